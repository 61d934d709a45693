// SPDX-License-Identifier: MPL-2.0
#include <scifi/conditions/conditions_store.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::condition;
using scifi::condition_kind;
using scifi::condition_query;
using scifi::conditions_store;
using scifi::input_error;
using scifi::new_condition;
using scifi::open_end;
using scifi::recorded_time;
using scifi::run_interval;
using namespace scifi::test;

constexpr auto writing = conditions_store::access::write;

recorded_time at(const char* text) { return scifi::recorded_time_from(text); }

new_condition geometry(run_interval runs, const char* recorded, const char* document = "{}") {
  return {.kind = condition_kind::geometry, .tracker = {}, .runs = runs, .recorded = at(recorded), .source = "g.json", .comment = "", .document = document};
}

/// The documents that were handed in, in order of their handing in, and the rule of the look-up applied to each: what the store must agree with.
struct oracle {
  std::vector<new_condition> given;

  static bool meant_for(const new_condition& c, const condition_query& q) {
    if (c.kind != q.kind) return false;
    if (q.run < c.runs.first || q.run > c.runs.last) return false;
    return !c.tracker.has_value() || c.tracker == q.tracker;
  }
  std::optional<std::string> document(const condition_query& q) const {
    const new_condition* best = nullptr;
    for (const new_condition& c : given) {
      if (!meant_for(c, q) || (q.as_of && *c.recorded > *q.as_of)) continue;
      if (best == nullptr || *c.recorded >= *best->recorded) best = &c;
    }
    return best == nullptr ? std::nullopt : std::optional(best->document);
  }
};

class dice {
 public:
  explicit dice(unsigned seed) : engine_(seed) {}
  int up_to(int n) { return std::uniform_int_distribution<int>(0, n)(engine_); }
  std::optional<int> tracker() {
    const int t = up_to(3);
    return t < 2 ? std::nullopt : std::optional(t - 2);
  }
  condition_kind kind() { return up_to(1) == 0 ? condition_kind::geometry : condition_kind::cabling; }
  // Few seconds and few runs, so that records often overlap and often share a second.
  recorded_time time() { return at("2015-01-01") + std::chrono::seconds(up_to(30)); }

 private:
  std::mt19937 engine_;
};

}  // namespace

TEST_CASE("a look-up agrees with the rule applied to every record, whatever was recorded", "[conditions]") {
  const temporary_folder folder;
  dice random(20151105);
  oracle expected;
  conditions_store store(folder / "a.db", writing);
  std::size_t found = 0;
  std::size_t missing = 0;
  for (int round = 0; round < 10; ++round) {
    std::vector<new_condition> batch;
    for (int i = 0; i < 6; ++i) {
      const int first = random.up_to(40);
      const run_interval runs{first, random.up_to(3) == 0 ? open_end : first + random.up_to(8)};
      const std::string document = "document " + std::to_string(round) + '/' + std::to_string(i);
      batch.push_back({random.kind(), random.tracker(), runs, random.time(), "source", "comment", document});
    }
    store.add(batch);
    expected.given.insert(expected.given.end(), batch.begin(), batch.end());
    for (int i = 0; i < 400; ++i) {
      condition_query q{.kind = random.kind(), .run = random.up_to(60), .as_of = {}, .tracker = random.tracker()};
      if (random.up_to(4) > 0) q.as_of = random.time() - std::chrono::seconds(2);
      const auto should_be = expected.document(q);
      const auto is = store.find(q);
      REQUIRE(is.has_value() == should_be.has_value());
      if (is) REQUIRE(store.document(*is) == *should_be);
      ++(is ? found : missing);
    }
  }
  CHECK(found > 1000);
  CHECK(missing > 500);

  // What is in force for a run is what the look-ups give, each once; its history is what was ever meant for it.
  for (int run = 0; run < 50; ++run) {
    std::vector<std::string> should_be;
    for (const condition_kind kind : {condition_kind::geometry, condition_kind::cabling})
      for (const std::optional<int> tracker : {std::optional<int>(), std::optional(0), std::optional(1)})
        if (const auto d = expected.document({.kind = kind, .run = run, .as_of = {}, .tracker = tracker})) should_be.push_back(*d);
    std::vector<std::string> is;
    for (const condition& c : store.in_force(run)) is.push_back(store.document(c));
    std::ranges::sort(should_be);
    should_be.erase(std::unique(should_be.begin(), should_be.end()), should_be.end());
    std::ranges::sort(is);
    CHECK(is == should_be);
    const auto meant = std::ranges::count_if(expected.given, [&](const new_condition& c) { return c.kind == condition_kind::cabling && c.runs.contains(run); });
    const auto history = store.history(condition_kind::cabling, run);
    CHECK(static_cast<std::ptrdiff_t>(history.size()) == meant);
    CHECK(std::ranges::is_sorted(history, [](const condition& a, const condition& b) { return std::pair(a.recorded, a.id) < std::pair(b.recorded, b.id); }));
  }
}

