// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/particle_reader.hpp>

#include <string>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi;
using namespace scifi::test;

namespace {

const detector trackers = mice::trackers();
const std::string header = "event,tracker,pdg,x_mm,y_mm,z_mm,t_ns,px_MeV,py_MeV,pz_MeV\n";

}  // namespace

TEST_CASE("particles of a beam file are gathered by event", "[io]") {
  const temporary_folder folder;
  const auto events = read_particles(folder.file("beam.csv", header + "3,1,-13,1,2,-30,0.5,10,20,200\n3,0,211,4,5,1130,0,-1,-2,-180\n7,1,11,0,0,-30,0,0,0,50\n"), trackers);
  REQUIRE(events.size() == 2);
  CHECK(events[0].number == 3);
  REQUIRE(events[0].particles.size() == 2);
  const beam_particle& first = events[0].particles[0];
  CHECK(first.tracker == 1);
  CHECK(first.start.hypothesis.pdg_id == muon_plus.pdg_id);
  CHECK(first.start.position == vector<double, 3>(1.0, 2.0, -30.0));
  CHECK(first.start.momentum == vector<double, 3>(10.0, 20.0, 200.0));
  CHECK(first.start.t == 0.5);
  CHECK(events[0].particles[1].start.hypothesis.name == "pi+");
  CHECK(events[1].number == 7);
  CHECK(events[1].particles.size() == 1);
  CHECK(read_particles(folder.file("none.csv", header), trackers).empty());
}

TEST_CASE("a beam file that does not fit is refused with file, line and column", "[io]") {
  struct row {
    std::string text;
    const char* message;
  };
  const row table[] = {
      {"", ": the file is empty"},
      {"event,tracker,pdg\n", ":1: x_mm: the header has no column of this name, it reads 'event,tracker,pdg'"},
      {header + "3,1,13,0,0,0,0,0,0,200\n4,1,13,0,0\n", ":3: 5 fields where the header names 10"},
      {header + "3,1,2112,0,0,0,0,0,0,200\n", ":2: pdg: 2112 is not known; try 13, -13, 211, -211, 11, -11 or 2212"},
      {header + "3,2,13,0,0,0,0,0,0,200\n", ":2: tracker: there is no tracker 2"},
      {header + "3,-1,13,0,0,0,0,0,0,200\n", ":2: tracker: there is no tracker -1"},
      {header + "3,1,13,0,0,0,0,0,0,0\n", ":2: pz_MeV: a particle needs a momentum along z"},
      {header + "3,1,13,0,0,0,0,0,0,1\n2,1,13,0,0,0,0,0,0,1\n",
       ":3: event: 2 comes after 3: the rows of an event must stand together and event numbers must grow"},
      {header + "-1,1,13,0,0,0,0,0,0,1\n", ":2: event: event numbers must not be negative"},
      {header + "1,1,13,x,0,0,0,0,0,1\n", ":2: x_mm: 'x' is not a number"},
      {header + "1,1,13,nan,0,0,0,0,0,1\n", ":2: x_mm: 'nan' is not a finite number"},
      {header + "1,1,13,0,0,0,,0,0,1\n", ":2: t_ns: the field is empty"},
      {std::string("\xFF\xFE" "e\0v\0", 6), ":1: event: the header has no column of this name, it reads '\xFF\xFE" "e?v?'"},
  };
  const temporary_folder folder;
  for (const row& r : table) {
    const auto path = folder.file("beam.csv", r.text);
    CHECK(without(path.string(), message_of<input_error>([&] { (void)read_particles(path, trackers); })) == r.message);
  }
}
