// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string_view>

// For the preprocessor, which can compare numbers only: #if SCIFI_VERSION >= 200 asks for 0.2.0 or later.
#define SCIFI_VERSION_MAJOR 0
#define SCIFI_VERSION_MINOR 1
#define SCIFI_VERSION_PATCH 0
#define SCIFI_VERSION (SCIFI_VERSION_MAJOR * 10000 + SCIFI_VERSION_MINOR * 100 + SCIFI_VERSION_PATCH)

/// Version of the library, semantic versioning: before 1.0 a minor version may change interfaces, a patch does not.
namespace scifi {

inline constexpr int version_major = SCIFI_VERSION_MAJOR;
inline constexpr int version_minor = SCIFI_VERSION_MINOR;
inline constexpr int version_patch = SCIFI_VERSION_PATCH;
inline constexpr std::string_view version = "0.1.0";

}  // namespace scifi
