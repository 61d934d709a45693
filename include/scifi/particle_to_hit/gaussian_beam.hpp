// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <stdexcept>

#include <scifi/core/linalg.hpp>
#include <scifi/core/random.hpp>
#include <scifi/core/refuse.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>

namespace scifi {

/// A beam that is the same in all directions about the z axis, Gaussian in x, px, y, py with a given emittance and Twiss parameters, in a uniform field.
///
/// Covariance of (x, px, y, py), with m c = mass, k = beta kappa - canonical, kappa = q B / (2 pz), gamma = (1 + alpha^2 + k^2) / beta
/// (Penn, Wurtele, Phys. Rev. Lett. 85 (2000) 764): m emittance [[beta/pz, -alpha, 0, -k], [-alpha, gamma pz, k, 0], [0, k, beta/pz, -alpha], [-k, 0, -alpha, gamma pz]].
/// Its determinant is (m emittance)^4. pz is the mean magnitude there; each particle's own is drawn from a Gaussian, apart from the rest.
struct gaussian_beam {
  particle hypothesis = muon_plus;
  double emittance = 6.0;   ///< normalised, transverse, root mean square, mm
  double beta = 400.0;      ///< mm
  double alpha = 0.0;       ///< positive where the beam converges along its flight
  double canonical = 0.0;   ///< canonical angular momentum, mean of L / (2 m emittance); 0 for a beam born outside the field
  double pz = 200.0;        ///< mean of the magnitude, MeV/c
  double pz_spread = 10.0;  ///< standard deviation, MeV/c; draws below a tenth of the mean are repeated

  /// Throws std::invalid_argument, naming the culprit, where no particle can be drawn.
  void check() const {
    if (hypothesis.charge == 0) detail::refuse<std::invalid_argument>("gaussian_beam: the particle must be charged");
    if (!(emittance >= 0.0) || !std::isfinite(emittance)) detail::refuse<std::invalid_argument>("gaussian_beam: the emittance must not be negative");
    if (!(beta > 0.0) || !std::isfinite(beta)) detail::refuse<std::invalid_argument>("gaussian_beam: the beta function must be above zero");
    if (!std::isfinite(alpha) || !std::isfinite(canonical)) detail::refuse<std::invalid_argument>("gaussian_beam: alpha and the canonical angular momentum must be finite");
    if (!(pz > 0.0) || !std::isfinite(pz)) detail::refuse<std::invalid_argument>("gaussian_beam: pz must be above zero");
    if (!(pz_spread >= 0.0) || !(pz_spread < pz)) detail::refuse<std::invalid_argument>("gaussian_beam: the spread of pz must not be negative nor reach pz");
  }

  /// A particle at z (mm) that flies along `direction` (+1 or -1) in z; `field` is Bz, (MeV/c)/(e mm), in the same frame. Throws
  /// std::invalid_argument where none can be drawn, which `check` would have said.
  [[nodiscard]] moving_particle shoot(double z, int direction, double field, random_stream& random) const {
    const double kappa = hypothesis.charge * field / (2.0 * pz);
    const double k = beta * kappa - canonical;
    const double size = std::sqrt(hypothesis.mass * emittance * beta / pz);
    const double spread = std::sqrt(hypothesis.mass * emittance * pz / beta);  // of px and py at one place
    const double x = size * random.normal();
    const double y = size * random.normal();
    moving_particle out;
    out.hypothesis = hypothesis;
    out.position = {x, y, z};
    const double px = pz / beta * (-alpha * x + k * y) + spread * random.normal();
    const double py = pz / beta * (-k * x - alpha * y) + spread * random.normal();
    constexpr double slowest = 0.1;
    double own = pz + pz_spread * random.normal();
    constexpr int most_draws = 1000;  // one in two is above, at least, in a beam that passed the check
    for (int draws = 1; !(own > slowest * pz); ++draws) {
      if (draws == most_draws) detail::refuse<std::invalid_argument>("gaussian_beam: no pz is above a tenth of its mean");
      own = pz + pz_spread * random.normal();
    }
    out.momentum = {px, py, direction * own};
    return out;
  }
};

}  // namespace scifi
