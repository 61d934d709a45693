// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/svg.hpp>

#include <string>

#include "support/catch.hpp"

TEST_CASE("a drawing is one svg element with what was drawn, in order", "[io]") {
  scifi::svg page(100.0, 50.5);
  page.line(1.0, 2.0, 3.25, -4.0, "stroke=\"red\"");
  page.circle(5.0, 6.0, 7.0, "fill=\"none\"");
  page.text(1.0, 2.0, "a < b & \"c\"", "end");
  page.arrow(0.0, 0.0, 10.0, 0.0, "black");
  page.arrow(4.0, 4.0, 4.0, 4.0, "blue");  // no length, no arrow
  const std::string drawing = page.finish();
  CHECK(drawing.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"50.5\" viewBox=\"0 0 100 50.5\""));
  CHECK(drawing.ends_with("</svg>\n"));
  const std::size_t line = drawing.find("<line x1=\"1\" y1=\"2\" x2=\"3.25\" y2=\"-4\" stroke=\"red\"/>");
  const std::size_t circle = drawing.find("<circle cx=\"5\" cy=\"6\" r=\"7\" fill=\"none\"/>");
  REQUIRE(line != std::string::npos);
  REQUIRE(circle != std::string::npos);
  CHECK(line < circle);
  CHECK(drawing.find("text-anchor=\"end\" font-size=\"11\">a &lt; b &amp; &quot;c&quot;</text>") != std::string::npos);
  CHECK(drawing.find("<polygon points=\"10,0 2,3 2,-3\" fill=\"black\"/>") != std::string::npos);
  CHECK(drawing.find("blue") == std::string::npos);
}

TEST_CASE("numbers are short and have two decimals at most", "[io]") {
  CHECK(scifi::svg::number(1.0) == "1");
  CHECK(scifi::svg::number(100.0) == "100");
  CHECK(scifi::svg::number(-0.001) == "0");
  CHECK(scifi::svg::number(2.345) == "2.35");
  CHECK(scifi::svg::number(-2.5) == "-2.5");
}
