// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <scifi/io/input_error.hpp>
#include <scifi/version.hpp>

#include "interruption.hpp"

/// How every program here ends: 0 done, 2 something was given wrongly, 3 it could not be done (a full disk, say), 128 and the number of the signal that
/// stopped it. A message goes to standard error.
inline constexpr int exit_given_wrongly = 2;
inline constexpr int exit_not_done = 3;
inline constexpr int exit_signalled = 128;

/// Parses the command line, then calls `run()`, which throws what went wrong; `name` stands before each message. Returns the exit status.
template <class Run>
[[nodiscard]] int run_program(const char* name, CLI::App& app, int argc, char** argv, const Run& run) {
  app.set_version_flag("--version", std::string(scifi::version));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : exit_given_wrongly;
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of the write
  const auto failed = [name](const char* why, int status) {
    fmt::print(stderr, "{}: {}\n", name, why);
    return status;
  };
  try {
    run();
  } catch (const interruption::interrupted& e) {
    return failed(e.what(), exit_signalled + interruption::received());
  } catch (const std::exception& e) {
    // What waited for input when the signal came failed for that alone.
    if (interruption::received() != 0) return failed(interruption::interrupted().what(), exit_signalled + interruption::received());
    const bool wrong = dynamic_cast<const scifi::input_error*>(&e) != nullptr || dynamic_cast<const std::invalid_argument*>(&e) != nullptr;
    return failed(e.what(), wrong ? exit_given_wrongly : exit_not_done);
  }
  if (std::fflush(stdout) != 0) return failed((std::string("standard output: could not be written: ") + std::strerror(errno)).c_str(), exit_not_done);
  return 0;
}
