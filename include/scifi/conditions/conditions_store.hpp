// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <scifi/conditions/condition.hpp>
#include <scifi/conditions/conditions_schema.hpp>
#include <scifi/conditions/sha256.hpp>
#include <scifi/conditions/sqlite_handle.hpp>
#include <scifi/io/input_error.hpp>

namespace scifi {

/// Documents that describe the detector, each valid for an interval of runs and recorded at some time, in one SQLite file. For a run and a time
/// the latest recorded by then whose interval holds the run is the one in force; of those recorded in the same second, the one added last.
/// Records are added, never changed or removed. Any number of processes may read while one adds; const members may be called from several
/// threads. A wrong file is an input_error, a failure of the disk a std::runtime_error.
class conditions_store {
 public:
  using access = detail::sqlite_handle::access;

  /// Opens a store; with access::write one that is not there is made. `patience`: how long to wait while another process writes.
  explicit conditions_store(const std::filesystem::path& path, access how = access::read, std::chrono::milliseconds patience = std::chrono::seconds(10))
      : database_(path, how, patience) {
    if (how == access::write) detail::make_conditions_tables(database_);
    detail::check_conditions_tables(database_);
  }

  /// Adds documents, all of them or none, and returns their records. What comes without a time is recorded `now`, or in the last second that
  /// something of the store was recorded if this clock is behind: it is to be in force. Throws std::invalid_argument for an interval that
  /// ends before it begins, a negative tracker, a time after `now`, or an empty document (bad channels excepted: there may be none).
  std::vector<condition> add(std::span<const new_condition> documents, recorded_time now = recorded_time_now()) {
    for (const new_condition& d : documents) check(d, now);
    std::vector<condition> added;
    detail::sqlite_transaction transaction(database_);
    for (const new_condition& d : documents) added.push_back(insert(d, now));
    transaction.commit();
    return added;
  }
  condition add(const new_condition& document, recorded_time now = recorded_time_now()) { return add(std::span(&document, 1), now).front(); }

  /// The condition in force, or nothing. For a tracker, records for it and for all trackers count; without, those for all trackers alone.
  [[nodiscard]] std::optional<condition> find(const condition_query& query) const {
    auto s = select("WHERE kind = ?1 AND first_run <= ?2 AND (last_run IS NULL OR ?2 <= last_run) AND (?3 IS NULL OR recorded <= ?3)"
                    " AND (tracker IS NULL OR tracker = ?4) ORDER BY recorded DESC, id DESC LIMIT 1");
    s.bind(1, name_of(query.kind)).bind(2, query.run).bind(3, seconds(query.as_of)).bind(4, query.tracker);
    if (!s.step()) return std::nullopt;
    return read(s);
  }

  /// The condition in force. Throws input_error that says what there is instead when there is none.
  [[nodiscard]] condition get(const condition_query& query) const {
    if (auto found = find(query)) return *std::move(found);
    throw input_error(database_.file(), 0, "", why_nothing(query));
  }

  /// The document of a record, compared with the length and checksum noted when it was added. Throws input_error when it is not the same
  /// or not there: a record of another store, or of one whose index is damaged.
  [[nodiscard]] std::string document(const condition& of) const {
    auto s = database_.prepare("SELECT document FROM condition WHERE id = ?1");
    s.bind(1, of.id);
    if (!s.step()) throw input_error(database_.file(), 0, "record " + std::to_string(of.id), "is not there");
    std::string text = s.bytes(0);
    if (text.size() != of.length || sha256(text) != of.sha256)
      throw input_error(database_.file(), 0, "record " + std::to_string(of.id), "is damaged: the document does not have the checksum it was stored with");
    return text;
  }

  /// All records (of a kind, recorded until `as_of`), in the order of their recording.
  [[nodiscard]] std::vector<condition> all(std::optional<condition_kind> kind = {}, std::optional<recorded_time> as_of = {}) const {
    auto s = select("WHERE (?1 = '' OR kind = ?1) AND (?2 IS NULL OR recorded <= ?2) ORDER BY recorded, id");
    s.bind(1, kind ? name_of(*kind) : "").bind(2, seconds(as_of));
    return read_all(s);
  }

  /// The records that were ever meant for a run, for all trackers or one, in the order of their recording.
  [[nodiscard]] std::vector<condition> history(condition_kind kind, run_number run, std::optional<recorded_time> as_of = {}) const {
    std::vector<condition> records = all(kind, as_of);
    std::erase_if(records, [&](const condition& c) { return !c.runs.contains(run); });
    return records;
  }

  /// The records in force for a run: of each kind what `find` gives for all trackers together and for each that has records of its own.
  [[nodiscard]] std::vector<condition> in_force(run_number run, std::optional<condition_kind> kind = {}, std::optional<recorded_time> as_of = {}) const {
    std::vector<condition> out;
    for (const condition_kind k : condition_kinds) {
      if (kind && *kind != k) continue;
      const std::vector<condition> records = history(k, run, as_of);
      // In the order of recording, so that the last to hold for somebody wins.
      const auto holds = [&](std::optional<int> tracker) {
        const auto last = std::find_if(records.rbegin(), records.rend(), [&](const condition& c) { return !c.tracker || c.tracker == tracker; });
        const bool known = last == records.rend() || std::any_of(out.begin(), out.end(), [&](const condition& c) { return c.id == last->id; });
        if (!known) out.push_back(*last);
      };
      holds(std::nullopt);
      for (const condition& c : records) holds(c.tracker);
    }
    return out;
  }

