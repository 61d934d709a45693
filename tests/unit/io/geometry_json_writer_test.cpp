// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/geometry_json_writer.hpp>

#include <filesystem>
#include <string>

#include <scifi/geometry/mice.hpp>
#include <scifi/geometry/surface.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::detector;
using scifi::slab;
using namespace scifi::test;

/// Rounding of a number that is divided and multiplied by a unit on its way.
constexpr double rounding = 1e-14;

void check_same(const slab& a, const slab& b) {
  CHECK(a.thickness == b.thickness);
  CHECK(a.layer_radiation_lengths == b.layer_radiation_lengths);
  CHECK(a.medium.density == b.medium.density);
  CHECK(a.medium.radiation_length == b.medium.radiation_length);
  CHECK(a.medium.z_over_a == b.medium.z_over_a);
  CHECK(a.medium.mean_excitation_energy == Approx(b.medium.mean_excitation_energy).epsilon(rounding));
  CHECK(a.medium.density_effect.c == b.medium.density_effect.c);
  CHECK(a.medium.density_effect.delta0 == b.medium.density_effect.delta0);
}

void check_same(const detector& a, const detector& b) {
  REQUIRE(a.trackers.size() == b.trackers.size());
  for (std::size_t i = 0; i < a.trackers.size(); ++i) {
    CHECK(a.trackers[i].id == b.trackers[i].id);
    CHECK(a.trackers[i].name == b.trackers[i].name);
    CHECK(a.trackers[i].beam_direction == b.trackers[i].beam_direction);
    CHECK(a.trackers[i].fiducial_radius == b.trackers[i].fiducial_radius);
    check_same(slab{a.trackers[i].gas, 1.0, 0.0}, slab{b.trackers[i].gas, 1.0, 0.0});
    const auto x = scifi::surfaces_along(a.trackers[i], 1);
    const auto y = scifi::surfaces_along(b.trackers[i], 1);
    REQUIRE(x.size() == y.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      CHECK(x[k].station == y[k].station);
      CHECK(x[k].plane == y[k].plane);
      CHECK(x[k].z == y[k].z);
      CHECK(x[k].z_reference == y[k].z_reference);
      CHECK(x[k].cos_angle == Approx(y[k].cos_angle).margin(rounding));
      CHECK(x[k].sin_angle == Approx(y[k].sin_angle).margin(rounding));
      CHECK(x[k].offset == Approx(y[k].offset).margin(rounding));
      REQUIRE(x[k].below.size() == y[k].below.size());
      REQUIRE(x[k].above.size() == y[k].above.size());
      for (std::size_t n = 0; n < x[k].below.size(); ++n) check_same(x[k].below[n], y[k].below[n]);
      for (std::size_t n = 0; n < x[k].above.size(); ++n) check_same(x[k].above[n], y[k].above[n]);
    }
    for (std::size_t j = 0; j < a.trackers[i].stations.size(); ++j) {
      for (std::size_t k = 0; k < a.trackers[i].stations[j].planes.size(); ++k) {
        const auto& p = a.trackers[i].stations[j].planes[k];
        const auto& q = b.trackers[i].stations[j].planes[k];
        CHECK(p.view == q.view);
        CHECK(p.channels == q.channels);
        CHECK(p.central_channel == q.central_channel);
        CHECK(p.channel_width == q.channel_width);
      }
    }
  }
}

}  // namespace

TEST_CASE("a detector that is written and read is the same", "[io]") {
  const temporary_folder folder;
  detector d = scifi::mice::trackers();
  SECTION("as surveyed") {}
  SECTION("with a turned station") { d.trackers[1].stations[2].in_tracker.angle = -0.003; }
  SECTION("with media of its own") {
    auto foam = scifi::materials::polystyrene;
    foam.name = "foam";
    foam.density = 0.05;
    foam.radiation_length = 8758.0;
    d.trackers[0].gas = scifi::materials::vacuum;
    d.trackers[1].gas = foam;
    foam.density = 0.06;
    d.trackers[1].stations[4].planes[2].above.add({foam, 0.5, 0.01});
  }
  SECTION("with stations that differ") {
    d.trackers[0].stations[1].planes.pop_back();
    d.trackers[0].stations[2].planes[0].channels = 99;
    d.trackers[0].stations[2].planes[0].channel_width = 2.0;
  }
  scifi::write_geometry(folder / "g.json", d);
  const detector back = scifi::read_geometry(folder / "g.json");
  check_same(d, back);
  // What has been read can be written again, word by word.
  CHECK(scifi::geometry_from_json(scifi::geometry_to_json(back), "again").trackers.size() == 2);
  check_same(d, scifi::geometry_from_json(scifi::geometry_to_json(back), "again"));
}

TEST_CASE("a written geometry carries its format and version, and writes shared planes once", "[io]") {
  const auto document = scifi::geometry_to_json(scifi::mice::trackers());
  CHECK(document.at("format") == "scifi-geometry");
  CHECK(document.at("version") == 1);
  CHECK(document.at("planes").size() == 3);
  for (const auto& t : document.at("trackers"))
    for (const auto& s : t.at("stations")) CHECK_FALSE(s.contains("planes"));
  CHECK(scifi::fibre_from_json(document, "f").channel_width() == scifi::fibre_doublet{}.channel_width());
}
