#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-geometry from the outside: tables, JSON and drawings of geometries, and what it says when the input is bad.

Usage: geometry_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone. Exit status 77: the program was not built.
SCIFI_SHARED_DATA in the environment names the folder of external data; tests that need it are skipped without.
"""

import json
import math
import os
import pathlib
import unittest
import xml.etree.ElementTree

import programs

SHARED = os.environ.get("SCIFI_SHARED_DATA")

PLANE = """Module View{view}
{{
  Volume Cylinder
  Dimensions 18.9 0.06273 cm
  Position 0 0 {z} mm
  Rotation 0 0 {angle} degree
  PropertyString Material POLYSTYRENE
  PropertyString SensitiveDetector SciFi
  PropertyInt Plane {number}
  PropertyDouble ActiveRadius 161 mm
  PropertyDouble Pitch 0.427 mm
  PropertyDouble FibreDiameter 0.350 mm
  PropertyDouble CoreDiameter 0.308 mm
  PropertyDouble CentralFibre {central}
}}
"""


def station(number, z):
    planes = "".join(PLANE.format(view=view, z=at, angle=angle, number=i, central=central)
                     for i, (view, at, angle, central) in enumerate((("V", -0.6398, -120, 106.5), ("W", 0.0125, 120, 106.5), ("X", 0.6648, 0, 105.5))))
    return f"Module Station{number}\n{{\n  PropertyInt Station {number}\n  Position 0.1 -0.2 {z} mm\n{planes}}}\n"


def geometry(field=3):
    stations = "".join(station(i, z) for i, z in enumerate((-550, -350, -100, 200, 550), 1))
    return (f"Configuration Test\n{{\n  PropertyHep3Vector MagneticField 0 0 {field} tesla\n"
            f"  Module Tracker\n  {{\n    PropertyInt Tracker 1\n    PropertyString Material He\n{stations}  }}\n}}\n")


class Geometry(programs.InAFolder):
    def test_a_table_json_and_a_drawing_are_made_of_modules(self):
        source = self.write("a.dat", geometry())
        out, drawing = self.folder / "a.json", self.folder / "a.svg"
        done = self.run_program("scifi-geometry", source, "--json", out, "--svg", drawing)
        self.assertEqual(done.returncode, 0, done.stderr)
        for words in ("tracker 1", "beam towards +z", "field 3 T", "1100.0000", "planes of stations 1 to 5", "-120.000"):
            self.assertIn(words, done.stdout)
        document = json.loads(out.read_text())
        self.assertEqual([s["position"][2] for s in document["trackers"][0]["stations"]], [0, 200, 450, 750, 1100])
        self.assertAlmostEqual(document["trackers"][0]["field"], 3.0)
        self.assertEqual([p["channels"] for p in document["planes"]], [214, 214, 212])
        root = xml.etree.ElementTree.parse(drawing).getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        texts = [e.text for e in root.iter("{http://www.w3.org/2000/svg}text")]
        self.assertEqual(sum(t.startswith("station ") for t in texts), 5)
        # The JSON says the same as the modules.
        again = self.run_program("scifi-geometry", out)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(again.stdout.splitlines()[1:], done.stdout.splitlines()[1:])

    def test_the_other_programs_take_modules_and_their_field(self):
        source = self.write("a.dat", geometry(field=2))
        prefix = self.folder / "sim"
        done = self.run_program("scifi-simulate", "--geometry", source, "--events", 20, "--pt", 10, 30, "--radius", 30, "--output", prefix)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("field 2 T", done.stdout)
        done = self.run_program("scifi-reconstruct", f"{prefix}_digits.csv", "--geometry", source, "--output", self.folder / "t.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 T, helices", done.stdout)
        done = self.run_program("scifi-reconstruct", f"{prefix}_digits.csv", "--geometry", source, "--field", 3, "--output", self.folder / "t.csv")
        self.assertIn("3 T, helices", done.stdout)

    def test_bad_geometries_end_with_status_2_file_line_and_reason(self):
        self.write("ring.dat", "Module Ring\n{\n  Module a.dat\n  {\n  }\n}\n")
        good = geometry()
        for content, words in (
                ("", "describes no module"),
                ("hello\n", ":1: 'hello': a geometry begins with"),
                (good.replace("0.1 -0.2 200 mm", "0.1 -0.2 200"), "Position: is without a unit"),
                (good.replace("0.1 -0.2 200 mm", "0.1 mm"), "Position: the line is too short"),
                (good.replace("Module Station3\n", "Module Gone.dat { }\nModule Station3\n"), "Module Gone.dat: "),
                (good.replace("Module Tracker\n", "Module Gone.dat\n{\n}\nModule Other\n{\n}\nModule Tracker\n").replace("Tracker 1", "Trakcer 1"), "Gone.dat"),
                (good.replace("Module Station3\n", "Module ring.dat\n{\n}\nModule Station3\n"), "refers to itself: a.dat -> ring.dat -> a.dat"),
                (good.replace("Test", "T\u00e9st").encode("latin-1"), ":1: is not ASCII text: it holds the byte 233"),
                (good.encode("utf-16"), ":1: is not ASCII text"),
                (good.replace("CentralFibre 105.5", "CentralFibre 1e300"), "CentralFibre: '1e300'"),
                (good[:-4], "is not closed by }")):
            with self.subTest(words):
                done = self.run_program("scifi-geometry", self.write("a.dat", content), "--json", self.folder / "a.json", "--svg", self.folder / "a.svg")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(words, done.stderr)
                self.assertIn(".dat", done.stderr)
                self.assertFalse(list(self.folder.glob("a.json*")) + list(self.folder.glob("a.svg*")))

    def test_bad_options_end_with_status_2(self):
        source = self.write("a.dat", geometry())
        for options, words in (((self.folder / "none.dat",), "none.dat: cannot be opened"), ((source, "--svg", source), "would overwrite what is read"),
                               ((source, "--svg", self.folder / "x", "--json", self.folder / "x"), "the same file"),
                               ((source, "--svg", self.folder / "no" / "a.svg"), "cannot be written")):
            done = self.run_program("scifi-geometry", *options)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)

    def test_without_a_geometry_it_shows_the_one_that_the_programs_take(self):
        out = self.folder / "mice.json"
        done = self.run_program("scifi-geometry", "--json", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("MICE trackers as surveyed", done.stdout)
        self.assertEqual([len(t["stations"]) for t in json.loads(out.read_text())["trackers"]], [5, 5])

    def test_a_telescope_of_silicon_is_a_geometry_in_which_tracks_are_found(self):
        telescope = pathlib.Path(__file__).resolve().parents[2] / "examples" / "telescope.json"
        done = self.run_program("scifi-geometry", telescope)
        self.assertEqual(done.returncode, 0, done.stderr)
        for words in ("telescope", "geometry file 0.1500", "0.00320", "768"):
            self.assertIn(words, done.stdout)
        # x = 2.5 mm + 10 mrad z, y = -1 mm: the strips nearest to it, of the second station turned by 0.3 degrees and all where they stand.
        digits = "event,tracker,station,plane,channel,npe\n"
        for station, (x0, y0, z, turn) in enumerate(((0, 0, 0, 0), (0.03, -0.02, 150, 0.3), (0.06, -0.04, 300, 0), (0.09, -0.06, 450, 0)), 1):
            x, y, turn = 2.5 + 0.01 * z - x0, -1.0 - y0, math.radians(turn)
            for plane, alpha in enumerate((x * math.cos(turn) + y * math.sin(turn), y * math.cos(turn) - x * math.sin(turn))):
                digits += f"0,0,{station},{plane},{round(383.5 - alpha / 0.05)},20\n"
        done = self.run_program("scifi-reconstruct", self.write("d.csv", digits), "--geometry", telescope, "--field", 0, "--momentum", 5000, "--output", self.folder / "t.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        (track,) = programs.rows(self.folder / "t.csv")
        strip = 0.05 / math.sqrt(12)
        self.assertEqual((track["planes"], track["ndf"]), ("8", "4"))
        self.assertLess(abs(float(track["x_mm"]) - 2.5), 3 * strip)
        self.assertLess(abs(float(track["y_mm"]) + 1.0), 3 * strip)
        self.assertLess(abs(float(track["px_MeV"]) / float(track["pz_MeV"]) - 0.01), 3 * strip / 300)
        self.assertLess(float(track["sigma_x_mm"]), strip)

    @unittest.skipUnless(SHARED, "no external data")
    def test_the_experiment_s_geometry_is_converted(self):
        out = self.folder / "mice.json"
        done = self.run_program("scifi-geometry", pathlib.Path(SHARED) / "mice" / "geometry" / "Step_4_def_5_2.dat", "--json", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("-3.9", done.stderr)  # what the coils make of it
        theirs = json.loads((pathlib.Path(SHARED) / "g4" / "geometry.json").read_text())
        ours = json.loads(out.read_text())
        for a, b in zip(ours["trackers"], theirs["trackers"]):
            self.assertEqual([s["position"] for s in a["stations"]], [s["position"] for s in b["stations"]])
            self.assertEqual(a["beam_direction"], b["beam_direction"])


if __name__ == "__main__":
    programs.find("scifi-geometry")
    unittest.main()
