// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include <nlohmann/json.hpp>

#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/digit_check.hpp>
#include <scifi/io/json_field.hpp>
#include <scifi/io/line_reader.hpp>

namespace scifi {

/// Events from the JSON output of the MICE experiment's software, plain or gzip: one document a line, of which those with `recon_events`
/// hold digits, `recon_events[i].sci_fi_event.digits[j]` = {tracker, station, plane, channel, npe, ...}. One reconstructed event is one
/// event; they are numbered from 0 through the file, for MICE numbers them anew in every spill. One line is in memory at a time.
/// Throws input_error, with file, line and field, for whatever does not fit the format or the detector.
class mice_json_reader {
 public:
  mice_json_reader(const std::filesystem::path& path, const detector& d) : lines_(path, longest_line), check_(d, "digit") {}

  /// Puts number and digits of the next event into `out`, which is emptied first. False at the end of the file.
  [[nodiscard]] bool read(event& out) {
    out.clear();
    while (next_in_spill_ >= events_in_spill_) {
      if (!next_spill()) return false;
    }
    const json_field spill(document_, lines_.name(), lines_.line());
    const json_field entry = spill.at("recon_events").element(next_in_spill_++);
    out.number = number_++;
    if (!entry.has("sci_fi_event") || entry.at("sci_fi_event").is_null()) return true;
    const json_field content = entry.at("sci_fi_event");
    if (!content.value().is_object()) content.fail("is not an object");
    if (!content.has("digits") || content.at("digits").is_null()) return true;
    const json_field digits = content.at("digits");
    const std::size_t count = digits.size();
    check_.start_event(position_);
    for (std::size_t i = 0; i < count; ++i) add(digits.element(i), out);
    return true;
  }

  /// Number of the spill that the last event came from, or -1 where the document does not say.
  [[nodiscard]] int spill() const { return spill_; }
  /// The file behind it, for a progress display.
  [[nodiscard]] const text_source& source() const { return lines_.source(); }

 private:
  [[nodiscard]] bool next_spill() {
    std::string_view line;
    do {
      if (!lines_.next(line)) {
        if (lines_.line() == 0) throw input_error(lines_.name(), 0, "", "the file is empty");
        return false;
      }
    } while (line.find_first_not_of(" \t\r") == std::string_view::npos);
    document_ = parse_json(line, lines_.name(), lines_.line());
    const json_field whole(document_, lines_.name(), lines_.line());
    if (!document_.is_object()) whole.fail("the line is not a JSON object");
    next_in_spill_ = 0;
    events_in_spill_ = whole.has("recon_events") && !whole.at("recon_events").is_null() ? whole.at("recon_events").size() : 0;
    spill_ = whole.has("spill_number") ? whole.at("spill_number").whole_number() : -1;
    return true;
  }

  void add(const json_field& from, event& out) {
    const digit d{{from.at("tracker").whole_number(), from.at("station").whole_number(), from.at("plane").whole_number(), from.at("channel").whole_number()},
                  from.at("npe").number()};
    if (const auto fault = check_.fault_of(d, position_++)) from.at(fault->field).fail(fault->reason);
    out.digits.push_back(d);
  }

  static constexpr std::size_t longest_line = std::size_t{1} << 28;  // a spill with its simulation truth takes megabytes
  line_reader lines_;
  digit_check check_;
  nlohmann::json document_;
  std::size_t next_in_spill_ = 0, events_in_spill_ = 0;
  int spill_ = -1;
  long number_ = 0, position_ = 0;  // digits counted from 0 through the file
};

}  // namespace scifi
