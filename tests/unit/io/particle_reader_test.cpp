// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/particle_reader.hpp>

#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi;
using namespace scifi::test;

namespace {

const std::string header = "event,tracker,pdg,x_mm,y_mm,z_mm,t_ns,px_MeV,py_MeV,pz_MeV\n";

std::string refusal(const std::string& rows) {
  const temporary_folder folder;
  try {
    (void)read_particles(folder.file("beam.csv", header + rows));
  } catch (const input_error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("particles of a beam file are gathered by event", "[io]") {
  const temporary_folder folder;
  const auto events = read_particles(folder.file("beam.csv", header + "3,1,-13,1,2,-30,0.5,10,20,200\n3,0,211,4,5,1130,0,-1,-2,-180\n7,1,11,0,0,-30,0,0,0,50\n"));
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
  CHECK(read_particles(folder.file("none.csv", header)).empty());
}

TEST_CASE("a beam file that does not fit is refused with line and column", "[io]") {
  CHECK(refusal("3,1,2112,0,0,0,0,0,0,200\n").find("2112 is not known") != std::string::npos);
  CHECK(refusal("3,1,13,0,0,0,0,0,0,0\n").find("momentum along z") != std::string::npos);
  CHECK(refusal("3,1,13,0,0,0,0,0,0,1\n2,1,13,0,0,0,0,0,0,1\n").find("2 comes after 3") != std::string::npos);
  CHECK(refusal("-1,1,13,0,0,0,0,0,0,1\n").find("negative") != std::string::npos);
  CHECK(refusal("1,1,13,x,0,0,0,0,0,1\n").find("x_mm") != std::string::npos);
}
