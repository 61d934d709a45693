// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <scifi/core/linalg.hpp>
#include <scifi/core/planar.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/field/concepts.hpp>

namespace scifi {

/// A particle in vacuum on its way along z: q/p is what a magnetic field leaves alone. Frame of the field.
template <class Scalar>
struct nystrom_state {
  planar<Scalar> position;  ///< x, y in mm
  planar<Scalar> slope;     ///< dx/dz, dy/dz
  Scalar q_over_p;          ///< with the sign of q/pz, e/(MeV/c)
};

/// Derivatives of position and slope by Columns numbers at the start of a flight.
template <class Scalar, std::size_t Columns>
struct nystrom_derivatives {
  std::array<planar<Scalar>, Columns> position, slope;
};

namespace detail {

/// Length of a track per dz, sqrt(1 + tx^2 + ty^2).
template <class Scalar>
[[nodiscard]] Scalar path_per_dz(const planar<Scalar>& u) {
  using std::sqrt;
  return sqrt(Scalar(Scalar(1.0) + norm(u)));
}

/// d2(x, y)/dz2 over q/pz: (tx ty Bx - (1 + tx^2) By + ty Bz, (1 + ty^2) Bx - tx ty By - tx Bz), from dp/dz = q p x B / pz.
template <class Scalar>
[[nodiscard]] planar<Scalar> bend(const planar<Scalar>& u, const vector<Scalar, 3>& b) {
  const Scalar mixed = u.x * u.y;
  return {Scalar(mixed * b.x() - (Scalar(1.0) + u.x * u.x) * b.y() + u.y * b.z()), Scalar((Scalar(1.0) + u.y * u.y) * b.x() - mixed * b.y() - u.x * b.z())};
}

/// d2(x, y)/dz2.
template <class Scalar>
[[nodiscard]] planar<Scalar> curvature(const planar<Scalar>& u, const Scalar& q_over_p, const vector<Scalar, 3>& b) {
  return Scalar(q_over_p * path_per_dz(u)) * bend(u, b);
}

}  // namespace detail

/// One step of Runge, Kutta and Nystrom, of fourth order, for r'' = f(z, r, r') with r = (x, y): three evaluations of the field
/// (Abramowitz and Stegun 25.5.20; Bugge and Myrheim, NIM 179 (1981) 365; Lund et al., JINST 4 (2009) P04001).
///
/// `Field` may change anywhere but should be smooth over the step; a field with_gradient() is asked for its gradient once a position.
template <class Scalar, class Field>
class nystrom_step {
 public:
  static constexpr bool has_gradient = magnetic_field_with_gradient<Field, Scalar>;
  /// What the derivatives are taken by: tx, ty, q/p and, where the field tells its gradient, x and y.
  static constexpr std::size_t columns = has_gradient ? 5 : 3;
  using derivatives = nystrom_derivatives<Scalar, columns>;

  /// From `start` at z over h (mm, either sign).
  nystrom_step(const Field& field, const nystrom_state<Scalar>& start, double z, double h) : nystrom_step(field, start, at(field, start.position, z), z, h) {}

  /// The same where the field at the start is known: that of a step which was too long.
  nystrom_step(const Field& field, const nystrom_state<Scalar>& start, const field_and_gradient<Scalar>& first, double z, double h)
      : h_(h), q_over_p_(start.q_over_p), first_(first) {
    const Scalar full = Scalar(h), half = Scalar(0.5 * h), eighth = Scalar(0.125 * h * h);
    u_[0] = start.slope;
    k_[0] = detail::curvature(u_[0], q_over_p_, first_.value);
    middle_ = at(field, start.position + half * u_[0] + eighth * k_[0], z + 0.5 * h);
    u_[1] = u_[0] + half * k_[0];
    k_[1] = detail::curvature(u_[1], q_over_p_, middle_.value);
    u_[2] = u_[0] + half * k_[1];
    k_[2] = detail::curvature(u_[2], q_over_p_, middle_.value);
    last_ = at(field, start.position + full * u_[0] + Scalar(0.5 * h * h) * k_[2], z + h);
    u_[3] = u_[0] + full * k_[2];
    k_[3] = detail::curvature(u_[3], q_over_p_, last_.value);
    end_.position = start.position + full * u_[0] + Scalar(h * h / 6.0) * (k_[0] + k_[1] + k_[2]);
    end_.slope = start.slope + Scalar(h / 6.0) * (k_[0] + Scalar(2.0) * (k_[1] + k_[2]) + k_[3]);
    end_.q_over_p = q_over_p_;
  }

