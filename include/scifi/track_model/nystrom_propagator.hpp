// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/field/concepts.hpp>
#include <scifi/kalman/concepts.hpp>
#include <scifi/track_model/nystrom_step.hpp>
#include <scifi/track_model/slope_state.hpp>
#include <scifi/track_model/stretch.hpp>

namespace scifi {

/// How a flight through a field ended.
enum class flight_status {
  arrived,
  not_finite,      ///< the state at the start or the way was not
  no_field,        ///< the field said NaN: the track left the region where it is known
  too_many_steps,  ///< the tolerance asks for more steps than allowed: a wild field, or a particle that turns back
};

/// A flight status as a clause for people.
[[nodiscard]] constexpr std::string_view describe(flight_status s) {
  switch (s) {
    case flight_status::arrived: return "the track arrived";
    case flight_status::not_finite: return "the track or its way began with a number that is infinite or not a number";
    case flight_status::no_field: return "the track left the region where the field is known";
    case flight_status::too_many_steps: return "the track needs more steps than allowed";
  }
  return "unknown flight status";
}

/// How finely a flight is cut into steps.
struct nystrom_options {
  double tolerance = 1e-3;     ///< mm, of the estimated error of each step; that at the end of a flight of a metre is about a tenth of it
  double longest_step = 50.0;  ///< mm: shorter than the smallest thing in the field
  int most_steps = 4096;       ///< of a flight
};

/// What `nystrom_propagator::fly` returns.
template <class Scalar>
struct flight_result {
  kalman::propagated<Scalar, 5> moved;
  flight_status status = flight_status::arrived;
  int steps = 0;     ///< taken
  int rejected = 0;  ///< tried and found too long
};

/// Flight through any magnetic field, in slopes: steps of Runge, Kutta and Nystrom with a controlled error and a transported Jacobian.
///
/// The step is dz over a power of two. It is halved where the estimated error exceeds the tolerance and doubled where it is far below; lanes of a
/// pack share it. |q/p| is conserved exactly, q/pz follows the slopes. The Jacobian is that of the steps taken, exact to rounding, for a field
/// with_gradient; without it, that of a field which is the same across the track. Neither allocates nor throws.
template <class Field>
struct nystrom_propagator {
  using state_space = slope_state;
  Field field;  ///< (MeV/c)/(e mm), in the frame of the track
  nystrom_options options{};

  /// State (5, slope_state) at z + dz and its Jacobian d_end_d_start (5 x 5). A track that does not arrive ends with NaN, which a filter reports.
  template <class Scalar>
  [[nodiscard]] kalman::propagated<Scalar, 5> propagate(const vector<Scalar, 5>& start, const stretch& way) const {
    return fly(start, way).moved;
  }

