// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <boost/histogram/algorithm/project.hpp>
#include <boost/histogram/axis/variable.hpp>
#include <boost/histogram/histogram.hpp>
#include <boost/histogram/literals.hpp>
#include <boost/histogram/make_histogram.hpp>
#include <boost/histogram/storage_adaptor.hpp>

namespace scifi::study {

/// Edges of the bins in which momentum-dependent numbers are given, MeV/c, rising. The true values at the reference surface count.
struct momentum_edges {
  std::vector<double> pt{0, 2, 5, 10, 20, 30, 40, 50, 70, 90};
  std::vector<double> pz{100, 130, 160, 190, 220, 250, 280};  ///< of |pz|
};

/// Wider cells in two dimensions, for what needs many tracks in each: the shift of the momentum.
[[nodiscard]] inline momentum_edges wide_momentum_edges() { return {.pt = {0, 5, 10, 20, 30, 50, 90}, .pz = {100, 160, 220, 280}}; }

/// Cells in true (pt, |pz|), with underflow and overflow. A cell counts or collects; what it is filled with is up to its type.
template <class Cell>
using momentum_grid = boost::histogram::histogram<std::tuple<boost::histogram::axis::variable<>, boost::histogram::axis::variable<>>, boost::histogram::dense_storage<Cell>>;

/// Cells in true pt or in true |pz| alone.
template <class Cell>
using momentum_row = boost::histogram::histogram<std::tuple<boost::histogram::axis::variable<>>, boost::histogram::dense_storage<Cell>>;

/// An empty grid. Throws std::invalid_argument when the edges do not rise or are fewer than two.
template <class Cell>
[[nodiscard]] momentum_grid<Cell> make_momentum_grid(const momentum_edges& edges) {
  namespace bh = boost::histogram;
  return bh::make_histogram_with(bh::dense_storage<Cell>(), bh::axis::variable<>(edges.pt, "pt [MeV/c]"), bh::axis::variable<>(edges.pz, "pz [MeV/c]"));
}

/// The grid summed over |pz|, those outside the edges included: cells in pt.
template <class Cell>
[[nodiscard]] momentum_row<Cell> in_pt(const momentum_grid<Cell>& grid) {
  using namespace boost::histogram::literals;
  return boost::histogram::algorithm::project(grid, 0_c);
}

/// The grid summed over pt, those outside the edges included: cells in |pz|.
template <class Cell>
[[nodiscard]] momentum_row<Cell> in_pz(const momentum_grid<Cell>& grid) {
  using namespace boost::histogram::literals;
  return boost::histogram::algorithm::project(grid, 1_c);
}

}  // namespace scifi::study
