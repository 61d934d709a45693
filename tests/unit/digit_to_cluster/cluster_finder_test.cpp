// SPDX-License-Identifier: MPL-2.0
#include <scifi/digit_to_cluster/cluster_finder.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace host {

/// A digit of someone else, with other names and other numbers in it.
struct signal {
  int tspc;
  float photons;
};
channel_id channel_of(const signal& s) { return channel_from_tspc(s.tspc); }
double light_of(const signal& s) { return static_cast<double>(s.photons); }

}  // namespace host

namespace {

const detector where = mice::trackers();

digit at(int channel, double npe, int plane = 0, int station = 1, int tracker = 0) { return {{tracker, station, plane, channel}, npe}; }

/// Clusters of neighbouring channels from 50 on with this light.
std::vector<cluster> of_run(const std::vector<double>& light) {
  std::vector<digit> digits;
  for (std::size_t i = 0; i < light.size(); ++i) digits.push_back(at(50 + static_cast<int>(i), light[i]));
  std::vector<cluster> out;
  cluster_finder{}(where, digits, out);
  return out;
}

/// Channels of the clusters, as means.
std::vector<double> channels(const std::vector<cluster>& clusters) {
  std::vector<double> out;
  for (const cluster& c : clusters) out.push_back(c.channel);
  return out;
}

}  // namespace

TEST_CASE("one channel is a cluster at its middle", "[digit_to_cluster]") {
  std::vector<digit> digits{at(100, 8.0, 2)};
  std::vector<cluster> out;
  cluster_finder{}(where, digits, out);
  REQUIRE(out.size() == 1);
  const cluster& c = out[0];
  CHECK(c.tracker == 0);
  CHECK(c.station == 1);
  CHECK(c.plane == 2);
  CHECK(c.channel == 100.0);
  CHECK(c.npe == 8.0);
  CHECK(c.alpha == Approx(5.5 * 1.4945).epsilon(1e-12));  // central channel 105.5
  CHECK(c.variance == fibre_resolution{}.variance(*where.find_plane({0, 1, 2, 0}), {1, 8.0, 8.0}));
  CHECK(c.first_digit == 0);
  CHECK(c.size == 1);
}

TEST_CASE("two neighbours are one cluster at their unweighted mean", "[digit_to_cluster]") {
  const std::vector<cluster> out = of_run({3.0, 17.0});
  REQUIRE(out.size() == 1);
  CHECK(out[0].channel == 50.5);
  CHECK(out[0].npe == 20.0);
  CHECK(out[0].size == 2);
  CHECK(out[0].variance == fibre_resolution{}.variance(*where.find_plane({0, 1, 0, 0}), {2, 3.0, 20.0}));
}

TEST_CASE("a longer run is cut from its brightest channel outwards into pairs and singles", "[digit_to_cluster]") {
  CHECK(channels(of_run({5.0, 9.0, 7.0})) == std::vector<double>{50.0, 51.5});
  CHECK(channels(of_run({7.0, 9.0, 5.0})) == std::vector<double>{50.5, 52.0});
  CHECK(channels(of_run({9.0, 5.0, 7.0})) == std::vector<double>{50.5, 52.0});
  CHECK(channels(of_run({5.0, 7.0, 9.0})) == std::vector<double>{50.0, 51.5});
  CHECK(channels(of_run({4.0, 9.0, 8.0, 5.0})) == std::vector<double>{50.0, 51.5, 53.0});
  CHECK(channels(of_run({9.0, 8.0, 6.0, 10.0})) == std::vector<double>{50.5, 52.5});
  CHECK(channels(of_run({9.0, 8.0, 3.0, 8.0, 10.0})) == std::vector<double>{50.5, 52.0, 53.5});
  CHECK(channels(of_run({3.0, 4.0, 9.0, 5.0, 3.0})) == std::vector<double>{50.5, 52.5, 54.0});
}

namespace {

/// First channels of the clusters of light[begin, end), as the rule says it.
void by_the_rule(const std::vector<double>& light, int begin, int end, std::vector<int>& out) {
  if (begin == end) return;
  if (end - begin <= 2) return out.push_back(begin);
  const auto at = [&light](int i) { return light[static_cast<std::size_t>(i)]; };
  int seed = begin;
  for (int i = begin; i < end; ++i)
    if (at(i) > at(seed)) seed = i;
  const bool left = seed > begin && (seed + 1 == end || at(seed - 1) > at(seed + 1));
  by_the_rule(light, begin, left ? seed - 1 : seed, out);
  out.push_back(left ? seed - 1 : seed);
  by_the_rule(light, left ? seed + 1 : seed + 2, end, out);
}

}  // namespace

