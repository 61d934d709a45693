// SPDX-License-Identifier: MPL-2.0
// Inside a host framework: a module with `process(event)`, as the event loops of Geant4, ROOT or Gaudi call it, one module a thread. The host keeps its own
// event and its own digits, and nothing of them is copied. Fails where a track differs from what the chain makes of its own event.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

// What the host has, written before anyone thought of this library.
namespace host {

struct fibre_signal {
  std::int16_t detector, layer, channel;  // layer = 3 station + plane
  float photons;
};

struct reconstructed {  // a part of the event that modules add to it
  std::vector<scifi::cluster> clusters;
  std::vector<scifi::space_point> points;
  std::vector<scifi::candidate> candidates;
  std::vector<scifi::track> tracks;
  std::vector<scifi::track_point> track_points;
  scifi::event_flags flags;
};

struct run_event {
  std::vector<fibre_signal> signals;
  reconstructed tracking;
};

class module {
 public:
  virtual ~module() = default;
  virtual void process(run_event& e) = 0;
};

}  // namespace host

// [digit]
namespace host {  // beside the host's own type, where the chain finds them

inline scifi::channel_id channel_of(const fibre_signal& s) { return {s.detector, s.layer / 3, s.layer % 3, s.channel}; }
inline double light_of(const fibre_signal& s) { return static_cast<double>(s.photons); }

}  // namespace host
static_assert(scifi::digit_record<host::fibre_signal>);
// [digit]

// [event]
/// The host's event under the names that the chain knows: references, no copy.
struct seen_by_chain {
  std::vector<host::fibre_signal>& digits;
  std::vector<scifi::cluster>& clusters;
  std::vector<scifi::space_point>& space_points;
  std::vector<scifi::candidate>& candidates;
  std::vector<scifi::track>& tracks;
  std::vector<scifi::track_point>& track_points;
  scifi::event_flags& flags;

  explicit seen_by_chain(host::run_event& e)
      : digits(e.signals), clusters(e.tracking.clusters), space_points(e.tracking.points), candidates(e.tracking.candidates), tracks(e.tracking.tracks),
        track_points(e.tracking.track_points), flags(e.tracking.flags) {}
};
static_assert(scifi::event_record<seen_by_chain>);
// [event]

// [module]
/// One for each thread of the host. The chain is const and shared; what a thread works in is its own.
class fibre_tracking final : public host::module {
 public:
  using chain = scifi::standard_reconstruction<>;  // in a uniform field

  explicit fibre_tracking(std::shared_ptr<const chain> shared) : chain_(std::move(shared)) {}

  void process(host::run_event& e) override {
    seen_by_chain view(e);
    (*chain_)(view, work_);
  }

 private:
  std::shared_ptr<const chain> chain_;
  chain::buffers work_;
};
// [module]

namespace {

/// Two muons in each tracker, as the host and as this library would keep them.
void simulate(const scifi::detector& mice, double field, std::uint64_t number, host::run_event& theirs, scifi::event& ours) {
  scifi::transport_settings settings;
  settings.field = field;
  scifi::flat_beam beam;
  beam.radius = 60.0;
  beam.pt_max = 50.0;
  for (const scifi::tracker& t : mice.trackers) {
    const scifi::transport fly(t, settings, scifi::coulomb_scattering{}, scifi::collision_loss{});
    scifi::random_stream random(10, number, static_cast<std::uint32_t>(t.id));
    scifi::truth truth;
    truth.last_particle = 2;
    for (int particle = 1; particle <= 2; ++particle) fly(beam.shoot(t, random), particle, random, truth);
    std::vector<scifi::raw_digit> read_out;
    scifi::digitiser<>{}(t, truth.hits, random, read_out);
    for (const scifi::raw_digit& raw : read_out) {
      const scifi::digit d = raw.seen();
      const auto small = [](int i) { return static_cast<std::int16_t>(i); };
      const auto photons = static_cast<float>(d.npe);
      theirs.signals.push_back({small(d.id.tracker), small(3 * d.id.station + d.id.plane), small(d.id.channel), photons});
      ours.digits.push_back({d.id, static_cast<double>(photons)});
    }
  }
}

bool same(const scifi::track& a, const scifi::track& b) {
  return a.tracker == b.tracker && a.charge == b.charge && a.planes == b.planes && a.chi2 == b.chi2 && a.reference.mean == b.reference.mean &&
         a.reference.covariance == b.reference.covariance;
}

}  // namespace

int main() {
  const scifi::detector mice = scifi::mice::trackers();
  scifi::reconstruction_options options;
  options.field = 3.0 * scifi::units::tesla;

  constexpr std::size_t events = 40, threads = 2;
  std::array<host::run_event, events> theirs;
  std::array<scifi::event, events> ours;
  for (std::size_t i = 0; i < events; ++i) simulate(mice, options.field, i, theirs[i], ours[i]);

  // [threads]
  const auto chain = std::make_shared<const fibre_tracking::chain>(scifi::make_reconstruction(mice, options));
  std::vector<std::thread> workers;
  for (std::size_t worker = 0; worker < threads; ++worker)
    workers.emplace_back([&theirs, worker, module = fibre_tracking(chain)]() mutable {
      for (std::size_t i = worker; i < events; i += threads) module.process(theirs[i]);
    });
  for (std::thread& w : workers) w.join();
  // [threads]

  std::size_t tracks = 0;
  for (std::size_t i = 0; i < events; ++i) {
    (*chain)(ours[i]);
    const std::vector<scifi::track>& found = theirs[i].tracking.tracks;
    bool all_same = found.size() == ours[i].tracks.size();
    for (std::size_t t = 0; all_same && t < found.size(); ++t) all_same = same(found[t], ours[i].tracks[t]);
    if (!all_same) {
      std::printf("event %zu: the host's event does not have the tracks that the chain finds in its own\n", i);
      return 1;
    }
    tracks += found.size();
  }
  std::printf("%zu events on %zu threads: %zu tracks of %zu muons\n", events, threads, tracks, 4 * events);
  return 10 * tracks >= 9 * 4 * events ? 0 : 1;
}
