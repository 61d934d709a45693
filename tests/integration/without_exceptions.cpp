// SPDX-License-Identifier: MPL-2.0
// Compiled with -fno-exceptions -fno-rtti: the filter and the fit of a helix through fifteen planes, with smoother, material and statuses of failures.
#if defined(__cpp_exceptions) || defined(__cpp_rtti)
#error "this program is compiled without exceptions and without run-time types"
#endif

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include <scifi/core/units.hpp>
#include <scifi/kalman.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/leg.hpp>
#include <scifi/track_model/material_noise.hpp>

namespace kalman = scifi::kalman;
using scifi::slope_state;

namespace {

constexpr int planes = 15;
constexpr double distance = 70.0;  // mm

/// Half a millimetre of polystyrene at either end of 70 mm of vacuum.
scifi::leg between_planes() {
  scifi::leg step{distance, +1, {}, {}, {}};
  step.start.add(scifi::whole(scifi::materials::polystyrene, 0.5));
  step.finish.add(scifi::whole(scifi::materials::polystyrene, 0.5));
  return step;
}

int failures = 0;
void check(bool right, const char* what) {
  if (right) return;
  std::fprintf(stderr, "%s\n", what);
  ++failures;
}

}  // namespace

int main() {
  using measurement = scifi::fibre_measurement<slope_state>;
  const scifi::energy_loss_propagator fly{scifi::helix_propagator{3.0 * scifi::units::tesla}, scifi::mean_energy_loss{}, scifi::muon_plus, +1};
  const kalman::filter fit{fly, scifi::material_noise{scifi::highland_scattering{}, scifi::no_straggling{}, scifi::muon_plus}, kalman::symmetric_form{}};
  const scifi::leg step = between_planes();

  scifi::vector<double, 5> truth;
  truth << 10.0, 0.15, -20.0, -0.1, 1.0 / 200.0;
  const kalman::estimate<double, 5> start = kalman::uncorrelated(truth, scifi::vector<double, 5>(50.0, 0.5, 50.0, 0.5, 0.004));
  std::array<kalman::site<scifi::leg, measurement>, planes> sites;
  scifi::vector<double, 5> x = truth;
  for (int k = 0; k < planes; ++k) {
    x = fly.propagate(x, step).state;
    const double angle = 2.0943951023931953 * k;  // three views, 120 degrees apart
    measurement m{0.0, 0.2, std::cos(angle), std::sin(angle), 0.0};
    m.alpha = m.cos_angle * x[slope_state::x] + m.sin_angle * x[slope_state::y];
    sites[static_cast<std::size_t>(k)] = {step, m};
  }

  // Measurements without errors of a model that is right: the fit ends on the truth.
  std::array<kalman::node<double, 5, 1>, planes> nodes;
  const auto run = fit.run(start, sites, nodes);
  check(run.status.ok() && run.reached == planes && run.chi2 < 1e-12, "the filter did not follow the helix");
  check(kalman::smooth(nodes, kalman::modified_bryson_frazier{}).ok(), "the smoother failed");
  for (int i = 0; i < 5; ++i) check(std::abs(nodes.back().smoothed.mean(i) - x(i)) < 1e-6 * kalman::sigma(start, i), "the fit is not on the helix");

  kalman::estimate<double, 5> in_place = start;
  for (const auto& site : sites) check(fit.advance(in_place, site.step, site.measurement).status.ok(), "a step in place failed");
  check((in_place.mean - nodes.back().filtered.mean).norm() < 1e-9, "steps in place end elsewhere");

  // Failures come back as statuses.
  sites[7].measurement.alpha = std::numeric_limits<double>::quiet_NaN();
  const auto failed = fit.run(start, sites, nodes);
  check(failed.failed_at == 7 && failed.status.why == kalman::reason::not_finite, "a measurement that is not a number went unnoticed");
  return failures == 0 ? 0 : 1;
}
