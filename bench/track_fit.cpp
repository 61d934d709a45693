// SPDX-License-Identifier: MPL-2.0
// The fit of a track through the fifteen planes of a tracker and to its reference surface: filter alone, filter and smoother, and the whole stage that
// takes candidates to tracks with their residuals; with all material, and without any. The tracks are helices with Gaussian errors of measurement.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <scifi/candidate_to_track/track_fitter.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>

#include "support/textbook.hpp"

namespace {

namespace kalman = scifi::kalman;
using scifi::slope_state;

constexpr double field = 3.0 * scifi::units::tesla;
constexpr int tracks = 64;

/// A step is a pointer to a leg here: sites that do not copy their legs.
template <class Model>
struct along_legs {
  using state_space = slope_state;
  Model model;
  template <class Scalar>
  [[nodiscard]] auto propagate(const scifi::vector<Scalar, 5>& x, const scifi::leg* step) const { return model.propagate(x, *step); }
  template <class Scalar>
  [[nodiscard]] auto covariance(const scifi::vector<Scalar, 5>& x, const scifi::leg* step, const kalman::propagated<Scalar, 5>& moved) const { return model.covariance(x, *step, moved); }
};

struct site {
  const scifi::leg* step;
  std::optional<scifi::fibre_measurement<slope_state>> measurement;
};

/// One simulated track in the forms that the benchmarks need.
struct simulated {
  scifi::vector<double, 5> at_reference, seed;
  std::vector<site> sites;
  scifi::candidate candidate;
  std::vector<scifi::space_point> points;
  std::vector<scifi::cluster> clusters;
};

struct sample {
  scifi::tracker tracker = scifi::mice::trackers().trackers.back();
  scifi::fit_path path = scifi::fit_path_of(tracker);
  std::vector<simulated> tracks;

  sample() {
    std::mt19937_64 engine(2027);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> flat(-1.0, 1.0);
    const scifi::helix_propagator fly{field};
    constexpr double sigma = 0.431;  // 1.4945 mm / sqrt(12)
    for (int t = 0; t < ::tracks; ++t) {
      simulated s;
      s.at_reference << 60.0 * flat(engine), 0.2 * flat(engine), 60.0 * flat(engine), 0.2 * flat(engine), 1.0 / (180.0 + 40.0 * flat(engine));
      const double far = path.surfaces.front().z;
      s.seed = fly.propagate(s.at_reference, far - path.z_reference).state;
      s.candidate.tracker = tracker.id;
      s.candidate.z = far;
      s.candidate.seed.mean = s.seed;
      for (std::size_t i = 0; i <= path.surfaces.size(); ++i) {
        s.sites.push_back({&path.legs[i], std::nullopt});
        if (i == path.surfaces.size()) break;
        const scifi::surface& at = path.surfaces[i];
        const scifi::vector<double, 5> x = fly.propagate(s.at_reference, at.z - path.z_reference).state;
        scifi::cluster hit;
        hit.tracker = tracker.id;
        hit.station = at.station;
        hit.plane = at.plane;
        hit.alpha = at.tracker_to_alpha(x[slope_state::x], x[slope_state::y]) + sigma * normal(engine);
        hit.variance = sigma * sigma;
        s.sites.back().measurement = scifi::fibre_measurement<slope_state>{hit.alpha, hit.variance, at.cos_angle, at.sin_angle, at.offset};
        if (s.points.empty() || s.points.back().station != hit.station) {
          s.candidate.space_points.push_back(static_cast<int>(s.points.size()));
          s.points.emplace_back();
          s.points.back().station = hit.station;
        }
        s.points.back().clusters.push_back(static_cast<int>(s.clusters.size()));
        s.clusters.push_back(hit);
      }
      tracks.push_back(s);
    }
  }
};

const sample& given() {
  static const sample s;
  return s;
}

struct with_material {
  static constexpr const char* name = "material";
  static auto filter() {
    using namespace scifi;
    const double layers = 5.0;
    const energy_loss_propagator fly{helix_propagator{field}, median_energy_loss{layers}, muon_plus, given().tracker.beam_direction};
    const material_noise noise{highland_scattering{}, landau_straggling{layers}, muon_plus};
    return kalman::filter{along_legs<decltype(fly)>{fly}, along_legs<decltype(noise)>{noise}};
  }
  static auto fitter(const scifi::track_fit_options& o) {
    using namespace scifi;
    return track_fitter(given().tracker, o, muon_plus, median_energy_loss{5.0}, highland_scattering{}, landau_straggling{5.0});
  }
};

struct without_material {
  static constexpr const char* name = "vacuum";
  static auto filter() {
    using namespace scifi;
    const energy_loss_propagator fly{helix_propagator{field}, no_energy_loss{}, muon_plus, given().tracker.beam_direction};
    const material_noise noise{no_scattering{}, no_straggling{}, muon_plus};
    return kalman::filter{along_legs<decltype(fly)>{fly}, along_legs<decltype(noise)>{noise}};
  }
  static auto fitter(const scifi::track_fit_options& o) {
    using namespace scifi;
    return track_fitter(given().tracker, o, muon_plus, no_energy_loss{}, no_scattering{}, no_straggling{});
  }
};

kalman::estimate<double, 5> start_of(const simulated& s) {
  return kalman::uncorrelated(s.seed, scifi::vector<double, 5>{50.0, 0.5, 50.0, 0.5, 0.004});
}

struct no_smoother {};

/// One pass over all tracks: linearised along the flight of the seed. Returns the sum of chi2.
template <class Smoother, class Filter, class Nodes, class References>
double fit_all(const Filter& filter, Nodes& nodes, References& references) {
  double sum = 0.0;
  for (const simulated& s : given().tracks) {
    const auto start = start_of(s);
    if constexpr (std::is_same_v<Smoother, no_smoother>) {
      references[0] = s.seed;
      const auto result = filter.run(start, s.sites, nodes, kalman::detail::flown_references<References>{references});
      if (!result.status.ok()) return std::nan("");
      sum += result.chi2;
    } else {
      const auto result = kalman::run_relinearised(filter, start, s.seed, s.sites, nodes, references, 1, kalman::detail::never_settled{}, Smoother{});
      if (!result.status.ok()) return std::nan("");
      sum += result.chi2;
    }
    benchmark::DoNotOptimize(nodes.data());
    benchmark::ClobberMemory();
  }
  return sum;
}

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
    for (auto _ : state) {
      double sum_of_run = run();
      benchmark::DoNotOptimize(sum_of_run);
    }
    state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * tracks * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  });
}

