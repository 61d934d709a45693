// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/material/momentum.hpp>
#include <scifi/particle_to_hit/decay.hpp>
#include <scifi/particle_to_hit/electron_flight.hpp>
#include <scifi/particle_to_hit/energy_loss_sampling.hpp>
#include <scifi/particle_to_hit/fibre_crossing.hpp>
#include <scifi/particle_to_hit/fibre_layer.hpp>
#include <scifi/particle_to_hit/flight_propagator.hpp>
#include <scifi/particle_to_hit/knocked_on.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>
#include <scifi/particle_to_hit/scattering_sampling.hpp>
#include <scifi/particle_to_hit/transport_settings.hpp>

namespace scifi {

/// Follows one particle through a tracker: in flight between the surfaces, by default on the exact helix of `settings.field`; scattering in the middle of
/// each slab of material (and of the gas between the stations), and a loss of energy drawn for each fibre core and for what is between the cores. Inside a
/// row of fibres the track is straight.
///
/// Half a doublet holds one row of fibres: the last slab below and the first above z_measured are the two rows. Knocked-on electrons and those of
/// decays are followed by an `electron_flight`, muons of pions like their parent. Strong interactions are left out. Const: shared between threads.
template <class Scattering = coulomb_scattering, class Loss = collision_loss, class Propagator = helix_flight>
class transport {
  static_assert(scattering_sampler<Scattering>,
                "scifi: the scattering of a transport needs a const member sample(p, particle, slab, path_over_thickness, random) that returns two "
                "angles in rad; wrap a variance policy as gaussian_scattering<policy>.");
  static_assert(energy_loss_sampler<Loss>,
                "scifi: the energy loss of a transport needs a const member sample(p, particle, medium, path, random) that returns MeV; wrap an "
                "energy-loss policy as fixed_loss<policy>.");
  static_assert(flight_propagator<Propagator>,
                "scifi: the propagator of a transport needs a const member propagate(moving_particle, dz) that returns the moving_particle after dz mm; "
                "wrap a propagator of slopes as slope_flight<propagator>.");

 public:
  transport(const tracker& t, const transport_settings& settings, Scattering scattering = {}, Loss loss = {})
    requires std::same_as<Propagator, helix_flight>
      : transport(t, settings, scattering, loss, helix_flight{settings.field}) {}

  /// With a flight of one's own. Electrons that are knocked on keep to the helix of `settings.field`: they curl up within millimetres.
  transport(const tracker& t, const transport_settings& settings, Scattering scattering, Loss loss, Propagator propagator)
      : tracker_id_(t.id),
        gas_(t.gas),
        settings_(settings),
        scattering_(scattering),
        loss_(loss),
        propagator_(propagator),
        layers_(fibre_layers(t)),
        electrons_(t, settings) {}

  /// Follows `moving`, a particle of the beam, from where it is to the far side of the last plane ahead of it, then what it made; appends what happens
  /// to `out`, under the number `index` and, for secondaries, the numbers after `out.last_particle`.
  flight_end operator()(const moving_particle& moving, int index, random_stream& random, truth& out) const {
    std::size_t next = out.particles.size();
    out.particles.push_back({index, 0, moving.hypothesis.pdg_id, particle_origin::beam, moving.t, moving.position, moving.momentum});
    const flight_end end = follow(moving, index, 0, random, out);
    while (++next < out.particles.size()) {
      const simulated_particle born = out.particles[next];
      const std::optional<particle> hypothesis = particle_from_pdg(born.pdg_id);
      if (!hypothesis) continue;
      const moving_particle child{*hypothesis, born.position, born.momentum, born.t};
      if (std::abs(born.pdg_id) == electron.pdg_id) electrons_(child, born.particle, born.parent, random, out);
      else follow(child, born.particle, born.parent, random, out);
    }
    return end;
  }

 private:
  struct flight {
    moving_particle now;
    int index, parent;
    int direction;
    flight_end end;
    double life;  // left to it at rest, ns
    random_stream& random;
    truth& out;
    [[nodiscard]] bool over() const { return end != flight_end::crossed; }
    void bear(particle_origin origin, const particle& what, const vector<double, 3>& position, const vector<double, 3>& momentum) {
      out.particles.push_back({++out.last_particle, index, what.pdg_id, origin, now.t, position, momentum});
    }
  };

