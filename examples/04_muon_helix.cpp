// SPDX-License-Identifier: MPL-2.0
// Muons through a MICE tracker: a helix in 3 T that loses energy and scatters in fibres, mylar and helium. The fit starts at the far
// end and works towards the beam, where the momentum is wanted. Prints one track and the pulls of many; fails where they are not standard.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/kalman.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

namespace kalman = scifi::kalman;
using namespace scifi::literals;
using scifi::slope_state;
using state = scifi::vector<double, 5>;

constexpr scifi::particle muon = scifi::muon_plus;
constexpr int downstream = +1;  // the muons fly towards growing z
constexpr scifi::highland_scattering highland;

/// The step from one surface to another, in either direction: the sides of the planes that face each other, and the gas between.
scifi::leg leg_between(const scifi::surface& from, const scifi::surface& to, const scifi::material& gas) {
  const bool up = to.z > from.z;
  scifi::leg step{to.z - from.z, up ? +1 : -1, up ? from.above : from.below, {}, up ? to.below : to.above};
  const double free = std::abs(step.dz) - thickness(step.start) - thickness(step.finish);
  if (free > 1.0) step.gap.add(scifi::whole(gas, free));
  return step;
}

/// Scatters a muon in thin material: each projection of its direction is turned by Highland's angle, its momentum stays.
state scattered(const state& x, const scifi::slab_stack<4>& material, scifi::random_stream& random) {
  const double path = std::hypot(1.0, x[slope_state::tx], x[slope_state::ty]);
  double variance = 0.0;
  for (const scifi::slab& slice : material) variance += highland.variance(path / std::abs(x[slope_state::q_over_pz]), muon, slice, path);
  const scifi::matrix<double, 2, 2> c = scifi::slope_covariance(x[slope_state::tx], x[slope_state::ty], variance);
  const double a = random.normal(), b = random.normal();
  const double width = std::sqrt(c(0, 0));
  state y = x;
  if (!(width > 0.0)) return y;
  y[slope_state::tx] += width * a;
  y[slope_state::ty] += c(0, 1) / width * a + std::sqrt(c(1, 1) - c(0, 1) * c(0, 1) / c(0, 0)) * b;
  y[slope_state::q_over_pz] *= std::hypot(1.0, y[slope_state::tx], y[slope_state::ty]) / path;
  return y;
}

int main() {
  const scifi::detector mice = scifi::mice::trackers();
  const scifi::tracker& tracker = *mice.find(scifi::mice::downstream);
  const std::vector<scifi::surface> forward = scifi::surfaces_along(tracker, +1), backward = scifi::surfaces_along(tracker, -1);
  const std::size_t n = forward.size();

  const scifi::energy_loss_propagator model{scifi::helix_propagator{3.0_T}, scifi::mean_energy_loss{}, muon, downstream};
  const kalman::filter fit{model, scifi::material_noise{highland, scifi::no_straggling{}, muon}};

  using measurement = scifi::fibre_measurement<slope_state>;
  std::vector<kalman::site<scifi::leg, measurement>> sites(n);
  std::vector<kalman::node<double, 5, 1>> nodes(n);
  std::vector<state> references(n + 1), path(n);
  std::array<double, 5> sum{}, squares{};
  double chi2 = 0.0;
  constexpr int muons = 1000;
  constexpr double resolution = 1.4945 / 3.4641016;  // one channel's width over sqrt 12

  for (int event = 0; event < muons; ++event) {
    scifi::random_stream random(2015, static_cast<std::uint64_t>(event), 0);
    state x;
    const double pz = random.uniform(140.0, 240.0);
    x << 20.0 * random.normal(), 0.1 * random.normal(), 20.0 * random.normal(), 0.1 * random.normal(), 1.0 / pz;

    // The true path, surface by surface: scatter, fly and lose energy, scatter. The gas slows but its scattering is left out here.
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) {
        const scifi::leg step = leg_between(forward[i - 1], forward[i], tracker.gas);
        x = model.propagate(scattered(x, step.start, random), step).state;
        x = scattered(x, step.finish, random);
      }
      path[n - 1 - i] = x;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const scifi::surface& at = backward[i];
      scifi::leg step = i == 0 ? scifi::leg{} : leg_between(backward[i - 1], at, tracker.gas);
      const double alpha = at.tracker_to_alpha(path[i][slope_state::x], path[i][slope_state::y]) + resolution * random.normal();
      sites[i] = {step, {alpha, resolution * resolution, at.cos_angle, at.sin_angle, at.offset}};
    }

    // A poor idea of the track, as pattern recognition would give it; the fit is linearised about it, then about itself.
    const state spread(30.0, 0.2, 30.0, 0.2, 0.002);
    state seed = path[0];
    for (int i = 0; i < slope_state::dimension; ++i) seed[i] += 0.03 * spread[i] * random.normal();
    const kalman::estimate<double, 5> prior = kalman::uncorrelated(seed, spread);
    const auto result = kalman::run_relinearised(fit, prior, seed, sites, nodes, references, 2);
    if (!result.status.ok()) {
      std::printf("muon %d: the %s failed: %s\n", event, to_string(result.status.step).data(), describe(result.status.why).data());
      return 1;
    }
    chi2 += result.chi2;
    const auto& end = nodes.back().smoothed;
    for (std::size_t i = 0; i < 5; ++i) {
      const int component = static_cast<int>(i);
      const double pull = (end.mean[component] - path[n - 1][component]) / sigma(end, component);
      sum[i] += pull;
      squares[i] += pull * pull;
    }

    if (event > 0) continue;
    std::printf("one muon     z [mm]      x      y [mm]     tx      ty     pz [MeV/c]   true   pull of the fibre\n");
    for (std::size_t i = 0; i < n; ++i) {
      const auto& fitted = nodes[i].smoothed;
      const state& v = fitted.mean;
      const double fitted_pz = 1.0 / v[slope_state::q_over_pz], error = sigma(fitted, slope_state::q_over_pz) * fitted_pz * fitted_pz;
      std::printf("  %d %d      %8.2f %7.2f %7.2f %8.4f %7.4f   %7.2f +- %4.2f  %6.2f  %6.2f\n", backward[i].station, backward[i].plane, backward[i].z,
                  v[slope_state::x], v[slope_state::y], v[slope_state::tx], v[slope_state::ty], fitted_pz, error, 1.0 / path[i][slope_state::q_over_pz],
                  pull(kalman::unbiased_residual(nodes[i])));
    }
  }

  bool good = true;
  std::printf("pulls of %d muons at station 1   mean   width\n", muons);
  for (std::size_t i = 0; i < 5; ++i) {
    const double mean = sum[i] / muons, width = std::sqrt(squares[i] / muons - mean * mean);
    std::printf("  %-34s %6.3f %6.3f\n", slope_state::titles[i].data(), mean, width);
    good = good && std::abs(mean) < 4.0 / std::sqrt(muons) && std::abs(width - 1.0) < 4.0 / std::sqrt(2.0 * muons);
  }
  const double ndf = muons * (static_cast<double>(n) - 5.0);
  std::printf("chi2 per degree of freedom %.3f\n", chi2 / ndf);
  return good && std::abs(chi2 / ndf - 1.0) < 4.0 * std::sqrt(2.0 / ndf) ? 0 : 1;
}
