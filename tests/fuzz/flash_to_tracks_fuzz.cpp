// SPDX-License-Identifier: MPL-2.0
// Events that light much of the detector.
#include <string_view>

#include "fuzz/absurd_digits.hpp"

namespace scifi::fuzz {

inline const registered flash_to_tracks_target("flash_to_tracks", [](std::string_view bytes) { reconstruct_absurd_digits(bytes, 20000); });

}  // namespace scifi::fuzz