TEST_CASE("runs of any length and shape are cut by the rule, in order", "[digit_to_cluster]") {
  const auto check = [](const std::vector<double>& light) {
    std::vector<int> expected, got;
    by_the_rule(light, 0, static_cast<int>(light.size()), expected);
    for (const cluster& c : of_run(light)) got.push_back(c.first_digit);
    CHECK(got == expected);
  };
  for (std::size_t n = 1; n <= 120; ++n) {
    std::vector<double> rising, falling, uneven;
    for (std::size_t i = 0; i < n; ++i) {
      rising.push_back(3.0 + static_cast<double>(i));
      falling.push_back(300.0 - static_cast<double>(i));
      uneven.push_back(3.0 + static_cast<double>(i * i * 37 % 101));
    }
    check(rising);
    check(falling);
    check(uneven);
  }
}

TEST_CASE("every digit of a run is in exactly one cluster, with its light", "[digit_to_cluster]") {
  for (std::size_t n = 1; n <= 9; ++n) {
    std::vector<double> light;
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) light.push_back(2.0 + static_cast<double>(i * 7 % 5));
    for (const double x : light) sum += x;
    const std::vector<cluster> out = of_run(light);
    int next = 0;
    double found = 0.0;
    for (const cluster& c : out) {
      CHECK(c.first_digit == next);
      CHECK((c.size == 1 || c.size == 2));
      next += c.size;
      found += c.npe;
    }
    CHECK(next == static_cast<int>(n));
    CHECK(found == Approx(sum));
  }
}

TEST_CASE("digits are sorted, and clusters refer to the sorted order", "[digit_to_cluster]") {
  std::vector<digit> digits{at(10, 5.0, 1, 2, 1), at(31, 6.0, 0, 1, 0), at(4, 5.0, 2, 5, 0), at(30, 5.0, 0, 1, 0), at(10, 5.0, 0, 2, 1), at(12, 5.0, 1, 2, 1)};
  std::vector<cluster> out;
  cluster_finder{}(where, digits, out);
  CHECK(std::is_sorted(digits.begin(), digits.end(), [](const digit& a, const digit& b) { return a.id < b.id; }));
  REQUIRE(out.size() == 5);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const channel_id& first = digits[static_cast<std::size_t>(out[i].first_digit)].id;
    CHECK(first.tracker == out[i].tracker);
    CHECK(first.station == out[i].station);
    CHECK(first.plane == out[i].plane);
    if (i == 0) continue;
    const channel_id& before = digits[static_cast<std::size_t>(out[i - 1].first_digit)].id;
    CHECK(before < first);
  }
  CHECK(out[0].channel == 30.5);
}

TEST_CASE("digits below the threshold are left out and divide a run", "[digit_to_cluster]") {
  CHECK(channels(of_run({5.0, 1.9, 5.0})) == std::vector<double>{50.0, 52.0});
  CHECK(channels(of_run({1.9, 2.0})) == std::vector<double>{51.0});
  cluster_finder<> high;
  high.min_npe = 6.0;
  std::vector<digit> digits{at(50, 5.9), at(51, 6.0)};
  std::vector<cluster> out;
  high(where, digits, out);
  REQUIRE(out.size() == 1);
  CHECK(out[0].channel == 51.0);
  CHECK(out[0].first_digit == 1);
  CHECK(out[0].size == 1);
}

TEST_CASE("digits of planes that do not exist are skipped", "[digit_to_cluster]") {
  std::vector<digit> digits{at(50, 5.0, 3), at(50, 5.0, 0, 6), at(50, 5.0, 0, 1, 7), at(50, 5.0, -1), at(60, 5.0)};
  std::vector<cluster> out;
  cluster_finder{}(where, digits, out);
  REQUIRE(out.size() == 1);
  CHECK(out[0].channel == 60.0);
}

TEST_CASE("clusters are appended, and nothing comes of nothing", "[digit_to_cluster]") {
  std::vector<digit> none;
  std::vector<cluster> out(1);
  cluster_finder{}(where, none, out);
  CHECK(out.size() == 1);
  std::vector<digit> one{at(50, 5.0)};
  cluster_finder{}(where, one, out);
  CHECK(out.size() == 2);
}

