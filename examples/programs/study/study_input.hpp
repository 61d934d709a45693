// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <scifi/event/event.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/track_point_reader.hpp>
#include <scifi/io/track_reader.hpp>
#include <scifi/io/truth_reader.hpp>

#include "reconstruct/event_source.hpp"

namespace scifi::study_program {

/// What the files say about one event.
struct event_files {
  long number = 0;
  std::vector<crossing> crossings;
  event seen;  ///< digits, tracks and their points
};

/// Digits of events in rising order of their numbers, one event ahead.
class digits_ahead {
 public:
  digits_ahead(const std::string& path, const detector& d) : path_(path), source_(path, d) { advance(); }

  [[nodiscard]] long next_event() const { return more_ ? next_.number : event_rows::no_more; }

  void read(long number, std::vector<digit>& out) {
    out.clear();
    if (next_event() != number) return;
    std::swap(out, next_.digits);
    advance();
    if (more_ && next_.number <= number) throw input_error(path_, 0, "", "event " + std::to_string(next_.number) + " comes after event " + std::to_string(number));
  }

 private:
  void advance() { more_ = source_.read(next_); }

  std::string path_;
  event_source source_;
  event next_;
  bool more_ = false;
};

/// The files of a study side by side, event by event.
class study_input {
 public:
  /// Empty names: no such file. The detector must outlive this. Throws input_error.
  study_input(const detector& d, const std::string& truth, const std::string& tracks, const std::string& points, const std::string& digits)
      : truth_(truth, d), tracks_(tracks, d) {
    if (truth_.next_event() == event_rows::no_more) throw input_error(truth, 0, "", "no particle crosses a plane: there is nothing to compare with");
    if (!points.empty()) points_.emplace(points, d);
    if (!digits.empty()) digits_.emplace(digits, d);
  }

  /// The next event that any file knows; false at the end. Throws input_error.
  [[nodiscard]] bool next(event_files& out) {
    out.number = std::min(truth_.next_event(), tracks_.next_event());
    if (points_) out.number = std::min(out.number, points_->next_event());
    if (digits_) out.number = std::min(out.number, digits_->next_event());
    if (out.number == event_rows::no_more) return false;
    out.seen.clear();
    out.seen.number = out.number;
    truth_.read(out.number, out.crossings);
    tracks_.read(out.number, out.seen);
    if (points_) points_->read(out.number, out.seen);
    if (digits_) digits_->read(out.number, out.seen.digits);
    return true;
  }

 private:
  truth_reader truth_;
  track_reader tracks_;
  std::optional<track_point_reader> points_;
  std::optional<digits_ahead> digits_;
};

}  // namespace scifi::study_program
