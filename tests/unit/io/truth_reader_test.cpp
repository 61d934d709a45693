// SPDX-License-Identifier: MPL-2.0
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

#include <scifi/geometry/mice.hpp>
#include <scifi/io/truth_reader.hpp>

using namespace scifi;

namespace {

const std::string header = "event,track,pdg,tracker,station,plane,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV\n";

}  // namespace

TEST_CASE("crossings are read event by event, packed too", "[io]") {
  const detector d = mice::trackers();
  const test::temporary_folder folder;
  const std::string text = header + "3,1,-13,1,1,0,1.5,2,0,10,20,200\n3,1,-13,1,1,1,1.6,2,0.65,10,20,-199\n4,2,11,0,5,2,0,0,1101,1,2,150\n";
  for (const std::string& content : {text, test::gzip(text)}) {
    truth_reader reader(folder.file("truth.csv", content), d);
    std::vector<crossing> crossings;
    CHECK(reader.next_event() == 3);
    reader.read(3, crossings);
    REQUIRE(crossings.size() == 2);
    CHECK(crossings[0].pdg_id == -13);
    CHECK(crossings[0].position == vector<double, 3>(1.5, 2.0, 0.0));
    CHECK(crossings[1].momentum == vector<double, 3>(10.0, 20.0, -199.0));
    reader.read(4, crossings);
    REQUIRE(crossings.size() == 1);
    CHECK(crossings[0].station == 5);
    reader.read(5, crossings);
    CHECK(crossings.empty());
  }
}

TEST_CASE("what cannot be a crossing is refused with line and column", "[io]") {
  const detector d = mice::trackers();
  const test::temporary_folder folder;
  const auto message = [&](const std::string& row) {
    const auto path = folder.file("truth.csv", header + row + "\n");
    return test::without(path.string(), test::message_of<input_error>([&] {
                           std::vector<crossing> crossings;
                           truth_reader(path, d).read(3, crossings);
                         }));
  };
  CHECK(message("3,1,-13,2,1,0,1.5,2,0,10,20,200") == ":2: tracker: there is no tracker 2");
  CHECK(message("3,1,-13,1,6,0,1.5,2,0,10,20,200") == ":2: plane: there is no plane 0 in station 6 of tracker 1");
  CHECK(message("3,1,-13,1,1,3,1.5,2,0,10,20,200") == ":2: plane: there is no plane 3 in station 1 of tracker 1");
  CHECK(message("3,1,-13,1,1,0,1.5,2,0,10,20,0") == ":2: pz_MeV: a particle that crosses a plane has a momentum along z");
  CHECK(message("3,1,-13,1,1,0,1.5,nan,0,10,20,1") == ":2: y_mm: 'nan' is not a finite number");
}
