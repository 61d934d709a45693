// SPDX-License-Identifier: MPL-2.0
#include <scifi/candidate_to_track/track_fitter.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

#include "support/catch.hpp"
#include "support/ideal_clusters.hpp"
#include "support/sample.hpp"

using namespace scifi;

namespace {

constexpr double three_tesla = 3.0 * units::tesla;

const tracker& in(int id) {
  static const detector both = mice::trackers();
  return *both.find(id);
}

struct job {
  std::vector<cluster> clusters;
  std::vector<space_point> points;
  candidate found;
};

/// The clusters as one point a station, and a candidate of them all whose seed is given at z.
job candidate_of(const tracker& t, std::vector<cluster> clusters, track_shape shape, const vector<double, 5>& seed, double z) {
  job j;
  test::sort_clusters(clusters);
  j.clusters = std::move(clusters);
  for (const station& s : t.stations) {
    space_point p;
    p.tracker = t.id;
    p.station = s.id;
    for (std::size_t i = 0; i < j.clusters.size(); ++i)
      if (j.clusters[i].station == s.id) p.clusters.push_back(static_cast<int>(i));
    if (p.clusters.empty()) continue;
    j.found.space_points.push_back(static_cast<int>(j.points.size()));
    j.points.push_back(p);
  }
  j.found.tracker = t.id;
  j.found.shape = shape;
  j.found.seed.mean = seed;
  j.found.seed.covariance.setIdentity();
  j.found.z = z;
  return j;
}

struct fitted {
  track result;
  std::vector<track_point> points;
};

template <class Fitter>
fitted fit(const Fitter& fitter, const job& j) {
  std::vector<track> tracks;
  fitted out;
  typename Fitter::buffers work;
  fitter(j.found, 17, j.points, j.clusters, tracks, out.points, work);
  REQUIRE(tracks.size() == 1);
  out.result = tracks[0];
  return out;
}

template <class Gate = kalman::no_gate>
auto without_material(const tracker& t, double field, Gate gate = {}) {
  track_fit_options o;
  o.field = field;
  return track_fitter(t, o, muon_plus, no_energy_loss{}, no_scattering{}, no_straggling{}, kalman::joseph{}, gate);
}

vector<double, 5> state(double x, double tx, double y, double ty, double q_over_pz) {
  vector<double, 5> s;
  s << x, tx, y, ty, q_over_pz;
  return s;
}

/// The reference state of a track that is `start` at z = 0, as momentum_state.
vector<double, 5> momentum(const vector<double, 5>& start, int travel) { return slopes_to_momentum(start, travel).state; }

/// Simulated muons: exact helices, Gaussian scattering and mean loss slab by slab; fibres without noise measure with a Gaussian error.
class toys {
 public:
  toys(const tracker& t, double field, int charge) : tracker_(t), field_(field), surfaces_(surfaces_along(t, +1)), fly_(t, settings(field), {}, {}) {
    beam_.hypothesis = charge > 0 ? muon_plus : muon_minus;
    beam_.pz_min = 160.0;
    beam_.pz_max = 250.0;
    beam_.pt_min = 20.0;
    beam_.pt_max = 60.0;
    beam_.radius = 40.0;
  }

  /// Truth at the reference surface and a candidate with a seed about as good as pattern recognition's; false where the muon left the tracker.
  bool make(std::uint64_t number, vector<double, 5>& truth_at_reference, job& out) const {
    random_stream random(42, number, 0);
    truth real;
    if (fly_(beam_.shoot(tracker_, random), 1, random, real) != flight_end::crossed) return false;
    std::vector<cluster> clusters;
    vector<double, 5> seed;
    for (const crossing& c : real.crossings) {
      for (const surface& s : surfaces_) {
        if (s.station != c.station || s.plane != c.plane) continue;
        vector<double, 5> m;
        m << c.position.x(), c.position.y(), c.momentum.x(), c.momentum.y(), c.momentum.z();
        const vector<double, 5> slopes = momentum_to_slopes(m, beam_.hypothesis.charge).state;
        const vector<double, 5> at = helix_propagator{field_}.propagate(slopes, s.z - c.position.z()).state;
        cluster measured = test::ideal_cluster(tracker_, s, at[slope_state::x], at[slope_state::y]);
        measured.alpha += std::sqrt(measured.variance) * random.normal();
        clusters.push_back(measured);
        if (s.station == 1 && s.plane == 0) truth_at_reference = m;
        if (s.station == 5 && s.plane == 2) {
          seed = at;
          const std::array<double, 5> spread{0.3, 2e-3, 0.3, 2e-3, 2e-4};
          for (int i = 0; i < 5; ++i) seed[i] += spread[static_cast<std::size_t>(i)] * random.normal();
        }
      }
    }
    out = candidate_of(tracker_, clusters, field_ != 0.0 ? track_shape::helix : track_shape::line, seed, surfaces_.back().z);
    return true;
  }

