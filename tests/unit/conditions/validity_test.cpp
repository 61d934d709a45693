// SPDX-License-Identifier: MPL-2.0
#include <scifi/conditions/validity.hpp>

#include <stdexcept>
#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::open_end;
using scifi::run_interval;
using scifi::run_interval_from;
using scifi::test::message_of;

std::string refused(const char* text) {
  return message_of<std::invalid_argument>([&] { static_cast<void>(run_interval_from(text)); });
}

}  // namespace

TEST_CASE("an interval holds both its ends and nothing beyond", "[conditions]") {
  constexpr run_interval runs{7000, 7999};
  CHECK_FALSE(runs.contains(6999));
  CHECK(runs.contains(7000));
  CHECK(runs.contains(7999));
  CHECK_FALSE(runs.contains(8000));
  CHECK(run_interval{7000, open_end}.contains(open_end - 1));
}

TEST_CASE("an interval is read as it is written", "[conditions]") {
  for (const auto& [text, runs] : {std::pair{"7000:7999", run_interval{7000, 7999}}, std::pair{"7000:", run_interval{7000, open_end}},
                                   std::pair{"7000", run_interval{7000, 7000}}, std::pair{"0:", run_interval{0, open_end}}}) {
    CHECK(run_interval_from(text) == runs);
    CHECK(to_text(runs) == text);
  }
  CHECK(run_interval_from("5:5") == run_interval{5, 5});
}

TEST_CASE("a text that is no interval is refused with the reason", "[conditions]") {
  CHECK(refused("") == "'' is not the number of a run");
  CHECK(refused(":") == "'' is not the number of a run");
  CHECK(refused(":7999") == "'' is not the number of a run");
  CHECK(refused("x") == "'x' is not the number of a run");
  CHECK(refused("7000-7999") == "'7000-7999' is not the number of a run");
  CHECK(refused("-1:3") == "'-1' is not the number of a run");
  CHECK(refused("1:2:3") == "'2:3' is not the number of a run");
  CHECK(refused(" 7") == "' 7' is not the number of a run");
  CHECK(refused("7.5") == "'7.5' is not the number of a run");
  CHECK(refused("8000:7999") == "'8000:7999' ends before it begins");
  CHECK(refused("1:99999999999999999999") == "'99999999999999999999' is too large for a run");
  CHECK(refused("9223372036854775807") == "'9223372036854775807' is too large for a run");
  CHECK_FALSE(run_interval{-1, 3}.is_valid());
}
