// SPDX-License-Identifier: MPL-2.0
// How good could any fit be? The exact posterior of Geant4's tracks under what channels really say (a flat probability in the strip that lights them) and under scattering
// with its tail, sampled by Gibbs' method, beside the Kalman fit of the same tracks. No estimator has a smaller mean square error than the mean of that posterior.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <Eigen/Dense>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/random.hpp>
#include <scifi/core/units.hpp>
#include <scifi/io/csv.hpp>
#include <scifi/io/digit_reader.hpp>
#include <scifi/io/geometry_json.hpp>

#include "support/catch.hpp"
#include "support/sample.hpp"
#include "support/shared_data.hpp"

using namespace scifi;
using slopes = vector<double, 5>;
using square5 = matrix<double, 5, 5>;
using places = Eigen::Matrix<double, 10, 1>;  // x, y at the middle plane of each station
using square10 = Eigen::Matrix<double, 10, 10>;

namespace {

/// Density of a crossing along alpha given the cluster: flat between `from` and `to`.
struct flat_piece {
  double from, to, density;
};

struct plane_reading {
  double by_x = 0.0, by_y = 0.0, shift = 0.0;  // alpha = by_x x + by_y y + shift, of the place at the middle of the station
  std::array<flat_piece, 3> pieces{};
};

/// One track about its fit: everything linear, with the scattering of each inner station in one of the three widths of the law.
struct linear_track {
  slopes at_reference, prior_mean;
  places expected;
  std::array<plane_reading, 15> readings;
  std::vector<square10> precision;                 // for each of the 27 combinations of widths
  std::vector<Eigen::Matrix<double, 5, 10>> gain;  // best state at the reference surface for given places
  std::vector<double> log_weight;
};

double below(double z) { return 0.5 * std::erfc(-z * std::sqrt(0.5)); }

/// Draws from a normal distribution times the densities of three planes along one coordinate.
double draw(const linear_track& t, std::size_t coordinate, const places& at, double mean, double sigma, random_stream& random) {
  static const boost::math::normal normal;
  const std::size_t station = coordinate / 2;
  const bool along_x = coordinate % 2 == 0;
  std::array<double, 20> cuts{};
  std::array<double, 3> slope{}, start{};
  std::size_t n = 0;
  double low = -1e9, high = 1e9;
  for (std::size_t k = 0; k < 3; ++k) {
    const plane_reading& r = t.readings[3 * station + k];
    slope[k] = along_x ? r.by_x : r.by_y;
    start[k] = r.shift + (along_x ? r.by_y : r.by_x) * at[static_cast<Eigen::Index>(along_x ? coordinate + 1 : coordinate - 1)];
    if (std::abs(slope[k]) < 1e-6) continue;
    const double a = (r.pieces.front().from - start[k]) / slope[k], b = (r.pieces.back().to - start[k]) / slope[k];
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
    for (const flat_piece& p : r.pieces) cuts[n++] = (p.from - start[k]) / slope[k];
  }
  const double stay = at[static_cast<Eigen::Index>(coordinate)];
  if (!(low < high)) return stay;
  cuts[n++] = low;
  cuts[n++] = high;
  std::sort(cuts.begin(), cuts.begin() + static_cast<std::ptrdiff_t>(n));
  std::array<double, 20> mass{};
  double total = 0.0;
  const auto side = [&](double x) { return (x - mean) / sigma; };
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (cuts[i] < low || cuts[i + 1] > high) continue;
    double density = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::abs(slope[k]) < 1e-6) continue;
      const double alpha = start[k] + slope[k] * 0.5 * (cuts[i] + cuts[i + 1]);
      double here = 0.0;
      for (const flat_piece& p : t.readings[3 * station + k].pieces) here = alpha >= p.from && alpha < p.to ? p.density : here;
      density *= here;
    }
    const double a = side(cuts[i]), b = side(cuts[i + 1]);
    total += mass[i] = density * (a > 0.0 ? below(-a) - below(-b) : below(b) - below(a));
  }
  if (!(total > 1e-280)) return stay;
  double pick = random.uniform() * total;
  std::size_t i = 0;
  while (i + 2 < n && pick > mass[i]) pick -= mass[i++];
  const double a = side(cuts[i]), b = side(cuts[i + 1]), u = random.uniform();
  const double far = a > 0.0 ? below(-b) + u * (below(-a) - below(-b)) : below(a) + u * (below(b) - below(a));
  if (!(far > 1e-300 && far < 1.0)) return stay;
  const double z = boost::math::quantile(normal, far);
  return std::clamp(mean + sigma * (a > 0.0 ? -z : z), cuts[i], cuts[i + 1]);
}

