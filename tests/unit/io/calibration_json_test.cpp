// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/calibration_json.hpp>

#include <string>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::input_error;
using scifi::read_calibration;
using namespace scifi::test;

std::string entry(const char* bank, const char* channel, const char* gain, const char* pedestal) {
  return std::string(R"({"tdc_gain": 0.00, "adc_gain": )") + gain + R"(, "bank": )" + bank + R"(, "tdc_pedestal": 0.00, "channel": )" + channel +
         R"(, "adc_pedestal": )" + pedestal + "}";
}

}  // namespace

TEST_CASE("a calibration is read as it is written; zero gain and pedestal are none", "[io]") {
  const temporary_folder folder;
  const std::string text = "[" + entry("0", "0", "9.54", "26.58") + ",\n" + entry("0", "1", "0.00", "0.00") + "," + entry("63", "127", "14.81", "29.24") + "]";
  for (const auto& path : {folder.file("a.txt", text), folder.file("b.txt", gzip(text))}) {
    const auto calibration = read_calibration(path);
    CHECK(calibration.size() == 2);
    REQUIRE(calibration.of({0, 0, 0}).has_value());
    CHECK(calibration.of({0, 0, 0})->gain == 9.54);
    CHECK(calibration.of({0, 0, 0})->pedestal == 26.58);
    CHECK_FALSE(calibration.of({0, 0, 1}).has_value());
    REQUIRE(calibration.of({15, 3, 127}).has_value());
    CHECK(calibration.of({15, 3, 127})->gain == 14.81);
  }
}

TEST_CASE("a malformed calibration is refused with the entry and the reason", "[io]") {
  struct row {
    std::string text;
    const char* message;
  };
  const std::string good = entry("0", "0", "9.54", "26.58");
  const row table[] = {
      {"", ": the file is empty"},
      {"{}", ": is not an array"},
      {"[]", ": calibrates no channel"},
      {"[5]", ": [0]: is not an object"},
      {"[" + entry("0", "0", "0.0", "0.0") + "]", ": calibrates no channel"},
      {"[" + good + "," + entry("0", "1", "0.0", "28.2") + "]",
       ": [1].adc_gain: is zero where the pedestal is not: a channel that is not calibrated has both zero"},
      {"[" + good + "," + entry("0", "1", "-9.5", "28.2") + "]", ": [1].adc_gain: -9.5 is negative"},
      {"[" + good + "," + entry("0", "1", "9.5", "-0.5") + "]", ": [1].adc_pedestal: -0.5 is negative"},
      {"[" + good + "," + entry("0", "1", "\"9.5\"", "28.2") + "]", ": [1].adc_gain: '\"9.5\"' is not a number"},
      {"[" + good + "," + entry("0", "1", "null", "28.2") + "]", ": [1].adc_gain: 'null' is not a number"},
      {"[" + entry("64", "0", "9.5", "28.2") + "]", ": [0].bank: 64 is outside 0 .. 63"},
      {"[" + entry("-1", "0", "9.5", "28.2") + "]", ": [0].bank: -1 is outside 0 .. 63"},
      {"[" + entry("0", "128", "9.5", "28.2") + "]", ": [0].channel: 128 is outside 0 .. 127"},
      {"[" + entry("1e99", "0", "9.5", "28.2") + "]", ": [0].bank: 1e+99 is outside 0 .. 63"},
      {"[" + entry("0", "0.5", "9.5", "28.2") + "]", ": [0].channel: 0.5 is not a whole number"},
      {"[" + good + "," + entry("0", "1", "9.5", "28.2") + "," + good + "]", ": [2]: bank 0 channel 0 is calibrated in entry 0 already"},
      {R"([{"bank": 0, "channel": 0, "adc_gain": 9.5}])", ": [0].adc_pedestal: is missing"},
      {R"([{"channel": 0, "adc_gain": 9.5, "adc_pedestal": 28.2}])", ": [0].bank: is missing"},
  };
  const temporary_folder folder;
  for (const row& r : table) {
    const auto path = folder.file("a.txt", r.text);
    CHECK(without(path.string(), message_of<input_error>([&] { (void)read_calibration(path); })) == r.message);
  }
}

TEST_CASE("text that is no JSON is refused with the line", "[io]") {
  const std::string good = entry("0", "0", "9.54", "26.58");
  const temporary_folder folder;
  const std::string texts[] = {"[\n" + good + ",\n", "[\n" + good + ",\n" + good.substr(0, 20), "[\n\n\xFF\xFE", "[\n\n\"\xE9\"]", "[\n\n" + entry("0", "0", "nan", "1") + "]"};
  for (const std::string& text : texts) {
    const auto path = folder.file("a.txt", text);
    const std::string message = without(path.string(), message_of<input_error>([&] { (void)read_calibration(path); }));
    CHECK(message.find(":3: is not JSON: ") == 0);
  }
  const auto huge = folder.file("c.txt", "[" + entry("0", "0", "1e999", "1") + "]");
  CHECK(without(huge.string(), message_of<input_error>([&] { (void)read_calibration(huge); })) == ":1: is not usable JSON: number overflow parsing '1e999'");
  const auto wide = folder.file("b.txt", std::string("\xFF\xFE[\0]\0", 6));
  CHECK(without(wide.string(), message_of<input_error>([&] { (void)read_calibration(wide); })).find(":1: is not JSON: ") == 0);
}

TEST_CASE("the published calibration is read", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  const auto calibration = read_calibration(*data / "mice" / "scifi_calibration_2015-09-12.txt");
  CHECK(calibration.size() == 8192 - 838);  // entries with a gain of zero, counted with grep
  REQUIRE(calibration.of({0, 0, 1}).has_value());
  CHECK(calibration.of({0, 0, 1})->gain == 10.43);
  CHECK(calibration.of({15, 3, 126})->pedestal == 28.96);
}
