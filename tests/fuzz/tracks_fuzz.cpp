// SPDX-License-Identifier: MPL-2.0
#include <cstddef>
#include <string_view>

#include <scifi/event/event.hpp>
#include <scifi/io/event_rows.hpp>
#include <scifi/io/track_point_reader.hpp>
#include <scifi/io/track_reader.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

// A table of tracks, then, where there is one, a line "---" and the table of their points.
inline const registered tracks_target("tracks", [](std::string_view bytes) {
  constexpr std::string_view between = "---\n";
  const std::size_t cut = bytes.find(between);
  const auto path = as_file(bytes.substr(0, cut));
  const auto points_path = as_file(cut == std::string_view::npos ? "" : bytes.substr(cut + between.size()), "points");
  read_or_refuse([&] {
    track_reader reader(path, trackers());
    track_point_reader points(points_path, trackers());
    event e;
    for (int left = 100; left > 0 && reader.next_event() != event_rows::no_more; --left) {
      const long number = reader.next_event();
      reader.read(number, e);
      points.read(number, e);
      for (const track& t : e.tracks) {
        require(!t.status.ok() || t.reference.mean.allFinite(), "a track that was fitted has finite numbers");
        require(t.first_point >= 0 && t.points >= 0 && static_cast<std::size_t>(t.first_point + t.points) <= e.track_points.size(), "points of a track are there");
      }
    }
  });
});

}  // namespace scifi::fuzz
