// SPDX-License-Identifier: MPL-2.0
#pragma once

/// Everything that needs Eigen alone: the filter, the track models, geometry, simulation and reconstruction.
/// Left out on purpose: `scifi/alignment` (decompositions of matrices of any size: slow to compile), `scifi/io` (files: nlohmann-json, zlib) and `kalman/automatic_jacobian.hpp` (Eigen's unsupported AutoDiff); include what you use.
#include <scifi/candidate_to_track/track_fitter.hpp>
#include <scifi/chain/reconstruction.hpp>
#include <scifi/cluster_to_space_point/space_point_finder.hpp>
#include <scifi/core/units.hpp>
#include <scifi/digit_to_cluster/cluster_finder.hpp>
#include <scifi/event/event.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/field/coil_field.hpp>
#include <scifi/field/graded_field.hpp>
#include <scifi/field/placed_field.hpp>
#include <scifi/field/tabulate.hpp>
#include <scifi/field/uniform_field.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/information/track_bound.hpp>
#include <scifi/kalman.hpp>
#include <scifi/material/concepts.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>
#include <scifi/readout_to_digit/readout_digitiser.hpp>
#include <scifi/space_point_to_candidate/track_finder.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>
#include <scifi/version.hpp>
