// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <utility>
#include <variant>

#include <scifi/field/cartesian_map.hpp>
#include <scifi/field/cylindrical_map.hpp>

namespace scifi {

/// A map of either kind, as it comes from a file. Copies share the numbers.
class field_map {
 public:
  using either = std::variant<cylindrical_map<>, cartesian_map<>>;
  explicit field_map(either map) : map_(std::move(map)) {}

  template <single_number Scalar>
  [[nodiscard]] vector<Scalar, 3> operator()(const vector<Scalar, 3>& position) const {
    return with_gradient(position).value;
  }
  template <single_number Scalar>
  [[nodiscard]] field_and_gradient<Scalar> with_gradient(const vector<Scalar, 3>& position) const {
    if (const auto* const round = std::get_if<cylindrical_map<>>(&map_)) return round->with_gradient(position);
    return std::get_if<cartesian_map<>>(&map_)->with_gradient(position);
  }

  [[nodiscard]] const either& map() const { return map_; }

 private:
  either map_;
};

}  // namespace scifi
