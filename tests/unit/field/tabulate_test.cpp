// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/tabulate.hpp>

#include <cmath>

#include <scifi/field/coil_field.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

const coil_field solenoid({{vector<double, 3>::Zero(), vector<double, 3>::UnitZ(), 600.0, 258.0, 40.0, 110.0}});

/// Largest distance from the field in the space of a tracker, over the field in the middle.
template <class Map>
double worst(const Map& map) {
  double out = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double phi = 2.4 * i, radius = 150.0 * std::sqrt((i + 0.5) / 300.0), z = -500.0 + 1000.0 * std::fmod(0.618 * i, 1.0);
    const vector<double, 3> at(radius * std::cos(phi), radius * std::sin(phi), z);
    out = std::max(out, (map(at) - solenoid(at)).norm());
  }
  return out / solenoid(vector<double, 3>(0.0, 0.0, 0.0)).norm();
}

auto round_map(double step) { return tabulated(solenoid, {0.0, step, static_cast<std::size_t>(160.0 / step) + 1}, {-500.0, step, static_cast<std::size_t>(1000.0 / step) + 1}, outside_map::error); }

}  // namespace

TEST_CASE("a map of coils comes to the coils with the third power of its cells", "[field]") {
  const double coarse = worst(round_map(20.0)), fine = worst(round_map(10.0));
  CHECK(coarse < 2e-4);
  CHECK(std::log2(coarse / fine) > 2.5);
  const auto linear = tabulated<linear_interpolation>(solenoid, {0.0, 10.0, 17}, {-500.0, 10.0, 101}, outside_map::error);
  CHECK(worst(linear) > 5.0 * fine);
  const grid_axis across{-160.0, 20.0, 17};
  CHECK(worst(tabulated(solenoid, across, across, {-500.0, 20.0, 51}, outside_map::error)) < 3e-4);
}
