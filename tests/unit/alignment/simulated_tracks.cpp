// SPDX-License-Identifier: MPL-2.0
#include "simulated_tracks.hpp"

#include <cmath>

#include <scifi/alignment/fit_equations.hpp>
#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/random.hpp>

#include "support/ideal_clusters.hpp"

namespace scifi::test {

struct tracks_of_chain::parts {
  using chain_type = standard_reconstruction<helix_propagator>;
  using collector = alignment::track_collector<standard_fitter<helix_propagator>>;

  parts(const alignment::tracker_parameters& where, double field, const alignment::track_cuts& cuts)
      : parameters(where),
        chain(make_reconstruction({{where.where()}}, {.field = field, .fibre = {}})),
        equations(chain.trackers().front().fit_track),
        collect(where, chain.trackers().front().fit_track, cuts) {}

  alignment::tracker_parameters parameters;
  chain_type chain;
  alignment::fit_equations<standard_fitter<helix_propagator>> equations;
  collector collect;
  chain_type::buffers reconstruction_work;
  collector::buffers collection_work;
};

tracks_of_chain::tracks_of_chain(const alignment::tracker_parameters& parameters, double field, const alignment::track_cuts& cuts)
    : parts_(std::make_shared<parts>(parameters, field, cuts)) {}
void tracks_of_chain::reconstruct(event& e) { parts_->chain(e, parts_->reconstruction_work); }
void tracks_of_chain::collect(const event& e, alignment::tracker_sum& sum) { parts_->collect(e, sum, parts_->collection_work); }
alignment::failure tracks_of_chain::equations(const event& e, const track& t, alignment::track_equations& out) {
  return parts_->equations(parts_->parameters, e, t, out, parts_->collection_work.fit);
}

std::vector<event> crossing_tracks(const tracker& t, double field, int count, std::uint64_t seed) {
  random_stream random(seed, 0, 0);
  std::vector<event> out;
  for (int i = 0; i < count; ++i) {
    vector<double, 5> start;
    const double pz = t.beam_direction * random.uniform(180.0, 240.0);
    const double slopes = field != 0.0 ? 0.15 : 0.02;
    start << random.uniform(-60.0, 60.0), slopes * random.normal(), random.uniform(-60.0, 60.0), slopes * random.normal(), 1.0 / pz;
    std::vector<cluster> clusters;
    add_ideal_track(t, start, field, clusters);
    event e;
    e.number = i;
    for (const cluster& c : clusters) e.digits.push_back({{c.tracker, c.station, c.plane, static_cast<int>(std::lround(c.channel))}, 10.0});
    out.push_back(e);
  }
  return out;
}

}  // namespace scifi::test
