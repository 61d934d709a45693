// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <scifi/io/input_error.hpp>
#include <scifi/version.hpp>

/// How every program here ends: 0 done, 2 something was given wrongly, 3 it could not be done (a full disk, say). A message goes to standard error.
inline constexpr int exit_given_wrongly = 2;
inline constexpr int exit_not_done = 3;

/// Parses the command line, then calls `run()`, which throws what went wrong; `name` stands before each message. Returns the exit status.
template <class Run>
[[nodiscard]] int run_program(const char* name, CLI::App& app, int argc, char** argv, const Run& run) {
  app.set_version_flag("--version", std::string(scifi::version));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : exit_given_wrongly;
  }
  const auto failed = [name](const std::exception& e, int status) {
    fmt::print(stderr, "{}: {}\n", name, e.what());
    return status;
  };
  try {
    run();
  } catch (const scifi::input_error& e) {
    return failed(e, exit_given_wrongly);
  } catch (const std::invalid_argument& e) {
    return failed(e, exit_given_wrongly);
  } catch (const std::exception& e) {
    return failed(e, exit_not_done);
  }
  return 0;
}
