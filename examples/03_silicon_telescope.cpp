// SPDX-License-Identifier: MPL-2.0
// A beam telescope of five double-sided silicon strip sensors in air: another detector described with the same types, and no field.
// Simulates straight pions with multiple scattering, fits them, and fails where the errors of the fit are not the errors made.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/core/units.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/kalman.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/line_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

namespace kalman = scifi::kalman;
using namespace scifi::literals;
using scifi::line_state;
using line = scifi::vector<double, 4>;

constexpr std::size_t sensors = 5;
constexpr double pitch = 50.0 * scifi::units::um;
constexpr double momentum = 5.0 * scifi::units::GeV;
constexpr scifi::highland_scattering highland;

/// A medium of one's own is a handful of numbers from the PDG's table.
constexpr scifi::material silicon{
    "silicon", 2.329, 21.82 / 2.329 * scifi::units::cm, 0.49848, 173.0 * scifi::units::eV, {0.14921, 3.2546, 0.2015, 2.8716, 4.4355, 0.14}};

scifi::tracker telescope() {
  scifi::tracker t;
  t.name = "telescope";
  t.gas = scifi::materials::air;
  for (std::size_t i = 0; i < sensors; ++i) {
    const double n = static_cast<double>(i);
    scifi::station sensor;  // 300 um of silicon with strips on both sides, a little out of line
    sensor.id = static_cast<int>(i) + 1;
    sensor.in_tracker = {{0.03 * n, -0.02 * n, 150.0 * n}, 5.0_mrad * n};
    for (const bool far_side : {false, true}) {
      scifi::plane strips;
      strips.view = far_side ? 'y' : 'x';
      strips.angle = far_side ? 90.0_deg : 0.0;
      strips.channels = 768;
      strips.central_channel = 383.5;
      strips.channel_width = pitch;
      strips.z_measured = far_side ? 0.3 : 0.0;
      (far_side ? strips.below : strips.above).add(scifi::whole(silicon, 0.15));
      sensor.planes.push_back(strips);
    }
    scifi::as_one_layer(sensor);
    t.stations.push_back(sensor);
  }
  return t;
}

/// The step from one surface to the next: what is behind the one, the air between, what is before the other.
scifi::leg leg_between(const scifi::surface& from, const scifi::surface& to, const scifi::material& gas) {
  scifi::leg step{to.z - from.z, 1, from.above, {}, to.below};
  const double free = step.dz - thickness(step.start) - thickness(step.finish);
  if (free > 1.0) step.gap.add(scifi::whole(gas, free));
  return step;
}

/// Flies a pion over a leg. In a thick layer the displacement and the angle come from two normal numbers each (PDG 2024, eqs. 34.22, 34.23).
line flown(line x, const scifi::leg& step, scifi::random_stream& random) {
  const auto kicked = [&](const auto& stack, double length) {
    double variance = 0.0;
    for (const scifi::slab& slice : stack) variance += highland.variance(momentum, scifi::pion_plus, slice, 1.0);
    const double sigma = std::sqrt(variance);
    for (const auto& [position, slope] : {std::array{line_state::x, line_state::tx}, std::array{line_state::y, line_state::ty}}) {
      const double a = random.normal(), b = random.normal();
      x[position] += length * sigma * (a / std::sqrt(12.0) + 0.5 * b);
      x[slope] += sigma * b;
    }
  };
  kicked(step.start, 0.0);
  x = scifi::line_propagator{}.transition(step.dz) * x;
  kicked(step.gap, step.dz);
  kicked(step.finish, 0.0);
  return x;
}

/// Mean and width of what should be standard normal.
struct pull_statistics {
  double sum = 0.0, squares = 0.0;
  int n = 0;
  void add(double pull) { sum += pull, squares += pull * pull, ++n; }
  double mean() const { return sum / n; }
  double width() const { return std::sqrt(squares / n - mean() * mean()); }
  bool standard() const { return std::abs(mean()) < 4.0 / std::sqrt(n) && std::abs(width() - 1.0) < 4.0 / std::sqrt(2.0 * n); }
};