  flight_end follow(const moving_particle& moving, int index, int parent, random_stream& random, truth& out) const {
    if (moving.momentum.z() == 0.0) return flight_end::turned_back;
    if (!is_finite(moving.position.sum() + moving.momentum.sum() + moving.t)) return flight_end::left;  // it is nowhere
    const double life = settings_.decays ? mean_life(moving.hypothesis) * random.exponential() : std::numeric_limits<double>::infinity();
    flight f{moving, index, parent, moving.momentum.z() > 0.0 ? 1 : -1, flight_end::crossed, life, random, out};
    for (std::size_t i = 0; i < layers_.size() && !f.over(); ++i) cross(f, layers_[f.direction > 0 ? i : layers_.size() - 1 - i]);
    if (f.end == flight_end::stopped && f.now.hypothesis.charge > 0 && std::isfinite(f.life)) {
      f.now.t += f.life;
      f.now.momentum.setZero();
      decay(f);
    } else if (f.end == flight_end::decayed) {
      decay(f);
    }
    return f.end;
  }

  void decay(flight& f) const {
    if (const auto daughter = charged_daughter(f.now, f.random)) f.bear(particle_origin::decay, daughter->hypothesis, daughter->position, daughter->momentum);
  }

  void cross(flight& f, const fibre_layer& l) const {
    const double near = l.at.z_reference;
    const double far = l.at.z + thickness(l.at.above);
    const double gap = ((f.direction > 0 ? near : far) - f.now.position.z()) * f.direction;
    if (gap < -closeness) return;  // behind the particle
    if (gap > closeness) through(f, whole(gas_, gap));
    if (f.over()) return;
    if (f.direction > 0) {
      record_crossing(f, l);
      for (std::size_t i = 0; i < l.at.below.size() && !f.over(); ++i) through_slab(f, l, l.at.below[i], i + 1 == l.at.below.size() ? 0 : no_row);
      for (std::size_t i = 0; i < l.at.above.size() && !f.over(); ++i) through_slab(f, l, l.at.above[i], i == 0 ? 1 : no_row);
    } else {
      for (std::size_t i = l.at.above.size(); i-- > 0 && !f.over();) through_slab(f, l, l.at.above[i], i == 0 ? 1 : no_row);
      for (std::size_t i = l.at.below.size(); i-- > 0 && !f.over();) through_slab(f, l, l.at.below[i], i + 1 == l.at.below.size() ? 0 : no_row);
      if (!f.over()) record_crossing(f, l);
    }
  }

  void through_slab(flight& f, const fibre_layer& l, const slab& s, int row) const {
    if (row == no_row) through(f, s);
    else through_row(f, l, s, row);
  }

  /// Half a slab, the turn, the loss, the other half.
  void through(flight& f, const slab& s) const {
    fly(f, 0.5 * s.thickness);
    if (f.over()) return;
    const double path = s.thickness * f.now.momentum.norm() / std::abs(f.now.momentum.z());
    scatter(f, s, path / s.thickness);
    const vector<double, 3> middle = f.now.position;
    const vector<double, 3> d = f.now.momentum.normalized();
    if (!f.over()) lose(f, s.medium, path, [&](double along) { return vector<double, 3>(middle + (along - 0.5 * path) * d); });
    if (!f.over()) fly(f, 0.5 * s.thickness);
  }

