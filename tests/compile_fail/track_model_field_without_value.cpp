// SPDX-License-Identifier: MPL-2.0
// expect: scifi: the field of a nystrom_propagator needs a const call operator that takes a position
#include <scifi/track_model/nystrom_propagator.hpp>

struct field_on_axis {
  double operator()(double z) const { return z; }
};

int main() {
  const scifi::nystrom_propagator flight{field_on_axis{}};
  const scifi::vector<double, 5> start(0.0, 0.0, 0.0, 0.0, 0.005);
  return flight.propagate(start, scifi::stretch{0.0, 100.0}).state.allFinite() ? 0 : 1;
}
