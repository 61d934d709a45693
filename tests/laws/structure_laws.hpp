// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/structure.hpp>

#include "laws/update_laws.hpp"

namespace laws {

/// The same model without its declaration of structure.
template <class Propagator>
struct undeclared_step {
  Propagator model;
  template <class X, class Step>
  auto propagate(const X& x, const Step& step) const { return scifi::kalman::propagate(model, x, step); }
};
template <class Measurement>
struct undeclared_measurement {
  Measurement m;
  decltype(auto) value() const { return m.value(); }
  decltype(auto) projection() const { return m.projection(); }
  decltype(auto) covariance() const { return m.covariance(); }
};

/// How far what a propagator declares is from its Jacobian: the largest entry of a declared column less that of the identity.
template <class Propagator, class Scalar, int N, class Step>
Scalar undeclared_columns(const Propagator& p, const scifi::vector<Scalar, N>& x, const Step& step) {
  const auto jacobian = scifi::kalman::propagate(p, x, step).jacobian;
  Scalar worst = 0;
  for (const auto column : scifi::kalman::unit_columns<Propagator>)
    for (int i = 0; i < N; ++i) worst = std::max<Scalar>(worst, std::abs(jacobian(i, static_cast<int>(column)) - Scalar(i == static_cast<int>(column) ? 1 : 0)));
  return worst;
}

/// How much a step and an update change when the declarations are hidden; see estimate_distance.
template <class Update, class Propagator, class Noise, class Scalar, int N, class Step, class Measurement>
Scalar declaration_dependence(const Update& update, const Propagator& p, const Noise& q, const scifi::kalman::estimate<Scalar, N>& start, const Step& step, const Measurement& m) {
  const scifi::kalman::filter declared{p, q, update};
  const scifi::kalman::filter dense{undeclared_step<Propagator>{p}, q, update};
  const undeclared_measurement<Measurement> seen{m};
  const auto moved = declared.predict(start, step);
  const auto moved_densely = dense.predict(start, step);
  auto in_place = start;
  if (!declared.advance(in_place, step, m).status.ok()) return Scalar(std::nan(""));
  const auto one = declared.update(moved, m).posterior;
  const auto other = dense.update(moved_densely, seen).posterior;
  return std::max({estimate_distance(moved_densely.estimate, moved.estimate), estimate_distance(other, one), estimate_distance(other, in_place)});
}

}  // namespace laws
