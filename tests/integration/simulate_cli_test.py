#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-simulate: the same files for any number of threads, well-formed rows, and errors that say what was wrong.

Usage: simulate_cli_test.py BIN_DIRECTORY
"""

import csv
import math
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(sys.argv[1]) / "scifi-simulate"
SKIPPED = 77
TRUTH = "event,track,pdg,tracker,station,plane,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV".split(",")
DIGITS = "event,tracker,station,plane,channel,adc,npe".split(",")


def run(*options):
    return subprocess.run([PROGRAM, *map(str, options)], capture_output=True, text=True, timeout=120, check=False)


def simulate(prefix, *options):
    done = run("--output", prefix, *options)
    assert done.returncode == 0, done.stderr
    return [pathlib.Path(f"{prefix}_{part}.csv").read_bytes() for part in ("digits", "truth")]


def rows(content, header):
    table = list(csv.DictReader(content.decode().splitlines()))
    assert list(table[0]) == header, list(table[0])
    return table


def check_threads(folder):
    # More events than a block that is simulated at once.
    options = ("--events", 1500, "--seed", 42)
    one = simulate(folder / "one", *options, "--threads", 1)
    assert one == simulate(folder / "two", *options, "--threads", 2)
    assert one != simulate(folder / "other", "--events", 1500, "--seed", 43, "--threads", 2)


def check_rows(folder):
    digits, truth = simulate(folder / "rows", "--events", 200, "--seed", 5, "--tracks-per-event", 2, "--particle", "mu-", "--pt", 10, 40, "--pz", 150, 200)
    truth, digits = rows(truth, TRUTH), rows(digits, DIGITS)
    events = [int(r["event"]) for r in truth]
    assert events == sorted(events) and set(events) == set(range(200))
    assert {r["pdg"] for r in truth} == {"13"}
    assert {r["tracker"] for r in truth} == {"0", "1"}
    tracks = {(r["event"], r["track"]) for r in truth}
    assert len(tracks) == 800, len(tracks)
    for r in truth:
        pz = float(r["pz_MeV"])
        assert (pz < 0) == (r["tracker"] == "0")
        assert math.hypot(float(r["x_mm"]), float(r["y_mm"])) <= 160.0
        assert (r["station"], r["plane"]) != ("1", "0") or float(r["z_mm"]) == 0.0
    for r in digits:
        assert 1 <= int(r["station"]) <= 5 and 0 <= int(r["plane"]) <= 2 and 0 <= int(r["channel"]) < 214
        assert float(r["npe"]) >= 2.0 and 0 <= int(r["adc"]) <= 255
    keys = [tuple(int(r[k]) for k in DIGITS[:5]) for r in digits]
    assert keys == sorted(set(keys)), "digits are unique and in order"


def check_no_noise_no_particles(folder):
    digits, truth = simulate(folder / "empty", "--events", 3, "--tracks-per-event", 0, "--noise-rate", 0)
    assert digits.decode().splitlines() == [",".join(DIGITS)]
    assert truth.decode().splitlines() == [",".join(TRUTH)]


def check_refusals(folder):
    for options, words in (
            (("--particle", "neutrino"), "'neutrino' is not known"),
            (("--pz", 300, 100), "pz"),
            (("--tracker", 2), "no tracker 2"),
            (("--events", 0), "--events"),
            (("--noise-rate", 1.5), "--noise-rate"),
            (("--scattering", "much"), "--scattering"),
            (("--geometry", folder / "missing.json"), "missing.json"),
            (("--output", folder / "no" / "such" / "folder"), "folder_digits.csv")):
        prefix = folder / "refused"
        arguments = options if options[0] == "--output" else ("--output", prefix, *options)
        done = run(*arguments)
        assert done.returncode == 2, (options, done.returncode, done.stderr)
        assert words in done.stderr, (options, done.stderr)
        left = list(folder.glob("refused*"))
        assert not left, left


def main():
    if not PROGRAM.exists():
        print(f"skipped: no {PROGRAM}")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        for check in (check_threads, check_rows, check_no_noise_no_particles, check_refusals):
            check(pathlib.Path(name))
            print("passed:", check.__name__)
    return 0


if __name__ == "__main__":
    sys.exit(main())
