// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <limits>
#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

#include <scifi/geometry/mice.hpp>
#include <scifi/io/track_reader.hpp>
#include <scifi/io/track_writer.hpp>
#include <scifi/track_model/helix_state.hpp>

using namespace scifi;
using m = momentum_state;

namespace {

track written_track() {
  track t;
  t.tracker = 1;
  t.charge = -1;
  t.stations = 5;
  t.planes = 14;
  t.chi2 = 12.5;
  t.ndf = 9;
  t.p_value = 0.1875;
  t.reference.mean << 1.5, -2.25, 30.125, -40.5, 200.75;
  t.reference.covariance = vector<double, 5>(0.25, 0.0625, 1.0, 4.0, 9.0).asDiagonal();
  return t;
}

}  // namespace

TEST_CASE("tracks come back as they were written; one whose fit had stopped keeps its place", "[io]") {
  const detector d = mice::trackers();
  event e;
  e.number = 12;
  e.tracks = {written_track(), written_track(), written_track()};
  e.tracks[1].status.why = kalman::reason::not_converged;
  e.tracks[2].shape = track_shape::line;
  std::string text(track_columns);
  append_tracks(text, e);
  const test::temporary_folder folder;
  track_reader reader(folder.file("tracks.csv", text), d);
  CHECK(reader.next_event() == 12);
  event back;
  reader.read(12, back);
  REQUIRE(back.tracks.size() == 3);
  CHECK_FALSE(back.tracks[1].status.ok());
  CHECK(back.tracks[2].shape == track_shape::line);
  const track& t = back.tracks[0];
  CHECK(t.status.ok());
  CHECK(t.tracker == 1);
  CHECK(t.charge == -1);
  CHECK(t.stations == 5);
  CHECK(t.planes == 14);
  CHECK(t.chi2 == 12.5);
  CHECK(t.ndf == 9);
  CHECK(t.p_value == 0.1875);
  CHECK(t.reference.mean == e.tracks[0].reference.mean);
  CHECK(t.reference.covariance == e.tracks[0].reference.covariance);
  reader.read(13, back);
  CHECK(back.tracks.empty());
}

TEST_CASE("what cannot be a track is refused with line and column", "[io]") {
  const detector d = mice::trackers();
  const test::temporary_folder folder;
  const std::string good = "1,1,0,helix,1,5,15,10,10,0.44,0,0,0,30,40,200,0.3,0.3,1,1,3\n";
  const auto message = [&](const std::string& rows) {
    const auto path = folder.file("tracks.csv", std::string(track_columns) + rows);
    return test::without(path.string(), test::message_of<input_error>([&] {
                           event e;
                           track_reader(path, d).read(1, e);
                         }));
  };
  CHECK(message(good) == "(no error)");
  CHECK(message(good + good) == ":3: track: 0: the tracks of an event stand in the order of their numbers, each once");
  CHECK(message("1,1,-1,helix,1,5,15,10,10,0.44,0,0,0,30,40,200,0.3,0.3,1,1,3\n") == ":2: track: -1 is negative");
  CHECK(message("1,1,9999999,helix,1,5,15,10,10,0.44,0,0,0,30,40,200,0.3,0.3,1,1,3\n") == ":2: track: 9999999: no event has so many tracks");
  CHECK(message("1,3,0,helix,1,5,15,10,10,0.44,0,0,0,30,40,200,0.3,0.3,1,1,3\n") == ":2: tracker: there is no tracker 3");
  CHECK(message("1,1,0,spiral,1,5,15,10,10,0.44,0,0,0,30,40,200,0.3,0.3,1,1,3\n") == ":2: model: 'spiral' is neither 'helix' nor 'line'");
  CHECK(message("1,1,0,helix,1,5,15,10,10,1.44,0,0,0,30,40,200,0.3,0.3,1,1,3\n") == ":2: p_value: '1.44' is outside 0 .. 1");
  CHECK(message("1,1,0,helix,1,5,15,10,10,0.44,0,0,0,30,40,0,0.3,0.3,1,1,3\n") == ":2: pz_MeV: a track has a momentum along z");
  CHECK(message("1,1,0,helix,1,5,15,10,10,0.44,0,0,0,30,40,200,0.3,-0.3,1,1,3\n") == ":2: sigma_y_mm: a standard deviation is not negative");
  CHECK(message("1,1,0,helix,1,5,15,ten,10,0.44,0,0,0,30,40,200,0.3,0.3,1,1,3\n") == ":2: chi2: 'ten' is not a number");
}
