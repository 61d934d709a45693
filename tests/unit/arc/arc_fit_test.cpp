// SPDX-License-Identifier: MPL-2.0
#include <scifi/arc/arc_fit.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Dense>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

using complex = std::complex<double>;

const std::vector<double> station_z{0.0, 200.0, 450.0, 750.0, 1100.0};

/// Points of a helix of curvature w that starts at (3, -7) with this slope; each with a random shift of `noise` standard deviations.
std::vector<arc_point> points_of(double w, complex slope, double noise, std::uint64_t seed) {
  random_stream random(seed, 0, 0);
  std::vector<arc_point> out;
  for (const double z : station_z) {
    const complex i(0.0, 1.0);
    const complex lever = w == 0.0 ? complex(z) : (1.0 - std::exp(-i * w * z)) / (i * w);
    const double variance = random.uniform(0.05, 0.3);
    const double dx = random.normal(), dy = random.normal();
    const complex p = complex(3.0, -7.0) + lever * slope + noise * std::sqrt(variance) * complex(dx, dy);
    out.push_back({{p.real(), p.imag()}, variance, z});
  }
  return out;
}

arc_fit filtered(const std::vector<arc_point>& points, const arc_prior& prior, double w, double scattering) {
  arc_fit fit(points[0], prior, w);
  for (std::size_t i = 1; i < points.size(); ++i) {
    fit.fly(points[i].z, scattering);
    fit.take(points[i]);
  }
  return fit;
}

struct reference {
  complex position, slope;  // at the last point
  double pp, ss;
  complex ps;
  double chi2;
};

/// One least squares by QR in all unknowns at once: position and slope at the first point and the kick at each point but the last, where slope and
/// kicks have priors. Everything per projection, so complex numbers with real variances do.
reference all_at_once(const std::vector<arc_point>& points, double slope_variance, double w, double scattering) {
  const auto n = static_cast<Eigen::Index>(points.size());
  const complex i(0.0, 1.0);
  const auto lever = [&](double dz) { return w == 0.0 ? complex(dz) : (1.0 - std::exp(-i * w * dz)) / (i * w); };
  const Eigen::Index unknowns = n + 1;  // position, slope, n - 1 kicks
  const bool kicks = scattering > 0.0;
  Eigen::MatrixXcd a = Eigen::MatrixXcd::Zero(2 * n, unknowns);
  Eigen::VectorXcd b = Eigen::VectorXcd::Zero(2 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const arc_point& p = points[static_cast<std::size_t>(k)];
    const double sigma = std::sqrt(p.variance);
    a(k, 0) = 1.0 / sigma;
    a(k, 1) = lever(p.z - points[0].z) / sigma;
    for (Eigen::Index j = 0; j < k; ++j) a(k, 2 + j) = kicks ? lever(p.z - points[static_cast<std::size_t>(j)].z) / sigma : complex(0.0);
    b(k) = complex(p.position.x, p.position.y) / sigma;
  }
  a(n, 1) = 1.0 / std::sqrt(slope_variance);
  for (Eigen::Index j = 0; j + 1 < n; ++j) a(n + 1 + j, 2 + j) = kicks ? 1.0 / std::sqrt(scattering) : 1.0;
  const Eigen::VectorXcd x = a.colPivHouseholderQr().solve(b);
  const Eigen::MatrixXcd covariance = (a.adjoint() * a).inverse();

  // From the unknowns to position and slope at the last point.
  const double last = points.back().z;
  Eigen::MatrixXcd t = Eigen::MatrixXcd::Zero(2, unknowns);
  const auto turn = [&](double dz) { return std::exp(-i * w * dz); };
  t(0, 0) = 1.0;
  t(0, 1) = lever(last - points[0].z);
  t(1, 1) = turn(last - points[0].z);
  for (Eigen::Index j = 0; kicks && j + 1 < n; ++j) {
    t(0, 2 + j) = lever(last - points[static_cast<std::size_t>(j)].z);
    t(1, 2 + j) = turn(last - points[static_cast<std::size_t>(j)].z);
  }
  const Eigen::VectorXcd end = t * x;
  const Eigen::MatrixXcd end_covariance = t * covariance * t.adjoint();
  return {end(0), end(1), end_covariance(0, 0).real(), end_covariance(1, 1).real(), end_covariance(0, 1), (a * x - b).squaredNorm()};
}

}  // namespace

TEST_CASE("at a given curvature the arc fit is the least squares in all unknowns at once", "[arc]") {
  for (const double w : {0.0, 1e-7, 0.004, -0.009, 0.018}) {
    for (const double scattering : {0.0, 2e-5}) {
      INFO("curvature " << w << ", scattering " << scattering);
      const std::vector<arc_point> points = points_of(0.0045, {0.1, 0.25}, 1.0, 7);
      const arc_prior prior{0.09, 0.0, 0.0};
      const arc_fit fit = filtered(points, prior, w, scattering);
      const reference r = all_at_once(points, prior.slope_variance, w, scattering);
      CHECK(fit.chi2() == Approx(r.chi2).epsilon(1e-8));
      CHECK(std::hypot(fit.position().x - r.position.real(), fit.position().y - r.position.imag()) < 1e-7);
      CHECK(std::hypot(fit.slope().x - r.slope.real(), fit.slope().y - r.slope.imag()) < 1e-9);
      CHECK(fit.position_variance() == Approx(r.pp).epsilon(1e-7));
      CHECK(fit.slope_variance() == Approx(r.ss).epsilon(1e-6));
      CHECK(fit.position_slope_covariance().x == Approx(r.ps.real()).epsilon(1e-6).margin(1e-12));
      CHECK(fit.position_slope_covariance().y == Approx(r.ps.imag()).epsilon(1e-6).margin(1e-12));
      CHECK(fit.curvature_step() == 0.0);
      CHECK(fit.z() == 1100.0);
    }
  }
}

TEST_CASE("without curvature and scattering the arc fit is a straight-line regression", "[arc]") {
  std::vector<arc_point> points = points_of(0.0, {-0.12, 0.05}, 1.0, 9);
  const arc_fit fit = filtered(points, {1e3, 0.0, 0.0}, 0.0, 0.0);
  // Weighted regression in closed form.
  double s = 0, sz = 0, szz = 0, sx = 0, szx = 0;
  for (const arc_point& p : points) {
    const double weight = 1.0 / p.variance;
    const double z = p.z - points.back().z;
    s += weight;
    sz += weight * z;
    szz += weight * z * z;
    sx += weight * p.position.x;
    szx += weight * z * p.position.x;
  }
  const double determinant = s * szz - sz * sz;
  CHECK(fit.position().x == Approx((szz * sx - sz * szx) / determinant).epsilon(1e-6));
  CHECK(fit.slope().x == Approx((s * szx - sz * sx) / determinant).epsilon(1e-6));
  CHECK(fit.position_variance() == Approx(szz / determinant).epsilon(1e-6));
  CHECK(fit.slope_variance() == Approx(s / determinant).epsilon(1e-6));
}

TEST_CASE("a track without noise is reproduced, with chi2 zero at its curvature", "[arc]") {
  for (const double w : {0.0, 0.0045, -0.0085}) {
    const complex slope(0.2, -0.15);
    const std::vector<arc_point> points = points_of(w, slope, 0.0, 1);
    const arc_fit fit = filtered(points, {1e8, 0.0, 0.0}, w, 0.0);
    const complex expected = slope * std::exp(complex(0.0, -w * 1100.0));
    CHECK(fit.chi2() == Approx(0.0).margin(1e-6));
    CHECK(fit.position().x == Approx(points.back().position.x).margin(1e-5));
    CHECK(fit.slope().x == Approx(expected.real()).margin(1e-8));
    CHECK(fit.slope().y == Approx(expected.imag()).margin(1e-8));
  }
}

TEST_CASE("Gauss-Newton in the curvature converges to the minimum of chi2", "[arc]") {
  constexpr double scattering = 1.5e-5;
  double worst = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const double w = (seed % 2 == 0 ? 1.0 : -1.0) * (0.003 + 0.0001 * static_cast<double>(seed));
    const std::vector<arc_point> points = points_of(w, {0.15, 0.1}, 1.0, seed);
    const arc_prior prior{0.09, std::copysign(0.0054, w), 0.0036 * 0.0036, {0.15, 0.1}};
    const auto chi2 = [&](double at) { return filtered(points, prior, at, scattering).chi2(); };
    // The minimum near the truth on a grid, then by golden section.
    double best = w;
    for (double at = w - 6e-4; at < w + 6e-4; at += 1e-6)
      if (chi2(at) < chi2(best)) best = at;
    double low = best - 1e-6, high = best + 1e-6;
    for (int i = 0; i < 40; ++i) {
      const double a = high - 0.618034 * (high - low), b = low + 0.618034 * (high - low);
      (chi2(a) < chi2(b) ? high : low) = chi2(a) < chi2(b) ? b : a;
    }
    const double minimum = 0.5 * (low + high);

    arc_fit fit = filtered(points, prior, w + 2e-4, scattering);
    for (int i = 0; i < 8; ++i) fit = filtered(points, prior, fit.curvature() + fit.curvature_step(), scattering);
    const double sigma = std::sqrt(fit.curvature_variance());
    worst = std::max(worst, std::abs(fit.curvature() - minimum) / sigma);
    CHECK(std::abs(fit.curvature_step()) < 1e-3 * sigma);
    CHECK(std::abs(w - minimum) < 5.0 * sigma);
    // The variance is that of the parabola at the minimum: chi2 grows by one over one standard deviation.
    CHECK(0.5 * (chi2(minimum + sigma) + chi2(minimum - sigma)) - chi2(minimum) == Approx(1.0).epsilon(0.2));
  }
  // The step holds the gains fixed though they change with the curvature.
  CHECK(worst < 0.1);
}

TEST_CASE("the predicted chi2 after the step is the one found there", "[arc]") {
  const arc_prior prior{0.09, 0.0054, 0.0036 * 0.0036};
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::vector<arc_point> points = points_of(0.005, {0.2, 0.1}, 1.0, seed);
    const arc_fit near = filtered(points, prior, 0.00502, 0.0);
    const arc_fit there = filtered(points, prior, near.curvature() + near.curvature_step(), 0.0);
    CHECK(near.chi2_after_step() < near.chi2());
    // The gains are held fixed: their change with the curvature, times the residuals, is left out of the first derivative.
    const double decrease = near.chi2() - near.chi2_after_step();
    CHECK(std::abs(there.chi2() - near.chi2_after_step()) < 0.2 * std::sqrt(decrease * near.chi2()));
  }
}

TEST_CASE("the derivatives are those of the state with the curvature, where nothing but the points decides", "[arc]") {
  // Two points and a free slope: the state follows the points exactly, so that fixed weights are exact.
  std::vector<arc_point> points = points_of(0.005, {0.2, 0.1}, 0.0, 21);
  points.resize(2);
  const arc_prior prior{1e8, 0.005, 1e-6, {0.2, 0.1}};
  constexpr double h = 1e-7;
  const auto ahead = [&](double w) {
    arc_fit fit = filtered(points, prior, w, 0.0);
    fit.fly(500.0, 0.0);
    return fit;
  };
  const arc_fit here = ahead(0.005), up = ahead(0.005 + h), down = ahead(0.005 - h);
  CHECK(here.d_position().x == Approx((up.position().x - down.position().x) / (2.0 * h)).epsilon(1e-5));
  CHECK(here.d_position().y == Approx((up.position().y - down.position().y) / (2.0 * h)).epsilon(1e-5));
  CHECK(here.d_slope().x == Approx((up.slope().x - down.slope().x) / (2.0 * h)).epsilon(1e-5));
  CHECK(here.d_slope().y == Approx((up.slope().y - down.slope().y) / (2.0 * h)).epsilon(1e-5));
}

TEST_CASE("the distance of a point counts its own error, that of the prediction and that of the curvature", "[arc]") {
  const std::vector<arc_point> points = points_of(0.005, {0.2, 0.1}, 0.0, 3);
  arc_fit fit(points[0], {0.09, 0.005, 1e-8}, 0.005);
  for (std::size_t i = 1; i < 3; ++i) {
    fit.fly(points[i].z, 1e-5);
    fit.take(points[i]);
  }
  fit.fly(points[3].z, 1e-5);
  const double extra = norm(fit.d_position()) * fit.curvature_variance();
  CHECK(extra > 0.0);
  CHECK(fit.prediction_variance() == Approx(fit.position_variance() + extra));
  arc_point off = points[3];
  const planar<double> predicted = fit.position();
  off.position = {predicted.x + 3.0, predicted.y - 4.0};
  CHECK(fit.distance2(off) == Approx(25.0 / (off.variance + fit.prediction_variance())));
}

TEST_CASE("the distance of true points follows chi-squared with two degrees of freedom", "[arc]") {
  double sum = 0.0;
  constexpr int tracks = 4000;
  for (int k = 0; k < tracks; ++k) {
    const std::vector<arc_point> points = points_of(0.005, {0.2, 0.1}, 1.0, 1000 + static_cast<std::uint64_t>(k));
    arc_fit fit(points[0], {0.09, 0.0, 0.0}, 0.005);
    for (std::size_t i = 1; i < 4; ++i) {
      fit.fly(points[i].z, 0.0);
      if (i < 3) fit.take(points[i]);
    }
    sum += fit.distance2(points[3]);
  }
  // Mean 2, variance 4.
  CHECK(std::abs(sum / tracks - 2.0) < 4.0 * std::sqrt(4.0 / tracks));
}
