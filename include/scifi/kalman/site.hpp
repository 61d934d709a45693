// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

namespace scifi::kalman {

/// One stop of a run: the step that leads to it from the one before, and what is measured there.
/// Any type with these two members will do. The step may be a std::optional: `at_start` then means that there is no step to take.
template <class Step, class Measurement>
struct site {
  Step step;
  Measurement measurement;
};

template <class Step, class Measurement>
site(Step, Measurement) -> site<Step, Measurement>;

/// The step of a site that lies where the estimate already is.
inline constexpr std::nullopt_t at_start = std::nullopt;

}  // namespace scifi::kalman
