// SPDX-License-Identifier: MPL-2.0
// The chain and each of its stages, per event, for 1 to 20 simulated tracks an event in one tracker in 3 T; pattern recognition on the space points of the true
// tracks as well; events per second on one and on all cores; how long a single event takes, as a distribution. What is found is compared with what flew first.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/simulated_events.hpp"
#include "support/textbook_unit.hpp"
#include "support/track_score.hpp"

namespace {

constexpr double field = 3.0 * scifi::units::tesla;

scifi::detector one_tracker() {
  scifi::detector out;
  out.trackers = {*scifi::mice::trackers().find(scifi::mice::downstream)};
  return out;
}

const auto& chain() {
  static const auto c = [] {
    scifi::reconstruction_options o;
    o.field = field;
    return scifi::make_reconstruction(one_tracker(), o);
  }();
  return c;
}
using memory = std::remove_cvref_t<decltype(chain())>::buffers;

bool all_right = true;

void check(bool right, const std::string& what) {
  if (right) return;
  std::fprintf(stderr, "%s\n", what.c_str());
  all_right = false;
}

/// Events with the same number of tracks, reconstructed: each stage finds its input in them.
struct sample {
  int tracks;
  std::vector<simulated::one_event> drawn;
  std::vector<scifi::event> events;

  sample(int tracks_per_event, int count) : tracks(tracks_per_event) {
    memory work;
    for (int i = 0; i < count; ++i) {
      drawn.push_back(simulated::draw(chain().where(), field, tracks, static_cast<std::uint64_t>(i)));
      events.emplace_back();
      events.back().digits = drawn.back().digits;
      chain()(events.back(), work);
    }
  }

  /// Tracks of the chain against the particles; candidates from the points of the true tracks against those, found when all their points are of one particle.
  void compare(double least_found, double most_ghosts) const {
    scifi::test::track_score score(true);
    for (std::size_t i = 0; i < events.size(); ++i) score.add(drawn[i].crossings, events[i]);
    const std::string where = std::to_string(tracks) + " tracks an event: ";
    check(score.all.value() >= least_found && score.all.expected > 0, where + "found " + std::to_string(score.all.value()) + " of them");
    check(score.ghosts_per_expected() <= most_ghosts, where + std::to_string(score.ghosts_per_expected()) + " ghosts a track");
    long expected = 0, pure = 0;
    memory work;
    std::vector<scifi::candidate> candidates;
    for (const auto& e : drawn) {
      candidates.clear();
      find(e.truth, candidates, work);
      for (int particle = 1; particle <= tracks; ++particle) {
        expected += std::count(e.truth.particle_of.begin(), e.truth.particle_of.end(), particle) >= 4;
        pure += std::any_of(candidates.begin(), candidates.end(), [&](const scifi::candidate& c) {
          return std::all_of(c.space_points.begin(), c.space_points.end(), [&](int p) { return e.truth.particle_of[static_cast<std::size_t>(p)] == particle; });
        });
      }
    }
    check(static_cast<double>(pure) >= least_found * static_cast<double>(expected), where + std::to_string(pure) + " pure candidates of " + std::to_string(expected));
    if (std::getenv("SCIFI_BENCH_VERBOSE") != nullptr)
      std::fprintf(stderr, "%sfound %.4f, ghosts %.4f, pure %.4f\n", where.c_str(), score.all.value(), score.ghosts_per_expected(), static_cast<double>(pure) / static_cast<double>(expected));
  }

