// SPDX-License-Identifier: MPL-2.0
#include <scifi/candidate_to_track/fit_path.hpp>

#include <cstddef>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

double solid_radiation_lengths(const tracker& t) {
  double sum = 0.0;
  for (const station& s : t.stations)
    for (const plane& p : s.planes) sum += radiation_lengths(p.below) + radiation_lengths(p.above);
  return sum;
}

}  // namespace

TEST_CASE("the way leads from the last surface to the first, and on to the reference surface", "[candidate_to_track]") {
  for (const tracker& t : mice::trackers().trackers) {
    const fit_path path = fit_path_of(t);
    REQUIRE(path.surfaces.size() == 15);
    REQUIRE(path.legs.size() == 16);
    CHECK(path.z_reference == 0.0);
    CHECK(path.surfaces.front().station == 5);
    CHECK(path.surfaces.front().plane == 2);
    CHECK(path.surfaces.back().station == 1);
    CHECK(path.surfaces.back().plane == 0);
    CHECK(path.legs[0].dz == 0.0);
    double z = path.surfaces[0].z;
    for (std::size_t i = 0; i < path.legs.size(); ++i) {
      CHECK(path.legs[i].direction == -1);
      z += path.legs[i].dz;
      CHECK(z == Approx(i < 15 ? path.surfaces[i].z : path.z_reference).margin(1e-12));
    }
  }
}

TEST_CASE("all material from the last surface down to the reference surface stands on the way, once", "[candidate_to_track]") {
  for (const tracker& t : mice::trackers().trackers) {
    const fit_path path = fit_path_of(t);
    double solid = 0.0;
    double gas = 0.0;
    for (const leg& l : path.legs) {
      solid += radiation_lengths(l.start) + radiation_lengths(l.finish);
      gas += thickness(l.gap);
      // Gas and solids fill the leg.
      CHECK(thickness(l.start) + thickness(l.gap) + thickness(l.finish) == Approx(-l.dz).margin(1e-6));
      for (const slab& s : l.gap) CHECK(s.medium.name == "helium");
    }
    // What lies behind the last measurement is not crossed.
    CHECK(solid == Approx(solid_radiation_lengths(t) - radiation_lengths(path.surfaces.front().above)).epsilon(1e-12));
    double between_stations = 0.0;
    for (std::size_t i = 0; i + 1 < t.stations.size(); ++i) {
      const plane& last = t.stations[i].planes.back();
      between_stations += t.stations[i + 1].in_tracker.origin.z() - t.stations[i].in_tracker.origin.z() - last.z_measured - thickness(last.above);
    }
    CHECK(gas == Approx(between_stations).epsilon(1e-9));
  }
}

TEST_CASE("thin material stands on the side of the gas on which it is", "[candidate_to_track]") {
  const tracker t = mice::trackers().trackers[mice::downstream];
  const fit_path path = fit_path_of(t);
  // From plane 0 of station 5 to plane 2 of station 4: what lies below the one, helium, what lies above the other.
  const leg& l = path.legs[3];
  CHECK(thickness(l.start) == Approx(thickness(t.stations[4].planes[0].below)));
  CHECK(thickness(l.finish) == Approx(thickness(t.stations[3].planes[2].above)));
  CHECK(radiation_lengths(l.start) == Approx(radiation_lengths(t.stations[4].planes[0].below)));
  CHECK(l.gap.size() == 1);
  // Within a station there is no gas.
  CHECK(path.legs[1].gap.empty());
  // The last leg: what lies between the first fibres and the outer surface.
  CHECK(radiation_lengths(path.legs[15].start) + radiation_lengths(path.legs[15].finish) == Approx(radiation_lengths(t.stations[0].planes[0].below)));
  CHECK(path.legs[15].gap.empty());
}

TEST_CASE("every slab keeps the layer that the logarithms of scattering and loss use", "[candidate_to_track]") {
  const tracker t = mice::trackers().trackers[mice::downstream];
  const double station = solid_radiation_lengths(t) / 5.0;
  for (const leg& l : fit_path_of(t).legs) {
    for (const slab& s : l.start) CHECK(s.layer_radiation_lengths == Approx(station));
    for (const slab& s : l.finish) CHECK(s.layer_radiation_lengths == Approx(station));
  }
}

TEST_CASE("slabs of one medium and layer are put together, others are kept apart", "[candidate_to_track]") {
  slab_stack<4> stack;
  add_to(stack, {materials::mylar, 0.1, 0.01});
  add_to(stack, {materials::polystyrene, 0.3, 0.01});
  add_to(stack, {materials::mylar, 0.2, 0.01});
  add_to(stack, {materials::mylar, 0.4, 0.02});
  REQUIRE(stack.size() == 3);
  CHECK(stack[0].thickness == Approx(0.3));
  CHECK(stack[1].thickness == 0.3);
  CHECK(stack[2].thickness == 0.4);
  // Two media of one name, as a geometry file may describe them.
  material denser = materials::mylar;
  denser.density *= 2.0;
  add_to(stack, {denser, 0.5, 0.02});
  REQUIRE(stack.size() == 4);
  CHECK(stack[3].thickness == 0.5);
}

TEST_CASE("a tracker without stations has no way", "[candidate_to_track]") {
  const fit_path path = fit_path_of(tracker{});
  CHECK(path.surfaces.empty());
  CHECK(path.legs.empty());
}