/// Mean over the posterior of f(state at the reference surface).
template <class F>
vector<double, 4> posterior_mean(const linear_track& t, places at, int sweeps, random_stream& random, const F& f) {
  constexpr int burn_in = 40;
  vector<double, 4> sum = vector<double, 4>::Zero();
  std::vector<double> weight(t.precision.size());
  for (int sweep = -burn_in; sweep < sweeps; ++sweep) {
    double largest = -1e300, total = 0.0;
    for (std::size_t c = 0; c < weight.size(); ++c) largest = std::max(largest, weight[c] = t.log_weight[c] - 0.5 * (at - t.expected).dot(t.precision[c] * (at - t.expected)));
    for (double& w : weight) total += w = std::exp(w - largest);
    double pick = random.uniform() * total;
    std::size_t c = 0;
    while (c + 1 < weight.size() && pick > weight[c]) pick -= weight[c++];
    for (std::size_t j = 0; j < 10; ++j) {
      const auto row = static_cast<Eigen::Index>(j);
      const double own = t.precision[c](row, row);
      const double pull = t.precision[c].row(row).dot(at - t.expected);
      at[row] = draw(t, j, at, at[row] - pull / own, 1.0 / std::sqrt(own), random);
    }
    if (sweep >= 0) sum += f(slopes(t.at_reference + t.prior_mean + t.gain[c] * (at - t.expected)));
  }
  return sum / sweeps;
}

/// What a cluster says of alpha.
std::array<flat_piece, 3> pieces_of(const cluster& hit, const event& e, const plane& p) {
  const fibre_doublet fibre;
  const double width = p.channel_width;
  const double half = 0.5 * fibre.overlap();
  const double a = hit.alpha;
  if (hit.size == 1) {  // its own strip; rarely the strip shared with a neighbour that stayed below threshold
    const double own = 0.5 * fibre.unshared();
    return {flat_piece{a - 0.5 * width - half, a - own, 0.06}, {a - own, a + own, 1.0}, {a + own, a + 0.5 * width + half, 0.06}};
  }
  if (hit.size > 2) return {flat_piece{a - 2.0 * width, a - width, 1.0}, {a - width, a + width, 1.0}, {a + width, a + 2.0 * width, 1.0}};
  // The strip that both share, or one of them is noise: the dimmer, most of the time.
  const digit& first = e.digits[static_cast<std::size_t>(hit.first_digit)];
  const digit& second = e.digits[static_cast<std::size_t>(hit.first_digit + 1)];
  const double edge = half + 0.02;  // tilted tracks
  const double true_pair = (fibre.overlap() * fibre.overlap() + 0.05 * 0.05) / 12.0;
  const double wrong = (fibre_resolution{}.variance(p, {2, std::min(first.npe, second.npe), hit.npe}) - true_pair) / (width * width / 3.0 - true_pair);
  const double upper = first.npe > second.npe ? 0.85 : 0.15;  // alpha falls as channels grow
  return {flat_piece{a - width + half, a - edge, (1.0 - upper) * wrong / 1.4}, {a - edge, a + edge, (1.0 - wrong) / (2.0 * edge)}, {a + edge, a + width - half, upper * wrong / 1.4}};
}

/// The tracker walked upwards from its reference surface.
struct walk {
  std::vector<leg> legs;
  std::vector<surface> surfaces;
  energy_loss_propagator<helix_propagator, mean_energy_loss> fly;
  material_noise<highland_scattering, landau_straggling> noise{{}, {5.0}, muon_plus};

  walk(const tracker& where, double field) : fly{{field}, {}, muon_plus, 1} {
    const fit_path path = fit_path_of(where);
    for (std::size_t i = path.surfaces.size(); i-- > 0;) {
      leg l = path.legs[i + 1];
      l.dz = -l.dz;
      l.direction = 1;
      std::swap(l.start, l.finish);
      legs.push_back(l);
      surfaces.push_back(path.surfaces[i]);
    }
  }
};

