// SPDX-License-Identifier: MPL-2.0
// Your own parts: a body falls in air and a radar beside it measures its distance; then a scattering model tuned to a measurement.
// Prints the fit beside the truth and fails where they differ by more than the fit says.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/automatic_jacobian.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/model_value.hpp>
#include <scifi/material/concepts.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/material/scattering.hpp>

// [state]
struct fall {  // m, m/s; speed is positive upwards
  enum component { height, speed };
  static constexpr int dimension = 2;
};
// [state]

// [propagator]
struct falling {
  using state_space = fall;
  double gravity = 9.81;    // m/s^2
  double drag_time = 20.0;  // s, the speed decays with it

  template <class Scalar>
  scifi::kalman::propagated<Scalar, 2> propagate(const scifi::vector<Scalar, 2>& start, double dt) const {
    const double kept = std::exp(-dt / drag_time);
    const double reach = drag_time * (1.0 - kept);
    const double terminal = -gravity * drag_time;

    scifi::kalman::propagated<Scalar, 2> end;
    end.state[fall::speed] = terminal + (start[fall::speed] - terminal) * kept;
    end.state[fall::height] = start[fall::height] + terminal * dt + (start[fall::speed] - terminal) * reach;
    end.jacobian.setIdentity();
    end.jacobian(fall::height, fall::speed) = reach;
    end.jacobian(fall::speed, fall::speed) = kept;
    return end;
  }
};
// [propagator]

// [noise]
struct gusts {
  using state_space = fall;
  double strength = 0.01;  // (m/s)^2 of speed per second

  scifi::matrix<double, 2, 2> covariance(double dt) const {
    scifi::matrix<double, 2, 2> q;
    q << dt * dt * dt / 3.0, dt * dt / 2.0, dt * dt / 2.0, dt;
    return strength * q;
  }
};
// [noise]

// [measurement]
struct radar {
  using state_space = fall;
  double distance;     // measured, m
  double sigma = 0.5;  // m
  double aside = 200.0;  // the radar stands this far from the point of impact, m

  double value() const { return distance; }
  double covariance() const { return sigma * sigma; }

  template <class Scalar>
  scifi::kalman::projected<Scalar, 1, 2> project(const scifi::vector<Scalar, 2>& x) const {
    using std::sqrt;  // found for any scalar: double, dual number, pack of lanes
    const Scalar height = x[fall::height];
    const Scalar expected = sqrt(height * height + Scalar(aside * aside));
    scifi::kalman::projected<Scalar, 1, 2> out;
    out.value << expected;
    out.jacobian << height / expected, Scalar(0.0);
    return out;
  }
};
// [measurement]

// [automatic]
struct falls_to {  // where the body is after dt
  using state_space = fall;

  template <class Scalar>
  scifi::vector<Scalar, 2> operator()(const scifi::vector<Scalar, 2>& start, double dt) const {
    const double kept = std::exp(-dt / 20.0), terminal = -9.81 * 20.0;
    const Scalar above = start[fall::speed] - Scalar(terminal);
    return {start[fall::height] + Scalar(terminal * dt) + above * Scalar(20.0 * (1.0 - kept)), Scalar(terminal) + above * Scalar(kept)};
  }
};
struct echo {
  using state_space = fall;
  double distance;
  double value() const { return distance; }
  double covariance() const { return 0.25; }

  template <class Scalar>
  Scalar expected(const scifi::vector<Scalar, 2>& x) const {
    using std::sqrt;
    return sqrt(x[fall::height] * x[fall::height] + Scalar(200.0 * 200.0));
  }
};
// [automatic]

// [gate]
struct five_sigma {
  template <class Scalar>
  auto operator()(const Scalar& chi2, int dimension) const {
    return chi2 < Scalar(25.0 * dimension);
  }
};
// [gate]

// [scattering]
struct scaled_highland {
  using variance_of = scifi::scattering_angle;
  double width;  // of Highland's: about 0.91 in lithium hydride at 172 to 240 MeV/c (MICE, arXiv:2209.10251)

  template <scifi::scalar Scalar>
  Scalar variance(const Scalar& p, const scifi::particle& hypothesis, const scifi::slab& s, const Scalar& path_over_thickness) const {
    return Scalar(width * width) * scifi::highland_scattering{}.variance(p, hypothesis, s, path_over_thickness);
  }
};
static_assert(scifi::scattering_policy<scaled_highland>);
// [scattering]

int main() {
  namespace kalman = scifi::kalman;

  // [run]
  const kalman::filter fit{falling{}, gusts{}, kalman::joseph{}, five_sigma{}};
  kalman::estimate<double, 2> now = kalman::uncorrelated(scifi::vector<double, 2>(950.0, 0.0), scifi::vector<double, 2>(100.0, 10.0));
  // [run]

  const double step = 0.25;
  const falling truth{};
  scifi::vector<double, 2> body(1000.0, -5.0);
  int outliers = 0;
  double unlike = 0.0;
  for (int i = 0; i < 40; ++i) {
    body = truth.propagate(body, step).state;
    const double stray = i == 20 ? 50.0 : 0.0;  // one measurement is of something else
    const radar seen{std::hypot(body[fall::height], 200.0) + stray};

    // [automatic_step]
    const kalman::filter plainly{kalman::automatic_jacobian{falls_to{}}, gusts{}, kalman::joseph{}, five_sigma{}};
    const auto posterior = plainly.update(plainly.predict(now, step), kalman::automatic_projection{echo{seen.distance}}).posterior;
    // [automatic_step]

    // [step]
    const auto after = fit.update(fit.predict(now, step), seen);
    if (!after.status.ok()) {
      std::printf("the %s failed: %s\n", to_string(after.status.step).data(), describe(after.status.why).data());
      return 1;
    }
    now = after.posterior;
    // [step]
    unlike = std::max(unlike, (now.mean - posterior.mean).norm());
    outliers += after.outlier ? 1 : 0;
  }

  const double sigma_height = sigma(now, fall::height);
  const double sigma_speed = sigma(now, fall::speed);
  std::printf("height %8.2f +- %.2f m    true %8.2f\n", now.mean[fall::height], sigma_height, body[fall::height]);
  std::printf("speed  %8.2f +- %.2f m/s  true %8.2f\n", now.mean[fall::speed], sigma_speed, body[fall::speed]);
  std::printf("%d outlier refused; with automatic Jacobians the state differs by %.0e\n", outliers, unlike);
  // The measurements carry no error, so the fit must be closer than its own error.
  const bool close = std::abs(now.mean[fall::height] - body[fall::height]) < sigma_height && std::abs(now.mean[fall::speed] - body[fall::speed]) < sigma_speed;

  const scifi::slab absorber = scifi::whole(scifi::materials::lithium_hydride, 65.0);
  const double own = std::sqrt(scaled_highland{0.91}.variance(200.0, scifi::muon_plus, absorber, 1.0));
  const double highland = std::sqrt(scifi::highland_scattering{}.variance(200.0, scifi::muon_plus, absorber, 1.0));
  std::printf("65 mm of lithium hydride at 200 MeV/c: %.1f mrad, Highland %.1f mrad\n", 1e3 * own, 1e3 * highland);
  return close && outliers == 1 && unlike < 1e-10 && std::abs(own / highland - 0.91) < 1e-12 ? 0 : 1;
}