 private:
  static transport_settings settings(double field) {
    transport_settings s;
    s.field = field;
    return s;
  }

  const tracker& tracker_;
  double field_;
  flat_beam beam_;
  std::vector<surface> surfaces_;
  transport<gaussian_scattering<highland_scattering>, fixed_loss<mean_energy_loss>> fly_;
};

}  // namespace

TEST_CASE("a helix without noise is found again, from a seed that is off", "[candidate_to_track]") {
  for (const int id : {mice::upstream, mice::downstream}) {
    const tracker& t = in(id);
    for (const double field : {three_tesla, -three_tesla}) {
      for (const int charge : {1, -1}) {
        INFO(t.name << ", field " << field << ", charge " << charge);
        const vector<double, 5> start = state(20.0, 0.15, -30.0, 0.1, charge * t.beam_direction / 180.0);
        std::vector<cluster> clusters;
        test::add_ideal_track(t, start, field, clusters);
        const double z = surfaces_along(t, +1).back().z;
        vector<double, 5> seed = helix_propagator{field}.propagate(start, z).state;
        seed += state(1.0, 0.005, -1.0, 0.005, 0.0001);
        const fitted f = fit(without_material(t, field), candidate_of(t, clusters, track_shape::helix, seed, z));
        const track& r = f.result;
        REQUIRE(r.status.ok());
        CHECK(r.tracker == id);
        CHECK(r.candidate == 17);
        CHECK(r.charge == charge);
        CHECK(r.stations == 5);
        CHECK(r.planes == 15);
        CHECK(r.ndf == 10);
        // Nothing but the wide prior is off: seed and typical q/pz.
        const track_fit_options o;
        const double off = (std::abs(start[slope_state::q_over_pz]) - o.prior.typical) / o.prior.spread;
        CHECK(r.chi2 == Approx(2.0 * square(1.0 / o.position_spread) + 2.0 * square(0.005 / o.slope_spread) + square(off)).epsilon(0.01));
        CHECK(r.p_value == Approx(1.0).margin(1e-6));
        CHECK(r.z == 0.0);
        const vector<double, 5> truth = momentum(start, t.beam_direction);
        for (int i = 0; i < 5; ++i) {
          INFO(momentum_state::names[static_cast<std::size_t>(i)]);
          CHECK(std::abs(r.reference.mean[i] - truth[i]) < 0.02 * kalman::sigma(r.reference, i));
        }
        REQUIRE(f.points.size() == 15);
        CHECK(r.first_point == 0);
        CHECK(r.points == 15);
        for (std::size_t k = 0; k < 15; ++k) {
          const track_point& p = f.points[k];
          if (k > 0) CHECK(p.z > f.points[k - 1].z);
          const auto at = helix_propagator{field}.propagate(start, p.z).state;
          CHECK(p.smoothed.mean[slope_state::x] == Approx(at[slope_state::x]).margin(0.01));
          CHECK(p.smoothed.mean[slope_state::y] == Approx(at[slope_state::y]).margin(0.01));
          CHECK_FALSE(p.outlier);
          REQUIRE(p.cluster >= 0);
          CHECK(std::abs(p.residual) < 0.02);
        }
      }
    }
  }
}

