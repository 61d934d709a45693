#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-simulate and scifi-reconstruct in fields that are not uniform: maps from files, coils of a geometry, and what they say of bad ones.

Usage: field_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone. Exit status 77: the programs were not built.
SCIFI_SHARED_DATA in the environment names the folder of external data; tests that need it are skipped without.
"""

import gzip
import math
import os
import pathlib
import statistics
import unittest

import programs

SHARED = os.environ.get("SCIFI_SHARED_DATA")
HEAD = "scifi field map\ngrid cylindrical\nlength mm\nfield T\ncolumns r z br bz\n"


def steps(first, last, step):
    return [first + i * step for i in range(round((last - first) / step) + 1)]


def map_of(field):
    """A map of field(r, z) -> (br, bz) in tesla, over the space of a tracker."""
    return HEAD + "".join(f"{r} {z} {field(r, z)[0]!r} {field(r, z)[1]!r}\n" for r in steps(0, 200, 20) for z in steps(-60, 1180, 20))


def wavy(r, z):
    """A field of 3 T with a wave of 3 % along z, 1.2 m long, free of sources and currents: Bz = B0 (1 + a I0(kr) cos kz), Br = B0 a I1(kr) sin kz."""
    k, a = 2 * math.pi / 1200, 0.015
    x = k * r / 2
    i0 = sum((x ** n / math.factorial(n)) ** 2 for n in range(12))
    i1 = sum(x ** (2 * n + 1) / (math.factorial(n) * math.factorial(n + 1)) for n in range(12))
    return 3 * a * i1 * math.sin(k * z), 3 * (1 + a * i0 * math.cos(k * z))


class Fields(programs.InAFolder):
    def simulate(self, field, events, *options):
        done = self.run_program("scifi-simulate", "--field", field, "--events", events, "--tracker", 1, "--radius", 60, "--pt", 10, 60, "--output", "s", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def reconstruct(self, field, *options):
        done = self.run_program("scifi-reconstruct", "s_digits.csv", "--field", field, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.rows("tracks.csv")

    def pulls_of_pz(self, tracks):
        """(pz of the track - true pz) / its error, for events with one track; the truth is where the particle crossed plane 0 of station 1."""
        truth = {row["event"]: float(row["pz_MeV"]) for row in self.rows("s_truth.csv") if row["station"] == "1" and row["plane"] == "0"}
        return [(float(t["pz_MeV"]) - truth[t["event"]]) / float(t["sigma_pz_MeV"]) for t in tracks if t["event"] in truth]

    def test_a_map_of_a_uniform_field_is_the_number(self):
        self.write("three.map.gz", gzip.compress(map_of(lambda r, z: (0.0, 3.0)).encode()))
        done = self.simulate("three.map.gz", 100)
        self.assertIn("three.map.gz, mean 3.0000 T, 3.0000 T", done.stdout)
        through_map = self.reconstruct("three.map.gz")
        on_helix = self.reconstruct(3)
        self.assertGreater(len(on_helix), 80)
        self.assertEqual(len(through_map), len(on_helix))
        for a, b in zip(through_map, on_helix):
            for name in ("x_mm", "y_mm", "px_MeV", "py_MeV", "pz_MeV"):
                self.assertAlmostEqual(float(a[name]), float(b[name]), delta=0.01 * float(b[f"sigma_{name}"]))

    def test_in_a_field_that_waves_by_3_per_cent_the_map_gives_right_momenta_and_the_number_does_not(self):
        self.write("wavy.map", map_of(wavy))
        self.simulate("wavy.map", 1500, "--noise-rate", 0)
        right = self.pulls_of_pz(self.reconstruct("wavy.map"))
        wrong = self.pulls_of_pz(self.reconstruct(3))
        self.assertGreater(len(right), 1000)
        n = len(right)

        def spread(pulls):
            cuts = statistics.quantiles(pulls, n=1000)
            return (cuts[840] - cuts[158]) / 2

        # Standard errors: 1.25/sqrt(n) of the median, 0.96/sqrt(n) of the spread.
        self.assertLess(abs(statistics.median(right)), 4 * 1.25 / math.sqrt(n))
        self.assertLess(abs(spread(right) - 1), 4 * 0.96 / math.sqrt(n))
        self.assertTrue(abs(statistics.median(wrong)) > 0.3 or spread(wrong) > 1.2, (statistics.median(wrong), spread(wrong)))

    @unittest.skipUnless(SHARED, "no external data")
    def test_the_coils_of_the_experiment(self):
        geometry = ["--geometry", pathlib.Path(SHARED) / "mice" / "geometry" / "Step_4_def_5_2.dat"]
        done = self.simulate("coils", 1000, *geometry)
        # Means on the axis from Biot-Savart of the coils by a separate program: -3.9395 and 3.9474 T.
        self.assertRegex(done.stdout, r"field coils, mean -3\.93\d\d T, 3\.94\d\d T")
        pulls = self.pulls_of_pz(self.reconstruct("coils", *geometry))
        self.assertGreater(len(pulls), 800)
        self.assertLess(abs(statistics.median(pulls)), 4 * 1.25 / math.sqrt(len(pulls)))

    def test_bad_fields_are_refused_with_file_line_and_reason(self):
        self.simulate(3, 2)
        good = map_of(lambda r, z: (0.0, 3.0))
        self.write("bad.map", good.replace("20 0 0.0 3.0", "20 0 0.0 x", 1))
        self.write("cut.map.gz", gzip.compress(good.encode())[:-20])
        self.write("short.map", HEAD + "".join(f"{r} {z} 0 3\n" for r in (0, 50, 100) for z in (0, 100, 200)))
        for field, message in (("none.map", "--field: 'none.map' is neither a number of tesla nor 'coils' nor a file that exists"), ("bad.map", "bad.map:72: bz: 'x' is not a number"),
                               ("cut.map.gz", "the gzip data end too early: the file is truncated"), ("s_digits.csv", "s_digits.csv:1: is not a field map"), ("coils", "--field coils: the geometry has no coils"),
                               ("short.map", "short.map: does not cover the axis of tracker"), ("nan", "--field: nan is not a number of tesla"), ("1e9", "--field: 1e9 is not a number of tesla")):
            for program, options in (("scifi-reconstruct", ["s_digits.csv"]), ("scifi-simulate", ["--events", 2, "--output", "t"])):
                with self.subTest(field=field, program=program):
                    done = self.run_program(program, *options, "--field", field)
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertIn(message, done.stderr)
        self.assertFalse((self.folder / "tracks.csv").exists())
        self.assertEqual(self.run_program("scifi-reconstruct", "s_digits.csv", "--field-outside", "else").returncode, 2)
        self.assertEqual(self.run_program("scifi-reconstruct", "s_digits.csv", "--field", "short.map", "--field-outside", "nearest").returncode, 0)


if __name__ == "__main__":
    programs.find("scifi-simulate", "scifi-reconstruct")
    unittest.main()