TEST_CASE("planes may have any number of channels, and the last of one is no neighbour of the first of the next", "[digit_to_cluster]") {
  plane strips;
  strips.channels = 2560;
  strips.channel_width = 0.08;
  tracker telescope;
  telescope.stations = {station{1, {}, {strips, strips}}};
  const detector silicon{{telescope}};
  std::vector<digit> digits{at(1000, 5.0, 0), at(999, 5.0, 0), at(1001, 5.0, 1), at(0, 5.0, 1), at(2559, 5.0, 0), at(2000, 5.0, 0)};
  std::vector<cluster> out;
  cluster_finder<uniform_resolution>{}(silicon, digits, out);
  CHECK(channels(out) == std::vector<double>{999.5, 2000.0, 2559.0, 0.0, 1001.0});
}

TEST_CASE("the resolution can be replaced", "[digit_to_cluster]") {
  struct fixed {
    double variance(const plane&, const cluster_light& light) const { return light.size + light.least + 100.0 * light.total; }
  };
  std::vector<digit> digits{at(50, 5.0), at(51, 3.0)};
  std::vector<cluster> out;
  cluster_finder{2.0, fixed{}}(where, digits, out);
  REQUIRE(out.size() == 1);
  CHECK(out[0].variance == 2.0 + 3.0 + 800.0);
}

TEST_CASE("digits of another framework are taken where they are", "[digit_to_cluster]") {
  std::vector<host::signal> signals{{112031, 4.0F}, {12100, 8.0F}, {12099, 5.5F}, {112032, 1.5F}};
  std::vector<digit> digits;
  for (const host::signal& s : signals) digits.push_back({channel_of(s), light_of(s)});
  std::vector<cluster> theirs, ours;
  std::span<host::signal> view(signals);
  cluster_finder{}(where, view, theirs);
  cluster_finder{}(where, digits, ours);
  REQUIRE(theirs.size() == 2);
  REQUIRE(ours.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(theirs[i].tracker == ours[i].tracker);
    CHECK(theirs[i].alpha == ours[i].alpha);
    CHECK(theirs[i].npe == ours[i].npe);
    CHECK(theirs[i].first_digit == ours[i].first_digit);
  }
  CHECK(signals.front().tspc == 12099);  // sorted in place
}

TEST_CASE("a digit whose light is no number is left out", "[digit_to_cluster]") {
  std::vector<digit> digits{at(10, std::numeric_limits<double>::quiet_NaN()), at(11, 7.0), at(12, std::numeric_limits<double>::quiet_NaN())};
  std::vector<cluster> out;
  cluster_finder{}(where, digits, out);
  REQUIRE(out.size() == 1);
  CHECK(out[0].channel == 11.0);
}

TEST_CASE("digits that cannot be are left out, and it is said", "[digit_to_cluster]") {
  using limits = std::numeric_limits<double>;
  const digit good = at(50, 9.0, 1);
  const std::vector<digit> absurd{at(20, limits::quiet_NaN()), at(20, limits::infinity()), at(20, limits::max()), at(214, 9.0), at(-1, 9.0),
                                  at(20, 9.0, 3), at(20, 9.0, -1), at(20, 9.0, 0, 6), at(20, 9.0, 0, 1, 2),
                                  at(std::numeric_limits<int>::max(), 9.0), at(std::numeric_limits<int>::min(), 9.0)};
  for (const digit& d : absurd) {
    std::vector<digit> digits{d, good};
    std::vector<cluster> out;
    CHECK_FALSE(cluster_finder{}(where, digits, out));
    CHECK(channels(out) == std::vector<double>{50.0});
  }
  // Little light is no fault, wherever it is said to be.
  std::vector<digit> dim{at(20, -limits::infinity()), at(20, -1.0), at(20, 0.0), good};
  std::vector<cluster> out;
  CHECK(cluster_finder{}(where, dim, out));
  CHECK(channels(out) == std::vector<double>{50.0});
}

TEST_CASE("a channel has one digit: another one is left out, and a run ends at the last channel", "[digit_to_cluster]") {
  std::vector<digit> twice{at(50, 9.0), at(50, 9.0), at(60, 5.0)};
  std::vector<cluster> out;
  CHECK_FALSE(cluster_finder{}(where, twice, out));
  CHECK(channels(out) == std::vector<double>{50.0, 60.0});
  // View V has channels 0 to 213.
  std::vector<digit> beyond{at(213, 5.0), at(214, 5.0), at(215, 5.0)};
  out.clear();
  CHECK_FALSE(cluster_finder{}(where, beyond, out));
  CHECK(channels(out) == std::vector<double>{213.0});
}
