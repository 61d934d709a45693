// SPDX-License-Identifier: MPL-2.0
// Five spills of the MICE experiment's own simulation, with the momenta that its own reconstruction finds.
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/io/mice_json.hpp>

#include "support/catch.hpp"
#include "support/shared_data.hpp"

using namespace scifi;

namespace {

/// The geometry of the file, TrackerTest.dat: stations without transverse offsets, and one plane that is a channel and a half off.
detector trackers_of_the_file() {
  detector d;
  d.trackers = {mice::fibre_tracker(mice::upstream, "TKU", -1, {{0, 0, 0}, {0, 0, 199.9646}, {0, 0, 449.8276}, {0, 0, 749.8279}, {0, 0, 1099.7578}}),
                mice::fibre_tracker(mice::downstream, "TKD", +1, {{0, 0, 0}, {0, 0, 200.0}, {0, 0, 450.0}, {0, 0, 750.0}, {0, 0, 1100.0}})};
  plane& shifted = d.trackers[0].stations[4].planes[2];
  shifted.central_channel = 107.0;
  shifted.channels = 215;
  return d;
}

/// (spill, tracker)
using key = std::pair<int, int>;

/// pt and pz (MeV/c) at the reference surface that MAUS fits to these digits; its fit fails for tracker 0 in spills 1 and 2.
const std::map<key, std::array<double, 2>> fitted_by_maus{{{3, 0}, {50.4, 172.4}}, {{4, 0}, {57.7, 174.1}}, {{5, 0}, {33.9, 184.1}}, {{1, 1}, {8.9, 201.4}},
                                                         {{2, 1}, {15.6, 186.6}}, {{3, 1}, {13.0, 181.3}}, {{4, 1}, {51.6, 175.4}}, {{5, 1}, {62.3, 177.9}}};

/// The simulated muon where it enters the first plane of station 1, as momentum_state at the reference surface in the frame of the digits.
///
/// The file holds global coordinates: the beam flies along +z. Tracker 0 is turned by 180 degrees about y against them, (x, z) -> (-x, -z). Moreover the channels of
/// the file count upwards with the coordinate where ours count downwards: the digits show the mirror image (x -> -x) of the muons, in the mirror image
/// of the field, which is +4 T along z of both trackers where the simulation had -4 T.
std::map<key, vector<double, 5>> simulated_muons(const std::filesystem::path& path) {
  constexpr std::array<double, 2> reference_z{1634.357, 4365.522};  // global, mm: outer mylar surface of station 1, from TrackerTest.dat
  std::map<key, vector<double, 5>> out;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const auto document = nlohmann::json::parse(line);
    if (!document.contains("recon_events")) continue;
    for (const auto& hit : document.at("mc_events").at(0).at("sci_fi_hits")) {
      const auto& id = hit.at("channel_id");
      const int tracker = id.at("tracker_number").get<int>();
      const key k{document.at("spill_number").get<int>(), tracker};
      if (hit.at("track_id") != 1 || id.at("station_number") != 1 || id.at("plane_number") != 0 || out.count(k) != 0) continue;
      const auto number = [&hit](const char* what, const char* axis) { return hit.at(what).at(axis).get<double>(); };
      const double dz = reference_z.at(static_cast<std::size_t>(tracker)) - number("position", "z");
      const double pz = number("momentum", "z");
      const double x = number("position", "x") + dz * number("momentum", "x") / pz;
      const double y = number("position", "y") + dz * number("momentum", "y") / pz;
      const double sign = tracker == mice::upstream ? 1.0 : -1.0;  // turned and mirrored, or only mirrored
      out[k] << sign * x, y, sign * number("momentum", "x"), number("momentum", "y"), tracker == mice::upstream ? -pz : pz;
    }
  }
  return out;
}

}  // namespace