using nodes_type = std::vector<kalman::node<double, 5, 1>>;
using references_type = std::vector<scifi::vector<double, 5>>;

template <class Material, class Smoother>
void add_fit(const std::string& name) {
  add(name + "/" + Material::name, [filter = Material::filter(), nodes = nodes_type(given().path.legs.size()), references = references_type(given().path.legs.size() + 1)]() mutable {
    return fit_all<Smoother>(filter, nodes, references);
  });
}

template <class Material>
void add_stage() {
  scifi::track_fit_options o;
  o.field = field;
  o.passes = 1;
  add(std::string("stage/") + Material::name, [fit = Material::fitter(o), fitted = std::vector<scifi::track>(), points = std::vector<scifi::track_point>(),
                                               work = typename decltype(Material::fitter(o))::buffers()]() mutable {
    double sum = 0.0;
    for (const simulated& s : given().tracks) {
      fitted.clear();
      points.clear();
      fit(s.candidate, 0, s.points, s.clusters, fitted, points, work);
      if (!fitted[0].status.ok() || fitted[0].points != 15) return std::nan("");
      sum += fitted[0].chi2;
    }
    return sum;
  });
}

/// The fit without material must find the helices that were drawn: chi2 with ten degrees of freedom, pulls of unit width.
void check_fits() {
  const auto filter = without_material::filter();
  nodes_type nodes(given().path.legs.size());
  references_type references(given().path.legs.size() + 1);
  const double mean = fit_all<kalman::rauch_tung_striebel>(filter, nodes, references) / tracks;
  constexpr double ndf = 10.0;
  check(std::abs(mean - ndf) < 4.0 * std::sqrt(2.0 * ndf / tracks), "mean chi2 is " + std::to_string(mean) + ", not 10");
  double worst = 0.0;
  for (const simulated& s : given().tracks) {
    const auto start = start_of(s);
    static_cast<void>(kalman::run_relinearised(filter, start, s.seed, s.sites, nodes, references, 1));
    const kalman::estimate<double, 5> last = nodes.back().smoothed;
    for (int i = 0; i < 5; ++i) check(std::abs(last.mean(i) - s.at_reference(i)) < 6.0 * kalman::sigma(last, i), "a fitted track is not the one drawn");
    nodes_type other = nodes;
    static_cast<void>(kalman::smooth(other, kalman::modified_bryson_frazier{}));
    for (std::size_t k = 0; k < nodes.size(); ++k)
      for (int i = 0; i < 5; ++i) {
        const double sigma = kalman::sigma(nodes[k].smoothed, i);
        worst = std::max({worst, std::abs(other[k].smoothed.mean(i) - nodes[k].smoothed.mean(i)) / sigma, std::abs(kalman::sigma(other[k].smoothed, i) / sigma - 1.0)});
      }
  }
  std::printf("smoothers differ by at most %.1e standard deviations\n", worst);
  check(worst < 1e-3, "the smoothers differ");
}

/// The unit of every figure: a textbook step of five components and one measured value, each on its own dense constant matrices.
void textbook_unit(benchmark::State& state) {
  using square = scifi::matrix<double, 5, 5>;
  std::mt19937_64 engine(51);
  std::normal_distribution<double> normal;
  square f, b;
  scifi::matrix<double, 1, 5> h;
  for (int i = 0; i < 25; ++i) {
    f.data()[i] = normal(engine);
    b.data()[i] = normal(engine);
  }
  for (int i = 0; i < 5; ++i) h(i) = normal(engine);
  f *= 0.95 / f.norm();
  const square q = 0.1 * (b * b.transpose() + square::Identity());
  const scifi::matrix<double, 1, 1> r = scifi::matrix<double, 1, 1>::Constant(1.5);
  constexpr int steps = 64;
  std::vector<scifi::vector<double, 1>> z(steps);
  for (auto& value : z) value(0) = normal(engine);
  for (auto _ : state) {
    textbook::knowledge<scifi::vector<double, 5>, square> e{scifi::vector<double, 5>::Zero(), square::Identity()};
    for (const auto& value : z) textbook::plain_step(e, f, q, h, r, value);
    benchmark::DoNotOptimize(e);
  }
  state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * steps * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace

int main(int argc, char** argv) {
  check_fits();
  benchmark::RegisterBenchmark("textbook", textbook_unit);
  add_fit<without_material, no_smoother>("filter");
  add_fit<without_material, kalman::rauch_tung_striebel>("filter_rts");
  add_fit<without_material, kalman::modified_bryson_frazier>("filter_mbf");
  add_stage<without_material>();
  add_fit<with_material, no_smoother>("filter");
  add_fit<with_material, kalman::rauch_tung_striebel>("filter_rts");
  add_fit<with_material, kalman::modified_bryson_frazier>("filter_mbf");
  add_stage<with_material>();
  if (!all_right) return 1;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