TEST_CASE("a straight line without noise is found again, with the momentum assumed", "[candidate_to_track]") {
  const tracker& t = in(mice::upstream);
  const vector<double, 5> start = state(20.0, 0.05, -30.0, -0.04, -1.0 / 200.0);
  std::vector<cluster> clusters;
  test::add_ideal_track(t, start, 0.0, clusters);
  std::erase_if(clusters, [](const cluster& c) { return c.station == 2; });
  const double z = surfaces_along(t, +1).back().z;
  vector<double, 5> seed = helix_propagator{0.0}.propagate(start, z).state;
  const fitted f = fit(without_material(t, 0.0), candidate_of(t, clusters, track_shape::line, seed + state(1.0, 0.005, -1.0, 0.005, 0.0), z));
  REQUIRE(f.result.status.ok());
  CHECK(f.result.charge == 1);
  CHECK(f.result.ndf == 12 - 4);
  CHECK(f.result.planes == 12);
  CHECK(f.result.stations == 4);
  const vector<double, 5> truth = momentum(start, -1);
  for (int i = 0; i < 5; ++i) CHECK(f.result.reference.mean[i] == Approx(truth[i]).epsilon(1e-5).margin(1e-4));
  CHECK(f.result.reference.covariance(momentum_state::pz, momentum_state::pz) == Approx(0.0).margin(1e-12));
  // A silent station has its fitted points all the same.
  REQUIRE(f.points.size() == 15);
  for (const track_point& p : f.points) {
    CHECK((p.cluster >= 0) == (p.station != 2));
    CHECK(std::isnan(p.residual) == (p.station == 2));
    CHECK(std::isnan(p.pull) == (p.station == 2));
    CHECK(p.smoothed.mean[slope_state::x] == Approx(20.0 + 0.05 * p.z).margin(1e-3));
  }
}

TEST_CASE("simulated muons: unit pulls of state and residuals, chi2 with its distribution, in both trackers and charges", "[candidate_to_track]") {
  constexpr std::uint64_t tracks = 1500;
  for (const auto& [id, field, charge] : {std::tuple{mice::downstream, three_tesla, 1}, std::tuple{mice::upstream, three_tesla, 1},
                                         std::tuple{mice::upstream, -three_tesla, -1}}) {
    INFO(in(id).name << ", charge " << charge);
    const tracker& t = in(id);
    const toys make(t, field, charge);
    track_fit_options o;
    o.field = field;
    const track_fitter fitter(t, o, muon_plus, mean_energy_loss{}, highland_scattering{}, no_straggling{});
    std::array<test::sample, 5> pull;
    test::sample chi2, residual_pull;
    std::array<int, 10> p_values{};
    for (std::uint64_t i = 0; i < tracks; ++i) {
      vector<double, 5> truth;
      job j;
      if (!make.make(i, truth, j)) continue;
      const fitted f = fit(fitter, j);
      REQUIRE(f.result.status.ok());
      CHECK(f.result.charge == charge);
      REQUIRE(f.result.ndf == 10);
      for (int k = 0; k < 5; ++k) pull[static_cast<std::size_t>(k)].add((f.result.reference.mean[k] - truth[k]) / kalman::sigma(f.result.reference, k));
      chi2.add(f.result.chi2);
      residual_pull.add(f.points[static_cast<std::size_t>(i % 15)].pull);
      ++p_values[static_cast<std::size_t>(std::min(9.0, 10.0 * f.result.p_value))];
    }
    const auto n = static_cast<double>(chi2.size());
    REQUIRE(n > 1000);
    for (std::size_t k = 0; k < 5; ++k) {
      INFO(momentum_state::names[k] << ": mean " << pull[k].mean() << ", standard deviation " << pull[k].standard_deviation());
      CHECK(std::abs(pull[k].mean()) < 4.0 / std::sqrt(n));
      CHECK(std::abs(pull[k].standard_deviation() - 1.0) < 4.0 / std::sqrt(2.0 * n));
    }
    CHECK(std::abs(residual_pull.mean()) < 4.0 / std::sqrt(n));
    CHECK(std::abs(residual_pull.standard_deviation() - 1.0) < 4.0 / std::sqrt(2.0 * n));
    CHECK(std::abs(chi2.mean() - 10.0) < 4.0 * std::sqrt(20.0 / n));
    double flat = 0.0;
    for (const int count : p_values) flat += (count - n / 10.0) * (count - n / 10.0) / (n / 10.0);
    CHECK(flat < 9.0 + 4.0 * std::sqrt(18.0));
  }
}

