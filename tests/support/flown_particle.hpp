// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <vector>

#include <scifi/event/track.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/geometry/tracker.hpp>

namespace scifi::test {

/// Crossings of a positive muon that flies as an exact helix, without material: (x, y, px, py, pz) at z = 0, field in (MeV/c)/(e mm).
/// Turning: d(px)/dz = +k py/pz, d(py)/dz = -k px/pz.
inline std::vector<crossing> flown_particle(const tracker& where, int number, const vector<double, 5>& start, double field) {
  std::vector<crossing> out;
  for (const surface& s : surfaces_along(where, +1)) {
    const double z = s.z_reference;
    const double angle = field * z / start[4];
    const double px = start[2] * std::cos(angle) + start[3] * std::sin(angle);
    const double py = start[3] * std::cos(angle) - start[2] * std::sin(angle);
    const double x = field == 0.0 ? start[0] + start[2] / start[4] * z : start[0] + (start[3] - py) / field;
    const double y = field == 0.0 ? start[1] + start[3] / start[4] * z : start[1] - (start[2] - px) / field;
    out.push_back({number, -13, where.id, s.station, s.plane, {x, y, z}, {px, py, start[4]}});
  }
  return out;
}

/// A fitted track with this state (x, y, px, py, pz) at the reference surface and these standard deviations.
inline track fitted_track(int tracker, const vector<double, 5>& state, const vector<double, 5>& sigmas) {
  track t;
  t.tracker = tracker;
  t.charge = 1;
  t.stations = 5;
  t.planes = 15;
  t.ndf = 10;
  t.chi2 = 10.0;
  t.p_value = 0.44;
  t.reference.mean = state;
  t.reference.covariance = vector<double, 5>(sigmas.cwiseProduct(sigmas)).asDiagonal();
  return t;
}

inline vector<double, 5> five(double a, double b, double c, double d, double e) {
  vector<double, 5> out;
  out << a, b, c, d, e;
  return out;
}

}  // namespace scifi::test
