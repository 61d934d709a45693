// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/event/event.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/event_rows.hpp>
#include <scifi/io/track_point_reader.hpp>
#include <scifi/io/track_reader.hpp>
#include <scifi/io/truth_reader.hpp>

#include "reconstruct/chains.hpp"
#include "reconstruct/event_source.hpp"

/// Events put together from the files that tell of them: digits, tracks, track points, truth, each where it was given. Clusters and space points are made
/// of the digits here, and the tracks too where no file of tracks was given.
class display_events {
 public:
  struct files {
    std::string digits, tracks, track_points, truth;
  };

  /// The detector must outlive it. Throws scifi::input_error.
  display_events(const files& from, const scifi::detector& d, const scifi::reconstruction_options& choice)
      : detector_(d), chain_(make_chain(d, choice)) {
    clusters_.min_npe = choice.min_npe;
    clusters_.resolution.fibre = choice.fibre;
    if (!from.digits.empty()) digits_.emplace(from.digits, d);
    if (!from.tracks.empty()) tracks_.emplace(from.tracks, d);
    if (!from.track_points.empty()) points_.emplace(from.track_points, d);
    if (!from.truth.empty()) truth_.emplace(from.truth, d);
    advance();
  }

  /// The next event that has digits or tracks; false at the end. Throws scifi::input_error.
  [[nodiscard]] bool read(scifi::event& out, scifi::truth& true_event) {
    const long in_tracks = tracks_ ? tracks_->next_event() : scifi::event_rows::no_more;
    const bool with_digits = more_digits_ && next_.number <= in_tracks;
    const long number = with_digits ? next_.number : in_tracks;
    if (number == scifi::event_rows::no_more) return false;
    out.clear();
    if (with_digits) {
      out = next_;
      advance();
      add_space_points(out);
    }
    out.number = number;
    if (tracks_) tracks_->read(number, out);
    if (points_) read_points(number, out);
    true_event.clear();
    if (truth_) read_truth(number, true_event);
    return true;
  }

 private:
  void advance() { more_digits_ = digits_ && digits_->read(next_); }

  /// Tracks first, where they are looked for, of all consistent triplets; then, to be seen, those space points that share no cluster.
  void add_space_points(scifi::event& e) {
    if (!tracks_) reconstruct(chain_, {&e, 1}, work_);
    else clusters_(detector_, e.digits, e.clusters);
    e.candidates.clear();
    e.space_points.clear();
    scifi::space_point_finder::buffers work;
    for (const scifi::tracker& t : detector_.trackers) scifi::space_point_finder{}(t, e.clusters, e.space_points, work);
  }

  // Rows of events that are passed over have to be read past; track points of an event without tracks are a mistake that the reader finds.
  void read_points(long number, scifi::event& e) {
    scifi::event none;
    while (points_->next_event() < number) points_->read(points_->next_event(), none);
    points_->read(number, e);
  }
  void read_truth(long number, scifi::truth& t) {
    while (truth_->next_event() < number) truth_->read(truth_->next_event(), t.crossings);
    truth_->read(number, t.crossings);
  }

  const scifi::detector& detector_;
  helix_chain chain_;
  helix_chain::buffers work_;
  scifi::cluster_finder<scifi::fibre_resolution> clusters_;
  std::optional<event_source> digits_;
  std::optional<scifi::track_reader> tracks_;
  std::optional<scifi::track_point_reader> points_;
  std::optional<scifi::truth_reader> truth_;
  scifi::event next_;
  bool more_digits_ = false;
};
