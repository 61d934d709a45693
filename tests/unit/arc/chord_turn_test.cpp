// SPDX-License-Identifier: MPL-2.0
#include <scifi/arc/chord_turn.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "support/catch.hpp"

using namespace scifi;

namespace {

using complex = std::complex<double>;

/// Second chord over first one of a helix, from its points.
complex exact(double w, double step1, double step2) {
  const auto at = [w](double z) { return w == 0.0 ? complex(z) : (1.0 - std::exp(complex(0.0, -w * z))) / complex(0.0, w); };
  return (at(step1 + step2) - at(step1)) / at(step1);
}

}  // namespace

TEST_CASE("the second chord of a helix is the first one times the factor", "[arc]") {
  for (const auto& [step1, step2] : {std::pair{200.0, 250.0}, {300.0, 350.0}, {450.0, 300.0}}) {
    const chord_turn turn(step1, step2, 0.018);
    CHECK(turn.half() == 0.5 * (step1 + step2));
    CHECK(turn.largest() == Approx(std::min(0.018, constants::pi / std::max(step1, step2))));
    for (int i = -50; i <= 50; ++i) {
      const double w = turn.largest() * i / 50.0;
      CAPTURE(step1, step2, w);
      const complex f = exact(w, step1, step2);
      const auto [factor, derivative] = turn(w);
      CHECK(std::abs(complex(factor.x, factor.y) - f) < 2e-4 * std::max(1.0, std::abs(f)));
      CHECK(turn.ratio(w) == Approx(std::abs(f)).epsilon(1e-9));
      CHECK(turn.ratio(w) >= turn.shortest_ratio() - 1e-3);
      CHECK(turn.ratio(w) <= turn.longest_ratio() + 1e-3);
      constexpr double h = 1e-6;
      const complex slope = (exact(w + h, step1, step2) - exact(w - h, step1, step2)) / (2.0 * h);
      // The table's is that of the middle between its nodes.
      CHECK(std::abs(complex(derivative.x, derivative.y) - slope) < 0.03 * std::abs(slope));
    }
  }
}

TEST_CASE("a straight line goes on as the distances do, and the ratio is negative once a chord has passed a whole turn", "[arc]") {
  const chord_turn straight(200.0, 250.0, 0.0);
  CHECK(straight.largest() == 0.0);
  CHECK(straight(0.0).factor.x == Approx(1.25));
  CHECK(straight(0.0).factor.y == 0.0);
  const chord_turn bent(200.0, 350.0, 0.02);
  CHECK(bent.ratio(2.0 * constants::pi / 350.0 * 0.99) > 0.0);
  CHECK(bent.ratio(2.0 * constants::pi / 350.0 * 1.01) < 0.0);
}
