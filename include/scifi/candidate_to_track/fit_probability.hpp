// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include <scifi/core/chi_squared.hpp>
#include <scifi/core/gamma_probability.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/material/scattering_tail.hpp>

namespace scifi {

/// What a p-value is worked out from.
struct fit_summary {
  double chi2 = 0.0;
  int ndf = 0;
  double closure = 0.0;      ///< part of chi2 that says how well each triplet of clusters closes (sum of its alphas)
  int closures = 0;          ///< degrees of freedom of that part
  double measurement = 0.0;  ///< degrees of freedom that errors of measurement fill, the rest is scattering: sum of var(residual)/R of the smoothed residuals
  int inner_stations = 0;    ///< stations with measurements on either side: those whose scattering is seen
};

/// The summary of a candidate before its fit: the chi2 of its triplets, and how many there are.
[[nodiscard]] inline fit_summary closures_of(const candidate& c, std::span<const space_point> points) {
  fit_summary out;
  for (const int i : c.space_points) {
    const space_point& p = points[static_cast<std::size_t>(i)];
    if (p.clusters.size() < 3) continue;
    out.closure += p.chi2;
    ++out.closures;
  }
  return out;
}

/// The p-value of Gaussian errors: chi-squared with ndf degrees of freedom.
struct gaussian_probability {
  [[nodiscard]] double operator()(const fit_summary& f) const { return chi_squared_probability(f.chi2, f.ndf); }
};

/// The p-value of fibres and of scattering as they are.
///
/// The closure of a triplet is left out: channel sums are whole numbers, so with planes at 120 degrees it is (1/2)^2/(1/4) = 1 for every true triplet of
/// single channels, and the space-point finder has already asked for it. What remains is, for each number of inner stations that scattered out of the
/// core, a sum of squares with known mean and variance, taken as a gamma distribution with the same two (Satterthwaite, Biometrics Bull. 2 (1946) 110):
///   mean = D + e sum(v),  variance = 2 (flatness D + e sum(v^2)),  D = measurement - closures,  e = (ndf - measurement)/inner stations,
/// v the variance of each station over Highland's, drawn from `tail`. `flatness` holds that the square of a flat error varies less than that of a Gaussian.
/// NaN where nothing is left to ask.
struct fibre_probability {
  scattering_tail tail{};
  double flatness = 0.7;

  [[nodiscard]] double operator()(const fit_summary& f) const {
    const int ndf = f.ndf - f.closures;
    if (ndf < 1) return chi_squared_probability(f.chi2, f.ndf);
    const double chi2 = std::max(0.0, f.chi2 - f.closure);
    const double own = std::clamp(f.measurement - f.closures, 0.0, static_cast<double>(ndf));
    const int n = f.inner_stations;
    const double each = n > 0 ? (ndf - own) / n : 0.0;
    double sum = 0.0;
    double total = 0.0;
    constexpr double negligible = 2e-4;
    for (int wide = 0; wide <= n; ++wide) {
      for (int hard = 0; hard + wide <= n; ++hard) {
        const int core = n - wide - hard;
        const double share = ways(n, wide) * ways(n - wide, hard) * power(tail.share[0], core) * power(tail.share[1], wide) * power(tail.share[2], hard);
        if (share < negligible) continue;
        const auto over = [&](auto v) { return core * v(tail.variance[0]) + wide * v(tail.variance[1]) + hard * v(tail.variance[2]); };
        const double mean = own + each * over([](double v) { return v; });
        const double variance = 2.0 * (flatness * own + each * over([](double v) { return v * v; }));
        total += share;
        sum += share * gamma_probability(mean * mean / variance, chi2 * mean / variance);
      }
    }
    return sum / total;
  }

 private:
  [[nodiscard]] static double power(double base, int exponent) {
    double out = 1.0;
    for (int i = 0; i < exponent; ++i) out *= base;
    return out;
  }
  /// Ways to choose k of n.
  [[nodiscard]] static double ways(int n, int k) {
    double out = 1.0;
    for (int i = 1; i <= k; ++i) out *= static_cast<double>(n - k + i) / i;
    return out;
  }
};

}  // namespace scifi
