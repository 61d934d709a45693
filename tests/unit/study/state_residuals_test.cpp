// SPDX-License-Identifier: MPL-2.0
#include <vector>

#include "support/catch.hpp"
#include "support/flown_particle.hpp"

#include <scifi/geometry/mice.hpp>
#include <scifi/study/state_residuals.hpp>

using namespace scifi;
using namespace scifi::study;
using q = residual_quantity;
using test::five;

namespace {

struct fixture {
  detector d = mice::trackers();
  std::vector<crossing> crossings = test::flown_particle(*d.find(1), 1, five(10, 20, 30, 40, 200), 0.9);
  true_track particle = true_tracks(*d.find(1), crossings).at(0);
  track t = test::fitted_track(1, five(10.5, 19, 33, 44, 198), five(0.25, 0.5, 1, 2, 4));
  reference_bound limit;
  fixture() {
    limit.momentum = {particle.state(), matrix<double, 5, 5>::Identity()};
    limit.slopes = limit.momentum;
    limit.pt = 0.9;
  }
};

}  // namespace

TEST_CASE("residuals are reconstructed - true, that of pt along its true direction", "[study]") {
  const fixture f;
  const auto r = residuals_of(f.particle, f.t);
  CHECK(r[q::x] == Approx(0.5));
  CHECK(r[q::y] == Approx(-1.0));
  CHECK(r[q::pt] == Approx(5.0));  // (3, 4) along (0.6, 0.8)
  CHECK(r[q::pz] == Approx(-2.0));
  CHECK(r[q::tx] == Approx(33.0 / 198.0 - 30.0 / 200.0));
  track sideways = f.t;
  sideways.reference.mean = five(10, 20, 30 - 4, 40 + 3, 200);
  CHECK(residuals_of(f.particle, sideways)[q::pt] == Approx(0.0).margin(1e-12));
}

TEST_CASE("pulls are residuals over stated standard deviations; the charge is counted; merged", "[study]") {
  fixture f;
  state_residuals a, b;
  a.add(f.particle, f.t, f.limit);
  f.t.charge = -1;
  b.add(f.particle, f.t, f.limit);
  a += b;
  using m = momentum_state;
  CHECK(a.pull(m::x).values.values()[0] == Approx(2.0));
  CHECK(a.pull(m::y).values.values()[1] == Approx(-2.0));
  CHECK(a.pull(m::px).values.values()[0] == Approx(3.0));
  CHECK(a.pull(m::py).values.values()[0] == Approx(2.0));
  CHECK(a.pull(m::pz).values.values()[0] == Approx(-0.5));
  CHECK(a.residual(q::pt).values.size() == 2);
  CHECK(a.bound(q::pt).values()[1] == 0.9);
  CHECK(a.charge().found == 1);
  CHECK(a.charge().expected == 2);
}

TEST_CASE("a line has no residuals and pulls of its momentum", "[study]") {
  fixture f;
  f.t.shape = track_shape::line;
  state_residuals r;
  r.add(f.particle, f.t, f.limit);
  CHECK(r.residual(q::x).values.size() == 1);
  CHECK(r.residual(q::tx).values.size() == 1);
  CHECK(r.residual(q::pz).values.size() == 0);
  CHECK(r.pull(momentum_state::y).values.size() == 1);
  CHECK(r.pull(momentum_state::px).values.size() == 0);
  CHECK(r.charge().expected == 0);
}
