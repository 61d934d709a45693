#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-reconstruct --monitor from the outside: the histograms in the page, and that the tracks do not notice.

Usage: monitor_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone: the page here is a stand-in for the real one, which pages_test.py opens in a browser.
Exit status 77: a program was not built.
"""

import collections
import json
import math
import shutil
import subprocess
import time
import unittest

import programs

EVENTS = 700


class Monitor(programs.BesideItsPage):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.install("scifi-reconstruct", "monitor.html")
        cls.make("scifi-simulate", "--events", EVENTS, "--seed", 6, "--output", "m")
        cls.watched = cls.run_program("m_digits.csv", "--output", "watched.csv", "--track-points", "points.csv", "--monitor", "m.html", "--threads", "2")
        cls.data = json.loads(cls.data_of("m.html")) if cls.watched.returncode == 0 else None

    def setUp(self):
        self.assertEqual(self.watched.returncode, 0, self.watched.stderr)

    def plot(self, name, tracker):
        found = next(p for p in self.data["plots"] if p["name"] == name)
        return found["x"], next(s for s in found["series"] if s["tracker"] == tracker)

    def test_the_tracks_are_the_same_bytes_with_and_without(self):
        plain = self.run_program("m_digits.csv", "--output", "plain.csv", "--track-points", "plain_points.csv")
        self.assertEqual(plain.returncode, 0, plain.stderr)
        for with_it, without in (("watched.csv", "plain.csv"), ("points.csv", "plain_points.csv")):
            self.assertEqual((self.folder / with_it).read_bytes(), (self.folder / without).read_bytes())

    def test_status(self):
        status = self.data["status"]
        self.assertEqual(status["state"], "done")
        self.assertEqual(status["events"], EVENTS)
        self.assertLess(abs(status["written_at"] - time.time()), 300.0)

    def test_hit_maps_count_every_digit(self):
        expected = collections.Counter((int(r["tracker"]), int(r["station"]), int(r["plane"]), int(r["channel"])) for r in programs.rows(self.folder / "m_digits.csv"))
        found = collections.Counter()
        for tracker in self.data["trackers"]:
            self.assertEqual(len(tracker["planes"]), 15)
            for plane in tracker["planes"]:
                self.assertEqual(len(plane["hits"]), plane["channels"])
                for channel, hits in enumerate(plane["hits"]):
                    if hits > 0:
                        found[tracker["tracker"], plane["station"], plane["plane"], channel] = hits
        self.assertEqual(found, expected)

    def check_histogram(self, name, tracker, values):
        x, series = self.plot(name, tracker)
        width = (x["high"] - x["low"]) / x["bins"]
        expected = [0] * x["bins"]
        outside = 0
        near_edge = 0
        for value in values:
            place = (value - x["low"]) / width
            near_edge += abs(place - round(place)) < 1e-3  # the table is rounded
            if 0 <= place < x["bins"]:
                expected[math.floor(place)] += 1
            else:
                outside += 1
        self.assertEqual(sum(series["counts"]) + series["underflow"] + series["overflow"], len(values))
        self.assertLessEqual(sum(abs(a - b) for a, b in zip(series["counts"], expected)), 2 * near_edge)
        self.assertGreater(len(values), 100)

    def test_histograms_are_those_of_the_tables(self):
        digits, tracks, points = (programs.rows(self.folder / name) for name in ("m_digits.csv", "watched.csv", "points.csv"))
        for tracker in (0, 1):
            here = lambda table: [r for r in table if int(r["tracker"]) == tracker]  # noqa: E731
            self.check_histogram("light", tracker, [float(r["npe"]) for r in here(digits)])
            self.check_histogram("pt", tracker, [math.hypot(float(r["px_MeV"]), float(r["py_MeV"])) for r in here(tracks)])
            self.check_histogram("pz", tracker, [abs(float(r["pz_MeV"])) for r in here(tracks)])
            self.check_histogram("p_values", tracker, [float(r["p_value"]) for r in here(tracks)])
            self.check_histogram("residuals", tracker, [float(r["residual_mm"]) for r in here(points) if r["residual_mm"] != "nan"])
            self.check_histogram("pulls", tracker, [float(r["pull"]) for r in here(points) if r["pull"] != "nan"])
            per_event = collections.Counter(r["event"] for r in here(tracks))
            self.check_histogram("tracks", tracker, [per_event[str(e)] for e in range(EVENTS)])

    def test_channel_sums_peak_at_what_is_expected(self):
        for tracker in (0, 1):
            x, series = self.plot("channel_sums", tracker)
            centres = [x["low"] + (i + 0.5) * (x["high"] - x["low"]) / x["bins"] for i in range(x["bins"])]
            near = sum(n for c, n in zip(centres, series["counts"]) if abs(c) < 0.8)
            self.assertGreater(near, 0.85 * sum(series["counts"]))

    def test_space_points_of_an_event_are_counted_once_an_event(self):
        for tracker in (0, 1):
            _, series = self.plot("space_points", tracker)
            self.assertEqual(sum(series["counts"]) + series["overflow"], EVENTS)

    def test_the_page_is_whole_at_any_moment(self):
        digits = (self.folder / "m_digits.csv").read_text(encoding="utf-8").splitlines(True)
        shift = lambda line, by: f"{int(line.split(',', 1)[0]) + by},{line.split(',', 1)[1]}"  # noqa: E731
        with open(self.folder / "long.csv", "w", encoding="utf-8") as out:
            out.write(digits[0])
            for copy in range(20):
                out.writelines(shift(line, copy * EVENTS) for line in digits[1:])
        page = self.folder / "live.html"
        run = subprocess.Popen([self.program, "long.csv", "--output", "long_tracks.csv", "--monitor", page, "--monitor-every", "0.2", "--threads", "1"],
                               cwd=self.folder, stdout=subprocess.DEVNULL)
        seen = []
        while run.poll() is None:
            if page.exists():
                seen.append(json.loads(self.data_of(page))["status"])
            time.sleep(0.02)
        self.assertEqual(run.returncode, 0)
        seen.append(json.loads(self.data_of(page))["status"])
        events = [s["events"] for s in seen]
        self.assertEqual(events, sorted(events))
        self.assertEqual(seen[0]["state"], "running")
        self.assertEqual((seen[-1]["state"], seen[-1]["events"]), ("done", 20 * EVENTS))
        self.assertGreater(len(set(events)), 2)
        self.assertFalse((self.folder / "live.html.partial").exists())

    def test_a_run_that_meets_bad_input_says_so_in_the_page(self):
        text = (self.folder / "m_digits.csv").read_text(encoding="utf-8")
        (self.folder / "broken.csv").write_text(text + "oops\n", encoding="utf-8")
        result = self.run_program("broken.csv", "--output", "broken_tracks.csv", "--monitor", "broken.html")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(json.loads(self.data_of(self.folder / "broken.html"))["status"]["state"], "stopped")

    def test_what_is_given_wrongly_is_named(self):
        for status, word, arguments in (
                (2, "would overwrite", ["--monitor", "m_digits.csv"]),
                (2, "same file", ["--track-points", "a.html", "--monitor", "a.html"]),
                (2, "no_folder", ["--monitor", "no_folder/m.html"]),
                (2, "--monitor-every", ["--monitor", "b.html", "--monitor-every", "0"]),
                (2, "--monitor", ["--monitor-every", "3"])):
            result = self.run_program("m_digits.csv", "--output", "unused.csv", *arguments)
            self.assertEqual(result.returncode, status, (arguments, result.stderr))
            self.assertIn(word, result.stderr)

    def test_without_the_page_it_says_how_to_make_it(self):
        elsewhere = self.folder / "elsewhere" / "bin"
        elsewhere.mkdir(parents=True, exist_ok=True)
        shutil.copy(programs.BIN / "scifi-reconstruct", elsewhere)
        result = subprocess.run([elsewhere / "scifi-reconstruct", "m_digits.csv", "--monitor", "x.html"], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 3)
        self.assertIn("scripts/web_assets", result.stderr)


if __name__ == "__main__":
    programs.find("scifi-simulate", "scifi-reconstruct")
    if "--monitor" not in subprocess.run([programs.BIN / "scifi-reconstruct", "--help"], capture_output=True, text=True, check=True).stdout:
        programs.skip("built without scifi::study, so without --monitor")
    unittest.main(verbosity=2)
