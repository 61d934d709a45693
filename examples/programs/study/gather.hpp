// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "ranks.hpp"

#ifdef SCIFI_HAS_MPI
#include <chrono>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <mpi.h>
#include <nlohmann/json.hpp>

#include <scifi/study/contents.hpp>

#include "interruption.hpp"

namespace scifi::study_program {

namespace detail {

enum message : int { numbers, drawings };

template <class Value>
void send(std::span<const Value> values, MPI_Datatype type, message what) {
  if (values.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) throw std::runtime_error("the study of one rank is too large for a message: start more ranks");
  MPI_Send(values.data(), static_cast<int>(values.size()), type, 0, what, MPI_COMM_WORLD);
}

/// Waits without taking the processor from ranks that work. Throws interruption::interrupted.
template <class Value>
[[nodiscard]] std::vector<Value> receive(int from, MPI_Datatype type, message what) {
  constexpr std::chrono::milliseconds pause{1};
  MPI_Status status{};
  for (int there = 0; there == 0;) {
    interruption::throw_if_received();
    MPI_Iprobe(from, what, MPI_COMM_WORLD, &there, &status);
    if (there == 0) std::this_thread::sleep_for(pause);
  }
  int count = 0;
  MPI_Get_count(&status, type, &count);
  std::vector<Value> out(static_cast<std::size_t>(count));
  MPI_Recv(out.data(), count, type, from, what, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return out;
}

}  // namespace detail

/// Adds to the study of the first rank those of all others, in their order; the others keep theirs. Throws interruption::interrupted at the first one.
template <class Study>
void gather(const ranks& all, Study& s) {
  if (!all.leads()) {
    detail::send<double>(study::contents(s), MPI_DOUBLE, detail::numbers);
    detail::send<char>(s.shown.contents().dump(), MPI_CHAR, detail::drawings);
    return;
  }
  for (int rank = 1; rank < all.size(); ++rank) {
    const bool same = study::add_contents(s, detail::receive<double>(rank, MPI_DOUBLE, detail::numbers));
    if (!same) throw std::runtime_error("rank " + std::to_string(rank) + " studies another detector");
    s.shown.add_contents(nlohmann::ordered_json::parse(detail::receive<char>(rank, MPI_CHAR, detail::drawings)));
  }
}

}  // namespace scifi::study_program
#else
namespace scifi::study_program {

/// Built without MPI: there is nobody else.
template <class Study>
void gather(const ranks&, Study&) {}

}  // namespace scifi::study_program
#endif
