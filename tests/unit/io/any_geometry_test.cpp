// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/any_geometry.hpp>

#include <optional>
#include <stdexcept>
#include <string>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi::test;
using scifi::any_geometry;

TEST_CASE("a geometry is told apart by its name, else by its first mark", "[io]") {
  const temporary_folder folder;
  CHECK(scifi::looks_like_json(folder / "absent.json"));
  CHECK(scifi::looks_like_json(folder / "absent.json.gz"));
  CHECK_FALSE(scifi::looks_like_json(folder / "absent.dat"));
  CHECK(scifi::looks_like_json(folder.file("a", "\n  {\"trackers\": []}")));
  CHECK(scifi::looks_like_json(folder.file("b.gz", gzip("{}"))));
  CHECK_FALSE(scifi::looks_like_json(folder.file("c", "// comment\nModule A {}\n")));
  CHECK(message_of<scifi::input_error>([&] { (void)scifi::looks_like_json(folder / "absent"); }).find("absent: cannot be opened") != std::string::npos);
}

TEST_CASE("a geometry survives JSON, field included", "[io]") {
  any_geometry g;
  g.detector = scifi::mice::trackers();
  g.fibre.core_diameter = 0.3;
  g.field = {std::optional(3.0 * scifi::units::tesla), std::nullopt};
  const temporary_folder folder;
  const any_geometry back = scifi::read_any_geometry(folder.file("a.json", scifi::geometry_to_json(g).dump()));
  CHECK(back.detector.trackers.size() == 2);
  CHECK(back.detector.trackers[0].stations[1].in_tracker.origin == g.detector.trackers[0].stations[1].in_tracker.origin);
  CHECK(back.fibre.core_diameter == 0.3);
  REQUIRE(back.field.size() == 2);
  CHECK(back.field[0].value() == Approx(3.0 * scifi::units::tesla));
  CHECK_FALSE(back.field[1].has_value());
  auto document = scifi::geometry_to_json(g);
  document["trackers"][1]["field"] = "strong";
  CHECK(message_of<scifi::input_error>([&] {
          (void)scifi::read_any_geometry(folder.file("a.json", document.dump()));
        }).find("a.json: trackers[1].field: '\"strong\"' is not a number") != std::string::npos);
}

TEST_CASE("the common field is one that all trackers have", "[io]") {
  any_geometry g;
  CHECK_FALSE(g.common_field().has_value());
  g.field = {std::nullopt, std::nullopt};
  CHECK_FALSE(g.common_field().has_value());
  g.field = {std::optional(2.0), std::optional(2.0)};
  CHECK(g.common_field() == 2.0);
  g.field = {std::optional(2.0), std::optional(-2.0)};
  CHECK_THROWS_AS(g.common_field(), std::invalid_argument);
  g.field = {std::optional(2.0), std::nullopt};
  CHECK_THROWS_AS(g.common_field(), std::invalid_argument);
}

TEST_CASE("the experiment's geometry survives the way to JSON and back", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  const any_geometry g = scifi::read_any_geometry(*data / "mice" / "geometry" / "Step_4_def_5_2.dat");
  CHECK(g.common_field().value() == Approx(4.0 * scifi::units::tesla));
  CHECK_FALSE(g.notes.empty());
  const temporary_folder folder;
  const any_geometry back = scifi::read_any_geometry(folder.file("a.json", scifi::geometry_to_json(g).dump()));
  CHECK(scifi::geometry_to_json(back) == scifi::geometry_to_json(g));
}
