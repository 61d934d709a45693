// SPDX-License-Identifier: MPL-2.0
// The filter step of bench/filter_step.cpp by the Bayesian Filtering Library (Orocos).
#include <bfl/filter/extendedkalmanfilter.h>
#include <bfl/model/linearanalyticmeasurementmodel_gaussianuncertainty.h>
#include <bfl/model/linearanalyticsystemmodel_gaussianuncertainty.h>

#include "support/peer_main.hpp"

namespace {

template <int N, int M>
struct bfl {
  static constexpr bool has_chi2 = false;

  template <int Rows, int Cols>
  static MatrixWrapper::Matrix given(const scifi::matrix<double, Rows, Cols>& m) {
    MatrixWrapper::Matrix out(Rows, Cols);
    for (int i = 0; i < Rows; ++i)
      for (int j = 0; j < Cols; ++j) out(static_cast<unsigned>(i) + 1, static_cast<unsigned>(j) + 1) = m(i, j);
    return out;
  }
  template <int Rows>
  static BFL::Gaussian noise(const scifi::matrix<double, Rows, Rows>& covariance) {
    MatrixWrapper::ColumnVector zero(Rows);
    zero = 0.0;
    MatrixWrapper::SymmetricMatrix s(Rows);
    for (int i = 0; i < Rows; ++i)
      for (int j = 0; j < Rows; ++j) s(static_cast<unsigned>(i) + 1, static_cast<unsigned>(j) + 1) = covariance(i, j);
    return BFL::Gaussian(zero, s);
  }

  static stepping::answer<N> run(const stepping::problem<double, N, M>& g) {
    static BFL::LinearAnalyticConditionalGaussian moves(given(g.f), noise<N>(g.q)), sees(given(g.h), noise<M>(g.r));
    static BFL::LinearAnalyticSystemModelGaussianUncertainty system(&moves);
    static BFL::LinearAnalyticMeasurementModelGaussianUncertainty measurement(&sees);
    static const std::vector<MatrixWrapper::ColumnVector> measured = [&g] {
      std::vector<MatrixWrapper::ColumnVector> all;
      for (const auto& z : g.z) {
        MatrixWrapper::ColumnVector v(M);
        for (int i = 0; i < M; ++i) v(static_cast<unsigned>(i) + 1) = z(i);
        all.push_back(v);
      }
      return all;
    }();
    BFL::Gaussian start = noise<N>(scifi::matrix<double, N, N>::Identity());
    BFL::ExtendedKalmanFilter filter(&start);
    for (const auto& z : measured) filter.Update(&system, &measurement, z);
    stepping::answer<N> out;
    const MatrixWrapper::ColumnVector x = filter.PostGet()->ExpectedValueGet();
    const MatrixWrapper::SymmetricMatrix p = filter.PostGet()->CovarianceGet();
    for (int i = 0; i < N; ++i) {
      out.x(i) = x(static_cast<unsigned>(i) + 1);
      for (int j = 0; j < N; ++j) out.p(i, j) = p(static_cast<unsigned>(i) + 1, static_cast<unsigned>(j) + 1);
    }
    return out;
  }
};

}  // namespace

int main(int argc, char** argv) { return stepping::time_peer<bfl>("bfl", argc, argv); }
