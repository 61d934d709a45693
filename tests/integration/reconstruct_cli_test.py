#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-reconstruct from the outside: what it finds, and what it says and leaves behind when the input is bad.

Usage: reconstruct_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone. Exit status 77: the program was not built.
SCIFI_SHARED_DATA in the environment names the folder of external data; tests that need it are skipped without.
"""

import csv
import gzip
import json
import math
import os
import subprocess
import unittest

import programs

HEADER = "event,tracker,station,plane,channel,adc,npe\n"
# The downstream tracker of MICE: origins of its stations, mm; views and channels of its planes (see the geometry headers).
ORIGINS = [(0.0, 0.0, 0.0), (-0.4698, 0.0052, 200.8936), (-0.6717, -0.1759, 449.8990), (0.1722, -0.2912, 749.8284), (0.0, 0.0, 1099.9026)]
PLANES = [(120.0, 106.5), (-120.0, 106.5), (0.0, 105.5)]
CHANNEL_WIDTH = 0.5 * 0.427 * 7
PLANE_STEP = 0.025 + 0.27734 + 0.350
FIELD = 3.0
CURVATURE = 0.299792458  # MeV/c per tesla, mm and unit charge


def digits_of(path):
    """Digits of one particle, path(z) -> (x, y): the channel whose middle is nearest in every plane."""
    for s, (x0, y0, z0) in enumerate(ORIGINS, 1):
        for p, (angle, central) in enumerate(PLANES):
            x, y = path(z0 + (p + 0.5) * PLANE_STEP)
            a = math.radians(angle)
            alpha = (x - x0) * math.cos(a) + (y - y0) * math.sin(a)
            yield f"1,{s},{p},{round(central - alpha / CHANNEL_WIDTH)},90,10.5"


def helix(x, y, px, py, pz):
    """A positive particle in a field along z: d(px)/dz = k py/pz, d(py)/dz = -k px/pz."""
    k = CURVATURE * FIELD

    def at(z):
        t = k * z / pz
        s, c = math.sin(t), math.cos(t)
        return x + (px * s + py * (1 - c)) / k, y + (py * s - px * (1 - c)) / k

    return at


def particle(event):
    """Starting values of an event's particle, spread over the tracker without chance."""
    phase = 2.399963 * event  # golden angle
    radius = 20.0 + 5.0 * (event % 7)
    pt = 20.0 + 3.0 * (event % 11)
    return radius * math.cos(phase), radius * math.sin(phase), pt * math.cos(1.7 * phase), pt * math.sin(1.7 * phase), 160.0 + 5.0 * (event % 13)


def helical_events(numbers):
    return "".join(f"{n},{d}\n" for n in numbers for d in digits_of(helix(*particle(n))))


GOOD = helical_events(range(3))


