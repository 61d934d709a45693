// SPDX-License-Identifier: MPL-2.0
// Fields that are not uniform: what one value with its gradient costs, and a flight with Jacobian over the 1100 mm of a tracker beside the exact helix.
// Each map and each flight is compared with the coils before it is timed.

#include <benchmark/benchmark.h>

#include <cmath>

#include <scifi/core/units.hpp>
#include <scifi/field/automatic_gradient.hpp>
#include <scifi/field/coil_field.hpp>
#include <scifi/field/tabulate.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

namespace {

using position = scifi::vector<double, 3>;

const scifi::coil_field coils({{position(0.0, 0.0, 552.0), position::UnitZ(), 1314.0, 258.0, 22.0, 125.0},
                               {position(0.0, 0.0, -200.0), position::UnitZ(), 110.0, 258.0, 54.8, 125.0},
                               {position(0.0, 0.0, 1304.0), position::UnitZ(), 110.0, 258.0, 54.8, 125.0}});
const scifi::grid_axis along{-100.0, 20.0, 66}, across{-200.0, 20.0, 21}, radii{0.0, 20.0, 11};

const auto& round_map() {
  static const auto map = scifi::tabulated(coils, radii, along, scifi::outside_map::error);
  return map;
}
const auto& square_map() {
  static const auto map = scifi::tabulated(coils, across, across, along, scifi::outside_map::error);
  return map;
}

template <class Field>
void one_value(benchmark::State& state, const Field& field) {
  constexpr double tolerance = 1e-3;  // of the field: the interpolation on cells of 20 mm
  position at(31.0, -57.0, 333.0);
  if (!((field(at) - coils(at)).norm() < tolerance * coils(at).norm())) return state.SkipWithError("the field is not that of the coils");
  for (auto _ : state) {
    at.z() = at.z() < 900.0 ? at.z() + 7.3 : at.z() - 800.0;
    benchmark::DoNotOptimize(field.with_gradient(at));
  }
}

template <class Flight>
void flight(benchmark::State& state, const Flight& fly, double tolerance) {
  scifi::vector<double, 5> start(30.0, 0.2, -20.0, 0.1, 1.0 / 200.0);
  const auto exact = scifi::nystrom_propagator{coils, scifi::nystrom_options{1e-6}}.propagate(start, scifi::stretch{0.0, 1100.0});
  if (!((fly(start).state - exact.state).template head<4>().norm() < tolerance)) return state.SkipWithError("the flight does not end where it should");
  for (auto _ : state) {
    start[0] = start[0] < 60.0 ? start[0] + 0.7 : start[0] - 60.0;
    benchmark::DoNotOptimize(fly(start));
  }
}

template <class Field>
void flight_through(benchmark::State& state, const Field& field) {
  const scifi::nystrom_propagator model{field, scifi::nystrom_options{1e-3 * static_cast<double>(state.range(0))}};
  flight(state, [&model](const auto& start) { return model.propagate(start, scifi::stretch{0.0, 1100.0}); }, 0.02);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::RegisterBenchmark("value/coils", [](benchmark::State& s) { one_value(s, scifi::automatic_gradient{coils}); });
  benchmark::RegisterBenchmark("value/cylindrical_map", [](benchmark::State& s) { one_value(s, round_map()); });
  benchmark::RegisterBenchmark("value/cartesian_map", [](benchmark::State& s) { one_value(s, square_map()); });
  // A helix in the mean field ends 2 mm away.
  benchmark::RegisterBenchmark("flight/helix", [](benchmark::State& s) {
    flight(s, [](const auto& start) { return scifi::helix_propagator{3.32 * scifi::units::tesla}.propagate(start, 1100.0); }, 5.0);
  });
  benchmark::RegisterBenchmark("flight/cylindrical_map/um", [](benchmark::State& s) { flight_through(s, round_map()); })->Arg(1)->Arg(10);
  benchmark::RegisterBenchmark("flight/cartesian_map/um", [](benchmark::State& s) { flight_through(s, square_map()); })->Arg(1)->Arg(10);
  benchmark::RegisterBenchmark("flight/coils/um", [](benchmark::State& s) { flight_through(s, coils); })->Arg(10);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