  [[nodiscard]] const std::string& file() const { return database_.file(); }

 private:
  [[nodiscard]] static std::optional<std::int64_t> seconds(std::optional<recorded_time> t) {
    if (!t) return std::nullopt;
    return std::int64_t{t->time_since_epoch().count()};
  }

  static void check(const new_condition& d, recorded_time now) {
    if (!d.runs.is_valid()) throw std::invalid_argument("the runs " + to_text(d.runs) + " are no interval from 0 on");
    if (d.tracker && *d.tracker < 0) throw std::invalid_argument("tracker " + std::to_string(*d.tracker) + " is negative");
    if (d.document.empty() && d.kind != condition_kind::bad_channels) throw std::invalid_argument("the document is empty");
    if (d.recorded && *d.recorded > now) throw std::invalid_argument("recorded " + to_text(*d.recorded) + ": that is in the future");
  }

  [[nodiscard]] condition insert(const new_condition& d, recorded_time now) {
    const recorded_time latest{std::chrono::seconds(database_.number("SELECT ifnull(max(recorded), 0) FROM condition"))};
    const recorded_time written = std::max(now, latest);
    condition c{.id = 0, .kind = d.kind, .tracker = d.tracker, .runs = d.runs, .recorded = d.recorded.value_or(written), .written = written,
                .source = d.source, .comment = d.comment, .sha256 = sha256(d.document), .length = d.document.size()};
    auto s = database_.prepare("INSERT INTO condition (kind, tracker, first_run, last_run, recorded, written, source, comment, length, sha256, document)"
                               " VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)");
    s.bind(1, name_of(c.kind)).bind(2, c.tracker).bind(3, c.runs.first);
    s.bind(4, c.runs.last == open_end ? std::nullopt : std::optional(c.runs.last)).bind(5, seconds(c.recorded)).bind(6, seconds(c.written));
    s.bind(7, c.source).bind(8, c.comment).bind(9, static_cast<std::int64_t>(c.length)).bind(10, c.sha256).bind_bytes(11, d.document);
    while (s.step()) {
    }
    c.id = database_.last_row();
    return c;
  }

  [[nodiscard]] detail::sqlite_statement select(const std::string& which) const {
    return database_.prepare("SELECT id, kind, tracker, first_run, last_run, recorded, written, source, comment, length, sha256 FROM condition " + which);
  }
  [[nodiscard]] condition read(const detail::sqlite_statement& s) const {
    const auto kind = condition_kind_from_name(s.bytes(1));
    if (!kind) throw input_error(database_.file(), 0, "record " + std::to_string(s.number(0)), "is of a kind that is not known: " + in_quotes(s.bytes(1)));
    condition c;
    c.id = s.number(0);
    c.kind = *kind;
    if (!s.is_null(2)) c.tracker = static_cast<int>(s.number(2));
    c.runs = {s.number(3), s.is_null(4) ? open_end : s.number(4)};
    c.recorded = recorded_time(std::chrono::seconds(s.number(5)));
    c.written = recorded_time(std::chrono::seconds(s.number(6)));
    c.source = s.bytes(7);
    c.comment = s.bytes(8);
    c.length = static_cast<std::size_t>(s.number(9));
    c.sha256 = s.bytes(10);
    return c;
  }
  [[nodiscard]] std::vector<condition> read_all(detail::sqlite_statement& s) const {
    std::vector<condition> out;
    while (s.step()) out.push_back(read(s));
    return out;
  }

  [[nodiscard]] std::string why_nothing(const condition_query& query) const {
    const std::string kind(name_of(query.kind));
    std::string out = "no " + kind + " for run " + std::to_string(query.run);
    if (query.tracker) out += " and tracker " + std::to_string(*query.tracker);
    if (query.as_of) out += " was known at " + to_text(*query.as_of);
    std::vector<condition> records = all(query.kind);
    if (records.empty()) return out + ": the store has no " + kind;
    const auto for_others = [&](const condition& c) { return c.tracker && c.tracker != query.tracker; };
    const auto others = std::ranges::find_if(records, [&](const condition& c) { return for_others(c) && c.runs.contains(query.run); });
    if (others != records.end()) return out + " (there is one for tracker " + std::to_string(*others->tracker) + ')';
    std::erase_if(records, for_others);
    if (records.empty()) return out + ": the store has " + kind + " for other trackers alone";
    const auto later = std::ranges::find_if(records, [&](const condition& c) { return c.runs.contains(query.run); });
    if (later != records.end()) return out + "; the first was recorded at " + to_text(later->recorded);
    out += "; there is " + kind + " for runs";
    constexpr std::size_t most = 5;
    for (std::size_t i = 0; i < std::min(most, records.size()); ++i) out += (i > 0 ? ", " : " ") + to_text(records[i].runs);
    return out + (records.size() > most ? ", ..." : "");
  }

  detail::sqlite_handle database_;
};

}  // namespace scifi
