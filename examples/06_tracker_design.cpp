// SPDX-License-Identifier: MPL-2.0
// What could a fibre tracker know of a muon if its field, the distance of its stations or the width of its channels were different? No track is simulated and
// none is fitted: the Fisher information of measurements and materials along a track gives the resolution that no fit can beat.
//
//   06_tracker_design [table.csv]      scripts/plot_tracker_design.py table.csv design.png
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <scifi/core/constants.hpp>
#include <scifi/core/random.hpp>
#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/information/mixture_spread.hpp>
#include <scifi/information/track_bound.hpp>
#include <scifi/material/highland.hpp>

namespace {

using scifi::momentum_state;

/// The downstream tracker of MICE with its stations `stretch` times as far apart and `fibres` fibres in a channel.
scifi::tracker design(double stretch, int fibres) {
  scifi::fibre_doublet doublet;
  doublet.fibres_per_channel = fibres;
  std::vector<scifi::vector<double, 3>> origins;
  for (const double z : {0.0, 200.0, 450.0, 750.0, 1100.0}) origins.emplace_back(0.0, 0.0, stretch * z);
  return scifi::mice::fibre_tracker(scifi::mice::downstream, "design", 1, origins, doublet);
}

/// Resolutions at the reference surface: spreads over many muons of 200 MeV/c along z.
struct resolution {
  double x, pt, pz;  // mm, MeV/c, MeV/c
};

resolution resolution_of(const scifi::tracker& t, double tesla, double pt) {
  // [bound]
  const auto bound = scifi::make_track_bound(t, tesla * scifi::units::tesla);
  std::vector<double> x, transverse, along;
  for (std::uint64_t i = 0; i < 400; ++i) {
    scifi::random_stream random(6, i, 0);
    const double r = 40.0 * std::sqrt(random.uniform());
    const double place = random.uniform(0.0, 2.0 * scifi::constants::pi);
    const double direction = random.uniform(0.0, 2.0 * scifi::constants::pi);
    scifi::vector<double, 5> truth;
    truth << r * std::cos(place), r * std::sin(place), pt * std::cos(direction), pt * std::sin(direction), 200.0;
    const scifi::reference_bound best = bound(truth, +1);
    x.push_back(scifi::kalman::sigma(best.momentum, momentum_state::x));
    transverse.push_back(best.pt);
    along.push_back(scifi::kalman::sigma(best.momentum, momentum_state::pz));
  }
  return {scifi::mixture_spread(x), scifi::mixture_spread(transverse), scifi::mixture_spread(along)};
  // [bound]
}

int failures = 0;

void check(const char* what, bool true_of_it) {
  if (!true_of_it) ++failures;
  std::printf("%-88s %s\n", what, true_of_it ? "yes" : "NO");
}

}  // namespace

int main(int argc, char** argv) {
  constexpr double field = 3.0;
  std::string table = "scan,value,pt_MeV,sigma_x_mm,sigma_pt_MeV,sigma_pz_MeV\n";
  const auto add = [&table](const char* scan, double value, double pt, const resolution& r) {
    char line[160];
    std::snprintf(line, sizeof line, "%s,%g,%g,%.5f,%.5f,%.5f\n", scan, value, pt, r.x, r.pt, r.pz);
    table += line;
  };
  for (const double pt : {10.0, 30.0, 50.0}) {
    for (const double tesla : {1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0}) add("field_tesla", tesla, pt, resolution_of(design(1.0, 7), tesla, pt));
    for (const double stretch : {0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0}) add("station_stretch", stretch, pt, resolution_of(design(stretch, 7), field, pt));
    for (const int fibres : {1, 2, 3, 5, 7, 10, 14}) add("channel_width_mm", 0.2135 * fibres, pt, resolution_of(design(1.0, fibres), field, pt));
  }
  if (argc > 1) {
    std::ofstream out(argv[1]);
    out << table;
    if (!out.flush()) {
      std::fprintf(stderr, "%s: cannot be written\n", argv[1]);
      return 2;
    }
  } else {
    std::fputs(table.c_str(), stdout);
  }

  const resolution now = resolution_of(design(1.0, 7), field, 30.0);
  const resolution fine = resolution_of(design(1.0, 1), field, 30.0);
  const resolution strong = resolution_of(design(1.0, 7), 2.0 * field, 30.0);
  // Highland's angle of one station times p: what no measurement behind the station undoes.
  const double p = std::hypot(30.0, 200.0);
  double layer = 0.0;
  const scifi::tracker usual = design(1.0, 7);
  for (const auto& plane : usual.stations[0].planes) layer += (radiation_lengths(plane.below) + radiation_lengths(plane.above)) * p / 200.0;
  const double station = p * std::sqrt(scifi::highland_variance(p, scifi::muon_plus, layer, layer));
  std::printf("3 T, pt 30 MeV/c: x %.3f mm, pt %.3f MeV/c (scattering in station 1 alone %.3f), pz %.2f MeV/c\n", now.x, now.pt, station, now.pz);
  check("twice the field halves the error of pz, within 15 %", std::abs(2.0 * strong.pz / now.pz - 1.0) < 0.15);
  check("pt cannot be known better than station 1 scatters", now.pt > station);
  check("seven times finer channels make x four times better or more", fine.x < now.x / 4.0);
  check("but pt gains less than a quarter: scattering holds it", fine.pt > 0.75 * now.pt);
  return failures == 0 ? 0 : 1;
}
