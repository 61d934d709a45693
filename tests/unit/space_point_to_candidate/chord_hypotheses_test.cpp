// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/chord_hypotheses.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/track_model/helix_propagator.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

const tracker where = mice::trackers().trackers[mice::downstream];

struct search {
  track_finder_options options;
  station_scattering scattering{where, muon_plus, highland_scattering{}};
};

search in_field(double field) {
  search s;
  s.options.field = field;
  return s;
}

/// Three points of the helix with this q/pz and slope.
std::array<arc_point, 3> points(double field, double q_over_pz, double slope, const std::array<double, 3>& z) {
  vector<double, 5> start;
  start << 5.0, slope * 0.6, 7.0, slope * 0.8, q_over_pz;
  std::array<arc_point, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = helix_propagator{field}.propagate(start, z[i] - z[0]).state;
    out[i] = {{at[slope_state::x], at[slope_state::y]}, 0.12, z[i]};
  }
  return out;
}

chord_hypotheses::list hypotheses(const search& s, const std::array<arc_point, 3>& p) {
  const chord_turn turn(p[1].z - p[0].z, p[2].z - p[1].z, std::abs(s.options.field) / s.options.smallest_pz);
  const chord_hypotheses make(s.options, s.scattering, 0, 1, turn, s.options.gate);
  return make(p[0], p[1], p[2]);
}

}  // namespace

TEST_CASE("the curvature of three points of a helix is among the hypotheses, whole turns included", "[space_point_to_candidate]") {
  constexpr std::array<std::array<double, 3>, 3> distances{{{0.0, 200.0, 450.0}, {0.0, 450.0, 1100.0}, {0.0, 250.0, 550.0}}};
  for (const double field : {3.0 * units::tesla, -4.0 * units::tesla}) {
    const search s = in_field(field);
    for (const auto& z : distances) {
      for (const double pz : {55.0, 80.0, 95.0, 120.0, 200.0, 280.0}) {
        for (const double charge : {1.0, -1.0}) {
          const auto p = points(field, charge / pz, 0.3, z);
          const double w = field * charge / pz;
          const auto all = hypotheses(s, p);
          INFO("field " << field << ", pz " << pz << ", charge " << charge << ", middle " << z[1]);
          CHECK(std::any_of(all.begin(), all.end(), [w](const curvature_hypothesis& h) { return std::abs(h.curvature - w) < 1e-9; }));
        }
      }
    }
  }
}

TEST_CASE("no hypothesis is beyond the least momentum", "[space_point_to_candidate]") {
  const search s = in_field(3.0 * units::tesla);
  for (const double pz : {40.0, 60.0, 150.0}) {
    for (const curvature_hypothesis& h : hypotheses(s, points(s.options.field, 1.0 / pz, 0.3, {0.0, 250.0, 550.0})))
      CHECK(std::abs(h.curvature) <= s.options.field / s.options.smallest_pz * (1.0 + 1e-12));
  }
}

TEST_CASE("points whose distances no curvature explains give none", "[space_point_to_candidate]") {
  const search s = in_field(3.0 * units::tesla);
  auto p = points(s.options.field, 0.005, 0.3, {0.0, 200.0, 450.0});
  REQUIRE_FALSE(hypotheses(s, p).empty());
  const planar<double> away = p[2].position - p[1].position;
  p[2].position = p[1].position + 3.0 * away;
  CHECK(hypotheses(s, p).empty());
  p[2].position = p[1].position;
  CHECK(hypotheses(s, p).empty());
}

TEST_CASE("a length may be off by what the error of the middle point does to both chords", "[space_point_to_candidate]") {
  search s = in_field(3.0 * units::tesla);
  constexpr double q_over_pz = 0.006, variance = 9.0;  // beside which scattering is little
  const double w = s.options.field * q_over_pz;
  const auto exact = points(s.options.field, q_over_pz, 0.3, {0.0, 200.0, 450.0});
  const planar<double> first = exact[1].position - exact[0].position, second = exact[2].position - exact[1].position;
  const double ratio = std::sqrt(norm(second) / norm(first));
  const double allowed = std::sqrt(s.options.gate * variance) * (1.0 + ratio);
  for (const auto& [share, found] : {std::pair(0.9, true), std::pair(1.1, false)}) {
    auto p = exact;
    p[0].variance = p[2].variance = 0.0;
    p[1].variance = variance;
    p[2].position = p[1].position + (1.0 + share * allowed / std::sqrt(norm(second))) * second;
    const auto all = hypotheses(s, p);
    CHECK(std::any_of(all.begin(), all.end(), [w](const curvature_hypothesis& h) { return std::abs(h.curvature - w) < 1e-9; }) == found);
  }
}

TEST_CASE("where the chords are short both senses of rotation are tried", "[space_point_to_candidate]") {
  const search s = in_field(3.0 * units::tesla);
  for (const double slope : {0.0, 0.002, 0.005}) {
    const auto all = hypotheses(s, points(s.options.field, 0.005, slope, {0.0, 200.0, 450.0}));
    CHECK(std::any_of(all.begin(), all.end(), [](const curvature_hypothesis& h) { return h.curvature > 0.002; }));
    CHECK(std::any_of(all.begin(), all.end(), [](const curvature_hypothesis& h) { return h.curvature < -0.002; }));
  }
}

TEST_CASE("a track without any bend is a hypothesis", "[space_point_to_candidate]") {
  const search s = in_field(3.0 * units::tesla);
  const auto all = hypotheses(s, points(s.options.field, 0.0, 0.3, {0.0, 200.0, 450.0}));
  CHECK(std::any_of(all.begin(), all.end(), [](const curvature_hypothesis& h) { return std::abs(h.curvature) < 1e-9; }));
}
