// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>

#include <scifi/kalman/propagation.hpp>

// What any propagator must obey, as deviations that a test compares with a tolerance. `units` says what a change of 1 is in each component.
namespace laws {

/// Largest component of end - start after a step and its reverse, over 1 + |start|.
template <class P, class Scalar, int N, class Step>
Scalar round_trip_deviation(const P& p, const scifi::vector<Scalar, N>& x, const Step& there, const Step& back) {
  const auto end = scifi::kalman::propagate(p, x, there);
  const auto again = scifi::kalman::propagate(p, end.state, back);
  const scifi::matrix<Scalar, N, N> product = again.jacobian * end.jacobian;
  const Scalar states = ((again.state - x).array().abs() / (1 + x.array().abs())).maxCoeff();
  const Scalar jacobians = (product - scifi::matrix<Scalar, N, N>::Identity()).norm() / (again.jacobian.norm() * end.jacobian.norm());
  return states < jacobians ? jacobians : states;
}

/// Largest difference between two steps and the whole, in state and Jacobian, relative.
template <class P, class Scalar, int N, class Step>
Scalar composition_deviation(const P& p, const scifi::vector<Scalar, N>& x, const Step& first, const Step& second, const Step& whole) {
  const auto middle = scifi::kalman::propagate(p, x, first);
  const auto end = scifi::kalman::propagate(p, middle.state, second);
  const auto once = scifi::kalman::propagate(p, x, whole);
  const Scalar states = ((end.state - once.state).array().abs() / (1 + once.state.array().abs())).maxCoeff();
  const Scalar jacobians = (end.jacobian * middle.jacobian - once.jacobian).norm() / once.jacobian.norm();
  return states < jacobians ? jacobians : states;
}

/// Largest difference between the Jacobian and central differences with steps h times `units`, in those units.
template <class P, class Scalar, int N, class Step>
Scalar propagator_jacobian_deviation(const P& p, const scifi::vector<Scalar, N>& x, const Step& step, Scalar h,
                                     const scifi::vector<Scalar, N>& units = scifi::vector<Scalar, N>::Ones()) {
  const auto moved = scifi::kalman::propagate(p, x, step);
  Scalar worst = 0;
  for (int j = 0; j < N; ++j) {
    scifi::vector<Scalar, N> up = x, down = x;
    up(j) += h * units(j);
    down(j) -= h * units(j);
    const scifi::vector<Scalar, N> difference =
        (scifi::kalman::propagate(p, up, step).state - scifi::kalman::propagate(p, down, step).state) / (2 * h);
    for (int i = 0; i < N; ++i) {
      const Scalar off = (difference(i) - moved.jacobian(i, j) * units(j)) / units(i);
      worst = off < worst ? (-off < worst ? worst : -off) : off;
    }
  }
  return worst;
}

/// What `jacobian_against_differences` found.
template <class Scalar>
struct jacobian_check {
  Scalar deviation_over_error;
  Scalar error;
};

/// The Jacobian against central differences whose error is known from themselves: steps of h and h/2 times `units` differ by three times the
/// error that the shorter one has left from the curvature, and `roundings` of the end state divided by the step come on top. Returns the largest
/// deviation over that error (a right Jacobian stays below 1) and the largest error, in `units`, which a test should keep small.
template <class P, class Scalar, int N, class Step>
jacobian_check<Scalar> jacobian_against_differences(const P& p, const scifi::vector<Scalar, N>& x, const Step& step, Scalar h,
                                                    const scifi::vector<Scalar, N>& units, Scalar roundings) {
  const auto moved = scifi::kalman::propagate(p, x, step);
  const auto central = [&](int j, Scalar by) -> scifi::vector<Scalar, N> {
    scifi::vector<Scalar, N> up = x, down = x;
    up(j) += by * units(j);
    down(j) -= by * units(j);
    return (scifi::kalman::propagate(p, up, step).state - scifi::kalman::propagate(p, down, step).state) / (up(j) - down(j));
  };
  jacobian_check<Scalar> worst{0, 0};
  for (int j = 0; j < N; ++j) {
    const scifi::vector<Scalar, N> wide = central(j, h), narrow = central(j, h / 2);
    for (int i = 0; i < N; ++i) {
      const Scalar rounding = roundings * std::numeric_limits<Scalar>::epsilon() * (std::abs(moved.state(i)) + units(i)) / (h * units(j));
      const Scalar error = std::abs(wide(i) - narrow(i)) + rounding;
      const Scalar deviation = std::abs(narrow(i) - moved.jacobian(i, j)) / error;
      const Scalar in_units = error * units(j) / units(i);
      if (!(deviation <= worst.deviation_over_error)) worst.deviation_over_error = deviation;
      if (!(in_units <= worst.error)) worst.error = in_units;
    }
  }
  return worst;
}

}  // namespace laws
