// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>
#include <string_view>

#include <scifi/event/raw_digit.hpp>
#include <scifi/io/fixed_point.hpp>

namespace scifi {

/// Header line of the table of digits that digit_reader reads: one row a digit, with the counts of its ADC.
inline constexpr std::string_view digit_columns = "event,tracker,station,plane,channel,adc,npe\n";

/// Appends the row of a digit under `digit_columns`; light in photo-electrons to three decimals.
inline void append_digit(std::string& out, long event_number, const raw_digit& d) {
  constexpr int npe_decimals = 3;  // an ADC of MICE has ten counts a photo-electron
  append_integer(out, event_number);
  for (const int field : {d.id.tracker, d.id.station, d.id.plane, d.id.channel, d.adc}) {
    out += ',';
    append_integer(out, field);
  }
  out += ',';
  append_fixed(out, d.npe, npe_decimals);
  out += '\n';
}

}  // namespace scifi
