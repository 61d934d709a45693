// SPDX-License-Identifier: MPL-2.0
#include <memory>

#include "exchanged.hpp"

int main() {
  const auto one = std::make_unique<exchanged>();
  one->covariance = scifi::matrix<double, 4, 4>::Identity();
  return trace(*one) == 4.0 ? 0 : 1;
}
