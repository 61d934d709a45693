// SPDX-License-Identifier: MPL-2.0
// Clustering, space points, pattern recognition, the fit with its second looks, and the chain of all: warm, with the events handed back in, they ask operator new for nothing.
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

long news = 0;

// Not inlined: the compiler would see memory from new given to free.
[[gnu::noinline]] void* take(std::size_t size, std::size_t alignment) {
  ++news;
  if (void* const p = std::aligned_alloc(alignment, (size / alignment + 1) * alignment)) return p;
  throw std::bad_alloc{};
}
[[gnu::noinline]] void give_back(void* p) noexcept { std::free(p); }

}  // namespace

void* operator new(std::size_t size) { return take(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) { return take(size, static_cast<std::size_t>(alignment)); }
void operator delete(void* p) noexcept { give_back(p); }
void operator delete(void* p, std::size_t) noexcept { give_back(p); }
void operator delete(void* p, std::align_val_t) noexcept { give_back(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { give_back(p); }

// Eigen takes its memory from malloc and reports it, while that is forbidden, through its assertion, in release builds too.
namespace {
long eigen_complaints = 0;
}
#define EIGEN_RUNTIME_NO_MALLOC
#define eigen_assert(condition) static_cast<void>((condition) ? 0 : ++eigen_complaints)

#include "support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/track_model/helix_propagator.hpp>

using namespace scifi;

namespace {

/// Digits of one to five particles in each tracker, on helices; some crossings are blurred, so that some fits are bad and looked at again. Some noise.
std::vector<event> drawn(const detector& where, double field) {
  std::vector<event> events;
  for (std::uint64_t number = 0; number < 25; ++number) {
    event e;
    e.number = static_cast<long>(number);
    random_stream random(7, number, 0);
    for (const tracker& t : where.trackers) {
      const std::vector<surface> surfaces = surfaces_along(t, 1);
      const auto light = [&](const surface& s, double channel, double npe) {
        const channel_id id{t.id, s.station, s.plane, static_cast<int>(std::lround(channel))};
        if (where.find_plane(id)->has_channel(id.channel)) e.digits.push_back({id, npe});
      };
      for (std::uint64_t i = 0; i <= number % 5; ++i) {
        vector<double, 5> start;
        for (const int k : {slope_state::x, slope_state::y}) start[k] = random.uniform(-50.0, 50.0);
        for (const int k : {slope_state::tx, slope_state::ty}) start[k] = random.uniform(-0.1, 0.1);
        start[slope_state::q_over_pz] = 1.0 / random.uniform(150.0, 250.0);
        for (const surface& s : surfaces) {
          const vector<double, 5> at = helix_propagator{field}.propagate(start, s.z).state;
          const plane& p = *where.find_plane({t.id, s.station, s.plane, 0});
          light(s, p.channel_at(s.tracker_to_alpha(at[slope_state::x], at[slope_state::y])) + (i == 2 ? 0.5 * random.normal() : 0.0), 12.0);
        }
      }
      for (const surface& s : surfaces) light(s, random.uniform(0.0, 200.0), 2.5);
    }
    events.push_back(e);
  }
  return events;
}

void check(double field) {
  const detector where = mice::trackers();
  std::vector<event> events = drawn(where, field);
  reconstruction_options o;
  o.field = field;
  const auto chain = make_reconstruction(where, o);
  decltype(chain)::buffers work;
  const auto each_and_all = [&] {
    for (event& e : events) chain(e, work);
    chain(std::span(events), work);
  };
  each_and_all();

  Eigen::internal::set_is_malloc_allowed(false);
  const long before = news;
  each_and_all();
  const long after = news;
  Eigen::internal::set_is_malloc_allowed(true);

  CHECK(after == before);
  CHECK(eigen_complaints == 0);
  std::size_t tracks = 0, bad = 0;
  for (const event& e : events) {
    tracks += e.tracks.size();
    for (const track& t : e.tracks) bad += t.status.ok() && t.p_value < robust_refit{}.p_below ? 1u : 0u;
  }
  CHECK(tracks > 100);
  CHECK(bad > 0);
}

}  // namespace

TEST_CASE("the chain leaves the heap alone once it is warm", "[chain]") {
  check(3.0 * units::tesla);
  check(0.0);
}

TEST_CASE("the two counters of allocations see what they are there for", "[chain]") {
  const long before = news;
  ::operator delete(::operator new(1));
  ::operator delete(::operator new(64, std::align_val_t(64)), std::align_val_t(64));
  CHECK(news == before + 2);
  Eigen::internal::set_is_malloc_allowed(false);
  const Eigen::MatrixXd heap = Eigen::MatrixXd::Zero(3, 3);
  Eigen::internal::set_is_malloc_allowed(true);
  CHECK(eigen_complaints > 0);
  CHECK(heap(0, 0) == 0.0);
  eigen_complaints = 0;
}
