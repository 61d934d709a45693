// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/disjoint.hpp>

#include <vector>

#include "support/catch.hpp"
#include "support/made_candidates.hpp"

using namespace scifi;
using scifi::test::candidate_of;
using scifi::test::point_of;

namespace {

struct outcome {
  std::vector<double> chi2;
  std::vector<char> used;
};

outcome select(const std::vector<candidate>& found, const std::vector<space_point>& points, double gain, int max_shared, std::vector<char> used) {
  std::vector<candidate> selected;
  disjoint_buffers work;
  select_disjoint(found, points, gain, max_shared, used, selected, work);
  outcome out{{}, used};
  for (const candidate& c : selected) out.chi2.push_back(c.chi2);
  return out;
}

const std::vector<space_point> triplets{point_of({0, 1, 2}), point_of({3, 4, 5}), point_of({6, 7, 8}), point_of({2, 9, 10})};

}  // namespace

TEST_CASE("of candidates that share clusters the one with the smaller chi2 stays", "[space_point_to_candidate]") {
  const auto none = std::vector<char>(11, 0);
  CHECK(select({candidate_of({0, 1}, 8.0), candidate_of({1, 2}, 5.0)}, triplets, 0.0, 0, none).chi2 == std::vector<double>{5.0});
  // Points 0 and 3 share cluster 2.
  CHECK(select({candidate_of({0}, 4.0), candidate_of({3}, 3.0)}, triplets, 0.0, 0, none).chi2 == std::vector<double>{3.0});
  // Those that share nothing stay, best first; equal ones in the order found.
  CHECK(select({candidate_of({0}, 4.0), candidate_of({1}, 3.0), candidate_of({2}, 3.5)}, triplets, 0.0, 0, none).chi2 == std::vector<double>{3.0, 3.5, 4.0});
}

TEST_CASE("a cluster more is worth the gain in chi2", "[space_point_to_candidate]") {
  const auto none = std::vector<char>(11, 0);
  const std::vector<candidate> found{candidate_of({0}, 4.0), candidate_of({0, 1}, 20.0)};
  CHECK(select(found, triplets, 5.0, 0, none).chi2 == std::vector<double>{4.0});
  CHECK(select(found, triplets, 6.0, 0, none).chi2 == std::vector<double>{20.0});
}

TEST_CASE("as many clusters may be shared as is said", "[space_point_to_candidate]") {
  const auto none = std::vector<char>(11, 0);
  const std::vector<candidate> found{candidate_of({0}, 4.0), candidate_of({3}, 3.0), candidate_of({0, 1}, 10.0)};
  CHECK(select(found, triplets, 0.0, 1, none).chi2 == std::vector<double>{3.0, 4.0});
  CHECK(select(found, triplets, 0.0, 3, none).chi2 == std::vector<double>{3.0, 4.0, 10.0});
}

TEST_CASE("what is used already counts, and what is selected is marked", "[space_point_to_candidate]") {
  std::vector<char> used(11, 0);
  used[4] = 1;
  const outcome o = select({candidate_of({1}, 1.0), candidate_of({2}, 2.0)}, triplets, 0.0, 0, used);
  CHECK(o.chi2 == std::vector<double>{2.0});
  CHECK(o.used == std::vector<char>{0, 0, 0, 0, 1, 0, 1, 1, 1, 0, 0});
}

TEST_CASE("candidates are appended, none of none", "[space_point_to_candidate]") {
  std::vector<candidate> selected{candidate_of({0}, 1.0)};
  std::vector<char> used(11, 0);
  disjoint_buffers work;
  select_disjoint({}, triplets, 0.0, 0, used, selected, work);
  CHECK(selected.size() == 1);
  select_disjoint({candidate_of({1}, 2.0)}, triplets, 0.0, 0, used, selected, work);
  CHECK(selected.size() == 2);
}
