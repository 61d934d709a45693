// SPDX-License-Identifier: MPL-2.0
#pragma once

/// The generic Kalman filter: it knows no dimension and no physics. `kalman/automatic_jacobian.hpp` is separate, for its extra header.
#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/concepts.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/factored_estimate.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/gate.hpp>
#include <scifi/kalman/iterated.hpp>
#include <scifi/kalman/joseph.hpp>
#include <scifi/kalman/node.hpp>
#include <scifi/kalman/node_residual.hpp>
#include <scifi/kalman/plain.hpp>
#include <scifi/kalman/relinearised.hpp>
#include <scifi/kalman/residual.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/smoother.hpp>
#include <scifi/kalman/square_root.hpp>
#include <scifi/kalman/status.hpp>
#include <scifi/kalman/symmetric_form.hpp>