TEST_CASE("energy is lost along the flight: towards station 5 downstream, towards station 1 upstream", "[candidate_to_track]") {
  for (const int id : {mice::upstream, mice::downstream}) {
    const tracker& t = in(id);
    const vector<double, 5> start = state(20.0, 0.15, -30.0, 0.1, t.beam_direction / 180.0);
    std::vector<cluster> clusters;
    test::add_ideal_track(t, start, three_tesla, clusters);
    const double z = surfaces_along(t, +1).back().z;
    track_fit_options o;
    o.field = three_tesla;
    const track_fitter fitter(t, o, muon_plus, mean_energy_loss{}, highland_scattering{}, no_straggling{});
    const fitted f = fit(fitter, candidate_of(t, clusters, track_shape::helix, helix_propagator{three_tesla}.propagate(start, z).state, z));
    REQUIRE(f.result.status.ok());
    const auto energy = [](const track_point& p) {
      const double tx = p.smoothed.mean[slope_state::tx], ty = p.smoothed.mean[slope_state::ty];
      const double pz = 1.0 / std::abs(p.smoothed.mean[slope_state::q_over_pz]);
      return std::hypot(pz * std::sqrt(1.0 + tx * tx + ty * ty), muon_plus.mass);
    };
    // Polystyrene: 4 planes of 0.627 mm for each station passed, about 2.2 MeV cm2/g at this momentum (PDG tables of muons).
    const double lost = (energy(f.points.front()) - energy(f.points.back())) * t.beam_direction;
    CHECK(lost == Approx(14.0 * 0.0627 * 1.06 * 2.2 * std::sqrt(1.0 + 0.0325)).epsilon(0.15));
  }
}

TEST_CASE("a measurement that the gate refuses is an outlier and does not count", "[candidate_to_track]") {
  const tracker& t = in(mice::downstream);
  const vector<double, 5> start = state(20.0, 0.15, -30.0, 0.1, 1.0 / 180.0);
  std::vector<cluster> clusters;
  test::add_ideal_track(t, start, three_tesla, clusters);
  clusters[1].alpha += 20.0;  // plane W of station 1, late in the fit
  const double z = surfaces_along(t, +1).back().z;
  const auto fitter = without_material(t, three_tesla, kalman::chi2_gate{25.0});
  const fitted f = fit(fitter, candidate_of(t, clusters, track_shape::helix, helix_propagator{three_tesla}.propagate(start, z).state, z));
  REQUIRE(f.result.status.ok());
  CHECK(f.result.planes == 14);
  CHECK(f.result.stations == 5);
  CHECK(f.result.ndf == 9);
  CHECK(f.result.chi2 < 0.02);
  REQUIRE(f.points.size() == 15);
  for (std::size_t k = 0; k < 15; ++k) CHECK(f.points[k].outlier == (k == 1));
  CHECK(f.points[1].cluster >= 0);
  CHECK(f.points[1].chi2 > 25.0);
  CHECK(f.points[1].residual == Approx(20.0).margin(0.05));
}

TEST_CASE("a candidate without clusters gives a track that says so", "[candidate_to_track]") {
  const tracker& t = in(mice::downstream);
  const double z = surfaces_along(t, +1).back().z;
  const fitted f = fit(without_material(t, three_tesla), candidate_of(t, {}, track_shape::helix, state(0.0, 0.1, 0.0, 0.0, 0.005), z));
  CHECK(f.result.planes == 0);
  CHECK(f.result.stations == 0);
  CHECK(f.result.chi2 == 0.0);
  CHECK(f.result.ndf == -5);
  CHECK(std::isnan(f.result.p_value));
}

TEST_CASE("a tracker without planes is refused in words", "[candidate_to_track]") {
  CHECK_THROWS_WITH(without_material(tracker{}, three_tesla), "scifi: a tracker without planes has nothing to fit a track to");
}

