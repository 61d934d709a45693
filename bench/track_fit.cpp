// SPDX-License-Identifier: MPL-2.0
// The fit of a track through the fifteen planes of a tracker and to its reference surface: filter alone, filter and smoother, and the whole stage that
// takes candidates to tracks with their residuals; with all material, and without any. The tracks are helices with Gaussian errors of measurement.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <scifi/candidate_to_track/track_fitter.hpp>
#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>

#include "support/drawn_tracks.hpp"
#include "support/textbook_unit.hpp"

namespace {

namespace kalman = scifi::kalman;
using scifi::slope_state;

using drawn::field;
using drawn::given;
using drawn::tracks;

template <class EnergyLoss, class Scattering, class Straggling>
struct policies {
  EnergyLoss loss;
  Scattering scattering;
  Straggling straggling;
  using leg = scifi::prepared_leg<EnergyLoss, Scattering, Straggling>;

  [[nodiscard]] auto filter() const {
    const scifi::energy_loss_propagator fly{scifi::helix_propagator{field}, loss, scifi::muon_plus, given().tracker.beam_direction};
    return kalman::filter{fly, scifi::material_noise{scattering, straggling, scifi::muon_plus}, kalman::symmetric_form{}};
  }
  [[nodiscard]] std::vector<leg> legs() const {
    std::vector<leg> out;
    for (const scifi::leg& l : given().path.legs) out.emplace_back(l, loss, scattering, straggling, scifi::muon_plus);
    return out;
  }
  [[nodiscard]] auto fitter() const {
    scifi::track_fit_options o;
    o.field = field;
    o.passes = 1;
    return scifi::track_fitter(given().tracker, o, scifi::muon_plus, loss, scattering, straggling);
  }
};
const policies<scifi::median_energy_loss, scifi::highland_scattering, scifi::landau_straggling> material{{5.0}, {}, {5.0}};
const policies<scifi::no_energy_loss, scifi::no_scattering, scifi::no_straggling> vacuum{};

struct no_smoother {};

/// All tracks, one in each lane of Scalar, with their measurements laid out and linearised along the flight of their seeds.
template <class Scalar, class Policies>
class fits {
  using leg = typename Policies::leg;
  static constexpr std::size_t width = static_cast<std::size_t>(scifi::lane_count<Scalar>);

 public:
  explicit fits(const Policies& p) : filter_(p.filter()), legs_(p.legs()), nodes_(legs_.size()), references_(legs_.size() + 1) {
    for (std::size_t first = 0; first < tracks; first += width) {
      group g;
      std::array<scifi::fit_job, width> jobs;
      for (std::size_t lane = 0; lane < width; ++lane) {
        const drawn::one_track& s = given().tracks[first + lane];
        jobs[lane] = {&s.candidate, 0, s.points, s.clusters};
        for (int i = 0; i < 5; ++i) scifi::set_lane(g.seed[i], static_cast<int>(lane), s.seed[i]);
      }
      scifi::set_stops(given().path, legs_, jobs, g.memory);
      g.start = {g.seed, scifi::matrix<Scalar, 5, 5>::Zero()};
      const scifi::vector<double, 5> sigmas{50.0, 0.5, 50.0, 0.5, 0.004};
      for (int i = 0; i < 5; ++i) g.start.covariance(i, i) = Scalar(sigmas[i] * sigmas[i]);
      groups_.push_back(std::move(g));
    }
  }

  /// One pass over all tracks, `see` called after each group. Returns the sum of chi2.
  template <class Smoother, class See>
  double run(const See& see) {
    double sum = 0.0;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const group& g = groups_[i];
      references_[0] = g.seed;
      auto result = filter_.run(g.start, g.memory.stops, nodes_, kalman::detail::flown_references<decltype(references_)>{references_});
      if constexpr (!std::is_same_v<Smoother, no_smoother>) {
        if (result.status.ok()) result.status = kalman::smooth(nodes_, Smoother{});
      }
      if (!result.status.ok()) return std::nan("");
      for (std::size_t lane = 0; lane < width; ++lane) sum += static_cast<double>(scifi::lane_of(result.chi2, static_cast<int>(lane)));
      see(i, nodes_);
      benchmark::DoNotOptimize(nodes_.data());
      benchmark::ClobberMemory();
    }
    return sum;
  }
  template <class Smoother>
  double run() {
    return run<Smoother>([](std::size_t, const auto&) {});
  }

 private:
  struct group {
    scifi::vector<Scalar, 5> seed;
    kalman::estimate<Scalar, 5> start;
    scifi::fit_memory<slope_state, Scalar, leg> memory;
  };
  std::vector<group> groups_;
  decltype(std::declval<const Policies&>().filter()) filter_;
  std::vector<leg> legs_;
  std::vector<kalman::node<Scalar, 5, 1>> nodes_;
  std::vector<scifi::vector<Scalar, 5>> references_;
};

bool all_right = true;

void check(bool right, const std::string& what) {
  if (right) return;
  std::fprintf(stderr, "%s\n", what.c_str());
  all_right = false;
}

