// SPDX-License-Identifier: MPL-2.0
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include <scifi/conditions/conditions_store.hpp>
#include <scifi/conditions/document_check.hpp>
#include <scifi/conditions/recorded_time.hpp>
#include <scifi/conditions/validity.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

/// The bytes of a store with three records.
[[nodiscard]] inline const std::string& good_store() {
  static const std::string bytes = [] {
    const auto path = as_file("", "made");
    std::filesystem::remove(path);
    conditions_store store(path, conditions_store::access::write);
    for (const condition_kind kind : {condition_kind::geometry, condition_kind::calibration, condition_kind::bad_channels}) {
      new_condition d;
      d.kind = kind;
      d.runs = run_interval_from("7000:7999");
      d.recorded = recorded_time_from("2016-05-01T12:00:00Z");
      d.source = "where it came from";
      d.comment = "why";
      d.document = "{\"a\": 1}";
      static_cast<void>(store.add(d));
    }
    return test::content_of(path);
  }();
  return bytes;
}

/// Reads all that a store says, where it can.
inline void look_up_all(const std::filesystem::path& path) {
  const conditions_store store(path);
  for (const condition& c : store.all()) {
    static_cast<void>(to_text(c.runs) + to_text(c.recorded) + to_text(c.written));
    read_or_refuse([&] { static_cast<void>(store.document(c)); });
  }
  for (const condition_kind kind : condition_kinds) {
    condition_query query;
    query.kind = kind;
    query.run = 7500;
    read_or_refuse([&] { static_cast<void>(store.get(query)); });
    query.run = 12;
    query.tracker = 1;
    read_or_refuse([&] { static_cast<void>(store.get(query)); });
  }
  static_cast<void>(store.in_force(7500));
}

// The first byte says what the others are: a document, the text of a time or of runs, or changes to the bytes of a good store.
inline const registered conditions_target("conditions", [](std::string_view bytes) {
  const unsigned what = bytes.empty() ? 0U : static_cast<std::uint8_t>(bytes.front());
  if (!bytes.empty()) bytes.remove_prefix(1);
  if (what == 's') {
    std::string store = good_store();
    for (; bytes.size() >= 3; bytes.remove_prefix(3)) {
      const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
      store[(at(0) * std::size_t{256} + at(1)) % store.size()] = bytes[2];
    }
    const auto path = as_file(store);
    try {
      read_or_refuse([&] { look_up_all(path); });
    } catch (const std::runtime_error&) {  // what SQLite cannot make sense of
    }
    return;
  }
  try {
    if (what == 't') {
      static_cast<void>(to_text(recorded_time_from(bytes)));
    } else if (what == 'r') {
      require(run_interval_from(bytes).is_valid(), "runs are an interval");
    } else {
      const condition_kind kind = condition_kinds[what % condition_kinds.size()];
      read_or_refuse([&] { static_cast<void>(check_document(built_in_document_checks(), kind, std::string(bytes), "input.json")); });
    }
  } catch (const std::invalid_argument&) {  // a time or runs that are none
  }
});

}  // namespace scifi::fuzz
