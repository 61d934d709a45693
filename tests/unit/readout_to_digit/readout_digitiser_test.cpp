// SPDX-License-Identifier: MPL-2.0
#include <scifi/readout_to_digit/readout_digitiser.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>

#include "support/catch.hpp"

namespace {

using scifi::bad_channels;
using scifi::cabling_map;
using scifi::cabling_result;
using scifi::channel_id;
using scifi::raw_count;
using scifi::raw_digit;
using scifi::readout_calibration;
using scifi::readout_digitiser;
using scifi::readout_tally;

/// Three channels of a plane on one bank, the order of the cables turned round.
cabling_map three_cables() {
  cabling_map map;
  for (int channel = 0; channel < 3; ++channel) REQUIRE(map.connect({0, 1, 10 - channel}, {0, 1, 0, channel}) == cabling_result::connected);
  return map;
}

/// Every channel of the MICE trackers on a read-out channel of its own, scattered over the boards: 1637 and 8192 have no common divisor.
cabling_map all_of(const scifi::detector& d) {
  cabling_map map;
  int next = 0;
  for (const scifi::tracker& t : d.trackers)
    for (const scifi::station& s : t.stations)
      for (std::size_t p = 0; p < s.planes.size(); ++p)
        for (int channel = 0; channel < s.planes[p].channels; ++channel) {
          const int place = next++ * 1637 % 8192;
          REQUIRE(map.connect({place / 512, place / 128 % 4, place % 128}, {t.id, s.id, static_cast<int>(p), channel}) == cabling_result::connected);
        }
  return map;
}

}  // namespace

TEST_CASE("counts become digits in order of their channels", "[readout_to_digit]") {
  readout_calibration calibration;
  REQUIRE(calibration.set({0, 1, 10}, {8.0, 24.0}));
  REQUIRE(calibration.set({0, 1, 9}, {10.0, 30.0}));
  const readout_digitiser digitise(three_cables(), calibration, bad_channels{});
  const std::vector<raw_count> counts = {{{0, 1, 9}, 255}, {{0, 1, 10}, 104}};
  std::vector<raw_digit> digits(5);
  const readout_tally tally = digitise(counts, digits);
  CHECK(tally.digits == 2);
  CHECK(tally.counts() == 2);
  REQUIRE(digits.size() == 2);
  CHECK(digits[0].id == channel_id{0, 1, 0, 0});
  CHECK(digits[0].npe == 10.0);  // (104 - 24) / 8
  CHECK(digits[0].adc == 104);
  CHECK(digits[1].id == channel_id{0, 1, 0, 1});
  CHECK(digits[1].npe == 22.5);  // (255 - 30) / 10
}

TEST_CASE("what is left out is counted by its first reason", "[readout_to_digit]") {
  readout_calibration calibration;
  REQUIRE(calibration.set({0, 1, 10}, {8.0, 24.0}));
  REQUIRE(calibration.set({0, 1, 9}, {8.0, 24.0}));
  REQUIRE(calibration.set({3, 3, 3}, {8.0, 24.0}));
  bad_channels bad;
  REQUIRE(bad.mark({0, 1, 9}));
  REQUIRE(bad.mark({3, 3, 3}));
  const readout_digitiser digitise(three_cables(), calibration, bad);
  std::vector<raw_digit> digits;
  const std::vector<raw_count> counts = {{{3, 3, 3}, 200}, {{99, 0, 0}, 200}, {{0, 1, 9}, 200}, {{0, 1, 8}, 200}, {{0, 1, 10}, 39}};
  readout_tally tally = digitise(counts, digits);
  CHECK(digits.empty());
  CHECK(tally.not_cabled == 2);
  CHECK(tally.bad == 1);
  CHECK(tally.not_calibrated == 1);
  CHECK(tally.below_threshold == 1);  // 39 counts are 1.875 photo-electrons
  CHECK(tally.digits == 0);
  tally += digitise(std::vector<raw_count>{{{0, 1, 10}, 40}}, digits);  // just two
  CHECK(tally.digits == 1);
  CHECK(tally.counts() == 6);
}

