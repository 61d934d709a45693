#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-reconstruct and scifi-study under mpirun: the bytes of a single process, whatever dies.

Usage: many_ranks_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library and Open MPI. Exit status 77: there is no Open MPI, or the program was built without SCIFI_MPI.
"""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import threading
import time
import unittest

import programs

EVENTS = 4000
OUTPUTS = ("--output", "t.csv", "--track-points", "p.csv")
MPIRUN = ["mpirun", "--oversubscribe", "--allow-run-as-root"]


def skip_without_mpi():
    if shutil.which("mpirun") is None:
        programs.skip("no mpirun")
    if "Open MPI" not in subprocess.run(["mpirun", "--version"], capture_output=True, text=True, timeout=60, check=False).stdout:
        programs.skip("mpirun is not that of Open MPI")
    probe = subprocess.run([*MPIRUN, "-n", "2", programs.BIN / "scifi-reconstruct", "none.csv"], capture_output=True, text=True, timeout=60, check=False)
    if "built without MPI: configure with -D SCIFI_MPI=ON" in probe.stderr:
        programs.skip("scifi-reconstruct was built without SCIFI_MPI, and says so under mpirun")


def rank_of(process):
    """Rank of one of our processes by its number, or nothing."""
    try:
        for entry in pathlib.Path(f"/proc/{process}/environ").read_bytes().split(b"\0"):
            if entry.startswith(b"OMPI_COMM_WORLD_RANK="):
                return int(entry.split(b"=")[1])
    except (OSError, ValueError):
        pass
    return None


def children_of(process):
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1]) == process:
                found.append(int(entry.name))
        except OSError:
            pass
    return found


class ManyRanks(programs.BesideItsPage):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.install("scifi-reconstruct", "monitor.html")
        cls.make("scifi-simulate", "--events", EVENTS, "--tracker", "1", "--seed", 9, "--output", "s")
        cls.digits = (cls.folder / "s_digits.csv").read_bytes()
        cls.single = cls.run_program("s_digits.csv", *OUTPUTS, "--monitor", "m.html")
        cls.histograms = json.loads(cls.data_of("m.html"))
        cls.expected = [(cls.folder / name).read_bytes() for name in ("t.csv", "p.csv")]

    def setUp(self):
        for name in ("t.csv", "p.csv"):
            (self.folder / name).write_bytes(b"old")

    def tearDown(self):
        for path in self.folder.iterdir():
            if path.name.startswith(("t.csv", "p.csv", "m.html", "in.csv")):
                path.unlink()

    def command(self, ranks, *arguments):
        return [*MPIRUN, "-n", str(ranks), self.program, *map(str, arguments)]

    def on_ranks(self, ranks, *arguments, **how):
        return subprocess.run(self.command(ranks, *arguments), cwd=self.folder, capture_output=True, text=True, timeout=120, check=False, **how)

    def expect_complete(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        for name, expected in zip(("t.csv", "p.csv"), self.expected):
            self.assertTrue((self.folder / name).read_bytes() == expected, name + " has other bytes")
        self.assertEqual([p.name for p in self.folder.iterdir() if "partial" in p.name or "checkpoint" in p.name], [])

    def expect_old(self):
        for name in ("t.csv", "p.csv"):
            self.assertEqual((self.folder / name).read_bytes(), b"old")

    def events_saved(self):
        try:
            return json.loads((self.folder / "t.csv.checkpoint").read_text(encoding="ascii"))["sum"]["events"]
        except FileNotFoundError:
            return 0

    def drip(self):
        """Feeds the input so slowly that a job may be stopped in the middle of it."""
        piece = 5000
        try:
            with open(self.folder / "in.csv", "wb", buffering=0) as pipe:
                for at in range(0, len(self.digits), piece):
                    self.assertEqual(pipe.write(self.digits[at:at + piece]), len(self.digits[at:at + piece]))
                    time.sleep(0.01)
        except BrokenPipeError:
            pass

    def stopped(self, stop, *arguments):
        """A job in the middle of its input when stop(mpirun, {rank: process}) is called; status and messages."""
        os.mkfifo(self.folder / "in.csv")
        with subprocess.Popen(list(map(str, self.command(4, "in.csv", *OUTPUTS, *arguments))), cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as job:
            feeder = threading.Thread(target=self.drip, daemon=True)
            feeder.start()
            try:
                programs.wait_for(lambda: self.events_saved() > 500, "a checkpoint")
                stop(job.pid, {rank_of(p): p for p in children_of(job.pid)})
                errors = job.communicate(timeout=60)[1]
            finally:
                job.kill()
            feeder.join(timeout=60)
        (self.folder / "in.csv").unlink()
        return job.returncode, errors

    def test_the_bytes_are_those_of_one_process_and_so_are_counts_and_histograms(self):
        for ranks in (1, 2, 4):
            with self.subTest(ranks=ranks):
                self.setUp()
                result = self.on_ranks(ranks, "s_digits.csv", *OUTPUTS, "--monitor", "m.html")
                self.expect_complete(result)
                kept = ("events", "digits", "clusters", "space", "candidates", "tracks", "failures")
                self.assertEqual(*([line for line in r.stdout.splitlines() if line.split()[0] in kept] for r in (result, self.single)))
                self.assertIn(f"{ranks} ranks" if ranks > 1 else "thread", result.stdout)
                self.assertEqual(result.stdout.count("scifi-reconstruct"), 1)
                histograms = json.loads(self.data_of("m.html"))
                self.assertEqual(histograms["status"]["events"], EVENTS)
                for part in ("plots", "trackers"):
                    self.assertEqual(histograms[part], self.histograms[part])

    def test_a_rank_that_dies_ends_the_job_and_nothing_is_lost(self):
        for dead in (0, 2):
            with self.subTest(rank=dead):
                self.setUp()
                status, errors = self.stopped(lambda _, ranks, dead=dead: os.kill(ranks[dead], signal.SIGKILL))
                self.assertNotEqual(status, 0)
                self.assertIn(f"process rank {dead}", errors)
                self.assertIn("signal 9 (Killed)", errors)
                self.expect_old()
                done = self.events_saved()
                result = self.on_ranks(4, "s_digits.csv", *OUTPUTS, "--resume") if dead == 0 else self.run_program("s_digits.csv", *OUTPUTS, "--resume")
                self.assertIn(f"goes on after {done} events", result.stderr)
                self.expect_complete(result)

    def test_a_job_of_one_process_is_gone_on_with_by_many_and_the_histograms_count_every_event_once(self):
        status, errors = self.stopped(lambda job, _: os.kill(job, signal.SIGINT), "--monitor", "m.html")
        self.assertNotEqual(status, 0, errors)
        self.expect_old()
        self.expect_complete(self.on_ranks(3, "s_digits.csv", *OUTPUTS, "--resume", "--monitor", "m.html"))
        histograms = json.loads(self.data_of("m.html"))
        for part in ("plots", "trackers"):
            self.assertEqual(histograms[part], self.histograms[part])

    def test_what_is_wrong_is_said_once(self):
        bad = self.digits.split(b"\n")
        bad[len(bad) // 2] += b",1"
        (self.folder / "in.csv").write_bytes(b"\n".join(bad))
        for arguments, status, message in ((["in.csv"], 2, "fields where the header names"), (["none.csv"], 2, "none.csv: cannot be opened"), (["s_digits.csv", "--field", "x"], 2, "--field: 'x' is neither a number of tesla"),
                                           (["s_digits.csv", "--threads", "2"], 2, "--threads: under mpirun every rank is one thread"), (["s_digits.csv", "--nonsense"], 2, "--nonsense")):
            with self.subTest(arguments=arguments):
                result = self.on_ranks(4, *arguments, *OUTPUTS)
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertEqual(result.stderr.count(message), 1, result.stderr)
                self.expect_old()

    def test_a_rank_that_cannot_begin_says_why(self):
        # As where a file is not on every machine.
        result = subprocess.run([*MPIRUN, "-n", "2", self.program, "s_digits.csv", *OUTPUTS, ":", "-n", "1", self.program, "s_digits.csv", *OUTPUTS, "--geometry", "none.json"],
                                cwd=self.folder, capture_output=True, text=True, timeout=120, check=False)
        self.assertNotEqual(result.returncode, 0)
        self.assertEqual(result.stderr.count("none.json: cannot be opened"), 1, result.stderr)
        self.expect_old()

    def test_a_full_disk_is_reported(self):
        result = self.on_ranks(4, "s_digits.csv", "--output", "t.csv", "--track-points", "/dev/full")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("/dev/full: could not be written: No space left on device", result.stderr)
        self.expect_old()


class ManyRanksStudy(programs.InAFolder):
    INPUT = ("s_truth.csv", "t.csv", "--track-points", "p.csv", "--digits", "s_digits.csv", "--no-page", "-o")

    def setUp(self):
        if not (programs.BIN / "scifi-study").exists():
            self.skipTest("no scifi-study")
        super().setUp()
        for program, *arguments in (("scifi-simulate", "--events", 2000, "--tracker", "both", "--seed", 4, "--output", "s"), ("scifi-reconstruct", "s_digits.csv", *OUTPUTS)):
            self.assertEqual(self.run_program(program, *arguments).returncode, 0)

    def on_ranks(self, ranks, *arguments):
        return [*MPIRUN, "-n", str(ranks), str(programs.BIN / "scifi-study"), *arguments]

    def run_on_ranks(self, ranks, *arguments):
        return subprocess.run(self.on_ranks(ranks, *arguments), cwd=self.folder, capture_output=True, text=True, timeout=120, check=False)

    def test_the_study_is_that_of_one_process(self):
        single = self.run_program("scifi-study", *self.INPUT, "one")
        self.assertEqual(single.returncode, 0, single.stderr)
        expected = (self.folder / "one" / "study.json").read_bytes()
        self.assertEqual([d["title"] for d in json.loads(expected)["displays"]][:1], ["a typical track"])
        for ranks in (1, 2, 3, 5):
            with self.subTest(ranks=ranks):
                result = self.run_on_ranks(ranks, *self.INPUT, "many")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertTrue((self.folder / "many" / "study.json").read_bytes() == expected, "study.json has other bytes")
                self.assertEqual(result.stdout.replace("many/", "one/"), single.stdout)

    def test_what_is_wrong_is_said_once_and_leaves_the_old_study(self):
        rows = (self.folder / "s_truth.csv").read_text().splitlines()
        rows[len(rows) // 2] += ",1"
        self.write("bad.csv", "\n".join(rows))
        (self.folder / "many").mkdir()
        self.write("many/study.json", "old")
        for arguments, message in ((("bad.csv", *self.INPUT[1:]), "fields where the header names"), (("none.csv", *self.INPUT[1:]), "none.csv: cannot be opened"), (("--pt-edges", "2,1", *self.INPUT), "--pt-edges")):
            with self.subTest(arguments=arguments):
                result = self.run_on_ranks(3, *arguments, "many")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertEqual(result.stderr.count(message), 1, result.stderr)
                self.assertEqual((self.folder / "many" / "study.json").read_text(), "old")

    def test_a_rank_that_dies_ends_the_job_and_leaves_the_old_study(self):
        (self.folder / "many").mkdir()
        self.write("many/study.json", "old")
        for dead in (0, 2):
            with self.subTest(rank=dead), subprocess.Popen(self.on_ranks(3, *self.INPUT, "many"), cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as job:
                ranks = {}

                def started():
                    ranks.update({rank_of(p): p for p in children_of(job.pid)})
                    return dead in ranks

                programs.wait_for(started, "a rank")
                os.kill(ranks[dead], signal.SIGKILL)
                errors = job.communicate(timeout=60)[1]
                self.assertNotEqual(job.returncode, 0)
                self.assertIn(f"process rank {dead}", errors)
                self.assertEqual((self.folder / "many" / "study.json").read_text(), "old")


if __name__ == "__main__":
    programs.find("scifi-reconstruct", "scifi-simulate")
    skip_without_mpi()
    unittest.main()
