// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <span>

#include <scifi/core/planar.hpp>
#include <scifi/core/trigonometry.hpp>

namespace scifi {

/// A space point as the arc fit sees it: transverse position with one variance for both directions.
struct arc_point {
  planar<double> position;  ///< tracker frame, mm
  double variance = 1.0;    ///< per projection, mm^2
  double z = 0.0;           ///< mm
};

/// What the arc fit knows before it sees a point.
struct arc_prior {
  double slope_variance = 0.09;       ///< per projection, about `slope`
  double curvature = 0.0;             ///< rad/mm
  double curvature_variance = 0.0;    ///< (rad/mm)^2; zero: the curvature is known and not fitted
  planar<double> slope{};             ///< at the first point
};

/// A helix of given curvature w = field q/pz in space, as a filter in two complex numbers: the transverse position and slope.
///
/// With w fixed the helix is linear: slope' = e^{-i w dz} slope, position' = position + (1 - e^{-i w dz})/(i w) slope, a straight line for w = 0. Scattering
/// and round errors keep the covariance a 2 x 2 Hermitian matrix, so one step costs a few multiplications. The derivative of the state in w goes along
/// with the gains held fixed, hence each pass over the points is one Gauss-Newton step in w (variable projection; Golub and Pereyra,
/// SIAM J. Numer. Anal. 10 (1973) 413) where the prior slope is near the track's; from a prior slope of zero
/// the turn of the first chord is not seen, so the steps come out short and the error of w large. No circle is fitted, so nothing degenerates when the track is straight.
class arc_fit {
 public:
  /// Starts at the first point with the prior slope.
  arc_fit(const arc_point& first, const arc_prior& prior, double curvature)
      : w_(curvature), position_(first.position), slope_(prior.slope), pp_(first.variance), ss_(prior.slope_variance), z_(first.z) {
    if (prior.curvature_variance > 0.0) {
      fitted_ = 1.0;
      const double offset = prior.curvature - curvature;
      information_ = 1.0 / prior.curvature_variance;
      gradient_ = offset * information_;
      chi2_ = offset * gradient_;
    }
  }

  /// Flies to z; `scattering` is the variance of each projected slope from the material at the point just left.
  void fly(double z, double scattering) {
    const double dz = z - z_;
    const turning<double> t = turning_at(w_ * dz);
    const planar<double> turn{t.cosine, -t.sine};
    const planar<double> lever{dz * t.s1, -dz * t.c1};
    const planar<double> d_lever{dz * dz * t.d_s1, -dz * dz * t.d_c1};
    const planar<double> d_turn{-dz * t.sine, -dz * t.cosine};
    d_position_ += lever * d_slope_ + d_lever * slope_;
    d_slope_ = turn * d_slope_ + d_turn * slope_;
    position_ += lever * slope_;
    slope_ = turn * slope_;
    ss_ += scattering;
    pp_ += 2.0 * dot(lever, ps_) + norm(lever) * ss_;
    ps_ = conjugate(turn) * (ps_ + ss_ * lever);
    z_ = z;
  }

  /// Takes a point at the present z in.
  void take(const arc_point& point) {
    const planar<double> residual = point.position - position_;
    const double inverse = 1.0 / (pp_ + point.variance);
    chi2_ += norm(residual) * inverse;
    gradient_ += fitted_ * dot(d_position_, residual) * inverse;
    information_ += fitted_ * norm(d_position_) * inverse;
    const double gain = pp_ * inverse;
    const planar<double> slope_gain = inverse * conjugate(ps_);
    position_ += gain * residual;
    slope_ += slope_gain * residual;
    d_slope_ -= slope_gain * d_position_;
    d_position_ = (1.0 - gain) * d_position_;
    ss_ -= norm(ps_) * inverse;
    ps_ = (1.0 - gain) * ps_;
    pp_ *= 1.0 - gain;
  }

  /// Squared distance of a point at the present z from the prediction, in units of its variance, the uncertainty of the curvature included; two degrees of freedom.
  [[nodiscard]] double distance2(const arc_point& point) const { return norm(point.position - position_) / (point.variance + prediction_variance()); }
  /// Variance per projection of the position at the present z, the uncertainty of the curvature included.
  [[nodiscard]] double prediction_variance() const { return pp_ + (information_ > 0.0 ? norm(d_position_) / information_ : 0.0); }

  [[nodiscard]] double curvature() const { return w_; }
  /// Gauss-Newton step in the curvature after all points; zero when it is not fitted.
  [[nodiscard]] double curvature_step() const { return information_ > 0.0 ? gradient_ / information_ : 0.0; }
  [[nodiscard]] double curvature_variance() const { return information_ > 0.0 ? 1.0 / information_ : 0.0; }
  /// chi2 at the curvature given.
  [[nodiscard]] double chi2() const { return chi2_; }
  /// chi2 at the minimum that the Gauss-Newton step predicts.
  [[nodiscard]] double chi2_after_step() const { return chi2_ - gradient_ * curvature_step(); }
  [[nodiscard]] planar<double> position() const { return position_; }
  [[nodiscard]] planar<double> slope() const { return slope_; }
  [[nodiscard]] planar<double> d_position() const { return d_position_; }
  [[nodiscard]] planar<double> d_slope() const { return d_slope_; }
  [[nodiscard]] double position_variance() const { return pp_; }
  [[nodiscard]] planar<double> position_slope_covariance() const { return ps_; }
  [[nodiscard]] double slope_variance() const { return ss_; }
  [[nodiscard]] double z() const { return z_; }

 private:
  double w_;
  double fitted_ = 0.0;  // 1 where the curvature is
  planar<double> position_;
  planar<double> slope_;
  planar<double> d_position_{};  // d/dw
  planar<double> d_slope_{};
  double pp_;           // E |dp|^2 per projection
  planar<double> ps_{};  // E dp conj(ds)
  double ss_;
  double z_;
  double chi2_ = 0.0;
  double gradient_ = 0.0;     // -1/2 d chi2/dw
  double information_ = 0.0;  // 1/2 d2 chi2/dw2, Gauss-Newton
};

}  // namespace scifi
