// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/fixed_point.hpp>
#include <scifi/io/svg.hpp>

namespace scifi {

namespace detail {

/// Colours that stay apart for colour-blind readers (Okabe and Ito 2008), one a plane.
[[nodiscard]] inline std::string plane_colour(std::size_t plane) {
  constexpr std::array colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7"};
  return colours[plane % colours.size()];
}

/// A number for a label, with a minus sign as it is set in print.
[[nodiscard]] inline std::string label(double x, int decimals) {
  std::string text;
  append_fixed(text, x, decimals);
  return text.starts_with('-') ? "\u2212" + text.substr(1) : text;
}

/// Draws a geometry: planes from the front, stations from the side, a station along its fibres.
class geometry_drawing {
 public:
  geometry_drawing(const detector& d, const fibre_doublet& fibre)
      : detector_(d), fibre_(fibre), page_(width, side_top + side_height * static_cast<double>(d.trackers.size()) + 24.0) {}

  [[nodiscard]] std::string draw() {
    const tracker& first = detector_.trackers.front();
    draw_front(first.stations.front(), first);
    draw_station(first.stations.front());
    for (std::size_t i = 0; i < detector_.trackers.size(); ++i) draw_side(detector_.trackers[i], side_top + side_height * static_cast<double>(i), i);
    const double foot = side_top + side_height * static_cast<double>(detector_.trackers.size()) + 8.0;
    page_.text(0.5 * width, foot,
               std::string("Below a station: z and (x, y) of its origin in the tracker frame, mm. ") + (to_scale_ ? "To scale" : "To scale along z") +
                   " but for the distances of the planes",
               "middle");
    return page_.finish();
  }

 private:
  void heading(double x, double y, const std::string& words) { page_.text(x, y, words, "start", "font-size=\"14\" font-weight=\"bold\""); }

