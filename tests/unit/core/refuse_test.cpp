// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/refuse.hpp>

#include <stdexcept>
#include <string>

#include "support/catch.hpp"

TEST_CASE("a wrong configuration is refused with the error and the message given", "[core]") {
  CHECK_THROWS_AS(scifi::detail::refuse<std::length_error>("too long"), std::length_error);
  try {
    scifi::detail::refuse<std::invalid_argument>("a tracker without stations");
  } catch (const std::exception& e) {
    CHECK(std::string(e.what()) == "a tracker without stations");
  }
}
