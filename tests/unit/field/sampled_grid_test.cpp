// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/sampled_grid.hpp>

#include <cmath>
#include <initializer_list>
#include <stdexcept>

#include <scifi/field/interpolation.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

const grid_axis first{0.0, 2.0, 5}, second{-3.0, 1.5, 6};

/// Component 0 odd, component 1 even in u; both parabolas in v.
std::array<double, 2> smooth(double u, double v) { return {u * (1.0 + v - 0.3 * v * v), (4.0 - u * u) * (2.0 + v * v)}; }

template <class Interpolation>
sampled_grid<2, 2, Interpolation> filled(const std::array<int, 2>& parity) {
  std::vector<std::array<double, 2>> values;
  for (std::size_t i = 0; i < first.count; ++i)
    for (std::size_t k = 0; k < second.count; ++k) values.push_back(smooth(first.at(i), second.at(k)));
  return {{first, second}, values, parity};
}

template <class Grid>
auto sample(const Grid& grid, double u, double v) {
  return grid.template sample<double>({place_on(first, u), place_on(second, v)});
}

}  // namespace

TEST_CASE("every interpolation gives the number at the points of the grid", "[field]") {
  const auto linear = filled<linear_interpolation>({0, 0});
  const auto cubic = filled<cubic_interpolation>({-1, 1});
  for (std::size_t i = 0; i < first.count; ++i)
    for (std::size_t k = 0; k < second.count; ++k)
      for (std::size_t c = 0; c < 2; ++c) {
        const double expected = smooth(first.at(i), second.at(k))[c];
        CHECK(linear.at({i, k})[c] == expected);
        CHECK(sample(linear, first.at(i), second.at(k)).value[c] == Approx(expected).margin(1e-13));
        CHECK(sample(cubic, first.at(i), second.at(k)).value[c] == Approx(expected).margin(1e-13));
      }
}

TEST_CASE("cubic interpolation of parabolas is exact up to the edges, slopes too, with or without the symmetry", "[field]") {
  for (const std::array<int, 2>& parity : {std::array{0, 0}, std::array{-1, 1}}) {
    const auto grid = filled<cubic_interpolation>(parity);
    for (const double u : {0.0, 0.7, 4.1, 8.0})
      for (const double v : {-3.0, -2.9, 0.2, 4.5}) {
        INFO("u " << u << " v " << v);
        const auto got = sample(grid, u, v);
        CHECK(got.value[0] == Approx(smooth(u, v)[0]).margin(1e-12));
        CHECK(got.value[1] == Approx(smooth(u, v)[1]).margin(1e-12));
        CHECK(got.slope[0][0] == Approx(1.0 + v - 0.3 * v * v).margin(1e-12));
        CHECK(got.slope[0][1] == Approx(u * (1.0 - 0.6 * v)).margin(1e-12));
        CHECK(got.slope[1][0] == Approx(-2.0 * u * (2.0 + v * v)).margin(1e-12));
        CHECK(got.slope[1][1] == Approx((4.0 - u * u) * 2.0 * v).margin(1e-12));
      }
  }
}

TEST_CASE("beyond an edge the number is that of the edge, without a slope", "[field]") {
  const auto grid = filled<cubic_interpolation>({0, 0});
  CHECK(sample(grid, 100.0, 1.0).value[1] == Approx(smooth(8.0, 1.0)[1]));
  CHECK(sample(grid, 100.0, 1.0).slope[1][0] == 0.0);
  CHECK(sample(grid, 100.0, 1.0).slope[1][1] == Approx((4.0 - 64.0) * 2.0));
}

TEST_CASE("a grid that is too small or has other than its number of values is refused", "[field]") {
  using grid = sampled_grid<2, 2, linear_interpolation>;
  const std::vector<std::array<double, 2>> six(6);
  CHECK_THROWS_AS(grid({grid_axis{0.0, 1.0, 2}, grid_axis{0.0, 1.0, 3}}, six), std::invalid_argument);
  CHECK_THROWS_AS(grid({grid_axis{0.0, 1.0, 3}, grid_axis{0.0, 1.0, 3}}, six), std::invalid_argument);
  CHECK_THROWS_AS(grid({grid_axis{0.0, 0.0, 3}, grid_axis{0.0, 1.0, 3}}, std::vector<std::array<double, 2>>(9)), std::invalid_argument);
}
