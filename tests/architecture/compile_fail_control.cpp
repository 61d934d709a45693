// SPDX-License-Identifier: MPL-2.0
// expect: nothing, for this file compiles; the check of compile-fail cases must notice
#include <scifi/core/linalg.hpp>

scifi::matrix<double, 2, 2> half(const scifi::matrix<double, 2, 2>& m);

scifi::matrix<double, 2, 2> half(const scifi::matrix<double, 2, 2>& m) { return 0.5 * scifi::symmetrised(m); }
