// SPDX-License-Identifier: MPL-2.0
#include <stdexcept>

#include "support/catch.hpp"

#include <scifi/study/momentum_bins.hpp>

using namespace scifi::study;

TEST_CASE("cells add up over the other variable, those outside the edges included", "[study]") {
  auto grid = make_momentum_grid<double>({.pt = {0, 10, 20}, .pz = {100, 200, 300}});
  grid(5.0, 150.0);
  grid(5.0, 250.0);
  grid(5.0, 900.0);
  grid(10.0, 150.0);
  grid(99.0, 150.0);
  CHECK(grid.at(0, 0) == 1.0);
  CHECK(in_pt(grid).at(0) == 3.0);
  CHECK(in_pt(grid).at(1) == 1.0);
  CHECK(in_pz(grid).at(0) == 3.0);
  CHECK(in_pz(grid).at(1) == 1.0);
}

TEST_CASE("edges that do not rise are refused", "[study]") {
  CHECK_THROWS_AS(make_momentum_grid<double>({.pt = {0, 0}, .pz = {100, 200}}), std::invalid_argument);
  CHECK_THROWS_AS(make_momentum_grid<double>({.pt = {0}, .pz = {100, 200}}), std::invalid_argument);
}
