// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdio>
#include <cstdlib>

namespace scifi::detail {

/// Ends the use of a wrong configuration: throws Error(message). Compiled with -fno-exceptions it writes the message to the standard error and aborts.
template <class Error, class Message>
[[noreturn]] inline void refuse(const Message& message) {
#if defined(__cpp_exceptions)
  throw Error(message);
#else
  std::fprintf(stderr, "%s\n", Error(message).what());
  std::abort();
#endif
}

}  // namespace scifi::detail
