// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/event/hit.hpp>
#include <scifi/event/raw_digit.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/hit_to_digit/adc.hpp>
#include <scifi/hit_to_digit/dead_channels.hpp>
#include <scifi/hit_to_digit/light_yield.hpp>
#include <scifi/hit_to_digit/noise.hpp>

namespace scifi {

/// From the hits of one tracker to its digits: light, noise, dead channels, ADC, threshold. Each step can be replaced.
/// Light(edep) by `photo_electrons`, Noise by `for_each`, Adc by `read`, Calibration is called with a channel_id, Dead is asked by `contains`.
template <class Light = light_yield, class Noise = thermal_noise, class Adc = adc_response, class Calibration = drawn_calibration, class Dead = dead_channels>
struct digitiser {
  Light light{};
  Noise noise{};
  Adc adc{};
  Calibration calibration{};
  Dead dead{};
  double threshold = 2.0;  ///< digits below it are not kept, photo-electrons

  /// Replaces `out` by the digits of tracker `t`, in order of their channels; hits of other trackers are ignored.
  /// The memory of `out` is reused. Light of a channel's hits is added up before the noise; a hit in a channel that does not exist is ignored.
  void operator()(const tracker& t, std::span<const hit> hits, random_stream& random, std::vector<raw_digit>& out) const {
    out.clear();
    for (const hit& h : hits)
      if (exists(t, h.id)) out.push_back({h.id, 0, light.photo_electrons(h.edep)});
    for (const station& s : t.stations)
      for (std::size_t i = 0; i < s.planes.size(); ++i)
        noise.for_each(s.planes[i].channels, random, [&](int channel, int photo_electrons) {
          out.push_back({{t.id, s.id, static_cast<int>(i), channel}, 0, static_cast<double>(photo_electrons)});
        });
    // Stable: the sums, and with them the digits, do not depend on how the sort is written.
    std::stable_sort(out.begin(), out.end(), [](const raw_digit& a, const raw_digit& b) { return a.id < b.id; });

    std::size_t kept = 0;
    for (std::size_t i = 0; i < out.size();) {
      const channel_id id = out[i].id;
      double photo_electrons = 0.0;
      for (; i < out.size() && out[i].id == id; ++i) photo_electrons += out[i].npe;
      if (dead.contains(id)) continue;
      const adc_reading reading = adc.read(photo_electrons, calibration(id), random);
      if (reading.npe >= threshold) out[kept++] = {id, reading.counts, reading.npe};
    }
    out.resize(kept);
  }

 private:
  [[nodiscard]] static bool exists(const tracker& t, const channel_id& id) {
    if (id.tracker != t.id) return false;
    for (const station& s : t.stations)
      if (s.id == id.station) return id.plane >= 0 && static_cast<std::size_t>(id.plane) < s.planes.size() && s.planes[static_cast<std::size_t>(id.plane)].has_channel(id.channel);
    return false;
  }
};

}  // namespace scifi