int main() {
  const scifi::tracker detector = telescope();
  const std::vector<scifi::surface> surfaces = scifi::surfaces_along(detector, +1);
  std::vector<scifi::leg> legs{scifi::leg{}};  // the fit begins on the first surface
  for (std::size_t i = 1; i < surfaces.size(); ++i) legs.push_back(leg_between(surfaces[i - 1], surfaces[i], detector.gas));

  const kalman::filter fit{scifi::leg_propagator{scifi::line_propagator{}}, scifi::line_material_noise{highland, scifi::pion_plus, momentum}};
  const auto anywhere = kalman::uncorrelated(line(0.0, 0.0, 0.0, 0.0), line(100.0, 0.1, 100.0, 0.1));

  using measurement = scifi::fibre_measurement<line_state>;
  std::vector<kalman::site<scifi::leg, measurement>> sites(surfaces.size());
  std::vector<kalman::node<double, 4, 1>> nodes(surfaces.size());
  std::array<pull_statistics, 4> at_entry;
  std::vector<pull_statistics> at_surface(surfaces.size());
  double chi2 = 0.0;
  constexpr int tracks = 2000;

  for (int event = 0; event < tracks; ++event) {
    scifi::random_stream random(2024, static_cast<std::uint64_t>(event), 0);
    line x;
    x << random.uniform(-5.0, 5.0), 1.0_mrad * random.normal(), random.uniform(-5.0, 5.0), 1.0_mrad * random.normal();
    const line entry = x;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      if (i > 0) x = flown(x, legs[i], random);
      // The strip that is hit, and the middle of it as its coordinate: even odds within the pitch, variance pitch^2/12.
      const scifi::surface& at = surfaces[i];
      const scifi::plane& strips = detector.stations[static_cast<std::size_t>(at.station - 1)].planes[static_cast<std::size_t>(at.plane)];
      const double strip = std::round(strips.channel_at(at.tracker_to_alpha(x[line_state::x], x[line_state::y])));
      sites[i] = {legs[i], {strips.alpha(strip), pitch * pitch / 12.0, at.cos_angle, at.sin_angle, at.offset}};
    }

    const auto result = fit.run(anywhere, sites, nodes);
    if (!result.status.ok() || !kalman::smooth(nodes).ok()) {
      std::printf("track %d was not fitted\n", event);
      return 1;
    }
    chi2 += result.chi2;
    const auto& first = nodes.front().smoothed;
    for (const int i : {line_state::x, line_state::tx, line_state::y, line_state::ty})
      at_entry[static_cast<std::size_t>(i)].add((first.mean[i] - entry[i]) / sigma(first, i));
    for (std::size_t i = 0; i < nodes.size(); ++i) at_surface[i].add(pull(kalman::unbiased_residual(nodes[i])));
  }

  bool good = true;
  std::printf("pulls at the first sensor     mean   width\n");
  for (std::size_t i = 0; i < at_entry.size(); ++i) {
    std::printf("  %-24s %8.3f %7.3f\n", line_state::titles[i].data(), at_entry[i].mean(), at_entry[i].width());
    good = good && at_entry[i].standard();
  }
  std::printf("pulls of a surface the others predict\n");
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    std::printf("  sensor %d side %d %24.3f %7.3f\n", surfaces[i].station, surfaces[i].plane, at_surface[i].mean(), at_surface[i].width());
    good = good && at_surface[i].standard();
  }
  const double ndf = static_cast<double>(tracks) * (static_cast<double>(surfaces.size()) - 4.0);
  const double resolution = sigma(nodes.front().smoothed, line_state::x) / scifi::units::um;
  std::printf("chi2 per degree of freedom %.3f, resolution at the first sensor %.1f um\n", chi2 / ndf, resolution);
  good = good && std::abs(chi2 / ndf - 1.0) < 4.0 * std::sqrt(2.0 / ndf);
  return good ? 0 : 1;
}