/// The linear model about a fitted track.
linear_track linear_about(const track& k, const event& e, const walk& way, const tracker& where, places& at) {
  const scattering_tail tail{{0.900, 0.096, 0.004}, {0.80, 3.9, 72.0}};  // of these very tracks' true angles
  linear_track t;
  t.at_reference = momentum_to_slopes(k.reference.mean, k.charge).state;
  t.prior_mean = slopes::Zero();
  t.prior_mean[4] = std::copysign(q_over_pz_prior{}.typical, t.at_reference[4]) - t.at_reference[4];
  slopes x = t.at_reference;
  square5 f = square5::Identity();
  std::vector<square5> steps;
  std::array<std::array<square5, 15>, 6> kicks;  // by station; the last: gas
  for (auto& of_station : kicks) of_station.fill(square5::Zero());
  Eigen::Matrix<double, 10, 5> by_reference;
  for (std::size_t i = 0; i < 15; ++i) {
    const auto moved = way.fly.propagate(x, way.legs[i]);
    const auto part = [&](bool at_start, bool gap, bool at_finish) {
      leg l = way.legs[i];
      if (!at_start) l.start = {};
      if (!gap) l.gap = {};
      if (!at_finish) l.finish = {};
      return square5(way.noise.covariance(x, l, moved));
    };
    kicks[i > 0 ? (i - 1) / 3 : 0][i] += part(true, false, false);
    kicks[5][i] += part(false, true, false);
    kicks[i / 3][i] += part(false, false, true);
    f = moved.jacobian * f;
    x = moved.state;
    steps.push_back(moved.jacobian);
    if (i % 3 != 1) continue;
    const auto row = static_cast<Eigen::Index>(2 * (i / 3));
    by_reference.row(row) = f.row(slope_state::x);
    by_reference.row(row + 1) = f.row(slope_state::y);
    t.expected[row] = x[slope_state::x];
    t.expected[row + 1] = x[slope_state::y];
  }
  t.expected += by_reference * t.prior_mean;
  std::array<square10, 6> scattered;
  for (std::size_t s = 0; s < 6; ++s) {
    scattered[s].setZero();
    for (std::size_t i = 0; i < 15; ++i) {
      Eigen::Matrix<double, 10, 5> reach = Eigen::Matrix<double, 10, 5>::Zero();
      square5 so_far = square5::Identity();
      for (std::size_t j = i; j < 15; ++j) {
        if (j > i) so_far = steps[j] * so_far;
        if (j % 3 != 1) continue;
        const auto row = static_cast<Eigen::Index>(2 * (j / 3));
        reach.row(row) = so_far.row(slope_state::x);
        reach.row(row + 1) = so_far.row(slope_state::y);
      }
      scattered[s] += reach * kicks[s][i] * reach.transpose();
    }
  }
  const square5 prior = (slopes() << 2500.0, 0.25, 2500.0, 0.25, 16e-6).finished().asDiagonal();
  for (std::size_t c = 0; c < 27; ++c) {
    const std::array<std::size_t, 3> of{c % 3, c / 3 % 3, c / 9};
    square10 covariance = by_reference * prior * by_reference.transpose() + tail.variance[0] * (scattered[0] + scattered[4]) + scattered[5] + 1e-8 * square10::Identity();
    double weight = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
      covariance += tail.variance[of[s]] * scattered[s + 1];
      weight += std::log(tail.share[of[s]]);
    }
    const Eigen::LLT<square10> factor(covariance);
    for (Eigen::Index i = 0; i < 10; ++i) weight -= std::log(factor.matrixL()(i, i));
    t.precision.push_back(factor.solve(square10::Identity()));
    t.gain.push_back(prior * by_reference.transpose() * t.precision.back());
    t.log_weight.push_back(weight);
  }
  for (int i = 0; i < k.points; ++i) {
    const track_point& p = e.track_points[static_cast<std::size_t>(k.first_point + i)];
    const auto station = static_cast<std::size_t>(p.station - 1);
    const std::size_t place = 3 * station + static_cast<std::size_t>(p.plane);
    const auto& s = p.smoothed.mean;
    if (p.plane == 1) at.segment<2>(static_cast<Eigen::Index>(2 * station)) << s[slope_state::x], s[slope_state::y];
    plane_reading& r = t.readings[place];
    const surface& here = way.surfaces[place];
    r.by_x = here.cos_angle;
    r.by_y = here.sin_angle;
    r.shift = (here.cos_angle * s[slope_state::tx] + here.sin_angle * s[slope_state::ty]) * (here.z - way.surfaces[3 * station + 1].z) - here.offset;
    r.pieces = pieces_of(e.clusters[static_cast<std::size_t>(p.cluster)], e, where.stations[station].planes[static_cast<std::size_t>(p.plane)]);
  }
  return t;
}

}  // namespace

