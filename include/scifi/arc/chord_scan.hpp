// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include <scifi/arc/chord_turn.hpp>
#include <scifi/core/constants.hpp>
#include <scifi/core/pack.hpp>
#include <scifi/core/planar.hpp>
#include <scifi/core/scalar.hpp>

namespace scifi {

/// The third points that a helix through two points allows, many looked at together, one in each SIMD lane.
///
/// The angle between the chords gives the curvature, the curvature the ratio of their lengths; what is left of the length is compared with its error.
/// For curvatures that turn the chords against each other by less than half a turn: no angle means two of them.
class chord_scan {
 public:
  /// A third point, the curvature (rad/mm) to it, and the squared deviation of the length in units of its variance.
  struct hit {
    int point;
    double curvature;
    double chi2;
  };

  /// What scattering at the middle point adds to the variance of the length: k2 (a + b k2) with k2 = max(w^2 / field^2, least), 1/momentum^2.
  struct scatter {
    double per_field2, least, a, b;
  };

  /// For the chords of this turn, with |w| up to `most`.
  void prepare(const chord_turn& turn, double most, const scatter& matter) {
    matter_ = matter;
    half_ = turn.half();
    largest_ = std::min({most, turn.largest(), 0.95 * constants::pi / half_});
    // The ratio of the lengths is even in w and smooth: a polynomial through Chebyshev's nodes of w^2.
    constexpr int n = terms;
    std::array<double, n> u{}, divided{};
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      u[k] = 0.5 * square(largest_) * (1.0 + std::cos(constants::pi * (i + 0.5) / n));
      divided[k] = std::sqrt(norm(turn(std::sqrt(u[k])).factor));
    }
    for (std::size_t order = 1; order < n; ++order)
      for (std::size_t i = n - 1; i >= order; --i) divided[i] = largest_ > 0.0 ? (divided[i] - divided[i - 1]) / (u[i] - u[i - order]) : 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      divided_[i] = static_cast<float>(divided[i]);
      node_[i] = static_cast<float>(u[i]);
    }
    const double start = turn(0.0).factor.x, end = std::sqrt(norm(turn(largest_).factor));
    least_ratio_ = 0.999 * std::min(start, end);
    most_ratio_ = 1.001 * std::max(start, end);
  }

  /// The second chords from a middle point, to be filled by `add`.
  void clear() { chords_.clear(); }
  /// `cost`: chi2 that the third point itself brings.
  void add(const planar<double>& chord, double cost, int point) { chords_.push_back({chord, std::sqrt(norm(chord)), cost, point}); }
  /// Once all are added.
  void order() {
    std::sort(chords_.begin(), chords_.end(), [](const second& a, const second& b) { return a.length != b.length ? a.length < b.length : a.point < b.point; });
    const std::size_t room = chords_.size() + lanes::lanes;
    points_.assign(room, 0);
    for (auto* row : {&x_, &y_, &length_, &cost_}) row->assign(room, 0.0F);
    for (std::size_t i = 0; i < chords_.size(); ++i) {
      x_[i] = static_cast<float>(chords_[i].chord.x);
      y_[i] = static_cast<float>(chords_[i].chord.y);
      length_[i] = static_cast<float>(chords_[i].length);
      cost_[i] = static_cast<float>(chords_[i].cost);
      points_[i] = chords_[i].point;
    }
    for (std::size_t i = chords_.size(); i < room; ++i) cost_[i] = std::numeric_limits<float>::infinity();
    hits_.resize(std::max(hits_.size(), room + lanes::lanes));
  }

  /// The third points after this first chord for which cost + deviation^2 / variance <= `limit`. `variance`: of the difference of the lengths, from the errors of the
  /// points. The list holds until the next call.
  [[nodiscard]] std::span<const hit> operator()(const planar<double>& first, double variance, double limit) {
    const double length = std::sqrt(norm(first));
    std::size_t found = 0;
    const double widest = std::max(square(largest_) * matter_.per_field2, matter_.least);
    const double slack = std::sqrt(std::max(limit, 0.0) * (variance + widest * (matter_.a + matter_.b * widest)));
    const auto last = length_.begin() + static_cast<std::ptrdiff_t>(chords_.size());
    const auto begin = std::lower_bound(length_.begin(), last, static_cast<float>(least_ratio_ * length - slack));
    const auto end = std::upper_bound(begin, last, static_cast<float>(most_ratio_ * length + slack));
    const lanes fx(first.x), fy(first.y), fl(length), most(largest_), per_angle(1.0 / half_), of_points(variance), allowed(limit);
    const lanes per_field2(matter_.per_field2), least(matter_.least), ma(matter_.a), mb(matter_.b);
    rounds_ = 0;
    for (auto i = static_cast<std::size_t>(begin - length_.begin()); i < static_cast<std::size_t>(end - length_.begin()); i += lanes::lanes) {
      ++rounds_;
      const lanes x = load(x_, i), y = load(y_, i), l = load(length_, i);
      const lanes w = lanes(0.0F) - angle(fx * x + fy * y, fx * y - fy * x) * per_angle;
      const lanes u = w * w;
      lanes ratio(divided_.back());
      for (std::size_t k = terms - 1; k-- > 0;) ratio = ratio * (u - lanes(node_[k])) + lanes(divided_[k]);
      const lanes off = l - ratio * fl;
      const lanes k2 = select(u * per_field2 < least, least, u * per_field2);
      const lanes chi2 = off * off / (of_points + k2 * (ma + mb * k2));
      const auto good = u <= most * most && chi2 + load(cost_, i) <= allowed;
      if (!any_of(good)) continue;
      // Every lane is written, and the next one over it where it is no hit: no branch to be guessed wrong.
      for (int lane = 0; lane < lanes::lanes; ++lane) {
        hits_[found] = {points_[i + static_cast<std::size_t>(lane)], w[lane], chi2[lane]};
        found += good[lane];
      }
    }
    return std::span<const hit>(hits_).first(found);
  }
  /// How often the lanes were filled in the last scan.
  [[nodiscard]] long rounds() const { return rounds_; }

 private:
  using lanes = pack<float>;
  static constexpr std::size_t terms = 5;
  struct second {
    planar<double> chord;
    double length;
    double cost;
    int point;
  };

  [[nodiscard]] static lanes load(const std::vector<float>& row, std::size_t i) {
    lanes out;
    std::memcpy(&out.v, row.data() + i, sizeof out.v);
    return out;
  }
  /// Of (x, y) against the x axis, within 1.2e-5 (Abramowitz and Stegun 4.4.49).
  [[nodiscard]] static lanes angle(const lanes& x, const lanes& y) {
    const lanes zero(0.0F);
    const lanes ax = select(x < zero, -x, x), ay = select(y < zero, -y, y);
    const lanes smaller = select(ax < ay, ax, ay), larger = select(ax < ay, ay, ax);
    const lanes r = smaller / select(larger > zero, larger, lanes(1.0F));
    const lanes s = r * r;
    lanes a = r * (lanes(0.9998660F) + s * (lanes(-0.3302995F) + s * (lanes(0.1801410F) + s * (lanes(-0.0851330F) + s * lanes(0.0208351F)))));
    a = select(ax < ay, lanes(0.5 * constants::pi) - a, a);
    a = select(x < zero, lanes(constants::pi) - a, a);
    return select(y < zero, -a, a);
  }

  scatter matter_{};
  double half_ = 1.0, largest_ = 0.0;
  double least_ratio_ = 1.0, most_ratio_ = 1.0;
  std::array<float, terms> divided_{}, node_{};  // Newton's form
  std::vector<second> chords_;
  std::vector<float> x_, y_, length_, cost_;
  std::vector<int> points_;
  std::vector<hit> hits_;
  long rounds_ = 0;
};

}  // namespace scifi
