// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/material/in_slabs.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>

using namespace scifi;

namespace {

/// A policy of a user that knows only the plain form.
struct one_per_mm {
  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const Scalar&, const particle&, const slab& s, const Scalar& path) const {
    return {Scalar(path * Scalar(s.thickness)), Scalar(0.0), Scalar(s.thickness)};
  }
  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const Scalar&, const particle&, const slab& s, const Scalar& path) const {
    return path * Scalar(s.thickness);
  }
};

slab_stack<4> plane() {
  slab_stack<4> stack;
  stack.add(whole(materials::mylar, 0.025)).add(whole(materials::polystyrene, 0.6273));
  return stack;
}
slab_stack<1> gas() {
  slab_stack<1> stack;
  stack.add(whole(materials::helium, 350.0));
  return stack;
}

}  // namespace

TEST_CASE("What is worked out once for all slabs equals asking slab by slab", "[material]") {
  const auto check = [](const auto& policy) {
    for (const double p : {60.0, 150.0, 300.0, 3000.0}) {
      for (const double path : {1.0, 1.12}) {
        const auto crossing = crossing_particle_of(p, muon_plus, path);
        energy_loss<double> expected{0.0, 0.0, 0.0};
        const auto add = [&](const slab& s) {
          const auto one = policy.loss(p, muon_plus, s, path);
          expected.value += one.value;
          expected.d_value_d_p += one.d_value_d_p;
          expected.d_value_d_path_factor += one.d_value_d_path_factor;
        };
        for (const slab& s : plane()) add(s);
        for (const slab& s : gas()) add(s);
        const auto got = loss_in_slabs(policy, crossing, muon_plus, plane(), gas());
        CHECK(got.value == Approx(expected.value).epsilon(1e-12));
        CHECK(got.d_value_d_p == Approx(expected.d_value_d_p).epsilon(1e-10));
        CHECK(got.d_value_d_path_factor == Approx(expected.d_value_d_path_factor).epsilon(1e-12));
      }
    }
  };
  check(mean_energy_loss{});
  check(most_probable_energy_loss{5.0});
  check(median_energy_loss{5.0});
  check(no_energy_loss{});
  check(one_per_mm{});
}

TEST_CASE("Variances of slabs add up, in either form of a policy", "[material]") {
  const double p = 180.0, path = 1.07;
  const auto crossing = crossing_particle_of(p, muon_plus, path);
  const auto check = [&](const auto& policy) {
    double expected = 0.0;
    for (const slab& s : plane()) expected += policy.variance(p, muon_plus, s, path);
    CHECK(variance_in_slabs(policy, crossing, muon_plus, plane()) == Approx(expected).epsilon(1e-12));
  };
  check(highland_scattering{});
  check(landau_straggling{5.0});
  check(bohr_straggling{});
  check(no_scattering{});
  check(one_per_mm{});
  CHECK(variance_in_slabs(highland_scattering{}, crossing, muon_plus, slab_stack<4>{}) == 0.0);
}
