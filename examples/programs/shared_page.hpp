// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

/// A page that `scripts/web_assets` has made: `../share/scifi/NAME` as seen from the program, in a build folder as after an installation.
/// Throws std::runtime_error that says where it was looked for and how to make it.
[[nodiscard]] inline std::string shared_page(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  const fs::path prefix = program.parent_path().parent_path();
  const fs::path file = prefix / "share" / "scifi" / name;
  std::ifstream stream(file, std::ios::binary);
  std::string page;
  if (stream) {
    const auto size = fs::file_size(file, none);
    page.resize(none ? 0 : static_cast<std::size_t>(size));
    stream.read(page.data(), static_cast<std::streamsize>(page.size()));
    page.resize(static_cast<std::size_t>(stream.gcount()));
  }
  if (page.empty()) {
    throw std::runtime_error(file.string() + ": the page to write into is not there; in the sources of scifi run\n    scripts/web_assets " + prefix.string() +
                             "\nwhich needs Node.js and npm and downloads what the page is made of");
  }
  return page;
}
