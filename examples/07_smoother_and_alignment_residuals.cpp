// SPDX-License-Identifier: MPL-2.0
// A smoother and the residuals it gives. A row of six planes measures one coordinate; one stands a quarter of a millimetre off and another counts its
// millimetres 0.5 % too long. The smoother shows that something is wrong, the alignment says what, and after it the residuals are what they should be.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <scifi/alignment/normal_equations.hpp>
#include <scifi/alignment/solution.hpp>
#include <scifi/alignment/track_linearisation.hpp>
#include <scifi/core/random.hpp>
#include <scifi/kalman.hpp>

namespace kalman = scifi::kalman;
namespace alignment = scifi::alignment;
using state = scifi::vector<double, 2>;  // position and slope

constexpr std::size_t planes = 6;
constexpr std::array<double, planes> z{0.0, 100.0, 200.0, 400.0, 600.0, 700.0};  // mm
constexpr double resolution = 0.1;                                             // mm
constexpr double scattering = 0.5e-3;                                          // rad in each plane
constexpr int tracks = 2000;

struct flight {
  scifi::matrix<double, 2, 2> transition(double dz) const { return (scifi::matrix<double, 2, 2>() << 1.0, dz, 0.0, 1.0).finished(); }
};

/// The plane at the start of a step scatters.
struct scatter {
  scifi::matrix<double, 2, 2> covariance(double dz) const {
    const state lever(dz, 1.0);
    return scattering * scattering * lever * lever.transpose();
  }
};

struct position {
  double measured;
  double value() const { return measured; }
  double covariance() const { return resolution * resolution; }
  scifi::matrix<double, 1, 2> projection() const { return {1.0, 0.0}; }
};

/// What is said of a plane: it measures offset + (1 + stretch) times the true position.
struct calibration {
  std::array<double, planes> offset{}, stretch{};
  double corrected(std::size_t plane, double raw) const { return (raw - offset[plane]) / (1.0 + stretch[plane]); }
};
enum parameter { offset = 0, stretch = planes };  // number of the first parameter of a kind

/// Raw measurements of a track in planes that are what `real` says.
std::array<double, planes> flown(const calibration& real, int number) {
  scifi::random_stream random(7, static_cast<std::uint64_t>(number), 0);
  state x(random.uniform(-50.0, 50.0), 0.05 * random.normal());
  std::array<double, planes> raw{};
  for (std::size_t i = 0; i < planes; ++i) {
    if (i > 0) x = flight{}.transition(z[i] - z[i - 1]) * x;
    raw[i] = real.offset[i] + (1.0 + real.stretch[i]) * x[0] + resolution * random.normal();
    x[1] += scattering * random.normal();
  }
  return raw;
}

/// What a pass over the tracks gathers.
struct gathered {
  std::array<double, planes> mean{}, square{};  // of the pulls of the unbiased residuals
  alignment::normal_equations equations{2 * planes};
};

gathered pass(const calibration& real, const calibration& believed) {
  const kalman::filter fit{flight{}, scatter{}};
  const alignment::track_linearisation<flight, scatter, 2> linearise{flight{}, scatter{}};
  decltype(linearise)::buffers work;
  alignment::track_equations equations;
  alignment::local_elimination eliminate;
  alignment::reduced_track reduced;
  std::vector<kalman::node<double, 2, 1>> nodes(planes);
  std::vector<kalman::site<double, position>> sites(planes);
  std::array<double, planes> steps{};
  gathered out;

  for (int number = 0; number < tracks; ++number) {
    const std::array<double, planes> raw = flown(real, number);
    for (std::size_t i = 0; i < planes; ++i) {
      steps[i] = i > 0 ? z[i] - z[i - 1] : 0.0;
      sites[i] = {steps[i], {believed.corrected(i, raw[i])}};
    }
    // [smooth]
    const auto start = kalman::uncorrelated(state(0.0, 0.0), state(1000.0, 1.0));
    if (!fit.run(start, sites, nodes).status.ok() || !kalman::smooth(nodes).ok()) continue;
    for (std::size_t i = 0; i < planes; ++i) {
      const double pull = kalman::pull(kalman::unbiased_residual(nodes[i]));  // of the measurement against all others
      out.mean[i] += pull / tracks;
      out.square[i] += pull * pull / tracks;
    }
    // [smooth]

    // [align]
    std::vector<state> reference;
    std::vector<alignment::stop_measurement<2>> stops;
    std::array<std::array<alignment::coefficient, 2>, planes> moved;
    for (std::size_t i = 0; i < planes; ++i) {
      const int plane = static_cast<int>(i);
      const double x = nodes[i].smoothed.mean[0];
      reference.push_back(nodes[i].smoothed.mean);
      moved[i] = {{{offset + plane, 1.0}, {stretch + plane, x}}};  // derivatives of what the plane measures
      stops.push_back({plane, sites[i].measurement.measured - x, resolution * resolution, position{}.projection(), moved[i]});
    }
    equations.clear(2);
    if (linearise(reference, steps, stops, equations, work) != alignment::failure::none) continue;
    eliminate(equations, 2 * planes, reduced);
    out.equations.add(reduced);
    // [align]
  }
  return out;
}

bool print_residuals(const char* when, const gathered& g) {
  std::printf("%s\n  plane   mean pull   width\n", when);
  bool standard = true;
  for (std::size_t i = 0; i < planes; ++i) {
    const double width = std::sqrt(g.square[i] - g.mean[i] * g.mean[i]);
    std::printf("  %5zu %11.3f %7.3f\n", i, g.mean[i], width);
    standard = standard && std::abs(g.mean[i]) < 4.0 / std::sqrt(tracks) && std::abs(width - 1.0) < 4.0 / std::sqrt(2.0 * tracks);
  }
  return standard;
}

int main() {
  calibration real, believed;
  real.offset[2] = 0.25;
  real.stretch[4] = 0.005;

  const gathered before = pass(real, believed);
  const bool wrong_before = !print_residuals("before", before);

  // Three things tracks cannot know: an offset that all planes share, one that grows with z, and a stretch that all share. The ends define them.
  // [solve]
  const int last = static_cast<int>(planes) - 1;
  const std::vector<alignment::constraint> frame{{"first offset", {{offset, 1.0}}}, {"last offset", {{offset + last, 1.0}}}, {"first stretch", {{stretch, 1.0}}}};
  const alignment::solution open = solve(before.equations, {});
  const alignment::solution found = solve(before.equations, frame);
  // [solve]
  if (found.status != alignment::failure::none) return 1;

  bool good = wrong_before && open.undetermined == 3;
  std::printf("without constraints %d of %zu parameters are not determined; with the ends held:\n", open.undetermined, 2 * planes);
  for (std::size_t i = 1; i < planes; ++i) {
    for (const int kind : {offset, stretch}) {
      if (kind == offset && i + 1 == planes) continue;
      const int k = kind + static_cast<int>(i);
      const double truth = kind == offset ? real.offset[i] : real.stretch[i];
      std::printf("  plane %zu %-8s %9.5f +- %.5f  (%.3f)\n", i, kind == offset ? "offset" : "stretch", found.values[k], found.sigma(k), truth);
      // The stretch multiplies the position: to first order in it, and 4 errors.
      good = good && std::abs(found.values[k] - truth) < 4.0 * found.sigma(k) + real.stretch[4] * std::abs(truth);
    }
    believed.offset[i] += found.values[offset + static_cast<int>(i)];
    believed.stretch[i] += found.values[stretch + static_cast<int>(i)];
  }
  good = print_residuals("after", pass(real, believed)) && good;
  return good ? 0 : 1;
}
