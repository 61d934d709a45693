// SPDX-License-Identifier: MPL-2.0
#include <scifi/cluster_to_space_point/crossing.hpp>

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/geometry/surface.hpp>

#include "support/catch.hpp"
#include "support/ideal_clusters.hpp"

using namespace scifi;

namespace {

/// A tracker of one station, shifted and turned.
tracker turned_station(double angle) {
  tracker t;
  t.stations = {mice::fibre_station(1, {1.5, -2.5, 300.0})};
  t.stations[0].in_tracker.angle = angle;
  return t;
}

std::vector<cluster> clusters_at(const tracker& t, double x, double y) {
  std::vector<cluster> out;
  for (const surface& s : surfaces_along(t, +1)) out.push_back(test::ideal_cluster(t, s, x, y));
  return out;
}

struct solution {
  Eigen::Vector2d position;
  Eigen::Matrix2d covariance;
  double chi2;
};

/// Weighted least squares in the tracker frame by a QR decomposition of the rows n . r = alpha + offset.
solution by_qr(const tracker& t, const std::vector<const cluster*>& chosen, double slope_spread) {
  const std::vector<surface> surfaces = surfaces_along(t, +1);
  const auto n = static_cast<Eigen::Index>(chosen.size());
  double mean_z = 0.0;
  for (const cluster* c : chosen) mean_z += surfaces[static_cast<std::size_t>(c->plane)].z / static_cast<double>(n);
  Eigen::MatrixXd a(n, 2);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const cluster& c = *chosen[static_cast<std::size_t>(i)];
    const surface& s = surfaces[static_cast<std::size_t>(c.plane)];
    const double sigma = std::hypot(std::sqrt(c.variance), slope_spread * (s.z - mean_z));
    a.row(i) << s.cos_angle / sigma, s.sin_angle / sigma;
    b(i) = (c.alpha + s.offset) / sigma;
  }
  solution out;
  out.position = a.colPivHouseholderQr().solve(b);
  out.covariance = (a.transpose() * a).inverse();
  out.chi2 = (a * out.position - b).squaredNorm();
  return out;
}

}  // namespace

TEST_CASE("three fibres cross where least squares by QR says, with its covariance and chi2, however the station is turned", "[cluster_to_space_point]") {
  random_stream random(1, 0, 0);
  for (const double angle : {0.0, 0.4, -2.0, 3.1}) {
    const tracker t = turned_station(angle);
    for (int i = 0; i < 20; ++i) {
      std::vector<cluster> clusters = clusters_at(t, random.uniform(-100.0, 100.0), random.uniform(-100.0, 100.0));
      for (cluster& c : clusters) {
        c.alpha += random.normal();
        c.variance *= random.uniform(0.05, 2.0);
      }
      const std::vector<const cluster*> chosen{&clusters[0], &clusters[1], &clusters[2]};
      const double slope_spread = i % 2 == 0 ? 0.0 : 0.25;
      const crossing_point c = cross(t.stations[0], chosen, slope_spread);
      const solution reference = by_qr(t, chosen, slope_spread);
      REQUIRE(c.defined);
      CHECK((c.position - reference.position).norm() < 1e-9);
      CHECK((c.covariance - reference.covariance).norm() < 1e-10 * reference.covariance.norm());
      // alpha^2/variance up to 1e5 cancels down to chi2.
      CHECK(c.chi2 == Approx(reference.chi2).epsilon(1e-9).margin(1e-8));
    }
  }
}

TEST_CASE("a point is found again from its exact coordinates, at the mean z of its planes", "[cluster_to_space_point]") {
  const tracker t = turned_station(0.3);
  const std::vector<cluster> clusters = clusters_at(t, 31.0, -52.0);
  const std::array triplet{&clusters[0], &clusters[1], &clusters[2]};
  const crossing_point c = cross(t.stations[0], triplet, 0.25);
  REQUIRE(c.defined);
  CHECK(c.position.x() == Approx(31.0).epsilon(1e-12));
  CHECK(c.position.y() == Approx(-52.0).epsilon(1e-12));
  CHECK(c.chi2 == Approx(0.0).margin(1e-9));
  const std::vector<surface> surfaces = surfaces_along(t, +1);
  CHECK(c.z == Approx((surfaces[0].z + surfaces[1].z + surfaces[2].z) / 3.0).epsilon(1e-14));
}

TEST_CASE("at 120 degrees the error of a point is round and 2/3 of the variance of a fibre", "[cluster_to_space_point]") {
  const tracker t = turned_station(0.0);
  const std::vector<cluster> clusters = clusters_at(t, 0.0, 0.0);
  const std::array triplet{&clusters[0], &clusters[1], &clusters[2]};
  const crossing_point c = cross(t.stations[0], triplet, 0.0);
  CHECK(c.covariance(0, 0) == Approx(2.0 / 3.0 * clusters[0].variance).epsilon(1e-12));
  CHECK(c.covariance(1, 1) == Approx(2.0 / 3.0 * clusters[0].variance).epsilon(1e-12));
  CHECK(c.covariance(0, 1) == Approx(0.0).margin(1e-12));
}

TEST_CASE("two fibres cross in a point without a test of it", "[cluster_to_space_point]") {
  const tracker t = turned_station(-0.7);
  std::vector<cluster> clusters = clusters_at(t, -20.0, 70.0);
  for (const auto& [i, j] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
    const std::vector<const cluster*> chosen{&clusters[static_cast<std::size_t>(i)], &clusters[static_cast<std::size_t>(j)]};
    const crossing_point c = cross(t.stations[0], chosen, 0.25);
    const solution reference = by_qr(t, chosen, 0.25);
    REQUIRE(c.defined);
    CHECK((c.position - reference.position).norm() < 1e-9);
    CHECK(c.position.x() == Approx(-20.0).epsilon(1e-10));
    CHECK((c.covariance - reference.covariance).norm() < 1e-10 * reference.covariance.norm());
    CHECK(c.chi2 == Approx(0.0).margin(1e-8));
  }
}

TEST_CASE("parallel fibres do not cross", "[cluster_to_space_point]") {
  tracker t = turned_station(0.0);
  t.stations[0].planes[1].angle = t.stations[0].planes[0].angle;
  const std::vector<cluster> clusters = clusters_at(t, 10.0, 10.0);
  CHECK_FALSE(cross(t.stations[0], std::array{&clusters[0], &clusters[1]}, 0.25).defined);
  CHECK(cross(t.stations[0], std::array{&clusters[0], &clusters[2]}, 0.25).defined);
  t.stations[0].planes[1].angle += 180.0 * units::degree;
  CHECK_FALSE(cross(t.stations[0], std::array{&clusters[0], &clusters[1]}, 0.25).defined);
}
