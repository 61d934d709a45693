// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/LU>

#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/propagation.hpp>

// The fit of a track as one writes it down first: matrices whose sizes are known when the program runs, inverses, a smoother that keeps all it needs in lists.
// Flight and noise are the library's, so that the numbers must be those of the library's fit.
namespace textbook {

struct plain_node {
  Eigen::MatrixXd f;  ///< of the step that leads here
  Eigen::VectorXd x_predicted, x;
  Eigen::MatrixXd p_predicted, p;
};

struct plain_result {
  double chi2 = 0.0;
  Eigen::VectorXd x;  ///< at the last stop
  Eigen::MatrixXd p;
};

/// Kalman filter linearised about the flight of `seed`, and with `smoothed` the Rauch-Tung-Striebel smoother back to the first stop.
template <class Propagator, class Noise, class Stops, int N>
plain_result plain_fit(const Propagator& propagator, const Noise& noise, const Stops& stops, const scifi::vector<double, N>& seed, const scifi::kalman::estimate<double, N>& start, bool smoothed) {
  std::vector<plain_node> nodes;
  scifi::vector<double, N> reference = seed;
  Eigen::VectorXd x = start.mean;
  Eigen::MatrixXd p = start.covariance;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(N, N);
  plain_result out;
  for (const auto& stop : stops) {
    plain_node n;
    n.f = identity;
    if (stop.step) {
      const auto& leg = stop.step->get();
      const auto moved = scifi::kalman::detail::propagate_fully(propagator, reference, leg);
      n.f = moved.jacobian;
      const Eigen::MatrixXd q = noise.covariance(reference, leg, moved);
      x = Eigen::VectorXd(moved.state) + n.f * (x - Eigen::VectorXd(reference));
      p = n.f * p * n.f.transpose() + q;
      reference = moved.state;
    }
    n.x_predicted = x;
    n.p_predicted = p;
    if (stop.measurement) {
      const Eigen::MatrixXd h = stop.measurement->projection();
      const Eigen::VectorXd z = Eigen::VectorXd::Constant(1, stop.measurement->value());
      const Eigen::MatrixXd r = Eigen::MatrixXd::Constant(1, 1, stop.measurement->covariance());
      const Eigen::MatrixXd inverse = (h * p * h.transpose() + r).inverse();
      const Eigen::VectorXd residual = z - h * x;
      const Eigen::MatrixXd k = p * h.transpose() * inverse;
      out.chi2 += residual.dot(inverse * residual);
      x = x + k * residual;
      p = (identity - k * h) * p;
    }
    n.x = x;
    n.p = p;
    nodes.push_back(n);
  }
  out.x = x;
  out.p = p;
  if (!smoothed) return out;
  for (std::size_t i = nodes.size() - 1; i-- > 0;) {
    const plain_node& next = nodes[i + 1];
    const Eigen::MatrixXd c = nodes[i].p * next.f.transpose() * next.p_predicted.inverse();
    nodes[i].x = nodes[i].x + c * (next.x - next.x_predicted);
    nodes[i].p = nodes[i].p + c * (next.p - next.p_predicted) * c.transpose();
  }
  out.x = nodes.front().x;
  out.p = nodes.front().p;
  return out;
}

}  // namespace textbook