  /// Seen against +z: x to the right, y upwards.
  void draw_front(const station& s, const tracker& t) {
    constexpr double cx = 225.0;
    constexpr double cy = 228.0;
    constexpr double radius = 150.0;
    const double scale = radius / t.active_radius;
    heading(20.0, 26.0, "a\u2002Planes of a station, seen against +z");
    page_.circle(cx, cy, radius, R"(fill="#f7f7f7" stroke="black" stroke-width="1")");
    for (std::size_t i = 0; i < s.planes.size(); ++i) {
      const plane& p = s.planes[i];
      const std::string colour = plane_colour(i);
      const double c = std::cos(p.angle);
      const double n = std::sin(p.angle);
      constexpr int every = 10;
      for (int channel = 0; channel < p.channels; channel += every) {
        const double alpha = p.alpha(channel) * scale;
        if (std::abs(alpha) >= radius) continue;
        const double half = std::sqrt(radius * radius - alpha * alpha);
        page_.line(cx + alpha * c - half * n, cy - alpha * n - half * c, cx + alpha * c + half * n, cy - alpha * n + half * c,
                   "stroke=\"" + colour + "\" stroke-width=\"0.6\" stroke-opacity=\"0.55\"");
      }
      constexpr double reach = 1.12;
      page_.arrow(cx, cy, cx + reach * radius * c, cy - reach * radius * n, colour, 2.0);
      const double lx = cx + (reach + (c > 0.5 ? 0.03 : 0.1)) * radius * c;
      const double ly = cy - (reach + 0.1) * radius * n;
      const char* const anchor = c > 0.5 ? "start" : "middle";
      page_.text(lx, ly + 1.0, "\u03b1 of " + p.view, anchor, "font-size=\"13\" font-weight=\"bold\" fill=\"" + colour + '"');
      page_.text(lx, ly + 14.0, "channel 0", anchor, "font-size=\"10\" fill=\"" + colour + '"');
      const double far = 1.13 * radius;
      page_.text(cx - far * c, cy + far * n + 3.0, std::to_string(p.channels - 1), c > 0.5 ? "end" : "middle", "font-size=\"10\" fill=\"" + colour + '"');
    }
    page_.circle(cx, cy, t.fiducial_radius * scale, R"(fill="none" stroke="black" stroke-width="0.8" stroke-dasharray="5 3")");
    constexpr double ox = 40.0;
    constexpr double oy = 405.0;
    page_.arrow(ox, oy, ox + 32.0, oy, "black");
    page_.arrow(ox, oy, ox, oy - 32.0, "black");
    page_.text(ox + 36.0, oy + 4.0, "x");
    page_.text(ox - 3.0, oy - 37.0, "y");
    page_.text(cx, oy + 20.0, "Every tenth channel. Active to " + label(t.active_radius, 0) + " mm, dashed: fiducial to " + label(t.fiducial_radius, 0) + " mm",
               "middle");
  }

  /// A station in z, each plane along its own fibres, to scale. Circles where the sheets are the doublets of `fibre`.
  void draw_station(const station& s) {
    constexpr double left = 540.0;
    constexpr double bottom = 370.0;
    constexpr double height = 300.0;
    constexpr double w = 320.0;
    const plane& last = s.planes.back();
    const double depth = last.z_measured + thickness(last.above);
    const double scale = height / depth;
    const auto y_of = [&](double z) { return bottom - z * scale; };
    heading(500.0, 26.0, "b\u2002A station along its fibres");
    for (std::size_t i = 0; i < s.planes.size(); ++i) {
      const plane& p = s.planes[i];
      const std::string colour = plane_colour(i);
      double z = p.z_reference;
      for (const slab_stack<4>* stack : {&p.below, &p.above})
        for (const slab& sheet : *stack) {
          const bool sensitive = std::abs(z - p.z_measured) < 1e-9 || std::abs(z + sheet.thickness - p.z_measured) < 1e-9;
          page_.rectangle(left, y_of(z + sheet.thickness), w, sheet.thickness * scale,
                          sensitive ? "fill=\"" + colour + "\" fill-opacity=\"0.10\"" : std::string(R"(fill="#555555")"));
          z += sheet.thickness;
        }
      const bool doublet = std::abs(z - p.z_measured - 0.5 * fibre_.thickness()) < 0.01 * fibre_.thickness();
      if (doublet) draw_fibres(left, w, y_of(p.z_measured), scale, colour);
      page_.line(left - 4.0, y_of(p.z_measured), left + w + 4.0, y_of(p.z_measured), "stroke=\"" + colour + "\" stroke-width=\"1\" stroke-dasharray=\"4 3\"");
      page_.text(left - 40.0, y_of(p.z_measured) + 5.0, p.view, "end", "font-size=\"15\" font-weight=\"bold\" fill=\"" + colour + '"');
      page_.text(left + w + 10.0, y_of(p.z_measured) + 4.0, "z = " + label(p.z_measured, 3) + " mm");
      page_.text(left + w + 10.0, y_of(p.z_reference) - 2.0, "z = " + label(p.z_reference, 3) + " mm");
      if (doublet && i == 0) {
        const double x = left + 0.5 * w - 0.5 * fibre_.channel_width() * scale;
        page_.line(x, bottom + 8.0, x + fibre_.channel_width() * scale, bottom + 8.0, R"(stroke="black" stroke-width="1.5")");
        page_.text(left + 0.5 * w, bottom + 22.0,
                   "a channel: " + std::to_string(fibre_.fibres_per_channel) + " fibres, " + label(fibre_.channel_width(), 4) + " mm", "middle");
      }
    }
    page_.arrow(left - 22.0, bottom, left - 22.0, bottom - height, "black");
    page_.text(left - 30.0, bottom - height + 6.0, "z", "end");
    page_.text(left + 0.5 * w, 425.0, "Dark: sheets without read-out. Dashed: where \u03b1 is measured. Filled: fibre cores of a channel", "middle");
  }

  void draw_fibres(double left, double w, double y, double scale, const std::string& colour) {
    const double step = fibre_.step() * scale;
    const double middle = left + 0.5 * w;
    const int reach = static_cast<int>((0.5 * w - 0.5 * fibre_.diameter * scale) / step);
    for (int k = -reach; k <= reach; ++k) {
      const double row = (k % 2 == 0 ? -0.5 : 0.5) * fibre_.row_separation * scale;
      const bool lit = 2 * std::abs(k) < fibre_.fibres_per_channel;
      page_.circle(middle + k * step, y + row, 0.5 * fibre_.diameter * scale, "fill=\"white\" stroke=\"" + colour + "\" stroke-width=\"0.8\"");
      page_.circle(middle + k * step, y + row, 0.5 * fibre_.core_diameter * scale,
                   "fill=\"" + colour + "\" fill-opacity=\"" + (lit ? "0.75" : "0.15") + "\" stroke=\"none\"");
    }
  }

  /// Stations in z, to scale; the offsets of the survey are too small to be seen and are written.
  void draw_side(const tracker& t, double top, std::size_t number) {
    const station& first = t.stations.front();
    const station& last = t.stations.back();
    const double from = first.in_tracker.origin.z();
    const double span = std::max(last.in_tracker.origin.z() - from, 1.0);
    constexpr double left = 110.0;
    constexpr double right = width - 110.0;
    const double scale = (right - left) / span;
    const double axis = top + 154.0;
    constexpr double tallest = 116.0;
    const double half = std::min(t.active_radius * scale, tallest);
    to_scale_ = to_scale_ && half < tallest;
    const auto x_of = [&](double z) { return left + (z - from) * scale; };
    heading(20.0, top + 14.0,
            std::string(1, static_cast<char>('c' + number)) + "\u2002Tracker " + std::to_string(t.id) + (t.name.empty() ? "" : ", " + t.name));
    page_.line(left - 60.0, axis, right + 60.0, axis, R"(stroke="black" stroke-width="0.7" stroke-dasharray="9 3 2 3")");
    page_.arrow(right + 62.0, axis, right + 84.0, axis, "black");
    page_.text(right + 89.0, axis + 4.0, "z");
    const bool along = t.beam_direction > 0;
    const double beam_from = along ? left - 92.0 : right + 92.0;
    page_.arrow(beam_from, axis - 28.0, beam_from + (along ? 44.0 : -44.0), axis - 28.0, "#555555", 3.0);
    page_.text(beam_from + (along ? 22.0 : -22.0), axis - 36.0, "beam", "middle", R"(font-size="12" fill="#555555")");
    for (std::size_t i = 0; i < t.stations.size(); ++i) {
      const station& s = t.stations[i];
      const auto& o = s.in_tracker.origin;
      const double x = x_of(o.z());
      // The planes are closer than a line is thick: drawn side by side.
      constexpr double line_width = 2.4;
      for (std::size_t p = 0; p < s.planes.size(); ++p) {
        const double at = x + line_width * (static_cast<double>(p) - 0.5 * static_cast<double>(s.planes.size() - 1));
        page_.line(at, axis - half, at, axis + half, "stroke=\"" + plane_colour(p) + "\" stroke-width=\"" + svg::number(line_width) + '"');
      }
      page_.text(x, axis - half - 7.0, "station " + std::to_string(s.id), "middle", R"(font-size="12" font-weight="bold")");
      page_.text(x, axis + half + 15.0, "z = " + label(o.z(), 4), "middle");
      page_.text(x, axis + half + 29.0, "(" + label(o.x(), 4) + ", " + label(o.y(), 4) + ")", "middle", R"(font-size="11" fill="#555555")");
      if (i == 0) continue;
      const double before = x_of(t.stations[i - 1].in_tracker.origin.z());
      page_.text(0.5 * (x + before), axis - 6.0, label(o.z() - t.stations[i - 1].in_tracker.origin.z(), 4) + " mm", "middle",
                 R"(font-size="11" fill="#555555")");
    }
  }

  static constexpr double width = 1000.0;
  static constexpr double side_top = 455.0;
  static constexpr double side_height = 318.0;
  const detector& detector_;
  fibre_doublet fibre_;
  svg page_;
  bool to_scale_ = true;
};

}  // namespace detail

/// A detector as a drawing in SVG: the planes of station 1 of the first tracker from the front and along their fibres, and the stations of every tracker
/// from the side, to scale. `fibre` is drawn where the planes are as thick as its doublets. Empty for a detector without planes.
[[nodiscard]] inline std::string geometry_to_svg(const detector& d, const fibre_doublet& fibre = {}) {
  if (d.trackers.empty() || d.trackers.front().stations.empty() || d.trackers.front().stations.front().planes.empty()) return {};
  return detail::geometry_drawing(d, fibre).draw();
}

}  // namespace scifi
