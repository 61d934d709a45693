// SPDX-License-Identifier: MPL-2.0
// expect: scifi: an event needs members digits (with channel_of and light_of beside their type), clusters, space_points, candidates, tracks, track_points and flags
#include <scifi/chain/reconstruction.hpp>

struct own_event {
  std::vector<scifi::digit> digits;
  std::vector<scifi::cluster> clusters;
  std::vector<scifi::space_point> space_points;
  std::vector<scifi::track> tracks;
  std::vector<scifi::track_point> track_points;
  scifi::event_flags flags;
};

void process(own_event& e) { scifi::make_reconstruction(scifi::detector{}, scifi::reconstruction_options{})(e); }
