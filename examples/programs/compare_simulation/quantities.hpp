// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <scifi/event/truth.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/hit_to_digit/light_yield.hpp>
#include <scifi/material/highland.hpp>
#include <scifi/particle_to_hit/helix_step.hpp>

#include "compare_simulation/sample.hpp"

namespace scifi::compare {

/// What is compared of a simulation with one particle of the beam in an event: in the planes that it crosses within the fiducial radius.
class quantities {
 public:
  quantities(const tracker& t, double field) : tracker_(t), field_(field) {}

  void add(long event, const truth& real) {
    add_deposits(event, real);
    for (std::size_t i = 0; i + 1 < real.crossings.size(); ++i) {
      const crossing& a = real.crossings[i];
      const crossing& b = real.crossings[i + 1];
      if (inside(a) && inside(b) && b.station == a.station && b.plane != a.plane) momentum_loss.add(event, a.momentum.norm() - b.momentum.norm());
    }
    for (std::size_t i = 0; i + 3 < real.crossings.size(); ++i) add_angle(event, real.crossings[i], real.crossings[i + 3]);
  }

  sample fibre_deposit, fibre_row;  // MeV: all particles, each particle
  sample plane_deposit;             // MeV, planes with any
  sample channel_light;             // photo-electrons, channels with any
  sample channels, lit_channels;    // number in a crossed plane: with a deposit, above threshold
  sample momentum_loss;             // MeV/c, from a plane to the next of its station
  sample angle;                     // mrad, projected, through a station
  sample angle_over_highland;

 private:
  [[nodiscard]] bool inside(const crossing& c) const { return std::hypot(c.position.x(), c.position.y()) < tracker_.fiducial_radius; }

  void add_deposits(long event, const truth& real) {
    constexpr double threshold = 2.0;  // photo-electrons
    std::map<std::tuple<int, int, int>, double> fibres, lights;
    std::map<std::tuple<int, int>, double> planes;
    std::set<std::tuple<int, int>> crossed;
    for (const crossing& c : real.crossings)
      if (inside(c)) crossed.insert({c.station, c.plane});
    for (const hit& h : real.hits) {
      if (!crossed.contains({h.id.station, h.id.plane})) continue;
      fibre_row.add(event, h.edep);
      fibres[{h.id.station, h.id.plane, h.fibre}] += h.edep;
      lights[{h.id.station, h.id.plane, h.id.channel}] += light_yield{}.photo_electrons(h.edep);
      planes[{h.id.station, h.id.plane}] += h.edep;
    }
    for (const auto& [where, edep] : fibres) fibre_deposit.add(event, edep);
    for (const auto& [where, edep] : planes) plane_deposit.add(event, edep);
    std::map<std::tuple<int, int>, int> any, lit;
    for (const auto& [where, light] : lights) {
      channel_light.add(event, light);
      const std::tuple plane(std::get<0>(where), std::get<1>(where));
      ++any[plane];
      if (light >= threshold) ++lit[plane];
    }
    for (const auto& plane : crossed) {
      channels.add(event, any[plane]);
      lit_channels.add(event, lit[plane]);
    }
  }

  /// The angle between the directions at the first planes of two stations in a row, the turn in the field undone: what the first station did.
  void add_angle(long event, const crossing& a, const crossing& b) {
    const auto along = [](const crossing& c) { return c.momentum.z() > 0.0 ? 1 : -1; };
    if (std::abs(b.station - a.station) != 1 || a.plane != b.plane || a.plane != (along(a) > 0 ? 0 : 2) || !inside(a) || !inside(b)) return;
    moving_particle back;
    back.hypothesis = particle_from_pdg(b.pdg_id).value_or(muon_plus);
    back.position = b.position;
    back.momentum = b.momentum;
    helix_step(back, a.position.z() - b.position.z(), field_);
    const vector<double, 3> before = a.momentum.normalized();
    const vector<double, 3> after = back.momentum.normalized();
    const vector<double, 3> first = vector<double, 3>(before.z(), 0.0, -before.x()).normalized();
    const vector<double, 3> second{before.y() * first.z() - before.z() * first.y(), before.z() * first.x() - before.x() * first.z(),
                                   before.x() * first.y() - before.y() * first.x()};
    double layer = 0.0;
    for (const station& s : tracker_.stations)
      if (s.id == a.station)
        for (const plane& p : s.planes) layer += radiation_lengths(p.below) + radiation_lengths(p.above);
    layer /= std::abs(before.z());
    const double highland = std::sqrt(highland_variance(0.5 * (a.momentum.norm() + b.momentum.norm()), back.hypothesis, layer, layer));
    constexpr double to_mrad = 1.0 / units::mrad;
    for (const double projected : {std::atan2(after.dot(first), after.dot(before)), std::atan2(after.dot(second), after.dot(before))}) {
      angle.add(event, projected * to_mrad);
      angle_over_highland.add(event, projected / highland);
    }
  }

