// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <scifi/core/units.hpp>
#include <scifi/field/coil_field.hpp>
#include <scifi/field/field_map.hpp>
#include <scifi/field/tabulate.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/field_map_reader.hpp>

/// The field in one tracker, in its frame.
struct tracker_field {
  double mean = 0.0;                    ///< of Bz on the axis from the first plane to the last, (MeV/c)/(e mm)
  std::optional<scifi::field_map> map;  ///< nothing: uniform
};

/// What a user says of the field, by --field and --field-outside, and what the geometry says where he does not.
class chosen_field {
 public:
  void offer(CLI::App& app) {
    app.add_option("--field", given_,
                   "field in the tracker frame: a number, tesla along z; a file with a field map; or 'coils', those of the geometry; unless given the number of the geometry, else 3");
    app.add_option("--field-outside", outside_, "field outside of a map: zero, nearest or error (the track ends)")->check(CLI::IsMember({"zero", "nearest", "error"}))->capture_default_str();
  }

  /// Reads what is to be read. Throws std::invalid_argument or scifi::input_error.
  void resolve(const scifi::detector& where, const scifi::any_geometry* geometry) {
    uniform_ = default_tesla * scifi::units::tesla;
    if (given_.empty()) {
      if (geometry != nullptr) uniform_ = geometry->common_field().value_or(uniform_);
    } else if (const auto number = number_in(given_)) {
      if (!std::isfinite(*number) || std::abs(*number) > largest_tesla) throw std::invalid_argument(fmt::format("--field: {} is not a number of tesla from -{} to {}", given_, largest_tesla, largest_tesla));
      uniform_ = *number * scifi::units::tesla;
    } else if (given_ != "coils") {
      if (std::error_code none; !std::filesystem::exists(given_, none)) throw std::invalid_argument("--field: '" + given_ + "' is neither a number of tesla nor 'coils' nor a file that exists");
      file_ = scifi::read_field_map(given_, outside_ == "zero" ? scifi::outside_map::zero : outside_ == "nearest" ? scifi::outside_map::nearest : scifi::outside_map::error);
      mapped_ = true;
    } else if (geometry == nullptr || geometry->coils.empty() || geometry->coils.front().empty()) {
      throw std::invalid_argument("--field coils: the geometry has no coils");
    } else {
      mapped_ = true;
    }
    for (std::size_t i = 0; i < where.trackers.size(); ++i) {
      const scifi::tracker& t = where.trackers[i];
      fields_.push_back({uniform_, std::nullopt});
      ids_.push_back(t.id);
      if (!mapped_) continue;
      fields_.back().map = file_ ? *file_ : map_of(geometry->coils[i], t);
      fields_.back().mean = mean_on_axis(*fields_.back().map, t);
    }
  }

  /// True where tracks fly through a map.
  [[nodiscard]] bool mapped() const { return mapped_; }
  /// True where there is no field: tracks are straight.
  [[nodiscard]] bool none() const { return !mapped_ && uniform_ == 0.0; }
  [[nodiscard]] const std::string& file() const { return given_; }  // a number or 'coils' is no file that exists
  [[nodiscard]] const tracker_field& in(const scifi::tracker& t) const { return fields_[static_cast<std::size_t>(std::find(ids_.begin(), ids_.end(), t.id) - ids_.begin())]; }

  /// As it was asked for.
  [[nodiscard]] std::string given() const { return given_.empty() ? description() : given_ == "coils" || number_in(given_) ? given_ : "a map, outside " + outside_; }

  /// "3 T", or the map and its mean in each tracker.
  [[nodiscard]] std::string description() const {
    if (!mapped_) return fmt::format("{} T", uniform_ / scifi::units::tesla);
    std::string means;
    for (const tracker_field& f : fields_) means += (means.empty() ? "" : ", ") + fmt::format("{:.4f} T", f.mean / scifi::units::tesla);
    return fmt::format("{}, mean {}", given_, means);
  }

 private:
  static constexpr double default_tesla = 3.0, largest_tesla = 100.0;

  [[nodiscard]] static std::optional<double> number_in(const std::string& text) {
    double value = 0.0;
    const char* const first = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
  }

  [[nodiscard]] static double last_z(const scifi::tracker& t) {
    const auto surfaces = scifi::surfaces_along(t, +1);
    return surfaces.empty() ? 0.0 : surfaces.back().z;
  }

  /// The coils as a map of the space that the planes look at, and somewhat more.
  [[nodiscard]] static scifi::field_map map_of(const std::vector<scifi::coil>& coils, const scifi::tracker& t) {
    constexpr double margin = 100.0, cell = 10.0, coarse_cell = 20.0;  // mm
    const scifi::coil_field field(coils);
    const double end = last_z(t) + margin;
    const auto along = [&](double step) { return scifi::grid_axis{-margin, step, static_cast<std::size_t>(std::ceil((end + margin) / step)) + 1}; };
    constexpr double close = 1e-6;
    const bool round = std::all_of(coils.begin(), coils.end(), [](const scifi::coil& c) { return std::hypot(c.axis.x(), c.axis.y()) < close && std::hypot(c.centre.x(), c.centre.y()) < close; });
    const double radius = t.active_radius + 0.25 * margin;
    if (round) return scifi::field_map(scifi::tabulated(field, {0.0, cell, static_cast<std::size_t>(std::ceil(radius / cell)) + 1}, along(cell), scifi::outside_map::error));
    const auto half = static_cast<std::size_t>(std::ceil(radius / coarse_cell));
    const scifi::grid_axis across{-coarse_cell * static_cast<double>(half), coarse_cell, 2 * half + 1};
    return scifi::field_map(scifi::tabulated(field, across, across, along(coarse_cell), scifi::outside_map::error));
  }

  [[nodiscard]] double mean_on_axis(const scifi::field_map& map, const scifi::tracker& t) const {
    constexpr int steps = 1000;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) sum += map(scifi::vector<double, 3>(0.0, 0.0, last_z(t) * (i + 0.5) / steps)).z();
    if (!std::isfinite(sum)) throw std::invalid_argument(fmt::format("{}: does not cover the axis of tracker {} from z = 0 to {:.1f} mm", given_, t.id, last_z(t)));
    return sum / steps;
  }

  std::string given_, outside_ = "error";
  double uniform_ = 0.0;
  bool mapped_ = false;
  std::optional<scifi::field_map> file_;
  std::vector<tracker_field> fields_;
  std::vector<int> ids_;
};
