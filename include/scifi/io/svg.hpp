// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include <scifi/io/fixed_point.hpp>

namespace scifi {

/// The text of an SVG drawing (SVG 1.1, W3C 2011), element by element. Coordinates in pixels, y downwards. `style` is put into each element
/// as it is: attributes such as `stroke="black"`.
class svg {
 public:
  svg(double width, double height) {
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width) + "\" height=\"" + number(height) + "\" viewBox=\"0 0 " + number(width) + ' ' +
           number(height) + "\" font-family=\"Helvetica, Arial, sans-serif\">\n";
    rectangle(0.0, 0.0, width, height, "fill=\"white\"");
  }

  void line(double x1, double y1, double x2, double y2, std::string_view style) {
    element("<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) + "\" ", style);
  }
  void rectangle(double x, double y, double width, double height, std::string_view style) {
    element("<rect x=\"" + number(x) + "\" y=\"" + number(y) + "\" width=\"" + number(width) + "\" height=\"" + number(height) + "\" ", style);
  }
  void circle(double x, double y, double radius, std::string_view style) {
    element("<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"" + number(radius) + "\" ", style);
  }
  /// A line with a head at its end; `colour` as in CSS.
  void arrow(double x1, double y1, double x2, double y2, const std::string& colour, double width = 1.2) {
    const double length = std::hypot(x2 - x1, y2 - y1);
    if (!(length > 0.0)) return;
    constexpr double head = 8.0;
    constexpr double half = 3.0;
    const double ux = (x2 - x1) / length;
    const double uy = (y2 - y1) / length;
    line(x1, y1, x2 - 0.8 * head * ux, y2 - 0.8 * head * uy, "stroke=\"" + colour + "\" stroke-width=\"" + number(width) + '"');
    const auto corner = [&](double side) { return number(x2 - head * ux - side * uy) + ',' + number(y2 - head * uy + side * ux); };
    element("<polygon points=\"" + number(x2) + ',' + number(y2) + ' ' + corner(half) + ' ' + corner(-half) + "\" ", "fill=\"" + colour + '"');
  }
  /// Text whose base line begins, ends or has its middle (`anchor`: start, end, middle) at a point. Reserved characters are escaped.
  void text(double x, double y, std::string_view words, std::string_view anchor = "start", std::string_view style = "font-size=\"11\"") {
    out_ += "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + std::string(anchor) + "\" " + std::string(style) + '>' + escaped(words) +
            "</text>\n";
  }

  /// The whole drawing.
  [[nodiscard]] std::string finish() const { return out_ + "</svg>\n"; }

  /// A number as in attributes: at most two decimals.
  [[nodiscard]] static std::string number(double x) {
    std::string out;
    append_fixed(out, x, 2);
    while (out.ends_with('0')) out.pop_back();
    if (out.ends_with('.')) out.pop_back();
    return out;
  }
  [[nodiscard]] static std::string escaped(std::string_view words) {
    std::string out;
    for (const char c : words) {
      if (c == '&') out += "&amp;";
      else if (c == '<') out += "&lt;";
      else if (c == '>') out += "&gt;";
      else if (c == '"') out += "&quot;";
      else if (static_cast<unsigned char>(c) >= 0x20) out += c;
    }
    return out;
  }

 private:
  void element(std::string begin, std::string_view style) { out_ += begin + std::string(style) + "/>\n"; }

  std::string out_;
};

}  // namespace scifi
