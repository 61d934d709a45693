#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-display from the outside: what its page holds, what Phoenix gets, and what it says when the input is bad.

Usage: display_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone: the page here is a stand-in for the real one, which pages_test.py opens in a browser.
Exit status 77: a program was not built.
"""

import collections
import json
import math
import os
import shutil
import subprocess
import unittest

import programs



class Display(programs.BesideItsPage):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.install("scifi-display", "display.html")
        cls.make("scifi-simulate", "--events", 12, "--tracks-per-event", 2, "--seed", 4, "--output", "m")
        cls.make("scifi-reconstruct", "m_digits.csv", "--track-points", "points.csv")
        cls.given = ["m_digits.csv", "--tracks", "tracks.csv", "--track-points", "points.csv", "--truth", "m_truth.csv"]

    def view(self, *arguments):
        result = self.run_program(*arguments, "--output", "out.html")
        self.assertEqual(result.returncode, 0, result.stderr)
        data = self.data_of("out.html")
        self.assertNotIn("<", data)
        return json.loads(data)

    def test_every_digit_and_every_track_of_the_files_is_there(self):
        view = self.view(*self.given)
        digits, tracks = collections.Counter(r["event"] for r in programs.rows(self.folder / "m_digits.csv")), collections.Counter()
        for row in programs.rows(self.folder / "tracks.csv"):
            tracks[row["event"]] += 1
        self.assertEqual(len(view["events"]), 12)
        for event in view["events"]:
            self.assertEqual(len(event["digits"]), digits[str(event["event"])])
            self.assertEqual(len(event["tracks"]), tracks[str(event["event"])])
        self.assertGreater(sum(tracks.values()), 12)

    def test_tracks_are_drawn_through_their_points_and_near_the_true_particles(self):
        view = self.view(*self.given)
        points = collections.defaultdict(list)
        for row in programs.rows(self.folder / "points.csv"):
            points[int(row["event"]), int(row["track"])].append([float(row[name]) for name in ("x_mm", "y_mm", "z_mm")])
        near = 0
        for event in view["events"]:
            for track in event["tracks"]:
                expected = points[event["event"], track["track"]]
                self.assertEqual(len(track["points"]), len(expected))
                for at, other in zip(track["points"], expected):
                    self.assertLess(max(abs(a - b) for a, b in zip(at["at"], other)), 1e-3)
                    self.assertIn(at["at"], track["curve"])
                truth = [p for p in event["truth"] if p["tracker"] == track["tracker"]]
                # Half way between the stations, where no measurement is: the nearest true curve is a few mm away, were a turn lost it would be tens.
                middle = track["curve"][len(track["curve"]) // 2]
                away = min((math.dist(middle, p) for one in truth for p in one["curve"]), default=math.inf)
                near += away < 12.0
        self.assertGreater(near, 0.9 * sum(len(e["tracks"]) for e in view["events"]))

    def test_digits_alone_are_reconstructed_here_with_the_same_tracks(self):
        view = self.view("m_digits.csv")
        ours = [(e["event"], t["track"], t["pz"][0]) for e in view["events"] for t in e["tracks"]]
        theirs = [(int(r["event"]), int(r["track"]), float(r["pz_MeV"])) for r in programs.rows(self.folder / "tracks.csv")]
        self.assertEqual([o[:2] for o in ours], [t[:2] for t in theirs])
        for o, t in zip(ours, theirs):
            self.assertAlmostEqual(o[2], t[2], delta=1e-3)
        self.assertNotIn("truth", view["events"][0])

    def test_tracks_can_be_shown_without_digits(self):
        view = self.view("--tracks", "tracks.csv")
        self.assertEqual(sum(len(e["tracks"]) for e in view["events"]), len(programs.rows(self.folder / "tracks.csv")))
        self.assertEqual(view["events"][0]["digits"], [])

    def test_channels_lie_in_the_planes_where_the_space_points_are(self):
        for event in self.view(*self.given)["events"]:
            lines = {(d["tracker"], d["station"], d["plane"], d["channel"]): d for d in event["digits"]}
            for point in event["space_points"]:
                x, y, _ = point["at"]
                for plane, channel in point["channels"]:
                    line = lines[point["tracker"], point["station"], plane, math.floor(channel)]
                    (ax, ay, _), (bx, by, _) = line["from"], line["to"]
                    distance = abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / math.hypot(bx - ax, by - ay)
                    self.assertLess(distance, 3.5)  # two channels and the lever of the slope between the planes

    def test_some_of_the_events(self):
        self.assertEqual([e["event"] for e in self.view(*self.given, "--first", "3", "--events", "4")["events"]], [3, 4, 5, 6])
        result = self.run_program(*self.given, "--events", "2", "--output", "two.html")
        self.assertIn("there are more", result.stdout)

    def test_a_title_cannot_break_out_of_its_place(self):
        title = "</script><script>alert(1)</script>"
        self.assertEqual(self.view("m_digits.csv", "--title", title)["title"], title)

    def test_events_for_phoenix(self):
        result = self.run_program(*self.given, "--output", "p.html", "--phoenix", "p.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        phoenix = json.loads((self.folder / "p.json").read_text(encoding="utf-8"))
        view = self.view(*self.given)
        self.assertEqual(list(phoenix), [f"Event {e['event']}" for e in view["events"]])
        for event, name in zip(view["events"], phoenix):
            tracks = phoenix[name]["Tracks"].get("Fitted tracks", [])
            self.assertEqual(len(tracks), len(event["tracks"]))
            for track in tracks:
                self.assertGreater(len(track["pos"]), 2)
                self.assertTrue(all(len(p) == 3 and all(map(math.isfinite, p)) for p in track["pos"]))
                self.assertGreater(track["momentum"][2], 0.0)
            hits = phoenix[name]["Hits"]
            self.assertEqual(sum(len(h) for k, h in hits.items() if k.startswith("Channels")), len(event["digits"]))
            self.assertEqual(len(hits["Space points"]), len(event["space_points"]))

    def test_the_data_of_the_page_alone(self):
        self.run_program(*self.given, "--output", "j.html", "--json", "j.json")
        self.assertEqual(json.loads((self.folder / "j.json").read_text(encoding="utf-8")), self.view(*self.given))

    def refused(self, status, words, *arguments):
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, status, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_what_is_given_wrongly_is_named(self):
        (self.folder / "bad.csv").write_text("event,tracker,station,plane,channel,npe\n0,0,1,0,999,5\n", encoding="utf-8")
        self.refused(2, ["bad.csv:2", "channel"], "bad.csv")
        (self.folder / "cut.csv").write_text("event,tracker,track\n0,0,0\n", encoding="utf-8")
        self.refused(2, ["cut.csv:1", "model"], "--tracks", "cut.csv")
        self.refused(2, ["missing.csv"], "missing.csv")
        self.refused(2, ["nothing to show"])
        self.refused(2, ["--track-points"], "m_digits.csv", "--track-points", "points.csv")
        self.refused(2, ["would overwrite"], "m_digits.csv", "--output", "m_digits.csv")
        self.refused(2, ["same file"], "m_digits.csv", "--output", "a.html", "--phoenix", "a.html")
        self.refused(2, ["--events"], "m_digits.csv", "--events", "0")
        self.refused(2, ["points.csv", "track"], "--tracks", self.without_the_first_track(), "--track-points", "points.csv")
        self.assertEqual([p for p in self.folder.iterdir() if p.name.endswith(".partial")], [])

    def without_the_first_track(self):
        lines = (self.folder / "tracks.csv").read_text(encoding="utf-8").splitlines(True)
        (self.folder / "fewer.csv").write_text(lines[0] + "".join(lines[2:]), encoding="utf-8")
        return "fewer.csv"

    def test_without_the_page_it_says_how_to_make_it(self):
        elsewhere = self.folder / "elsewhere" / "bin"
        elsewhere.mkdir(parents=True, exist_ok=True)
        shutil.copy(programs.BIN / "scifi-display", elsewhere)
        result = subprocess.run([elsewhere / "scifi-display", "m_digits.csv"], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 3)
        self.assertIn(f"scripts/web_assets {elsewhere.parent / 'share/scifi'}", result.stderr)


if __name__ == "__main__":
    programs.find("scifi-display", "scifi-simulate", "scifi-reconstruct")
    os.environ.pop("SCIFI_SHARED_DATA", None)
    unittest.main(verbosity=2)
