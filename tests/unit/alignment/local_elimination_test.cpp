// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/local_elimination.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/LU>

#include "random_problem.hpp"
#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

namespace {

constexpr std::array<double, 1> one{1.0};
constexpr std::array<coefficient, 1> on_first{{{0, 1.0}}};

failure status_of(const track_equations& track, int parameters = 6) {
  reduced_track out;
  local_elimination{}(track, parameters, out);
  return out.status;
}

}  // namespace

TEST_CASE("the reduced equations are the normal equations less what the track's parameters take, as in Millepede", "[alignment]") {
  const test::random_problem problem(1);
  local_elimination eliminate;
  reduced_track out;
  for (const track_equations& track : problem.tracks) {
    eliminate(track, problem.globals, out);
    REQUIRE(out.status == failure::none);
    const auto m = static_cast<Eigen::Index>(track.size());
    Eigen::MatrixXd local(m, track.local_parameters()), global = Eigen::MatrixXd::Zero(m, problem.globals);
    Eigen::VectorXd residual(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto r = track[static_cast<std::size_t>(i)];
      for (Eigen::Index k = 0; k < local.cols(); ++k) local(i, k) = r.local[static_cast<std::size_t>(k)] / r.sigma;
      for (const coefficient& c : r.global) global(i, c.parameter) = c.value / r.sigma;
      residual[i] = r.residual / r.sigma;
    }
    // Blobel and Kleinwort, hep-ex/0208021, eqs. 12 to 14: C - G' inv(Gamma) G, b - G' inv(Gamma) beta.
    const Eigen::MatrixXd inverse = (local.transpose() * local).inverse();
    const Eigen::MatrixXd mixed = local.transpose() * global;
    const Eigen::VectorXd beta = local.transpose() * residual;
    const Eigen::MatrixXd matrix = global.transpose() * global - mixed.transpose() * inverse * mixed;
    const Eigen::VectorXd gradient = global.transpose() * residual - mixed.transpose() * inverse * beta;
    // Differences of numbers of the size of the first terms.
    const double rounding = 1e-10 * (1.0 + global.squaredNorm() + residual.squaredNorm()) * (1.0 + inverse.norm());
    CHECK(out.rows.rows() == m - local.cols());
    CHECK(out.ndf == m - local.cols());
    CHECK(out.chi2 == Approx(residual.squaredNorm() - beta.dot(inverse * beta)).margin(rounding));
    for (std::size_t i = 0; i < out.parameters.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      CHECK(out.rows.col(column).dot(out.residuals) == Approx(gradient[out.parameters[i]]).margin(rounding));
      CHECK(out.own[column] == Approx(global.col(out.parameters[i]).squaredNorm()));
      for (std::size_t j = 0; j < out.parameters.size(); ++j)
        CHECK(out.rows.col(column).dot(out.rows.col(static_cast<Eigen::Index>(j))) == Approx(matrix(out.parameters[i], out.parameters[j])).margin(rounding));
    }
  }
}

TEST_CASE("a wide prior makes a track determined and is no degree of freedom", "[alignment]") {
  const std::array<double, 2> first{1.0, 0.0}, second{0.0, 1.0};
  track_equations track;
  track.clear(2);
  track.add(1.0, 1.0, first, on_first);
  track.add(3.0, 1.0, first, on_first);
  track.add(3.0, 1.0, first, on_first);
  CHECK(status_of(track) == failure::singular_track);
  track.add_wide_prior(0.0, 100.0, second);
  reduced_track out;
  local_elimination{}(track, 1, out);
  CHECK(out.status == failure::none);
  CHECK(out.ndf == 1);
  CHECK(out.chi2 == Approx(4.0 / 9.0 + 4.0 / 9.0 + 16.0 / 9.0));
}

TEST_CASE("a track without parameters of its own keeps its equations", "[alignment]") {
  track_equations track;
  track.clear(0);
  track.add(3.0, 2.0, {}, on_first);
  reduced_track out;
  local_elimination{}(track, 1, out);
  CHECK(out.status == failure::none);
  CHECK(out.rows(0, 0) == Approx(0.5));
  CHECK(out.residuals[0] == Approx(1.5));
}

TEST_CASE("a track that cannot be used says why", "[alignment]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](double residual, double sigma, double derivative, int parameter) {
    const std::array<double, 1> local{derivative};
    const std::array<coefficient, 1> global{{{parameter, 1.0}}};
    track_equations track;
    track.clear(1);
    track.add(0.0, 1.0, one, on_first);
    track.add(residual, sigma, local, global);
    return status_of(track);
  };
  CHECK(with(0.0, 1.0, 1.0, 5) == failure::none);
  CHECK(with(0.0, 0.0, 1.0, 5) == failure::no_error);
  CHECK(with(0.0, -1.0, 1.0, 5) == failure::no_error);
  CHECK(with(0.0, nan, 1.0, 5) == failure::not_finite);
  CHECK(with(nan, 1.0, 1.0, 5) == failure::not_finite);
  CHECK(with(0.0, 1.0, std::numeric_limits<double>::infinity(), 5) == failure::not_finite);
  CHECK(with(0.0, 1e-300, 1.0, 5) == failure::not_finite);
  CHECK(with(0.0, 1.0, 1.0, 6) == failure::unknown_parameter);
  CHECK(with(0.0, 1.0, 1.0, -1) == failure::unknown_parameter);
  track_equations track;
  track.clear(1);
  CHECK(status_of(track) == failure::too_few_measurements);
  track.add(0.0, 1.0, one, on_first);
  CHECK(status_of(track) == failure::too_few_measurements);
  const std::array<double, 1> none{0.0};
  track.clear(1);
  track.add(0.0, 1.0, none, on_first);
  track.add(0.0, 1.0, none, on_first);
  CHECK(status_of(track) == failure::singular_track);
}