class Reconstruct(programs.InAFolder):
    def run_on(self, content, *arguments, name="digits.csv"):
        if content is not None:
            self.write(name, content)
        return self.run_program("scifi-reconstruct", *arguments, name)

    def rows(self, name="tracks.csv"):
        return super().rows(name)

    def expect_refused(self, result, *sentences, status=2):
        self.assertEqual(result.returncode, status, result.stderr)
        for sentence in sentences:
            self.assertIn(sentence, result.stderr)
        self.assertNotIn("tracks.csv", self.files())

    # What is found

    def test_particles_are_found_where_they_are(self):
        events = range(40)
        result = self.run_on(HEADER + helical_events(events), "--field", str(FIELD), "--track-points", "points.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = self.rows()
        self.assertEqual([int(r["event"]) for r in rows], list(events))
        for r in rows:
            x, y, px, py, pz = particle(int(r["event"]))
            self.assertEqual((r["tracker"], r["track"], r["model"], r["charge"]), ("1", "0", "helix", "1"))
            # Channels are 1.5 mm wide and nothing was scattered or lost; the fit corrects for a loss of some 2 MeV.
            for name, true, window in (("x_mm", x, 2.0), ("y_mm", y, 2.0), ("px_MeV", px, 5.0), ("py_MeV", py, 5.0), ("pz_MeV", pz, 15.0)):
                self.assertLess(abs(float(r[name]) - true), window, (name, r))
            self.assertEqual(float(r["z_mm"]), 0.0)
        points = self.rows("points.csv")
        self.assertEqual(len(points), 15 * len(events))
        self.assertEqual([int(p["event"]) for p in points], sorted(int(p["event"]) for p in points))
        for sentence in ("events                    40", "tracks                    40", "failures                   0", "events/s", "units: mm"):
            self.assertIn(sentence, result.stdout)

    def test_straight_tracks_have_slopes_times_the_given_momentum(self):
        tx, ty = 0.05, -0.08
        text = HEADER + "".join(f"0,{d}\n" for d in digits_of(lambda z: (10 + tx * z, 20 + ty * z)))
        result = self.run_on(text, "--field", "0", "--momentum", "180")
        self.assertEqual(result.returncode, 0, result.stderr)
        (row,) = self.rows()
        self.assertEqual(row["model"], "line")
        self.assertAlmostEqual(float(row["pz_MeV"]), 180.0, delta=10.0)
        self.assertAlmostEqual(float(row["px_MeV"]) / float(row["pz_MeV"]), tx, delta=0.01)
        self.assertAlmostEqual(float(row["py_MeV"]) / float(row["pz_MeV"]), ty, delta=0.01)
        self.assertAlmostEqual(float(row["x_mm"]), 10.0, delta=1.5)

    def test_output_does_not_depend_on_the_number_of_threads(self):
        text = HEADER + helical_events(range(1500))
        outputs = set()
        for threads in ("1", "2", "5"):
            result = self.run_on(text, "--threads", threads, "--track-points", "points.csv")
            self.assertEqual(result.returncode, 0, result.stderr)
            outputs.add(((self.folder / "tracks.csv").read_bytes(), (self.folder / "points.csv").read_bytes()))
        self.assertEqual(len(outputs), 1)
        numbers = [int(r["event"]) for r in self.rows()]
        self.assertEqual(numbers, sorted(numbers))
        self.assertGreater(len(numbers), 1400)

    def test_what_other_programs_write_is_read(self):
        self.run_on(HEADER + GOOD)
        expected = (self.folder / "tracks.csv").read_bytes()
        quoted = ",".join(f'"{c}"' for c in HEADER.strip().split(",")) + "\n"
        extra = "note," + HEADER + "".join("x," + line + "\n" for line in GOOD.splitlines())
        for text in (HEADER + GOOD.rstrip("\n"), (HEADER + GOOD).replace("\n", "\r\n"), HEADER + GOOD + "\n\n \n", "\ufeff" + HEADER + GOOD, quoted + GOOD,
                     extra, gzip.compress((HEADER + GOOD).encode())):
            result = self.run_on(text)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual((self.folder / "tracks.csv").read_bytes(), expected)

    def test_a_table_without_rows_gives_a_table_without_rows(self):
        self.assertEqual(self.run_on(HEADER).returncode, 0)
        self.assertEqual(self.rows(), [])

    def test_mice_json_is_read(self):
        digits = []
        for line in GOOD.splitlines():
            if line.startswith("0,"):
                _, tracker, station, plane, channel, _, npe = line.split(",")
                digits.append({"tracker": int(tracker), "station": int(station), "plane": int(plane), "channel": int(channel), "npe": float(npe)})
        spill = {"maus_event_type": "Spill", "spill_number": 1, "recon_events": [{"sci_fi_event": {"digits": digits}}]}
        text = '{"maus_event_type": "JobHeader"}\n' + json.dumps(spill) + "\n"
        result = self.run_on(text, name="spills.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        from_json = (self.folder / "tracks.csv").read_bytes()
        self.run_on(HEADER + "".join(line + "\n" for line in GOOD.splitlines() if line.startswith("0,")))
        self.assertEqual((self.folder / "tracks.csv").read_bytes(), from_json)
        digits[3]["channel"] = 500
        (self.folder / "tracks.csv").unlink()
        result = self.run_on(text.splitlines()[0] + "\n" + json.dumps(spill), name="spills.json")
        self.expect_refused(result, "spills.json:2: recon_events[0].sci_fi_event.digits[3].channel: 500 is outside 0 .. 213")

    def test_an_event_with_ten_thousand_digits_does_not_hang(self):
        views = [{"plane": i, "view": "VWU"[i], "angle": (120.0, -120.0, 0.0)[i], "channels": 700, "central_channel": 349.5,
                  "z_mylar": [0.7 * i, 0.7 * i + 0.025], "z_fibres": [0.7 * i + 0.025, 0.7 * i + 0.65]} for i in range(3)]
        stations = [{"station": s, "position": [0, 0, 250.0 * (s - 1)]} for s in range(1, 6)]
        geometry = {"format": "scifi-geometry", "version": 1, "channel_width": 1.5, "fiducial_radius": 500.0, "planes": views,
                    "trackers": [{"tracker": 1, "beam_direction": 1, "stations": stations}]}
        (self.folder / "wide.json").write_text(json.dumps(geometry), encoding="ascii")
        channels = [(s, p, c) for s in range(1, 6) for p in range(3) for c in range(700) if (c * 31 + s * 7 + p) % 21 != 0]
        text = HEADER + "".join(f"0,1,{s},{p},{c},9,9.5\n" for s, p, c in channels[:10000])
        result = self.run_on(text, "--geometry", "wide.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("digits                 10000", result.stdout)
        self.assertNotIn("events flagged             0", result.stdout)

    @unittest.skipUnless(os.environ.get("SCIFI_SHARED_DATA"), "needs external data")
    def test_the_experiments_own_simulation_is_reconstructed_as_by_its_own_software(self):
        """pt and pz, MeV/c, that the software of MICE fits to these digits (event, tracker); its field is 4 T in both trackers."""
        published = {(2, 0): (50.4, 172.4), (3, 0): (57.7, 174.1), (4, 0): (33.9, 184.1), (0, 1): (8.9, 201.4), (1, 1): (15.6, 186.6),
                     (2, 1): (13.0, 181.3), (3, 1): (51.6, 175.4), (4, 1): (62.3, 177.9)}
        digits = os.path.abspath(os.path.join(os.environ["SCIFI_SHARED_DATA"], "mice", "test_helical_digits.json"))
        result = self.run_on(None, "--field", "4", name=digits)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("space points              50", result.stdout)
        found = {(int(r["event"]), int(r["tracker"])): r for r in self.rows()}
        self.assertEqual(len(found), 10)
        for key, (pt, pz) in published.items():
            row = found[key]
            # Two fits to the same digits: they differ by less than the error of one of them.
            self.assertLess(abs(math.hypot(float(row["px_MeV"]), float(row["py_MeV"])) - pt), 1.0, key)
            self.assertLess(abs(abs(float(row["pz_MeV"])) - pz), 1.0 + float(row["sigma_pz_MeV"]), key)

    # What is refused

    def test_bad_rows_are_refused_with_file_line_and_field(self):
        last = 1 + len(GOOD.splitlines())
        bad = last + 1
        for row, message in (
                ("3,1,1,0,57,9,abc", "npe: 'abc' is not a number"),
                ("3,1,1,0,57,9,nan", "npe: 'nan' is not a finite number"),
                ("3,1,1,0,57,9,-2.5", "npe: -2.500000 is negative"),
                ("3,1,1,0,57,9,", "npe: the field is empty"),
                ("3,1,1,0,5x,9,4", "channel: '5x' is not a whole number"),
                ("3,1,1,0,214,9,4", "channel: 214 is outside 0 .. 213"),
                ("3,1,1,2,212,9,4", "channel: 212 is outside 0 .. 211"),
                ("3,1,1,0,-1,9,4", "channel: -1 is outside 0 .. 213"),
                ("3,1,1,3,57,9,4", "plane: there is no plane 3 in station 1"),
                ("3,1,6,0,57,9,4", "station: there is no station 6 in tracker 1"),
                ("3,2,1,0,57,9,4", "tracker: there is no tracker 2"),
                ("3,1,1,0,57,4", "6 fields where the header names 7"),
                ("1,1,1,0,57,9,4", "event: 1 comes after 2"),
                ("3000000000000000000000,1,1,0,57,9,4", "event: '3000000000000000000000' is too large"),
                (GOOD.splitlines()[-1], "channel: a second digit of channel")):
            with self.subTest(row=row):
                result = self.run_on(HEADER + GOOD + row + "\n")
                self.expect_refused(result, f"digits.csv:{bad}: {message}", "events before the mistake are kept in tracks.csv.partial")
                # The last event may lack digits, so it is not there.
                self.assertLessEqual({r["event"] for r in self.rows("tracks.csv.partial")}, {"0", "1", "2"})
                self.assertIn("0", {r["event"] for r in self.rows("tracks.csv.partial")})

    def test_bad_files_are_refused(self):
        packed = gzip.compress((HEADER + helical_events(range(200))).encode())
        for content, message in ((b"", "digits.csv: the file is empty"),
                                 (b"\n", "digits.csv:1: event: the header has no column of this name"),
                                 (GOOD.encode(), "digits.csv:1: event: the header has no column of this name"),
                                 (b"event,tracker,station,plane,channel,adc\n0,1,1,0,57,9\n", "digits.csv:1: npe: the header has no column of this name"),
                                 (packed[:len(packed) // 2], ": the gzip data end too early: the file is truncated"),
                                 (packed[:-4], ": the gzip data end too early: the file is truncated"),
                                 (packed[:5], "digits.csv:1: the gzip data end too early"),
                                 (bytes(range(256)) * 50, "digits.csv:1: event: the header has no column of this name"),
                                 (b"\0" * 3000000, "digits.csv:1: the line is longer than 1048576 bytes")):
            with self.subTest(message=message):
                self.expect_refused(self.run_on(content), message)
        self.expect_refused(self.run_on(None, name="none.csv"), "none.csv: cannot be opened: No such file or directory")
        self.expect_refused(self.run_on(None, name="."), ".: cannot be read: Is a directory")

    def test_a_bad_input_leaves_older_tracks_alone_and_keeps_what_it_found(self):
        (self.folder / "old.csv").write_text("old", encoding="ascii")
        result = self.run_on(HEADER + GOOD + "9,9,9,9,9,9,9\n", "--output", "old.csv", "--track-points", "points.csv")
        self.assertEqual(result.returncode, 2)
        self.assertIn("old.csv.partial, points.csv.partial", result.stderr)
        self.assertEqual((self.folder / "old.csv").read_text(encoding="ascii"), "old")
        self.assertEqual(self.files(), ["digits.csv", "old.csv", "old.csv.partial", "points.csv.partial"])

    def test_nothing_is_kept_when_nothing_was_found(self):
        self.expect_refused(self.run_on(HEADER + "0,9,9,9,9,9,9\n"), "digits.csv:2: tracker: there is no tracker 9")
        self.assertEqual(self.files(), ["digits.csv"])

    def test_wrong_options_are_refused(self):
        for arguments in (["--field", "abc"], ["--field", "nan"], ["--min-npe", "-1"], ["--momentum", "0"], ["--threads", "-3"], ["--threads", "x"],
                          ["--particle", "unicorn"], ["--nonsense"], ["--geometry", "none.json"], ["--output", "none/tracks.csv"], ["--output", "."],
                          ["--output", "digits.csv"], ["--output", "a.csv", "--track-points", "a.csv"]):
            with self.subTest(arguments=arguments):
                result = self.run_on(HEADER + GOOD, *arguments)
                self.expect_refused(result)
                self.assertNotEqual(result.stderr, "")
                self.assertEqual(self.files(), ["digits.csv"])
        self.assertEqual(subprocess.run([programs.BIN / "scifi-reconstruct"], capture_output=True, check=False, timeout=60).returncode, 2)
        self.assertEqual(subprocess.run([programs.BIN / "scifi-reconstruct", "--help"], capture_output=True, check=False, timeout=60).returncode, 0)

    def test_a_wrong_geometry_is_refused(self):
        for content, message in (("{", "g.json:1: is not JSON"), ('{"format": "scifi-geometry", "version": 2}', "g.json: version: version 2 is newer than version 1"),
                                 ("{}", "g.json: trackers: is missing")):
            (self.folder / "g.json").write_text(content, encoding="ascii")
            self.expect_refused(self.run_on(HEADER + GOOD, "--geometry", "g.json"), message)

    @unittest.skipUnless(os.path.exists("/dev/full"), "no device that is always full")
    def test_a_full_disk_is_an_error(self):
        result = self.run_on(HEADER + GOOD, "--output", "/dev/full")
        self.expect_refused(result, "/dev/full: could not be written: No space left on device", status=3)
        self.assertEqual(self.files(), ["digits.csv"])

    @unittest.skipUnless(os.path.exists("/dev/stdout"), "no name for standard output")
    def test_tracks_may_go_to_standard_output(self):
        self.run_on(HEADER + GOOD)
        result = self.run_on(None, "--output", "/dev/stdout")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, (self.folder / "tracks.csv").read_text(encoding="ascii"))
        self.assertIn("events/s", result.stderr)


if __name__ == "__main__":
    programs.find("scifi-reconstruct")
    unittest.main()
