// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/solution.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "random_problem.hpp"
#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

namespace {

normal_equations sum_of(const test::random_problem& problem) {
  normal_equations sum(problem.globals);
  local_elimination eliminate;
  reduced_track out;
  for (const track_equations& track : problem.tracks) {
    eliminate(track, problem.globals, out);
    sum.add(out);
  }
  return sum;
}

/// Positions measured in units that differ by six orders, against the rest of the same line: only differences from their mean are known.
normal_equations only_differences(int parameters) {
  normal_equations sum(parameters);
  local_elimination eliminate;
  reduced_track out;
  for (int t = 0; t < 5; ++t) {
    track_equations track;
    track.clear(1);
    for (int i = 0; i < parameters; ++i) {
      const std::array<double, 1> local{1.0};
      const std::array<coefficient, 1> global{{{i, i == 0 ? 1e6 : 1.0}}};
      track.add(0.1 * i + 0.01 * t * t, 0.5, local, global);
    }
    eliminate(track, parameters, out);
    sum.add(out);
  }
  return sum;
}

}  // namespace

TEST_CASE("values, covariance, multipliers and chi2 are those of one dense least squares with every track's parameters kept", "[alignment]") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const test::random_problem problem(seed);
    std::vector<constraint> constraints;
    if (seed > 3) constraints.push_back({"sum", {{0, 1.0}, {1, 1.0}, {2, 1.0}}, 0.0});
    if (seed > 6) constraints.push_back({"one", {{4, 100.0}}, 25.0});
    const test::dense_least_squares expected(problem.globals, problem.tracks, constraints);
    const solution found = solve(sum_of(problem), constraints);
    REQUIRE(found.status == failure::none);
    // Normal equations of 80 unknowns with condition numbers of some 1e5.
    CHECK((found.values - expected.values).norm() <= 1e-9 * expected.values.norm());
    CHECK((found.covariance - expected.covariance).norm() <= 1e-9 * expected.covariance.norm());
    CHECK((found.multipliers - expected.multipliers).norm() <= 1e-8 * (1.0 + expected.multipliers.norm()));
    CHECK(found.chi2 == Approx(expected.chi2).epsilon(1e-9));
    CHECK(found.modes.size() == 6 - constraints.size());
    CHECK(found.undetermined == 0);
  }
}

TEST_CASE("pulls of the values have mean zero and width one, chi2 the mean of its degrees of freedom", "[alignment]") {
  double sum = 0.0, squares = 0.0, chi2 = 0.0;
  long ndf = 0;
  int n = 0;
  for (std::uint64_t seed = 100; seed < 200; ++seed) {
    const test::random_problem problem(seed);
    const solution found = solve(sum_of(problem), {});
    REQUIRE(found.status == failure::none);
    // Whitened by the covariance: six independent numbers a problem.
    const Eigen::MatrixXd information = found.covariance.inverse();
    squares += (found.values - problem.truth).dot(information * (found.values - problem.truth));
    for (int i = 0; i < problem.globals; ++i) sum += (found.values[i] - problem.truth[i]) / found.sigma(i);
    n += problem.globals;
    chi2 += found.chi2;
    ndf += found.ndf;
  }
  // Four standard errors: of a mean of n, correlated by at most two; of a sum of n squares; of chi2.
  CHECK(std::abs(sum / n) <= 4.0 * 2.0 / std::sqrt(n));
  CHECK(std::abs(squares / n - 1.0) <= 4.0 * std::sqrt(2.0 / n));
  CHECK(std::abs(chi2 / static_cast<double>(ndf) - 1.0) <= 4.0 * std::sqrt(2.0 / static_cast<double>(ndf)));
}

