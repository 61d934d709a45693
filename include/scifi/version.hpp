// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string_view>

/// Version of the library, semantic versioning: before 1.0 a minor version may change interfaces, a patch does not.
namespace scifi {

inline constexpr int version_major = 0;
inline constexpr int version_minor = 1;
inline constexpr int version_patch = 0;
inline constexpr std::string_view version = "0.1.0";

}  // namespace scifi
