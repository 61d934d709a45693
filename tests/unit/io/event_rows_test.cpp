// SPDX-License-Identifier: MPL-2.0
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

#include <scifi/io/event_rows.hpp>

using namespace scifi;

TEST_CASE("rows come event by event, and events without a row are passed over", "[io]") {
  const test::temporary_folder folder;
  event_rows rows(folder.file("a.csv", "x,event\n1,2\n2,2\n3,7\n"), {"x"});
  std::vector<int> seen;
  const auto visit = [&](const csv_reader& row) { seen.push_back(row.whole_number<int>(1)); };
  CHECK(rows.next_event() == 2);
  rows.read(1, visit);
  CHECK(seen.empty());
  rows.read(2, visit);
  CHECK(seen == std::vector<int>{1, 2});
  CHECK(rows.next_event() == 7);
  rows.read(5, visit);
  rows.read(7, visit);
  CHECK(seen.size() == 3);
  CHECK(rows.next_event() == event_rows::no_more);
}

TEST_CASE("a table out of order is refused with its line", "[io]") {
  const test::temporary_folder folder;
  const auto path = folder.file("a.csv", "event,x\n2,1\n3,1\n2,1\n");
  const std::string message = test::message_of<input_error>([&] {
    event_rows rows(path, {"x"});
    for (long n = 0; n < 5; ++n) rows.read(n, [](const csv_reader&) {});
  });
  CHECK(test::without(path.string(), message) == ":4: event: 2 comes after 3: the rows of an event must stand together and event numbers must grow");
  const auto negative = folder.file("b.csv", "event,x\n-1,1\n");
  CHECK(test::without(negative.string(), test::message_of<input_error>([&] { event_rows(negative, {"x"}); })) == ":2: event: event numbers must not be negative");
  const auto largest = folder.file("c.csv", "event,x\n9223372036854775806,1\n9223372036854775807,1\n");
  CHECK(test::without(largest.string(), test::message_of<input_error>([&] { event_rows(largest, {"x"}).read(9223372036854775806, [](const csv_reader&) {}); })) ==
        ":3: event: 9223372036854775807 is too large for an event number");
}
