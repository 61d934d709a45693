// SPDX-License-Identifier: MPL-2.0
#include "simulated_tracks.hpp"

namespace scifi::test {

void reconstruct(const standard_chain& chain, event& e) { chain(e); }

}  // namespace scifi::test
