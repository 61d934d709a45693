// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <filesystem>
#include <string>

/// A file that goes with the programs: SCIFI_SHARED_FROM_BIN is the way to it from their folder, in the build tree as after an installation.
[[nodiscard]] inline std::filesystem::path shared_file(const std::string& name) {
  return (std::filesystem::canonical("/proc/self/exe").parent_path() / SCIFI_SHARED_FROM_BIN / name).lexically_normal();
}
