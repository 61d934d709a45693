// SPDX-License-Identifier: MPL-2.0
// A propagator of one's own: a solenoid whose field grows along z. Only the equation of motion is written down; the Jacobian comes from
// dual numbers. Checked against what theory conserves and against the helix, then put into a filter where the helix would be wrong.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <vector>

#include <scifi/core/units.hpp>
#include <scifi/kalman.hpp>
#include <scifi/kalman/automatic_jacobian.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>

namespace kalman = scifi::kalman;
using namespace scifi::literals;
using scifi::slope_state;
using scifi::momentum_state;
using state = scifi::vector<double, 5>;

/// A step between two places along z, mm: in a field that changes, the length alone does not say enough.
struct stretch {
  double from, to;
};

/// Bz = field + gradient z on and off the axis; div B = 0 then asks for Bx = -gradient x/2, By = -gradient y/2.
/// Runge-Kutta of fourth order for dp/dz = q p x B / pz, written in slopes.
struct graded_solenoid {
  using state_space = slope_state;
  double field;     // at z = 0
  double gradient;  // per mm

  template <class Scalar>
  scifi::vector<Scalar, 5> slope_of(const scifi::vector<Scalar, 5>& v, double z) const {
    const Scalar bx = Scalar(-0.5 * gradient) * v[slope_state::x], by = Scalar(-0.5 * gradient) * v[slope_state::y], bz = Scalar(field + gradient * z);
    const Scalar tx = v[slope_state::tx], ty = v[slope_state::ty], k = v[slope_state::q_over_pz];
    const Scalar along = tx * by - ty * bx;  // dpz/dz over the charge
    scifi::vector<Scalar, 5> d;
    d << tx, k * (ty * bz - by - tx * along), ty, k * (bx - tx * bz - ty * along), -k * k * along;
    return d;
  }

  template <class Scalar>
  scifi::vector<Scalar, 5> operator()(const scifi::vector<Scalar, 5>& start, const stretch& step) const {
    constexpr double longest = 10.0;  // mm: about 0.05 rad of turning
    const int n = std::max(1, static_cast<int>(std::ceil(std::abs(step.to - step.from) / longest)));
    const double h = (step.to - step.from) / n;
    scifi::vector<Scalar, 5> v = start;
    for (int i = 0; i < n; ++i) {
      const double z = step.from + h * i;
      const scifi::vector<Scalar, 5> a = slope_of(v, z);
      const scifi::vector<Scalar, 5> b = slope_of<Scalar>(v + a * Scalar(0.5 * h), z + 0.5 * h);
      const scifi::vector<Scalar, 5> c = slope_of<Scalar>(v + b * Scalar(0.5 * h), z + 0.5 * h);
      const scifi::vector<Scalar, 5> d = slope_of<Scalar>(v + c * Scalar(h), z + h);
      v += (a + b * Scalar(2.0) + c * Scalar(2.0) + d) * Scalar(h / 6.0);
    }
    return v;
  }
};

/// The helix for the same steps.
struct uniform_solenoid {
  using state_space = slope_state;
  scifi::helix_propagator helix;
  template <class Scalar>
  auto propagate(const scifi::vector<Scalar, 5>& start, const stretch& step) const {
    return helix.propagate(start, step.to - step.from);
  }
};

/// What an axially symmetric field conserves besides |p|: x py - y px + q Bz r^2/2, the canonical angular momentum (here q = 1).
double angular_momentum(const state& v, double bz) {
  const state p = scifi::slopes_to_momentum(v, +1).state;
  const double x = p[momentum_state::x], y = p[momentum_state::y];
  return x * p[momentum_state::py] - y * p[momentum_state::px] + 0.5 * bz * (x * x + y * y);
}
double momentum(const state& v) { return scifi::slopes_to_momentum(v, +1).state.tail<3>().norm(); }

bool check(const char* what, double found, double limit) {
  std::printf("%-62s %9.2e, allowed %.0e\n", what, found, limit);
  return found <= limit;
}

/// Fits the points of a track, which carry no errors but are said to, by 0.2 mm each: chi2 is what the propagator gets wrong.
template <class Propagator>
double chi2_of_fit(const Propagator& propagator, const std::vector<state>& path, const std::vector<stretch>& steps) {
  const kalman::filter fit{propagator, kalman::no_noise{}};
  using measurement = scifi::point_measurement<slope_state>;
  std::vector<kalman::site<stretch, measurement>> sites;
  for (std::size_t i = 0; i < path.size(); ++i)
    sites.push_back({steps[i], {{path[i][slope_state::x], path[i][slope_state::y]}, 0.04 * scifi::matrix<double, 2, 2>::Identity()}});
  std::vector<kalman::node<double, 5, 2>> nodes(path.size());
  std::vector<state> references(path.size() + 1);
  state seed = path.front();
  seed[slope_state::q_over_pz] *= 1.03;
  const auto prior = kalman::uncorrelated(seed, state(50.0, 0.5, 50.0, 0.5, 0.005));
  const auto result = kalman::run_relinearised(fit, prior, seed, sites, nodes, references, 4);
  if (!result.status.ok()) return std::numeric_limits<double>::quiet_NaN();
  return result.chi2;
}

int main() {
  const double field = 3.0_T, gradient = 1.0_T / 1000.0;  // one tesla per metre
  const state start(30.0, 0.2, -20.0, 0.1, 1.0 / 200.0);
  const kalman::automatic_jacobian graded{graded_solenoid{field, gradient}};
  bool good = true;

  const auto flat = kalman::automatic_jacobian{graded_solenoid{field, 0.0}}.propagate(start, stretch{0.0, 1000.0});
  const auto helix = scifi::helix_propagator{field}.propagate(start, 1000.0);
  // Runge-Kutta errs by about (turning angle per step)^5/120 a step, 100 steps, on lengths of up to 1e2 mm and levers of 1e5 mm (MeV/c).
  good = check("without gradient: distance from the helix [mm]", (flat.state - helix.state).norm(), 1e-4) && good;
  good = check("without gradient: Jacobian against the helix's, relative", (flat.jacobian - helix.jacobian).norm() / helix.jacobian.norm(), 1e-5) && good;

  const state end = graded.propagate(start, stretch{0.0, 1000.0}).state;
  const double before = angular_momentum(start, field), after = angular_momentum(end, field + gradient * 1000.0);
  good = check("with gradient: change of |p|, relative", std::abs(momentum(end) / momentum(start) - 1.0), 1e-6) && good;
  good = check("with gradient: change of the angular momentum, relative", std::abs(after / before - 1.0), 1e-6) && good;
  std::printf("pz from %.3f to %.3f MeV/c as the field grows\n", 1.0 / start[slope_state::q_over_pz], 1.0 / end[slope_state::q_over_pz]);

  // Five stations on the true path, at their exact points.
  std::vector<state> path{start};
  std::vector<stretch> steps{{0.0, 0.0}};
  for (const double z : {200.0, 450.0, 750.0, 1100.0}) {
    steps.push_back({steps.back().to, z});
    path.push_back(graded.propagate(path.back(), steps.back()).state);
  }
  const double own = chi2_of_fit(graded, path, steps);
  const double other = chi2_of_fit(uniform_solenoid{{field + gradient * 550.0}}, path, steps);
  // The prior of q/pz, 3 % off and 100 % wide, pulls by (0.03)^2 at most; nothing else does.
  good = check("fit with the gradient: chi2 of 10 coordinates", own, 1e-3) && good;
  std::printf("fit with a helix in the mean field: chi2 %.1f\n", other);
  return good && other > 100.0 ? 0 : 1;
}
