#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-align from the outside: a misaligned detector is simulated, reconstructed as if it were not, aligned and reconstructed again.

Usage: align_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone. Exit status 77: a program was not built.
"""

import copy
import csv
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import unittest

BIN = None
# Shifts (mm) and rotations (rad) of the stations that are not at the ends.
MOVED = {0: {2: (0.5, -0.5, 0.005), 3: (-0.5, 0.5, -0.005), 4: (0.5, 0.5, 0.005)},
         1: {2: (-0.5, -0.5, -0.005), 3: (-0.5, 0.5, 0.005), 4: (0.5, -0.5, -0.005)}}
STRAIGHT = ["--field", 0, "--pz", 190, 210, "--pt", 0, 12, "--radius", 80]
# The trackers of MICE: z of the stations, mm; views and channels of the planes; a doublet of fibres on a sheet of mylar.
STATIONS = {0: (0.0, 199.9646, 449.8276, 749.8280, 1099.7578), 1: (0.0, 200.8936, 449.8990, 749.8284, 1099.9026)}
PLANES = (("V", 120.0, 214, 106.5), ("W", -120.0, 214, 106.5), ("U", 0.0, 212, 105.5))
MYLAR, FIBRES = 0.025, 0.62734


def nominal_geometry():
    planes = []
    for i, (view, angle, channels, central) in enumerate(PLANES):
        z = i * (MYLAR + FIBRES)
        planes.append({"plane": i, "view": view, "angle": angle, "channels": channels, "central_channel": central, "channel_width": 1.4945,
                       "z_mylar": [z, z + MYLAR], "z_fibres": [z + MYLAR, z + MYLAR + FIBRES]})
    return {"planes": planes, "fiducial_radius": 150.0,
            "trackers": [{"tracker": tracker, "beam_direction": 2 * tracker - 1,
                          "stations": [{"station": i, "position": [0.0, 0.0, z]} for i, z in enumerate(positions, 1)]}
                         for tracker, positions in STATIONS.items()]}


def run(program, *arguments, cwd):
    return subprocess.run([str(BIN / program), *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=300, check=False)


def good(program, *arguments, cwd):
    result = run(program, *arguments, cwd=cwd)
    assert result.returncode == 0, (program, arguments, result.stderr)
    return result


def misaligned(nominal):
    """The nominal geometry with its inner stations moved."""
    out = copy.deepcopy(nominal)
    for tracker in out["trackers"]:
        for station in tracker["stations"]:
            dx, dy, turn = MOVED[tracker["tracker"]].get(station["station"], (0.0, 0.0, 0.0))
            station["position"][0] += dx
            station["position"][1] += dy
            station["rotation"] = station.get("rotation", 0.0) + math.degrees(turn)
    return out


class Quality:
    """What tracks and their residuals look like: means of chi2/ndf, spreads of residuals and pulls by tracker and station."""

    def __init__(self, folder, geometry, field):
        good("scifi-reconstruct", "sim_digits.csv", "--geometry", geometry, "--field", field, "--output", "tracks.csv", "--track-points", "points.csv", cwd=folder)
        with open(folder / "tracks.csv", encoding="ascii") as stream:
            tracks = list(csv.DictReader(stream))
        self.tracks = len(tracks)
        self.chi2 = statistics.median(float(t["chi2"]) / int(t["ndf"]) for t in tracks)
        self.residuals, self.pulls = {}, {}
        with open(folder / "points.csv", encoding="ascii") as stream:
            for point in csv.DictReader(stream):
                if point["residual_mm"] != "nan":
                    key = int(point["tracker"]), int(point["station"])
                    self.residuals.setdefault(key, []).append(float(point["residual_mm"]))
                    self.pulls.setdefault(key, []).append(float(point["pull"]))

    @staticmethod
    def spread(values):
        """Half the width of the central 68 %."""
        ordered = sorted(values)
        return 0.5 * (ordered[int(0.84135 * len(ordered))] - ordered[int(0.15865 * len(ordered))])


class Align(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        nominal = cls.nominal = nominal_geometry()
        (cls.folder / "nominal.json").write_text(json.dumps(nominal), encoding="utf-8")
        (cls.folder / "real.json").write_text(json.dumps(misaligned(nominal)), encoding="utf-8")
        good("scifi-simulate", "--geometry", "real.json", "--events", 1500, "--seed", 11, "--output", "sim", *STRAIGHT, cwd=cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def align(self, *arguments):
        return good("scifi-align", "sim_digits.csv", "--geometry", "nominal.json", *arguments, cwd=self.folder)

    def check_parameters(self, document):
        """All free parameters within three of their errors, errors small against what was moved."""
        checked = 0
        for tracker in document["trackers"]:
            self.assertTrue(tracker["settled"])
            for p in tracker["parameters"]:
                truth = MOVED[tracker["tracker"]].get(p["station"], (0.0, 0.0, 0.0))[("x", "y", "rotation").index(p["motion"])]
                with self.subTest(tracker=tracker["tracker"], parameter=p):
                    self.assertLessEqual(abs(p["value"] - truth), 3.0 * p["sigma"] + 1e-9)
                    if truth:
                        self.assertLess(p["sigma"], 0.3 * abs(truth))
                        checked += 1
                    else:
                        self.assertLess(p["sigma"], 1e-9)
        self.assertEqual(checked, 18)

    def test_stations_are_put_back_and_tracks_are_as_good_as_in_the_real_geometry(self):
        result = self.align("--output", "aligned.json", "--parameters", "alignment.json")
        document = json.loads((self.folder / "alignment.json").read_text(encoding="utf-8"))
        self.check_parameters(document)
        self.assertIn("station 3 rotation", result.stdout)

        # The geometry written is the one that the parameters say.
        aligned = json.loads((self.folder / "aligned.json").read_text(encoding="utf-8"))
        for before, after, found in zip(self.nominal["trackers"], aligned["trackers"], document["trackers"]):
            for p in found["parameters"]:
                old, new = (next(s for s in t["stations"] if s["station"] == p["station"]) for t in (before, after))
                moved = {"x": new["position"][0] - old["position"][0], "y": new["position"][1] - old["position"][1],
                         "rotation": math.radians(new.get("rotation", 0.0) - old.get("rotation", 0.0))}[p["motion"]]
                self.assertAlmostEqual(moved, p["value"], places=9)

        before, after, ideal = (Quality(self.folder, geometry, 0) for geometry in ("nominal.json", "aligned.json", "real.json"))
        self.assertGreater(before.chi2, 1.15 * ideal.chi2)
        self.assertAlmostEqual(after.chi2, ideal.chi2, delta=0.02 * ideal.chi2)
        self.assertGreaterEqual(after.tracks, ideal.tracks - 3)
        for key, residuals in ideal.residuals.items():
            with self.subTest(station=key):
                # The same tracks: the spreads differ by far less than their own error.
                self.assertAlmostEqual(Quality.spread(after.residuals[key]), Quality.spread(residuals), delta=0.02 * Quality.spread(residuals))
                self.assertAlmostEqual(Quality.spread(after.pulls[key]), Quality.spread(ideal.pulls[key]), delta=0.02)
                # Planes of one station share the track: their mean residuals are as well known as one plane's. Four errors.
                self.assertLess(abs(statistics.mean(after.residuals[key])), 4.0 * statistics.pstdev(residuals) / math.sqrt(len(residuals) / 3))

    def test_the_output_does_not_depend_on_the_number_of_threads(self):
        for threads in (1, 2):
            self.align("--passes", 2, "--threads", threads, "--output", f"aligned{threads}.json", "--parameters", f"alignment{threads}.json")
        for name in ("aligned", "alignment"):
            self.assertEqual((self.folder / f"{name}1.json").read_bytes(), (self.folder / f"{name}2.json").read_bytes())

    def test_planes_one_by_one_and_the_average_frame(self):
        self.align("--level", "planes", "--frame", "average", "--tracker", 1, "--output", "planes.json", "--parameters", "planes_alignment.json")
        (tracker,) = json.loads((self.folder / "planes_alignment.json").read_text(encoding="utf-8"))["trackers"]
        self.assertEqual(len(tracker["parameters"]), 30)
        # Stations were moved as a whole: the planes of each keep their sum of alpha, which no frame touches.
        sums = {}
        for i, p in enumerate(tracker["parameters"]):
            if p["motion"] == "along":
                sums.setdefault(p["station"], []).append((i, p["value"]))
        for members in sums.values():
            variance = sum(tracker["covariance"][i][j] for i, _ in members for j, _ in members)
            self.assertLess(abs(sum(value for _, value in members)), 3.5 * math.sqrt(variance))
        before, after = (Quality(self.folder, geometry, 0) for geometry in ("nominal.json", "planes.json"))
        self.assertLess(after.chi2, before.chi2)
        aligned = json.loads((self.folder / "planes.json").read_text(encoding="utf-8"))
        self.assertEqual(aligned["trackers"][0]["stations"][2]["position"], self.nominal["trackers"][0]["stations"][2]["position"])

    def test_helices(self):
        good("scifi-simulate", "--geometry", "real.json", "--events", 1500, "--seed", 12, "--output", "bent", "--field", 3, "--pt", 0, 60, cwd=self.folder)
        good("scifi-align", "bent_digits.csv", "--geometry", "nominal.json", "--field", 3, "--output", "bent.json", "--parameters", "bent_alignment.json", cwd=self.folder)
        self.check_parameters(json.loads((self.folder / "bent_alignment.json").read_text(encoding="utf-8")))
        if not os.access(BIN / "scifi-study", os.X_OK):
            return
        # Against the truth, beside each other: the momentum is better, chi2 and p-values are what they should be.
        study = None
        for when, geometry in (("before", "nominal.json"), ("after", "bent.json")):
            good("scifi-reconstruct", "bent_digits.csv", "--geometry", geometry, "--field", 3, "--output", f"{when}.csv", cwd=self.folder)
            against = ["--before", "before/study.json"] if when == "after" else []
            good("scifi-study", "bent_truth.csv", f"{when}.csv", "--geometry", geometry, "--field", 3, "--no-page", "-o", when, *against, cwd=self.folder)
            study = json.loads((self.folder / when / "study.json").read_text(encoding="utf-8"))
        before, after = study["before"]["all"], study["all"]
        self.assertGreater(before["chi2_per_ndf"]["mean"], 1.3)
        self.assertAlmostEqual(after["chi2_per_ndf"]["mean"], 1.0, delta=0.05)
        self.assertGreater(before["p_value"]["kolmogorov_smirnov_distance"], 0.25)
        self.assertLess(after["p_value"]["kolmogorov_smirnov_distance"], 0.08)
        self.assertLess(after["residuals"]["pz"]["spread"], 0.95 * before["residuals"]["pz"]["spread"])
        self.assertGreaterEqual(after["efficiency"]["found"], 0.995 * before["efficiency"]["found"])

    def expect_refused(self, result, message, status=2):
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertIn(message, result.stderr)
        self.assertFalse((self.folder / "none.json").exists())
        self.assertFalse((self.folder / "none.json.partial").exists())

    def test_what_tracks_cannot_see_is_named(self):
        result = run("scifi-align", "sim_digits.csv", "--geometry", "nominal.json", "--frame", "none", "--output", "none.json", cwd=self.folder)
        self.expect_refused(result, "tracks and constraints do not determine all parameters", status=3)
        self.assertEqual(result.stderr.count("not determined:"), 5, result.stderr)

    def test_bad_input_is_refused(self):
        header = "event,tracker,station,plane,channel,npe\n"
        (self.folder / "bad.csv").write_text(header + "0,1,1,0,100,5\n0,1,9,0,100,5\n", encoding="ascii")
        (self.folder / "column.csv").write_text("event,tracker,station,plane,channel\n", encoding="ascii")
        (self.folder / "empty.csv").write_text(header, encoding="ascii")
        (self.folder / "bad.json").write_text("{", encoding="ascii")
        for arguments, message in ((["bad.csv"], "bad.csv:3: station: "), (["column.csv"], "column.csv:1: "), (["missing.csv"], "missing.csv"),
                                   (["sim_digits.csv", "--geometry", "bad.json"], "bad.json:1: is not JSON"),
                                   (["sim_digits.csv", "--hold", "7"], "there is no station 7 in tracker 0"),
                                   (["sim_digits.csv", "--tracker", "5"], "the geometry has no tracker 5"),
                                   (["sim_digits.csv", "--level", "fibres"], "--level"), (["sim_digits.csv", "--momentum", "0"], "--momentum"),
                                   (["sim_digits.csv", "--particle", "unicorn"], "--particle"), (["sim_digits.csv", "--passes", "0"], "--passes"),
                                   (["sim_digits.csv", "--output", "sim_digits.csv"], "would overwrite"), (["/dev/null"], "is not a file"), ([], "DIGITS")):
            with self.subTest(arguments=arguments):
                output = [] if "--output" in arguments else ["--output", "none.json"]
                self.expect_refused(run("scifi-align", *arguments, *output, cwd=self.folder), message)
        self.expect_refused(run("scifi-align", "empty.csv", "--output", "none.json", cwd=self.folder), "empty.csv: no tracks to align with", status=3)


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv[1]).resolve()
    for needed in ("scifi-align", "scifi-simulate", "scifi-reconstruct"):
        if not os.access(BIN / needed, os.X_OK):
            print(f"skipped: {needed} was not built")
            sys.exit(77)
    unittest.main(argv=[sys.argv[0]] + sys.argv[2:])
