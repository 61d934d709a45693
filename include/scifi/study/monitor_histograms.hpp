// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/study/distribution.hpp>
#include <scifi/track_model/helix_state.hpp>

namespace scifi::study {

/// Hits of one plane, channel by channel.
struct plane_hits {
  int station = 0;
  int plane = 0;
  std::string view;
  counts channels;
};

/// What is watched of one tracker while a reconstruction runs. Histograms without the values behind them: their memory does not grow.
class tracker_histograms {
 public:
  explicit tracker_histograms(const tracker& t) : tracker_(t.id) {
    for (const station& s : t.stations) {
      sums_.emplace_back(s.id, s.planes.size() == 3 ? s.channel_sum() : 0.0);
      for (std::size_t i = 0; i < s.planes.size(); ++i) {
        const plane& p = s.planes[i];
        planes.push_back({s.id, static_cast<int>(i), p.view, make_counts(p.channels, -0.5, p.channels - 0.5, "channel")});
      }
    }
  }

  std::vector<plane_hits> planes;
  counts light = make_counts(80, 0.0, 40.0, "light of a digit [photo-electrons]");
  counts channel_sums = make_counts(15, -3.75, 3.75, "sum of channels - expected");  ///< of space points of three clusters (Kuno's conjecture)
  counts space_points = make_counts(41, -0.5, 40.5, "space points per event");
  counts tracks = make_counts(11, -0.5, 10.5, "tracks per event");
  counts residuals = make_counts(100, -2.5, 2.5, "measured - fitted without it [mm]");
  counts pulls = make_counts(100, -5.0, 5.0, "pull of a measurement");
  counts p_values = make_counts(50, 0.0, 1.0, "probability of chi2");
  counts pt = make_counts(75, 0.0, 150.0, "pt [MeV/c]");  ///< of helices; a line has no momentum of its own
  counts pz = make_counts(100, 0.0, 400.0, "|pz| [MeV/c]");

  [[nodiscard]] int tracker_number() const { return tracker_; }

  /// A reconstructed event; what is in other trackers is passed over.
  void add(const event& e) {
    add_digits(e);
    std::size_t points = 0;
    for (const space_point& p : e.space_points) {
      if (p.tracker != tracker_) continue;
      ++points;
      add_channel_sum(e, p);
    }
    space_points(static_cast<double>(points));
    std::size_t found = 0;
    for (const track& t : e.tracks) {
      if (t.tracker != tracker_ || !t.status.ok()) continue;
      ++found;
      add_track(e, t);
    }
    tracks(static_cast<double>(found));
  }

  /// Calls visit(histogram) or visit(histogram, the same one of `other`) for all of them.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    for (std::size_t i = 0; i < planes.size(); ++i) visit(planes[i].channels, other.planes[i].channels...);
    visit(light, other.light...);
    visit(channel_sums, other.channel_sums...);
    visit(space_points, other.space_points...);
    visit(tracks, other.tracks...);
    visit(residuals, other.residuals...);
    visit(pulls, other.pulls...);
    visit(p_values, other.p_values...);
    visit(pt, other.pt...);
    visit(pz, other.pz...);
  }

 private:
  void add_digits(const event& e) {
    plane_hits* of = nullptr;
    for (const digit& d : e.digits) {
      if (d.id.tracker != tracker_) continue;
      light(d.npe);
      // Digits are sorted: mostly the plane is that of the digit before.
      if (of == nullptr || of->station != d.id.station || of->plane != d.id.plane) {
        const auto found = std::find_if(planes.begin(), planes.end(), [&](const plane_hits& p) { return p.station == d.id.station && p.plane == d.id.plane; });
        if (found == planes.end()) continue;
        of = &*found;
      }
      // A channel is a bin: no need to look for it.
      if (d.id.channel >= 0 && d.id.channel < of->channels.axis().size()) of->channels.at(d.id.channel) += 1.0;
    }
  }

  void add_channel_sum(const event& e, const space_point& p) {
    if (p.clusters.size() != 3) return;
    for (const auto& [station, expected] : sums_) {
      if (station != p.station) continue;
      double sum = -expected;
      for (const int i : p.clusters) sum += e.clusters[static_cast<std::size_t>(i)].channel;
      channel_sums(sum);
    }
  }

  void add_track(const event& e, const track& t) {
    using c = momentum_state;
    if (t.ndf > 0) p_values(t.p_value);
    if (t.shape == track_shape::helix) {
      pt(std::hypot(t.reference.mean[c::px], t.reference.mean[c::py]));
      pz(std::abs(t.reference.mean[c::pz]));
    }
    const auto first = static_cast<std::size_t>(t.first_point);
    for (std::size_t i = first; i < first + static_cast<std::size_t>(t.points); ++i) {
      const track_point& p = e.track_points[i];
      if (std::isfinite(p.residual)) residuals(p.residual);
      if (std::isfinite(p.pull)) pulls(p.pull);
    }
  }

  int tracker_;
  std::vector<std::pair<int, double>> sums_;  // station and what its channel numbers should add up to
};

/// Histograms of a running reconstruction, tracker by tracker. Merged with +=; a thread fills its own and `clear`s them for the next block of events.
class monitor_histograms {
 public:
  explicit monitor_histograms(const detector& d) {
    for (const tracker& t : d.trackers) trackers_.emplace_back(t);
  }

  void add(const event& e) {
    ++events_;
    for (tracker_histograms& t : trackers_) t.add(e);
  }
  /// Both of the same detector.
  monitor_histograms& operator+=(const monitor_histograms& other) {
    events_ += other.events_;
    for (std::size_t i = 0; i < trackers_.size(); ++i) trackers_[i].each([](counts& mine, const counts& more) { mine += more; }, other.trackers_[i]);
    return *this;
  }
  void clear() {
    events_ = 0;
    for (tracker_histograms& t : trackers_) t.each([](counts& h) { h.reset(); });
  }

  /// The number of events and every bin, under- and overflow too, in a fixed order: for another process.
  [[nodiscard]] std::vector<double> contents() {
    std::vector<double> out{static_cast<double>(events_)};
    for (tracker_histograms& t : trackers_)
      t.each([&out](counts& h) { out.insert(out.end(), h.begin(), h.end()); });
    return out;
  }
  /// Adds what `contents` gave of histograms of the same detector. False, and nothing added, where their number is another.
  [[nodiscard]] bool add_contents(std::span<const double> more) {
    std::size_t size = 1;
    for (tracker_histograms& t : trackers_) t.each([&size](counts& h) { size += h.size(); });
    if (more.size() != size) return false;
    events_ += static_cast<long>(more.front());
    std::size_t at = 1;
    for (tracker_histograms& t : trackers_)
      t.each([&](counts& h) {
        for (auto&& bin : h) bin += more[at++];
      });
    return true;
  }

  [[nodiscard]] long events() const { return events_; }
  [[nodiscard]] const std::vector<tracker_histograms>& trackers() const { return trackers_; }

 private:
  long events_ = 0;
  std::vector<tracker_histograms> trackers_;
};

}  // namespace scifi::study
