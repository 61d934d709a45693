// SPDX-License-Identifier: MPL-2.0
// What bench/instructions/compare.py counts the instructions of: filter_steps, a thousand steps of five components and one measured value, and track_fits, filter and
// smoother of 64 helices through fifteen planes with all material. Counting starts and ends with each function.
#include <cmath>

#include <scifi/kalman/filter.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

#include "support/model_fits.hpp"

namespace {

namespace kalman = scifi::kalman;
using square = scifi::matrix<double, 5, 5>;

struct constant_model {
  square f, q;
  const square& transition(double) const { return f; }
  const square& covariance(double) const { return q; }
};

struct row {
  scifi::matrix<double, 1, 5> h;
  double z;
  double value() const { return z; }
  double covariance() const { return 1.5; }
  const scifi::matrix<double, 1, 5>& projection() const { return h; }
};

auto helices() {
  const scifi::energy_loss_propagator fly{scifi::helix_propagator{drawn::field}, models::loss, scifi::muon_plus, drawn::given().tracker.beam_direction};
  const scifi::material_noise noise{models::scattering, models::straggling, scifi::muon_plus};
  return models::fits<scifi::slope_state, models::prepared, decltype(fly), decltype(noise)>(models::prepared_legs(), fly, noise);
}

}  // namespace

extern "C" [[gnu::noinline]] double filter_steps() {
  std::mt19937_64 engine(51);
  constant_model model;
  row seen{};
  for (int i = 0; i < 25; ++i) model.f.data()[i] = 0.04 * static_cast<double>(engine() % 8);
  model.q = 0.1 * square::Identity();
  seen.h << 1.0, 0.5, -0.5, 0.25, -0.25;
  const kalman::filter filter{model, model, kalman::symmetric_form{}};
  kalman::estimate<double, 5> e{scifi::vector<double, 5>::Zero(), square::Identity()};
  double chi2 = 0.0;
  for (int i = 0; i < 1000; ++i) {
    seen.z = static_cast<double>(i % 7) - 3.0;
    const auto u = filter.update(filter.predict(e, 1.0), seen);
    chi2 += u.chi2;
    e = u.posterior;
  }
  return chi2;
}

extern "C" [[gnu::noinline]] double track_fits(decltype(helices())& all) {
  double chi2 = 0.0;
  for (std::size_t i = 0; i < drawn::given().tracks.size(); ++i) chi2 += all.library(i, true);
  return chi2;
}

int main() {
  auto all = helices();
  return std::isfinite(filter_steps()) && std::isfinite(track_fits(all)) ? 0 : 1;
}
