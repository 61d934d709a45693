// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <array>
#include <stdexcept>

#include <scifi/material/slab.hpp>

using namespace scifi;

TEST_CASE("A whole slab is its own layer", "[material]") {
  constexpr slab s = whole(materials::polystyrene, 41.311320754716984);
  CHECK(radiation_lengths(s) == Approx(0.1).epsilon(1e-12));
  CHECK(s.layer_radiation_lengths == radiation_lengths(s));
  CHECK(layer_thickness(s) == Approx(s.thickness).epsilon(1e-15));
}

TEST_CASE("Slices add up to the slab and remember the layer", "[material]") {
  constexpr slab s = whole(materials::aluminium, 6.0);
  constexpr slab slice = split(s, 3);
  CHECK(slice.thickness == Approx(2.0));
  CHECK(3.0 * radiation_lengths(slice) == Approx(radiation_lengths(s)).epsilon(1e-15));
  CHECK(slice.layer_radiation_lengths == s.layer_radiation_lengths);
  CHECK(layer_thickness(split(slice, 7)) == Approx(6.0).epsilon(1e-14));
  CHECK_THROWS_AS(split(s, 0), std::invalid_argument);
  CHECK_THROWS_AS(split(s, -2), std::invalid_argument);
}

TEST_CASE("Vacuum and nothing have no radiation lengths", "[material]") {
  CHECK(radiation_lengths(whole(materials::vacuum, 1000.0)) == 0.0);
  CHECK(layer_thickness(whole(materials::vacuum, 1000.0)) == 1000.0);
  CHECK(layer_thickness(whole(materials::polystyrene, 0.0)) == 0.0);
  CHECK(radiation_lengths(slab{}) == 0.0);
}

TEST_CASE("A stack keeps its slabs in order and refuses one too many", "[material]") {
  slab_stack<3> stack;
  CHECK(stack.empty());
  CHECK(radiation_lengths(stack) == 0.0);
  stack.add(whole(materials::polystyrene, 0.627)).add(whole(materials::mylar, 0.025)).add(whole(materials::helium, 199.0));
  REQUIRE(stack.size() == 3);
  CHECK(stack[0].medium.name == "polystyrene");
  CHECK(stack[2].medium.name == "helium");
  CHECK(thickness(stack) == Approx(199.652).epsilon(1e-14));
  CHECK_THROWS_AS(stack.add(slab{}), std::length_error);
  CHECK(stack.size() == 3);
  static_assert(slab_stack<>::capacity() == 4);

  std::size_t count = 0;
  for (const slab& s : stack) count += s.thickness > 0.0 ? 1u : 0u;
  CHECK(count == 3);
}

TEST_CASE("A stack regarded as one layer keeps its thickness and shares one logarithm", "[material]") {
  slab_stack<> stack;
  stack.add(whole(materials::polystyrene, 0.627)).add(whole(materials::mylar, 0.025));
  const slab_stack<> merged = as_one_layer(stack);
  // PDG radiation lengths 413.1 mm and 285.4 mm.
  CHECK(radiation_lengths(merged) == Approx(0.627 / 413.1 + 0.025 / 285.4).epsilon(1e-3));
  CHECK(thickness(merged) == thickness(stack));
  CHECK(merged[0].layer_radiation_lengths == radiation_lengths(stack));
  CHECK(merged[1].layer_radiation_lengths == radiation_lengths(stack));
}
