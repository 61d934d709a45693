// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/geometry_json.hpp>

#include <cmath>
#include <functional>
#include <string>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace {

using nlohmann::json;
using scifi::detector;
using scifi::input_error;
using namespace scifi::test;

json one_tracker() {
  return json::parse(R"({
    "channel_width": 1.5, "fiducial_radius": 100.0,
    "planes": [
      {"plane": 0, "view": "X", "angle": 0.0, "channels": 100, "central_channel": 49.5, "z_mylar": [0.0, 0.1], "z_fibres": [0.1, 0.7]},
      {"plane": 1, "view": "Y", "angle": 90.0, "channels": 120, "central_channel": 59.5, "z_mylar": [1.0, 1.1], "z_fibres": [1.1, 1.7]}],
    "trackers": [{"tracker": 3, "name": "T", "beam_direction": 1, "stations": [
      {"station": 1, "position": [0.0, 0.0, 0.0]},
      {"station": 2, "position": [1.0, -2.0, 300.0], "rotation": 0.5},
      {"station": 4, "position": [0.0, 0.0, 600.0]}]}]})");
}

}  // namespace

TEST_CASE("a geometry document is read by the rules of a fibre plane", "[io]") {
  const detector d = scifi::geometry_from_json(one_tracker(), "f.json");
  REQUIRE(d.trackers.size() == 1);
  const scifi::tracker& t = d.trackers[0];
  CHECK(t.id == 3);
  CHECK(t.name == "T");
  CHECK(t.fiducial_radius == 100.0);
  CHECK(t.gas.name == "helium");
  REQUIRE(t.stations.size() == 3);
  CHECK(t.stations[2].id == 4);
  CHECK(t.stations[1].in_tracker.origin.y() == -2.0);
  CHECK(t.stations[1].in_tracker.angle == Approx(0.5 * scifi::units::degree));
  REQUIRE(t.stations[0].planes.size() == 2);
  const scifi::plane& p = t.stations[0].planes[1];
  CHECK(p.view == "Y");
  CHECK(p.angle == Approx(90.0 * scifi::units::degree));
  CHECK(p.channels == 120);
  CHECK(p.channel_width == 1.5);
  CHECK(p.z_reference == 1.0);
  CHECK(p.z_measured == Approx(1.4));
  REQUIRE(p.below.size() == 2);
  REQUIRE(p.above.size() == 1);
  CHECK(p.below[0].medium.name == "mylar");
  CHECK(p.below[1].thickness == Approx(0.3));
  CHECK(p.above[0].thickness == Approx(0.3));
  // The two planes of the station are one layer.
  const double layer = 2.0 * (0.1 / scifi::materials::mylar.radiation_length + 0.6 / scifi::materials::polystyrene.radiation_length);
  for (const scifi::slab& s : {p.below[0], p.below[1], p.above[0]}) CHECK(s.layer_radiation_lengths == Approx(layer));
}

TEST_CASE("a plane may be given by its slabs, each with a layer of its own", "[io]") {
  json document = one_tracker();
  json& p = document["planes"][1];
  p.erase("z_mylar");
  p.erase("z_fibres");
  p["z_reference"] = 1.0;
  p["z_measured"] = 1.5;
  p["below"] = {{{"material", "mylar"}, {"thickness", 0.5}, {"layer_radiation_lengths", 0.25}}};
  p["above"] = {{{"material", "helium"}, {"thickness", 0.1}}, {{"material", "mylar"}, {"thickness", 0.2}}};
  const detector d = scifi::geometry_from_json(document, "f.json");
  const scifi::plane& read = d.trackers[0].stations[0].planes[1];
  CHECK(read.z_measured == 1.5);
  REQUIRE(read.below.size() == 1);
  REQUIRE(read.above.size() == 2);
  CHECK(read.below[0].layer_radiation_lengths == 0.25);
  CHECK(read.above[0].medium.name == "helium");
  CHECK(read.above[1].layer_radiation_lengths == Approx(0.2 / scifi::materials::mylar.radiation_length));
}

