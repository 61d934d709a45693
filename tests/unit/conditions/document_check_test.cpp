// SPDX-License-Identifier: MPL-2.0
#include <scifi/conditions/document_check.hpp>

#include <string>

#include <scifi/geometry/mice.hpp>
#include <scifi/io/geometry_json_writer.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::condition_kind;
using scifi::input_error;
using namespace scifi::test;

bool checked(condition_kind kind, const std::string& text, const std::string& file) {
  return check_document(scifi::built_in_document_checks(), kind, text, file);
}
std::string refused(const std::string& text, const std::string& file) {
  return message_of<input_error>([&] { static_cast<void>(checked(condition_kind::geometry, text, file)); });
}

}  // namespace

TEST_CASE("a geometry that the programs can read passes", "[conditions]") {
  const std::string text = scifi::geometry_to_json(scifi::mice::trackers()).dump();
  CHECK(checked(condition_kind::geometry, text, "g.json"));
  CHECK(checked(condition_kind::geometry, "\n " + text, "g"));
}

TEST_CASE("a geometry with a mistake is refused with file and field", "[conditions]") {
  CHECK(refused("", "g.json") == "g.json: the file is empty");
  CHECK(refused("{}", "g.json") == "g.json: trackers: is missing");
  CHECK(refused("trackers", "g.json").starts_with("g.json:1: is not JSON"));
  CHECK(refused("{\n{", "g.txt").starts_with("g.txt:2: is not JSON"));
  auto document = scifi::geometry_to_json(scifi::mice::trackers());
  document["fibre"]["diameter"] = -1.0;
  CHECK(refused(document.dump(), "g.json") == "g.json: fibre.diameter: -1.0 is not above zero");
}

TEST_CASE("a calibration with a mistake is refused with file and field", "[conditions]") {
  const auto says = [](const std::string& text) { return message_of<input_error>([&] { static_cast<void>(checked(condition_kind::calibration, text, "c.json")); }); };
  CHECK(says("gain 3").starts_with("c.json:1: is not JSON"));
  CHECK(says("7").starts_with("c.json: "));
}

TEST_CASE("a format without a reader passes unchecked, and says so", "[conditions]") {
  CHECK_FALSE(checked(condition_kind::geometry, "Module Tracker\n{\n}\n", "Tracker.dat"));
  CHECK_FALSE(checked(condition_kind::alignment, "{}", "a.json"));
}

TEST_CASE("an empty document is refused, unless it says that no channel is bad", "[conditions]") {
  CHECK(message_of<input_error>([] { static_cast<void>(checked(condition_kind::alignment, "", "a.txt")); }) == "a.txt: the file is empty");
  CHECK_FALSE(checked(condition_kind::bad_channels, "", "bad.txt"));
}

TEST_CASE("a check of one's own joins in", "[conditions]") {
  auto checks = scifi::built_in_document_checks();
  checks.push_back({condition_kind::alignment, [](const std::string& text, const std::string& file) {
                      if (text != "good") throw input_error(file, 1, "", "not good");
                      return true;
                    }});
  CHECK(check_document(checks, condition_kind::alignment, "good", "a"));
  CHECK_THROWS_AS(check_document(checks, condition_kind::alignment, "bad", "a"), input_error);
  CHECK_FALSE(check_document(checks, condition_kind::cabling, "bad", "a"));
}
