// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

#include <scifi/geometry/mice.hpp>
#include <scifi/io/input_error.hpp>

#include "support/temporary_folder.hpp"

namespace scifi::fuzz {

/// Something that takes any bytes: it returns, or it is a defect. `name` is that of its folder in the corpus.
struct target {
  std::string_view name;
  void (*run)(std::string_view bytes);
};

/// The targets that are linked into this program.
[[nodiscard]] inline std::vector<target>& targets() {
  static std::vector<target> all;
  return all;
}

/// Adds a target before main begins.
struct registered {
  registered(std::string_view name, void (*run)(std::string_view)) { targets().push_back({name, run}); }
};

/// Ends the program where a promise is broken, so that the input is kept.
inline void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

/// Does what may be refused with an input_error, and nothing else.
template <class Action>
void read_or_refuse(const Action& action) {
  try {
    action();
  } catch (const input_error& e) {
    require(*e.what() != '\0', "an error says what is wrong");
  }
}

/// The bytes as a file of this name, which is rewritten at each call.
[[nodiscard]] inline std::filesystem::path as_file(std::string_view bytes, const char* name = "input") {
  static const test::temporary_folder folder;
  return folder.file(name, bytes);
}

/// The detector that readers hold their tables against.
[[nodiscard]] inline const detector& trackers() {
  static const detector both = mice::trackers();
  return both;
}

}  // namespace scifi::fuzz