TEST_CASE("what was known on a day does not change when more is recorded later", "[conditions]") {
  const temporary_folder folder;
  conditions_store store(folder / "a.db", writing);
  const condition_query then{.kind = condition_kind::geometry, .run = 7500, .as_of = at("2015-12-01"), .tracker = {}};
  store.add(geometry({7000, 7999}, "2015-11-05", "survey"));
  CHECK(store.document(store.get(then)) == "survey");
  store.add(geometry({7400, 7600}, "2016-03-01", "aligned"));
  CHECK(store.document(store.get(then)) == "survey");
  condition_query now = then;
  now.as_of.reset();
  CHECK(store.document(store.get(now)) == "aligned");
  now.run = 7399;
  CHECK(store.document(store.get(now)) == "survey");
  now.as_of = at("2015-11-05");
  CHECK(store.document(store.get(now)) == "survey");
  *now.as_of -= std::chrono::seconds(1);
  CHECK_FALSE(store.find(now));
}

TEST_CASE("a record keeps every byte and word of what was handed in", "[conditions]") {
  const temporary_folder folder;
  std::string bytes;
  for (int i = 0; i < 100'000; ++i) bytes += static_cast<char>(i * 7 % 256);
  const new_condition given{condition_kind::bad_channels, 1, {5, open_end}, at("2015-11-05T14:30:00Z"), "it's \"a\" file", "50 % better; \xc3\xa9", bytes};
  const recorded_time now = at("2020-01-01");
  const condition added = conditions_store(folder / "a.db", writing).add(given, now);
  const conditions_store store(folder / "a.db");
  const auto records = store.all();
  REQUIRE(records.size() == 1);
  const condition& c = records.front();
  CHECK(c.id == added.id);
  CHECK(c.kind == given.kind);
  CHECK(c.tracker == given.tracker);
  CHECK(c.runs == given.runs);
  CHECK(c.recorded == *given.recorded);
  CHECK(c.written == now);
  CHECK(c.source == given.source);
  CHECK(c.comment == given.comment);
  CHECK(c.length == bytes.size());
  CHECK(c.sha256 == scifi::sha256(bytes));
  CHECK(store.document(c) == bytes);
}

TEST_CASE("there may be no bad channels", "[conditions]") {
  const temporary_folder folder;
  conditions_store store(folder / "a.db", writing);
  new_condition none = geometry({1, 2}, "2015-01-01", "");
  none.kind = condition_kind::bad_channels;
  CHECK(store.document(store.add(none)).empty());
}

TEST_CASE("what comes without a time is recorded now and in force, even if this clock is behind", "[conditions]") {
  const temporary_folder folder;
  conditions_store store(folder / "a.db", writing);
  new_condition without_time = geometry({0, open_end}, "2000-01-01", "first");
  without_time.recorded.reset();
  CHECK(store.add(without_time, at("2015-11-05T12:00")).recorded == at("2015-11-05T12:00"));
  without_time.document = "second";
  CHECK(store.add(without_time, at("2015-11-05T11:00")).recorded == at("2015-11-05T12:00"));
  CHECK(store.document(store.get({.kind = condition_kind::geometry, .run = 1, .as_of = {}, .tracker = {}})) == "second");
  const recorded_time before = scifi::recorded_time_now();
  const condition real = store.add(without_time);
  CHECK(real.recorded >= before);
  CHECK(real.recorded <= scifi::recorded_time_now());
}

TEST_CASE("documents are added together or not at all", "[conditions]") {
  const temporary_folder folder;
  conditions_store store(folder / "a.db", writing);
  std::vector<new_condition> batch{geometry({1, 2}, "2015-01-01"), geometry({3, 2}, "2015-01-01")};
  CHECK(message_of<std::invalid_argument>([&] { store.add(batch); }) == "the runs 3:2 are no interval from 0 on");
  CHECK(store.all().empty());
  batch[1].runs = {3, 4};
  batch[1].document.clear();
  CHECK(message_of<std::invalid_argument>([&] { store.add(batch); }) == "the document is empty");
  batch[1].document = "x";
  batch[1].tracker = -1;
  CHECK(message_of<std::invalid_argument>([&] { store.add(batch); }) == "tracker -1 is negative");
  batch[1].tracker = 0;
  batch[1].recorded = at("2015-01-02");
  CHECK(message_of<std::invalid_argument>([&] { store.add(batch, at("2015-01-01")); }) == "recorded 2015-01-02T00:00:00Z: that is in the future");
  CHECK(store.all().empty());
  CHECK(store.add(batch).size() == 2);
  CHECK(store.all().size() == 2);
}

TEST_CASE("a look-up that finds nothing says what there is", "[conditions]") {
  const temporary_folder folder;
  conditions_store store(folder / "a.db", writing);
  const auto says = [&](const condition_query& q) {
    return without((folder / "a.db").string(), message_of<input_error>([&] { static_cast<void>(store.get(q)); }));
  };
  const condition_query query{.kind = condition_kind::geometry, .run = 8000, .as_of = {}, .tracker = {}};
  CHECK(says(query) == ": no geometry for run 8000: the store has no geometry");
  new_condition one_tracker = geometry({8000, 8100}, "2015-01-01");
  one_tracker.tracker = 1;
  store.add(one_tracker);
  CHECK(says(query) == ": no geometry for run 8000 (there is one for tracker 1)");
  condition_query other = query;
  other.run = 9000;
  other.tracker = 0;
  CHECK(says(other) == ": no geometry for run 9000 and tracker 0: the store has geometry for other trackers alone");
  store.add(geometry({7000, 7999}, "2015-11-05"));
  store.add(geometry({9500, open_end}, "2015-11-05"));
  CHECK(says(other) == ": no geometry for run 9000 and tracker 0; there is geometry for runs 7000:7999, 9500:");
  condition_query early = query;
  early.run = 7500;
  early.as_of = at("2015-11-04");
  CHECK(says(early) == ": no geometry for run 7500 was known at 2015-11-04T00:00:00Z; the first was recorded at 2015-11-05T00:00:00Z");
}

TEST_CASE("a document that was tampered with is not handed out", "[conditions]") {
  const temporary_folder folder;
  conditions_store store(folder / "a.db", writing);
  const condition c = store.add(geometry({1, 2}, "2015-01-01", "right"));
  scifi::detail::sqlite_handle tool(folder / "a.db", writing, std::chrono::milliseconds(50));
  const std::string guard = "CREATE TRIGGER condition_never_updated BEFORE UPDATE ON condition BEGIN SELECT RAISE(ABORT, 'no'); END";
  tool.run("DROP TRIGGER condition_never_updated; UPDATE condition SET document = CAST('wrong' AS BLOB); " + guard);
  CHECK(message_of<input_error>([&] { static_cast<void>(conditions_store(folder / "a.db").document(c)); }) ==
        (folder / "a.db").string() + ": record 1: is damaged: the document does not have the checksum it was stored with");
  const condition elsewhere{.id = 99, .kind = c.kind, .tracker = {}, .runs = c.runs, .recorded = c.recorded, .written = c.written, .source = "", .comment = "", .sha256 = "", .length = 0};
  CHECK(message_of<input_error>([&] { static_cast<void>(store.document(elsewhere)); }) == (folder / "a.db").string() + ": record 99: is not there");
}

TEST_CASE("a store opened for reading takes nothing", "[conditions]") {
  const temporary_folder folder;
  CHECK(message_of<input_error>([&] { conditions_store(folder / "a.db"); }) == (folder / "a.db").string() + ": cannot be opened: there is no such file");
  { const conditions_store made(folder / "a.db", writing); }
  conditions_store store(folder / "a.db");
  CHECK_THROWS_AS(store.add(geometry({1, 2}, "2015-01-01")), input_error);
  CHECK(store.all().empty());
}

TEST_CASE("a damaged file is refused", "[conditions]") {
  const temporary_folder folder;
  {
    conditions_store store(folder / "a.db", writing);
    store.add(geometry({1, 2}, "2015-01-01", std::string(50'000, 'x').c_str()));
  }
  const std::string whole = content_of(folder / "a.db");
  const auto truncated = folder.file("b.db", whole.substr(0, whole.size() / 2));
  CHECK_THROWS_AS(conditions_store(truncated).document(conditions_store(truncated).get({.kind = condition_kind::geometry, .run = 1, .as_of = {}, .tracker = {}})),
                  input_error);
  std::string header = whole;
  header[0] = 'X';
  CHECK(message_of<input_error>([&] { conditions_store(folder.file("c.db", header)); }) ==
        (folder / "c.db").string() + ": is not a conditions store: it is no SQLite database");
}

TEST_CASE("several threads look up while another adds", "[conditions]") {
  const temporary_folder folder;
  conditions_store writer(folder / "a.db", writing);
  writer.add(geometry({0, open_end}, "2015-01-01", "0"));
  const conditions_store shared(folder / "a.db");
  std::atomic<bool> done = false;
  std::atomic<int> wrong = 0;
  const auto look = [&](const conditions_store& store) {
    std::int64_t last = 0;
    while (!done) {
      const condition c = store.get({.kind = condition_kind::geometry, .run = 3, .as_of = {}, .tracker = {}});
      if (c.id < last || store.document(c) != std::to_string(c.id - 1)) ++wrong;
      last = c.id;
    }
  };
  std::vector<std::thread> readers;
  for (int i = 0; i < 2; ++i) readers.emplace_back([&] { look(shared); });
  readers.emplace_back([&] { look(conditions_store(folder / "a.db")); });
  for (int i = 1; i <= 30; ++i) writer.add(geometry({0, open_end}, "2015-01-01", std::to_string(i).c_str()));
  done = true;
  for (std::thread& t : readers) t.join();
  CHECK(wrong == 0);
  CHECK(shared.all().size() == 31);
}
