#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-digitise from the outside: what it makes of raw counts, and what it says and leaves behind when the input is bad.

Usage: digitise_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone. Exit status 77: the program was not built.
SCIFI_SHARED_DATA in the environment names the folder of external data; tests that need it are skipped without.
"""

import csv
import gzip
import json
import os
import pathlib
import unittest

import programs

RAW_HEADER = "event,board,bank,channel,adc\n"
DIGIT_HEADER = "event,tracker,station,plane,channel,adc,npe"
CHANNELS = (214, 214, 212)  # of the planes of a MICE station


def all_channels():
    return [(t, s, p, c) for t in range(2) for s in range(1, 6) for p in range(3) for c in range(CHANNELS[p])]


def cable_of(number):
    """Read-out channel (board, bank, channel) of the detector channel of this number: all over the boards, each once."""
    place = number * 1637 % 8192
    return place // 512, place // 128 % 4, place % 128


def line_of(number):
    """Gain and pedestal of a read-out channel, different from neighbour to neighbour."""
    return 8.0 + 0.01 * (number % 401), 24.0 + 0.01 * (number % 503)


CABLE = {channel: cable_of(i) for i, channel in enumerate(all_channels())}
LINE = {channel: line_of(i) for i, channel in enumerate(all_channels())}
CABLING = "".join("{} {} {} {} {} {} {} 1 1 1\n".format(*CABLE[c], *c) for c in all_channels())


def calibration(lines):
    """JSON of {(board, bank, channel): (gain, pedestal)}."""
    return json.dumps([{"bank": 4 * board + bank, "channel": channel, "adc_gain": gain, "adc_pedestal": pedestal, "tdc_gain": 0.0, "tdc_pedestal": 0.0}
                       for (board, bank, channel), (gain, pedestal) in lines.items()])


CALIBRATION = calibration({CABLE[c]: LINE[c] for c in all_channels()})


class Digitise(programs.InAFolder):
    def setUp(self):
        super().setUp()
        self.write("cabling.txt", CABLING)
        self.write("calibration.txt", CALIBRATION)
        self.write("bad.txt", "")

    def digitise(self, raw, *arguments, **files):
        if raw is not None:
            self.write("raw.csv", raw)
        names = {"cabling": "cabling.txt", "calibration": "calibration.txt", "bad_channels": "bad.txt", **files}
        inputs = [word for key, name in names.items() for word in ("--" + key.replace("_", "-"), name)]
        return self.run_program("scifi-digitise", *inputs, *arguments, "raw.csv")

    def rows(self, name="digits.csv"):
        return super().rows(name)

    def expect_refused(self, result, *sentences, status=2):
        self.assertEqual(result.returncode, status, result.stderr)
        for sentence in sentences:
            self.assertIn(sentence, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith("digits")], [])

    # What is made

    def test_counts_become_digits(self):
        first, second, third, fourth = (0, 1, 0, 0), (0, 3, 1, 213), (1, 5, 2, 211), (1, 2, 0, 100)
        self.write("bad.txt", "{} {}\n".format(4 * CABLE[fourth][0] + CABLE[fourth][1], CABLE[fourth][2]))
        free = cable_of(len(all_channels()))  # the next one
        counts = [(3, third, 255), (3, first, 60), (3, fourth, 200), (8, second, 100), (8, first, 39)]
        raw = RAW_HEADER + "".join("{},{},{},{},{}\n".format(e, *CABLE[c], adc) for e, c, adc in counts) + "9,{},{},{},200\n".format(*free)
        result = self.digitise(raw)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "digits.csv").read_text(encoding="ascii").splitlines()[0], DIGIT_HEADER)
        expected = [(3, first, 60), (3, third, 255), (8, second, 100)]  # in order of the channels
        rows = self.rows()
        self.assertEqual([tuple(int(r[k]) for k in ("event", "tracker", "station", "plane", "channel", "adc")) for r in rows], [(e, *c, adc) for e, c, adc in expected])
        for row, (_, channel, adc) in zip(rows, expected):
            gain, pedestal = LINE[channel]
            self.assertAlmostEqual(float(row["npe"]), (adc - pedestal) / gain, delta=0.000501)
        for sentence in ("events                       3", "counts                       6", "  not cabled                 1", "  bad channel                1",
                         "  too little light           1", "  digits                     3", "geometry without one 0"):
            self.assertIn(sentence, result.stdout)

    def test_the_least_light_can_be_chosen(self):
        channel = (0, 1, 0, 0)
        raw = RAW_HEADER + "".join("{},{},{},{},{}\n".format(adc, *CABLE[channel], adc) for adc in range(0, 61))
        gain, pedestal = LINE[channel]
        for least in (0.0, 1.0, 2.0, 3.5):
            result = self.digitise(raw, "--min-npe", least)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual([int(r["adc"]) for r in self.rows()], [adc for adc in range(61) if (adc - pedestal) / gain >= least])

    def test_a_channel_without_calibration_gives_no_digits(self):
        lines = {CABLE[c]: LINE[c] for c in all_channels()}
        lines[CABLE[(0, 1, 0, 0)]] = (0.0, 0.0)
        del lines[CABLE[(0, 1, 0, 1)]]
        self.write("calibration.txt", calibration(lines))
        raw = RAW_HEADER + "".join("0,{},{},{},99\n".format(*CABLE[(0, 1, 0, c)]) for c in range(3))
        result = self.digitise(raw)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([r["channel"] for r in self.rows()], ["2"])
        self.assertIn("  not calibrated             2", result.stdout)

    def test_simulated_digits_come_back_to_the_rounding_of_the_adc(self):
        result = self.run_program("scifi-simulate", "--events", 300, "--seed", 3, "--output", "simulated")
        self.assertEqual(result.returncode, 0, result.stderr)
        simulated = self.rows("simulated_digits.csv")
        raw, expected = [RAW_HEADER], []
        for row in simulated:
            channel = tuple(int(row[k]) for k in ("tracker", "station", "plane", "channel"))
            gain, pedestal = LINE[channel]
            adc = min(255, round(gain * float(row["npe"]) + pedestal))
            raw.append("{},{},{},{},{}\n".format(row["event"], *CABLE[channel], adc))
            expected.append((int(row["event"]), *channel, adc, float(row["npe"]), gain))
        self.assertGreater(len(expected), 5000)
        raw = "".join(raw)
        # Half a count below two photo-electrons is still one that was simulated.
        result = self.digitise(raw, "--min-npe", 1.9)
        self.assertEqual(result.returncode, 0, result.stderr)
        back = self.rows()
        self.assertEqual([tuple(int(r[k]) for k in DIGIT_HEADER.split(",")[:6]) for r in back], [e[:6] for e in expected])
        for row, (*_, adc, npe, gain) in zip(back, expected):
            if adc < 255:
                self.assertLessEqual(abs(float(row["npe"]) - npe), 0.5 / gain + 0.000501)
        table = (self.folder / "digits.csv").read_bytes()

        # Once more through the read-out: nothing changes any more, packed input or not.
        again = [RAW_HEADER]
        for row in back:
            channel = tuple(int(row[k]) for k in ("tracker", "station", "plane", "channel"))
            gain, pedestal = LINE[channel]
            again.append("{},{},{},{},{}\n".format(row["event"], *CABLE[channel], round(gain * float(row["npe"]) + pedestal)))
        for content in ("".join(again), gzip.compress("".join(again).encode())):
            self.assertEqual(self.digitise(content, "--min-npe", 1.9).returncode, 0)
            self.assertEqual((self.folder / "digits.csv").read_bytes(), table)

        # The digits go on, as a table or as MICE JSON, to the same tracks.
        self.assertEqual(self.digitise(None, "--min-npe", 1.9, "-o", "digits.json").returncode, 0)
        tracks = {}
        for name in ("digits.csv", "digits.json"):
            result = self.run_program("scifi-reconstruct", "--field", 3, "--output", "tracks.csv", name)
            self.assertEqual(result.returncode, 0, result.stderr)
            tracks[name] = self.rows("tracks.csv")
        self.assertGreater(len(tracks["digits.csv"]), 300)
        self.assertEqual(len(tracks["digits.csv"]), len(tracks["digits.json"]))

    def test_digits_as_mice_json(self):
        channels = [(0, 1, 0, 0), (1, 5, 2, 211)]
        raw = RAW_HEADER + "".join("7,{},{},{},90\n".format(*CABLE[c]) for c in channels)
        result = self.digitise(raw, "-o", "digits.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        (document,) = [json.loads(line) for line in (self.folder / "digits.json").read_text(encoding="ascii").splitlines()]
        self.assertEqual((document["maus_event_type"], document["spill_number"]), ("Spill", 7))
        digits = document["recon_events"][0]["sci_fi_event"]["digits"]
        self.assertEqual([(d["tracker"], d["station"], d["plane"], d["channel"]) for d in digits], channels)
        for d, channel in zip(digits, channels):
            gain, pedestal = LINE[channel]
            self.assertAlmostEqual(d["npe"], (90 - pedestal) / gain, places=12)

    def test_a_table_without_rows_gives_a_table_without_rows(self):
        self.assertEqual(self.digitise(RAW_HEADER).returncode, 0)
        self.assertEqual((self.folder / "digits.csv").read_text(encoding="ascii"), DIGIT_HEADER + "\n")

    def test_digits_to_standard_output_stand_alone(self):
        result = self.digitise(RAW_HEADER, "-o", "/dev/stdout")
        self.assertEqual((result.returncode, result.stdout), (0, DIGIT_HEADER + "\n"))

    @unittest.skipUnless(os.environ.get("SCIFI_SHARED_DATA"), "needs external data")
    def test_the_published_files_are_read_with_the_geometry_that_goes_with_them(self):
        mice = pathlib.Path(os.path.abspath(os.environ["SCIFI_SHARED_DATA"])) / "mice"
        recent, early = mice / "scifi_mapping_2015-09-11.txt", mice / "scifi_mapping_7.txt"
        files = {"calibration": mice / "scifi_calibration_2015-09-12.txt", "bad_channels": mice / "scifi_bad_channels.txt"}
        # The early cabling has the plane of 212 channels as the second of a station.
        views = [{"plane": i, "view": "VWU"[i], "angle": (120.0, -120.0, 0.0)[i], "channels": (214, 212, 214)[i], "central_channel": (106.5, 105.5, 106.5)[i],
                  "z_mylar": [0.7 * i, 0.7 * i + 0.025], "z_fibres": [0.7 * i + 0.025, 0.7 * i + 0.65]} for i in range(3)]
        stations = [{"station": s, "position": [0, 0, 250.0 * (s - 1)]} for s in range(1, 6)]
        geometry = {"format": "scifi-geometry", "version": 1, "channel_width": 1.4945, "fiducial_radius": 150.0, "planes": views,
                    "trackers": [{"tracker": 0, "beam_direction": -1, "stations": stations}, {"tracker": 1, "beam_direction": 1, "stations": stations}]}
        self.write("early.json", json.dumps(geometry))
        bad = {tuple(map(int, line.split())) for line in files["bad_channels"].read_text().splitlines()}
        lines = {(e["bank"], e["channel"]): (e["adc_gain"], e["adc_pedestal"]) for e in json.loads(files["calibration"].read_text())}
        every = [(board, bank, channel) for board in range(16) for bank in range(4) for channel in range(128)]
        raw = RAW_HEADER + "".join("0,{},{},{},120\n".format(*r) for r in every)
        for cabling, options in ((recent, ()), (early, ("--geometry", "early.json"))):
            result = self.digitise(raw, *options, cabling=cabling, **files)
            self.assertEqual(result.returncode, 0, result.stderr)
            expected = {}
            for line in cabling.read_text().splitlines():
                board, bank, channel, *where = map(int, line.split()[:7])
                gain, pedestal = lines[4 * board + bank, channel]
                if (4 * board + bank, channel) not in bad and gain > 0 and (120 - pedestal) / gain >= 2.0:
                    expected[tuple(where)] = (120 - pedestal) / gain
            rows = self.rows()
            self.assertEqual([tuple(int(r[k]) for k in ("tracker", "station", "plane", "channel")) for r in rows], sorted(expected))
            for r, key in zip(rows, sorted(expected)):
                self.assertAlmostEqual(float(r["npe"]), expected[key], delta=0.000501)
            (self.folder / "digits.csv").unlink()
        self.expect_refused(self.digitise(raw, cabling=early, **files), "scifi_mapping_7.txt:", "is it the one of this cabling?")
        self.expect_refused(self.digitise(raw, "--geometry", "early.json", cabling=recent, **files), "scifi_mapping_2015-09-11.txt:", "is it the one of this cabling?")

    # What is refused

    def test_bad_raw_counts_are_refused_with_file_line_and_column(self):
        good = RAW_HEADER + "0,0,0,1,90\n"
        for content, message in (("", "raw.csv: the file is empty"), ("0,0,0,1,90\n", "raw.csv:1: event: the header has no column"),
                                 (good + "1,0,0,1\n", "raw.csv:3: 4 fields where the header names 5"), (good + "1,16,0,1,9\n", "raw.csv:3: board: 16 is outside 0 .. 15"),
                                 (good + "1,0,-1,1,9\n", "raw.csv:3: bank: -1 is outside 0 .. 3"), (good + "1,0,0,128,9\n", "raw.csv:3: channel: 128 is outside"),
                                 (good + "1,0,0,1,256\n", "raw.csv:3: adc: 256 is outside 0 .. 255"), (good + "1,0,0,1,nan\n", "raw.csv:3: adc: 'nan' is not a whole number"),
                                 (good + "0,0,0,1,91\n", "raw.csv:3: channel: a second count of this channel"), (good + "-1,0,0,1,91\n", "raw.csv:3: event: event numbers must not be negative"),
                                 ((good + "1,0,0,1,9\n").encode("utf-16"), "raw.csv:1: event: the header has no column"),
                                 (gzip.compress(good.encode())[:-5], "the gzip data end too early")):
            with self.subTest(message=message):
                self.expect_refused(self.digitise(content), message)

    def test_bad_cablings_calibrations_and_bad_channels_are_refused(self):
        lines = CABLING.splitlines(keepends=True)
        board, bank, channel = CABLE[(0, 1, 0, 0)]
        one = "{} {} {} ".format(board, bank, channel)
        for name, key, content, message in (
                ("cabling", "cabling", lines[0] + "0 0 1\n", "cabling:2: 3 numbers where 10 belong"),
                ("cabling", "cabling", lines[0] + one + "0 1 0 1 1 1 1\n", "cabling:2: chan_ro: board"),
                ("cabling", "cabling", lines[0] + "15 3 5 0 1 0 0 1 1 1\n", "cabling:2: channel: tracker 0 station 1 plane 0 channel 0 has another cable in line 1"),
                ("cabling", "cabling", lines[0] + "15 3 5 0 1 0 1000000 1 1 1\n", "cabling:2: channel: 1000000 is outside 0 .. 213"),
                ("cabling", "cabling", lines[0], "is cabled up to channel 0 but has 214 channels in the geometry"),
                ("cabling", "cabling", "", "cabling: connects no channel"),
                ("cabling", "cabling", CABLING.encode("utf-16"), "cabling:1: is not plain ASCII text: byte 0xFF"),
                ("calib", "calibration", CALIBRATION[:5000], "calib:1: is not JSON"),
                ("calib", "calibration", CALIBRATION.encode("utf-16"), "calib:1: is not JSON"),
                ("calib", "calibration", calibration({(0, 0, 0): (0.0, 28.0)}), "calib: [0].adc_gain: is zero"),
                ("calib", "calibration", calibration({(0, 0, 0): (9.5, -1.0)}), "calib: [0].adc_pedestal: -1.0 is negative"),
                ("calib", "calibration", calibration({(16, 0, 0): (9.5, 28.0)}), "calib: [0].bank: 64 is outside 0 .. 63"),
                ("calib", "calibration", '[{"bank": 0, "channel": 0, "adc_gain": 1e999, "adc_pedestal": 1}]', "calib:1: is not usable JSON: number overflow"),
                ("badc", "bad_channels", "0 1\n0\n", "badc:2: 1 number where 2 belong"),
                ("badc", "bad_channels", "0 128\n", "badc:1: channel: 128 is outside 0 .. 127"),
                ("badc", "bad_channels", "64 0\n", "badc:1: bank: 64 is outside 0 .. 63")):
            with self.subTest(message=message):
                self.write(name, content)
                self.expect_refused(self.digitise(RAW_HEADER, **{key: name}), message)
        for key in ("cabling", "calibration", "bad_channels"):
            self.expect_refused(self.digitise(RAW_HEADER, **{key: "none"}), "none: cannot be opened: No such file or directory")

    def test_a_bad_input_leaves_older_digits_alone(self):
        self.write("old.csv", "old")
        result = self.digitise(RAW_HEADER + "0,0,0,1,90\n1,0,0,1,x\n", "-o", "old.csv")
        self.assertEqual(result.returncode, 2)
        self.assertEqual((self.folder / "old.csv").read_text(encoding="ascii"), "old")
        self.assertFalse((self.folder / "old.csv.partial").exists())

    def test_wrong_options_are_refused(self):
        for arguments in (["--min-npe", "-1"], ["--min-npe", "nan"], ["--min-npe", "x"], ["--geometry", "none.json"], ["--nonsense"], ["-o", "none/digits.csv"],
                          ["-o", "."], ["-o", "raw.csv"], ["-o", "cabling.txt"], ["-o", "digits.csv.gz"]):
            with self.subTest(arguments=arguments):
                result = self.digitise(RAW_HEADER, *arguments)
                self.expect_refused(result)
                self.assertNotEqual(result.stderr, "")
        self.assertEqual((self.folder / "cabling.txt").read_text(encoding="ascii"), CABLING)
        self.assertEqual(self.run_program("scifi-digitise").returncode, 2)
        self.assertEqual(self.run_program("scifi-digitise", "raw.csv", "--cabling", "cabling.txt").returncode, 2)
        self.assertEqual(self.run_program("scifi-digitise", "--help").returncode, 0)

    def test_spill_numbers_that_do_not_fit_are_refused(self):
        raw = RAW_HEADER + "3000000000,{},{},{},90\n".format(*CABLE[(0, 1, 0, 0)])
        self.expect_refused(self.digitise(raw, "-o", "digits.json"), "event 3000000000 cannot be the number of a spill")

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_a_full_disk_is_status_three(self):
        self.assertEqual(self.digitise(RAW_HEADER, "-o", "/dev/full").returncode, 3)


if __name__ == "__main__":
    programs.find("scifi-digitise")
    unittest.main()
