// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "shared_file.hpp"

/// A page that `scripts/web_assets` has made. Throws std::runtime_error that says where it was looked for and how to make it.
[[nodiscard]] inline std::string shared_page(const std::string& name) {
  const std::filesystem::path file = shared_file(name);
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  std::string page = text.str();
  if (page.empty())
    throw std::runtime_error(file.string() + ": the page to write into is not there; in the sources of scifi run\n    scripts/web_assets " +
                             file.parent_path().string() + "\nwhich needs Node.js and npm and downloads what the page is made of");
  return page;
}
