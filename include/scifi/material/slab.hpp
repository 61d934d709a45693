// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <stdexcept>

#include <scifi/core/inline_vector.hpp>
#include <scifi/core/refuse.hpp>
#include <scifi/material/material.hpp>
#include <scifi/material/materials.hpp>

namespace scifi {

/// A slice of a layer of one medium, crossed along its normal z.
///
/// `layer_radiation_lengths` is x/X0 at normal incidence of the whole layer the slice belongs to: the logarithms of Highland's formula
/// and of the most probable energy loss use the layer, so that N slices give what one slab gives.
struct slab {
  material medium = materials::vacuum;
  double thickness = 0.0;  ///< mm along z
  double layer_radiation_lengths = 0.0;
};

/// A layer of one piece, `thickness` in mm along z.
[[nodiscard]] constexpr slab whole(const material& medium, double thickness) { return {medium, thickness, thickness / medium.radiation_length}; }

/// One of `slices` equal slices of a slab; the layer it belongs to stays. Throws std::invalid_argument when slices < 1.
[[nodiscard]] constexpr slab split(const slab& original, int slices) {
  if (slices < 1) detail::refuse<std::invalid_argument>("scifi::split: a slab is split into one slice or more");
  return {original.medium, original.thickness / slices, original.layer_radiation_lengths};
}

/// x/X0 of the slab at normal incidence.
[[nodiscard]] constexpr double radiation_lengths(const slab& s) { return s.thickness / s.medium.radiation_length; }

/// Thickness (mm) of the layer, expressed in this slab's medium; the slab's own thickness in vacuum.
[[nodiscard]] constexpr double layer_thickness(const slab& s) {
  const double own = radiation_lengths(s);
  return own > 0.0 ? s.thickness * (s.layer_radiation_lengths / own) : s.thickness;
}

/// The material between two surfaces, in order of increasing z, without allocation.
template <std::size_t Capacity = 4>
class slab_stack {
 public:
  /// Appends a slab at larger z. Throws std::length_error when the stack is full.
  constexpr slab_stack& add(const slab& next) {
    if (!slabs_.push_back(next)) detail::refuse<std::length_error>("scifi::slab_stack: more slabs than its capacity");
    return *this;
  }

  [[nodiscard]] constexpr std::size_t size() const { return slabs_.size(); }
  [[nodiscard]] constexpr bool empty() const { return slabs_.empty(); }
  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }
  [[nodiscard]] constexpr const slab& operator[](std::size_t i) const { return slabs_[i]; }
  [[nodiscard]] constexpr const slab* begin() const { return slabs_.begin(); }
  [[nodiscard]] constexpr const slab* end() const { return slabs_.end(); }

 private:
  inline_vector<slab, Capacity> slabs_;
};

/// Sum of x/X0 at normal incidence.
template <std::size_t Capacity>
[[nodiscard]] constexpr double radiation_lengths(const slab_stack<Capacity>& stack) {
  double sum = 0.0;
  for (const slab& s : stack) sum += radiation_lengths(s);
  return sum;
}

/// Sum of the thicknesses, mm.
template <std::size_t Capacity>
[[nodiscard]] constexpr double thickness(const slab_stack<Capacity>& stack) {
  double sum = 0.0;
  for (const slab& s : stack) sum += s.thickness;
  return sum;
}

/// The same slabs regarded as slices of one layer: Highland's logarithm then uses their sum (PDG 2024, remark below eq. 34.16).
template <std::size_t Capacity>
[[nodiscard]] constexpr slab_stack<Capacity> as_one_layer(const slab_stack<Capacity>& stack) {
  const double total = radiation_lengths(stack);
  slab_stack<Capacity> merged;
  for (const slab& s : stack) merged.add({s.medium, s.thickness, total});
  return merged;
}

}  // namespace scifi
