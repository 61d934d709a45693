// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/event/track.hpp>
#include <scifi/study/contents.hpp>
#include <scifi/study/distribution.hpp>
#include <scifi/study/flatness.hpp>

namespace scifi::study {

/// chi2 per degree of freedom and p-value of tracks; the p-values of a fit that knows its errors are uniform. Merged with +=.
struct goodness_of_fit {
  distribution chi2_per_ndf{100, 0.0, 5.0, "chi2 / degrees of freedom"};
  distribution p_value{50, 0.0, 1.0, "p-value"};

  /// A track without degrees of freedom is passed over.
  void add(const track& t) {
    if (t.ndf < 1) return;
    chi2_per_ndf.add(t.chi2 / t.ndf);
    p_value.add(t.p_value);
  }
  goodness_of_fit& operator+=(const goodness_of_fit& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(chi2_per_ndf, other.chi2_per_ndf...);
    visit(p_value, other.p_value...);
  }
  [[nodiscard]] flatness of_p_value() const { return flatness_of(p_value.values); }
};

}  // namespace scifi::study
