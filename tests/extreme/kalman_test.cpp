// SPDX-License-Identifier: MPL-2.0
#include <array>
#include <cmath>
#include <vector>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/iterated.hpp>
#include <scifi/kalman/relinearised.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/smoother.hpp>
#include <scifi/kalman/square_root.hpp>
#include <scifi/kalman/symmetric_form.hpp>

#include "extreme/extremes.hpp"
#include "support/catch.hpp"
#include "unit/kalman/models.hpp"

using namespace scifi::kalman;
using scifi::matrix;
using scifi::vector;
using scifi::test::all_finite;
using scifi::test::extremes;
using scifi::test::infinity;
using scifi::test::not_a_number;
using scifi::test::sound;

namespace {

/// A step that does with position and velocity what it is told.
struct told {
  double velocity_by = 1.0;
  matrix<double, 2, 2> noise = matrix<double, 2, 2>::Zero();
};
struct told_propagator {
  matrix<double, 2, 2> transition(const told& step) const {
    matrix<double, 2, 2> f = matrix<double, 2, 2>::Identity();
    f(0, 1) = step.velocity_by;
    return f;
  }
};
struct told_noise {
  matrix<double, 2, 2> covariance(const told& step) const { return step.noise; }
};
/// a position + b velocity, measured.
struct told_measurement {
  double z = 0.3, variance = 0.5, a = 1.0, b = 0.2;
  double value() const { return z; }
  double covariance() const { return variance; }
  matrix<double, 1, 2> projection() const { return {a, b}; }
};

/// Everything that goes into one step and one update; `slot` says which number of it is put out of order.
struct problem {
  estimate<double, 2> start;
  told step;
  told_measurement seen;
  static constexpr int slots = 12;

  problem(int slot, double x) {
    start.mean << 1.0, 2.0;
    start.covariance << 2.0, 0.3, 0.3, 1.0;
    step.noise << 0.1, 0.02, 0.02, 0.1;
    const std::array<double*, slots> at{&start.mean[0],         &start.mean[1],    &start.covariance(0, 0), &start.covariance(1, 1), &start.covariance(0, 1), &step.velocity_by,
                                        &step.noise(0, 0), &step.noise(0, 1),  &seen.z,                 &seen.variance,          &seen.a,                 &seen.b};
    *at[static_cast<std::size_t>(slot)] = x;
    start.covariance(1, 0) = start.covariance(0, 1);
    step.noise(1, 0) = step.noise(0, 1);
  }
};

/// What comes out is sound, or the status says that something went wrong and nothing that is not sound came out of a sound start.
template <class Update>
void never_lies(const Update& update) {
  const filter f(told_propagator{}, told_noise{}, update);
  for (int slot = 0; slot < problem::slots; ++slot)
    for (const double x : extremes) {
      INFO("slot " << slot << " is " << x);
      const problem p(slot, x);
      const std::array<site<told, told_measurement>, 2> sites{site<told, told_measurement>{p.step, p.seen}, site<told, told_measurement>{told{}, told_measurement{}}};
      std::array<node<double, 2, 1>, 2> nodes;
      const auto result = f.run(p.start, sites, nodes);
      if (!std::isfinite(x)) CHECK_FALSE(result.status.ok());
      if (!result.status.ok()) continue;
      CHECK((std::isfinite(result.chi2) && result.chi2 >= 0.0));
      for (const auto& n : nodes) CHECK((sound(n.predicted) && sound(n.filtered) && std::isfinite(n.chi2)));
      if (smooth(nodes).ok()) CHECK(sound(nodes[0].smoothed));
    }
}

/// The problem in other units, and its outcome must be the outcome in those units, to the last bit.
template <class Update>
void scales_exactly(const Update& update, double up) {
  for (const double unit : {up, 1.0 / up}) {
    const auto solve = [&update](double by) {
      problem p(0, 1.0);
      p.start.mean *= by;
      p.start.covariance *= by * by;
      p.step.noise *= by * by;
      p.seen.z *= by;
      p.seen.variance *= by * by;
      const filter f(told_propagator{}, told_noise{}, update);
      return f.update(f.predict(p.start, p.step), p.seen);
    };
    const auto in_ones = solve(1.0);
    const auto in_units = solve(unit);
    REQUIRE(in_units.status.ok());
    CHECK(in_units.posterior.mean == in_ones.posterior.mean * unit);
    CHECK(in_units.posterior.covariance == in_ones.posterior.covariance * (unit * unit));
    CHECK(in_units.chi2 == in_ones.chi2);
  }
}

}  // namespace

TEST_CASE("a filter that is given any number ends in sound estimates or says that it failed", "[extreme]") {
  SECTION("Joseph's form") { never_lies(joseph{}); }
  SECTION("the symmetric form") { never_lies(symmetric_form{}); }
  SECTION("square roots") { never_lies(square_root{}); }
  SECTION("iterated") { never_lies(iterated{}); }
}