TEST_CASE("the experiment's simulated spills are reconstructed as its own software does, and as they were simulated", "[integration]") {
  const auto data = test::shared_data();
  if (!data) return;
  const std::filesystem::path file = *data / "mice" / "test_helical_digits.json";
  const detector where = trackers_of_the_file();
  CHECK(where.trackers[0].stations[4].channel_sum() == 320.0);
  reconstruction_options options;
  options.field = 4.0 * units::tesla;
  const auto reconstruct = make_reconstruction(where, options);
  decltype(reconstruct)::buffers work;
  const auto truth = simulated_muons(file);
  REQUIRE(truth.size() == 10);

  const std::array<std::size_t, 5> digits{34, 31, 33, 31, 31};
  mice_json_reader events(file, where);
  event e;
  std::size_t spills = 0;
  std::size_t compared = 0;
  double mahalanobis2 = 0.0;
  double chi2 = 0.0;
  int ndf = 0;
  while (events.read(e)) {
    INFO("spill " << events.spill());
    REQUIRE(spills < digits.size());
    CHECK(e.digits.size() == digits[spills++]);
    reconstruct(e, work);
    CHECK(e.clusters.size() == 30);
    CHECK(e.space_points.size() == 10);
    for (const space_point& p : e.space_points) CHECK(p.clusters.size() == 3);
    CHECK(e.tracks.size() == 2);
    CHECK(e.flags == event_flags{});
    for (const track& t : e.tracks) {
      INFO("tracker " << t.tracker);
      const key k{events.spill(), t.tracker};
      using s = momentum_state;
      const auto& m = t.reference.mean;
      REQUIRE(t.status.ok());
      CHECK(t.planes == 15);
      CHECK(m[s::pz] * where.find(t.tracker)->beam_direction > 0.0);
      // pt of a few MeV/c in spill 2 of tracker 0 leaves the sense of rotation within the errors.
      if (std::hypot(m[s::px], m[s::py]) > 5.0) CHECK(t.charge == 1);
      chi2 += t.chi2;
      ndf += t.ndf;

      const vector<double, 5> miss = m - truth.at(k);
      for (int i = 0; i < 5; ++i) {
        INFO(s::names[static_cast<std::size_t>(i)] << ' ' << m[i] << " +- " << kalman::sigma(t.reference, i) << ", true " << truth.at(k)[i]);
        CHECK(std::abs(miss[i]) < 4.0 * kalman::sigma(t.reference, i));
      }
      mahalanobis2 += miss.dot(kalman::cholesky<double, 5>(t.reference.covariance).solve<1>(miss));

      const auto other = fitted_by_maus.find(k);
      if (other == fitted_by_maus.end()) continue;
      ++compared;
      // Two fits to the same digits: their difference is smaller than the error of either.
      const double pt = std::hypot(m[s::px], m[s::py]);
      const vector<double, 2> along{m[s::px] / pt, m[s::py] / pt};
      const double sigma_pt = std::sqrt(along.dot(t.reference.covariance.block<2, 2>(s::px, s::px) * along));
      const double pz = std::abs(m[s::pz]);
      INFO("pt " << pt << " +- " << sigma_pt << ", MAUS " << other->second[0] << "; pz " << pz << " +- " << kalman::sigma(t.reference, s::pz) << ", MAUS " << other->second[1]);
      CHECK(std::abs(pt - other->second[0]) < 3.0 * sigma_pt);
      CHECK(std::abs(pz - other->second[1]) < 3.0 * kalman::sigma(t.reference, s::pz));
    }
  }
  CHECK(spills == digits.size());
  CHECK(compared == fitted_by_maus.size());
  // Ten tracks, five numbers each: chi-squared with 50 degrees of freedom, standard deviation 10; likewise the fits.
  CHECK(std::abs(mahalanobis2 - 50.0) < 4.0 * 10.0);
  CHECK(ndf == 100);
  CHECK(std::abs(chi2 - ndf) < 4.0 * std::sqrt(2.0 * ndf));
}
