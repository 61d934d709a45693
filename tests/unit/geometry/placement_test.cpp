// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/placement.hpp>

#include <random>

#include <scifi/core/units.hpp>

#include "support/catch.hpp"

using scifi::placement;
using point = scifi::vector<double, 3>;

TEST_CASE("a rotation is passive: seen from axes turned by +90 degrees the parent's x axis lies along -y", "[geometry]") {
  const placement turned{point::Zero(), 90.0 * scifi::units::degree};
  const point x = turned.parent_to_child({1.0, 0.0, 0.0});
  CHECK((x - point(0.0, -1.0, 0.0)).norm() < 1e-15);
  // The child's own x axis, in the parent, is the parent's y axis.
  CHECK((turned.child_to_parent({1.0, 0.0, 0.0}) - point(0.0, 1.0, 0.0)).norm() < 1e-15);
  CHECK((turned.direction_child_to_parent({0.0, 1.0, 2.0}) - point(-1.0, 0.0, 2.0)).norm() < 1e-15);
}

TEST_CASE("the origin of the child is zero in the child, and a direction knows no origin", "[geometry]") {
  const placement p{{3.0, -4.0, 100.0}, 0.7};
  CHECK(p.parent_to_child(p.origin).norm() == 0.0);
  CHECK((p.child_to_parent(point::Zero()) - p.origin).norm() == 0.0);
  const point a(1.0, 2.0, 3.0), b(-2.0, 0.5, 7.0);
  CHECK((p.parent_to_child(a) - p.parent_to_child(b) - p.direction_parent_to_child(a - b)).norm() < 1e-13);
}

TEST_CASE("there and back is where one was, and lengths stay", "[geometry]") {
  std::mt19937_64 engine(20240117);
  std::uniform_real_distribution<double> uniform(-500.0, 500.0);
  for (int i = 0; i < 100; ++i) {
    const placement p{{uniform(engine), uniform(engine), uniform(engine)}, uniform(engine)};
    const point a(uniform(engine), uniform(engine), uniform(engine)), b(uniform(engine), uniform(engine), uniform(engine));
    // A few operations on numbers of size 1e3: 10 eps 1e3.
    CHECK((p.child_to_parent(p.parent_to_child(a)) - a).norm() < 2e-12);
    CHECK((p.direction_child_to_parent(p.direction_parent_to_child(a)) - a).norm() < 2e-12);
    CHECK(std::abs((p.parent_to_child(a) - p.parent_to_child(b)).norm() - (a - b).norm()) < 2e-12);
    CHECK(p.direction_parent_to_child(a).z() == a.z());
  }
}

TEST_CASE("a placement that is not set changes nothing", "[geometry]") {
  const point a(1.0, -2.0, 3.0);
  CHECK(placement{}.parent_to_child(a) == a);
  CHECK(placement{}.child_to_parent(a) == a);
}
