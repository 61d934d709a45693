#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-align from the outside: a misaligned detector is simulated, reconstructed as if it were not, aligned and reconstructed again.

Usage: align_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone; without scifi-study the tracks are not looked at. Exit status 77: a program was not built.
"""

import copy
import json
import math
import os
import pathlib
import random
import subprocess
import tempfile
import unittest

import programs

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


def misaligned(nominal, moved):
    """The nominal geometry with its inner stations moved."""
    out = copy.deepcopy(nominal)
    for tracker in out["trackers"]:
        for station in tracker["stations"]:
            dx, dy, turn = moved[tracker["tracker"]].get(station["station"], (0.0, 0.0, 0.0))
            station["position"][0] += dx
            station["position"][1] += dy
            station["rotation"] = station.get("rotation", 0.0) + math.degrees(turn)
    return out


def squares_over_covariance(errors, covariance):
    """e' inv(C) e, by the Cholesky factor of C."""
    lower, whitened = [], []
    for i, error in enumerate(errors):
        row = []
        for j in range(i):
            row.append((covariance[i][j] - sum(a * b for a, b in zip(row, lower[j]))) / lower[j][j])
        row.append(math.sqrt(covariance[i][i] - sum(a * a for a in row)))
        lower.append(row)
        whitened.append((error - sum(a * b for a, b in zip(row, whitened))) / row[i])
    return sum(w * w for w in whitened)


