// SPDX-License-Identifier: MPL-2.0
#include "exchanged.hpp"

double trace(const exchanged& from) { return from.covariance.trace(); }
