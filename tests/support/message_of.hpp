// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>

namespace scifi::test {

/// The message of the Error that `action` throws, or "(no error)".
template <class Error, class Action>
[[nodiscard]] std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "(no error)";
}

}  // namespace scifi::test