TEST_CASE("materials of the file are used", "[io]") {
  json document = one_tracker();
  document["materials"] = {{"mylar", {{"radiation_length", 300.0}}}, {"air", json::object()}};
  document["trackers"][0]["gas"] = "air";
  const detector d = scifi::geometry_from_json(document, "f.json");
  CHECK(d.trackers[0].gas.name == "air");
  CHECK(d.trackers[0].stations[0].planes[0].below[0].medium.radiation_length == 300.0);
  CHECK(d.trackers[0].stations[0].planes[0].above[0].medium.radiation_length == scifi::materials::polystyrene.radiation_length);
}

TEST_CASE("a wrong geometry is refused with file, field and reason", "[io]") {
  struct row {
    std::function<void(json&)> spoil;
    const char* message;
  };
  const row table[] = {
      {[](json& d) { d = 5; }, "f.json: the document is not an object"},
      {[](json& d) { d["format"] = "other"; }, "f.json: format: 'other' is not 'scifi-geometry'"},
      {[](json& d) { d["version"] = 2; }, "f.json: version: version 2 is newer than version 1, the newest that can be read"},
      {[](json& d) { d["version"] = 0; }, "f.json: version: 0 is outside 1 .. 2147483647"},
      {[](json& d) { d["version"] = "1"; }, "f.json: version: '\"1\"' is not a number"},
      {[](json& d) {
         d["units"] = {{"length", "cm"}};
       },
       "f.json: units.length: 'cm' is not 'mm'"},
      {[](json& d) {
         d["units"] = {{"angle", "rad"}};
       },
       "f.json: units.angle: 'rad' is not 'degree'"},
      {[](json& d) { d["materials"] = 3; }, "f.json: materials: is not an object"},
      {[](json& d) { d["materials"]["mylar"]["radiation_length"] = -1; }, "f.json: materials.mylar.radiation_length: -1 is not above zero"},
      {[](json& d) { d["materials"]["foam"] = json::object(); }, "f.json: materials.foam.density_g_cm3: is missing"},
      {[](json& d) { d.erase("trackers"); }, "f.json: trackers: is missing"},
      {[](json& d) { d["trackers"] = json::array(); }, "f.json: trackers: names no tracker"},
      {[](json& d) { d["trackers"].push_back(d["trackers"][0]); }, "f.json: trackers[1].tracker: tracker 3 is given twice"},
      {[](json& d) { d["trackers"][0].erase("tracker"); }, "f.json: trackers[0].tracker: is missing"},
      {[](json& d) { d["trackers"][0]["tracker"] = -1; }, "f.json: trackers[0].tracker: -1 is outside 0 .. 2147483647"},
      {[](json& d) { d["trackers"][0]["beam_direction"] = 0; }, "f.json: trackers[0].beam_direction: is neither 1 nor -1"},
      {[](json& d) { d["trackers"][0]["gas"] = "argon"; }, "f.json: trackers[0].gas: 'argon' is not among the materials of the file"},
      {[](json& d) { d["trackers"][0]["stations"] = json::array(); }, "f.json: trackers[0].stations: names no station"},
      {[](json& d) { d["trackers"][0]["stations"] = json::array_t(17); }, "f.json: trackers[0].stations: more than 16 stations"},
      {[](json& d) { d["trackers"][0]["stations"][1]["station"] = 1; }, "f.json: trackers[0].stations[1].station: station numbers do not grow"},
      {[](json& d) {
         d["trackers"][0]["stations"][0]["position"] = {0, 0};
       },
       "f.json: trackers[0].stations[0].position: is not three numbers"},
      {[](json& d) { d["trackers"][0]["stations"][0]["position"][1] = "x"; }, "f.json: trackers[0].stations[0].position[1]: '\"x\"' is not a number"},
      {[](json& d) { d["trackers"][0]["stations"][1]["position"][2] = 1.0; },
       "f.json: trackers[0].stations[1].position: the station does not lie behind the one before it in z"},
      {[](json& d) { d["trackers"][0]["stations"][1]["rotation"] = "left"; }, "f.json: trackers[0].stations[1].rotation: '\"left\"' is not a number"},
      {[](json& d) { d.erase("planes"); }, "f.json: planes: is missing"},
      {[](json& d) { d["planes"] = json::array(); }, "f.json: planes: names no plane"},
      {[](json& d) { d["planes"] = json::array_t(5); }, "f.json: planes: more than 4 planes in a station"},
      {[](json& d) { d["planes"][1]["plane"] = 2; }, "f.json: planes[1].plane: is not 1: planes are numbered from 0 in order of growing z"},
      {[](json& d) { d["planes"][0]["channels"] = 0; }, "f.json: planes[0].channels: 0 is outside 1 .. 1000000"},
      {[](json& d) { d["planes"][0]["channels"] = 10.5; }, "f.json: planes[0].channels: 10.5 is not a whole number"},
      {[](json& d) { d["planes"][0].erase("angle"); }, "f.json: planes[0].angle: is missing"},
      {[](json& d) {
         d["planes"][0]["z_mylar"] = {0.1, 0.0};
       },
       "f.json: planes[0].z_mylar: does not grow"},
      {[](json& d) { d["planes"][0]["z_mylar"] = {0.1}; }, "f.json: planes[0].z_mylar: is not two numbers"},
      {[](json& d) {
         d["planes"][0]["z_fibres"] = {0.2, 0.7};
       },
       "f.json: planes[0].z_fibres: the fibres do not begin where the mylar ends"},
      {[](json& d) {
         d["planes"][1]["z_mylar"] = {0.5, 0.6};
         d["planes"][1]["z_fibres"] = {0.6, 1.2};
       },
       "f.json: planes[1]: the plane begins before the one below it ends"},
      {[](json& d) {
         d["planes"][0]["channels"] = d["planes"][1]["channels"] = 1000000;
         for (int i = 5; i < 8; ++i) d["trackers"][0]["stations"].push_back({{"station", i}, {"position", {0, 0, 300 * i}}});
       },
       "f.json: trackers: have 12000000 channels, more than 10000000"},
      {[](json& d) { d["channel_width"] = 0; }, "f.json: channel_width: 0 is not above zero"},
      {[](json& d) { d.erase("fiducial_radius"); }, "f.json: fiducial_radius: is missing"},
      {[](json& d) { d["planes"][1]["z_measured"] = 1.0; }, "f.json: planes[1].z_reference: is missing"},
      {[](json& d) {
         d["planes"][1] = {{"plane", 1}, {"angle", 0}, {"channels", 5}, {"central_channel", 2}, {"z_reference", 1.0}, {"z_measured", 1.5}};
         d["planes"][1]["below"] = {{{"material", "mylar"}, {"thickness", 0.4}}};
         d["planes"][1]["above"] = json::array();
       },
       "f.json: planes[1].below: its thicknesses do not reach from z_reference to z_measured"},
  };
  CHECK_NOTHROW(scifi::geometry_from_json(one_tracker(), "f.json"));
  for (const row& r : table) {
    json document = one_tracker();
    r.spoil(document);
    CHECK(message_of<input_error>([&] { (void)scifi::geometry_from_json(document, "f.json"); }) == r.message);
  }
}

