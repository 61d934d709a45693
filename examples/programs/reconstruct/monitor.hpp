// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>

#ifdef SCIFI_HAS_STUDY
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <scifi/io/atomic_file.hpp>
#include <scifi/io/html_page.hpp>
#include <scifi/study/monitor_histograms.hpp>

#include "reconstruct/monitor_json.hpp"
#include "shared_page.hpp"

/// Watches a reconstruction: histograms in a page that is written anew every few seconds, by a thread of its own, and replaced whole. Every block of events has
/// histograms of its own, added when it is written. The page takes the new histograms over by itself. A page that cannot be written any more is reported
/// once and does not stop the reconstruction.
class monitor {
 public:
  /// Histograms of a block of events; nothing without --monitor.
  using counts = std::optional<scifi::study::monitor_histograms>;

  monitor() = default;
  monitor(const monitor&) = delete;
  monitor& operator=(const monitor&) = delete;
  ~monitor() { end("stopped"); }

  void offer(CLI::App& app) {
    CLI::Option* const page =
        app.add_option("--monitor", path_, "write histograms of what has been reconstructed so far into this page, HTML, again and again while running");
    app.add_option("--monitor-every", seconds_, "with --monitor: time between two versions of the page, s")->check(CLI::Range(0.2, 3600.0))->capture_default_str()->needs(page);
  }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Empty histograms, for a block of events.
  [[nodiscard]] counts counts_of(const scifi::detector& d) const { return path_.empty() ? counts() : counts(d); }

  /// What `contents` gave in an earlier run. Throws scifi::input_error where it does not fit. After `prepare`.
  void set(const nlohmann::ordered_json& contents) {
    if (!seen_) return;
    seen_.emplace(*detector_);
    if (!seen_->add_contents(contents.get<std::vector<double>>())) throw std::invalid_argument("--resume: the histograms are those of another detector");
  }
  [[nodiscard]] nlohmann::ordered_json contents() {
    const std::scoped_lock lock(seen_mutex_);
    return seen_ ? nlohmann::ordered_json(seen_->contents()) : nlohmann::ordered_json();
  }

  /// Gets ready to count; nothing without --monitor. Throws std::runtime_error when the page to write into is not installed.
  void prepare(const scifi::detector& d) {
    if (path_.empty()) return;
    page_ = shared_page("monitor.html");
    detector_ = d;
    seen_ = counts_of(d);
  }
  /// Writes the first page. Throws scifi::input_error when it cannot be written.
  void start(std::string input) {
    if (path_.empty()) return;
    input_ = std::move(input);
    write("running");
    writer_ = std::thread([this] { keep_writing(); });
  }

  /// Adds what was seen in a block.
  void add(const counts& block) {
    if (!block || !seen_) return;
    const std::scoped_lock lock(seen_mutex_);
    *seen_ += *block;
  }

  /// Writes the last page. Later calls do nothing.
  void end(const std::string& state) {
    if (!writer_.joinable()) return;
    {
      const std::scoped_lock lock(mutex_);
      ended_ = true;
    }
    wake_.notify_one();
    writer_.join();
    try_to_write(state);
  }

 private:
  using clock = std::chrono::steady_clock;

  void keep_writing() {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, std::chrono::duration<double>(seconds_), [this] { return ended_; })) {
      lock.unlock();
      try_to_write("running");
      lock.lock();
    }
  }

  void try_to_write(const std::string& state) {
    if (failed_) return;
    try {
      write(state);
    } catch (const std::exception& e) {
      failed_ = true;
      fmt::print(stderr, "scifi-reconstruct: --monitor: {}; the reconstruction goes on without\n", e.what());
    }
  }

  void write(const std::string& state) {
    const scifi::study::monitor_histograms seen = [this] {
      const std::scoped_lock lock(seen_mutex_);
      return *seen_;
    }();
    const double elapsed = std::chrono::duration<double>(clock::now() - begin_).count();
    const double now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    const monitor_json::json status = {{"state", state},     {"input", input_},      {"events", seen.events()}, {"elapsed_s", elapsed},
                                       {"written_at", now}, {"every_s", seconds_}, {"page", ++pages_}};
    scifi::atomic_file file(path_);
    file.write(scifi::page_with_data(page_, monitor_json::document(status, *detector_, seen).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)));
    file.commit();
  }

  std::string path_, page_, input_;
  double seconds_ = 2.0;
  std::optional<scifi::detector> detector_;
  clock::time_point begin_ = clock::now();
  std::mutex mutex_;
  std::condition_variable wake_;
  std::mutex seen_mutex_;
  counts seen_;  // under seen_mutex_
  bool ended_ = false;   // under the mutex
  bool failed_ = false;  // of the thread that writes
  long pages_ = 0;
  std::thread writer_;
};
#else
/// Without scifi::study there is nothing to watch with.
class monitor {
 public:
  struct nothing {
    void clear() {}
    void add(const scifi::event&) {}
    [[nodiscard]] std::vector<double> contents() const { return {}; }
    [[nodiscard]] bool add_contents(std::span<const double>) const { return true; }
  };
  using counts = std::optional<nothing>;
  void offer(CLI::App&) {}
  [[nodiscard]] std::string path() const { return {}; }
  [[nodiscard]] counts counts_of(const scifi::detector&) const { return {}; }
  void set(const nlohmann::ordered_json&) {}
  [[nodiscard]] nlohmann::ordered_json contents() const { return {}; }
  void prepare(const scifi::detector&) {}
  void start(const std::string&) {}
  void add(const counts&) {}
  void end(const std::string&) {}
};
#endif