  /// The particle at z + h. NaN where the field was.
  [[nodiscard]] const nystrom_state<Scalar>& end() const { return end_; }
  /// The field at the start.
  [[nodiscard]] const field_and_gradient<Scalar>& field_at_start() const { return first_; }

  /// Estimated error of the position, mm: h^2 |k1 - k2 - k3 + k4|, that of the third order (Lund et al. 2009), which is larger than the real one.
  [[nodiscard]] Scalar error() const {
    const planar<Scalar> e = k_[0] - k_[1] - k_[2] + k_[3];
    return Scalar(h_ * h_) * (magnitude(e.x) + magnitude(e.y));
  }

  /// Carries derivatives along: those at the start become those at the end, exactly as the step depends on its start for a given h.
  void transport(derivatives& d) const {
    const Scalar full = Scalar(h_), half = Scalar(0.5 * h_), eighth = Scalar(0.125 * h_ * h_), half_square = Scalar(0.5 * h_ * h_);
    const Scalar by_position = Scalar(h_ * h_ / 6.0), by_slope = Scalar(h_ / 6.0);
    const slopes first(*this, 0, first_), second(*this, 1, middle_), third(*this, 2, middle_), fourth(*this, 3, last_);
    for (std::size_t i = 0; i < columns; ++i) {
      const Scalar own = Scalar(i == q_over_p_column ? 1.0 : 0.0);
      const planar<Scalar> r = d.position[i], u = d.slope[i];
      const planar<Scalar> k1 = first.of(r, u, own);
      const planar<Scalar> r_middle = r + half * u + eighth * k1;
      const planar<Scalar> k2 = second.of(r_middle, u + half * k1, own);
      const planar<Scalar> k3 = third.of(r_middle, u + half * k2, own);
      const planar<Scalar> k4 = fourth.of(r + full * u + half_square * k3, u + full * k3, own);
      d.position[i] = r + full * u + by_position * (k1 + k2 + k3);
      d.slope[i] = u + by_slope * (k1 + Scalar(2.0) * (k2 + k3) + k4);
    }
  }

  static constexpr std::size_t tx_column = 0, ty_column = 1, q_over_p_column = 2, x_column = 3, y_column = 4;

 private:
  /// Derivatives of one k.
  struct slopes {
    planar<Scalar> by_tx, by_ty, by_q_over_p, by_x, by_y;

    slopes(const nystrom_step& step, std::size_t stage, const field_and_gradient<Scalar>& field) {
      const planar<Scalar>& u = step.u_[stage];
      const vector<Scalar, 3>& b = field.value;
      const Scalar path = detail::path_per_dz(u);
      const Scalar k = step.q_over_p_ * path;
      const planar<Scalar> g = detail::bend(u, b);
      const Scalar stretching = step.q_over_p_ / path;  // d(q/pz) = q/p (tx dtx + ty dty) / path
      const Scalar two(2.0);
      by_q_over_p = path * g;
      by_tx = Scalar(stretching * u.x) * g + k * planar<Scalar>{Scalar(u.y * b.x() - two * u.x * b.y()), Scalar(-u.y * b.y() - b.z())};
      by_ty = Scalar(stretching * u.y) * g + k * planar<Scalar>{Scalar(u.x * b.x() + b.z()), Scalar(two * u.y * b.x() - u.x * b.y())};
      if constexpr (has_gradient) {
        by_x = k * detail::bend<Scalar>(u, field.gradient.col(0));
        by_y = k * detail::bend<Scalar>(u, field.gradient.col(1));
      }
    }

    [[nodiscard]] planar<Scalar> of(const planar<Scalar>& r, const planar<Scalar>& u, const Scalar& own) const {
      const planar<Scalar> bent = u.x * by_tx + u.y * by_ty + own * by_q_over_p;
      if constexpr (has_gradient) return bent + r.x * by_x + r.y * by_y;
      else return bent;
    }
  };

  [[nodiscard]] static field_and_gradient<Scalar> at(const Field& field, const planar<Scalar>& r, double z) {
    const vector<Scalar, 3> position(r.x, r.y, Scalar(z));
    if constexpr (has_gradient) return field.with_gradient(position);
    else return {field(position), {}};
  }

  double h_;
  Scalar q_over_p_;
  field_and_gradient<Scalar> first_, middle_, last_;
  std::array<planar<Scalar>, 4> u_, k_;  // slopes and curvatures of the four stages
  nystrom_state<Scalar> end_;
};

}  // namespace scifi