TEST_CASE("a geometry file that is not there or not JSON is refused", "[io]") {
  const temporary_folder folder;
  CHECK(message_of<input_error>([&] { (void)scifi::read_geometry(folder / "none.json"); }).find("none.json: cannot be opened") != std::string::npos);
  const auto path = folder.file("a.json", "{\"planes\": [\n{]\n");
  CHECK(message_of<input_error>([&] { (void)scifi::read_geometry(path); }).find(path.string() + ":2: is not JSON") == 0);
}

TEST_CASE("fibres are as the file says, and as in MICE where it says nothing", "[io]") {
  const scifi::fibre_doublet f =
      scifi::fibre_from_json(json::parse(R"({"fibre": {"diameter": 0.5, "core_diameter": 0.45, "fibres_per_channel": 3}})"), "f.json");
  CHECK(f.diameter == 0.5);
  CHECK(f.core_diameter == 0.45);
  CHECK(f.fibres_per_channel == 3);
  CHECK(f.pitch == scifi::fibre_doublet{}.pitch);
  CHECK(scifi::fibre_from_json(json::parse(R"({"fibre": {"mylar_thickness": 0}})"), "f.json").mylar_thickness == 0.0);
  const auto negative = json::parse(R"({"fibre": {"mylar_thickness": -0.1}})");
  CHECK(message_of<input_error>([&] { (void)scifi::fibre_from_json(negative, "f.json"); }) == "f.json: fibre.mylar_thickness: is negative");
  const auto core_too_large = json::parse(R"({"fibre": {"diameter": 0.3, "core_diameter": 0.45}})");
  CHECK(message_of<input_error>([&] { (void)scifi::fibre_from_json(core_too_large, "f.json"); }) == "f.json: fibre.core_diameter: is larger than the diameter");
}

