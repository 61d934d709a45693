// SPDX-License-Identifier: MPL-2.0
// Muons simulated by Geant4 in the trackers, fibre by fibre and independently of this library, from digits to tracks.
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/io/csv.hpp>
#include <scifi/io/digit_reader.hpp>
#include <scifi/io/geometry_json.hpp>
#include <scifi/material/highland.hpp>

#include "support/catch.hpp"
#include "support/sample.hpp"
#include "support/shared_data.hpp"
#include "support/track_score.hpp"
#include "support/track_score_checks.hpp"

using namespace scifi;

namespace {

constexpr test::limits sampled;

std::map<long, std::vector<crossing>> read_truth(const std::filesystem::path& path) {
  std::map<long, std::vector<crossing>> out;
  csv_reader rows(path, {"event", "track", "pdg", "tracker", "station", "plane", "x_mm", "y_mm", "z_mm", "px_MeV", "py_MeV", "pz_MeV"});
  while (rows.next_row())
    out[rows.whole_number<long>(0)].push_back({rows.whole_number<int>(1), rows.whole_number<int>(2), rows.whole_number<int>(3), rows.whole_number<int>(4),
                                               rows.whole_number<int>(5), {rows.number(6), rows.number(7), rows.number(8)},
                                               {rows.number(9), rows.number(10), rows.number(11)}});
  return out;
}

/// Reconstructs a set and compares it with its truth.
test::track_score score(const std::filesystem::path& folder, const std::string& set, double field) {
  const detector where = read_geometry(folder / "geometry.json");
  auto truth = read_truth(folder / (set + "_truth.csv.gz"));
  reconstruction_options options;
  options.field = field;
  const auto reconstruct = make_reconstruction(where, options);
  typename decltype(reconstruct)::buffers work;
  test::track_score out(field != 0.0);
  digit_reader digits(folder / (set + "_digits.csv.gz"), where);
  event e;
  while (digits.read(e)) {
    reconstruct(e, work);
    out.add(truth[e.number], e);
    truth.erase(e.number);
  }
  const event without_digits;
  for (const auto& [number, crossings] : truth) out.add(crossings, without_digits);
  return out;
}

void check_one_muon_in_a_field(const test::track_score& s) {
  CHECK(s.events == 6000);
  CHECK(s.all.expected > 4000);
  CHECK(s.failed == 0);
  CHECK(s.all.value() >= 0.985);
  for (std::size_t i = 0; i < s.by_pt.size(); ++i) {
    INFO("pt from " << test::pt_edges[i]);
    if (s.by_pt[i].expected > 50) sampled.at_least(s.by_pt[i], 0.97);
  }
  CHECK(s.ghosts_per_event() <= 0.02);
  sampled.spread_at_most(s.x, 0.345);
  sampled.spread_at_most(s.y, 0.345);
  sampled.spread_at_most(s.pt, 1.03);
  CHECK(std::abs(s.pt.median()) < 0.05);
  for (std::size_t i = 0; i < s.pull.size(); ++i) {
    INFO(momentum_state::names[i]);
    sampled.unit_spread(s.pull[i]);
  }
  sampled.unit_mean(s.chi2_per_ndf);
  CHECK(s.charge_above_5.value() >= 0.995);
}

}  // namespace

TEST_CASE("one muon in the downstream tracker in a field is found with the right state and errors", "[integration]") {
  if (const auto data = test::shared_data()) check_one_muon_in_a_field(score(*data / "g4", "tkd_helical", 3.0 * units::tesla));
}

TEST_CASE("one muon in the upstream tracker in a field is found with the right state and errors", "[integration]") {
  if (const auto data = test::shared_data()) check_one_muon_in_a_field(score(*data / "g4", "tku_helical", 3.0 * units::tesla));
}

TEST_CASE("one muon without a field is found with the right line and errors", "[integration]") {
  const auto data = test::shared_data();
  if (!data) return;
  const test::track_score s = score(*data / "g4", "tkd_straight", 0.0);
  CHECK(s.events == 3000);
  CHECK(s.all.expected > 1500);
  CHECK(s.failed == 0);
  CHECK(s.all.value() >= 0.99);
  CHECK(s.ghosts_per_event() <= 0.02);
  sampled.spread_at_most(s.x, 0.345);
  sampled.spread_at_most(s.y, 0.345);
  sampled.unit_spread(s.pull[momentum_state::x]);
  sampled.unit_spread(s.pull[momentum_state::y]);
  for (const test::sample& pull : s.slope_pull) sampled.unit_spread(pull);
  sampled.unit_mean(s.chi2_per_ndf);
}

TEST_CASE("two, four and ten muons at once are found and told apart", "[integration]") {
  const auto data = test::shared_data();
  if (!data) return;
  const auto check = [&data](const char* set, long events, double efficiency) {
    INFO(set);
    const test::track_score s = score(*data / "g4", set, 3.0 * units::tesla);
    CHECK(s.events == events);
    CHECK(s.failed == 0);
    CHECK(s.all.value() >= efficiency);
    CHECK(s.ghosts_per_expected() <= 0.05);
    CHECK(s.charge_above_5.value() >= 0.995);
  };
  check("tkd_multi2", 1000, 0.985);
  check("tkd_multi4", 1000, 0.97);
  check("tkd_multi10", 300, 0.96);
}

TEST_CASE("the core of Geant4's scattering in a station is Highland's to the 11 % it claims, slow and fast", "[integration]") {
  const auto data = test::shared_data();
  if (!data) return;
  const detector where = read_geometry(*data / "g4" / "geometry.json");
  std::array<test::sample, 2> over_highland;
  for (const auto& [number, crossings] : read_truth(*data / "g4" / "tkd_straight_truth.csv.gz"))
    for (std::size_t i = 0; i + 3 < crossings.size(); ++i) {
      // Without field, directions at the first planes of two stations differ by what the three planes of the first one did; the helium between does nothing.
      const crossing &a = crossings[i], &b = crossings[i + 3];
      if (a.plane != 0 || b.plane != 0 || b.station != a.station + 1) continue;
      const vector<double, 3> before = a.momentum.normalized(), after = b.momentum.normalized();
      double layer = 0.0;
      for (const surface& s : surfaces_along(where.trackers.front(), +1))
        if (s.station == a.station) layer += radiation_lengths(s.below) + radiation_lengths(s.above);
      layer /= before.z();
      const double p = 0.5 * (a.momentum.norm() + b.momentum.norm());
      const double highland = std::sqrt(highland_variance(p, muon_plus, layer, layer));
      // Angles about two axes across the flight.
      const vector<double, 3> first = vector<double, 3>(before.z(), 0.0, -before.x()).normalized();
      const vector<double, 3> second(before.y() * first.z() - before.z() * first.y(), before.z() * first.x() - before.x() * first.z(),
                                     before.x() * first.y() - before.y() * first.x());
      for (const vector<double, 3>& across : {first, second}) over_highland[p < 190.0 ? 0 : 1].add(std::atan2(after.dot(across), after.dot(before)) / highland);
    }
  for (const test::sample& s : over_highland) {
    REQUIRE(s.size() > 6000);
    INFO("core over Highland " << s.spread() << " of " << s.size());
    CHECK(std::abs(s.mean()) < 4.0 * s.error_of_mean());
    CHECK(s.spread() == Approx(1.0).margin(0.11));
  }
  // The same at either momentum: the width goes with 1/(beta p).
  CHECK(over_highland[0].spread() == Approx(over_highland[1].spread()).epsilon(6.0 * over_highland[0].relative_error_of_spread()));
}
