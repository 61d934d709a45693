// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>

#ifdef SCIFI_HAS_STUDY
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/enumerable_thread_specific.h>

#include <scifi/io/atomic_file.hpp>
#include <scifi/io/html_page.hpp>
#include <scifi/study/monitor_histograms.hpp>

#include "reconstruct/monitor_json.hpp"
#include "shared_page.hpp"

/// Watches a reconstruction: histograms in a page that is written anew every few seconds, by a thread of its own, and replaced whole. Every thread fills its own histograms. The page takes
/// the new histograms over by itself. A page that cannot be written any more is reported once and does not stop the reconstruction.
class monitor {
 public:
  /// Histograms of a thread, and who may touch them.
  struct of_thread {
    explicit of_thread(const scifi::detector& d) : seen(d) {}
    of_thread(const of_thread& other) : seen(other.seen) {}
    std::mutex mutex;
    scifi::study::monitor_histograms seen;
  };
  /// The calling thread's, held as long as this lives: for a block of events.
  class watcher {
   public:
    explicit watcher(of_thread* where) : where_(where) {
      if (where_ != nullptr) lock_ = std::unique_lock(where_->mutex);
    }
    void add(const scifi::event& e) {
      if (where_ != nullptr) where_->seen.add(e);
    }

   private:
    of_thread* where_;
    std::unique_lock<std::mutex> lock_;
  };

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

  /// Writes the first page; nothing without --monitor. Throws std::runtime_error when the page to write into is not installed, scifi::input_error when
  /// it cannot be written.
  void start(const scifi::detector& d, std::string input) {
    if (path_.empty()) return;
    page_ = shared_page("monitor.html");
    detector_ = d;
    input_ = std::move(input);
    threads_.emplace([this] { return of_thread(*detector_); });
    write("running");
    writer_ = std::thread([this] { keep_writing(); });
  }

  [[nodiscard]] watcher watch() { return watcher(detector_ ? &threads_->local() : nullptr); }

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
    scifi::study::monitor_histograms seen(*detector_);
    for (of_thread& t : *threads_) {
      const std::scoped_lock lock(t.mutex);
      seen += t.seen;
    }
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
  std::optional<tbb::enumerable_thread_specific<of_thread>> threads_;
  bool ended_ = false;   // under the mutex
  bool failed_ = false;  // of the thread that writes
  long pages_ = 0;
  std::thread writer_;
};
#else
/// Without scifi::study there is nothing to watch with.
class monitor {
 public:
  struct watcher {
    void add(const scifi::event&) {}
  };
  void offer(CLI::App&) {}
  [[nodiscard]] std::string path() const { return {}; }
  void start(const scifi::detector&, const std::string&) {}
  [[nodiscard]] watcher watch() { return {}; }
  void end(const std::string&) {}
};
#endif
