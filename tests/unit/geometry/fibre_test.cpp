// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/fibre.hpp>

#include <cmath>

#include "support/catch.hpp"

using scifi::fibre_doublet;

TEST_CASE("the MICE doublet has the published dimensions", "[geometry]") {
  // Ellis et al., NIM A 659 (2011) 136: 350 um fibres, pitch 427 um, seven fibres a channel, doublet layer 627 um thick.
  const fibre_doublet f;
  CHECK(f.step() == Approx(0.2135));
  CHECK(f.channel_width() == Approx(1.4945));
  CHECK(f.thickness() == Approx(0.627).margin(0.0005));
}

TEST_CASE("fibres of the two rows touch", "[geometry]") {
  const fibre_doublet f;
  const double distance = std::hypot(f.row_separation, f.step());
  CHECK(distance == Approx(f.diameter).epsilon(1e-5));  // row_separation is given to five digits
}

TEST_CASE("shared and unshared strips of the channels tile the plane", "[geometry]") {
  const fibre_doublet f;
  // Two neighbouring cores, centres a step apart, overlap by what their diameters exceed it.
  const double right_edge_of_left_core = 0.5 * f.core_diameter;
  const double left_edge_of_right_core = f.step() - 0.5 * f.core_diameter;
  CHECK(f.overlap() == Approx(right_edge_of_left_core - left_edge_of_right_core));
  CHECK(f.overlap() > 0.0);
  // One shared strip at each border between channels: a period is one strip of each kind.
  CHECK(f.unshared() + f.overlap() == Approx(f.channel_width()));
}