TEST_CASE("a fit that fails is a track with its status and without points", "[candidate_to_track]") {
  const tracker& t = in(mice::downstream);
  const vector<double, 5> start = state(20.0, 0.15, -30.0, 0.1, 1.0 / 180.0);
  std::vector<cluster> clusters;
  test::add_ideal_track(t, start, three_tesla, clusters);
  const double z = surfaces_along(t, +1).back().z;
  const fitted f = fit(without_material(t, three_tesla), candidate_of(t, clusters, track_shape::helix, state(0.0, 0.1, 0.0, std::nan(""), 0.005), z));
  CHECK_FALSE(f.result.status.ok());
  CHECK(f.result.status.why == kalman::reason::not_finite);
  CHECK(f.result.points == 0);
  CHECK(f.points.empty());
  CHECK(f.result.candidate == 17);
}

TEST_CASE("buffers handed in again change nothing", "[candidate_to_track]") {
  const tracker& t = in(mice::downstream);
  const toys make(t, three_tesla, 1);
  const auto fitter = without_material(t, three_tesla);
  decltype(fitter)::buffers work;
  for (std::uint64_t i = 0; i < 5; ++i) {
    vector<double, 5> truth;
    job j;
    if (!make.make(i, truth, j)) continue;
    std::vector<track> tracks;
    std::vector<track_point> points;
    fitter(j.found, 17, j.points, j.clusters, tracks, points, work);
    const fitted fresh = fit(fitter, j);
    REQUIRE(tracks.size() == 1);
    CHECK(tracks[0].reference.mean == fresh.result.reference.mean);
    CHECK(tracks[0].reference.covariance == fresh.result.reference.covariance);
    CHECK(tracks[0].chi2 == fresh.result.chi2);
  }
}

TEST_CASE("tracks fitted together are those fitted alone: of both shapes, with planes and stations missing, and where one fails", "[candidate_to_track]") {
  const tracker& t = in(mice::upstream);
  track_fit_options o;
  o.field = three_tesla;
  const track_fitter fitter(t, o, muon_plus, median_energy_loss{5.0}, highland_scattering{}, landau_straggling{5.0});
  const toys bent(t, three_tesla, 1), straight(t, 0.0, 1);
  std::vector<job> jobs;
  for (std::uint64_t number = 0; jobs.size() < 45; ++number) {
    vector<double, 5> truth;
    job j;
    if (!(number % 7 == 3 ? straight : bent).make(number, truth, j)) continue;
    if (number % 3 == 1) j.points[number % j.points.size()].clusters.pop_back();  // a plane without a cluster
    if (number % 5 == 2) {                                                       // a station without a point
      auto kept = j.found.space_points;
      j.found.space_points.clear();
      for (const int p : kept)
        if (p != 1) j.found.space_points.push_back(p);
    }
    if (number % 11 == 4) j.found.seed.mean[slope_state::q_over_pz] *= 8.0;      // it stops on the way
    jobs.push_back(std::move(j));
  }
  std::vector<fit_job> together;
  for (std::size_t i = 0; i < jobs.size(); ++i) together.push_back({&jobs[i].found, static_cast<int>(i), jobs[i].points, jobs[i].clusters});
  std::vector<fitted_track> out;
  decltype(fitter)::buffers work;
  fitter.fit_batch(together, out, work);
  REQUIRE(out.size() == jobs.size());

  int failed = 0;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    INFO("candidate " << i);
    const fitted alone = fit(fitter, jobs[i]);
    const track& a = alone.result;
    const track& b = out[i].summary;
    CHECK(b.candidate == static_cast<int>(i));
    CHECK(b.shape == a.shape);
    REQUIRE(b.status == a.status);
    REQUIRE(out[i].points.size() == alone.points.size());
    if (!a.status.ok()) {
      ++failed;
      continue;
    }
    CHECK(b.charge == a.charge);
    CHECK(b.ndf == a.ndf);
    CHECK(b.planes == a.planes);
    CHECK(b.stations == a.stations);
    // The first measurements shrink the wide prior's variances by 1e4 to 1e6, which makes 1e-16 of rounding 1e-11 here, and the smoother's
    // difference P - P L P a further 1e5 in the errors at the first surfaces.
    CHECK(b.chi2 == Approx(a.chi2).epsilon(1e-10));
    const auto same = [](const kalman::estimate<double, 5>& x, const kalman::estimate<double, 5>& y, double of_sigma) {
      for (int r = 0; r < 5; ++r) {
        CHECK(std::abs(x.mean[r] - y.mean[r]) <= 1e-9 * kalman::sigma(y, r));
        CHECK(kalman::sigma(x, r) == Approx(kalman::sigma(y, r)).epsilon(of_sigma));
      }
      CHECK((x.mean - y.mean).norm() <= 1e-12 * y.mean.norm());
    };
    same(b.reference, a.reference, 1e-10);
    for (std::size_t k = 0; k < alone.points.size(); ++k) {
      const track_point& p = alone.points[k];
      const track_point& q = out[i].points[k];
      CHECK(q.station == p.station);
      CHECK(q.cluster == p.cluster);
      same(q.smoothed, p.smoothed, 1e-5);
      if (p.cluster >= 0) CHECK(q.pull == Approx(p.pull).epsilon(1e-6).margin(1e-9));
    }
  }
  CHECK(failed > 0);
  CHECK(failed < 10);

  // The memory handed in again gives the same.
  std::vector<fitted_track> again = out;
  fitter.fit_batch(together, again, work);
  for (std::size_t i = 0; i < jobs.size(); ++i) CHECK(again[i].summary.chi2 == out[i].summary.chi2);
}

