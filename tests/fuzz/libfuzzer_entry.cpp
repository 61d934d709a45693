// SPDX-License-Identifier: MPL-2.0
// Gives the one target that is linked with it to libFuzzer.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  scifi::fuzz::targets().front().run(std::string_view(reinterpret_cast<const char*>(data), size));
  return 0;
}
