// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/io/json_field.hpp>
#include <scifi/readout_to_digit/calibration.hpp>

namespace scifi {

/// The calibration that a JSON document describes, as in the files of MICE: an array of objects {bank, channel, adc_pedestal, adc_gain, ...},
/// banks counted through all boards, pedestals in counts, gains in counts per photo-electron. Gain and pedestal both zero: the channel is not
/// calibrated. Other fields are ignored. `file` is for messages. Throws input_error with the entry and the reason.
[[nodiscard]] inline readout_calibration calibration_from_json(const nlohmann::json& document, const std::string& file, const readout_layout& layout = {}) {
  readout_calibration out(layout);
  const json_field root(document, file);
  constexpr std::size_t never = static_cast<std::size_t>(-1);
  std::vector<std::size_t> entry_of(layout.size(), never);
  const std::size_t entries = root.size();
  for (std::size_t i = 0; i < entries; ++i) {
    const json_field from = root.element(i);
    const int bank = from.at("bank").whole_number(0, layout.all_banks() - 1);
    const int channel = from.at("channel").whole_number(0, layout.channels - 1);
    const std::optional<readout_channel> at = layout.counted_through(bank, channel);
    const std::optional<std::size_t> index = at ? layout.index(*at) : std::nullopt;
    if (!index) from.fail("the read-out has no such channel");
    if (entry_of[*index] != never)
      from.fail("bank " + std::to_string(bank) + " channel " + std::to_string(channel) + " is calibrated in entry " + std::to_string(entry_of[*index]) +
                " already");
    entry_of[*index] = i;
    const adc_line line{from.at("adc_gain").number(), from.at("adc_pedestal").number()};
    if (line.pedestal < 0.0) from.at("adc_pedestal").fail(from.at("adc_pedestal").value().dump() + " is negative");
    if (line.gain < 0.0) from.at("adc_gain").fail(from.at("adc_gain").value().dump() + " is negative");
    if (line.gain == 0.0 && line.pedestal == 0.0) continue;
    if (line.gain == 0.0) from.at("adc_gain").fail("is zero where the pedestal is not: a channel that is not calibrated has both zero");
    if (!out.set(*at, line)) from.fail("is no calibration");
  }
  if (out.size() == 0) root.fail("calibrates no channel");
  return out;
}

/// The calibration in a file, plain or gzip. Throws input_error with file, line or entry, and the reason.
[[nodiscard]] inline readout_calibration read_calibration(const std::filesystem::path& path, const readout_layout& layout = {}) {
  return calibration_from_json(read_json(path), path.string(), layout);
}

}  // namespace scifi
