// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <scifi/io/atomic_file.hpp>
#include <scifi/io/input_error.hpp>
#include <scifi/io/track_writer.hpp>

#include "reconstruct/check_sum.hpp"
#include "reconstruct/checkpoint.hpp"
#include "reconstruct/track_block.hpp"
#include "reconstruct/monitor.hpp"

/// The tables that a reconstruction writes, block by block, and a checkpoint beside them from which another run can go on: TRACKS.checkpoint, which stays
/// until the tables have their names.
class track_tables {
 public:
  /// `points` may be empty. `settings` is what the results depend on besides the input. Throws scifi::input_error or std::invalid_argument.
  track_tables(const std::string& tracks, const std::string& points, nlohmann::ordered_json settings, bool resume, monitor& watch)
      : watch_(watch), checkpoint_file_(scifi::atomic_file::behind_links(tracks).string() + ".checkpoint") {
    resumable_ = !scifi::atomic_file::written_in_place(tracks) && (points.empty() || !scifi::atomic_file::written_in_place(points));
    if (resume && !resumable_) throw std::invalid_argument("--resume: the tracks must go to files");
    if (resume)
      if (std::optional<checkpoint> found = checkpoint::load(checkpoint_file_)) go_on(tracks, points, settings, std::move(*found));
    if (!resumed()) {
      std::error_code none;
      if (resumable_) std::filesystem::remove(checkpoint_file_, none);
      at_.settings = std::move(settings);
      open(tracks, points);
      put(*tracks_, at_.tracks, scifi::track_columns);
      if (points_) put(*points_, at_.points, scifi::track_point_columns);
    }
  }

  /// Where this run began.
  [[nodiscard]] const std::optional<checkpoint>& resumed() const { return begun_; }
  [[nodiscard]] bool with_points() const { return points_.has_value(); }
  /// Everything that is written, of earlier runs too.
  [[nodiscard]] const totals& sum() const { return at_.sum; }

  /// Throws std::system_error when the disk is full.
  void write(const track_block& b) {
    if (!b.whole) {
      last_whole_ = at_;
      last_whole_->monitor = watch_.contents();
    }
    put(*tracks_, at_.tracks, b.tracks);
    if (points_) put(*points_, at_.points, b.points);
    at_.sum.add(b.sum);
    at_.input_check = b.input_check;
    watch_.add(b.seen);
    if (!b.whole) {
      if (last_whole_->sum.events > 0) save(*last_whole_);
      return;
    }
    const auto now = std::chrono::steady_clock::now();
    constexpr std::chrono::milliseconds pause{200};
    if (now - saved_at_ >= pause) save_here();
  }

  /// Gives the tables their names. The points first: where the tracks are, everything is. Throws std::system_error.
  void commit() {
    save_here();
    if (points_) points_->commit();
    tracks_->commit();
    std::error_code none;
    if (resumable_) std::filesystem::remove(checkpoint_file_, none);
  }

  /// Leaves what there is for another run to go on with and says so; `when` is what it came before. Nothing is kept, and said, when there is nothing.
  [[nodiscard]] std::string keep(const char* when) {
    if (at_.sum.events == 0) return {};
    if (!last_whole_) save_here();
    std::string names = tracks_->keep_partial();
    if (points_) names += ", " + points_->keep_partial();
    return fmt::format("the {} tracks of the {} events before the {} are kept in {}{}", at_.sum.tracks, at_.sum.events, when, names, saved_ ? "; --resume goes on from there" : "");
  }
  /// True where a run that ends here, however it does, can be gone on with.
  [[nodiscard]] bool saved() const { return saved_; }

 private:
  static void put(scifi::atomic_file& file, check_sum& written, std::string_view text) {
    file.write(text);
    written.add(text);
  }

  void open(const std::string& tracks, const std::string& points) {
    tracks_.emplace(tracks, at_.tracks.bytes);
    if (!points.empty()) points_.emplace(points, at_.points.bytes);
  }

  void save_here() {
    if (!resumable_ || at_.sum.events == 0) return;
    at_.monitor = watch_.contents();
    save(at_);
  }
  void save(const checkpoint& here) {
    saved_at_ = std::chrono::steady_clock::now();
    if (!resumable_ || !here.save(checkpoint_file_)) return;
    saved_ = true;
    tracks_->keep_if_abandoned();
    if (points_) points_->keep_if_abandoned();
  }

  void go_on(const std::string& tracks, const std::string& points, const nlohmann::ordered_json& settings, checkpoint found) {
    for (const auto& [name, value] : settings.items()) {
      const auto before = found.settings.find(name);
      if (before == found.settings.end() || *before != value)
        throw std::invalid_argument(fmt::format("--resume: {} is now {}, was {} in the run that {} is of; give the same options or start without --resume", name, value.dump(),
                                                before == found.settings.end() ? "nothing" : before->dump(), checkpoint_file_));
    }
    restore(tracks, found.tracks);
    if (!points.empty()) restore(points, found.points);
    at_ = found;
    watch_.set(found.monitor);
    open(tracks, points);
    saved_ = true;
    tracks_->keep_if_abandoned();
    if (points_) points_->keep_if_abandoned();
    begun_ = std::move(found);
  }

  /// Sees to it that the partial file begins as the checkpoint says. A file that already had its name when the run ended is taken back under the partial one.
  void restore(const std::string& name, const check_sum& written) const {
    namespace fs = std::filesystem;
    std::error_code none;
    const fs::path partial = scifi::atomic_file::partial_of(name);
    if (!fs::exists(partial, none) && fs::file_size(name, none) == written.bytes && check_sum::of(name) == written) fs::copy_file(name, partial);
    if (check_sum::of(partial, written.bytes) != written)
      throw scifi::input_error(partial.string(), 0, "", "does not begin as " + checkpoint_file_ + " says: it was changed, or lost when the machine stopped; start without --resume");
  }

  monitor& watch_;
  std::string checkpoint_file_;
  bool resumable_ = false, saved_ = false;
  std::optional<scifi::atomic_file> tracks_, points_;
  checkpoint at_;                         // what is written
  std::optional<checkpoint> last_whole_;  // before a block that is not whole: with another end of the input it would be another one
  std::optional<checkpoint> begun_;
  std::chrono::steady_clock::time_point saved_at_ = std::chrono::steady_clock::now();
};
