// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string_view>

namespace scifi::alignment {

/// Why a track was not used, or why the parameters were not found.
enum class failure {
  none,
  not_finite,
  no_error,                  // a standard deviation is zero or negative
  unknown_parameter,
  too_few_measurements,
  singular_track,
  not_positive_definite,
  contradictory_constraints,
  undetermined_parameters,
};

/// A failure as a clause for people.
[[nodiscard]] constexpr std::string_view describe(failure why) {
  switch (why) {
    case failure::none: return "nothing went wrong";
    case failure::not_finite: return "a number is infinite or not a number";
    case failure::no_error: return "a standard deviation is not positive";
    case failure::unknown_parameter: return "a derivative names a parameter that does not exist";
    case failure::too_few_measurements: return "the track has no more measurements than parameters of its own";
    case failure::singular_track: return "the measurements do not determine the parameters of the track";
    case failure::not_positive_definite: return "the covariance of the measurements is not positive definite";
    case failure::contradictory_constraints: return "the constraints contradict each other";
    case failure::undetermined_parameters: return "tracks and constraints do not determine all parameters";
  }
  return "unknown failure";
}

}  // namespace scifi::alignment