TEST_CASE("the exact posterior leaves less than three per cent to be gained over the fit", "[integration]") {
  const auto data = test::shared_data();
  if (!data) return;
  const detector geometry = read_geometry(*data / "g4" / "geometry.json");
  const tracker& where = *geometry.find(1);
  reconstruction_options options;
  options.field = 3.0 * units::tesla;
  const auto reconstruct = make_reconstruction(geometry, options);
  typename decltype(reconstruct)::buffers work;
  const walk way(where, options.field);
  std::map<long, std::pair<vector<double, 5>, int>> truth;
  csv_reader rows(*data / "g4" / "tkd_helical_truth.csv.gz", {"event", "station", "plane", "x_mm", "y_mm", "px_MeV", "py_MeV", "pz_MeV"});
  while (rows.next_row()) {
    auto& [start, inside] = truth[rows.whole_number<long>(0)];
    inside += std::hypot(rows.number(3), rows.number(4)) < 150.0;
    if (rows.whole_number<int>(1) == 1 && rows.whole_number<int>(2) == 0) start << rows.number(3), rows.number(4), rows.number(5), rows.number(6), rows.number(7);
  }
  std::array<test::sample, 4> fitted, best;  // x, y, pt, pz over its error
  digit_reader digits(*data / "g4" / "tkd_helical_digits.csv.gz", geometry);
  event e;
  while (digits.read(e)) {
    reconstruct(e, work);
    const auto& [start, inside] = truth[e.number];
    if (inside < 15 || e.tracks.size() != 1 || e.tracks[0].planes != 15) continue;
    const track& k = e.tracks[0];
    const auto& m = k.reference.mean;
    if (std::hypot(m[0] - start[0], m[1] - start[1]) > 6.0 || std::hypot(m[2] - start[2], m[3] - start[3]) > 25.0) continue;
    places at = places::Zero();
    const linear_track t = linear_about(k, e, way, where, at);
    random_stream random(31, static_cast<std::uint64_t>(e.number), 0);
    const double px = start[2], py = start[3], pt = std::hypot(px, py);
    const auto along = [px, py, pt](double qx, double qy) { return (qx * px + qy * py) / pt - pt; };
    const auto mean = posterior_mean(t, at, 200, random, [&along](const slopes& s) {
      const double pz = 1.0 / std::abs(s[4]);
      return vector<double, 4>(s[0], s[2], along(s[1] * pz, s[3] * pz), s[4]);
    });
    const double error = kalman::sigma(k.reference, momentum_state::pz);
    const std::array<double, 4> a{m[0] - start[0], m[1] - start[1], along(m[2], m[3]), (m[4] - start[4]) / error};
    const std::array<double, 4> b{mean[0] - start[0], mean[1] - start[1], mean[2], (1.0 / std::abs(mean[3]) - start[4]) / error};
    for (std::size_t i = 0; i < 4; ++i) {
      fitted[i].add(a[i]);
      best[i].add(b[i]);
    }
  }
  REQUIRE(fitted[0].size() > 3500);
  constexpr std::array names{"x (mm)", "y (mm)", "pt (MeV/c)", "pz over its stated error"};
  for (std::size_t i = 0; i < 4; ++i) {
    WARN(names[i] << ": spread of the fit " << fitted[i].spread() << ", of the exact posterior mean " << best[i].spread());
    // Residuals that are the same to a few per cent have spreads whose difference is known to half a per cent.
    CHECK(best[i].spread() > 0.97 * fitted[i].spread());
    CHECK(best[i].spread() < 1.03 * fitted[i].spread());
  }
}
