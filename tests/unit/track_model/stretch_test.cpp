// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/stretch.hpp>

#include <scifi/kalman/automatic_jacobian.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/leg.hpp>
#include <scifi/track_model/slope_state.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

struct by_place {
  using state_space = slope_state;
  template <class Scalar>
  kalman::propagated<Scalar, 5> propagate(const vector<Scalar, 5>& start, const stretch& way) const {
    kalman::propagated<Scalar, 5> out{start, matrix<Scalar, 5, 5>::Identity()};
    out.state[slope_state::x] = Scalar(way.z);
    out.state[slope_state::y] = Scalar(way.dz);
    return out;
  }
};

struct by_distance {
  template <class Scalar>
  vector<Scalar, 5> operator()(const vector<Scalar, 5>& start, double dz) const {
    vector<Scalar, 5> out = start;
    out[slope_state::y] = Scalar(dz);
    return out;
  }
};

leg leg_at(double z, double dz) {
  leg l;
  l.z = z;
  l.dz = dz;
  return l;
}

}  // namespace

TEST_CASE("a propagator that wants to know the place is told, one that does not is given the distance", "[track_model]") {
  const vector<double, 5> start(1.0, 0.2, -3.0, 0.1, 0.005);
  const auto placed = flown(by_place{}, start, leg_at(70.0, -20.0));
  CHECK(placed.state[slope_state::x] == 70.0);
  CHECK(placed.state[slope_state::y] == -20.0);
  const helix_propagator helix{0.9};
  CHECK(flown(helix, start, leg_at(70.0, -20.0)).state == helix.propagate(start, -20.0).state);
  CHECK(flown(kalman::automatic_jacobian{by_distance{}}, start, leg_at(70.0, -20.0)).state[slope_state::y] == -20.0);
}
