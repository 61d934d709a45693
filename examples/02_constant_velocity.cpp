// SPDX-License-Identifier: MPL-2.0
// A body moves along a line and its position is measured now and then: a model of your own is a few plain structs.

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include <scifi/kalman.hpp>

namespace kalman = scifi::kalman;

// [model]
struct motion {  // mm, mm/ns
  enum component { position, velocity };
};

struct constant_velocity {
  using state_space = motion;
  scifi::matrix<double, 2, 2> transition(double dt) const {
    scifi::matrix<double, 2, 2> f = scifi::matrix<double, 2, 2>::Identity();
    f(motion::position, motion::velocity) = dt;
    return f;
  }
};

struct white_noise {  // of the acceleration
  using state_space = motion;
  double density;
  scifi::matrix<double, 2, 2> covariance(double dt) const {
    const double t = std::abs(dt);  // a step back in time is as uncertain as one forward
    scifi::matrix<double, 2, 2> q;
    q << t * t * t / 3.0, dt * t / 2.0, dt * t / 2.0, t;
    return density * q;
  }
};

struct position_measurement {
  using state_space = motion;
  double z, sigma;
  double value() const { return z; }
  double covariance() const { return sigma * sigma; }
  scifi::matrix<double, 1, 2> projection() const { return {1.0, 0.0}; }
};
// [model]

namespace {

bool close(double a, double b) { return std::abs(a - b) <= 1e-9 * (1.0 + std::abs(b)); }

/// Without noise and with a vague start the filter is the straight line through n equally spaced points by least squares.
bool check_line() {
  // [run]
  using site = kalman::site<std::optional<double>, position_measurement>;
  const std::array<site, 5> sites{{{kalman::at_start, {0.1, 0.2}}, {1.0, {0.9, 0.2}}, {1.0, {2.3, 0.2}}, {1.0, {2.8, 0.2}}, {1.0, {4.2, 0.2}}}};
  std::array<kalman::node<double, 2, 1>, 5> nodes;

  const kalman::estimate vague{scifi::vector<double, 2>(0.0, 0.0), scifi::matrix<double, 2, 2>(1e8 * scifi::matrix<double, 2, 2>::Identity())};
  const kalman::filter f{constant_velocity{}, kalman::no_noise{}};
  const auto result = f.run(vague, sites, nodes);
  const kalman::status smoothed = kalman::smooth(nodes);
  // [run]
  if (!result.status.ok() || !smoothed.ok()) return false;

  const double mean = (0.1 + 0.9 + 2.3 + 2.8 + 4.2) / 5.0;
  const double slope = (-2.0 * 0.1 - 0.9 + 2.8 + 2.0 * 4.2) / 10.0;  // sum t z / sum t^2, t from the middle
  const auto& first = nodes.front().smoothed;
  std::printf("velocity %.6f, by least squares %.6f; chi2 %.4f for %d - 2 degrees of freedom\n", first.mean(motion::velocity), slope, result.chi2, result.ndf);
  return std::abs(first.mean(motion::velocity) - slope) < 1e-6 && std::abs(first.mean(motion::position) - (mean - 2.0 * slope)) < 1e-6 &&
         std::abs(kalman::sigma(first, motion::velocity) - 0.2 / std::sqrt(10.0)) < 1e-6;
}

}  // namespace

int main() {
  // [step]
  const kalman::filter f{constant_velocity{}, white_noise{0.1}};
  const kalman::estimate s0{scifi::vector<double, 2>(0.0, 1.0), scifi::matrix<double, 2, 2>(scifi::matrix<double, 2, 2>::Identity())};
  const auto s = f.update(f.predict(s0, 2.0), position_measurement{2.5, 0.5});
  // [step]

  // By hand: P = [[1 + 4 + 0.8/3, 2 + 0.2], [2.2, 1.2]], S = P00 + 0.25, residual 0.5.
  const double p00 = 5.0 + 0.8 / 3.0, total = p00 + 0.25;
  std::printf("position %.6f, velocity %.6f, chi2 %.6f\n", s.posterior.mean(motion::position), s.posterior.mean(motion::velocity), s.chi2);
  const bool step_right = s.status.ok() && close(s.posterior.mean(motion::position), 2.0 + 0.5 * p00 / total) &&
                          close(s.posterior.mean(motion::velocity), 1.0 + 0.5 * 2.2 / total) &&
                          close(s.posterior.covariance(motion::velocity, motion::velocity), 1.2 - 2.2 * 2.2 / total) && close(s.chi2, 0.25 / total);
  return step_right && check_line() ? 0 : 1;
}