TEST_CASE("the surveyed trackers of the library are those of the geometry file of the simulation", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  const detector ours = scifi::mice::trackers();
  const detector theirs = scifi::read_geometry(*data / "g4" / "geometry.json");
  const double printed = 1.1e-4;  // mm: the file gives four decimals; three planes add up
  REQUIRE(theirs.trackers.size() == ours.trackers.size());
  for (std::size_t i = 0; i < ours.trackers.size(); ++i) {
    const scifi::tracker& a = ours.trackers[i];
    const scifi::tracker& b = theirs.trackers[i];
    CHECK(a.id == b.id);
    CHECK(a.name == b.name);
    CHECK(a.beam_direction == b.beam_direction);
    CHECK(a.fiducial_radius == b.fiducial_radius);
    CHECK(a.gas.density == Approx(b.gas.density).epsilon(1e-6));
    CHECK(a.gas.radiation_length == Approx(b.gas.radiation_length).epsilon(1e-4));
    REQUIRE(a.stations.size() == b.stations.size());
    for (std::size_t j = 0; j < a.stations.size(); ++j) {
      CHECK(a.stations[j].id == b.stations[j].id);
      CHECK((a.stations[j].in_tracker.origin - b.stations[j].in_tracker.origin).norm() < 1e-12);
      CHECK(a.stations[j].in_tracker.angle == b.stations[j].in_tracker.angle);
      REQUIRE(a.stations[j].planes.size() == b.stations[j].planes.size());
      for (std::size_t k = 0; k < a.stations[j].planes.size(); ++k) {
        const scifi::plane& p = a.stations[j].planes[k];
        const scifi::plane& q = b.stations[j].planes[k];
        CHECK(p.view == q.view);
        CHECK(p.angle == Approx(q.angle));
        CHECK(p.channels == q.channels);
        CHECK(p.central_channel == q.central_channel);
        CHECK(p.channel_width == Approx(q.channel_width));
        CHECK(p.z_reference == Approx(q.z_reference).margin(printed));
        CHECK(p.z_measured == Approx(q.z_measured).margin(printed));
        REQUIRE(p.below.size() == q.below.size());
        REQUIRE(p.above.size() == q.above.size());
        const auto same = [printed](const scifi::slab& s, const scifi::slab& t) {
          CHECK(s.medium.name == t.medium.name);
          CHECK(s.thickness == Approx(t.thickness).margin(printed));
          CHECK(s.layer_radiation_lengths == Approx(t.layer_radiation_lengths).epsilon(1e-3));
          CHECK(s.medium.z_over_a == Approx(t.medium.z_over_a).epsilon(1e-4));
          // The file's mylar is 0.7 % less dense than the PDG's, at the same radiation length in g/cm2.
          CHECK(s.medium.density == Approx(t.medium.density).epsilon(0.008));
          CHECK(s.medium.radiation_length == Approx(t.medium.radiation_length).epsilon(0.008));
          CHECK(s.medium.density_effect.c == Approx(t.medium.density_effect.c).margin(0.008));
        };
        for (std::size_t n = 0; n < p.below.size(); ++n) same(p.below[n], q.below[n]);
        for (std::size_t n = 0; n < p.above.size(); ++n) same(p.above[n], q.above[n]);
      }
    }
  }
}
