// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/core/units.hpp>
#include <scifi/io/input_error.hpp>
#include <scifi/io/mice_expression.hpp>

namespace scifi {

/// What a number of a MiceModules file measures. The field is in `units::tesla`.
enum class mice_quantity { length, angle, field };

/// Size of a unit of this quantity in the library's units, or nothing when the quantity has no such unit.
[[nodiscard]] inline std::optional<double> mice_unit(mice_quantity quantity, std::string_view unit) {
  struct known_unit {
    mice_quantity quantity;
    std::string_view name;
    double size;
  };
  using enum mice_quantity;
  static constexpr std::array known{
      known_unit{length, "um", units::um},      known_unit{length, "mm", units::mm},        known_unit{length, "cm", units::cm},
      known_unit{length, "m", units::m},        known_unit{angle, "degree", units::degree}, known_unit{angle, "deg", units::degree},
      known_unit{angle, "mrad", units::mrad},   known_unit{angle, "rad", units::rad},       known_unit{angle, "radian", units::rad},
      known_unit{field, "tesla", units::tesla}, known_unit{field, "T", units::tesla}};
  for (const known_unit& u : known)
    if (u.quantity == quantity && u.name == unit) return u.size;
  return std::nullopt;
}

/// A Property* line of a module: the words after the name, and where it stands. What is asked for and is not there throws input_error.
struct mice_property {
  std::string keyword, name, file;
  long line = 0;
  std::vector<std::string> words;

  [[noreturn]] void fail(std::string reason) const { throw input_error(file, line, name.empty() ? keyword : keyword + ' ' + name, std::move(reason)); }

  [[nodiscard]] const std::string& text() const {
    if (words.size() != 1) fail("is not one word");
    return words.front();
  }
  /// A plain number.
  [[nodiscard]] double number() const {
    if (words.size() != 1) fail(words.empty() ? "the line is too short: it needs a number" : "is not one number without a unit");
    return number_at(0);
  }
  /// A whole number from `lowest` to `highest`.
  [[nodiscard]] int whole_number(int lowest, int highest) const {
    const double x = number();
    if (x != std::floor(x)) fail(in_quotes(words[0]) + " is not a whole number");
    if (x < lowest || x > highest) fail(in_quotes(words[0]) + " is outside " + std::to_string(lowest) + " .. " + std::to_string(highest));
    return static_cast<int>(x);
  }
  /// `count` numbers and their unit, in the library's units.
  [[nodiscard]] std::vector<double> quantities(mice_quantity quantity, std::size_t count) const {
    if (words.size() < count || (words.size() == count && !mice_expression(words.back())))
      fail("the line is too short: it needs " + std::to_string(count) + (count == 1 ? " number" : " numbers") + " and a unit");
    if (words.size() == count) fail("is without a unit");
    if (words.size() > count + 1) fail("the line is too long: " + in_quotes(words[count + 1]) + " is not expected");
    const std::optional<double> unit = mice_unit(quantity, words[count]);
    if (!unit) fail(in_quotes(words[count]) + wrong_unit(quantity));
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(number_at(i) * *unit);
    return out;
  }
  /// A length above zero, mm.
  [[nodiscard]] double positive_length() const {
    const double x = quantities(mice_quantity::length, 1)[0];
    if (!(x > 0.0)) fail(in_quotes(words[0]) + " is not above zero");
    return x;
  }

 private:
  [[nodiscard]] double number_at(std::size_t i) const {
    const std::optional<double> x = mice_expression(words[i]);
    if (!x) fail(in_quotes(words[i]) + " is not a number");
    return *x;
  }
  [[nodiscard]] static const char* wrong_unit(mice_quantity quantity) {
    switch (quantity) {
      case mice_quantity::length: return " is not a unit of length (um, mm, cm, m)";
      case mice_quantity::angle: return " is not a unit of angle (degree, mrad, rad)";
      case mice_quantity::field: break;
    }
    return " is not a unit of the field (tesla)";
  }
};

/// A module of the experiment's geometry: a volume in its parent's frame, with properties and modules inside.
struct mice_module {
  std::string name, file;
  long line = 0;
  std::string volume;                                      ///< "Cylinder", "Tube", "Box", "None", ... or empty
  std::vector<double> dimensions;                          ///< mm: radius and length of a cylinder, inner and outer radius and length of a tube
  vector<double, 3> position = vector<double, 3>::Zero();  ///< of the origin in the parent's frame, mm
  matrix<double, 3, 3> parent_to_child = matrix<double, 3, 3>::Identity();  ///< passive: child = parent_to_child (parent - position)
  double scale_factor = 1.0;                                                ///< of the field that the module makes
  bool missing = false;                                                     ///< refers to a file that is not there and is described nowhere else
  std::map<std::string, mice_property, std::less<>> properties;
  std::vector<mice_module> children;

  [[noreturn]] void fail(std::string reason) const { throw input_error(file, line, "Module " + name, std::move(reason)); }

  /// The property of this name, or nullptr.
  [[nodiscard]] const mice_property* find(std::string_view property) const {
    const auto found = properties.find(property);
    return found == properties.end() ? nullptr : &found->second;
  }
  /// The property of this name. Throws input_error when the module does not have it.
  [[nodiscard]] const mice_property& at(std::string_view property) const {
    const mice_property* const found = find(property);
    if (found == nullptr) fail("has no property " + std::string(property));
    return *found;
  }
  /// True when the property is there and is this word.
  [[nodiscard]] bool has(std::string_view property, std::string_view word) const {
    const mice_property* const found = find(property);
    return found != nullptr && found->words.size() == 1 && found->words.front() == word;
  }
};

}  // namespace scifi
