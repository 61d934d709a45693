// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/geometry_svg.hpp>

#include <cstddef>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

namespace {

std::size_t count(std::string_view text, std::string_view part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

}  // namespace

TEST_CASE("the drawing names every station with its place and every plane with its view", "[io]") {
  const scifi::detector d = scifi::mice::trackers();
  const std::string drawing = scifi::geometry_to_svg(d);
  for (const char* words : {"Tracker 0, TKU", "Tracker 1, TKD", "1099.7578", "1099.9026", "(\u22120.5709, \u22120.7375)", "(0.1722, \u22120.2912)",
                            "200.8936 mm", "\u03b1 of V", "\u03b1 of W", "\u03b1 of U", "7 fibres, 1.4945 mm"})
    CHECK(drawing.find(words) != std::string::npos);
  CHECK(count(drawing, ">station ") == 10);
  CHECK(count(drawing, ">beam<") == 2);
  CHECK(count(drawing, ">213<") == 2);
  CHECK(count(drawing, ">211<") == 1);
}

TEST_CASE("the drawing of the stations is to scale", "[io]") {
  // Planes of station s are three lines; the middle one is at the station. Distances in pixels go as those in z.
  const scifi::detector d = scifi::mice::trackers();
  const std::string drawing = scifi::geometry_to_svg(d);
  const std::regex bar("<line x1=\"([0-9.]+)\" y1=\"([0-9.]+)\" x2=\"\\1\" y2=\"([0-9.]+)\" stroke=\"#D55E00\" stroke-width=\"2.4\"/>");
  std::vector<double> x;
  double height = 0.0;
  for (std::sregex_iterator i(drawing.begin(), drawing.end(), bar), end; i != end; ++i) {
    x.push_back(std::stod((*i)[1]));
    height = std::stod((*i)[3]) - std::stod((*i)[2]);
  }
  REQUIRE(x.size() == 10);
  for (std::size_t t = 0; t < 2; ++t) {
    const auto& stations = d.trackers[t].stations;
    const double scale = (x[5 * t + 4] - x[5 * t]) / stations[4].in_tracker.origin.z();
    for (std::size_t s = 0; s < 5; ++s) CHECK(x[5 * t + s] - x[5 * t] == Approx(scale * stations[s].in_tracker.origin.z()).margin(0.01));
    CHECK(height == Approx(2.0 * 160.0 * scale).epsilon(1e-3));
  }
}

TEST_CASE("planes that are no doublets of the fibre are drawn without fibres, and nothing gives nothing", "[io]") {
  scifi::detector d = scifi::mice::trackers();
  const std::size_t circles = count(scifi::geometry_to_svg(d), "<circle");
  CHECK(circles > 2 + 3 * 2 * 7);  // two radii, and fibres with their cores
  scifi::fibre_doublet thick;
  thick.diameter = 1.0;
  CHECK(count(scifi::geometry_to_svg(d, thick), "<circle") == 2);
  d.trackers.clear();
  CHECK(scifi::geometry_to_svg(d).empty());
}