TEST_CASE("a second look moves a track with a stray cluster towards the rest of it, and no other", "[candidate_to_track]") {
  const tracker& t = in(mice::downstream);
  for (const double field : {three_tesla, 0.0}) {
    const auto shape = field != 0.0 ? track_shape::helix : track_shape::line;
    track_fit_options options;
    options.field = field;
    const track_fitter plain(t, options, muon_plus, no_energy_loss{}, highland_scattering{}, no_straggling{});
    const track_fitter<no_energy_loss, highland_scattering, no_straggling, kalman::symmetric_form, kalman::no_gate, helix_propagator, robust_refit> robust(
        t, options, muon_plus, no_energy_loss{}, highland_scattering{}, no_straggling{}, {}, {}, {field}, robust_refit{});
    const vector<double, 5> truth = (vector<double, 5>() << 5.0, 0.1, -20.0, 0.05, 0.005).finished();
    std::vector<cluster> clusters;
    test::add_ideal_track(t, truth, field, clusters);
    const job good = candidate_of(t, clusters, shape, truth, 0.0);
    clusters[1].alpha += 7.0;  // station 1
    const job bad = candidate_of(t, clusters, shape, truth, 0.0);

    const fitted usual = fit(plain, good);
    CHECK((fit(robust, good).result.reference.mean - usual.result.reference.mean).norm() == 0.0);
    const fitted misled = fit(plain, bad);
    const fitted mended = fit(robust, bad);
    CHECK(misled.result.p_value < robust_refit{}.p_below);
    CHECK(mended.result.p_value == misled.result.p_value);
    CHECK(mended.result.charge == usual.result.charge);
    for (const int i : {momentum_state::x, momentum_state::y}) {
      const double off = std::abs(misled.result.reference.mean[i] - usual.result.reference.mean[i]);
      CHECK(std::abs(mended.result.reference.mean[i] - usual.result.reference.mean[i]) < 0.3 * off);
    }
    // The points have had the second look as well: the first is where the reference is.
    const auto distance = [](const fitted& a, const fitted& b) {
      return std::hypot(a.points[0].smoothed.mean[slope_state::x] - b.points[0].smoothed.mean[slope_state::x], a.points[0].smoothed.mean[slope_state::y] - b.points[0].smoothed.mean[slope_state::y]);
    };
    CHECK(distance(mended, usual) < 0.3 * distance(misled, usual));
    for (std::size_t i = 0; i < mended.points.size(); ++i) CHECK(mended.points[i].pull == misled.points[i].pull);
  }
}