TEST_CASE("a filter of factored estimates does not take NaN for certainty", "[extreme]") {
  const filter f(told_propagator{}, told_noise{}, square_root{});
  for (int slot = 0; slot < problem::slots; ++slot)
    for (const double x : {not_a_number, infinity, -infinity}) {
      INFO("slot " << slot << " is " << x);
      const problem p(slot, x);
      CHECK_FALSE(f.update(f.predict(factored(p.start), p.step), p.seen).status.ok());
    }
}

TEST_CASE("variances in any unit are worked with as those of one are", "[extreme]") {
  SECTION("Joseph's form, up to 1e295") { scales_exactly(joseph{}, 0x1p+490); }
  SECTION("the symmetric form, up to 1e150") { scales_exactly(symmetric_form{}, 0x1p+249); }
}

TEST_CASE("covariances without an inverse are taken as they are where they have a meaning", "[extreme]") {
  const filter f(told_propagator{}, told_noise{});
  problem p(0, 1.0);
  SECTION("a state that is known exactly does not move") {
    p.start.covariance.setZero();
    const auto u = f.update(p.start, p.seen);
    CHECK(u.status.ok());
    CHECK(u.posterior.mean == p.start.mean);
    CHECK(u.posterior.covariance.isZero(0.0));
  }
  SECTION("a measurement without error fixes what it measures") {
    p.seen.variance = 0.0;
    const auto u = f.update(p.start, p.seen);
    CHECK(u.status.ok());
    const auto h = p.seen.projection();
    CHECK((h * u.posterior.mean)(0) == Approx(p.seen.z).epsilon(1e-14));
    CHECK((h * u.posterior.covariance * h.transpose())(0) == Approx(0.0).margin(1e-15));
  }
  SECTION("both together contradict each other or say nothing") {
    p.start.covariance.setZero();
    p.seen.variance = 0.0;
    CHECK(f.update(p.start, p.seen).status == status{step_kind::update, reason::singular_innovation});
  }
  SECTION("a covariance of rank one stays on its line") {
    p.start.covariance << 4.0, 2.0, 2.0, 1.0;
    const auto u = f.update(p.start, p.seen);
    CHECK(u.status.ok());
    CHECK(u.posterior.mean[0] - 1.0 == Approx(2.0 * (u.posterior.mean[1] - 2.0)).epsilon(1e-14));
    CHECK(u.posterior.covariance(0, 0) == Approx(4.0 * u.posterior.covariance(1, 1)).epsilon(1e-14));
  }
}

TEST_CASE("a step of no length without noise changes nothing", "[extreme]") {
  const problem p(0, 1.0);
  const auto moved = filter(told_propagator{}, no_noise{}).predict(p.start, told{0.0});
  CHECK(moved.status.ok());
  CHECK(moved.estimate.mean == p.start.mean);
  CHECK(moved.estimate.covariance == p.start.covariance);
}

TEST_CASE("a million planes are filtered and smoothed to the variances of the stationary solution", "[extreme]") {
  struct walk {
    double transition(int) const { return 1.0; }
  };
  struct noise {
    double covariance(int) const { return 0.25; }
  };
  struct seen {
    double z;
    double value() const { return z; }
    double projection() const { return 1.0; }
    double covariance() const { return 1.0; }
  };
  constexpr std::size_t planes = 1000000;
  std::vector<site<int, seen>> sites(planes, site<int, seen>{1, seen{0.0}});
  for (std::size_t i = 0; i < planes; ++i) sites[i].measurement.z = i % 2 == 0 ? 1.0 : -1.0;
  std::vector<node<double, 1, 1>> nodes(planes);
  const auto result = filter(walk{}, noise{}).run(uncorrelated(0.0, 10.0), sites, nodes);
  REQUIRE(result.status.ok());
  CHECK(result.reached == planes);
  REQUIRE(smooth(nodes).ok());
  // P = q + P r/(P + r) before each measurement (Riccati); smoothed: the information of both sides and of the plane itself.
  const double q = 0.25, r = 1.0;
  const double before = 0.5 * (q + std::sqrt(q * q + 4.0 * q * r));
  const auto& middle = nodes[planes / 2];
  CHECK(middle.predicted.covariance(0, 0) == Approx(before).epsilon(1e-12));
  CHECK(middle.smoothed.covariance(0, 0) == Approx(1.0 / (1.0 / r + 2.0 / before)).epsilon(1e-12));
}

TEST_CASE("no pass over the sites is no fit, and the status says so", "[extreme]") {
  const filter f(told_propagator{}, told_noise{});
  const problem p(0, 1.0);
  const std::array<site<told, told_measurement>, 1> sites{site<told, told_measurement>{p.step, p.seen}};
  std::array<node<double, 2, 1>, 1> nodes;
  std::array<vector<double, 2>, 2> references;
  for (const int passes : {0, -1, -2147483647}) CHECK(run_relinearised(f, p.start, p.start.mean, sites, nodes, references, passes).status.why == reason::not_converged);
  CHECK(run_relinearised(f, p.start, p.start.mean, sites, nodes, references, 1).status.ok());
}
