// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/space_point_to_candidate/chord_hypotheses.hpp>

using namespace scifi;

namespace {

const double z1 = 0.0, z2 = 200.0, z3 = 450.0;

track_finder_options options() {
  track_finder_options o;
  o.field = 3.0 * units::tesla;
  return o;
}

/// A point of the helix position(z) = slope (1 - e^{-iwz})/(iw), from the equation of motion solved in complex numbers.
arc_point on_helix(double w, double z, std::complex<double> slope) {
  const std::complex<double> i(0.0, 1.0);
  const std::complex<double> at = slope * (1.0 - std::exp(-i * w * z)) / (i * w);
  return {{at.real(), at.imag()}, 0.1, z};
}

chord_hypotheses make(const track_finder_options& o, const station_scattering& s) { return {o, s, 0, 1, z1, z2, z3, 14.0}; }

}  // namespace

TEST_CASE("the true curvature is among the hypotheses of three exact points, both senses, slow and fast", "[space_point_to_candidate]") {
  const track_finder_options o = options();
  const station_scattering scattering(mice::trackers().trackers[1], muon_plus, highland_scattering{});
  const auto hypotheses = make(o, scattering);
  for (const double pz : {60.0, 90.0, 110.0, 200.0, 280.0}) {
    for (const double sense : {1.0, -1.0}) {
      const double w = sense * o.field / pz;
      const std::complex<double> slope = std::polar(0.25, 0.7);
      const auto found = hypotheses(on_helix(w, z1, slope), on_helix(w, z2, slope), on_helix(w, z3, slope));
      INFO("pz " << pz << " sense " << sense);
      CHECK(std::any_of(found.begin(), found.end(), [w](const curvature_hypothesis& h) { return std::abs(h.curvature - w) < 1e-9 * std::abs(w) + 1e-15; }));
    }
  }
}

TEST_CASE("chords whose lengths no curvature explains have no hypothesis", "[space_point_to_candidate]") {
  const track_finder_options o = options();
  const station_scattering scattering(mice::trackers().trackers[1], muon_plus, highland_scattering{});
  const auto hypotheses = make(o, scattering);
  const arc_point a{{0.0, 0.0}, 0.1, z1}, b{{50.0, 0.0}, 0.1, z2};
  CHECK(hypotheses(a, b, {{52.0, 0.0}, 0.1, z3}).empty());   // second chord far too short
  CHECK(hypotheses(a, b, {{150.0, 0.0}, 0.1, z3}).empty());  // far too long
}

TEST_CASE("short chords ask for both senses of rotation", "[space_point_to_candidate]") {
  const track_finder_options o = options();
  const station_scattering scattering(mice::trackers().trackers[1], muon_plus, highland_scattering{});
  const auto found = make(o, scattering)({{0.0, 0.0}, 0.1, z1}, {{0.3, 0.1}, 0.1, z2}, {{0.4, -0.2}, 0.1, z3});
  const double typical = o.typical_q_over_pz * o.field;
  for (const double w : {typical, -typical})
    CHECK(std::any_of(found.begin(), found.end(), [w](const curvature_hypothesis& h) { return h.curvature == w && h.iterations > 1; }));
}
