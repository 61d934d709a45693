#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-study from the outside: its numbers beside ones computed here, its page, and what it says when the input is bad.

Usage: study_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone; without a Python that has matplotlib the page is not tested. Exit status 77: the
program was not built. SCIFI_SHARED_DATA in the environment names the folder of external data; tests that need it are skipped without.
"""

import base64
import csv
import gzip
import html.parser
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import programs

EVENTS = 400
TRUTH_HEADER = "event,track,pdg,tracker,station,plane,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV\n"


def python_that_draws():
    for python in ("python3", "/usr/bin/python3"):
        if shutil.which(python) and subprocess.run([python, "-c", "import matplotlib, numpy"], capture_output=True, check=False).returncode == 0:
            return python
    return None


def quantile(values, q):
    values = sorted(values)
    place = q * (len(values) - 1)
    i = int(place)
    return values[i] + (values[min(i + 1, len(values) - 1)] - values[i]) * (place - i)


def spread(values):
    return 0.5 * (quantile(values, 0.84135) - quantile(values, 0.15865))


def wilson(k, n):
    return (k + 0.5) / (n + 1), math.sqrt(k * (n - k) / n + 0.25) / (n + 1)  # one standard deviation: centre, half width


class Comparison:
    """The comparison with the truth once more, in other words."""

    def __init__(self, truth, tracks, tracker):
        planes = {}
        for r in programs.rows(truth):
            if int(r["tracker"]) == tracker:
                state = [float(r[k]) for k in ("x_mm", "y_mm", "px_MeV", "py_MeV", "pz_MeV")]
                planes.setdefault((int(r["event"]), int(r["track"])), {})[int(r["station"]), int(r["plane"])] = state
        particles = {}  # event -> [(state, complete stations, expected)]
        for (event, _), seen in planes.items():
            if (1, 0) not in seen:
                continue
            good = [s for s in range(1, 6) if all(math.hypot(*seen.get((s, p), (999, 0))[:2]) < 150 for p in range(3))]
            at = seen[1, 0]
            particles.setdefault(event, []).append([at, len(good), len(good) > 3 and 1 in good and math.hypot(at[2], at[3]) < 0.5 * abs(at[4]), None])
        self.ghosts = 0
        fitted = {}
        for r in programs.rows(tracks):
            if int(r["tracker"]) == tracker:
                fitted.setdefault(int(r["event"]), []).append(r)
        for event, found in fitted.items():
            pairs = []
            for p in particles.get(event, []):
                for i, r in enumerate(found):
                    off = [float(r[k]) - p[0][j] for j, k in enumerate(("x_mm", "y_mm", "px_MeV", "py_MeV"))]
                    if math.hypot(*off[:2]) < 6 and math.hypot(*off[2:]) < 25:
                        pairs.append((2 * math.hypot(*off[:2]) + math.hypot(*off[2:]), i, p))
            used = set()
            for _, i, p in sorted(pairs, key=lambda q: q[0]):
                if p[3] is None and i not in used:
                    p[3] = found[i]
                    used.add(i)
            self.ghosts += len(found) - len(used)
        self.expected = [p for of_event in particles.values() for p in of_event if p[2]]
        self.found = [p for p in self.expected if p[3] is not None]
        self.compared = [p for p in self.found if p[1] == 5]

    def column(self, of):
        return [of(p[0], p[3]) for p in self.compared]


def residual(name):
    def of(true, fit):
        if name == "pt":
            pt = math.hypot(true[2], true[3])
            return (float(fit["px_MeV"]) * true[2] + float(fit["py_MeV"]) * true[3]) / max(pt, 1e-9) - pt
        if name == "pz":
            return abs(float(fit["pz_MeV"])) - abs(true[4])
        return float(fit[name + "_mm"]) - true["xy".index(name)]
    return of


def pull(name):
    i = ["x", "y", "px", "py", "pz"].index(name)
    column = name + ("_mm" if i < 2 else "_MeV")
    return lambda true, fit: (float(fit[column]) - true[i]) / float(fit["sigma_" + column])


def decode_png(data):
    """Width and height; raises where the image is damaged: chunks, their checksums and the packed pixels."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("no PNG")
    at, packed, ended = 8, b"", False
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if zlib.crc32(kind + body) != struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]:
            raise ValueError("checksum")
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
        packed += body if kind == b"IDAT" else b""
        ended = kind == b"IEND"
        at += 12 + length
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    if not ended or len(zlib.decompress(packed)) != height * (1 + (width * depth * channels + 7) // 8):
        raise ValueError("pixels")
    return width, height


class Study(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory(prefix="scifi_study_")
        cls.data = pathlib.Path(cls.shared.name)
        cls.call([programs.BIN / "scifi-simulate", "--events", str(EVENTS), "--tracker", "both", "--seed", "5", "--output", "muons"])
        cls.call([programs.BIN / "scifi-reconstruct", "--field", "3", "--output", "tracks.csv", "--track-points", "points.csv", "muons_digits.csv"])
        cls.study = cls.run_here("muons_truth.csv", "tracks.csv", "--track-points", "points.csv", "--digits", "muons_digits.csv", "--no-page", "-o", "full")
        assert cls.study.returncode == 0, cls.study.stderr
        cls.result = cls.load("full")

    @classmethod
    def tearDownClass(cls):
        cls.shared.cleanup()

    @classmethod
    def call(cls, command):
        subprocess.run(command, cwd=cls.data, check=True, capture_output=True, timeout=120)

    @classmethod
    def run_here(cls, *arguments):
        return subprocess.run([programs.BIN / "scifi-study", *arguments], cwd=cls.data, capture_output=True, text=True, timeout=300, check=False)

    @classmethod
    def load(cls, folder):
        return json.loads((cls.data / folder / "study.json").read_text(encoding="utf-8"))

    # The numbers

    def test_efficiency_and_ghosts_are_those_counted_here(self):
        self.assertEqual([t["tracker"] for t in self.result["trackers"]], [0, 1])
        total = [0, 0]
        for block in self.result["trackers"]:
            own = Comparison(self.data / "muons_truth.csv", self.data / "tracks.csv", block["tracker"])
            e = block["efficiency"]
            self.assertEqual((e["expected"], e["found"], block["ghosts"]), (len(own.expected), len(own.found), own.ghosts))
            self.assertGreater(e["expected"], EVENTS / 2)
            centre, half = wilson(e["found"], e["expected"])
            self.assertAlmostEqual(e["value"], e["found"] / e["expected"])
            self.assertAlmostEqual(e["low"], centre - half)
            self.assertAlmostEqual(e["high"], min(1.0, centre + half))
            for b in block["efficiency_in_bins"]["by_pt"]:
                inside = [p for p in own.expected if b["pt"][0] <= math.hypot(*p[0][2:4]) < b["pt"][1]]
                self.assertEqual((b["expected"], b["found"]), (len(inside), sum(p[3] is not None for p in inside)))
            cells = block["efficiency_in_bins"]["by_pt_and_pz"]
            for b in cells:
                inside = [p for p in own.expected if b["pt"][0] <= math.hypot(*p[0][2:4]) < b["pt"][1] and b["pz"][0] <= abs(p[0][4]) < b["pz"][1]]
                self.assertEqual(b["expected"], len(inside))
            total[0] += e["expected"]
            total[1] += e["found"]
        e = self.result["all"]["efficiency"]
        self.assertEqual([e["expected"], e["found"]], total)

    def test_residuals_pulls_and_chi2_are_those_computed_here(self):
        for block in self.result["trackers"]:
            own = Comparison(self.data / "muons_truth.csv", self.data / "tracks.csv", block["tracker"])
            for name in ("x", "y", "pt", "pz"):
                values = own.column(residual(name))
                r = block["residuals"][name]
                self.assertEqual(r["n"], len(values))
                self.assertAlmostEqual(r["mean"], sum(values) / len(values), places=9)
                self.assertAlmostEqual(r["median"], quantile(values, 0.5), places=9)
                self.assertAlmostEqual(r["spread"], spread(values), places=9)
                self.assertAlmostEqual(r["beyond_5_spreads"], sum(abs(v) > 5 * spread(values) for v in values) / len(values))
                h = r["histogram"]
                self.assertEqual(h["below"] + sum(h["counts"]) + h["above"], len(values))
                step = (h["high"] - h["low"]) / len(h["counts"])
                self.assertEqual(sum(h["counts"][:50]) + h["below"], sum(v < h["low"] + 50 * step for v in values))
            for name in ("x", "y", "px", "py", "pz"):
                values = own.column(pull(name))
                self.assertAlmostEqual(block["pulls"][name]["spread"], spread(values), places=9)
            values = own.column(lambda _, fit: float(fit["chi2"]) / int(fit["ndf"]))
            self.assertAlmostEqual(block["chi2_per_ndf"]["mean"], sum(values) / len(values), places=9)
            p = sorted(own.column(lambda _, fit: float(fit["p_value"])))
            distance = max(max((i + 1) / len(p) - v, v - i / len(p)) for i, v in enumerate(p))
            self.assertAlmostEqual(block["p_value"]["kolmogorov_smirnov_distance"], distance, places=9)
            for b in block["momentum_in_bins"]["by_pt_and_pz"]:
                inside = [p for p in own.compared if b["pt"][0] <= math.hypot(*p[0][2:4]) < b["pt"][1] and b["pz"][0] <= abs(p[0][4]) < b["pz"][1]]
                values = [residual("pt")(p[0], p[3]) for p in inside]
                q = b["residual_pt"]
                self.assertEqual(q["n"], len(values))
                if len(values) > 1:
                    self.assertAlmostEqual(q["median_over_spread"], quantile(values, 0.5) / spread(values), places=9)
                    self.assertEqual(q["shifted"], len(values) > 200 and abs(quantile(values, 0.5)) > 0.03 * spread(values))
            for b in block["momentum_in_bins"]["by_pt"]:
                inside = [residual("pz")(p[0], p[3]) for p in own.compared if b["pt"][0] <= math.hypot(*p[0][2:4]) < b["pt"][1]]
                self.assertEqual(b["residual_pz"]["n"], len(inside))
                if inside:
                    self.assertAlmostEqual(b["residual_pz"]["median"], quantile(inside, 0.5), places=9)

    def test_the_bound_is_near_what_is_reached_and_what_the_fit_states(self):
        for name in ("x", "y", "pt"):
            r = self.result["all"]["residuals"][name]
            # Bound and fit share their model; the spread of some 600 residuals is known to 4 %. Three of those, and 10 % for what a fit of channels loses.
            self.assertLess(abs(r["spread"] / r["bound"] - 1.05), 0.17, (name, r["spread"], r["bound"]))
        for b in self.result["all"]["momentum_in_bins"]["by_pt"][4:]:
            q = b["residual_pz"]
            self.assertLess(abs(q["stated"] / q["bound"] - 1.05), 0.15, b["pt"])

    def test_pulls_at_the_planes_are_normal(self):
        for block in self.result["trackers"]:
            self.assertEqual([(p["station"], p["plane"]) for p in block["planes"]], [(s, p) for s in range(1, 6) for p in range(3)])
            for p in block["planes"]:
                for name, of in p["pulls"].items():
                    # Some 300 tracks: their spread is known to 0.055, their median to 0.07. Four of those.
                    self.assertLess(abs(of["spread"] - 1.0), 0.22, (p["station"], p["plane"], name))
                    self.assertLess(abs(of["median"]), 0.29, (p["station"], p["plane"], name))

    def test_digits_are_counted_and_triplets_sum_to_the_constant(self):
        digits = programs.rows(self.data / "muons_digits.csv")
        for block in self.result["trackers"]:
            mine = [r for r in digits if int(r["tracker"]) == block["tracker"]]
            d = block["digits"]
            self.assertEqual(d["digits_per_event"]["n"], self.result["events"])
            self.assertAlmostEqual(d["digits_per_event"]["mean"], len(mine) / self.result["events"])
            self.assertAlmostEqual(d["digit_npe"]["median"], quantile([float(r["npe"]) for r in mine], 0.5))
            self.assertEqual([s["expected"] for s in block["channel_sums"]], [106.5 + 106.5 + 105.5] * 5)
            counts = {}
            for r in mine:
                counts.setdefault((r["event"], r["station"]), {}).setdefault(r["plane"], []).append(int(r["channel"]))
            # Where a station has one channel in each plane nothing has to be chosen.
            alone = [c for c in counts.values() if len(c) == 3 and all(len(v) == 1 for v in c.values())]
            near = sum(abs(sum(v[0] for v in c.values()) - 318.5) < 3 for c in alone)
            self.assertGreater(near / len(alone), 0.9)  # noise stands in for a missing channel now and then
            for s in block["channel_sums"]:
                self.assertLess(abs(s["median"]), 0.51)
                self.assertGreater(s["n"], 0.9 * block["efficiency"]["found"])

    def test_displays_show_what_was_fitted(self):
        kinds = {d["title"] for d in self.result["displays"]}
        self.assertIn("a typical track", kinds)
        for d in self.result["displays"]:
            for t in d["tracks"]:
                self.assertEqual(len(t["line"]), 221)
                if "centre" not in t or t["pt"] < 10:
                    continue
                # In a field of 3 T, all along the line: the distance from the axis of the helix is pt/(q B).
                z, x, y = t["line"][0]
                self.assertAlmostEqual(math.hypot(x - t["centre"][0], y - t["centre"][1]), t["pt"] / (3 * 0.299792458), delta=0.1 * t["pt"] + 3)

    def test_packed_tables_give_the_same_numbers(self):
        for name in ("muons_truth.csv", "tracks.csv", "points.csv", "muons_digits.csv"):
            (self.data / (name + ".gz")).write_bytes(gzip.compress((self.data / name).read_bytes()))
        done = self.run_here("muons_truth.csv.gz", "tracks.csv.gz", "--track-points", "points.csv.gz", "--digits", "muons_digits.csv.gz", "--no-page", "-o", "packed")
        self.assertEqual(done.returncode, 0, done.stderr)
        packed = self.load("packed")
        for key in ("all", "trackers", "comparison", "displays"):
            self.assertEqual(packed[key], self.result[key])

    def test_tracks_alone_are_enough_and_no_track_at_all_is_an_efficiency_of_zero(self):
        done = self.run_here("muons_truth.csv", "tracks.csv", "--no-page", "-o", "alone", "--pt-edges", "0,40,90", "--pz-edges", "100,200,300")
        self.assertEqual(done.returncode, 0, done.stderr)
        alone = self.load("alone")
        self.assertNotIn("planes", alone["trackers"][0])
        self.assertNotIn("digits", alone["trackers"][0])
        self.assertEqual(alone["all"]["residuals"], self.result["all"]["residuals"])
        self.assertEqual([b["pt"] for b in alone["all"]["efficiency_in_bins"]["by_pt"]], [[0, 40], [40, 90]])
        header = (self.data / "tracks.csv").read_text(encoding="ascii").splitlines()[0] + "\n"
        (self.data / "none.csv").write_text(header, encoding="ascii")
        self.assertEqual(self.run_here("muons_truth.csv", "none.csv", "--no-page", "-o", "none").returncode, 0)
        self.assertEqual(self.load("none")["all"]["efficiency"]["found"], 0)

    @unittest.skipUnless(os.environ.get("SCIFI_SHARED_DATA"), "needs external data")
    def test_geant4_events_score_as_an_independent_scorer_says(self):
        shared = pathlib.Path(os.environ["SCIFI_SHARED_DATA"]).absolute()
        for name, field, straight in (("tkd_mix", "3", []), ("tkd_multi2", "3", []), ("tkd_straight", "0", ["--straight"])):
            truth = shared / "g4" / f"{name}_truth.csv.gz"
            self.call([programs.BIN / "scifi-reconstruct", "--field", field, "--output", f"{name}.csv", shared / "g4" / f"{name}_digits.csv.gz"])
            done = self.run_here(truth, f"{name}.csv", "--field", field, "--no-page", "-o", name)
            self.assertEqual(done.returncode, 0, done.stderr)
            ours = self.load(name)
            scored = subprocess.run([sys.executable, shared / "tools" / "score_tracks.py", truth, f"{name}.csv", "--json", *straight], cwd=self.data, capture_output=True, text=True, check=True)
            theirs = json.loads(scored.stdout)
            mine = ours["all"]
            self.assertEqual(ours["events"], theirs["events"])
            self.assertEqual((mine["efficiency"]["expected"], mine["efficiency"]["found"], mine["ghosts"], mine["tracks"]),
                             (theirs["expected"], theirs["found"], theirs["ghosts"], theirs["reconstructed"]))
            for quantity, r in theirs["residuals"].items():
                for key, own in (("mean", "mean"), ("median", "median"), ("spread", "spread"), ("tail", "beyond_5_spreads")):
                    self.assertAlmostEqual(mine["residuals"][quantity][own], r[key], places=9, msg=(name, quantity, key))
            self.assertEqual(set(mine["pulls"]), set(theirs["pulls"]))
            for quantity, r in theirs["pulls"].items():
                for key in ("mean", "median", "spread"):
                    self.assertAlmostEqual(mine["pulls"][quantity][key], r[key], places=9, msg=(name, quantity, key))
            for key in ("mean", "median"):
                self.assertAlmostEqual(mine["chi2_per_ndf"][key], theirs["chi2_per_ndf"][key], places=9)
            if straight:
                continue
            self.assertAlmostEqual(mine["charge_correct"]["value"], theirs["charge_correct"])
            by_pt = {tuple(b["pt"]): b for b in mine["momentum_in_bins"]["by_pt"]}
            for theirs_key, own in (("pz_by_pt", "residual_pz"), ("pt_by_pt", "residual_pt")):
                for b in theirs[theirs_key]:
                    q = by_pt[tuple(b["pt"])][own]
                    self.assertEqual(q["n"], b["n"])
                    self.assertAlmostEqual(q["spread"], b["spread"], places=9)
                    self.assertAlmostEqual(q["median"], b["median"], places=9)

    # The page

    def test_the_page_holds_everything_and_stands_alone(self):
        if python_that_draws() is None:
            self.skipTest("no Python with matplotlib")
        done = self.run_here("muons_truth.csv", "tracks.csv", "--track-points", "points.csv", "--digits", "muons_digits.csv", "--before", "full/study.json", "-o", "page")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.data / "page" / "study.html").read_text(encoding="utf-8")
        links, images = [], []

        class Parser(html.parser.HTMLParser):
            def handle_starttag(self, tag, attributes):
                attributes = dict(attributes)
                links.extend(attributes[k] for k in ("href", "src", "srcset", "data", "action") if k in attributes and tag != "img")
                if tag == "img":
                    images.append(attributes)

        Parser().feed(text)
        self.assertEqual(links, [])
        bare = re.sub(r"data:image/png;base64,[A-Za-z0-9+/=]*", "", text)
        self.assertIsNone(re.search(r"https?:|//|@import|url\(|<script|<link", bare, re.IGNORECASE))
        self.assertLess(len(bare), 50000)
        self.assertGreater(len(images), 14)
        for image in images:
            kind, data = image["src"].split(",", 1)
            self.assertEqual(kind, "data:image/png;base64")
            width, height = decode_png(base64.b64decode(data, validate=True))
            self.assertTrue(600 < width < 2000 and 300 < height < 1500, (image["alt"], width, height))
            self.assertTrue(image["alt"])
        drawn = {p.stem for p in (self.data / "page").glob("*.png")}
        self.assertEqual(drawn, {p.stem for p in (self.data / "page").glob("*.svg")})
        self.assertEqual(len(drawn), len(images))
        for name in ("efficiency", "efficiency_map", "residuals", "pulls", "goodness_of_fit", "momentum_resolution", "momentum_shift", "plane_residuals", "plane_pulls", "occupancy", "channel_sums", "event_1"):
            self.assertIn(name, drawn)
        for heading in ("published", "bound", "before", "measured"):
            self.assertIn(f"<th>{heading}</th>", bare)
        result = self.load("page")
        rows_of = {r["what"]: r for r in result["comparison"]}
        self.assertEqual((rows_of["spread of pt"]["published"], rows_of["spread of pz"]["published"]), (0.9, 4.0))
        for r in result["comparison"]:
            self.assertEqual(r["before"], r["measured"], r["what"])  # the study beside itself
        self.assertEqual(result["before"]["trackers"], [{"tracker": t["tracker"], "planes": t["planes"]} for t in result["trackers"]])

    def test_without_a_python_that_draws_the_numbers_are_there_and_the_status_says_so(self):
        done = self.run_here("muons_truth.csv", "tracks.csv", "--python", "no_such_python", "-o", "undrawn")
        self.assertEqual(done.returncode, 3)
        self.assertIn("undrawn/study.json is written, but nothing is drawn: there is no no_such_python with matplotlib", done.stderr)
        self.assertEqual(self.load("undrawn")["all"]["efficiency"], self.result["all"]["efficiency"])

    # What is refused

    def refused(self, *arguments):
        done = self.run_here(*arguments, "--no-page", "-o", "refused")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertFalse((self.data / "refused").exists())
        return done.stderr

    def write(self, name, text):
        (self.data / name).write_text(text, encoding="ascii")
        return name

    def test_wrong_and_empty_files_are_refused(self):
        self.assertIn("tracks.csv:1: pdg: the header has no column of this name", self.refused("tracks.csv", "muons_truth.csv"))
        self.assertIn("muons_digits.csv:1: track: the header has no column of this name", self.refused("muons_truth.csv", "muons_digits.csv"))
        self.assertIn("tracks.csv:1: station: the header has no column of this name", self.refused("muons_truth.csv", "tracks.csv", "--track-points", "tracks.csv"))
        self.assertIn("tracks.csv:1: station: the header has no column of this name", self.refused("muons_truth.csv", "tracks.csv", "--digits", "tracks.csv"))
        self.assertIn("empty.csv: the file is empty", self.refused(self.write("empty.csv", ""), "tracks.csv"))
        self.assertIn("bare.csv: no particle crosses a plane", self.refused(self.write("bare.csv", TRUTH_HEADER), "tracks.csv"))
        self.assertIn("missing.csv: cannot be opened", self.refused("muons_truth.csv", "missing.csv"))
        truth = (self.data / "muons_truth.csv").read_text(encoding="ascii")
        self.assertIn("short.csv:1: py_MeV: the header has no column of this name", self.refused(self.write("short.csv", truth.replace("py_MeV", "other", 1)), "tracks.csv"))

    def test_bad_rows_are_refused_with_file_line_and_field(self):
        truth = (self.data / "muons_truth.csv").read_text(encoding="ascii").splitlines()
        tracks = (self.data / "tracks.csv").read_text(encoding="ascii").splitlines()
        points = (self.data / "points.csv").read_text(encoding="ascii").splitlines()

        def spoiled(name, lines, number, column, value):
            fields = lines[number - 1].split(",")
            fields[lines[0].split(",").index(column)] = value
            return self.write(name, "\n".join(lines[:number - 1] + [",".join(fields)] + lines[number:]) + "\n")

        self.assertIn("bad.csv:7: x_mm: 'abc' is not a number", self.refused(spoiled("bad.csv", truth, 7, "x_mm", "abc"), "tracks.csv"))
        self.assertIn("bad.csv:9: plane: there is no plane 5", self.refused(spoiled("bad.csv", truth, 9, "plane", "5"), "tracks.csv"))
        self.assertIn("bad.csv:5: chi2: the field is empty", self.refused("muons_truth.csv", spoiled("bad.csv", tracks, 5, "chi2", "")))
        self.assertIn("bad.csv:40: event: 0 comes after", self.refused("muons_truth.csv", spoiled("bad.csv", tracks, 40, "event", "0")))
        self.assertIn("bad.csv:30: track: there is no track 8", self.refused("muons_truth.csv", "tracks.csv", "--track-points", spoiled("bad.csv", points, 30, "track", "8")))
        self.assertIn("bad.csv:11: tx: 'x' is not a number", self.refused("muons_truth.csv", "tracks.csv", "--track-points", spoiled("bad.csv", points, 11, "tx", "x")))

    def test_bad_options_are_refused(self):
        both = ("muons_truth.csv", "tracks.csv")
        self.assertIn("--pt-edges: not two or more rising numbers", self.refused(*both, "--pt-edges", "0,20,10"))
        self.assertIn("--pz-edges: not two or more rising numbers", self.refused(*both, "--pz-edges", "100"))
        self.assertIn("--wide-pt-edges: not two or more rising numbers", self.refused(*both, "--wide-pt-edges", "0,0"))
        self.assertIn("--field: not a finite number", self.refused(*both, "--field", "nan"))
        self.assertIn("other.json: format: is missing", self.refused(*both, "--before", self.write("other.json", "{}")))
        self.assertIn("other.json: format: is not 'scifi-study'", self.refused(*both, "--before", self.write("other.json", '{"format": "scifi-geometry", "version": 1}')))
        done = self.run_here(*both, "--before", "full/study.json", "--no-page", "-o", "full")
        self.assertEqual(done.returncode, 2)
        self.assertIn("full/study.json: would overwrite what is read", done.stderr)
        self.write("a_file", "")
        done = self.run_here(*both, "--no-page", "-o", "a_file")
        self.assertEqual(done.returncode, 2)
        self.assertIn("a_file: is not a folder", done.stderr)


if __name__ == "__main__":
    programs.find("scifi-study", "scifi-simulate", "scifi-reconstruct")
    unittest.main()
