#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-conditions from the outside, and the programs that take their documents from its store.

Usage: conditions_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone. Exit status 77: the program was not built (it needs SQLite).
"""

import gzip
import json
import os
import pathlib
import sqlite3
import subprocess
import unittest

import programs

HEADER = "event,tracker,station,plane,channel,adc,npe\n"


def geometry(last_station_z=1000.0):
    """A tracker of five equal stations, the last where the caller wants it."""
    planes = [{"plane": i, "view": "VWU"[i], "angle": (120.0, -120.0, 0.0)[i], "channels": 214, "central_channel": 106.5,
               "z_mylar": [0.7 * i, 0.7 * i + 0.025], "z_fibres": [0.7 * i + 0.025, 0.7 * i + 0.65]} for i in range(3)]
    stations = [{"station": s, "position": [0, 0, z]} for s, z in enumerate((0.0, 200.0, 450.0, 750.0, last_station_z), 1)]
    return json.dumps({"format": "scifi-geometry", "version": 1, "channel_width": 1.5, "fiducial_radius": 150.0, "planes": planes,
                       "trackers": [{"tracker": 1, "beam_direction": 1, "stations": stations}]})


class Conditions(programs.InAFolder):
    def on_store(self, *arguments, status=0, store="store.db"):
        done = self.run_program("scifi-conditions", store, *arguments)
        self.assertEqual(done.returncode, status, (arguments, done.stdout, done.stderr))
        return done

    def refused(self, *arguments, words, status=2, store="store.db"):
        done = self.on_store(*arguments, status=status, store=store)
        self.assertIn(words, done.stderr)
        self.assertEqual(done.stdout, "")

    def add_alignments(self):
        """Two surveys: the second, recorded later, for some of the runs of the first."""
        self.write("first.txt", "first")
        self.write("second.txt", "second")
        self.on_store("add", "--kind", "alignment", "--runs", "7000:7999", "--recorded", "2015-11-05", "--comment", "survey\nof autumn", "first.txt")
        self.on_store("add", "--kind", "alignment", "--runs", "7400:7600", "--recorded", "2016-03-01T12:00:00Z", "second.txt")

    def get(self, run, *more):
        return self.on_store("get", "--kind", "alignment", "--run", run, *more).stdout

    # What is looked up

    def test_the_latest_recorded_is_in_force_as_known_on_a_day(self):
        self.add_alignments()
        for run, when, expected in ((7500, "2015-11-05", "first"), (7500, "2016-02-29", "first"), (7500, "2016-03-01", "second"),
                                    (7500, "2016-03-01T11:59:59Z", "first"), (7500, "2016-03-01T12:00", "second"), (7399, "2016-03-01", "first"),
                                    (7601, "2016-03-01", "first"), (7400, "2016-03-01", "second"), (7600, "2016-03-01", "second")):
            self.assertEqual(self.get(run, "--as-of", when), expected, (run, when))
        self.assertEqual(self.get(7500), "second")

    def test_a_missing_interval_is_an_error_that_says_what_there_is(self):
        self.add_alignments()
        self.refused("get", "--kind", "alignment", "--run", "8000", words="store.db: no alignment for run 8000; there is alignment for runs 7000:7999, 7400:7600")
        self.refused("get", "--kind", "cabling", "--run", "7500", words="store.db: no cabling for run 7500: the store has no cabling")
        self.refused("get", "--kind", "alignment", "--run", "7500", "--as-of", "2015-11-04",
                     words="no alignment for run 7500 was known at 2015-11-04T23:59:59Z; the first was recorded at 2015-11-05T00:00:00Z")

    def test_a_document_comes_out_as_it_went_in(self):
        content = bytes(range(256)) * 300
        self.write("a.bin", content)
        self.write("b.bin.gz", gzip.compress(content))
        for name in ("a.bin", "b.bin.gz"):
            self.on_store("add", "--kind", "alignment", "--runs", "1:", name)
            self.on_store("get", "--kind", "alignment", "--run", 5, "-o", "out.bin")
            self.assertEqual((self.folder / "out.bin").read_bytes(), content)
            done = subprocess.run([programs.BIN / "scifi-conditions", "store.db", "get", "--kind", "alignment", "--run", "5"], cwd=self.folder, capture_output=True,
                                  timeout=60, check=True)
            self.assertEqual(done.stdout, content)

    def test_trackers_have_documents_of_their_own(self):
        for tracker in (0, 1):
            self.write("t.txt", f"tracker {tracker}")
            self.on_store("add", "--kind", "alignment", "--runs", "1:9", "--recorded", "2015-01-01", "--tracker", tracker, "t.txt")
        self.refused("get", "--kind", "alignment", "--run", 5, words="no alignment for run 5 (there is one for tracker 0)")
        self.assertEqual(self.get(5, "--tracker", 1), "tracker 1")
        self.write("t.txt", "both")
        self.on_store("add", "--kind", "alignment", "--runs", "1:9", "t.txt")
        self.assertEqual(self.get(5, "--tracker", 1), "both")

    def test_list_and_history_show_what_is_in_force(self):
        self.add_alignments()
        lines = self.on_store("list").stdout.splitlines()
        self.assertEqual(len(lines), 3)
        self.assertEqual(lines[1].split()[:5], ["1", "alignment", "all", "7000:7999", "2015-11-05T00:00:00Z"])
        self.assertIn("first.txt, survey?of autumn", lines[1])
        in_force = self.on_store("list", "--run", 7500).stdout.splitlines()
        self.assertEqual([line.split()[0] for line in in_force[1:]], ["2"])
        in_force = self.on_store("list", "--run", 7500, "--as-of", "2015-12-31").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in in_force[1:]], ["1"])
        told = self.on_store("history", "--kind", "alignment", "--run", 7500).stdout.splitlines()
        self.assertEqual([line.split()[0] for line in told[1:3]], ["1", "*"])
        self.assertEqual(len(self.on_store("list", "--kind", "cabling").stdout), 0)

    # Nothing is overwritten

    def test_no_record_changes_whatever_is_added(self):
        self.add_alignments()
        before = self.on_store("list").stdout.splitlines()
        done = self.on_store("add", "--kind", "alignment", "--runs", "7500", "--recorded", "2014-01-01", "first.txt")
        self.assertIn("note: 2 records of the same runs recorded later stay in force", done.stdout)
        self.on_store("add", "--kind", "alignment", "--runs", "7500", "first.txt")
        after = self.on_store("list").stdout.splitlines()
        self.assertEqual(len(after), 5)
        self.assertTrue(set(before) <= set(after))
        with sqlite3.connect(self.folder / "store.db") as tool:
            for statement in ("UPDATE condition SET first_run = 1", "DELETE FROM condition"):
                with self.assertRaisesRegex(sqlite3.IntegrityError, "that was recorded is never"):
                    tool.execute(statement)
        tool.close()

    def test_several_add_at_once_and_none_is_lost(self):
        self.write("a.txt", "a")
        command = [programs.BIN / "scifi-conditions", "store.db", "add", "--kind", "alignment", "--runs", "1:", "a.txt"]
        writers = [subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE) for _ in range(8)]
        for w in writers:
            _, errors = w.communicate(timeout=120)
            self.assertEqual(w.returncode, 0, errors)
        self.assertEqual(len(self.on_store("list").stdout.splitlines()), 9)
        self.assertEqual(self.files(), ["a.txt", "store.db"])

    # What is refused

    def test_wrong_documents_make_no_store(self):
        self.write("broken.json", '{\n"trackers": [')
        self.write("empty.txt", "")
        self.write("bad.json", geometry(last_station_z=10.0))
        self.write("calibration.json", "{}")
        self.write("bad.txt", "x y\n")
        files = self.files()
        for kind, name, words in (("geometry", "broken.json", "broken.json:2: is not JSON"), ("alignment", "empty.txt", "empty.txt: the file is empty"),
                                  ("geometry", "bad.json", "bad.json: trackers[0].stations[4].position: the station does not lie behind"),
                                  ("calibration", "calibration.json", "calibration.json: "), ("bad_channels", "bad.txt", "bad.txt:1: "),
                                  ("geometry", "bad.txt", "bad.txt:1: "), ("geometry", "none.json", "none.json: cannot be opened"), ("geometry", ".", ".: cannot be read")):
            with self.subTest(name=name):
                self.refused("add", "--kind", kind, "--runs", "1:", name, words=words)
                self.assertEqual(self.files(), files)

    def test_wrong_options_are_refused(self):
        self.write("a.txt", "a")
        for arguments, words in ((("--kind", "weather", "--runs", "1:"), "--kind: 'weather' is none of geometry, calibration"),
                                 (("--kind", "alignment", "--runs", "9:1"), "--runs: '9:1' ends before it begins"),
                                 (("--kind", "alignment", "--runs", "x"), "--runs: 'x' is not the number of a run"),
                                 (("--kind", "alignment", "--runs", "1:", "--recorded", "2015-02-29"), "--recorded: '2015-02-29' is not a date"),
                                 (("--kind", "alignment", "--runs", "1:", "--recorded", "9999-01-01"), "that is in the future"),
                                 (("--kind", "alignment", "--runs", "1:", "--tracker", "-1"), "--tracker"),
                                 (("--kind", "alignment"), "--runs"), (("--runs", "1:"), "--kind")):
            with self.subTest(arguments=arguments):
                self.refused("add", *arguments, "a.txt", words=words)
        self.add_alignments()
        self.refused("get", "--kind", "alignment", "--run", "-3", words="--run: '-3' is not the number of a run")
        self.refused("get", "--kind", "alignment", "--run", "7500", "--as-of", "tomorrow", words="--as-of: 'tomorrow' is not a date")
        self.refused("get", "--kind", "alignment", "--run", "7500", "-o", "store.db", words="would overwrite the store")
        self.refused("get", "--kind", "alignment", "--run", "7500", "-o", "none/x", words="none/x: cannot be written")
        self.refused(words="A subcommand is required")
        self.assertEqual(self.run_program("scifi-conditions", "--help").returncode, 0)

    def test_a_wrong_store_is_refused_and_left_as_it_is(self):
        self.write("a.txt", "a")
        self.write("text.db", "x" * 5000)
        with sqlite3.connect(self.folder / "other.db") as tool:
            tool.execute("CREATE TABLE theirs (a)")
        tool.close()
        self.on_store("add", "--kind", "alignment", "--runs", "1:", "a.txt", store="newer.db")
        with sqlite3.connect(self.folder / "newer.db") as tool:
            tool.execute("PRAGMA user_version = 2")
        tool.close()
        (self.folder / "folder.db").mkdir()
        before = {name: (self.folder / name).read_bytes() for name in ("text.db", "other.db", "newer.db")}
        for store, words in (("text.db", "text.db: is not a conditions store: it is no SQLite database"),
                             ("other.db", "other.db: is not a conditions store: it is an SQLite database of another program"),
                             ("newer.db", "newer.db: is a conditions store of version 2, newer than version 1, the newest that can be read"),
                             ("folder.db", "folder.db: is not a regular file")):
            for command in (["list"], ["add", "--kind", "alignment", "--runs", "1:", "a.txt"]):
                with self.subTest(store=store, command=command):
                    self.refused(*command, words=words, store=store)
        self.assertEqual(before, {name: (self.folder / name).read_bytes() for name in before})
        self.refused("list", words="none.db: cannot be opened: there is no such file", store="none.db")
        self.refused("add", "--kind", "alignment", "--runs", "1:", "a.txt", words="none/a.db: cannot be opened", store="none/a.db")
        self.assertNotIn("none.db", self.files())

    @unittest.skipIf(os.geteuid() == 0, "root may write everything")
    def test_a_store_without_permission_is_read_but_not_written(self):
        self.add_alignments()
        (self.folder / "store.db").chmod(0o444)
        self.assertEqual(self.get(7500), "second")
        self.refused("add", "--kind", "alignment", "--runs", "1:", "first.txt", words="store.db: cannot be written: no permission")

    @unittest.skipUnless(os.path.exists("/dev/full"), "no device that is always full")
    def test_a_full_disk_is_an_error(self):
        self.add_alignments()
        self.refused("get", "--kind", "alignment", "--run", 7500, "-o", "/dev/full", words="/dev/full: could not be written", status=3)

    # The programs

    def test_cabling_is_checked_against_the_geometry_in_force(self):
        self.write("cabling.txt", "0 0 0 1 1 0 300 0 0 0\n")
        done = self.on_store("add", "--kind", "cabling", "--runs", "7000:", "cabling.txt", store="without.db")
        self.assertIn("not checked, for the store has no geometry for its first run", done.stdout)
        self.write("g.json", geometry())
        self.on_store("add", "--kind", "geometry", "--runs", "7000:", "g.json")
        self.refused("add", "--kind", "cabling", "--runs", "7000:", "cabling.txt", words="cabling.txt:1: ")

    def add_geometries(self):
        """The last station moves from 1000 to 1100 mm when the survey is looked at again."""
        for z, when in ((1000.0, "2015-11-05"), (1100.0, "2016-03-01")):
            self.write(f"g{z:.0f}.json", geometry(z))
            self.on_store("add", "--kind", "geometry", "--runs", "7000:7999", "--recorded", when, f"g{z:.0f}.json")

    def both_ways(self, program, arguments, outputs):
        """Runs a program with the geometry from a file and from the store; the outputs must be the same, and not those of the other geometry."""
        seen = []
        for z, when in ((1000.0, "2015-12-24"), (1100.0, "2016-12-24")):
            made = []
            for source in (["--geometry", f"g{z:.0f}.json"], ["--conditions", "store.db", "--run", "7500", "--as-of", when]):
                done = self.run_program(program, *source, *arguments)
                self.assertEqual(done.returncode, 0, done.stderr)
                made.append([(self.folder / name).read_bytes() for name in outputs])
            self.assertEqual(made[0], made[1])
            self.assertIn("store.db", done.stdout)
            seen.append(made[0])
        self.assertNotEqual(seen[0], seen[1])

    def test_the_geometry_of_a_run_reaches_simulation_and_reconstruction(self):
        self.add_geometries()
        self.both_ways("scifi-simulate", ("--events", 40, "--tracker", 1, "--output", "s"), ("s_digits.csv", "s_truth.csv"))
        self.both_ways("scifi-reconstruct", ("s_digits.csv",), ("tracks.csv",))
        self.assertGreater(len((self.folder / "tracks.csv").read_text(encoding="ascii").splitlines()), 10)

    @unittest.skipUnless(os.environ.get("SCIFI_SHARED_DATA"), "needs external data")
    def test_the_experiments_own_geometry_is_stored_whole(self):
        modules = pathlib.Path(os.environ["SCIFI_SHARED_DATA"]).resolve() / "mice" / "geometry" / "TrackerTest.dat"
        self.on_store("add", "--kind", "geometry", "--runs", "7000:", modules)
        self.on_store("get", "--kind", "geometry", "--run", "7000", "-o", "g.json")
        self.assertEqual(len(json.loads((self.folder / "g.json").read_text(encoding="utf-8"))["trackers"]), 2)
        made = []
        for source in (["--geometry", modules], ["--conditions", "store.db", "--run", "7500"]):
            done = self.run_program("scifi-simulate", *source, "--events", 20, "--field", 3, "--output", "s")
            self.assertEqual(done.returncode, 0, done.stderr)
            made.append((self.folder / "s_digits.csv").read_bytes())
        self.assertEqual(made[0], made[1])

    def test_a_program_without_a_geometry_for_its_run_stops(self):
        self.add_geometries()
        self.write("d.csv", HEADER)
        for program, arguments in (("scifi-reconstruct", ["d.csv"]), ("scifi-simulate", ["--events", 1])):
            for source, words in ((["--conditions", "store.db", "--run", "8000"], "store.db: no geometry for run 8000; there is geometry for runs 7000:7999"),
                                  (["--conditions", "store.db", "--run", "7500", "--as-of", "2015-01-01"], "the first was recorded at 2015-11-05"),
                                  (["--conditions", "store.db", "--run", "x"], "--run: 'x' is not the number of a run"),
                                  (["--conditions", "store.db", "--run", "7500", "--as-of", "x"], "--as-of: 'x' is not a date"),
                                  (["--conditions", "none.db", "--run", "7500"], "none.db: cannot be opened"),
                                  (["--conditions", "store.db"], "--run"), (["--run", "7500"], "--conditions"), (["--as-of", "2015-01-01"], "--conditions")):
                with self.subTest(program=program, source=source):
                    done = self.run_program(program, *source, *arguments)
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertIn(words, done.stderr)
        self.on_store("add", "--kind", "geometry", "--runs", "7500", "--tracker", 1, "g1000.json")
        done = self.run_program("scifi-reconstruct", "--conditions", "store.db", "--run", "7500", "d.csv")
        self.assertEqual(done.returncode, 2)
        self.assertIn("store.db: record 3: is in force for tracker 1 alone, where one geometry for all trackers is needed", done.stderr)
        self.assertNotIn("tracks.csv", self.files())

    def test_documents_of_a_run_reach_the_digits(self):
        # Board 0, banks 0 and 1: two cables; gain and pedestal change with the second calibration, and a channel goes bad.
        self.add_geometries()
        self.write("cabling.txt", "0 0 0 1 1 0 50 0 0 0\n0 0 1 1 1 0 213 0 0 0\n")
        self.write("raw.csv", "event,board,bank,channel,adc\n0,0,0,0,100\n0,0,0,1,100\n")
        for when, gain, bad in (("2015-11-05", 5.0, ""), ("2016-03-01", 10.0, "0 1\n")):
            self.write("c.json", json.dumps([{"bank": 0, "channel": c, "adc_gain": gain, "adc_pedestal": 20.0} for c in (0, 1)]))
            self.write("bad.txt", bad)
            for kind, name in (("cabling", "cabling.txt"), ("calibration", "c.json"), ("bad_channels", "bad.txt")):
                self.on_store("add", "--kind", kind, "--runs", "7000:", "--recorded", when, name)
        for when, expected in (("2015-12-24", [("50", 16.0), ("213", 16.0)]), ("2016-12-24", [("50", 8.0)])):
            done = self.run_program("scifi-digitise", "--conditions", "store.db", "--run", 7500, "--as-of", when, "raw.csv")
            self.assertEqual(done.returncode, 0, done.stderr)
            rows = [line.split(",") for line in (self.folder / "digits.csv").read_text(encoding="ascii").splitlines()[1:]]
            self.assertEqual([(r[4], float(r[6])) for r in rows], expected)
            self.assertIn("record ", done.stdout)
        done = self.run_program("scifi-digitise", "--cabling", "cabling.txt", "raw.csv")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--calibration is required", done.stderr)

    def test_what_a_program_takes_from_the_store_is_not_left_behind(self):
        self.add_geometries()
        self.write("d.csv", HEADER)
        (self.folder / "tmp").mkdir()
        environment = dict(os.environ, TMPDIR=str(self.folder / "tmp"))
        done = subprocess.run([programs.BIN / "scifi-reconstruct", "--conditions", "store.db", "--run", "7500", "d.csv"], cwd=self.folder, env=environment,
                              capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(list((self.folder / "tmp").iterdir()), [])


if __name__ == "__main__":
    programs.find("scifi-conditions")
    unittest.main()