template <class Run>
void add(const std::string& name, Run run) {
  const double sum = run();
  check(std::isfinite(sum), name + ": a fit failed");
  benchmark::RegisterBenchmark(name.c_str(), [run](benchmark::State& state) mutable {
    double sum_of_run = 0.0;
    for (auto _ : state) {
      sum_of_run = run();
      benchmark::DoNotOptimize(sum_of_run);
    }
    if (!std::isfinite(sum_of_run)) state.SkipWithError("a fit failed");
    state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * tracks * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  });
}

template <class Smoother, class Scalar, class Policies>
void add_fit(const std::string& name, const Policies& p) {
  add(name, [all = std::make_shared<fits<Scalar, Policies>>(p)] { return all->template run<Smoother>(); });  // not copied: its stops point to its legs
}

/// The whole stage, one track after another or in lanes.
template <class Policies>
void add_stage(const std::string& medium, const Policies& p) {
  using fitter = decltype(p.fitter());
  std::vector<scifi::fit_job> jobs;
  for (const drawn::one_track& s : given().tracks) jobs.push_back({&s.candidate, 0, s.points, s.clusters});
  const auto sum_of = [](const std::vector<scifi::fitted_track>& fitted) {
    double sum = 0.0;
    for (const scifi::fitted_track& f : fitted) {
      if (!f.summary.status.ok() || f.summary.points != 15) return std::nan("");
      sum += f.summary.chi2;
    }
    return sum;
  };
  add("stage/" + medium, [=, fit = p.fitter(), fitted = std::vector<scifi::track>(), points = std::vector<scifi::track_point>(), work = typename fitter::buffers()]() mutable {
    fitted.clear();
    points.clear();
    double sum = 0.0;
    for (const scifi::fit_job& j : jobs) {
      fit(*j.from, 0, j.points, j.clusters, fitted, points, work);
      if (!fitted.back().status.ok() || fitted.back().points != 15) return std::nan("");
      sum += fitted.back().chi2;
    }
    return sum;
  });
  add("stage_lanes/" + medium, [=, fit = p.fitter(), fitted = std::vector<scifi::fitted_track>(), work = typename fitter::buffers()]() mutable {
    fit.fit_batch(jobs, fitted, work);
    return sum_of(fitted);
  });
}

template <class Policies>
void add_all(const std::string& medium, const Policies& p) {
  using numbers = scifi::pack<double>;
  using floats = scifi::pack<float>;
  const double alone = fits<double, Policies>(p).template run<no_smoother>();
  const double in_lanes = fits<numbers, Policies>(p).template run<no_smoother>();
  const double in_floats = fits<floats, Policies>(p).template run<no_smoother>();
  check(std::abs(in_lanes - alone) < 1e-10 * alone, medium + ": lanes of double differ from single tracks");
  check(std::abs(in_floats - alone) < 5e-3 * alone, medium + ": lanes of float differ from single tracks");
  add_fit<no_smoother, double>("filter/" + medium, p);
  add_fit<kalman::rauch_tung_striebel, double>("filter_rts/" + medium, p);
  add_fit<kalman::modified_bryson_frazier, double>("filter_mbf/" + medium, p);
  add_fit<no_smoother, numbers>("filter_lanes/" + medium, p);
  add_fit<kalman::modified_bryson_frazier, numbers>("filter_mbf_lanes/" + medium, p);
  add_fit<no_smoother, floats>("filter_floats/" + medium, p);
  add_fit<kalman::modified_bryson_frazier, floats>("filter_mbf_floats/" + medium, p);
  add_stage(medium, p);
}

/// The fit without material must find the helices that were drawn: chi2 with ten degrees of freedom, errors that cover the truth.
void check_fits() {
  fits<double, decltype(vacuum)> all(vacuum);
  double worst = 0.0;
  const double mean = all.run<kalman::rauch_tung_striebel>([&worst](std::size_t track, const auto& nodes) {
    const kalman::estimate<double, 5> last = nodes.back().smoothed;
    for (int i = 0; i < 5; ++i) check(std::abs(last.mean(i) - given().tracks[track].at_reference(i)) < 6.0 * kalman::sigma(last, i), "a fitted track is not the one drawn");
    auto other = nodes;
    static_cast<void>(kalman::smooth(other, kalman::modified_bryson_frazier{}));
    for (std::size_t k = 0; k < nodes.size(); ++k)
      for (int i = 0; i < 5; ++i) {
        const double sigma = kalman::sigma(nodes[k].smoothed, i);
        worst = std::max({worst, std::abs(other[k].smoothed.mean(i) - nodes[k].smoothed.mean(i)) / sigma, std::abs(kalman::sigma(other[k].smoothed, i) / sigma - 1.0)});
      }
  }) / tracks;
  constexpr double ndf = 10.0;
  check(std::abs(mean - ndf) < 4.0 * std::sqrt(2.0 * ndf / tracks), "mean chi2 is " + std::to_string(mean) + ", not 10");
  std::printf("smoothers differ by at most %.1e standard deviations\n", worst);
  check(worst < 1e-3, "the smoothers differ");
}

}  // namespace

int main(int argc, char** argv) {
  check_fits();
  benchmark::RegisterBenchmark("textbook", textbook::unit);
  add_all("vacuum", vacuum);
  add_all("material", material);
  if (!all_right) return 1;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
