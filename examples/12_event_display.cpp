// SPDX-License-Identifier: MPL-2.0
// An event display: one simulated event, reconstructed, as a page and for Phoenix: 12_event_display [PAGE]. PAGE is display.html as scripts/web_assets makes
// it; without one the event is written as the JSON that the page would hold, and checked.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/io/event_view_json.hpp>
#include <scifi/io/html_page.hpp>
#include <scifi/io/phoenix_json.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

using namespace scifi::literals;

/// One muon in each tracker: their digits, and what really happened.
scifi::event simulate(const scifi::detector& mice, double field, scifi::truth& truth) {
  scifi::transport_settings settings;
  settings.field = field;
  const scifi::flat_beam beam;
  const scifi::digitiser digitise;
  scifi::event e;
  e.number = 1;
  for (const scifi::tracker& t : mice.trackers) {
    scifi::random_stream random(12, static_cast<std::uint64_t>(t.id), 0);
    scifi::truth here;
    here.last_particle = 1;
    scifi::transport(t, settings)(beam.shoot(t, random), 1, random, here);
    std::vector<scifi::raw_digit> read_out;
    digitise(t, here.hits, random, read_out);
    for (const scifi::raw_digit& d : read_out) e.digits.push_back(d.seen());
    truth.crossings.insert(truth.crossings.end(), here.crossings.begin(), here.crossings.end());
  }
  return e;
}

/// Largest distance of a true crossing from the drawn curve of the track in its tracker, mm, or infinity where there is no track.
double furthest_from_tracks(const nlohmann::ordered_json& view) {
  double furthest = 0.0;
  for (const auto& particle : view["truth"]) {
    for (const auto& crossing : particle["points"]) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& track : view["tracks"]) {
        if (track["tracker"] != particle["tracker"]) continue;
        for (const auto& p : track["curve"]) {
          double squared = 0.0;
          for (std::size_t i = 0; i < 3; ++i) squared += std::pow(p[i].get<double>() - crossing["at"][i].get<double>(), 2);
          nearest = std::min(nearest, std::sqrt(squared));
        }
      }
      furthest = std::max(furthest, nearest);
    }
  }
  return furthest;
}

int main(int argc, char** argv) try {
  const scifi::detector mice = scifi::mice::trackers();
  const double field = 3.0_T;
  scifi::truth truth;
  scifi::event e = simulate(mice, field, truth);
  scifi::make_reconstruction(mice, {.field = field, .fibre = {}})(e);

  // [display]
  nlohmann::ordered_json view = scifi::event_view_json(mice, e, field, &truth);
  const auto document = scifi::event_view_document(mice, field, "one muon in each tracker", nlohmann::ordered_json::array({view}));
  if (argc > 1) {
    std::ifstream page(argv[1], std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(page)), {});
    std::ofstream("event.html") << scifi::page_with_data(text, document.dump());
  }
  scifi::phoenix_events phoenix(mice, field);
  phoenix.add(e);
  std::ofstream("event_phoenix.json") << phoenix.document().dump();
  // [display]

  const double furthest = furthest_from_tracks(view);
  const auto& tracks = phoenix.document().at("Event 1").at("Tracks").at("Fitted tracks");
  std::printf("%zu digits, %zu space points, %zu tracks, nowhere further than %.2f mm from the true crossings\n", e.digits.size(), e.space_points.size(),
              e.tracks.size(), furthest);
  if (argc < 2) std::filesystem::remove("event_phoenix.json");
  // The resolution of a plane is 0.43 mm, of a fitted point about 0.3 mm in x and y.
  return tracks.size() == 2 && view["tracks"].size() == 2 && furthest < 2.0 ? 0 : 1;
} catch (const std::exception& problem) {
  std::fprintf(stderr, "%s\n", problem.what());
  return 2;
}
