// SPDX-License-Identifier: MPL-2.0
// A radar sees a ship at constant speed: range and bearing, a measurement of your own that is not linear and whose angle wraps. The ship passes west of
// the radar, where the bearing jumps from pi to -pi. Prints the pulls of many voyages and fails where they are not standard.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include <scifi/core/constants.hpp>
#include <scifi/core/random.hpp>
#include <scifi/kalman.hpp>

namespace kalman = scifi::kalman;

struct ship {  // m, m/s; x to the east, y to the north
  enum component { x, vx, y, vy };
};
using state = scifi::vector<double, 4>;

struct constant_velocity {
  using state_space = ship;
  scifi::matrix<double, 4, 4> transition(double dt) const {
    scifi::matrix<double, 4, 4> f = scifi::matrix<double, 4, 4>::Identity();
    f(ship::x, ship::vx) = f(ship::y, ship::vy) = dt;
    return f;
  }
};

// [radar]
struct radar {
  using state_space = ship;
  enum quantity { range, bearing };
  scifi::vector<double, 2> seen;  // m, rad
  scifi::vector<double, 2> sigma;

  scifi::vector<double, 2> value() const { return seen; }
  scifi::matrix<double, 2, 2> covariance() const { return sigma.array().square().matrix().asDiagonal(); }

  template <class Scalar>
  scifi::kalman::projected<Scalar, 2, 4> project(const scifi::vector<Scalar, 4>& s) const {
    using std::atan2, std::sqrt;
    const Scalar r2 = s[ship::x] * s[ship::x] + s[ship::y] * s[ship::y];
    const Scalar r = sqrt(r2);
    scifi::kalman::projected<Scalar, 2, 4> out;
    out.value << r, atan2(s[ship::y], s[ship::x]);
    out.jacobian.setZero();
    out.jacobian(range, ship::x) = s[ship::x] / r;
    out.jacobian(range, ship::y) = s[ship::y] / r;
    out.jacobian(bearing, ship::x) = -s[ship::y] / r2;
    out.jacobian(bearing, ship::y) = s[ship::x] / r2;
    return out;
  }

  /// Measured minus expected, the angle the short way round.
  template <class Scalar>
  scifi::vector<Scalar, 2> residual(const scifi::vector<Scalar, 2>& measured, const scifi::vector<Scalar, 2>& expected) const {
    scifi::vector<Scalar, 2> difference = measured - expected;
    difference[bearing] = std::remainder(difference[bearing], 2.0 * scifi::constants::pi);
    return difference;
  }
};
// [radar]

int main() {
  constexpr int voyages = 1000, scans = 60;
  constexpr double minute = 60.0;
  const kalman::filter f{constant_velocity{}, kalman::no_noise{}, kalman::iterated{}};

  std::array<double, 4> sum{}, squares{};
  double chi2 = 0.0;
  bool crossed = false;
  for (int voyage = 0; voyage < voyages; ++voyage) {
    scifi::random_stream random(7, static_cast<std::uint64_t>(voyage), 0);
    state truth(-8000.0, 0.5, 9000.0, -5.0);  // southwards, past the west
    kalman::estimate<double, 4> now = kalman::uncorrelated(truth, state(1000.0, 3.0, 1000.0, 3.0));
    for (int i = 0; i < 4; ++i) now.mean[i] += sigma(now, i) * random.normal();

    double before = 0.0;
    for (int scan = 0; scan < scans; ++scan) {
      truth = constant_velocity{}.transition(minute) * truth;
      radar echo{{}, {20.0, 0.003}};
      echo.seen = echo.project(truth).value;
      for (const auto quantity : {radar::range, radar::bearing}) echo.seen[quantity] += echo.sigma[quantity] * random.normal();
      echo.seen[radar::bearing] = std::remainder(echo.seen[radar::bearing], 2.0 * scifi::constants::pi);
      crossed = crossed || (before > 3.0 && echo.seen[radar::bearing] < -3.0);
      before = echo.seen[radar::bearing];

      const auto after = f.update(f.predict(now, minute), echo);
      if (!after.status.ok()) {
        std::printf("the %s failed: %s\n", to_string(after.status.step).data(), describe(after.status.why).data());
        return 1;
      }
      chi2 += after.chi2;
      now = after.posterior;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const int component = static_cast<int>(i);
      const double pull = (now.mean[component] - truth[component]) / sigma(now, component);
      sum[i] += pull;
      squares[i] += pull * pull;
    }
    if (voyage == 0)
      std::printf("an hour later: %.0f +- %.0f m east, %.0f +- %.0f m north; true %.0f, %.0f\n", now.mean[ship::x], sigma(now, ship::x), now.mean[ship::y],
                  sigma(now, ship::y), truth[ship::x], truth[ship::y]);
  }

  bool good = crossed;
  constexpr std::array<const char*, 4> names{"x", "vx", "y", "vy"};
  std::printf("pulls of %d voyages    mean   width\n", voyages);
  for (std::size_t i = 0; i < 4; ++i) {
    const double mean = sum[i] / voyages, width = std::sqrt(squares[i] / voyages - mean * mean);
    std::printf("  %-18s %6.3f  %6.3f\n", names[i], mean, width);
    good = good && std::abs(mean) < 4.0 / std::sqrt(voyages) && std::abs(width - 1.0) < 4.0 / std::sqrt(2.0 * voyages);
  }
  const double ndf = 2.0 * voyages * scans;
  std::printf("chi2 per degree of freedom %.4f\n", chi2 / ndf);
  return good && std::abs(chi2 / ndf - 1.0) < 4.0 * std::sqrt(2.0 / ndf) ? 0 : 1;
}
