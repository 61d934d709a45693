// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include <scifi/alignment/solution.hpp>
#include <scifi/alignment/track_equations.hpp>
#include <scifi/core/random.hpp>

namespace scifi::test {

/// A linear problem with known parameters: tracks with parameters of their own, measurements that depend on a few global parameters each.
struct random_problem {
  int globals = 6;
  std::vector<alignment::track_equations> tracks;
  Eigen::VectorXd truth;

  explicit random_problem(std::uint64_t seed, int track_count = 30, int global_parameters = 6) : globals(global_parameters), truth(global_parameters) {
    random_stream random(seed, 0, 0);
    for (int i = 0; i < globals; ++i) truth[i] = random.normal();
    for (int t = 0; t < track_count; ++t) {
      const int locals = 1 + t % 4;
      Eigen::VectorXd own(locals);
      for (int k = 0; k < locals; ++k) own[k] = 10.0 * random.normal();
      alignment::track_equations equations;
      equations.clear(locals);
      for (int m = 0; m < locals + 1 + t % 7; ++m) {
        std::vector<double> local;
        double residual = 0.0;
        for (int k = 0; k < locals; ++k) {
          local.push_back(random.normal());
          residual += local.back() * own[k];
        }
        std::vector<alignment::coefficient> global;
        for (int i = 0; i < globals; ++i) {
          if (random.uniform() > 0.5) continue;
          global.push_back({i, random.normal()});
          residual += global.back().value * truth[i];
        }
        const double sigma = random.uniform(0.1, 2.0);
        equations.add(residual + sigma * random.normal(), sigma, local, global);
      }
      tracks.push_back(equations);
    }
  }
};

/// The same least squares with every parameter of every track kept, dense, constraints by Lagrange multipliers. Global parameters first.
struct dense_least_squares {
  Eigen::VectorXd values;       // global
  Eigen::MatrixXd covariance;   // global
  Eigen::VectorXd multipliers;
  double chi2 = 0.0;

  dense_least_squares(int globals, std::span<const alignment::track_equations> tracks, std::span<const alignment::constraint> constraints = {}) {
    Eigen::Index unknowns = globals, rows = 0;
    for (const auto& t : tracks) {
      unknowns += t.local_parameters();
      rows += static_cast<Eigen::Index>(t.size());
    }
    Eigen::MatrixXd design = Eigen::MatrixXd::Zero(rows, unknowns);
    Eigen::VectorXd measured(rows);
    Eigen::Index row = 0, first = globals;
    for (const auto& t : tracks) {
      for (std::size_t i = 0; i < t.size(); ++i, ++row) {
        const auto r = t[i];
        for (std::size_t k = 0; k < r.local.size(); ++k) design(row, first + static_cast<Eigen::Index>(k)) = r.local[k] / r.sigma;
        for (const auto& c : r.global) design(row, c.parameter) += c.value / r.sigma;
        measured[row] = r.residual / r.sigma;
      }
      first += t.local_parameters();
    }
    const auto c = static_cast<Eigen::Index>(constraints.size());
    Eigen::MatrixXd bordered = Eigen::MatrixXd::Zero(unknowns + c, unknowns + c);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns + c);
    bordered.topLeftCorner(unknowns, unknowns) = design.transpose() * design;
    right.head(unknowns) = design.transpose() * measured;
    for (Eigen::Index i = 0; i < c; ++i) {
      const auto& from = constraints[static_cast<std::size_t>(i)];
      for (const auto& k : from.coefficients) bordered(unknowns + i, k.parameter) = bordered(k.parameter, unknowns + i) = k.value;
      right[unknowns + i] = from.value;
    }
    const Eigen::MatrixXd inverse = bordered.fullPivLu().inverse();
    const Eigen::VectorXd all = inverse * right;
    values = all.head(globals);
    covariance = inverse.topLeftCorner(globals, globals);
    multipliers = all.tail(c);
    chi2 = (measured - design * all.head(unknowns)).squaredNorm();
  }
};

}  // namespace scifi::test
