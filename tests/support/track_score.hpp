// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <scifi/event/event.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/track_model/helix_state.hpp>

#include "support/sample.hpp"

namespace scifi::test {

/// Edges of the bins in true pt, MeV/c.
inline constexpr std::array<double, 10> pt_edges{0, 2, 5, 10, 20, 30, 40, 50, 70, 90};

/// Found of expected.
struct share {
  long expected = 0;
  long found = 0;
  [[nodiscard]] double value() const { return static_cast<double>(found) / static_cast<double>(std::max(expected, 1L)); }
  [[nodiscard]] double error() const { return error_of_share(value(), std::max(expected, 1L)); }
};

/// Compares reconstructed tracks with what really flew.
///
/// Expected: all three planes of at least four stations, station 1 among them, within 150 mm of the axis, pt/pz < 0.5 at the reference surface (plane 0 of
/// station 1). Matched: within 6 mm in (x, y) and, in a field, 25 MeV/c in (px, py) there, nearest first, each used once. A track that matches nothing is a
/// ghost, unless a particle that is not expected is there. Residuals, pulls and chi2 are those of matched tracks with five stations.
class track_score {
 public:
  explicit track_score(bool bent) : bent_(bent) {}

  share all, charge_above_5;
  std::array<share, pt_edges.size() - 1> by_pt;
  long events = 0, tracks = 0, ghosts = 0, failed = 0;
  sample x, y, tx, ty, pt, pz, chi2_per_ndf;
  std::array<sample, 5> pull;              // as momentum_state
  std::array<sample, 2> slope_pull;        // tx, ty
  std::array<sample, pt_edges.size() - 1> pt_in, pz_in;

  /// One event: the crossings of its particles and what was reconstructed.
  void add(std::span<const crossing> truth, const event& e) {
    ++events;
    std::map<std::pair<int, int>, particle_seen> seen;  // by tracker and particle
    for (const crossing& c : truth) seen[{c.tracker, c.particle}].add(c);
    std::set<int> trackers;
    for (const track& t : e.tracks) trackers.insert(t.tracker);
    for (const auto& [key, p] : seen) trackers.insert(key.first);
    for (const int tracker : trackers) add_tracker(tracker, seen, e);
  }

  [[nodiscard]] double ghosts_per_event() const { return static_cast<double>(ghosts) / static_cast<double>(std::max(events, 1L)); }
  [[nodiscard]] double ghosts_per_expected() const { return static_cast<double>(ghosts) / static_cast<double>(std::max(all.expected, 1L)); }

 private:
  struct particle_seen {
    bool at_reference = false;
    crossing reference;
    std::map<int, int> inside;  // planes within the fiducial radius, by station

    void add(const crossing& c) {
      constexpr double fiducial_radius = 150.0;
      if (c.station == 1 && c.plane == 0) {
        at_reference = true;
        reference = c;
      }
      if (std::hypot(c.position.x(), c.position.y()) < fiducial_radius) ++inside[c.station];
    }
    [[nodiscard]] int stations() const {
      return static_cast<int>(std::count_if(inside.begin(), inside.end(), [](const auto& s) { return s.second == 3; }));
    }
    [[nodiscard]] double pt() const { return std::hypot(reference.momentum.x(), reference.momentum.y()); }
    [[nodiscard]] bool expected() const {
      const auto first = inside.find(1);
      return stations() >= 4 && first != inside.end() && first->second == 3 && pt() < 0.5 * std::abs(reference.momentum.z());
    }
  };

  void add_tracker(int tracker, const std::map<std::pair<int, int>, particle_seen>& seen, const event& e) {
    std::vector<const particle_seen*> real;
    for (const auto& [key, p] : seen)
      if (key.first == tracker && p.at_reference) real.push_back(&p);
    std::vector<const track*> found;
    for (const track& t : e.tracks) {
      if (t.tracker != tracker) continue;
      ++tracks;
      if (!t.status.ok()) {
        ++failed;
        continue;
      }
      found.push_back(&t);
    }
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < real.size(); ++i) {
      for (std::size_t j = 0; j < found.size(); ++j) {
        const auto& m = found[j]->reference.mean;
        const crossing& at = real[i]->reference;
        const double dr = std::hypot(m[momentum_state::x] - at.position.x(), m[momentum_state::y] - at.position.y());
        const double dp = bent_ ? std::hypot(m[momentum_state::px] - at.momentum.x(), m[momentum_state::py] - at.momentum.y()) : 0.0;
        if (dr < 6.0 && dp < 25.0) pairs.emplace_back(dr / 0.5 + dp, i, j);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<const track*> match(real.size(), nullptr);
    std::vector<char> used(found.size(), 0);
    for (const auto& [distance, i, j] : pairs) {
      if (match[i] != nullptr || used[j]) continue;
      match[i] = found[j];
      used[j] = 1;
    }
    ghosts += std::count(used.begin(), used.end(), 0);
    for (std::size_t i = 0; i < real.size(); ++i)
      if (real[i]->expected()) add_expected(*real[i], match[i]);
  }

  void add_expected(const particle_seen& p, const track* t) {
    const auto bin = static_cast<std::size_t>(std::upper_bound(pt_edges.begin(), pt_edges.end(), p.pt()) - pt_edges.begin()) - 1;
    const auto count = [t](share& s) {
      ++s.expected;
      s.found += t != nullptr;
    };
    count(all);
    if (bin < by_pt.size()) count(by_pt[bin]);
    if (t == nullptr || p.stations() != 5) return;
    using s = momentum_state;
    const crossing& at = p.reference;
    vector<double, 5> truth;
    truth << at.position.x(), at.position.y(), at.momentum.x(), at.momentum.y(), at.momentum.z();
    const auto& m = t->reference.mean;
    x.add(m[s::x] - truth[s::x]);
    y.add(m[s::y] - truth[s::y]);
    tx.add(m[s::px] / m[s::pz] - truth[s::px] / truth[s::pz]);
    ty.add(m[s::py] / m[s::pz] - truth[s::py] / truth[s::pz]);
    slope_pull[0].add((m[s::px] - truth[s::px] / truth[s::pz] * m[s::pz]) / kalman::sigma(t->reference, s::px));
    slope_pull[1].add((m[s::py] - truth[s::py] / truth[s::pz] * m[s::pz]) / kalman::sigma(t->reference, s::py));
    const double dpt = (m[s::px] * truth[s::px] + m[s::py] * truth[s::py]) / p.pt() - p.pt();
    const double dpz = std::abs(m[s::pz]) - std::abs(truth[s::pz]);
    pt.add(dpt);
    pz.add(dpz);
    if (bin < pt_in.size()) {
      pt_in[bin].add(dpt);
      pz_in[bin].add(dpz);
    }
    for (int i = 0; i < 5; ++i) pull[static_cast<std::size_t>(i)].add((m[i] - truth[i]) / kalman::sigma(t->reference, i));
    if (t->ndf > 0) chi2_per_ndf.add(t->chi2 / t->ndf);
    const auto species = particle_from_pdg(at.pdg_id);
    if (species && p.pt() > 5.0) {
      ++charge_above_5.expected;
      charge_above_5.found += t->charge == species->charge;
    }
  }

  bool bent_;
};

}  // namespace scifi::test
