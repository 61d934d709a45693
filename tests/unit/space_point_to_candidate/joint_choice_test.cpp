// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/joint_choice.hpp>

#include <algorithm>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/space_point_to_candidate/disjoint.hpp>

#include "support/catch.hpp"
#include "support/made_candidates.hpp"

using namespace scifi;
using scifi::test::candidate_of;

namespace {

/// Twelve points of three clusters: four tracks of three points, 0-2, 3-5, 6-8 and 9-11.
std::vector<space_point> points() {
  std::vector<space_point> out(12);
  int cluster = 0;
  for (space_point& p : out)
    for (int i = 0; i < 3; ++i) p.clusters.push_back(cluster++);
  return out;
}

const std::vector<space_point> all_points = points();

std::vector<double> chosen(const std::vector<candidate>& found, const joint_choice& settings = {}, std::vector<char> used = std::vector<char>(36, 0)) {
  std::vector<candidate> selected;
  joint_buffers work;
  select_jointly(found, all_points, settings, used, selected, work);
  std::vector<double> out;
  for (const candidate& c : selected) {
    out.push_back(c.chi2);
    for (const int p : c.space_points)
      for (const int k : all_points[static_cast<std::size_t>(p)].clusters) CHECK(used[static_cast<std::size_t>(k)] == 1);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("a candidate better than each of three that it robs of a point gives way to the three", "[space_point_to_candidate]") {
  const std::vector<candidate> found{candidate_of({0, 4, 8}, 1.0), candidate_of({0, 1, 2}, 6.0), candidate_of({3, 4, 5}, 7.0), candidate_of({6, 7, 8}, 8.0)};
  CHECK(chosen(found, {10.0, 0}) == std::vector<double>{6.0, 7.0, 8.0});
  // Against one alone it wins.
  CHECK(chosen({found[0], found[1]}, {10.0, 0}) == std::vector<double>{1.0});
}

TEST_CASE("the set chosen is nearly as good as the best of all sets, and better than taking the best one by one", "[space_point_to_candidate]") {
  // Three tracks through four stations and seven mixtures of them, better or worse by chance; no two of a set may share a cluster.
  random_stream random(3, 0, 0);
  double sum_best = 0.0, sum_joint = 0.0, sum_greedy = 0.0;
  for (int problem = 0; problem < 200; ++problem) {
    std::vector<candidate> found;
    for (int i = 0; i < 10; ++i) {
      const auto track = [&random, i] { return i < 3 ? i : static_cast<int>(random.uniform(0.0, 3.0)); };
      found.push_back(candidate_of({track(), 3 + track(), 6 + track(), 9 + track()}, i < 3 ? random.uniform(2.0, 16.0) : random.uniform(0.0, 30.0)));
    }
    const auto score = [&found](unsigned set) {
      std::vector<int> used(12, 0);
      double sum = 0.0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (!((set >> i) & 1U)) continue;
        for (const int p : found[i].space_points)
          if (++used[static_cast<std::size_t>(p)] > 1) return -1.0;
        sum += 120.0 - found[i].chi2;
      }
      return sum;
    };
    double best = 0.0;
    for (unsigned set = 0; set < 1024; ++set) best = std::max(best, score(set));
    sum_best += best;
    for (const double chi2 : chosen(found, {10.0, 0})) sum_joint += 120.0 - chi2;
    std::vector<candidate> greedy;
    std::vector<char> used(36, 0);
    disjoint_buffers work;
    select_disjoint(found, all_points, 10.0, 0, used, greedy, work);
    for (const candidate& c : greedy) sum_greedy += 120.0 - c.chi2;
  }
  CAPTURE(sum_best, sum_joint, sum_greedy);
  CHECK(sum_joint <= sum_best);
  CHECK(sum_joint > 0.97 * sum_best);
  CHECK(sum_best - sum_joint < 0.5 * (sum_best - sum_greedy));
}

TEST_CASE("of the same track found twice the better is chosen", "[space_point_to_candidate]") {
  CHECK(chosen({candidate_of({0, 1, 2}, 6.0), candidate_of({0, 1, 2}, 4.0), candidate_of({0, 1, 3}, 5.0)}, {10.0, 3}) == std::vector<double>{4.0});
}

TEST_CASE("clusters taken before count as shared", "[space_point_to_candidate]") {
  std::vector<char> used(36, 0);
  used[0] = used[3] = used[8] = 1;
  CHECK(chosen({candidate_of({0, 1, 2}, 6.0)}, {10.0, 3}, used) == std::vector<double>{6.0});
  used[7] = 1;
  CHECK(chosen({candidate_of({0, 1, 2}, 6.0)}, {10.0, 3}, used).empty());
}

TEST_CASE("no more than the best ones are weighed, and nothing comes of nothing", "[space_point_to_candidate]") {
  const std::vector<candidate> found{candidate_of({0, 1, 2}, 6.0), candidate_of({3, 4, 5}, 5.0), candidate_of({6, 7, 8}, 4.0)};
  CHECK(chosen(found, {10.0, 6, 2}) == std::vector<double>{4.0, 5.0});
  CHECK(chosen({}).empty());
}
