// SPDX-License-Identifier: MPL-2.0
// The filter step of bench/filter_step.cpp by dlib's kalman_filter.
#include <dlib/filtering.h>

#include "support/peer_main.hpp"

namespace {

template <int N, int M>
struct dlib_filter {
  static constexpr bool has_chi2 = false;

  template <int Rows, int Cols>
  static dlib::matrix<double, Rows, Cols> given(const scifi::matrix<double, Rows, Cols>& m) {
    dlib::matrix<double, Rows, Cols> out;
    for (int i = 0; i < Rows; ++i)
      for (int j = 0; j < Cols; ++j) out(i, j) = m(i, j);
    return out;
  }

  static stepping::answer<N> run(const stepping::problem<double, N, M>& g) {
    static dlib::kalman_filter<N, M> filter = [&g] {
      dlib::kalman_filter<N, M> f;
      f.set_transition_model(given(g.f));
      f.set_process_noise(given(g.q));
      f.set_observation_model(given(g.h));
      f.set_measurement_noise(given(g.r));
      return f;
    }();
    static const std::vector<dlib::matrix<double, M, 1>> measured = [&g] {
      std::vector<dlib::matrix<double, M, 1>> all;
      for (const auto& z : g.z) all.push_back(given<M, 1>(z));
      return all;
    }();
    filter.set_state(dlib::zeros_matrix<double>(N, 1));
    filter.set_estimation_error_covariance(dlib::identity_matrix<double>(N));
    for (const auto& z : measured) filter.update(z);
    stepping::answer<N> out;
    for (int i = 0; i < N; ++i) {
      out.x(i) = filter.get_current_state()(i);
      for (int j = 0; j < N; ++j) out.p(i, j) = filter.get_current_estimation_error_covariance()(i, j);
    }
    return out;
  }
};

}  // namespace

int main(int argc, char** argv) { return stepping::time_peer<dlib_filter>("dlib", argc, argv); }
