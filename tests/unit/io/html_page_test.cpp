// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/html_page.hpp>

#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "support/catch.hpp"

TEST_CASE("data cannot end the element they stand in and are read back as they were", "[io]") {
  const nlohmann::json data = {{"title", "</script><script>alert(1)</script><!-- \\ \" \u00b5"}, {"x", {1.5, -2}}};
  const std::string page = scifi::page_with_data("<p>before</p><script>@SCIFI_DATA@</script><p>after</p>", data.dump());
  const std::string before = "<p>before</p><script>";
  const std::string after = "</script><p>after</p>";
  REQUIRE(page.size() > before.size() + after.size());
  CHECK(page.substr(0, before.size()) == before);
  CHECK(page.substr(page.size() - after.size()) == after);
  const std::string between = page.substr(before.size(), page.size() - before.size() - after.size());
  CHECK(between.find('<') == std::string::npos);
  CHECK(nlohmann::json::parse(between) == data);
}

TEST_CASE("a page without a place for data is refused", "[io]") {
  CHECK_THROWS_AS(scifi::page_with_data("<html></html>", "{}"), std::invalid_argument);
}
