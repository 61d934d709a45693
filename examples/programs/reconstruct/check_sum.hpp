// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>
#include <vector>

#include <zlib.h>

/// CRC-32 of bytes, and of the beginning of a file.
struct check_sum {
  std::uintmax_t bytes = 0;
  std::uint32_t check = 0;

  void add(const void* what, std::size_t size) {
    check = static_cast<std::uint32_t>(::crc32_z(check, static_cast<const Bytef*>(what), size));
    bytes += size;
  }
  void add(std::string_view text) { add(text.data(), text.size()); }
  friend bool operator==(const check_sum&, const check_sum&) = default;

  /// Of the first `most` bytes of a file, or of as many as there are; of none where it cannot be read.
  [[nodiscard]] static check_sum of(const std::filesystem::path& file, std::uintmax_t most = std::numeric_limits<std::uintmax_t>::max()) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> buffer(std::size_t{1} << 18);
    check_sum out;
    while (out.bytes < most && stream) {
      stream.read(buffer.data(), static_cast<std::streamsize>(std::min<std::uintmax_t>(most - out.bytes, buffer.size())));
      out.add(buffer.data(), static_cast<std::size_t>(stream.gcount()));
    }
    return out;
  }
};
