// SPDX-License-Identifier: MPL-2.0
#include <scifi/hit_to_digit/digitiser.hpp>

#include <algorithm>
#include <cmath>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

const detector trackers = mice::trackers();
const tracker& tkd = *trackers.find(mice::downstream);

hit deposit(int station, int plane, int channel, double edep) {
  hit h;
  h.id = {mice::downstream, station, plane, channel};
  h.edep = edep;
  return h;
}

/// Nothing random: no noise, no smearing, 10 counts per photo-electron.
digitiser<light_yield, thermal_noise, adc_response, uniform_calibration> plain() {
  digitiser<light_yield, thermal_noise, adc_response, uniform_calibration> d;
  d.noise.rate = 0.0;
  d.adc.resolution = 0.0;
  d.calibration.value = {10.0, 28.0};
  return d;
}

}  // namespace

TEST_CASE("the energy of a channel's hits is added up and becomes light, and digits come in order of their channels", "[hit_to_digit]") {
  random_stream random(1, 0, 0);
  std::vector<raw_digit> out(3);
  const std::vector<hit> hits{deposit(2, 1, 40, 0.05), deposit(1, 0, 57, 0.03), deposit(1, 0, 57, 0.031)};
  plain()(tkd, hits, random, out);
  REQUIRE(out.size() == 2);
  CHECK(out[0].id == channel_id{1, 1, 0, 57});
  CHECK(out[0].npe == Approx(10.0));  // 0.061 MeV * 174.73 = 10.66
  CHECK(out[0].adc == 128);
  CHECK(out[1].id == channel_id{1, 2, 1, 40});
  CHECK(out[1].npe == Approx(8.0));  // 8.74
  CHECK(out[1].seen().id == out[1].id);
  CHECK(out[1].seen().npe == out[1].npe);
}

TEST_CASE("digits below the threshold are dropped, those on it are kept", "[hit_to_digit]") {
  random_stream random(2, 0, 0);
  std::vector<raw_digit> out;
  auto d = plain();
  const std::vector<hit> hits{deposit(1, 0, 10, 1.9 / 174.73), deposit(1, 0, 20, 2.1 / 174.73)};
  d(tkd, hits, random, out);
  REQUIRE(out.size() == 1);
  CHECK(out[0].id.channel == 20);
  CHECK(out[0].npe == 2.0);
}

TEST_CASE("hits of other trackers and of channels that do not exist are ignored", "[hit_to_digit]") {
  random_stream random(3, 0, 0);
  std::vector<raw_digit> out;
  std::vector<hit> hits{deposit(1, 0, 214, 1.0), deposit(1, 2, 212, 1.0), deposit(6, 0, 1, 1.0), deposit(1, 3, 1, 1.0), deposit(1, -1, 1, 1.0), deposit(1, 0, -1, 1.0)};
  hits.push_back(deposit(1, 0, 1, 1.0));
  hits.back().id.tracker = mice::upstream;
  plain()(tkd, hits, random, out);
  CHECK(out.empty());
}

TEST_CASE("noise alone passes the threshold as often as it must", "[hit_to_digit]") {
  auto d = plain();
  d.noise.rate = 0.015;
  d.adc.resolution = 1.0;
  constexpr int events = 2000;
  std::vector<raw_digit> out;
  long seen = 0;
  for (int i = 0; i < events; ++i) {
    random_stream random(4, static_cast<std::uint64_t>(i), 2);
    d(tkd, {}, random, out);
    seen += static_cast<long>(out.size());
  }
  // n photo-electrons (Poisson) pass when floor((n + g) 10 + 28) >= 48, that is n + g >= 2.0.
  const double mean = -std::log(0.985);
  double pass = 0.0, term = std::exp(-mean);
  for (int n = 1; n < 6; ++n) {
    term *= mean / n;
    pass += term * 0.5 * std::erfc((2.0 - n) / std::sqrt(2.0));
  }
  const double expected = pass * 3200.0 * events;
  CHECK(std::abs(static_cast<double>(seen) - expected) < 5.0 * std::sqrt(expected));
}

TEST_CASE("noise adds to the light of a hit", "[hit_to_digit]") {
  auto d = plain();
  d.noise.rate = 0.999999;
  random_stream random(5, 0, 0);
  std::vector<raw_digit> out;
  const std::vector<hit> hits{deposit(1, 0, 57, 5.5 / 174.73)};
  d(tkd, hits, random, out);
  const auto with_hit = std::find_if(out.begin(), out.end(), [](const raw_digit& r) { return r.id == channel_id{1, 1, 0, 57}; });
  REQUIRE(with_hit != out.end());
  CHECK(with_hit->npe > 6.0);  // -ln(1e-6) = 13.8 photo-electrons of noise on average
}

TEST_CASE("the same stream gives the same digits", "[hit_to_digit]") {
  std::vector<raw_digit> first, second;
  const std::vector<hit> hits{deposit(1, 0, 57, 0.06), deposit(3, 2, 100, 0.08)};
  random_stream one(6, 9, 2), two(6, 9, 2);
  digitiser<>{}(tkd, hits, one, first);
  digitiser<>{}(tkd, hits, two, second);
  REQUIRE(first.size() == second.size());
  REQUIRE(first.size() >= 2);
  for (std::size_t i = 0; i < first.size(); ++i) {
    CHECK(first[i].id == second[i].id);
    CHECK(first[i].npe == second[i].npe);
  }
}

TEST_CASE("a dead channel has no digit, neither of light nor of noise, and leaves the others alone", "[hit_to_digit]") {
  const std::vector<hit> hits{deposit(1, 0, 57, 0.06), deposit(1, 0, 58, 0.06)};
  auto d = plain();
  d.dead = dead_channels({{mice::downstream, 1, 0, 57}});
  random_stream random(4, 0, 0);
  std::vector<raw_digit> out;
  d(tkd, hits, random, out);
  REQUIRE(out.size() == 1);
  CHECK(out[0].id.channel == 58);
  CHECK(out[0].npe == Approx(10.0));
  d.noise.rate = 0.999;  // everywhere
  d.threshold = 0.5;
  d(tkd, hits, random, out);
  CHECK(out.size() > 2500);
  CHECK(std::none_of(out.begin(), out.end(), [](const raw_digit& r) { return r.id == channel_id{mice::downstream, 1, 0, 57}; }));
}
