// SPDX-License-Identifier: MPL-2.0
#pragma once

// Included before every benchmark: a timing taken with assertions measures the assertions.
#ifndef NDEBUG
#error "scifi: benchmarks must be built with NDEBUG defined; configure with the release preset or -DSCIFI_BUILD_BENCHMARKS=OFF"
#endif
