// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace scifi::test {

/// Folder of external data sets: the environment variable SCIFI_SHARED_DATA, else the folder CMake was configured with.
/// Empty without one; the caller then returns, and the executable, unless something failed, reports itself as skipped.
std::optional<std::filesystem::path> shared_data();

}  // namespace scifi::test
