// SPDX-License-Identifier: MPL-2.0
// The fit of bench/track_fit.cpp with other models of a track: straight lines, and steps of Runge, Kutta and Nystrom in place of the exact helix; and the fit of a
// helix written plainly on matrices of run-time size, which must give the same numbers. All with scattering, those in a field with loss and straggling.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <string>

#include <scifi/field/uniform_field.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

#include "support/drawn_tracks.hpp"
#include "support/model_fits.hpp"
#include "support/textbook_unit.hpp"

namespace {

using drawn::given;
using namespace models;

bool all_right = true;

void check(bool right, const std::string& what) {
  if (right) return;
  std::fprintf(stderr, "%s\n", what.c_str());
  all_right = false;
}

template <class Fit>
void add(const std::string& name, Fit fit) {
  benchmark::RegisterBenchmark(name.c_str(), [fit](benchmark::State& state) mutable {
    double sum = 0.0;
    for (auto _ : state) {
      for (std::size_t i = 0; i < given().tracks.size(); ++i) sum += fit(i);
      benchmark::DoNotOptimize(sum);
    }
    if (!std::isfinite(sum)) state.SkipWithError("a fit failed");
    state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * drawn::tracks * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  });
}

template <class Fits>
double sum_of_chi2(Fits& f) {
  double sum = 0.0;
  for (std::size_t i = 0; i < given().tracks.size(); ++i) sum += f.library(i, true);
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  const scifi::material_noise noise{scattering, straggling, scifi::muon_plus};
  const int travel = given().tracker.beam_direction;
  const scifi::energy_loss_propagator on_helix{scifi::helix_propagator{drawn::field}, loss, scifi::muon_plus, travel};
  const scifi::uniform_field everywhere{{0.0, 0.0, drawn::field}};
  const scifi::energy_loss_propagator in_steps{scifi::nystrom_propagator{everywhere}, loss, scifi::muon_plus, travel};
  const scifi::leg_propagator straight{scifi::line_propagator{}};
  const scifi::line_material_noise line_noise{scattering, scifi::muon_plus, 200.0};
  static fits<scifi::slope_state, prepared, decltype(on_helix), decltype(noise)> helices(prepared_legs(), on_helix, noise);
  static fits<scifi::slope_state, prepared, decltype(in_steps), decltype(noise)> stepped(prepared_legs(), in_steps, noise);
  static fits<scifi::line_state, scifi::leg, decltype(straight), decltype(line_noise)> lines(given().path.legs, straight, line_noise);

  for (std::size_t i = 0; i < given().tracks.size(); ++i) {
    const double chi2 = helices.library(i, true);
    const textbook::plain_result filtered = helices.plain(i, false), smoothed = helices.plain(i, true);
    const auto& last = helices.nodes().back().filtered;
    const auto& first = helices.nodes().front().smoothed;
    const auto same = [](const auto& a, const auto& b) { return (a - b).norm() < 1e-6 * b.norm(); };
    check(std::abs(filtered.chi2 - chi2) < 1e-7 * chi2 && same(filtered.x, last.mean) && same(filtered.p, last.covariance), "the plain filter is not the library's");
    check(same(smoothed.x, first.mean) && same(smoothed.p, first.covariance), "the plain smoother is not the library's");
  }
  const double of_helices = sum_of_chi2(helices), of_steps = sum_of_chi2(stepped), of_lines = sum_of_chi2(lines);
  check(std::abs(of_steps - of_helices) < 1e-3 * of_helices, "the fit in steps gives another chi2 than that on the helix");
  constexpr double ndf = 11.0;  // the lines were drawn without the scattering that the fit allows for, so chi2 is smaller
  check(of_lines > 0.5 * ndf * drawn::tracks && of_lines < 1.2 * ndf * drawn::tracks, "mean chi2 of straight tracks is " + std::to_string(of_lines / drawn::tracks));
  if (!all_right) return 1;

  benchmark::RegisterBenchmark("textbook", textbook::unit);
  add("helix_plain/filter", [](std::size_t i) { return helices.plain(i, false).chi2; });
  add("helix_plain/filter_smoother", [](std::size_t i) { return helices.plain(i, true).chi2; });
  add("helix/filter", [](std::size_t i) { return helices.library(i, false); });
  add("helix/filter_smoother", [](std::size_t i) { return helices.library(i, true); });
  add("stepped/filter", [](std::size_t i) { return stepped.library(i, false); });
  add("stepped/filter_smoother", [](std::size_t i) { return stepped.library(i, true); });
  add("line/filter", [](std::size_t i) { return lines.library(i, false); });
  add("line/filter_smoother", [](std::size_t i) { return lines.library(i, true); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
