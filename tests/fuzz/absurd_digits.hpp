// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/units.hpp>
#include <scifi/event/event.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

/// Digits from bytes, five for a row of them: plane, first channel, light, how many, and how far apart. Whatever a caller could hand over.
class absurd_digits {
 public:
  explicit absurd_digits(std::string_view bytes) : rest_(bytes) {}

  [[nodiscard]] unsigned byte() {
    if (rest_.empty()) return 0;
    const auto b = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return b;
  }

  void append_to(std::vector<digit>& out, std::size_t most) {
    while (!rest_.empty() && out.size() < most) {
      const unsigned where = byte(), first = byte(), light = byte(), count = byte(), apart = byte();
      for (unsigned k = 0; k <= count && out.size() < most; ++k) {
        const int channel = channel_of(first, k * (apart & 15U));
        const double npe = light_of(light + k * (apart >> 4U));
        if (where == everywhere) {
          for (unsigned p = 0; p < planes; ++p) out.push_back({place(p, channel), npe});
        } else {
          out.push_back({place(where, channel), npe});
        }
      }
    }
  }

 private:
  static constexpr unsigned planes = 30, everywhere = 255;  // 2 trackers, 5 stations, 3 planes

  [[nodiscard]] static int extreme(unsigned i) {
    constexpr std::array values{-1, 0, 1, 2, 5, 6, 1000000, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    return values[i % values.size()];
  }
  [[nodiscard]] static channel_id place(unsigned where, int channel) {
    if (where < planes) return {static_cast<int>(where / 15U), static_cast<int>(where / 3U % 5U) + 1, static_cast<int>(where % 3U), channel};
    return {extreme(where), extreme(where / 9U), extreme(where / 5U), channel};
  }
  [[nodiscard]] static int channel_of(unsigned first, unsigned step) {
    if (first >= 248U) return extreme(first);
    return static_cast<int>(first + step);  // a plane has up to 214
  }
  [[nodiscard]] static double light_of(unsigned i) {
    using limits = std::numeric_limits<double>;
    constexpr std::array values{limits::quiet_NaN(), limits::infinity(), -limits::infinity(), limits::max(), limits::denorm_min(), -1.0, -0.0, 1e9};
    i %= 256U;
    return i < values.size() ? values[i] : 0.25 * i;
  }

  std::string_view rest_;
};

inline void check_reconstruction(const event& e) {
  const auto within = [](int i, const auto& list) { return i >= 0 && static_cast<std::size_t>(i) < list.size(); };
  for (const cluster& c : e.clusters) {
    require(within(c.first_digit, e.digits), "a cluster has its digits");
    require(std::isfinite(c.alpha) && std::isfinite(c.npe) && c.variance > 0.0 && std::isfinite(c.variance), "a cluster has finite numbers");
  }
  for (const space_point& p : e.space_points) {
    require(p.position.allFinite() && p.covariance.allFinite() && std::isfinite(p.z) && std::isfinite(p.npe), "a space point has finite numbers");
    for (const int c : p.clusters) require(within(c, e.clusters), "a space point has its clusters");
  }
  for (const candidate& c : e.candidates) {
    require(c.seed.mean.allFinite() && c.seed.covariance.allFinite() && std::isfinite(c.chi2), "a candidate has finite numbers");
    for (const int p : c.space_points) require(within(p, e.space_points), "a candidate has its space points");
  }
  bool failed = false;
  for (const track& t : e.tracks) {
    failed |= !t.status.ok();
    require(within(t.candidate, e.candidates), "a track has its candidate");
    if (!t.status.ok()) continue;
    require(t.reference.mean.allFinite() && t.reference.covariance.allFinite() && std::isfinite(t.chi2), "a track that was fitted has finite numbers");
    require((t.reference.covariance.diagonal().array() >= 0.0).all(), "variances are not negative");
    require(t.p_value >= 0.0 && t.p_value <= 1.0, "a probability is one");
    require(t.first_point >= 0 && static_cast<std::size_t>(t.first_point + t.points) <= e.track_points.size(), "a track has its points");
    for (int i = t.first_point; i < t.first_point + t.points; ++i) {
      const track_point& p = e.track_points[static_cast<std::size_t>(i)];
      require(p.smoothed.mean.allFinite() && p.smoothed.covariance.allFinite(), "a track point has finite numbers");
      require(p.cluster == -1 || within(p.cluster, e.clusters), "a track point has its cluster");
    }
  }
  require(!failed || e.flags.fit_failed, "a fit that failed is flagged");
}

/// The standard chain over the digits of these bytes, at most so many, in one of five fields.
inline void reconstruct_absurd_digits(std::string_view bytes, std::size_t most) {
  using chain = decltype(make_reconstruction(trackers(), reconstruction_options{}));
  static const std::vector<chain> chains = [] {
    std::vector<chain> out;
    for (const double field : {3.0, 0.0, -3.0, 0.1, 100.0}) {
      reconstruction_options options;
      options.field = field * units::tesla;
      out.push_back(make_reconstruction(trackers(), options));
    }
    return out;
  }();
  static chain::buffers work;
  static event e;
  absurd_digits from(bytes);
  const chain& reconstruct = chains[from.byte() % chains.size()];
  e.clear();
  from.append_to(e.digits, most);
  reconstruct(e, work);
  check_reconstruction(e);
}

}  // namespace scifi::fuzz
