// SPDX-License-Identifier: MPL-2.0
// The fit of bench/track_fit.cpp with other models of a track: straight lines, and steps of Runge, Kutta and Nystrom in place of the exact helix; and the fit of a
// helix written plainly on matrices of run-time size, which must give the same numbers. All with scattering, those in a field with loss and straggling.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <scifi/candidate_to_track/fit_stops.hpp>
#include <scifi/field/uniform_field.hpp>
#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/relinearised.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/symmetric_form.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>
#include <scifi/track_model/prepared_leg.hpp>

#include "support/drawn_tracks.hpp"
#include "support/plain_fit.hpp"
#include "support/textbook_unit.hpp"

namespace {

namespace kalman = scifi::kalman;
using drawn::given;

const scifi::median_energy_loss loss{5.0};
const scifi::highland_scattering scattering;
const scifi::landau_straggling straggling{5.0};
using prepared = scifi::prepared_leg<scifi::median_energy_loss, scifi::highland_scattering, scifi::landau_straggling>;

std::vector<prepared> prepared_legs() {
  std::vector<prepared> out;
  for (const scifi::leg& l : given().path.legs) out.emplace_back(l, loss, scattering, straggling, scifi::muon_plus);
  return out;
}

/// All tracks with their measurements laid out; `run(i)` fits one of them.
template <class StateSpace, class Leg, class Propagator, class Noise>
class fits {
  static constexpr int dimension = StateSpace::dimension;

 public:
  fits(std::vector<Leg> legs, Propagator propagator, Noise noise) : legs_(std::move(legs)), filter_(propagator, noise, kalman::symmetric_form{}), propagator_(propagator), noise_(noise) {
    std::mt19937_64 engine(2028);
    for (const drawn::one_track& t : given().tracks) {
      one o;
      const scifi::vector<double, 5> sigmas{50.0, 0.5, 50.0, 0.5, 0.004};
      o.seed = t.seed.head<dimension>();
      o.start = {o.seed, scifi::matrix<double, dimension, dimension>::Zero()};
      for (int i = 0; i < dimension; ++i) o.start.covariance(i, i) = sigmas[i] * sigmas[i];
      scifi::set_stops(given().path, legs_, std::array{scifi::fit_job{&t.candidate, 0, t.points, t.clusters}}, o.memory);
      // Not the helix that was drawn.
      if constexpr (dimension == 4) straighten(o, engine);
      tracks_.push_back(std::move(o));
    }
    nodes_.resize(legs_.size());
    references_.resize(legs_.size() + 1);
  }
  fits(const fits&) = delete;
  fits& operator=(const fits&) = delete;

  /// Filter and, with `smoothed`, smoother. Returns chi2, NaN where the fit failed.
  double library(std::size_t i, bool smoothed) {
    const one& o = tracks_[i];
    references_[0] = o.seed;
    auto result = filter_.run(o.start, o.memory.stops, nodes_, kalman::detail::flown_references<decltype(references_)>{references_});
    if (smoothed && result.status.ok()) result.status = kalman::smooth(nodes_, kalman::modified_bryson_frazier{});
    benchmark::DoNotOptimize(nodes_.data());
    return result.status.ok() ? result.chi2 : std::nan("");
  }
  textbook::plain_result plain(std::size_t i, bool smoothed) const {
    const one& o = tracks_[i];
    return textbook::plain_fit<Propagator, Noise, decltype(o.memory.stops), dimension>(propagator_, noise_, o.memory.stops, o.seed, o.start, smoothed);
  }
  [[nodiscard]] const auto& nodes() const { return nodes_; }

 private:
  struct one {
    scifi::vector<double, dimension> seed;
    kalman::estimate<double, dimension> start;
    scifi::fit_memory<StateSpace, double, Leg> memory;
  };

  /// Measurements of the straight way of the seed, with Gaussian errors.
  static void straighten(one& o, std::mt19937_64& engine) {
    std::normal_distribution<double> normal;
    const std::vector<scifi::surface>& surfaces = given().path.surfaces;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const double dz = surfaces[i].z - surfaces.front().z;
      auto& seen = *o.memory.stops[i].measurement;
      seen.alpha = surfaces[i].tracker_to_alpha(o.seed[0] + dz * o.seed[1], o.seed[2] + dz * o.seed[3]) + std::sqrt(seen.alpha_variance) * normal(engine);
    }
  }

  std::vector<Leg> legs_;
  kalman::filter<Propagator, Noise, kalman::symmetric_form> filter_;
  Propagator propagator_;
  Noise noise_;
  std::vector<one> tracks_;
  std::vector<kalman::node<double, dimension, 1>> nodes_;
  std::vector<scifi::vector<double, dimension>> references_;
};

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
