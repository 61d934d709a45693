// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string_view>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>

namespace scifi::kalman {

/// The kind of step that a status speaks of.
enum class step_kind { predict, update, smooth };

/// Why a step failed.
enum class reason { none, not_finite, not_positive_definite, singular_innovation, not_converged, out_of_space, missing_reference, not_reached };

/// Outcome of a step: which kind it was, and why it failed.
/// With one track per SIMD lane a step fails when no lane is left; the chi2 of a lane that failed is NaN.
struct status {
  step_kind step = step_kind::predict;
  reason why = reason::none;

  [[nodiscard]] constexpr bool ok() const { return why == reason::none; }
  [[nodiscard]] constexpr explicit operator bool() const { return ok(); }
  friend constexpr bool operator==(const status&, const status&) = default;
};

/// Name of a kind of step: "predict", "update", "smooth".
[[nodiscard]] constexpr std::string_view to_string(step_kind step) {
  switch (step) {
    case step_kind::predict: return "predict";
    case step_kind::update: return "update";
    case step_kind::smooth: return "smooth";
  }
  return "unknown step";
}

/// Name of a reason, as in the source.
[[nodiscard]] constexpr std::string_view to_string(reason why) {
  switch (why) {
    case reason::none: return "none";
    case reason::not_finite: return "not_finite";
    case reason::not_positive_definite: return "not_positive_definite";
    case reason::singular_innovation: return "singular_innovation";
    case reason::not_converged: return "not_converged";
    case reason::out_of_space: return "out_of_space";
    case reason::missing_reference: return "missing_reference";
    case reason::not_reached: return "not_reached";
  }
  return "unknown reason";
}

/// A reason as a clause for people.
[[nodiscard]] constexpr std::string_view describe(reason why) {
  switch (why) {
    case reason::none: return "nothing went wrong";
    case reason::not_finite: return "a number is infinite or not a number";
    case reason::not_positive_definite: return "a covariance is not positive definite";
    case reason::singular_innovation: return "the covariance of the residual cannot be inverted";
    case reason::not_converged: return "the iteration did not converge";
    case reason::out_of_space: return "there are more sites than nodes to write to";
    case reason::missing_reference: return "there are fewer reference states than sites";
    case reason::not_reached: return "no run has reached this node";
  }
  return "unknown reason";
}

/// What is wrong with a mean and a covariance, judged by finiteness and the signs of the variances: O(N), not a full test of definiteness.
template <class Scalar, int N>
[[nodiscard, gnu::always_inline]] inline reason fault_of(const vector<Scalar, N>& mean, const matrix<Scalar, N, N>& covariance) {
  Scalar of_mean(0.0);
  Scalar of_variances(0.0);
  Scalar lowest(covariance(0, 0));
  for (int i = 0; i < N; ++i) {
    of_mean += mean(i);
    of_variances += covariance(i, i);
    lowest = smaller_of<Scalar>(lowest, covariance(i, i));
  }
  const auto finite = is_finite<Scalar>(of_mean + of_variances);
  if (any_of(finite && lowest >= Scalar(0.0))) return reason::none;
  return any_of(finite) ? reason::not_positive_definite : reason::not_finite;
}

}  // namespace scifi::kalman
