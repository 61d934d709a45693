// SPDX-License-Identifier: MPL-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/particle_to_hit/gaussian_beam.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

#include "extreme/extremes.hpp"
#include "support/catch.hpp"

using namespace scifi;
using test::all_finite;
using test::extremes;
using test::infinity;
using test::not_a_number;

namespace {

const detector& trackers() {
  static const detector both = mice::trackers();
  return both;
}
const transport_settings three_tesla{3.0 * units::tesla, 160.0, {}};

moving_particle muon() {
  moving_particle m;
  m.position = {10.0, -20.0, -30.0};
  m.momentum = {20.0, 10.0, 200.0};
  return m;
}

/// What a flight leaves of a particle that started anywhere with anything.
void no_hit_of_nothing(const truth& out) {
  for (const hit& h : out.hits) CHECK((std::isfinite(h.edep) && h.edep > 0.0 && all_finite(h.position) && all_finite(h.momentum)));
  for (const crossing& c : out.crossings) CHECK((all_finite(c.position) && all_finite(c.momentum)));
}

}  // namespace

TEST_CASE("a particle that starts with any numbers is flown to an end and leaves hits of finite energy only", "[extreme]") {
  const tracker& t = *trackers().find(mice::downstream);
  const transport fly(t, three_tesla);
  for (const particle& what : {muon_plus, pion_plus, electron, proton})
    for (int slot = 0; slot < 7; ++slot)
      for (const double x : extremes) {
        INFO(what.name << ", slot " << slot << " is " << x);
        moving_particle start = muon();
        start.hypothesis = what;
        (slot < 3 ? start.position[slot] : slot < 6 ? start.momentum[slot - 3] : start.t) = x;
        random_stream random(1, 0, 0);
        truth out;
        const flight_end end = fly(start, 1, random, out);
        no_hit_of_nothing(out);
        if (!std::isfinite(x)) CHECK((end == flight_end::left && out.hits.empty() && out.crossings.empty()));
      }
}

TEST_CASE("transport with any settings comes to an end", "[extreme]") {
  const tracker& t = *trackers().find(mice::downstream);
  for (const double x : extremes)
    for (int slot = 0; slot < 5; ++slot) {
      INFO("slot " << slot << " is " << x);
      transport_settings settings = three_tesla;
      if (slot == 2 && std::abs(x) <= 1e-160) continue;  // every knocked-on electron followed to its end: right, and long
      const std::array<double*, 5> at{&settings.field, &settings.radius, &settings.follow_electrons_from, &settings.most_turns, &settings.doublet.core_diameter};
      *at[static_cast<std::size_t>(slot)] = x;
      random_stream random(2, 0, 0);
      truth out;
      (void)transport(t, settings)(muon(), 1, random, out);
      no_hit_of_nothing(out);
    }
}

TEST_CASE("a loss is drawn in a moment from any medium and any path, and is not negative", "[extreme]") {
  random_stream random(3, 0, 0);
  for (const double x : extremes)
    for (int slot = 0; slot < 5; ++slot) {
      INFO("slot " << slot << " is " << x);
      material medium = slot == 0 ? materials::air : materials::polystyrene;
      double p = 200.0, path = 1.0;
      collision_loss loss;
      const std::array<double*, 5> at{&medium.density, &p, &path, &loss.limit, &loss.excitations};
      *at[static_cast<std::size_t>(slot)] = x;
      CHECK_FALSE(loss.sample(p, muon_plus, medium, path, random) < 0.0);
    }
}

TEST_CASE("a scatter by an angle that is not a number leaves no direction, instead of the one before", "[extreme]") {
  const vector<double, 3> forward(1.0, 2.0, 200.0);
  for (const double x : {not_a_number, infinity, -infinity}) {
    CHECK_FALSE(all_finite(turned_by(forward, {x, 0.1})));
    CHECK_FALSE(all_finite(turned_by(forward, {0.1, x})));
  }
  CHECK(turned_by(forward, {0.0, 0.0}) == forward);
  CHECK(turned_by(forward, {1e-300, 0.0}).norm() == Approx(forward.norm()));
}

