// SPDX-License-Identifier: MPL-2.0
// Compile cost of fitting one helix through a tracker, with material and smoother.
#include <array>
#include <vector>

#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/candidate_to_track/fit_stops.hpp>
#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/relinearised.hpp>
#include <scifi/kalman/symmetric_form.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

using memory = scifi::fit_memory<scifi::slope_state, double, scifi::leg>;

double fit(const scifi::tracker& where, const scifi::fit_job& job, double field, const scifi::kalman::estimate<double, 5>& start, memory& work);
double fit(const scifi::tracker& where, const scifi::fit_job& job, double field, const scifi::kalman::estimate<double, 5>& start, memory& work) {
  const scifi::fit_path path = scifi::fit_path_of(where);
  const scifi::energy_loss_propagator fly{scifi::helix_propagator{field}, scifi::mean_energy_loss{}, scifi::muon_plus, where.beam_direction};
  const scifi::material_noise noise{scifi::highland_scattering{}, scifi::landau_straggling{5.0}, scifi::muon_plus};
  const scifi::kalman::filter filter{fly, noise, scifi::kalman::symmetric_form{}};
  scifi::set_stops(path, path.legs, std::array{job}, work);
  work.nodes.resize(path.legs.size());
  work.references.resize(path.legs.size() + 1);
  const scifi::vector<double, 5> seed = start.mean;
  const auto result = scifi::kalman::run_relinearised(filter, start, seed, work.stops, work.nodes, work.references, 2, scifi::kalman::detail::never_settled{}, scifi::kalman::modified_bryson_frazier{});
  return result.status.ok() ? result.chi2 : -1.0;
}