  static void find(const simulated::true_points& from, std::vector<scifi::candidate>& candidates, memory& work) {
    chain().trackers().front().find_candidates(from.points, from.clusters, candidates, work.candidates);
  }
};

void per_event(benchmark::State& state, std::size_t events) {
  state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(events) * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Times `work` on each event; memory has been used before.
template <class Work>
void add(const std::string& stage, const sample& given, Work work) {
  benchmark::RegisterBenchmark((stage + "/" + std::to_string(given.tracks)).c_str(), [&given, work](benchmark::State& state) mutable {
    for (auto _ : state)
      for (std::size_t i = 0; i < given.events.size(); ++i) work(i);
    per_event(state, given.events.size());
  });
}

void add_stages(const sample& given) {
  const auto& stages = chain().trackers().front();
  add("clusters", given, [&given, e = scifi::event{}](std::size_t i) mutable {
    e.digits = given.drawn[i].digits;
    e.clusters.clear();
    chain().clusters()(chain().where(), e.digits, e.clusters);
    benchmark::DoNotOptimize(e.clusters.data());
  });
  add("space_points", given, [&given, &stages, points = std::vector<scifi::space_point>{}, work = memory{}](std::size_t i) mutable {
    points.clear();
    chain().space_points()(stages.where, given.events[i].clusters, points, work.space_points);
    benchmark::DoNotOptimize(points.data());
  });
  add("patterns", given, [&given, &stages, candidates = std::vector<scifi::candidate>{}, work = memory{}](std::size_t i) mutable {
    candidates.clear();
    stages.find_candidates(given.events[i].space_points, given.events[i].clusters.size(), candidates, work.candidates);
    benchmark::DoNotOptimize(candidates.data());
  });
  add("patterns_of_true_points", given, [&given, candidates = std::vector<scifi::candidate>{}, work = memory{}](std::size_t i) mutable {
    candidates.clear();
    sample::find(given.drawn[i].truth, candidates, work);
    benchmark::DoNotOptimize(candidates.data());
  });
  add("fit", given, [&given, &stages, jobs = std::vector<scifi::fit_job>{}, work = memory{}](std::size_t i) mutable {
    const scifi::event& e = given.events[i];
    jobs.clear();
    for (std::size_t c = 0; c < e.candidates.size(); ++c) jobs.push_back({&e.candidates[c], static_cast<int>(c), e.space_points, e.clusters});
    stages.fit_track.fit_batch(jobs, work.fitted, work.fit);
    benchmark::DoNotOptimize(work.fitted.data());
  });
  add("chain", given, [&given, e = scifi::event{}, work = memory{}](std::size_t i) mutable {
    e.digits = given.drawn[i].digits;
    chain()(e, work);
    benchmark::DoNotOptimize(e.tracks.data());
  });
}

/// Blocks of events, each thread its own copies of all, as a program would run them.
void throughput(benchmark::State& state, const sample& given) {
  std::vector<scifi::event> events = given.events;
  memory work;
  chain()(std::span(events), work);
  for (auto _ : state) {
    chain()(std::span(events), work);
    benchmark::DoNotOptimize(events.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<long>(events.size()));
}

/// Every event timed alone, in the order drawn.
void latency(benchmark::State& state, const sample& given) {
  scifi::event e;
  memory work;
  std::vector<double> taken;
  const auto each = [&](const auto& record) {
    for (const auto& d : given.drawn) {
      e.digits = d.digits;
      const auto before = std::chrono::steady_clock::now();
      chain()(e, work);
      record(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count());
    }
  };
  each([](double) {});
  for (auto _ : state) each([&taken](double us) { taken.push_back(us); });
  std::sort(taken.begin(), taken.end());
  const auto quantile = [&taken](double q) { return taken[static_cast<std::size_t>(q * static_cast<double>(taken.size() - 1))]; };
  state.counters["median_us"] = quantile(0.5);
  state.counters["p99_us"] = quantile(0.99);
  state.counters["max_us"] = quantile(1.0);
  per_event(state, given.drawn.size());
}

}  // namespace

int main(int argc, char** argv) {
  // tracks an event, events, least share found, most ghosts a track
  struct wanted {
    int tracks, events;
    double found, ghosts;
  };
  std::vector<sample> samples;
  samples.reserve(8);
  for (const wanted& w : {wanted{1, 128, 0.97, 0.03}, {2, 64, 0.95, 0.03}, {4, 48, 0.93, 0.06}, {6, 32, 0.9, 0.1}, {8, 32, 0.88, 0.1}, {10, 24, 0.85, 0.15}, {20, 12, 0.7, 0.3}}) {
    samples.emplace_back(w.tracks, w.events);
    samples.back().compare(w.found, w.ghosts);
  }
  if (!all_right) return 1;
  benchmark::RegisterBenchmark("textbook", textbook::unit);
  for (const sample& s : samples) add_stages(s);
  for (const sample& s : samples) {
    if (s.tracks != 1 && s.tracks != 4) continue;
    const std::string tracks = std::to_string(s.tracks);
    for (const int threads : {1, static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))})
      benchmark::RegisterBenchmark(("throughput/" + tracks).c_str(), [&s](benchmark::State& state) { throughput(state, s); })->Threads(threads)->UseRealTime()->MinTime(0.3);  // threads take time to start
    benchmark::RegisterBenchmark(("latency/" + tracks).c_str(), [&s](benchmark::State& state) { latency(state, s); });
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
