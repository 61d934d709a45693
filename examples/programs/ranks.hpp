// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>

#ifdef SCIFI_HAS_MPI
#include <csignal>
#include <exception>

#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include "interruption.hpp"

/// The processes of a job that mpirun or srun started, from the first line of main to the last; a process that was started otherwise is alone, and MPI is
/// not touched. Rank 0 leads: it reads, writes and speaks to the user; the others are silent unless they have to say why they cannot work.
class ranks {
 public:
  ranks(int& argc, char**& argv) {
    for (const char* set_by_launchers : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE", "PMI_RANK"}) started_ = started_ || std::getenv(set_by_launchers) != nullptr;
    if (!started_) return;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    if (leads()) return;
    std::signal(SIGINT, SIG_IGN);  // the leader sees to it
    spoken_to_ = ::dup(STDERR_FILENO);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  ranks(const ranks&) = delete;
  ranks& operator=(const ranks&) = delete;
  ~ranks() {
    if (started_) MPI_Finalize();
  }

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] bool leads() const { return rank_ == 0; }
  void check_build() const {}

  /// Does what every rank does; throws on all where it threw on one, and one of them says why. What a signal stopped throws at once.
  template <class Work>
  void together(const Work& work) const {
    std::exception_ptr mine;
    try {
      work();
    } catch (...) {
      if (interruption::received() != 0) throw;
      mine = std::current_exception();
    }
    int first = mine ? rank_ : size_;
    if (size_ > 1) MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (first == size_) return;
    if (first == rank_) speak();
    if (mine) std::rethrow_exception(mine);
    throw std::runtime_error("rank " + std::to_string(first) + " could not go on");
  }

  /// From now on this rank's messages are seen.
  void speak() const {
    if (spoken_to_ >= 0) ::dup2(spoken_to_, STDERR_FILENO);
  }
  /// Ends all ranks at once.
  [[noreturn]] static void abort(int status) {
    MPI_Abort(MPI_COMM_WORLD, status);
    std::_Exit(status);
  }

 private:
  bool started_ = false;
  int rank_ = 0, size_ = 1, spoken_to_ = -1;
};
#else
/// Built without MPI: every process is alone.
class ranks {
 public:
  ranks(int&, char**&) {}
  [[nodiscard]] int size() const { return 1; }
  [[nodiscard]] int rank() const { return 0; }
  [[nodiscard]] bool leads() const { return true; }
  static void abort(int) {}
  /// Throws std::invalid_argument where mpirun started several processes, which would all do the same.
  void check_build() const {
    for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
      if (const char* const given = std::getenv(size); given != nullptr && std::atoi(given) > 1)
        throw std::invalid_argument("started by mpirun, but built without MPI: configure with -D SCIFI_MPI=ON");
  }
  template <class Work>
  void together(const Work& work) const {
    work();
  }
};
#endif
