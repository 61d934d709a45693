#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Every program that writes, killed, stopped and out of disk: what was there before stays until there is something complete in its place, and
scifi-reconstruct --resume goes on to the bytes of a run that was left in peace.

Usage: interruption_cli_test.py BIN
BIN is the folder of the programs. Needs the standard library alone, and strace for kills between any two system calls. Exit status 77: a program was not built.
"""

import json
import os
import resource
import shutil
import signal
import subprocess
import threading
import time
import unittest

import programs

EVENTS = 3000
OUTPUTS = ("--output", "t.csv", "--track-points", "p.csv")


def limit_files(size):
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class Fed:
    """A program whose input is a pipe with a name, so that a test decides how far it comes."""

    def __init__(self, folder, command, name):
        os.mkfifo(folder / name)
        self.name = folder / name
        self.process = subprocess.Popen(list(map(str, command)), cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.pipe = self.opened()

    def opened(self):
        """The writing end, when the program has opened the other."""
        while self.process.poll() is None:
            try:
                descriptor = os.open(self.name, os.O_WRONLY | os.O_NONBLOCK)
            except OSError:
                time.sleep(0.005)
                continue
            os.set_blocking(descriptor, True)
            return open(descriptor, "wb", buffering=0)
        raise AssertionError("ended before it read: " + self.process.communicate()[1])

    def feed(self, content):
        left = memoryview(content)
        while left:
            left = left[self.pipe.write(left):]

    def end(self, kill_with=None):
        """Sends a signal, closes the pipe; status and messages of the program."""
        if kill_with is not None:
            self.process.send_signal(kill_with)
        # A thread other than that which was signalled may be reading: the end of the input wakes it up.
        closer = threading.Timer(0.3 if kill_with is not None else 0.0, self.pipe.close)
        closer.start()
        errors = self.process.communicate(timeout=60)[1]
        closer.join()
        self.name.unlink()
        return self.process.returncode, errors


class Resume(programs.BesideItsPage):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.install("scifi-reconstruct", "monitor.html")
        cls.make("scifi-simulate", "--events", EVENTS, "--tracker", "1", "--seed", 8, "--output", "s")
        cls.digits = (cls.folder / "s_digits.csv").read_bytes()
        cls.make("scifi-reconstruct", "s_digits.csv", *OUTPUTS)
        cls.expected = [cls.take(name) for name in ("t.csv", "p.csv")]

    @classmethod
    def take(cls, name):
        content = (cls.folder / name).read_bytes()
        (cls.folder / name).unlink()
        return content

    def setUp(self):
        for name in ("t.csv", "p.csv"):
            (self.folder / name).write_bytes(b"old")

    def tearDown(self):
        for path in self.folder.iterdir():
            if path.name.startswith(("t.csv", "p.csv", "m.html", "in.csv")):
                path.unlink()

    def rows_up_to(self, event):
        """The beginning of the input, up to a row of that event."""
        return self.digits[:self.digits.index(b"\n%d," % event) + 1]

    def expect_old(self):
        for name in ("t.csv", "p.csv"):
            self.assertEqual((self.folder / name).read_bytes(), b"old")

    def expect_complete(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        for name, expected in zip(("t.csv", "p.csv"), self.expected):
            self.assertTrue((self.folder / name).read_bytes() == expected, name + " has other bytes")
        self.assertEqual([p.name for p in self.folder.iterdir() if "partial" in p.name or "checkpoint" in p.name], [])

    def resume(self, *arguments, **how):
        return subprocess.run([self.program, "s_digits.csv", *OUTPUTS, "--resume", *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=120,
                              check=False, **how)

    def fed(self, *arguments):
        return Fed(self.folder, [self.program, "in.csv", *OUTPUTS, *arguments], "in.csv")

    def events_saved(self):
        try:
            return json.loads((self.folder / "t.csv.checkpoint").read_text(encoding="ascii"))["sum"]["events"]
        except FileNotFoundError:
            return 0

    def partly(self, *arguments, event=1500, kill_with=signal.SIGKILL):
        """A run that is stopped when a good part is done and written."""
        run = self.fed(*arguments)
        run.feed(self.rows_up_to(400))
        # A checkpoint is written when some time has passed since the last.
        programs.wait_for(lambda: (self.folder / "t.csv.partial").stat().st_size > 10000, "the first block")
        time.sleep(0.3)
        run.feed(self.digits[len(self.rows_up_to(400)):len(self.rows_up_to(event))])
        programs.wait_for(lambda: self.events_saved() > 0, "a checkpoint")
        return run.end(kill_with)

    def test_killed_runs_are_completed_however_far_they_came(self):
        for events in (1, 700, 2900):
            with self.subTest(events=events):
                self.setUp()
                run = self.fed("--threads", "2")
                run.feed(self.rows_up_to(events))
                time.sleep(0.25)
                self.assertEqual(run.end(signal.SIGKILL)[0], -signal.SIGKILL)
                self.expect_old()
                self.expect_complete(self.resume("--threads", "1"))

    def test_a_run_killed_again_and_again_is_completed(self):
        done = 0
        for attempt in range(200):
            process = subprocess.Popen([self.program, "s_digits.csv", *OUTPUTS, "--resume", "--threads", "1"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                if process.wait(timeout=0.02 + 0.03 * attempt) == 0:
                    break
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            for name, expected in zip(("t.csv", "p.csv"), self.expected):
                self.assertTrue((self.folder / name).read_bytes() in (b"old", expected), name + " is neither the old one nor the new one")
            if (self.folder / "t.csv").stat().st_size > len(b"old"):
                break
            self.assertGreaterEqual(self.events_saved(), done)
            done = self.events_saved()
        else:
            self.fail("never done")
        self.expect_complete(self.resume())

    @unittest.skipUnless(shutil.which("strace"), "needs strace")
    def test_a_kill_at_any_system_call_loses_nothing(self):
        """Renames, removals and the like of the last moments; writes of the tables and of checkpoints on the way."""
        tried = 0
        for call, calls in (("fsync", 2), ("rename", 4), ("unlink", 1), ("write", 3)):
            for number in range(1, calls + 1):
                with self.subTest(call=call, number=number):
                    self.setUp()
                    killed = subprocess.run(["strace", "-f", "-qq", "-o", "/dev/null", "-e", "trace=" + call, "-e", f"inject={call}:signal=KILL:when={number}", self.program, "s_digits.csv",
                                             *OUTPUTS], cwd=self.folder, capture_output=True, timeout=120, check=False)
                    if killed.returncode != 0:
                        tried += 1
                        self.assertTrue(any((self.folder / name).read_bytes() in (b"old", new) for name, new in zip(("t.csv", "p.csv"), self.expected)))
                        self.assertIn((self.folder / "t.csv").read_bytes(), (b"old", self.expected[0]))
                    self.expect_complete(self.resume())
        self.assertGreater(tried, 6)

    def test_a_signal_ends_the_run_in_order(self):
        for which, name in ((signal.SIGINT, "SIGINT"), (signal.SIGTERM, "SIGTERM")):
            with self.subTest(name=name):
                self.setUp()
                status, errors = self.partly(kill_with=which)
                self.assertEqual(status, 128 + which, errors)
                self.assertIn(f"stopped by {name}; the ", errors)
                self.assertIn("events before the signal are kept in t.csv.partial, p.csv.partial; --resume goes on from there", errors)
                self.expect_old()
                # What is kept is the beginning of what is complete, to its last byte.
                for kept, whole in zip(("t.csv.partial", "p.csv.partial"), self.expected):
                    self.assertTrue(whole.startswith((self.folder / kept).read_bytes()))
                done = self.events_saved()
                result = self.resume()
                self.assertIn(f"goes on after {done} events", result.stderr)
                self.assertIn(f"{EVENTS}   {done} of them before this run", result.stdout)
                self.expect_complete(result)

    def test_without_resume_a_run_starts_anew_and_the_summary_counts_all(self):
        self.partly()
        result = self.run_program("s_digits.csv", *OUTPUTS)
        self.assertNotIn("before this run", result.stdout)
        self.expect_complete(result)
        self.setUp()
        self.partly()
        counts = [line for line in result.stdout.splitlines() if line.split()[0] in ("digits", "clusters", "space", "candidates", "tracks", "failures")]
        again = self.resume()
        self.assertEqual([line for line in counts if line not in again.stdout], [])

    def test_where_there_is_nothing_to_go_on_with_a_run_begins_at_the_beginning(self):
        result = self.resume()
        self.assertIn("nothing to go on with: from the beginning", result.stderr)
        self.expect_complete(result)

    def test_a_run_goes_on_when_the_mistake_in_its_input_is_mended(self):
        bad = self.digits.split(b"\n")
        bad[len(bad) // 2] += b",1"
        (self.folder / "in.csv").write_bytes(b"\n".join(bad))
        result = self.run_program("in.csv", *OUTPUTS)
        self.assertEqual(result.returncode, 2)
        self.assertIn("events before the mistake are kept in t.csv.partial, p.csv.partial; --resume goes on from there", result.stderr)
        self.expect_old()
        self.expect_complete(self.resume())

    def test_a_full_disk_is_reported_and_the_run_goes_on_when_there_is_room(self):
        size = len(self.expected[1])
        for share in (0.001, 0.5, 0.99):
            with self.subTest(share=share):
                self.setUp()
                result = subprocess.run([self.program, "s_digits.csv", *OUTPUTS, "--threads", "1"], cwd=self.folder, capture_output=True, text=True, timeout=120, check=False,
                                        preexec_fn=limit_files(int(share * size)))
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertRegex(result.stderr, "[tp].csv: could not be written: File too large")
                self.expect_old()
                self.expect_complete(self.resume())

    def test_a_full_standard_output_is_reported(self):
        with open("/dev/full", "wb") as full:
            result = subprocess.run([self.program, "s_digits.csv"], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True, timeout=120, check=False)
        self.assertEqual(result.returncode, 3)
        self.assertIn("standard output: could not be written", result.stderr)
        (self.folder / "tracks.csv").unlink()

    def test_another_run_is_not_gone_on_with(self):
        self.partly()
        for arguments, message in ((["--field", "2.9"], "--resume: --field is now \"2.9\", was \"3 T\" in the run that t.csv.checkpoint is of"),
                                   (["--particle", "pi"], "--particle is now"), (["--monitor", "m.html"], "--monitor is now true")):
            result = self.resume(*arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(message, result.stderr)
        self.assertIn("--resume: the tracks must go to files", self.run_program("s_digits.csv", "--output", "/dev/null", "--resume").stderr)
        (self.folder / "in.csv").write_bytes(self.digits[:5000])
        result = subprocess.run([self.program, "in.csv", *OUTPUTS, "--resume"], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("events are not those of the run to be resumed", result.stderr)
        self.expect_old()
        # None of this has touched what is there.
        partial = self.folder / "t.csv.partial"
        good = partial.read_bytes()
        partial.write_bytes(good[:2000] + b"x" + good[2001:])
        result = self.resume()
        self.assertEqual(result.returncode, 2)
        self.assertIn("t.csv.partial: does not begin as t.csv.checkpoint says", result.stderr)
        partial.write_bytes(good)
        checkpoint = self.folder / "t.csv.checkpoint"
        whole = checkpoint.read_bytes()
        checkpoint.write_bytes(whole[:100])
        self.assertIn("t.csv.checkpoint: is not a checkpoint of this program", self.resume().stderr)
        checkpoint.write_bytes(whole)
        self.expect_complete(self.resume())

    def test_two_runs_do_not_write_the_same_file(self):
        run = self.fed()
        run.feed(self.rows_up_to(100))
        programs.wait_for(lambda: (self.folder / "t.csv.partial").exists(), "the first run")
        result = self.resume()
        self.assertEqual(result.returncode, 2)
        self.assertIn("t.csv: cannot be written: another process is writing t.csv.partial", result.stderr)
        run.feed(self.digits[len(self.rows_up_to(100)):])
        status, errors = run.end()
        self.assertEqual(status, 0, errors)
        self.assertTrue((self.folder / "t.csv").read_bytes() == self.expected[0])

    def test_histograms_count_every_event_once(self):
        self.partly("--monitor", "m.html")
        self.expect_complete(self.resume("--monitor", "m.html"))
        resumed = json.loads(self.data_of("m.html"))
        self.run_program("s_digits.csv", *OUTPUTS, "--monitor", "m.html")
        at_once = json.loads(self.data_of("m.html"))
        self.assertEqual(resumed["status"]["events"], at_once["status"]["events"])
        self.assertEqual(resumed["plots"], at_once["plots"])
        self.assertEqual(resumed["trackers"], at_once["trackers"])


class Writers(programs.BesideItsPage):
    """The other programs: no half file under a name, whatever happens."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.install("scifi-display", "display.html")
        cls.make("scifi-simulate", "--events", 200, "--tracker", "1", "--seed", 8, "--output", "s")
        cls.make("scifi-reconstruct", "s_digits.csv", "--output", "s_tracks.csv")
        channels = [(t, s, p, c) for t in range(2) for s in range(1, 6) for p in range(3) for c in range((214, 214, 212)[p])]
        cabling = "".join(f"{i // 512} {i // 128 % 4} {i % 128} {t} {s} {p} {c} 1 1 1\n" for i, (t, s, p, c) in enumerate(channels))
        (cls.folder / "cabling.txt").write_text(cabling, encoding="ascii")
        line = {"bank": 0, "channel": 0, "adc_gain": 10.0, "adc_pedestal": 20.0, "tdc_gain": 0.0, "tdc_pedestal": 0.0}
        (cls.folder / "calibration.txt").write_text(json.dumps([line]), encoding="ascii")
        (cls.folder / "bad.txt").write_text("", encoding="ascii")
        (cls.folder / "raw.csv").write_text("event,board,bank,channel,adc\n" + "".join(f"{n},0,0,0,200\n" for n in range(2000)), encoding="ascii")
        digitise = ["--cabling", "cabling.txt", "--calibration", "calibration.txt", "--bad-channels", "bad.txt"]
        # Program, input, how it is run on it, what it writes.
        cls.cases = ((programs.BIN / "scifi-digitise", "raw.csv", lambda name: [*digitise, "-o", "out.csv", name], ["out.csv"]),
                     (programs.BIN / "scifi-study", "s_tracks.csv", lambda name: ["s_truth.csv", name, "--no-page", "-o", "."], ["study.json"]),
                     (cls.program, "s_digits.csv", lambda name: [name, "--events", "200", "--output", "out.html"], ["out.html"]))

    def old(self, names):
        for name in names:
            (self.folder / name).write_bytes(b"old")

    def expect_old(self, names):
        for name in names:
            self.assertEqual((self.folder / name).read_bytes(), b"old")

    def partial(self):
        return [p for p in self.folder.iterdir() if p.name.endswith(".partial")]

    def tearDown(self):
        for path in self.partial():
            path.unlink()

    def simulate(self, *arguments, **how):
        return subprocess.Popen([programs.BIN / "scifi-simulate", "--output", "x", *arguments], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **how)

    def test_a_full_disk_is_reported(self):
        for program, name, arguments, written in self.cases:
            with self.subTest(program=program.name):
                self.old(written)
                result = subprocess.run([program, *arguments(name)], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False, preexec_fn=limit_files(1000))
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertIn(written[0] + ": could not be written: File too large", result.stderr)
                self.expect_old(written)
                self.assertEqual(self.partial(), [])
        names = ["x_digits.csv", "x_truth.csv"]
        self.old(names)
        process = self.simulate("--events", "5000", preexec_fn=limit_files(20000))
        self.assertIn("could not be written: File too large", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 3)
        self.expect_old(names)
        self.assertEqual(self.partial(), [])

    def test_a_program_that_is_stopped_leaves_what_was_there(self):
        for program, name, arguments, written in self.cases:
            for which in (signal.SIGINT, signal.SIGKILL):
                with self.subTest(program=program.name, signal=which):
                    self.old(written)
                    run = Fed(self.folder, [program, *arguments("in.csv")], "in.csv")
                    content = (self.folder / name).read_bytes()
                    run.feed(content[:len(content) // 2])
                    time.sleep(0.2)
                    status, errors = run.end(which)
                    self.assertEqual(status, 130 if which == signal.SIGINT else -9, errors)
                    self.assertIn("stopped by SIGINT" if which == signal.SIGINT else "", errors)
                    self.expect_old(written)
                    if which == signal.SIGINT:
                        self.assertEqual(self.partial(), [])
                    self.tearDown()

    def test_an_alignment_that_is_stopped_leaves_what_was_there(self):
        header, _, rows = (self.folder / "s_digits.csv").read_text(encoding="ascii").partition("\n")
        split = [row.split(",", 1) for row in rows.splitlines()]
        many = self.folder / "many.csv"
        many.write_text(header + "\n" + "".join(f"{200 * i + int(event)},{rest}\n" for i in range(150) for event, rest in split), encoding="ascii")
        names = ["aligned.json", "parameters.json"]
        for which in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            with self.subTest(signal=which):
                self.old(names)
                process = subprocess.Popen([programs.BIN / "scifi-align", many, "--field", "3", "--tracker", "1", "--output", *names[:1], "--parameters", *names[1:]], cwd=self.folder,
                                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                programs.wait_for(self.partial, "the first pass")
                process.send_signal(which)
                errors = process.communicate(timeout=60)[1]
                self.assertEqual(process.returncode, -9 if which == signal.SIGKILL else 128 + which, errors)
                self.assertEqual(errors, "" if which == signal.SIGKILL else f"scifi-align: stopped by {which.name}; nothing was written\n")
                self.expect_old(names)
                if which != signal.SIGKILL:
                    self.assertEqual(self.partial(), [])
                self.tearDown()

    def test_a_simulation_that_is_stopped_leaves_what_was_there(self):
        names = ["x_digits.csv", "x_truth.csv"]
        for which in (signal.SIGINT, signal.SIGKILL):
            self.old(names)
            process = self.simulate("--events", "100000000", "--threads", "1")
            programs.wait_for(lambda: any(p.stat().st_size > 100000 for p in self.partial()), "some events")
            process.send_signal(which)
            errors = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, 130 if which == signal.SIGINT else -9, errors)
            self.expect_old(names)
            if which == signal.SIGINT:
                self.assertEqual(self.partial(), [])
            self.tearDown()


if __name__ == "__main__":
    programs.find("scifi-reconstruct", "scifi-simulate", "scifi-align", "scifi-display", "scifi-digitise", "scifi-study")
    unittest.main()
