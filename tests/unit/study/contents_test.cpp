// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "support/catch.hpp"

#include <scifi/study/contents.hpp>
#include <scifi/study/distribution.hpp>

using namespace scifi::study;

namespace {

struct some_study {
  long tracks = 0;
  std::vector<distribution> of{distribution(2, 0.0, 2.0, "a"), distribution(1, 0.0, 1.0, "b")};

  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(tracks, other.tracks...);
    for (std::size_t i = 0; i < of.size(); ++i) visit(of[i], other.of[i]...);
  }
};

}  // namespace

TEST_CASE("a study as numbers: counts, every bin, values behind their number, and back", "[study]") {
  some_study a;
  a.tracks = 7;
  for (const double x : {-1.0, 1.5, 1.25, 9.0}) a.of[0].add(x);
  a.of[1].add(0.5);
  const std::vector<double> expected{7, 1, 0, 2, 1, 4, -1.0, 1.5, 1.25, 9.0, 0, 1, 0, 1, 0.5};
  CHECK(contents(a) == expected);

  some_study b;
  b.tracks = 1;
  b.of[0].add(0.5);
  some_study merged = b;
  merged.each(merge, a);
  REQUIRE(add_contents(b, expected));
  CHECK(contents(b) == contents(merged));
  CHECK(contents(b) == std::vector<double>{8, 1, 1, 2, 1, 5, 0.5, -1.0, 1.5, 1.25, 9.0, 0, 1, 0, 1, 0.5});
}

TEST_CASE("numbers that are not of such a study are refused", "[study]") {
  some_study a;
  a.of[0].add(0.5);
  const std::vector<double> good = contents(a);
  const auto refused = [](std::span<const double> numbers) { return !add_contents(*std::make_unique<some_study>(), numbers); };
  CHECK_FALSE(refused(good));
  for (std::size_t n = 0; n < good.size(); ++n) CHECK(refused(std::span(good).first(n)));
  std::vector<double> bad = good;
  bad.push_back(0.0);
  CHECK(refused(bad));
  constexpr std::size_t number_of_values = 5;
  REQUIRE(good[number_of_values] == 1.0);
  for (const double wrong : {-1.0, 0.5, 2.0, 1e300, std::nan("")}) {
    bad = good;
    bad[number_of_values] = wrong;
    CHECK(refused(bad));
  }
}
