// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <scifi/kalman.hpp>

#include "unit/kalman/lanes.hpp"

namespace kalman = scifi::kalman;
using lanes::pack;

namespace {

struct motion {
  scifi::matrix<double, 2, 2> transition(double dt) const { return (scifi::matrix<double, 2, 2>() << 1.0, dt, 0.0, 1.0).finished(); }
  scifi::matrix<double, 2, 2> covariance(double dt) const { return 0.1 * scifi::vector<double, 2>(dt * dt * dt, dt).asDiagonal().toDenseMatrix(); }
};

template <class Scalar>
struct position {
  Scalar z;
  const Scalar& value() const { return z; }
  double covariance() const { return 0.04; }
  scifi::matrix<double, 1, 2> projection() const { return {1.0, 0.0}; }
};

template <class Scalar>
struct point {
  scifi::vector<Scalar, 2> z;
  const scifi::vector<Scalar, 2>& value() const { return z; }
  scifi::matrix<double, 2, 2> covariance() const { return 0.04 * scifi::matrix<double, 2, 2>::Identity(); }
  scifi::matrix<double, 2, 2> projection() const { return scifi::matrix<double, 2, 2>::Identity(); }
};

double value(int lane, int site) { return 0.3 * lane * site + 0.1 * std::sin(7.0 * lane + site); }

template <class Scalar, class Z, class Filter>
auto fit(const Filter& f, const std::vector<Z>& measured) {
  std::vector<kalman::site<double, Z>> sites;
  for (const Z& z : measured) sites.push_back({1.0, z});
  std::vector<kalman::node<Scalar, 2, 2>> nodes(sites.size());
  const kalman::estimate<Scalar, 2> start{scifi::vector<Scalar, 2>::Constant(Scalar(0.0)), scifi::matrix<Scalar, 2, 2>::Identity()};
  const auto result = f.run(start, sites, nodes);
  const auto smoothed = kalman::smooth(nodes);
  REQUIRE(result.status.ok());
  REQUIRE(smoothed.ok());
  return std::pair(result, nodes);
}

/// Each lane of a run in packs against a run of its own.
template <template <class> class Z, class Filter, class Make>
void check_lanes(const Filter& f, const Make& make) {
  std::vector<Z<pack>> together;
  for (int k = 0; k < 6; ++k) together.push_back(make(pack(value(0, k), value(1, k), value(2, k), value(3, k))));
  const auto [all, all_nodes] = fit<pack>(f, together);
  for (std::size_t lane = 0; lane < 4; ++lane) {
    std::vector<Z<double>> alone;
    for (int k = 0; k < 6; ++k) alone.push_back(make(value(static_cast<int>(lane), k)));
    const auto [one, nodes] = fit<double>(f, alone);
    CHECK(all.chi2.v[lane] == Approx(one.chi2).epsilon(1e-12));
    CHECK(all.ndf.v[lane] == static_cast<double>(one.ndf));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      CHECK(all_nodes[k].smoothed.mean(1).v[lane] == Approx(nodes[k].smoothed.mean(1)).margin(1e-12));
      CHECK(all_nodes[k].smoothed.covariance(0, 1).v[lane] == Approx(nodes[k].smoothed.covariance(0, 1)).margin(1e-12));
      CHECK(all_nodes[k].outlier.b[lane] == nodes[k].outlier);
    }
  }
}

const auto make_position = []<class Scalar>(const Scalar& z) { return position<Scalar>{z}; };
const auto make_point = []<class Scalar>(const Scalar& z) { return point<Scalar>{{z, Scalar(0.5)}}; };

}  // namespace

TEST_CASE("four tracks in the lanes of a pack are fitted as four tracks one by one", "[kalman]") {
  check_lanes<position>(kalman::filter{motion{}, motion{}}, make_position);
  check_lanes<point>(kalman::filter{motion{}, motion{}}, make_point);
  check_lanes<point>(kalman::filter{motion{}, motion{}, kalman::square_root{}}, make_point);
}

TEST_CASE("a gate decides lane by lane", "[kalman]") {
  check_lanes<position>(kalman::filter{motion{}, motion{}, kalman::joseph{}, kalman::chi2_gate{0.2}}, make_position);
}

TEST_CASE("a lane that fails does not stop the others and its chi2 is NaN", "[kalman]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const kalman::filter f{motion{}, motion{}};
  const kalman::estimate<pack, 2> start{scifi::vector<pack, 2>::Constant(pack(0.0)), scifi::matrix<pack, 2, 2>::Identity()};
  const auto u = f.update(start, position<pack>{pack(1.0, nan, 1.0, 1.0)});
  CHECK(u.status.ok());
  CHECK(std::isnan(u.chi2.v[1]));
  CHECK(std::isfinite(u.posterior.mean(0).v[0]));
  CHECK_FALSE(f.update(start, position<pack>{pack(nan)}).status.ok());
}
