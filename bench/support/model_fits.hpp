// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include <scifi/candidate_to_track/fit_stops.hpp>
#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/relinearised.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/symmetric_form.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/prepared_leg.hpp>

#include "support/drawn_tracks.hpp"
#include "support/plain_fit.hpp"

namespace models {

namespace kalman = scifi::kalman;
using drawn::given;

inline const scifi::median_energy_loss loss{5.0};
inline const scifi::highland_scattering scattering;
inline const scifi::landau_straggling straggling{5.0};
using prepared = scifi::prepared_leg<scifi::median_energy_loss, scifi::highland_scattering, scifi::landau_straggling>;

inline std::vector<prepared> prepared_legs() {
  std::vector<prepared> out;
  for (const scifi::leg& l : given().path.legs) out.emplace_back(l, loss, scattering, straggling, scifi::muon_plus);
  return out;
}

/// All tracks drawn, with their measurements laid out, to be fitted one by one in one model.
template <class StateSpace, class Leg, class Propagator, class Noise>
class fits {
  static constexpr int dimension = StateSpace::dimension;

 public:
  fits(std::vector<Leg> legs, Propagator propagator, Noise noise) : legs_(std::move(legs)), filter_(propagator, noise, kalman::symmetric_form{}), propagator_(propagator), noise_(noise) {
    std::mt19937_64 engine(2028);
    for (const drawn::one_track& t : given().tracks) {
      one o;
      const scifi::vector<double, 5> sigmas{50.0, 0.5, 50.0, 0.5, 0.004};
      o.seed = t.seed.head<dimension>();
      o.start = {o.seed, scifi::matrix<double, dimension, dimension>::Zero()};
      for (int i = 0; i < dimension; ++i) o.start.covariance(i, i) = sigmas[i] * sigmas[i];
      scifi::set_stops(given().path, legs_, std::array{scifi::fit_job{&t.candidate, 0, t.points, t.clusters}}, o.memory);
      // Not the helix that was drawn.
      if constexpr (dimension == 4) straighten(o, engine);
      tracks_.push_back(std::move(o));
    }
    nodes_.resize(legs_.size());
    references_.resize(legs_.size() + 1);
  }
  fits(const fits&) = delete;
  fits& operator=(const fits&) = delete;

  /// Filter and, with `smoothed`, smoother. Returns chi2, NaN where the fit failed.
  double library(std::size_t i, bool smoothed) {
    const one& o = tracks_[i];
    references_[0] = o.seed;
    auto result = filter_.run(o.start, o.memory.stops, nodes_, kalman::detail::flown_references<decltype(references_)>{references_});
    if (smoothed && result.status.ok()) result.status = kalman::smooth(nodes_, kalman::modified_bryson_frazier{});
    benchmark::DoNotOptimize(nodes_.data());
    return result.status.ok() ? result.chi2 : std::nan("");
  }
  textbook::plain_result plain(std::size_t i, bool smoothed) const {
    const one& o = tracks_[i];
    return textbook::plain_fit<Propagator, Noise, decltype(o.memory.stops), dimension>(propagator_, noise_, o.memory.stops, o.seed, o.start, smoothed);
  }
  [[nodiscard]] const auto& nodes() const { return nodes_; }

 private:
  struct one {
    scifi::vector<double, dimension> seed;
    kalman::estimate<double, dimension> start;
    scifi::fit_memory<StateSpace, double, Leg> memory;
  };

  /// Measurements of the straight way of the seed, with Gaussian errors.
  static void straighten(one& o, std::mt19937_64& engine) {
    std::normal_distribution<double> normal;
    const std::vector<scifi::surface>& surfaces = given().path.surfaces;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const double dz = surfaces[i].z - surfaces.front().z;
      auto& seen = *o.memory.stops[i].measurement;
      seen.alpha = surfaces[i].tracker_to_alpha(o.seed[0] + dz * o.seed[1], o.seed[2] + dz * o.seed[3]) + std::sqrt(seen.alpha_variance) * normal(engine);
    }
  }

  std::vector<Leg> legs_;
  kalman::filter<Propagator, Noise, kalman::symmetric_form> filter_;
  Propagator propagator_;
  Noise noise_;
  std::vector<one> tracks_;
  std::vector<kalman::node<double, dimension, 1>> nodes_;
  std::vector<scifi::vector<double, dimension>> references_;
};

}  // namespace models
