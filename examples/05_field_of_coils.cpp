// SPDX-License-Identifier: MPL-2.0
// The field of three coils, put into a map, written, read and flown through. Checked against what theory conserves in a field that is the same all
// round an axis, and against the helix, which is not the path.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include <scifi/core/units.hpp>
#include <scifi/field/coil_field.hpp>
#include <scifi/field/tabulate.hpp>
#include <scifi/io/field_map_reader.hpp>
#include <scifi/io/field_map_writer.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

using scifi::momentum_state;
using vec3 = scifi::vector<double, 3>;

/// Angular momentum about the axis with the flux inside the radius, x py - y px + q int Bz r dr: conserved (Busch, Ann. Phys. 386 (1926) 974).
double canonical(const scifi::vector<double, 5>& slopes, double z, const scifi::coil_field& field) {
  const auto p = scifi::slopes_to_momentum(slopes, +1).state;
  const double r = std::hypot(p[momentum_state::x], p[momentum_state::y]);
  constexpr int steps = 1000;
  double flux = 0.0;
  for (int i = 0; i < steps; ++i) flux += field(vec3(r * (i + 0.5) / steps, 0.0, z)).z() * r * r * (i + 0.5) / (steps * double(steps));
  return p[momentum_state::x] * p[momentum_state::py] - p[momentum_state::y] * p[momentum_state::px] + flux;
}

bool check(const char* what, double found, double limit) {
  std::printf("%-66s %9.2e, allowed %.0e\n", what, found, limit);
  return found <= limit;
}

int main() {
  // [coils]
  const vec3 along = vec3::UnitZ();
  const scifi::coil_field coils({{vec3(0.0, 0.0, 552.0), along, 1314.0, 258.0, 22.0, 125.0},  // centre, axis, length, inner radius, thickness: mm; A/mm2
                                 {vec3(0.0, 0.0, -200.0), along, 110.0, 258.0, 54.8, 125.0},
                                 {vec3(0.0, 0.0, 1304.0), along, 110.0, 258.0, 54.8, 125.0}});
  const scifi::grid_axis radii{0.0, 10.0, 21}, places{-50.0, 10.0, 121};  // first, step, count
  const auto map = scifi::tabulated(coils, radii, places, scifi::outside_map::error);
  // [coils]
  const auto path = std::filesystem::temp_directory_path() / "scifi_example_field_of_coils.map";
  std::ofstream(path) << scifi::field_map_to_text(map);

  // [flight]
  const scifi::field_map read = scifi::read_field_map(path, scifi::outside_map::error);
  const scifi::nystrom_propagator flight{read};
  const scifi::vector<double, 5> start(30.0, 0.2, -20.0, 0.1, 1.0 / 200.0);  // x, tx, y, ty, q/pz
  const auto end = flight.fly(start, scifi::stretch{0.0, 1100.0});           // from z = 0 over 1100 mm
  if (end.status != scifi::flight_status::arrived) return 1;
  // [flight]
  std::filesystem::remove(path);

  bool good = true;
  const auto exact = scifi::nystrom_propagator{coils, scifi::nystrom_options{1e-6}}.propagate(start, scifi::stretch{0.0, 1100.0});
  good = check("through the map and through the coils: distance [mm]", (end.moved.state - exact.state).head<4>().norm(), 5e-3) && good;
  const double before = canonical(start, 0.0, coils), after = canonical(exact.state, 1100.0, coils);
  good = check("change of the canonical angular momentum, relative", std::abs(after / before - 1.0), 1e-6) && good;
  const double mean = 3.32 * scifi::units::tesla;
  const double off = (scifi::helix_propagator{mean}.propagate(start, 1100.0).state - exact.state).head<4>().norm();
  std::printf("%d steps; a helix in the mean field ends %.2f mm away\n", end.steps, off);
  return good && off > 0.5 ? 0 : 1;
}
