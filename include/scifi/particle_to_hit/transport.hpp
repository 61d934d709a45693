// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/material/momentum.hpp>
#include <scifi/particle_to_hit/energy_loss_sampling.hpp>
#include <scifi/particle_to_hit/fibre_crossing.hpp>
#include <scifi/particle_to_hit/helix_step.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>
#include <scifi/particle_to_hit/scattering_sampling.hpp>

namespace scifi {

/// How the flight of a particle through a tracker ended.
enum class flight_end {
  crossed,      ///< it passed every plane
  left,         ///< it went further from the axis than the radius of the tracker
  stopped,      ///< nothing of its kinetic energy was left
  turned_back,  ///< it no longer flew along the direction in which it started
};

/// What a transport is told besides the tracker.
struct transport_settings {
  double field = 0.0;       ///< Bz in the tracker frame, (MeV/c)/(e mm): B in tesla times units::tesla
  double radius = 160.0;    ///< particles further from the axis are dropped, mm
  fibre_doublet doublet{};  ///< the sensitive layer of every plane
};

/// Follows one particle through a tracker: an exact helix between the surfaces, scattering in the middle of each slab of material (and of the gas
/// between the stations), and a loss of energy drawn for each fibre core and for what is between the cores. Inside a row of fibres the track is straight.
///
/// Half a doublet holds one row of fibres: the last slab below and the first above z_measured are the two rows. Decays and the flight of knocked-on
/// electrons are left out: they leave their energy where they are made. Const and without state: shared between threads.
template <class Scattering = coulomb_scattering, class Loss = collision_loss>
class transport {
  static_assert(scattering_sampler<Scattering>,
                "scifi: the scattering of a transport needs a const member sample(p, particle, slab, path_over_thickness, random) that returns two "
                "angles in rad; wrap a variance policy as gaussian_scattering<policy>.");
  static_assert(energy_loss_sampler<Loss>,
                "scifi: the energy loss of a transport needs a const member sample(p, particle, medium, path, random) that returns MeV; wrap an "
                "energy-loss policy as fixed_loss<policy>.");

 public:
  transport(const tracker& t, const transport_settings& settings, Scattering scattering = {}, Loss loss = {})
      : tracker_id_(t.id), gas_(t.gas), settings_(settings), scattering_(scattering), loss_(loss) {
    for (const surface& s : surfaces_along(t, +1)) layers_.push_back({s, *plane_of(t, s)});
  }

  /// Follows `moving` from where it is to the far side of the last plane ahead of it; appends what happens to `out`, under the number `index`.
  flight_end operator()(moving_particle moving, int index, random_stream& random, truth& out) const {
    if (moving.momentum.z() == 0.0) return flight_end::turned_back;
    flight f{moving, index, moving.momentum.z() > 0.0 ? 1 : -1, flight_end::crossed, random, out};
    for (std::size_t i = 0; i < layers_.size() && f.end == flight_end::crossed; ++i) cross(f, layers_[f.direction > 0 ? i : layers_.size() - 1 - i]);
    return f.end;
  }

 private:
  struct layer {
    surface at;
    plane of;
  };
  struct flight {
    moving_particle now;
    int index;
    int direction;
    flight_end end;
    random_stream& random;
    truth& out;
    [[nodiscard]] bool over() const { return end != flight_end::crossed; }
  };

  [[nodiscard]] static const plane* plane_of(const tracker& t, const surface& s) {
    for (const station& candidate : t.stations)
      if (candidate.id == s.station) return &candidate.planes[static_cast<std::size_t>(s.plane)];
    return nullptr;
  }

  void cross(flight& f, const layer& l) const {
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

  void through_slab(flight& f, const layer& l, const slab& s, int row) const {
    if (row == no_row)
      through(f, s);
    else
      through_row(f, l, s, row);
  }

  /// Half a slab, the turn, the loss, the other half.
  void through(flight& f, const slab& s) const {
    fly(f, 0.5 * s.thickness);
    if (f.over()) return;
    const double path_factor = f.now.momentum.norm() / std::abs(f.now.momentum.z());
    scatter(f, s, path_factor);
    if (!f.over()) lose(f, s.medium, s.thickness * path_factor);
    if (!f.over()) fly(f, 0.5 * s.thickness);
  }

  /// A slab with a row of fibres in it: the losses in the cores one by one, then that of the rest of the slab.
  void through_row(flight& f, const layer& l, const slab& s, int row) const {
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
      hit h;
      h.particle = f.index;
      h.id = {tracker_id_, l.at.station, l.at.plane, channel_of_fibre(settings_.doublet, core.fibre)};
      h.fibre = core.fibre;
      h.position = entered.position + core.entry * d;
      h.momentum = f.now.momentum;
      h.t = entered.t + core.entry / speed;
      h.edep = lose(f, s.medium, core.chord);
      if (h.edep > 0.0) f.out.hits.push_back(h);
      between -= core.chord;
    }
    if (!f.over()) lose(f, s.medium, between);
    if (!f.over()) fly(f, 0.5 * s.thickness);
  }

  void fly(flight& f, double distance) const {
    const double dz = f.direction * distance;
    // NaN counts as outside.
    if (!(largest_radius(f.now, dz, settings_.field) <= settings_.radius))
      f.end = flight_end::left;
    else
      helix_step(f.now, dz, settings_.field);
  }

  void scatter(flight& f, const slab& s, double path_factor) const {
    const vector<double, 2> angles = scattering_.sample(f.now.momentum.norm(), f.now.hypothesis, s, path_factor, f.random);
    f.now.momentum = turned_by(f.now.momentum, angles);
    if (!(f.now.momentum.z() * f.direction > smallest_cosine * f.now.momentum.norm())) f.end = flight_end::turned_back;
  }

  /// Takes away what is lost on a path and returns it; all of the kinetic energy where that is less.
  double lose(flight& f, const material& medium, double path) const {
    const double p = f.now.momentum.norm();
    const double loss = loss_.sample(p, f.now.hypothesis, medium, path, f.random);
    const double left = momentum_after_loss(p, f.now.hypothesis.mass, loss).p_new;
    if (!(left > slowest * f.now.hypothesis.mass)) {
      f.end = flight_end::stopped;
      return f.now.kinetic_energy();
    }
    f.now.momentum *= left / p;
    return loss;
  }

  void record_crossing(flight& f, const layer& l) const {
    f.out.crossings.push_back({f.index, f.now.hypothesis.pdg_id, tracker_id_, l.at.station, l.at.plane, f.now.position, f.now.momentum});
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
  std::vector<layer> layers_;  // in order of growing z
};

template <class... Policies>
transport(const tracker&, const transport_settings&, Policies...) -> transport<Policies...>;

}  // namespace scifi
