// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_json_writer.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <scifi/geometry/mice.hpp>
#include <scifi/io/line_reader.hpp>
#include <scifi/io/mice_json.hpp>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::append_mice_spill;
using scifi::digit;
using namespace scifi::test;

/// The geometry of the published file has planes of up to 214 channels in an order of its own.
scifi::detector wide_trackers() {
  scifi::detector d = scifi::mice::trackers();
  for (auto& t : d.trackers)
    for (auto& s : t.stations)
      for (auto& p : s.planes) p.channels = 214;
  return d;
}

std::vector<std::vector<digit>> events_of(const std::filesystem::path& path) {
  std::vector<std::vector<digit>> out;
  const scifi::detector d = wide_trackers();
  scifi::mice_json_reader reader(path, d);
  for (scifi::event e; reader.read(e);) out.push_back(e.digits);
  return out;
}

bool same(const std::vector<digit>& a, const std::vector<digit>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].id != b[i].id || a[i].npe != b[i].npe) return false;
  return true;
}

/// Names of the members of an object and kinds of their values: "npe number, not whole".
std::set<std::string> shape(const nlohmann::json& object) {
  std::set<std::string> out;
  for (const auto& member : object.items())
    out.insert(member.key() + ' ' + member.value().type_name() + (member.value().is_number_float() ? ", not whole" : ""));
  return out;
}

}  // namespace

TEST_CASE("a spill is a line that is read back exactly", "[io]") {
  std::string text;
  const std::vector<digit> digits = {{{0, 1, 2, 111}, 13.949896090594210}, {{1, 5, 0, 7}, 1.0 / 3.0}, {{1, 5, 0, 8}, 2.0}, {{1, 5, 0, 9}, 1.0e21}};
  append_mice_spill(text, 4, digits, 7417);
  append_mice_spill(text, 5, {});
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
  const temporary_folder folder;
  const auto path = folder.file("a.json", text);
  const auto back = events_of(path);
  REQUIRE(back.size() == 2);
  CHECK(same(back[0], digits));
  CHECK(back[1].empty());
  scifi::mice_json_reader reader(path, scifi::mice::trackers());
  scifi::event e;
  REQUIRE(reader.read(e));
  CHECK(reader.spill() == 4);
}

TEST_CASE("a number that is none of a spill or a run is refused", "[io]") {
  std::string text;
  CHECK(message_of<std::invalid_argument>([&] { append_mice_spill(text, 3000000000, {}); }) ==
        "event 3000000000 cannot be the number of a spill: that is 0 .. 2147483647");
  CHECK_THROWS_AS(append_mice_spill(text, -1, {}), std::invalid_argument);
  CHECK_THROWS_AS(append_mice_spill(text, 0, {}, -1), std::invalid_argument);
  CHECK(text.empty());
}

TEST_CASE("the experiment's digits go through unchanged, in documents of the same shape", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  const auto original = *data / "mice" / "test_helical_digits.json";
  const auto events = events_of(original);
  REQUIRE(events.size() == 5);
  std::string text;
  for (std::size_t i = 0; i < events.size(); ++i) append_mice_spill(text, static_cast<long>(i) + 1, events[i]);
  const temporary_folder folder;
  const auto written = folder.file("a.json", text);
  const auto back = events_of(written);
  REQUIRE(back.size() == 5);
  for (std::size_t i = 0; i < events.size(); ++i) CHECK(same(back[i], events[i]));

  scifi::line_reader lines(original);
  std::string_view line;
  nlohmann::json theirs;
  while (!theirs.contains("recon_events") && lines.next(line)) theirs = nlohmann::json::parse(line);
  theirs.erase("mc_events");  // the truth of a simulation
  const nlohmann::json ours = nlohmann::json::parse(text.substr(0, text.find('\n')));
  CHECK(shape(ours) == shape(theirs));
  const auto& our_event = ours["recon_events"][0];
  const auto& their_event = theirs["recon_events"][0];
  CHECK(shape(our_event) == shape(their_event));
  CHECK(shape(our_event["sci_fi_event"]) == shape(their_event["sci_fi_event"]));
  CHECK(shape(our_event["sci_fi_event"]["digits"][0]) == shape(their_event["sci_fi_event"]["digits"][0]));
}
