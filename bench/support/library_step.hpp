// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <cstdio>

#include <scifi/core/lane.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/symmetric_form.hpp>

#include "support/step_problem.hpp"

// The filter step of the library: on one track, and with one track a lane.
namespace stepping {

namespace kalman = scifi::kalman;

template <class Scalar, int N, int M>
struct constant_model {
  const problem<Scalar, N, M>* g;
  const scifi::matrix<Scalar, N, N>& transition(double) const { return g->f; }
  const scifi::matrix<Scalar, N, N>& covariance(double) const { return g->q; }
};

template <class Scalar, int N, int M>
struct measured {
  const problem<Scalar, N, M>* g;
  std::size_t i;
  const scifi::vector<Scalar, M>& value() const { return g->z[i]; }
  const scifi::matrix<Scalar, M, N>& projection() const { return g->h; }
  const scifi::matrix<Scalar, M, M>& covariance() const { return g->r; }
};

/// All steps in place. Returns chi2.
template <class Update, class Scalar, int N, int M>
Scalar advance_all(const problem<Scalar, N, M>& g, kalman::estimate<Scalar, N>& e) {
  const constant_model<Scalar, N, M> model{&g};
  const kalman::filter filter{model, model, Update{}};
  Scalar chi2(0.0);
  for (std::size_t i = 0; i < steps; ++i) chi2 += filter.advance(e, 1.0, measured<Scalar, N, M>{&g, i}).chi2;
  return chi2;
}

template <class Update>
struct library {
  template <int N, int M>
  struct form {
    static constexpr bool has_chi2 = true;
    static answer<N> run(const problem<double, N, M>& g) {
      kalman::estimate<double, N> e{answer<N>{}.x, answer<N>{}.p};
      const double chi2 = advance_all<Update>(g, e);
      return {e.mean, e.covariance, chi2};
    }
  };
};

template <class Scalar>
void set_number(Scalar& x, int lane, double value) {
  if constexpr (requires { x.set(lane, value); }) scifi::set_lane(x, lane, value);
  else x[static_cast<std::size_t>(lane)] = value;
}

template <class Scalar>
double number_of(const Scalar& x, int lane) {
  if constexpr (requires { typename Scalar::vector_type; }) return static_cast<double>(x[lane]);
  else return static_cast<double>(x[static_cast<std::size_t>(lane)]);
}

/// One track in each lane of Scalar; that in lane l begins with the measured value number l.
template <class Scalar>
struct in_lanes {
  template <int N, int M>
  struct form {
    static constexpr bool has_chi2 = true;
    static constexpr int tracks = scifi::lane_count<Scalar>;
    static constexpr double tolerance = sizeof(typename Scalar::value_type) == sizeof(double) ? 1e-11 : 1e-3;

    static problem<double, N, M> of_lane(const problem<double, N, M>& g, int lane) {
      problem<double, N, M> out = g;
      for (std::size_t i = 0; i < steps; ++i) out.z[i] = g.z[(i + static_cast<std::size_t>(lane)) % steps];
      return out;
    }
    static const problem<Scalar, N, M>& laid_out(const problem<double, N, M>& g) {
      static const problem<Scalar, N, M> out = [&g] {
        problem<Scalar, N, M> p{g.f.template cast<Scalar>(), g.q.template cast<Scalar>(), g.h.template cast<Scalar>(), g.r.template cast<Scalar>(), {}};
        for (int lane = 0; lane < tracks; ++lane) {
          const problem<double, N, M> own = of_lane(g, lane);
          for (std::size_t i = 0; i < steps; ++i)
            for (int m = 0; m < M; ++m) set_number(p.z[i](m), lane, own.z[i](m));
        }
        return p;
      }();
      return out;
    }
    static answer<N> run(const problem<double, N, M>& g, int lane = 0) {
      kalman::estimate<Scalar, N> e{scifi::vector<Scalar, N>::Zero(), scifi::matrix<Scalar, N, N>::Identity()};
      const Scalar chi2 = advance_all<kalman::symmetric_form>(laid_out(g), e);
      const auto number = [lane](const Scalar& x) { return number_of(x, lane); };
      return {e.mean.unaryExpr(number), e.covariance.unaryExpr(number), number(chi2)};
    }
    /// Each lane gives what its track gives alone.
    static bool every_lane_right() {
      const problem<double, N, M>& g = given<N, M>();
      for (int lane = 0; lane < tracks; ++lane)
        if (!agree(run(g, lane), library<kalman::symmetric_form>::form<N, M>::run(of_lane(g, lane)), tolerance)) return false;
      return true;
    }
  };
};

template <class Scalar, int N, int M>
void add_lanes(const char* name) {
  if (!in_lanes<Scalar>::template form<N, M>::every_lane_right()) {
    std::fprintf(stderr, "%s: a lane differs from its track alone\n", name);
    all_right = false;
  }
  add<in_lanes<Scalar>::template form, N, M>(name);
}

}  // namespace stepping
