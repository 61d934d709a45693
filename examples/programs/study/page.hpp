// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "shared_file.hpp"

namespace scifi::study_program {

/// The script that draws.
[[nodiscard]] inline std::filesystem::path drawing_script() {
  return shared_file("draw_study.py");
}

/// Runs a program, found on the path, and waits for it. Returns its exit status, or 127 when it could not be started.
[[nodiscard]] inline int run_and_wait(std::vector<std::string> command) {
  constexpr int not_started = 127;
  std::vector<char*> arguments;
  for (std::string& a : command) arguments.push_back(a.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (::posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), ::environ) != 0) return not_started;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), command[0]);
  return WIFEXITED(status) ? WEXITSTATUS(status) : not_started;
}

/// Draws the pictures and the page of `numbers` (a study.json) into `folder`. `python` is the interpreter; when empty, the one on the path and then the system's are
/// tried: one that has matplotlib. Throws std::runtime_error when that cannot be done; study.json is there all the same.
inline void draw_page(const std::filesystem::path& numbers, const std::filesystem::path& folder, const std::string& python) {
  const std::filesystem::path script = drawing_script();
  const std::string but = numbers.string() + " is written, but nothing is drawn: ";
  if (!std::filesystem::exists(script)) throw std::runtime_error(but + script.string() + " does not exist");
  const std::vector<std::string> interpreters = python.empty() ? std::vector<std::string>{"python3", "/usr/bin/python3"} : std::vector{python};
  for (const std::string& interpreter : interpreters) {
    constexpr int without_matplotlib = 69;  // as the script says it
    constexpr int not_started = 127;
    const int status = run_and_wait({interpreter, "-B", script.string(), numbers.string(), folder.string()});
    if (status == 0) return;
    if (status != without_matplotlib && status != not_started)
      throw std::runtime_error(but + interpreter + " " + script.string() + " ended with exit status " + std::to_string(status));
  }
  throw std::runtime_error(but + "there is no " + (python.empty() ? "Python 3" : python) + " with matplotlib (Debian: python3-matplotlib)");
}

}  // namespace scifi::study_program