  /// A slab with a row of fibres in it: the losses in the cores one by one, then that of the rest of the slab.
  void through_row(flight& f, const fibre_layer& l, const slab& s, int row) const {
    const double p = f.now.momentum.norm();
    const double path_factor = p / std::abs(f.now.momentum.z());
    const double alpha = l.at.tracker_to_alpha(f.now.position.x(), f.now.position.y());
    const vector<double, 3> d = f.now.momentum / p;
    const vector<double, 3> in_plane{l.at.cos_angle * d.x() + l.at.sin_angle * d.y(), l.at.cos_angle * d.y() - l.at.sin_angle * d.x(), d.z()};
    const auto cores = fibre_crossings(l.of, settings_.doublet, row, alpha, f.now.position.z() - l.at.z, in_plane);
    const moving_particle entered = f.now;
    const double speed = p / entered.energy() * constants::speed_of_light;

    fly(f, 0.5 * s.thickness);
    if (f.over()) return;
    scatter(f, s, path_factor);
    double between = s.thickness * path_factor;
    for (const fibre_crossing& core : cores) {
      if (f.over()) return;
      hit h{f.index, {tracker_id_, l.at.station, l.at.plane, channel_of_fibre(settings_.doublet, core.fibre)}, core.fibre, 0.0, entered.t + core.entry / speed,
            entered.position + core.entry * d, f.now.momentum, f.parent, f.now.hypothesis.pdg_id};
      h.edep = lose(f, s.medium, core.chord, [&](double along) { return vector<double, 3>(h.position + along * d); });
      if (h.edep > 0.0) f.out.hits.push_back(h);
      between -= core.chord;
    }
    const auto beside_cores = [&](double along) {
      for (const fibre_crossing& core : cores)
        if (along >= core.entry) along += core.chord;
      return vector<double, 3>(entered.position + along * d);
    };
    if (!f.over()) lose(f, s.medium, between, beside_cores);
    if (!f.over()) fly(f, 0.5 * s.thickness);
  }

  void fly(flight& f, double distance) const {
    double dz = f.direction * distance;
    moving_particle end = propagator_.propagate(f.now, dz);
    const double life = (end.t - f.now.t) * f.now.hypothesis.mass / f.now.energy();  // proper time
    const bool decays = life >= f.life;
    if (decays) {
      dz *= f.life / life;
      end = propagator_.propagate(f.now, dz);
    }
    if (!stays_within(settings_.radius, propagator_, f.now, end, dz)) {
      f.end = flight_end::left;
      return;
    }
    f.now = end;
    f.life -= life;
    if (decays) f.end = flight_end::decayed;
  }

  void scatter(flight& f, const slab& s, double path_factor) const {
    const vector<double, 2> angles = scattering_.sample(f.now.momentum.norm(), f.now.hypothesis, s, path_factor, f.random);
    f.now.momentum = turned_by(f.now.momentum, angles);
    if (!(f.now.momentum.z() * f.direction > smallest_cosine * f.now.momentum.norm())) f.end = flight_end::turned_back;
  }

  /// Takes away what is lost on a path and returns what stays there: without the electrons that are followed, which start at `place(path so far)`.
  /// All of the kinetic energy where that is less than the loss.
  template <class Place>
  double lose(flight& f, const material& medium, double path, const Place& place) const {
    const double p = f.now.momentum.norm();
    knock_ons electrons{settings_.follow_electrons_from};
    double loss = 0.0;
    if constexpr (knock_on_sampler<Loss>) loss = loss_.sample(p, f.now.hypothesis, medium, path, f.random, electrons);
    else loss = loss_.sample(p, f.now.hypothesis, medium, path, f.random);
    const double left = momentum_after_loss(p, f.now.hypothesis.mass, loss).p_new;
    if (!(left > slowest * f.now.hypothesis.mass)) {
      f.end = flight_end::stopped;
      return f.now.kinetic_energy();
    }
    for (const double kinetic_energy : electrons.energies) {
      const vector<double, 3> momentum = knocked_on_momentum(f.now, kinetic_energy, f.random);
      f.bear(particle_origin::knocked_on, electron, place(path * f.random.uniform()), momentum);
      loss -= kinetic_energy;
    }
    f.now.momentum *= left / p;
    return loss;
  }

  void record_crossing(flight& f, const fibre_layer& l) const {
    if (f.parent == 0) f.out.crossings.push_back({f.index, f.now.hypothesis.pdg_id, tracker_id_, l.at.station, l.at.plane, f.now.position, f.now.momentum});
  }

  static constexpr int no_row = -1;
  static constexpr double closeness = 1e-6;        // mm: surfaces that touch are one
  static constexpr double smallest_cosine = 0.05;  // of the angle to z: beyond, slabs are no longer crossed
  static constexpr double slowest = 0.05;          // beta gamma: below, the range is some 10 um and Bethe's formula ends

  int tracker_id_;
  material gas_;
  transport_settings settings_;
  Scattering scattering_;
  Loss loss_;
  Propagator propagator_;
  std::vector<fibre_layer> layers_;  // in order of growing z
  electron_flight electrons_;
};

template <class... Policies>
transport(const tracker&, const transport_settings&, Policies...) -> transport<Policies...>;

}  // namespace scifi