  const tracker& tracker_;
  double field_;
};

/// A line of the table: what is compared, and how far the two may lie apart.
struct line {
  std::string name;
  std::function<figure(const quantities&)> of;
  double limit;  ///< on |ratio - 1|; zero: only shown
};

/// The table: 5 % for everything but the tail of the scattering angle, 25 %. `core` is the core width of the reference's angle over Highland's.
[[nodiscard]] inline std::vector<line> table(double core) {
  constexpr double close = 0.05;
  constexpr double tail = 0.25;
  constexpr double shown = 0.0;
  using q = quantities;
  const auto share = [](double n) { return [n](const std::vector<double>& x) { return share_equal(x, n); }; };
  const auto beyond = [](double limit) { return [limit](const std::vector<double>& x) { return share_beyond(x, limit); }; };
  std::vector<line> out;
  const auto add = [&out](const char* name, double limit, sample q::*what, auto statistic) {
    out.push_back({name, [what, statistic](const q& of) { return (of.*what).of(statistic); }, limit});
  };
  add("deposit per fibre, mean (MeV)", close, &q::fibre_deposit, mean);
  add("deposit per fibre, median (MeV)", close, &q::fibre_deposit, median);
  add("deposit per fibre, core width (MeV)", close, &q::fibre_deposit, core_width);
  add("deposit per fibre, standard deviation (MeV)", close, &q::fibre_deposit, standard_deviation);
  add("deposit per fibre and particle, mean (MeV)", close, &q::fibre_row, mean);
  add("deposit per fibre and particle, standard deviation (MeV)", close, &q::fibre_row, standard_deviation);
  add("deposit per plane, mean (MeV)", close, &q::plane_deposit, mean);
  add("deposit per plane, median (MeV)", close, &q::plane_deposit, median);
  add("deposit per plane, core width (MeV)", close, &q::plane_deposit, core_width);
  add("deposit per plane, standard deviation (MeV)", close, &q::plane_deposit, standard_deviation);
  add("light per channel, mean (npe)", close, &q::channel_light, mean);
  add("light per channel, median (npe)", close, &q::channel_light, median);
  add("planes with 0 channels hit", shown, &q::channels, share(0));
  add("planes with 1 channel hit", close, &q::channels, share(1));
  add("planes with 2 channels hit", close, &q::channels, share(2));
  add("planes with 3 channels hit", close, &q::channels, share(3));
  add("planes with 1 channel above 2 npe", close, &q::lit_channels, share(1));
  add("planes with 2 channels above 2 npe", close, &q::lit_channels, share(2));
  add("planes with 3 channels above 2 npe", close, &q::lit_channels, share(3));
  add("momentum loss per plane, mean (MeV/c)", close, &q::momentum_loss, mean);
  add("momentum loss per plane, median (MeV/c)", close, &q::momentum_loss, median);
  add("momentum loss per plane, core width (MeV/c)", close, &q::momentum_loss, core_width);
  add("momentum loss per plane, standard deviation (MeV/c)", close, &q::momentum_loss, standard_deviation);
  add("scattering angle per station, core width (mrad)", close, &q::angle, core_width);
  add("scattering angle per station over Highland's, core width", close, &q::angle_over_highland, core_width);
  add("scattering angle per station, beyond 3 Highland widths", tail, &q::angle_over_highland, beyond(3.0));
  add("scattering angle per station, beyond 3 core widths", tail, &q::angle_over_highland, beyond(3.0 * core));
  add("scattering angle per station, beyond 5 core widths", shown, &q::angle_over_highland, beyond(5.0 * core));
  return out;
}

}  // namespace scifi::compare
