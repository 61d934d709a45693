// SPDX-License-Identifier: MPL-2.0
// Small events, of which thousands are looked at in the time of one that lights everything.
#include <string_view>

#include "fuzz/absurd_digits.hpp"

namespace scifi::fuzz {

inline const registered digits_to_tracks_target("digits_to_tracks", [](std::string_view bytes) { reconstruct_absurd_digits(bytes, 60); });

}  // namespace scifi::fuzz
