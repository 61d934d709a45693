// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/material/concepts.hpp>

#include "dual.hpp"

using namespace scifi;

namespace {

template <class Scalar>
constexpr bool all_policies_model_their_concepts() {
  return energy_loss_policy<mean_energy_loss, Scalar> && energy_loss_policy<most_probable_energy_loss, Scalar> &&
         energy_loss_policy<median_energy_loss, Scalar> && energy_loss_policy<no_energy_loss, Scalar> && scattering_policy<highland_scattering, Scalar> &&
         scattering_policy<no_scattering, Scalar> && straggling_policy<bohr_straggling, Scalar> && straggling_policy<landau_straggling, Scalar> &&
         straggling_policy<no_straggling, Scalar>;
}

struct fixed_angle {  // a user's policy, without any declaration
  double variance(double, const particle&, const slab&, double) const { return 1e-6; }
};

struct changes_itself {
  double variance(double, const particle&, const slab&, double) { return 1e-6; }
};

}  // namespace

TEST_CASE("The policies model their concepts for every scalar", "[material]") {
  CHECK(all_policies_model_their_concepts<double>());
  CHECK(all_policies_model_their_concepts<float>());
  CHECK(all_policies_model_their_concepts<test::dual>());
}

TEST_CASE("A policy that says what it varies is refused in the other place", "[material]") {
  CHECK_FALSE(scattering_policy<bohr_straggling>);
  CHECK_FALSE(scattering_policy<no_straggling>);
  CHECK_FALSE(straggling_policy<highland_scattering>);
  CHECK_FALSE(straggling_policy<no_scattering>);
  CHECK_FALSE(energy_loss_policy<no_scattering>);
  CHECK_FALSE(scattering_policy<no_energy_loss>);
}

TEST_CASE("A user's policy needs the one const function and nothing else", "[material]") {
  CHECK(scattering_policy<fixed_angle>);
  CHECK_FALSE(scattering_policy<changes_itself>);
  CHECK_FALSE(scattering_policy<fixed_angle, test::dual>);
}
