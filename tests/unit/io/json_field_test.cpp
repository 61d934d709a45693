// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/json_field.hpp>

#include <functional>
#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::input_error;
using scifi::json_field;
using namespace scifi::test;

}  // namespace

TEST_CASE("values are reached by name and index", "[io]") {
  const auto document = nlohmann::json::parse(R"({"a": [{"b": 2.5}, "x", 7, null]})");
  const json_field root(document, "f.json");
  CHECK(root.has("a"));
  CHECK_FALSE(root.has("b"));
  CHECK(root.at("a").size() == 4);
  CHECK(root.at("a").element(0).at("b").number() == 2.5);
  CHECK(root.at("a").element(1).text() == "x");
  CHECK(root.at("a").element(2).whole_number(0, 7) == 7);
  CHECK(root.at("a").element(3).is_null());
}

TEST_CASE("what is missing or of another kind is named with the way to it", "[io]") {
  const auto document = nlohmann::json::parse(R"({"a": [{"b": "x"}, 1.5, -3], "o": {}})");
  const json_field root(document, "f.json", 4);
  struct row {
    std::function<void()> action;
    const char* message;
  };
  const json_field a = root.at("a");
  const row table[] = {
      {[&] { (void)root.at("c"); }, "f.json:4: c: is missing"},
      {[&] { (void)a.element(0).at("c"); }, "f.json:4: a[0].c: is missing"},
      {[&] { (void)a.at("c"); }, "f.json:4: a: is not an object"},
      {[&] { (void)a.element(7); }, "f.json:4: a: has no element 7"},
      {[&] { (void)root.at("o").size(); }, "f.json:4: o: is not an array"},
      {[&] { (void)a.element(0).at("b").number(); }, "f.json:4: a[0].b: '\"x\"' is not a number"},
      {[&] { (void)a.number(); }, "f.json:4: a: a list is not a number"},
      {[&] { (void)root.number(); }, "f.json:4: an object is not a number"},
      {[&] { (void)a.element(1).text(); }, "f.json:4: a[1]: is not text"},
      {[&] { (void)a.element(1).whole_number(); }, "f.json:4: a[1]: 1.5 is not a whole number"},
      {[&] { (void)a.element(2).whole_number(0, 5); }, "f.json:4: a[2]: -3 is outside 0 .. 5"},
      {[&] { (void)a.element(2).positive(); }, "f.json:4: a[2]: -3 is not above zero"},
  };
  for (const row& r : table) CHECK(message_of<input_error>(r.action) == r.message);
}

TEST_CASE("a list nested deeper than the stack where a number belongs is refused", "[io]") {
  constexpr std::size_t deep = 1'000'000;
  const nlohmann::json document = scifi::parse_json("{\"a\": " + std::string(deep, '[') + std::string(deep, ']') + "}", "f.json");
  CHECK(message_of<input_error>([&] { (void)json_field(document, "f.json").at("a").number(); }) == "f.json: a: a list is not a number");
}

TEST_CASE("a document that is not JSON is refused with the line of the mistake", "[io]") {
  const temporary_folder folder;
  const auto path = folder.file("f.json", "{\n  \"a\": 1,\n  \"b\" 2\n}\n");
  const std::string message = message_of<input_error>([&] { (void)scifi::read_json(path); });
  CHECK(message.find(path.string() + ":3: is not JSON: syntax error") == 0);
  const auto huge = folder.file("huge.json", "{\"a\": 1e999}");
  CHECK(message_of<input_error>([&] { (void)scifi::read_json(huge); }) == huge.string() + ":1: is not usable JSON: number overflow parsing '1e999'");
  const auto empty = folder.file("empty.json", "");
  CHECK(message_of<input_error>([&] { (void)scifi::read_json(empty); }) == empty.string() + ": the file is empty");
}

TEST_CASE("a document may be packed and longer than a block", "[io]") {
  const temporary_folder folder;
  const std::string text = '"' + std::string(200'000, 'x') + '"';
  CHECK(scifi::read_json(folder.file("f.json", gzip(text))).get<std::string>().size() == 200'000);
}
