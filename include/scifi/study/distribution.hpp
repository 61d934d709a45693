// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>
#include <tuple>
#include <utility>

#include <boost/histogram/axis/regular.hpp>
#include <boost/histogram/histogram.hpp>
#include <boost/histogram/make_histogram.hpp>
#include <boost/histogram/storage_adaptor.hpp>

#include <scifi/study/contents.hpp>
#include <scifi/study/sample.hpp>

namespace scifi::study {

/// Counts in equal bins, with underflow and overflow.
using counts = boost::histogram::histogram<std::tuple<boost::histogram::axis::regular<>>, boost::histogram::dense_storage<double>>;

/// No counts in `bins` bins from `low` to `high` of what `label` names, unit included.
[[nodiscard]] inline counts make_counts(int bins, double low, double high, std::string label) {
  namespace bh = boost::histogram;
  return bh::make_histogram_with(bh::dense_storage<double>(), bh::axis::regular<>(static_cast<unsigned>(bins), low, high, std::move(label)));
}

/// A quantity of many tracks: its histogram, to be drawn, and its values, for exact quantiles. Merged with +=, which needs equal binning.
struct distribution {
  distribution(int bins, double low, double high, std::string label) : histogram(make_counts(bins, low, high, std::move(label))) {}

  counts histogram;
  sample values;

  void add(double value) {
    histogram(value);
    values.add(value);
  }
  /// Throws std::invalid_argument when the bins differ.
  distribution& operator+=(const distribution& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(histogram, other.histogram...);
    visit(values, other.values...);
  }
};

}  // namespace scifi::study
