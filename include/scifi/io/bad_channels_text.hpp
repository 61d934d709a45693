// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include <scifi/io/whole_number_rows.hpp>
#include <scifi/readout_to_digit/bad_channels.hpp>

namespace scifi {

/// The bad channels in a text file, plain or gzip, two whole numbers a line as in the files of MICE: bank, counted through all boards, and
/// channel of the bank. An empty file names none; a channel may be named again. Throws input_error with file, line, column and reason.
[[nodiscard]] inline bad_channels read_bad_channels(const std::filesystem::path& path, const readout_layout& layout = {}) {
  enum columns : std::size_t { bank_column, channel_column };
  bad_channels out(layout);
  whole_number_rows rows(path, {"bank", "channel"});
  while (rows.next()) {
    const std::optional<readout_channel> r =
        layout.counted_through(rows.within(bank_column, 0, layout.all_banks() - 1), rows.within(channel_column, 0, layout.channels - 1));
    if (!r || !out.mark(*r)) rows.fail("", "the read-out has no such channel");
  }
  return out;
}

}  // namespace scifi
