#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""The pages of scifi-display and of the monitor, opened from the file system in headless Chromium: no errors, everything drawn, selecting, stepping.

Usage: pages_test.py BIN
BIN is the folder of the programs; scripts/web_assets has made the pages and fetched the packages. Exit status 77, with the reason, where something is missing.
SCIFI_SCREENSHOTS names a folder to keep the screenshots in.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import programs

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = ROOT / "build/web"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


def what_is_missing():
    for page in ("display.html", "monitor.html"):
        if not (programs.BIN.parent / "share/scifi" / page).exists():
            return f"no {page}: run scripts/web_assets {programs.BIN.parent / 'share/scifi'}"
    if shutil.which("node") is None:
        return "no Node.js"
    if not (PACKAGES / "node_modules/playwright-core").exists():
        return "no playwright-core: run scripts/web_assets"
    if CHROMIUM is None:
        return "no Chromium (Debian: chromium)"
    return None


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.holder.name)
        cls.shots = pathlib.Path(os.environ.get("SCIFI_SCREENSHOTS", cls.folder)).resolve()
        cls.run_program("scifi-simulate", "--events", "8", "--tracks-per-event", "2", "--seed", "3", "--output", "m")

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    @classmethod
    def run_program(cls, name, *arguments):
        subprocess.run([programs.BIN / name, *map(str, arguments)], cwd=cls.folder, check=True, capture_output=True, timeout=120)

    def browse(self, what, page, *more):
        result = subprocess.run(["node", ROOT / "tests/integration/pages.mjs", PACKAGES, CHROMIUM, what, page, self.shots, *more], cwd=self.folder, capture_output=True,
                                text=True, timeout=240)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout.splitlines()[-1])

    def assert_drawn(self, pixels, least, colours=20):
        self.assertGreater(pixels["drawn"], least)
        self.assertGreater(pixels["colours"], colours)

    def test_event_display(self):
        self.run_program("scifi-reconstruct", "m_digits.csv", "--track-points", "points.csv")
        self.run_program("scifi-display", "m_digits.csv", "--tracks", "tracks.csv", "--track-points", "points.csv", "--truth", "m_truth.csv")
        seen = self.browse("display", self.folder / "display.html")
        self.assertEqual(seen["errors"], [])
        self.assertEqual(seen["requests"], [])

        tracks = [int(row["event"]) for row in programs.rows(self.folder / "tracks.csv")]
        self.assertEqual(len(seen["events"]), 8)
        for number, event in enumerate(seen["events"]):
            self.assertEqual(event, {"event": str(number), "rows": tracks.count(number), "drawn": tracks.count(number)})
        self.assertTrue(seen["nextAtEnd"])
        self.assertEqual(seen["afterArrow"], "6")

        last = tracks.count(0) - 1
        self.assertEqual((seen["clickedRow"]["row"], seen["clickedRow"]["scene"]), ([last], last))
        self.assertIn("measurements", seen["clickedRow"]["details"])
        self.assertEqual(seen["afterEscape"], [])
        self.assertIn("track 0", seen["tip"])
        self.assertEqual((seen["clickedPicture"]["row"], seen["clickedPicture"]["scene"]), ([0], 0))
        self.assertGreater(seen["turned"], 5.0)
        self.assertEqual(seen["afterTurn"], [0])
        self.assertEqual(seen["drawnHidden"], 0)
        self.assertEqual(seen["dark"], "dark")
        for picture in ("pixels", "side", "top", "front", "darkPixels"):
            self.assert_drawn(seen[picture], 0.01)

    def test_monitor_takes_over_a_newer_page(self):
        self.run_program("scifi-reconstruct", "m_digits.csv", "--output", "unused.csv", "--monitor", "done.html")
        page = (self.folder / "done.html").read_text(encoding="utf-8")
        older = re.sub(r'"state":"done"', '"state":"running"', page, count=1)
        older = re.sub(r'"events":\d+', '"events":0', older, count=1)
        older = re.sub(r'"every_s":[0-9.]+', '"every_s":0.5', older, count=1)
        older = re.sub(r'"page":\d+', '"page":0', older, count=1)
        (self.folder / "live.html").write_text(older, encoding="utf-8")
        seen = self.browse("monitor", self.folder / "live.html", self.folder / "done.html")
        self.assertEqual(seen["errors"], [])
        self.assertEqual(seen["requests"], [])
        self.assertEqual((seen["first"]["state"], seen["first"]["events"], seen["first"]["plots"]), ("running", 0, 11))
        self.assertGreaterEqual(seen["first"]["figures"], 11)
        self.assertEqual((seen["second"]["events"], seen["second"]["shown"]), (8, "done"))
        self.assertIn("8 events", seen["second"]["status"])
        self.assertEqual(seen["planes"]["plots"], 30)
        for picture in ("pixels", "planes", "dark"):
            self.assert_drawn(seen[picture], 0.02)
        self.assertGreater(seen["lines"], 9)


if __name__ == "__main__":
    programs.find("scifi-display", "scifi-simulate", "scifi-reconstruct")
    missing = what_is_missing()
    if missing:
        programs.skip(missing)
    unittest.main(verbosity=2)
