// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>

#include <scifi/event/event.hpp>
#include <scifi/study/contents.hpp>
#include <scifi/study/distribution.hpp>

namespace scifi::study {

/// How much there is in an event of one tracker: digits, clusters, space points and light. Merged with +=.
struct occupancy {
  distribution digits{200, -0.5, 199.5, "digits per event"};
  distribution clusters{200, -0.5, 199.5, "clusters per event"};
  distribution space_points{100, -0.5, 99.5, "space points per event"};
  distribution triplets{100, -0.5, 99.5, "space points of three clusters per event"};
  distribution digit_light{100, 0.0, 50.0, "light of a digit [photo-electrons]"};
  distribution cluster_light{100, 0.0, 50.0, "light of a cluster [photo-electrons]"};
  distribution cluster_size{4, 0.5, 4.5, "digits per cluster"};

  /// An event with its digits, clusters and space points; those of other trackers are passed over.
  void add(const event& e, int tracker) {
    const auto number = [](auto count) { return static_cast<double>(count); };
    const auto here = [tracker](const auto& one) { return one.tracker == tracker; };
    digits.add(number(std::count_if(e.digits.begin(), e.digits.end(), [tracker](const digit& d) { return d.id.tracker == tracker; })));
    clusters.add(number(std::count_if(e.clusters.begin(), e.clusters.end(), here)));
    space_points.add(number(std::count_if(e.space_points.begin(), e.space_points.end(), here)));
    triplets.add(number(std::count_if(e.space_points.begin(), e.space_points.end(), [&](const space_point& p) { return here(p) && p.clusters.size() == 3; })));
    for (const digit& d : e.digits)
      if (d.id.tracker == tracker) digit_light.add(d.npe);
    for (const cluster& c : e.clusters) {
      if (!here(c)) continue;
      cluster_light.add(c.npe);
      cluster_size.add(c.size);
    }
  }
  occupancy& operator+=(const occupancy& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(digits, other.digits...);
    visit(clusters, other.clusters...);
    visit(space_points, other.space_points...);
    visit(triplets, other.triplets...);
    visit(digit_light, other.digit_light...);
    visit(cluster_light, other.cluster_light...);
    visit(cluster_size, other.cluster_size...);
  }
};

}  // namespace scifi::study
