// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/normal_equations.hpp>

#include <stdexcept>

#include "random_problem.hpp"
#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

TEST_CASE("sums over halves of the tracks add up to the sum over all", "[alignment]") {
  const test::random_problem problem(2);
  normal_equations all(problem.globals), even(problem.globals), odd(problem.globals);
  local_elimination eliminate;
  reduced_track out;
  for (std::size_t i = 0; i < problem.tracks.size(); ++i) {
    eliminate(problem.tracks[i], problem.globals, out);
    all.add(out);
    (i % 2 == 0 ? even : odd).add(out);
  }
  even += odd;
  CHECK(even.tracks() == 30);
  CHECK(even.ndf() == all.ndf());
  CHECK(even.chi2() == Approx(all.chi2()));
  CHECK((even.matrix() - all.matrix()).norm() <= 1e-12 * all.matrix().norm());
  CHECK((even.gradient() - all.gradient()).norm() <= 1e-12 * all.gradient().norm());
  CHECK((even.own() - all.own()).norm() <= 1e-12 * all.own().norm());
  CHECK(all.matrix() == all.matrix().transpose());
}

TEST_CASE("a track that failed adds nothing", "[alignment]") {
  normal_equations sum(2);
  reduced_track failed;
  failed.status = failure::singular_track;
  failed.chi2 = 5.0;
  sum.add(failed);
  CHECK(sum.tracks() == 0);
  CHECK(sum.chi2() == 0.0);
}

TEST_CASE("sums over different parameters are not added", "[alignment]") {
  normal_equations sum(2);
  CHECK_THROWS_AS(sum += normal_equations(3), std::invalid_argument);
}