TEST_CASE("a digit that could not have come through has no counts", "[readout_to_digit]") {
  readout_calibration calibration;
  REQUIRE(calibration.set({0, 1, 10}, {8.0, 24.0}));
  REQUIRE(calibration.set({0, 1, 9}, {8.0, 24.0}));
  bad_channels bad;
  REQUIRE(bad.mark({0, 1, 9}));
  const readout_digitiser digitise(three_cables(), calibration, bad);
  REQUIRE(digitise.raw({{0, 1, 0, 0}, 10.0}).has_value());
  CHECK(digitise.raw({{0, 1, 0, 0}, 10.0})->adc == 104);
  CHECK(digitise.raw({{0, 1, 0, 0}, 1000.0})->adc == 255);
  CHECK_FALSE(digitise.raw({{0, 1, 0, 1}, 10.0}).has_value());  // bad
  CHECK_FALSE(digitise.raw({{0, 1, 0, 2}, 10.0}).has_value());  // not calibrated
  CHECK_FALSE(digitise.raw({{0, 1, 0, 3}, 10.0}).has_value());  // not cabled
}

TEST_CASE("simulated digits come back through the read-out with the same counts and light", "[readout_to_digit]") {
  const scifi::detector trackers = scifi::mice::trackers();
  const cabling_map cabling = all_of(trackers);
  REQUIRE(cabling.cables().size() == 6400);
  readout_calibration calibration;
  const scifi::drawn_calibration drawn{3};
  for (const auto& [id, cable] : cabling.cables()) REQUIRE(calibration.set(cable, drawn(id)));
  const readout_digitiser digitise(cabling, calibration, bad_channels{});

  scifi::digitiser<> simulate;
  simulate.calibration = drawn;
  simulate.noise.rate = 0.95;  // three photo-electrons a channel
  std::vector<raw_digit> simulated, back;
  std::size_t digits = 0;
  for (const scifi::tracker& t : trackers.trackers) {
    scifi::random_stream random(7, 0, 0, static_cast<std::uint32_t>(t.id));
    simulate(t, {}, random, simulated);
    std::vector<raw_count> counts;
    for (const raw_digit& d : simulated) {
      const auto raw = digitise.raw(d.seen());
      REQUIRE(raw.has_value());
      CHECK(raw->adc == d.adc);
      counts.insert(counts.begin(), *raw);  // the order of the read-out is another one
    }
    const readout_tally tally = digitise(counts, back);
    CHECK(tally.digits == tally.counts());
    REQUIRE(back.size() == simulated.size());
    for (std::size_t i = 0; i < back.size(); ++i) {
      CHECK(back[i].id == simulated[i].id);
      CHECK(back[i].adc == simulated[i].adc);
      CHECK(back[i].npe == simulated[i].npe);  // the same formula of the same numbers
    }
    digits += back.size();
  }
  CHECK(digits > 3000);
}

TEST_CASE("light that is no whole count comes back to half a count", "[readout_to_digit]") {
  const scifi::detector trackers = scifi::mice::trackers();
  const cabling_map cabling = all_of(trackers);
  readout_calibration calibration;
  const scifi::drawn_calibration drawn{4};
  for (const auto& [id, cable] : cabling.cables()) REQUIRE(calibration.set(cable, drawn(id)));
  const readout_digitiser digitise(cabling, calibration, bad_channels{}, 0.0);
  scifi::random_stream random(8, 0, 0, 0);
  std::vector<raw_digit> back;
  for (const auto& [id, cable] : cabling.cables()) {
    const double npe = 2.0 + 15.0 * random.uniform();
    const auto raw = digitise.raw({id, npe});
    REQUIRE(raw.has_value());
    digitise(std::vector<raw_count>{*raw}, back);
    REQUIRE(back.size() == 1);
    CHECK(back[0].id == id);
    CHECK(std::abs(back[0].npe - npe) <= 0.5 / drawn(id).gain * (1.0 + 1.0e-12));
  }
}
