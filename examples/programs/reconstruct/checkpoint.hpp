// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include <scifi/io/input_error.hpp>

#include "reconstruct/check_sum.hpp"
#include "reconstruct/totals.hpp"

/// How far a reconstruction has come, at the end of a block: what another run needs to go on from there.
struct checkpoint {
  nlohmann::ordered_json settings;  ///< what the results depend on besides the input
  std::uint32_t input_check = 0;    ///< of the events that are done
  totals sum;                       ///< with their number
  check_sum tracks, points;         ///< what is written
  nlohmann::ordered_json monitor;  ///< null without

  static constexpr int version = 1;

  /// Replaces the file by this. It must survive the end of the process, not of the machine: it is not forced to disk. False when it could not be
  /// written; what was there before is then still there.
  [[nodiscard]] bool save(const std::filesystem::path& file) const {
    nlohmann::ordered_json out = {{"format", "scifi-checkpoint"}, {"version", version}, {"settings", settings}, {"input_check", input_check}};
    for (const auto& [name, which] : counted) out["sum"][name] = sum.*which;
    out["sum"]["reconstruction_ns"] = sum.reconstruction.count();
    for (const auto& [name, written] : {std::pair{"tracks", &tracks}, std::pair{"points", &points}}) out[name] = {{"bytes", written->bytes}, {"check", written->check}};
    out["monitor"] = monitor;
    const std::string beside = file.string() + ".new";
    std::ofstream stream(beside, std::ios::binary);
    stream << out.dump() << '\n';
    stream.close();
    if (stream && std::rename(beside.c_str(), file.c_str()) == 0) return true;
    std::error_code none;
    std::filesystem::remove(beside, none);
    return false;
  }

  /// Nothing when there is none. Throws scifi::input_error when the file is something else.
  [[nodiscard]] static std::optional<checkpoint> load(const std::filesystem::path& file) {
    std::error_code none;
    if (!std::filesystem::exists(file, none)) return std::nullopt;
    std::ifstream stream(file, std::ios::binary);
    try {
      const auto in = nlohmann::ordered_json::parse(stream);
      if (in.at("format") != "scifi-checkpoint" || in.at("version") != version) throw std::invalid_argument("another format");
      checkpoint out;
      out.settings = in.at("settings");
      in.at("input_check").get_to(out.input_check);
      for (const auto& [name, which] : counted) in.at("sum").at(name).get_to(out.sum.*which);
      out.sum.reconstruction = std::chrono::steady_clock::duration(in.at("sum").at("reconstruction_ns").get<std::chrono::steady_clock::rep>());
      for (const auto& [name, written] : {std::pair{"tracks", &out.tracks}, std::pair{"points", &out.points}}) {
        in.at(name).at("bytes").get_to(written->bytes);
        in.at(name).at("check").get_to(written->check);
      }
      out.monitor = in.at("monitor");
      return out;
    } catch (const std::exception& e) {
      throw scifi::input_error(file.string(), 0, "", std::string("is not a checkpoint of this program (") + e.what() + "); start without --resume");
    }
  }
};