TEST_CASE("what tracks cannot see is found and named, and a constraint takes it away", "[alignment]") {
  const normal_equations sum = only_differences(4);
  const solution open = solve(sum, {});
  CHECK(open.status == failure::undetermined_parameters);
  CHECK(open.undetermined == 1);
  CHECK(open.values == Eigen::VectorXd::Zero(4));
  // All by the same length: 1e-6 of the first parameter's unit.
  const Eigen::VectorXd& lost = open.modes.front().direction;
  CHECK(open.modes.front().share <= 1e-12);
  CHECK(open.modes[1].share > 0.5);
  for (int i = 1; i < 4; ++i) CHECK(lost[i] == Approx(lost[0] * 1e6));

  const std::vector<constraint> mean{{"mean", {{0, 1e6}, {1, 1.0}, {2, 1.0}, {3, 1.0}}, 0.0}};
  const solution fixed = solve(sum, mean);
  REQUIRE(fixed.status == failure::none);
  CHECK(std::abs(fixed.multipliers[0]) <= 1e-9);
  const std::array<double, 4> expected{-0.15, -0.05, 0.05, 0.15};
  for (int i = 0; i < 4; ++i) {
    const double unit = i == 0 ? 1e6 : 1.0;
    CHECK(fixed.values[i] * unit == Approx(expected[static_cast<std::size_t>(i)]));
    // Five tracks; of four positions about their mean 3/4 is left.
    CHECK(fixed.sigma(i) * unit == Approx(0.5 / std::sqrt(5.0) * std::sqrt(0.75)));
  }
}

TEST_CASE("a parameter without tracks is undetermined unless a constraint holds it", "[alignment]") {
  normal_equations sum = sum_of(test::random_problem(3));
  normal_equations wider(7);
  local_elimination eliminate;
  reduced_track out;
  for (const track_equations& track : test::random_problem(3).tracks) {
    eliminate(track, 7, out);
    wider.add(out);
  }
  const solution open = solve(wider, {});
  CHECK(open.status == failure::undetermined_parameters);
  CHECK(open.undetermined == 1);
  CHECK(std::abs(open.modes.front().direction[6]) == Approx(1.0));
  const std::vector<constraint> held{{"held", {{6, 1.0}}, 0.5}};
  const solution fixed = solve(wider, held);
  REQUIRE(fixed.status == failure::none);
  CHECK(fixed.values[6] == Approx(0.5));
  CHECK(fixed.sigma(6) <= 1e-12);
  CHECK((fixed.values.head(6) - solve(sum, {}).values).norm() <= 1e-9);
}

TEST_CASE("constraints that repeat others do no harm, those that contradict them are refused", "[alignment]") {
  const normal_equations sum = sum_of(test::random_problem(4));
  const constraint once{"once", {{0, 1.0}, {1, -1.0}}, 0.3}, again{"again", {{0, -2.0}, {1, 2.0}}, -0.6}, against{"against", {{0, -2.0}, {1, 2.0}}, 0.0};
  const std::vector<constraint> one{once}, two{once, again}, three{once, against};
  const solution a = solve(sum, one), b = solve(sum, two);
  REQUIRE(b.status == failure::none);
  CHECK((a.values - b.values).norm() <= 1e-9);
  CHECK(a.ndf == b.ndf);
  CHECK(solve(sum, three).status == failure::contradictory_constraints);
  const std::vector<constraint> unknown{{"unknown", {{6, 1.0}}, 0.0}};
  CHECK(solve(sum, unknown).status == failure::unknown_parameter);
}

TEST_CASE("constraints may leave nothing free", "[alignment]") {
  std::vector<constraint> all;
  for (int i = 0; i < 6; ++i) all.push_back({"", {{i, 1.0}}, 0.1 * i});
  const solution found = solve(sum_of(test::random_problem(5)), all);
  REQUIRE(found.status == failure::none);
  for (int i = 0; i < 6; ++i) CHECK(found.values[i] == Approx(0.1 * i).margin(1e-12));
  CHECK(found.covariance.norm() == 0.0);
  CHECK(found.modes.empty());
}
