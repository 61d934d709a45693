// SPDX-License-Identifier: MPL-2.0
#include <string_view>

#include <scifi/io/particle_reader.hpp>

#include "fuzz/target.hpp"

namespace scifi::fuzz {

inline const registered particles_target("particles", [](std::string_view bytes) {
  const auto path = as_file(bytes);
  read_or_refuse([&] {
    for (const beam_event& e : read_particles(path, trackers()))
      for (const beam_particle& p : e.particles) {
        require(trackers().find(p.tracker) != nullptr, "a particle starts in a tracker");
        require(p.start.position.allFinite() && p.start.momentum.allFinite() && p.start.momentum.z() != 0.0, "a particle flies along z");
      }
  });
});

}  // namespace scifi::fuzz
