// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/core/units.hpp>
#include <scifi/io/mice_module.hpp>
#include <scifi/material/materials.hpp>

namespace scifi::detail {

/// What is left of decimals after sums of them: rounded to a femtometre. Angles likewise to 1e-12 degree.
[[nodiscard]] inline double rounded(double x) {
  constexpr double steps = 1.0e12;
  constexpr double largest = 1.0e3;  // beyond, a double has no such digits
  constexpr double coarse_steps = 1.0e9;
  const double by = std::abs(x) < largest ? steps : coarse_steps;
  return std::round(x * by) / by + 0.0;
}
[[nodiscard]] inline vector<double, 3> rounded(const vector<double, 3>& v) { return {rounded(v.x()), rounded(v.y()), rounded(v.z())}; }

/// A module with its place in the frame of an outer module, called top, and the modules around it.
struct placed_module {
  const mice_module* module;
  vector<double, 3> origin = vector<double, 3>::Zero();                 ///< frame of top, mm
  matrix<double, 3, 3> top_to_here = matrix<double, 3, 3>::Identity();  ///< of directions
  std::vector<const mice_module*> around;                               ///< outermost first

  /// The top itself: its own Position and Rotation place it in nothing.
  explicit placed_module(const mice_module& top) : module(&top) {}

  /// A child of this module.
  [[nodiscard]] placed_module inside(const mice_module& child) const {
    placed_module out(child);
    out.origin = origin + here_to_top(child.position);
    out.top_to_here = child.parent_to_child * top_to_here;
    out.around = around;
    out.around.push_back(module);
    return out;
  }
  /// A direction of this module in the frame of top.
  [[nodiscard]] vector<double, 3> here_to_top(const vector<double, 3>& direction) const { return top_to_here.transpose() * direction; }

  /// Angle of its axes about z of top, rad. Throws input_error when they are turned about another axis too.
  [[nodiscard]] double angle_about_z() const {
    constexpr double rounding = 1.0e-9;
    if (top_to_here(2, 2) < 1.0 - rounding) module->fail("is turned about another axis than z");
    return rounded(std::atan2(top_to_here(0, 1), top_to_here(0, 0)) / units::degree) * units::degree;
  }
};

/// The library's material for the experiment's name of it. Throws input_error for a name that is not known.
[[nodiscard]] inline material medium_of(const mice_module& m) {
  const mice_property& p = m.at("Material");
  const std::string& name = p.text();
  if (name == "POLYSTYRENE") return materials::polystyrene;
  if (name == "MYLAR") return materials::mylar;
  if (name == "He") return materials::helium;
  if (name == "AIR") return materials::air;
  if (name == "Al" || name == "ALUMINUM") return materials::aluminium;
  if (name == "Galactic") return materials::vacuum;
  p.fail(in_quotes(name) + " is not known as a material of a tracker");
}

/// Length along z of a cylinder, mm. Throws input_error when the module is none.
[[nodiscard]] inline double length_of(const mice_module& m) {
  if (m.volume != "Cylinder" || m.dimensions.size() != 2) m.fail("is not a cylinder with a radius and a length");
  if (!(m.dimensions[1] > 0.0)) m.fail("its length is not above zero");
  return m.dimensions[1];
}

/// The view that a plane's module is named after: "TrackerViewV" is V. The experiment writes X for what its papers call U.
[[nodiscard]] inline std::string view_of(std::string_view module_name) {
  constexpr std::string_view word = "View";
  const std::size_t at = module_name.rfind(word);
  const std::string view(at == std::string_view::npos ? module_name : module_name.substr(at + word.size()));
  return view == "X" ? "U" : view;
}

}  // namespace scifi::detail
