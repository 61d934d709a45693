// SPDX-License-Identifier: MPL-2.0
// A clock drifts, and sometimes a reading of it is wrong: a process noise of your own, and a gate of your own that is strict once the filter has settled.
// Prints how well the offset is known with and without the gate, and fails where the gate does not pay.

#include <cmath>
#include <cstdint>
#include <cstdio>

#include <scifi/core/chi_squared.hpp>
#include <scifi/core/random.hpp>
#include <scifi/kalman.hpp>

namespace kalman = scifi::kalman;

struct offset {  // of a clock against another, ns and ns/s
  enum component { delay, rate };
};

struct ticking {
  using state_space = offset;
  scifi::matrix<double, 2, 2> transition(double seconds) const {
    scifi::matrix<double, 2, 2> f = scifi::matrix<double, 2, 2>::Identity();
    f(offset::delay, offset::rate) = seconds;
    return f;
  }
};

// [noise]
/// White noise of the frequency and its random walk, the two that make up most of a quartz oscillator's drift: the reading walks, and so does its rate.
struct oscillator_noise {
  using state_space = offset;
  double white;  // ns^2/s
  double walk;   // ns^2/s^3

  scifi::matrix<double, 2, 2> covariance(double seconds) const {
    const double t = std::abs(seconds);  // a step back in time is as uncertain as one forward
    scifi::matrix<double, 2, 2> q;
    q << white * t + walk * t * t * t / 3.0, walk * seconds * t / 2.0, walk * seconds * t / 2.0, walk * t;
    return q;
  }
};
// [noise]

// [gate]
/// Refuses what a true reading does in fewer than one case in `once_in`.
struct rare_refused {
  double once_in = 1.0e4;

  bool operator()(double chi2, int dimension) const {
    return scifi::chi_squared_probability(chi2, dimension) > 1.0 / once_in;
  }
};
// [gate]

struct reading {
  using state_space = offset;
  double ns, sigma;
  double value() const { return ns; }
  double covariance() const { return sigma * sigma; }
  scifi::matrix<double, 1, 2> projection() const { return {1.0, 0.0}; }
};

struct outcome {
  double rms = 0.0;
  int refused = 0;
};

template <class Filter>
outcome follow(const Filter& f, const oscillator_noise& noise) {
  constexpr int readings = 20000;
  scifi::random_stream random(31, 0, 0);
  scifi::vector<double, 2> truth(0.0, 0.0);
  kalman::estimate<double, 2> now = kalman::uncorrelated(truth, scifi::vector<double, 2>(10.0, 1.0));
  outcome out;
  const kalman::cholesky<double, 2> root(noise.covariance(1.0));
  for (int i = 0; i < readings; ++i) {
    truth = ticking{}.transition(1.0) * truth + root.lower() * scifi::vector<double, 2>(random.normal(), random.normal());
    const bool wrong = random.uniform() < 0.01;  // one in a hundred is of another clock
    const reading seen{truth[offset::delay] + (wrong ? random.uniform(-500.0, 500.0) : random.normal()), 1.0};
    const auto after = f.update(f.predict(now, 1.0), seen);
    if (!after.status.ok()) return {1e9, -1};
    now = after.posterior;
    out.refused += after.outlier ? 1 : 0;
    out.rms += std::pow(now.mean[offset::delay] - truth[offset::delay], 2);
  }
  out.rms = std::sqrt(out.rms / readings);
  return out;
}

int main() {
  const oscillator_noise noise{0.01, 1.0e-6};
  const outcome gated = follow(kalman::filter{ticking{}, noise, kalman::joseph{}, rare_refused{}}, noise);
  const outcome open = follow(kalman::filter{ticking{}, noise}, noise);
  std::printf("offset known to %.3f ns with the gate (%d of about 200 wrong readings refused), %.3f ns without\n", gated.rms, gated.refused, open.rms);

  // The steady state of the delay alone, from the Riccati equation of a random walk: P = (sqrt(Q^2 + 4 Q R) - Q)/2; the rate costs little beside it.
  const double steady = std::sqrt(0.5 * (std::sqrt(0.01 * 0.01 + 4.0 * 0.01) - 0.01));
  std::printf("a random walk of this strength can be known to %.3f ns\n", steady);
  return gated.refused > 150 && gated.refused < 260 && gated.rms < 1.3 * steady && gated.rms > 0.9 * steady && open.rms > 5.0 * gated.rms ? 0 : 1;
}
