// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>

#include <scifi/core/units.hpp>
#include <scifi/space_point_to_candidate/track_finder_options.hpp>

#include "support/message_of.hpp"

using namespace scifi;

TEST_CASE("the expected momentum follows from curvature and slope, within bounds", "[space_point_to_candidate]") {
  track_finder_options o;
  o.field = -3.0 * units::tesla;
  CHECK(expected_momentum(o, o.field / 200.0, 0.25) == Approx(200.0 * std::sqrt(1.25)));
  CHECK(expected_momentum(o, -o.field / 200.0, 0.0) == Approx(200.0));
  CHECK(expected_momentum(o, o.field / 1.0, 0.0) == o.smallest_pz);
  CHECK(std::isfinite(expected_momentum(o, 0.0, 0.0)));
  CHECK(expected_inverse_momentum(o, o.field / 200.0) == Approx(1.0 / 200.0));
  CHECK(expected_inverse_momentum(o, -o.field) == 1.0 / o.smallest_pz);
  o.field = 0.0;
  CHECK(expected_momentum(o, 0.0, 0.1) == o.line_momentum);
  CHECK(expected_inverse_momentum(o, 0.0) == 1.0 / o.line_momentum);
}

TEST_CASE("a field in gauss is refused with the unit that is expected", "[space_point_to_candidate]") {
  const auto message = [](double field) {
    track_finder_options o;
    o.field = field;
    return test::message_of<std::invalid_argument>([&o] { o.check(); });
  };
  CHECK(message(-30.0 * units::tesla) == "(no error)");
  CHECK(message(30000.0).find("3 T is 3.0 * units::tesla") != std::string::npos);
  CHECK(message(-30000.0) == message(30000.0));
}