TEST_CASE("a beam of any settings shoots a particle or throws, and does not try for ever", "[extreme]") {
  const auto shot = [](const auto& beam) {
    random_stream random(4, 0, 0);
    try {
      const moving_particle m = [&] {
        if constexpr (requires { beam.shoot(0.0, 1, random); }) return beam.shoot(0.0, 1, random);
        else return beam.shoot(0.0, 1, 3.0 * units::tesla, random);
      }();
      return std::abs(m.momentum.z()) > 0.0;
    } catch (const std::invalid_argument&) {
      return true;
    }
  };
  for (const double x : extremes) {
    INFO(x);
    for (int slot = 0; slot < 6; ++slot) {
      flat_beam flat;
      const std::array<double*, 6> at{&flat.pz_min, &flat.pz_max, &flat.pt_min, &flat.pt_max, &flat.pt_over_pz_max, &flat.radius};
      *at[static_cast<std::size_t>(slot)] = x;
      CHECK(shot(flat));
      gaussian_beam gauss;
      const std::array<double*, 6> in{&gauss.emittance, &gauss.beta, &gauss.alpha, &gauss.canonical, &gauss.pz, &gauss.pz_spread};
      *in[static_cast<std::size_t>(slot)] = x;
      CHECK(shot(gauss));
    }
  }
}

TEST_CASE("cores are looked up at any place and along any direction", "[extreme]") {
  const plane& p = trackers().find(mice::downstream)->stations.front().planes.front();
  const fibre_doublet doublet;
  for (const double x : extremes) {
    INFO(x);
    const int of_alpha = core_at(p, doublet, x, 0.1), of_height = core_at(p, doublet, 0.0, x);
    CHECK((of_alpha >= -1 && of_alpha < p.channels * doublet.fibres_per_channel));
    if (std::abs(x) > 1.0 || std::isnan(x)) CHECK(of_height == -1);
    if (std::abs(x) > 1e3 || std::isnan(x)) CHECK(of_alpha == -1);
    for (int slot = 0; slot < 5; ++slot) {
      double alpha = 0.0, height = 0.0;
      vector<double, 3> direction(0.1, 0.0, 1.0);
      const std::array<double*, 5> at{&alpha, &height, &direction[0], &direction[1], &direction[2]};
      *at[static_cast<std::size_t>(slot)] = x;
      for (const fibre_crossing& c : fibre_crossings(p, doublet, 0, alpha, height, direction)) CHECK((c.chord > 0.0 && c.fibre >= 0));
    }
  }
}

TEST_CASE("digits are of finite light whatever the hits, the noise, the calibration and the threshold are", "[extreme]") {
  const tracker& t = *trackers().find(mice::downstream);
  for (const double x : extremes)
    for (int slot = 0; slot < 8; ++slot) {
      INFO("slot " << slot << " is " << x);
      hit h{1, {t.id, 1, 0, 100}, 700, 0.05, 0.0, {}, {}, 0, 13};
      digitiser<light_yield, thermal_noise, adc_response, uniform_calibration> digitise;
      const std::array<double*, 8> at{&h.edep,          &digitise.light.photons_per_mev,    &digitise.noise.rate,                 &digitise.adc.resolution,
                                      &digitise.threshold, &digitise.calibration.value.gain, &digitise.calibration.value.pedestal, &digitise.light.mirror};
      *at[static_cast<std::size_t>(slot)] = x;
      random_stream random(5, 0, 0);
      std::vector<raw_digit> out;
      digitise(t, std::vector<hit>{h}, random, out);
      for (const raw_digit& d : out) CHECK((std::isfinite(d.npe) && d.adc >= 0 && d.adc <= digitise.adc.largest_count));
    }
}