class Align(programs.InAFolder):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="scifi_align_")
        cls.addClassCleanup(holder.cleanup)
        folder = pathlib.Path(holder.name)
        cls.nominal_file, cls.real_file = folder / "nominal.json", folder / "real.json"
        cls.nominal = nominal_geometry()
        cls.nominal_file.write_text(json.dumps(cls.nominal), encoding="utf-8")
        cls.real_file.write_text(json.dumps(misaligned(cls.nominal, MOVED)), encoding="utf-8")
        subprocess.run([programs.BIN / "scifi-simulate", "--geometry", "real.json", "--events", "1500", "--seed", "11", "--output", "sim", *map(str, STRAIGHT)],
                       cwd=folder, check=True, capture_output=True, timeout=300)
        cls.digits, cls.truth = folder / "sim_digits.csv", folder / "sim_truth.csv"

    def good(self, program, *arguments):
        result = self.run_program(program, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def align(self, *arguments, digits=None):
        return self.good("scifi-align", digits or self.digits, "--geometry", self.nominal_file, *arguments)

    def document(self, name):
        return json.loads((self.folder / name).read_text(encoding="utf-8"))

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

    def study(self, name, geometry, field, digits, truth, before=None):
        """What scifi-study says of the tracks reconstructed in a geometry, beside those of another."""
        if not os.access(programs.BIN / "scifi-study", os.X_OK):
            self.skipTest("scifi-study was not built")
        self.good("scifi-reconstruct", digits, "--geometry", geometry, "--field", field, "--output", f"{name}.csv", "--track-points", f"{name}_points.csv")
        beside = ["--before", f"{before}/study.json"] if before else []
        self.good("scifi-study", truth, f"{name}.csv", "--track-points", f"{name}_points.csv", "--geometry", geometry, "--field", field, "--no-page", "-o", name, *beside)
        return self.document(f"{name}/study.json")

    def test_stations_are_put_back_and_tracks_are_as_good_as_in_the_real_geometry(self):
        result = self.align("--output", "aligned.json", "--parameters", "alignment.json")
        document = self.document("alignment.json")
        self.check_parameters(document)
        self.assertIn("station 3 rotation", result.stdout)

        # The geometry written is the one that the parameters say.
        aligned = self.document("aligned.json")
        for before, after, found in zip(self.nominal["trackers"], aligned["trackers"], document["trackers"]):
            for p in found["parameters"]:
                old, new = (next(s for s in t["stations"] if s["station"] == p["station"]) for t in (before, after))
                moved = {"x": new["position"][0] - old["position"][0], "y": new["position"][1] - old["position"][1],
                         "rotation": math.radians(new.get("rotation", 0.0) - old.get("rotation", 0.0))}[p["motion"]]
                self.assertAlmostEqual(moved, p["value"], places=9)

        events = 0, self.digits, self.truth
        self.study("nominal", self.nominal_file, *events)
        study = self.study("after", "aligned.json", *events, before="nominal")
        ideal = self.study("ideal", self.real_file, *events)
        rows = {r["what"]: (r["before"], r["measured"]) for r in study["comparison"]}
        self.assertGreater(rows["chi2 per degree of freedom, mean"][0], 1.4)
        self.assertAlmostEqual(rows["chi2 per degree of freedom, mean"][1], ideal["all"]["chi2_per_ndf"]["mean"], delta=0.02)
        self.assertGreaterEqual(study["all"]["efficiency"]["found"], ideal["all"]["efficiency"]["found"] - 3)
        worst_before = 0.0
        for before, after, best in zip(study["before"]["trackers"], study["trackers"], ideal["trackers"]):
            self.assertEqual((before["tracker"], len(before["planes"]), len(after["planes"])), (after["tracker"], 15, 15))
            for b, a, i in zip(before["planes"], after["planes"], best["planes"]):
                with self.subTest(tracker=after["tracker"], station=a["station"], plane=a["plane"]):
                    # The same tracks: spreads differ by far less than their own error.
                    for what in ("measurement_residual_mm", "measurement_pull"):
                        self.assertAlmostEqual(a[what]["spread"], i[what]["spread"], delta=0.04 * i[what]["spread"])
                    # Tracks and alignment share the measurements. Four errors.
                    self.assertLess(abs(a["measurement_residual_mm"]["median"]), 4.0 * a["measurement_residual_mm"]["median_error"])
                    worst_before = max(worst_before, abs(b["measurement_residual_mm"]["median"]))
        self.assertGreater(worst_before, 0.5)

    def test_the_output_does_not_depend_on_the_number_of_threads(self):
        for threads in (1, 2):
            self.align("--passes", 2, "--threads", threads, "--output", f"aligned{threads}.json", "--parameters", f"alignment{threads}.json")
        for name in ("aligned", "alignment"):
            self.assertEqual((self.folder / f"{name}1.json").read_bytes(), (self.folder / f"{name}2.json").read_bytes())

    def test_planes_one_by_one_and_the_average_frame(self):
        self.align("--level", "planes", "--frame", "average", "--tracker", 1, "--output", "planes.json", "--parameters", "planes_alignment.json")
        (tracker,) = self.document("planes_alignment.json")["trackers"]
        self.assertEqual(len(tracker["parameters"]), 30)
        # Stations were moved as a whole: the planes of each keep their sum of alpha, which no frame touches.
        sums = {}
        for i, p in enumerate(tracker["parameters"]):
            if p["motion"] == "along":
                sums.setdefault(p["station"], []).append((i, p["value"]))
        for members in sums.values():
            variance = sum(tracker["covariance"][i][j] for i, _ in members for j, _ in members)
            self.assertLess(abs(sum(value for _, value in members)), 3.5 * math.sqrt(variance))
        self.assertLess(tracker["chi2_per_ndf"]["after"], 0.75 * tracker["chi2_per_ndf"]["before"])
        self.assertEqual(self.document("planes.json")["trackers"][0]["stations"][2]["position"], self.nominal["trackers"][0]["stations"][2]["position"])

    def test_helices(self):
        self.good("scifi-simulate", "--geometry", self.real_file, "--events", 1500, "--seed", 12, "--output", "bent", "--field", 3, "--pt", 0, 60)
        self.align("--field", 3, "--output", "bent.json", "--parameters", "bent_alignment.json", digits="bent_digits.csv")
        self.check_parameters(self.document("bent_alignment.json"))
        # Against the truth: the momentum is better, chi2 and p-values are what they should be.
        events = 3, "bent_digits.csv", "bent_truth.csv"
        self.study("nominal", self.nominal_file, *events)
        study = self.study("after", "bent.json", *events, before="nominal")
        before, after = study["before"]["all"], study["all"]
        self.assertGreater(before["chi2_per_ndf"]["mean"], 1.3)
        self.assertAlmostEqual(after["chi2_per_ndf"]["mean"], 1.0, delta=0.05)
        self.assertGreater(before["p_value"]["kolmogorov_smirnov_distance"], 0.25)
        self.assertLess(after["p_value"]["kolmogorov_smirnov_distance"], 0.08)
        self.assertLess(after["residuals"]["pz"]["spread"], 0.95 * before["residuals"]["pz"]["spread"])
        self.assertGreaterEqual(after["efficiency"]["found"], 0.995 * before["efficiency"]["found"])

    def check_over_seeds(self, seeds, *simulated, aligned=()):
        """Both trackers, their inner stations displaced to sides that the seed says: errors made over errors stated."""
        squares, free, beyond_3 = 0.0, 0, 0
        for seed in seeds:
            side = random.Random(seed).choice
            moved = {tracker: {station: (side((-0.5, 0.5)), side((-0.5, 0.5)), side((-0.005, 0.005))) for station in (2, 3, 4)} for tracker in (0, 1)}
            self.write("real.json", json.dumps(misaligned(self.nominal, moved)))
            self.good("scifi-simulate", "--geometry", "real.json", "--seed", seed, "--output", "seed", *simulated)
            self.align("--output", "found.json", "--parameters", "found_parameters.json", *aligned, digits="seed_digits.csv")
            for tracker in self.document("found_parameters.json")["trackers"]:
                self.assertTrue(tracker["settled"], f"seed {seed}")
                at = [i for i, p in enumerate(tracker["parameters"]) if p["station"] in (2, 3, 4)]
                of = [tracker["parameters"][i] for i in at]
                errors = [p["value"] - moved[tracker["tracker"]][p["station"]][("x", "y", "rotation").index(p["motion"])] for p in of]
                squares += squares_over_covariance(errors, [[tracker["covariance"][i][j] for j in at] for i in at])
                free += len(errors)
                beyond_3 += sum(abs(e) > 3.0 * p["sigma"] for e, p in zip(errors, of))
        self.assertEqual(free, 18 * len(seeds))
        # Whitened by their covariance the pulls are independent: the mean of their squares is known to sqrt(2/n). Four of those, and 10 % either way for the
        # width of the scattering: Highland's formula is 4 % too wide for the core and too narrow for the tails.
        width = math.sqrt(squares / free)
        self.assertLess(abs(width - 1.0), 0.1 + 4.0 / math.sqrt(2.0 * free), f"{free} pulls")
        # 0.27 % of a normal distribution; 1 % of so many is four or more standard errors above.
        self.assertLessEqual(beyond_3, 0.01 * free + 1)
        return width, free, beyond_3

    def test_errors_made_are_the_errors_stated_with_straight_tracks(self):
        # With the last three a track has 15 planes here and 12 there, from pass to pass.
        self.check_over_seeds([*range(1, 38), 94, 157, 204], "--events", 300, *STRAIGHT)

    def test_errors_made_are_the_errors_stated_with_helices(self):
        # With the last two as well, or its momentum is known well enough here and not there.
        self.check_over_seeds([*range(1, 11), 116, 145], "--events", 350, "--field", 3, aligned=("--field", 3))

    def expect_refused(self, result, message, status=2):
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertIn(message, result.stderr)
        self.assertFalse([name for name in self.files() if name.startswith("none.json")])

    def test_what_tracks_cannot_see_is_named(self):
        result = self.run_program("scifi-align", self.digits, "--geometry", self.nominal_file, "--frame", "none", "--output", "none.json")
        self.expect_refused(result, "tracks and constraints do not determine all parameters", status=3)
        self.assertEqual(result.stderr.count("not determined:"), 5, result.stderr)

    def test_bad_input_is_refused(self):
        header = "event,tracker,station,plane,channel,npe\n"
        self.write("bad.csv", header + "0,1,1,0,100,5\n0,1,9,0,100,5\n")
        self.write("column.csv", "event,tracker,station,plane,channel\n")
        self.write("empty.csv", header)
        self.write("bad.json", "{")
        for arguments, message in ((["bad.csv"], "bad.csv:3: station: "), (["column.csv"], "column.csv:1: "), (["missing.csv"], "missing.csv"),
                                   (["empty.csv", "--geometry", "bad.json"], "bad.json:1: is not JSON"),
                                   (["empty.csv", "--hold", "7"], "there is no station 7 in tracker 0"),
                                   (["empty.csv", "--tracker", "5"], "the geometry has no tracker 5"),
                                   (["empty.csv", "--level", "fibres"], "--level"), (["empty.csv", "--momentum", "0"], "--momentum"),
                                   (["empty.csv", "--particle", "unicorn"], "--particle"), (["empty.csv", "--passes", "0"], "--passes"),
                                   (["empty.csv", "--output", "empty.csv"], "would overwrite"), (["/dev/null"], "is not a file"), ([], "DIGITS")):
            with self.subTest(arguments=arguments):
                output = [] if "--output" in arguments else ["--output", "none.json"]
                self.expect_refused(self.run_program("scifi-align", *arguments, *output), message)
        self.expect_refused(self.run_program("scifi-align", "empty.csv", "--output", "none.json"), "empty.csv: no tracks to align with", status=3)


if __name__ == "__main__":
    programs.find("scifi-align", "scifi-simulate", "scifi-reconstruct")
    unittest.main()
