// SPDX-License-Identifier: MPL-2.0
#if __has_include(<catch2/catch_session.hpp>)
#include <catch2/catch_session.hpp>
#else
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#endif

#include <cstdlib>
#include <iostream>

#include <support/shared_data.hpp>

namespace {

constexpr int skipped = 77;  // CTest is told so by SKIP_RETURN_CODE
bool data_was_missing = false;

}  // namespace

std::optional<std::filesystem::path> scifi::test::shared_data() {
  const char* const set = std::getenv("SCIFI_SHARED_DATA");
  const std::filesystem::path folder = set != nullptr ? set : SCIFI_SHARED_DATA_DEFAULT;
  if (!folder.empty() && std::filesystem::is_directory(folder)) return folder;
  std::cerr << "skipped: needs external data, SCIFI_SHARED_DATA names no folder\n";
  data_was_missing = true;
  return std::nullopt;
}

int main(int argc, char* argv[]) {
  const int result = Catch::Session().run(argc, argv);
  return result == 0 && data_was_missing ? skipped : result;
}
