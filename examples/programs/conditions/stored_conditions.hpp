// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#ifdef SCIFI_HAS_CONDITIONS
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <scifi/conditions/conditions_store.hpp>
#include <scifi/io/atomic_file.hpp>

/// Documents of a conditions store in place of files named on the command line: --conditions STORE --run N [--as-of DATE].
class stored_conditions {
 public:
  stored_conditions() = default;
  stored_conditions(const stored_conditions&) = delete;
  stored_conditions& operator=(const stored_conditions&) = delete;
  ~stored_conditions() {
    std::error_code none;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, none);
  }

  void offer(CLI::App& app) {
    CLI::Option* const store = app.add_option("--conditions", store_, "store of conditions (scifi-conditions) to take from what is not given as a file");
    CLI::Option* const run = app.add_option("--run", run_, "with --conditions: number of the run");
    CLI::Option* const as_of = app.add_option("--as-of", as_of_, "with --conditions: as known on that day or at that time (UTC); now unless given");
    store->needs(run);
    run->needs(store);
    as_of->needs(store);
  }

  /// Sets `path`, if it is empty and a store was given, to a file with the document of that kind; the file lives as long as this object.
  void fill_in(std::string& path, scifi::condition_kind kind) {
    if (store_.empty() || !path.empty()) return;
    scifi::condition_query query{.kind = kind, .run = 0, .as_of = {}, .tracker = {}};
    const char* option = "--run";
    try {
      query.run = scifi::run_number_from(run_);
      option = "--as-of";
      if (!as_of_.empty()) query.as_of = scifi::recorded_time_from(as_of_, scifi::date_alone::last_second);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(std::string(option) + ": " + e.what());
    }
    const scifi::conditions_store store(store_);
    const scifi::condition found = store.get(query);
    for (const scifi::condition& c : store.in_force(query.run, kind, query.as_of))
      if (c.id != found.id)
        throw scifi::input_error(store_, 0, fmt::format("record {}", c.id),
                                 fmt::format("is in force for tracker {} alone, where one {} for all trackers is needed", c.tracker.value_or(-1), name_of(kind)));
    const std::string document = store.document(found);
    const std::filesystem::path file = folder() / fmt::format("{}_record_{}", name_of(kind), found.id);
    scifi::atomic_file out(file);
    out.write(document);
    out.commit();
    path = file.string();
    names_[path] = fmt::format("record {} of {} ({}, runs {}, recorded {})", found.id, store_, found.source, to_text(found.runs), scifi::to_text(found.recorded));
  }

  /// What a user should be told that a file is: the record it came from, or its own name.
  [[nodiscard]] std::string origin(const std::string& path) const {
    const auto found = names_.find(path);
    return found == names_.end() ? path : found->second;
  }
  [[nodiscard]] const std::string& store() const { return store_; }

 private:
  [[nodiscard]] const std::filesystem::path& folder() {
    if (folder_.empty()) {
      std::string name = (std::filesystem::temp_directory_path() / "scifi_conditions_XXXXXX").string();
      if (::mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name + ": could not be made");
      folder_ = name;
    }
    return folder_;
  }

  std::string store_, run_, as_of_;
  std::filesystem::path folder_;
  std::map<std::string, std::string> names_;
};

#else

namespace scifi {
enum class condition_kind { geometry, calibration, cabling, bad_channels, alignment };
}

/// Built without SQLite: there is no store to take anything from.
class stored_conditions {
 public:
  void offer(CLI::App&) {}
  void fill_in(std::string&, scifi::condition_kind) {}
  [[nodiscard]] const std::string& origin(const std::string& path) const { return path; }
  [[nodiscard]] const std::string& store() const { return store_; }

 private:
  std::string store_;
};

#endif
