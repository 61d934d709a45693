// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/material/momentum.hpp>
#include <scifi/particle_to_hit/electron_loss.hpp>
#include <scifi/particle_to_hit/fibre_layer.hpp>
#include <scifi/particle_to_hit/helix_step.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>
#include <scifi/particle_to_hit/scattering_sampling.hpp>
#include <scifi/particle_to_hit/transport_settings.hpp>

namespace scifi {

/// Follows an electron or positron through a tracker in any direction until it stops or leaves: knocked-on electrons, electrons of decays.
///
/// Condensed history in short steps: mean loss by `electron_stopping_power`, an angle with the mean cosine of `electron_transport_rate` after each step
/// (exponential in 1 - cos), a helix in the field. What it loses in fibre cores becomes hits, one per core however often it comes back.
/// One that circles more than `most_turns` times on its way through a gap is dropped there, as Geant4 drops what it calls loopers.
/// Fluctuations of its loss, its own knocked-on electrons, bremsstrahlung and annihilation are left out. Const: shared between threads.
class electron_flight {
 public:
  electron_flight(const tracker& t, const transport_settings& settings)
      : tracker_id_(t.id), gas_(t.gas), settings_(settings), layers_(fibre_layers(t)) {
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      double z = layers_[i].at.z_reference;
      const auto add = [&](const slab_stack<4>& stack) {
        for (const slab& s : stack) {
          sheets_.push_back({z, z + s.thickness, s.medium, i});
          z += s.thickness;
        }
      };
      add(layers_[i].at.below);
      add(layers_[i].at.above);
    }
  }

  /// Follows the electron under the number `index`, child of `parent`; appends its hits to `out`.
  void operator()(moving_particle now, int index, int parent, random_stream& random, truth& out) const {
    const std::size_t first_hit = out.hits.size();
    std::size_t current = none;  // the hit that is being added to
    for (int i = 0; i < most_steps; ++i) {
      const double p = now.momentum.norm();
      const double kinetic = now.kinetic_energy();
      const double down = now.momentum.z() < 0.0 ? -1.0 : 1.0;
      const double cosine = std::max(std::abs(now.momentum.z()) / p, smallest_cosine);
      const region here = region_at(now.position.z(), down);
      if (!std::isfinite(here.depth)) return;  // past the last sheet
      const double turns = std::abs(settings_.field) * here.depth / (2.0 * constants::pi * std::abs(now.momentum.z()));
      if (here.in == nullptr && turns > settings_.most_turns) return;
      const material& medium = here.in == nullptr ? gas_ : here.in->medium;
      const bool last = kinetic <= lowest_energy;

      const double rate = electron_stopping_power(std::max(kinetic, lowest_energy), medium);
      const double turning_rate = electron_transport_rate(p, now.hypothesis, medium);
      double step = last ? 0.0 : std::min(largest_loss * kinetic / rate, largest_turn / turning_rate);
      if (here.in != nullptr) step = std::min(step, longest_step);
      const double to_boundary = here.depth / cosine;
      const bool leaves = step >= to_boundary;
      if (leaves) step = to_boundary;

      const double half_rate = electron_stopping_power(std::max(kinetic - 0.5 * rate * step, lowest_energy), medium);
      const double loss = last ? kinetic : half_rate * step;
      if (here.in != nullptr) {
        const vector<double, 3> middle = now.position + (0.5 * step / p) * now.momentum;
        current = add_to_core(layers_[here.in->layer], middle, now, loss, {index, parent, first_hit, current}, out);
      } else {
        current = none;
      }
      if (last) return;

      const double dz = down * cosine * step;
      if (!(largest_radius(now, dz, settings_.field) <= settings_.radius)) return;
      if (std::abs(now.momentum.z()) < smallest_cosine * p) now.momentum.z() = down * smallest_cosine * p;
      helix_step(now, leaves ? dz + down * closeness : dz, settings_.field);
      const double left = momentum_after_loss(now.momentum.norm(), now.hypothesis.mass, loss).p_new;
      if (!(left > 0.0)) return;
      const double mean_versine = -std::expm1(-turning_rate * step);
      const double versine = std::min(mean_versine * random.exponential(), 2.0);
      const double angle = std::acos(1.0 - versine);
      const double azimuth = random.uniform(0.0, 2.0 * constants::pi);
      now.momentum = turned_by(vector<double, 3>(now.momentum * (left / now.momentum.norm())), {angle * std::cos(azimuth), angle * std::sin(azimuth)});
    }
  }

 private:
  struct sheet {
    double from, to;  // z
    material medium;
    std::size_t layer;
  };
  struct region {
    const sheet* in;    // or nullptr in the gas
    double depth;        // along z to its end; infinite beyond the last sheet
  };
  struct owner {
    int index, parent;
    std::size_t first_hit, current;
  };

  [[nodiscard]] region region_at(double z, double down) const {
    const auto next = std::upper_bound(sheets_.begin(), sheets_.end(), z, [](double value, const sheet& s) { return value < s.from; });
    const bool inside = next != sheets_.begin() && z < std::prev(next)->to;
    if (inside) return {&*std::prev(next), std::max(down > 0.0 ? std::prev(next)->to - z : z - std::prev(next)->from, 0.0)};
    constexpr double outside = std::numeric_limits<double>::infinity();
    if (down > 0.0) return {nullptr, next == sheets_.end() ? outside : next->from - z};
    return {nullptr, next == sheets_.begin() ? outside : z - std::prev(next)->to};
  }

  /// Adds a loss at `place` to the hit of the core there, if there is one, and returns the hit's index or `none`.
  [[nodiscard]] std::size_t add_to_core(const fibre_layer& l, const vector<double, 3>& place, const moving_particle& now, double loss, const owner& of, truth& out) const {
    const int fibre = core_at(l.of, settings_.doublet, l.at.tracker_to_alpha(place.x(), place.y()), place.z() - l.at.z);
    if (fibre < 0) return none;
    const channel_id id{tracker_id_, l.at.station, l.at.plane, channel_of_fibre(settings_.doublet, fibre)};
    const auto same = [&](const hit& h) { return h.fibre == fibre && h.id == id; };
    std::size_t found = of.current;
    if (found == none || !same(out.hits[found])) {
      const auto from = out.hits.begin() + static_cast<std::ptrdiff_t>(of.first_hit);
      found = static_cast<std::size_t>(std::find_if(from, out.hits.end(), same) - out.hits.begin());
      if (found == out.hits.size()) out.hits.push_back({of.index, id, fibre, 0.0, now.t, now.position, now.momentum, of.parent, now.hypothesis.pdg_id});
    }
    out.hits[found].edep += loss;
    return found;
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  static constexpr int most_steps = 100000;        // an electron that circles in the gas
  static constexpr double lowest_energy = 0.01;    // MeV: its range, some 2 um, is nothing to a core
  static constexpr double largest_loss = 0.1;      // of the kinetic energy in a step
  static constexpr double largest_turn = 0.2;      // mean of 1 - cos in a step
  static constexpr double longest_step = 0.03;     // mm among fibres, a tenth of a core
  static constexpr double smallest_cosine = 1e-6;  // to z, so that a step along z exists
  static constexpr double closeness = 1e-7;        // mm beyond a boundary that is crossed

  int tracker_id_;
  material gas_;
  transport_settings settings_;
  std::vector<fibre_layer> layers_;  // in order of growing z, as are the sheets
  std::vector<sheet> sheets_;
};

}  // namespace scifi
