// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/gain.hpp>

/// What update policies of one shape share: a policy with a member correct(prior, seen, gain, posterior) that writes the posterior's mean and covariance.
namespace scifi::kalman::detail {

struct leave_unrecorded {
  template <class Seen, class Gain>
  [[gnu::always_inline]] void operator()(const Seen&, const Gain&) const {}
};

/// Takes a measurement in by `policy`, the posterior written where it is to stay; record(seen, gain) is called before. The prior stands there after a failure.
template <class Policy, class Scalar, int N, class Measurement, class Record = leave_unrecorded>
[[gnu::always_inline]] inline status correct_into(const Policy& policy, const estimate<Scalar, N>& prior, const Measurement& m, estimate<Scalar, N>& posterior, Scalar& chi2, const Record& record = {}) {
  constexpr int M = max_measurement_dimension<Measurement>;
  const auto take_in = [&](const innovation_view<Scalar, N, M>& seen) __attribute__((always_inline)) {
    gain<Scalar, N, M> k;
    set_gain<seen_components_of<Measurement>(), Scalar, N, M>(k, prior.covariance, seen);
    record(seen, k);
    policy.correct(prior, seen, k, posterior);
    chi2 = k.chi2;
    status s{step_kind::update, k.why};
    if (s.ok()) s.why = any_of(is_finite<Scalar>(k.chi2)) ? fault_of(posterior.mean, posterior.covariance) : reason::not_finite;
    if (!s.ok()) posterior = prior;
    return s;
  };
  return with_innovation(m, prior.mean, take_in);
}

/// The same with all that is known of it.
template <class Policy, class Scalar, int N, class Measurement>
[[nodiscard, gnu::always_inline]] inline auto corrected(const Policy& policy, const estimate<Scalar, N>& prior, const Measurement& m) -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
  updated<Scalar, N, max_measurement_dimension<Measurement>> out;
  const auto record = [&out](const auto& seen, const auto& k) __attribute__((always_inline)) {
    out.residual = seen.residual;
    out.residual_covariance = k.residual_covariance;
    out.jacobian = seen.jacobian;
    out.measurement_covariance = seen.covariance;
  };
  out.status = correct_into(policy, prior, m, out.posterior, out.chi2, record);
  return out;
}

}  // namespace scifi::kalman::detail
