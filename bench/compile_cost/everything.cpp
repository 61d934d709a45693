// SPDX-License-Identifier: MPL-2.0
// Compile cost of including the whole core of the library.
#include <scifi/scifi.hpp>