  /// The same, with the reason of a failure and the number of steps. Packs: a lane that fails ends with NaN, the status speaks when no lane is left.
  template <class Scalar>
  [[nodiscard]] flight_result<Scalar> fly(const vector<Scalar, 5>& start, const stretch& way) const {
    static_assert(magnetic_field<Field, Scalar>,
                  "scifi: the field of a nystrom_propagator needs a const call operator that takes a position (3, mm) and returns B (3, (MeV/c)/(e mm)), "
                  "for the scalar of the state.");
    using s = slope_state;
    using step = nystrom_step<Scalar, Field>;
    const planar<Scalar> slope{start[s::tx], start[s::ty]};
    const Scalar path = detail::path_per_dz(slope);
    nystrom_state<Scalar> now{{start[s::x], start[s::y]}, slope, Scalar(start[s::q_over_pz] / path)};
    typename step::derivatives d{};
    d.slope[step::tx_column].x = d.slope[step::ty_column].y = Scalar(1.0);
    if constexpr (step::has_gradient) d.position[step::x_column].x = d.position[step::y_column].y = Scalar(1.0);

    flight_result<Scalar> out;
    if (!std::isfinite(way.z) || !std::isfinite(way.dz)) now.position.x = Scalar(std::numeric_limits<double>::quiet_NaN());
    if (!any_of(alive(now))) out.status = flight_status::not_finite;
    // Steps are counted in units of dz / 2^finest, so that the last one ends where it should.
    const int finest = static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(options.most_steps, 1)))) - 1;
    const long whole = 1L << finest;
    const double unit = way.dz / static_cast<double>(whole);
    int coarsest = 0;
    while (coarsest < finest && std::abs(way.dz) > options.longest_step * static_cast<double>(1L << coarsest)) ++coarsest;
    int level = coarsest;
    bool tried = false;
    field_and_gradient<Scalar> known;
    for (long done = 0; done < whole && std::abs(way.dz) > 0.0 && any_of(alive(now));) {
      const long stride = 1L << (finest - level);
      const double z = way.z + unit * static_cast<double>(done);
      const double h = unit * static_cast<double>(stride);
      const step next = tried ? step(field, now, known, z, h) : step(field, now, z, h);
      const Scalar error = next.error();
      // A stage that met no field counts as too long a step: the track itself may stay inside.
      const auto too_long = alive(now) && !(error <= Scalar(options.tolerance));
      if (any_of(too_long) && level < finest) {
        ++level;
        ++out.rejected;
        known = next.field_at_start();
        tried = true;
        continue;
      }
      if (any_of(too_long)) give_up(now, next, too_long, out.status);
      else now = next.end();
      next.transport(d);
      done += stride;
      ++out.steps;
      tried = false;
      // Doubling h multiplies the estimated error by sixteen.
      if (level > coarsest && done % (2 * stride) == 0 && !any_of(alive(now) && !(error <= Scalar(options.tolerance / 32.0)))) --level;
    }
    if (any_of(alive(now))) out.status = flight_status::arrived;
    out.moved = in_slopes(start, path, now, d);
    return out;
  }

 private:
  template <class Scalar>
  [[nodiscard]] static auto alive(const nystrom_state<Scalar>& s) {
    return is_finite(Scalar(s.position.x + s.position.y + s.slope.x + s.slope.y + s.q_over_p));
  }

  /// Lanes in which the shortest step is still too long end here.
  template <class Scalar, class Mask>
  static void give_up(nystrom_state<Scalar>& now, const nystrom_step<Scalar, Field>& next, const Mask& too_long, flight_status& why) {
    const Scalar nan(std::numeric_limits<double>::quiet_NaN());
    const auto& last = next.end();
    why = any_of(is_finite(next.error())) ? flight_status::too_many_steps : flight_status::no_field;
    now.position = {select(too_long, nan, last.position.x), select(too_long, nan, last.position.y)};
    now.slope = {select(too_long, nan, last.slope.x), select(too_long, nan, last.slope.y)};
  }

  /// From q/p back to q/pz = (q/p) sqrt(1 + tx^2 + ty^2), at both ends.
  template <class Scalar, std::size_t Columns>
  [[nodiscard]] static kalman::propagated<Scalar, 5> in_slopes(const vector<Scalar, 5>& start, const Scalar& path, const nystrom_state<Scalar>& end,
                                                               const nystrom_derivatives<Scalar, Columns>& d) {
    using s = slope_state;
    using step = nystrom_step<Scalar, Field>;
    const Scalar path_end = detail::path_per_dz(end.slope);
    kalman::propagated<Scalar, 5> out;
    out.state << end.position.x, end.slope.x, end.position.y, end.slope.y, Scalar(end.q_over_p * path_end);

    const Scalar per_path = Scalar(1.0) / path;
    const Scalar by_slope = -end.q_over_p * per_path;  // d(q/p) = (d(q/pz) - (q/p)(tx dtx + ty dty)/path) / path
    const auto column = [&](int j, const planar<Scalar>& position, const planar<Scalar>& slope, const Scalar& q_over_p) {
      out.jacobian(s::x, j) = position.x;
      out.jacobian(s::y, j) = position.y;
      out.jacobian(s::tx, j) = slope.x;
      out.jacobian(s::ty, j) = slope.y;
      out.jacobian(s::q_over_pz, j) = q_over_p * path_end + end.q_over_p / path_end * dot(end.slope, slope);
    };
    const auto with_momentum = [&](int j, std::size_t own, const Scalar& q_over_p) {
      constexpr std::size_t k = step::q_over_p_column;
      column(j, d.position[own] + q_over_p * d.position[k], d.slope[own] + q_over_p * d.slope[k], q_over_p);
    };
    with_momentum(s::tx, step::tx_column, Scalar(by_slope * per_path * start[s::tx]));
    with_momentum(s::ty, step::ty_column, Scalar(by_slope * per_path * start[s::ty]));
    constexpr std::size_t k = step::q_over_p_column;
    column(s::q_over_pz, per_path * d.position[k], per_path * d.slope[k], per_path);
    if constexpr (step::has_gradient) {
      column(s::x, d.position[step::x_column], d.slope[step::x_column], Scalar(0.0));
      column(s::y, d.position[step::y_column], d.slope[step::y_column], Scalar(0.0));
    } else {
      const Scalar zero(0.0), one(1.0);
      column(s::x, {one, zero}, {zero, zero}, zero);
      column(s::y, {zero, one}, {zero, zero}, zero);
    }
    return out;
  }
};

template <class Field>
nystrom_propagator(Field) -> nystrom_propagator<Field>;
template <class Field>
nystrom_propagator(Field, nystrom_options) -> nystrom_propagator<Field>;

}  // namespace scifi
