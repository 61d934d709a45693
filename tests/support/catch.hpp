// SPDX-License-Identifier: MPL-2.0
#pragma once

// Catch2 3 or 2.13, whichever is installed; both spell TEST_CASE, CHECK, REQUIRE, SECTION and GENERATE alike.
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif
