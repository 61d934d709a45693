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
HITS = "event,track,parent,pdg,tracker,station,plane,fibre,edep_MeV,t_ns,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV".split(",")
SOURCES = "event,tspc,track,parent,pdg,hits,edep_MeV".split(",")
PARTICLES = "event,track,parent,pdg,origin,tracker,t_ns,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV".split(",")
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
    options = ("--events", 1500, "--seed", 42, "--hits")
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


def check_history(folder):
    prefix = folder / "history"
    digits, truth = simulate(prefix, "--events", 100, "--seed", 6, "--hits", "--particle", "pi+")
    digits, truth = rows(digits, DIGITS), rows(truth, TRUTH)
    hits, sources, particles = (rows(pathlib.Path(f"{prefix}_{part}.csv").read_bytes(), header)
                                for part, header in (("hits", HITS), ("sources", SOURCES), ("particles", PARTICLES)))
    born = {(r["event"], r["track"]): r for r in particles}
    assert len(born) == len(particles), "a number belongs to one particle of the event"
    assert {r["origin"] for r in particles} == {"beam", "knocked_on", "decay"}
    assert {r["pdg"] for r in truth} == {"211"}, "crossings are those of the beam"
    for r in particles:
        assert (r["origin"] == "beam") == (r["parent"] == "0")
        assert r["parent"] == "0" or (r["event"], r["parent"]) in born
    behind = {}
    for r in hits:
        particle = born[r["event"], r["track"]]
        assert (particle["pdg"], particle["parent"]) == (r["pdg"], r["parent"])
        tspc = ((int(r["tracker"]) * 10 + int(r["station"])) * 10 + int(r["plane"])) * 1000 + int(r["fibre"]) // 7
        key = (r["event"], str(tspc), r["track"])
        behind[key] = behind.get(key, 0.0) + float(r["edep_MeV"])
    assert sources
    for r in sources:
        assert abs(behind[r["event"], r["tspc"], r["track"]] - float(r["edep_MeV"])) < 1e-5
    lit = {(r["event"], r["tspc"]) for r in sources}
    bright = {(r["event"], str(((int(r["tracker"]) * 10 + int(r["station"])) * 10 + int(r["plane"])) * 1000 + int(r["channel"])))
              for r in digits if float(r["npe"]) > 8.0}
    assert bright <= lit, "what is too bright for noise has a particle behind it"


def check_beams(folder):
    # Gaussian: the size that emittance and beta function give, 30 mm before the first station.
    prefix = folder / "gaussian"
    simulate(prefix, "--events", 4000, "--tracker", 1, "--beam", "gaussian", "--emittance", 4, "--beta", 500, "--momentum", 180, 5, "--hits", "--no-decays")
    start = [r for r in rows(pathlib.Path(f"{prefix}_particles.csv").read_bytes(), PARTICLES) if r["origin"] == "beam"]
    assert len(start) == 4000 and all(float(r["z_mm"]) == -30.0 for r in start)
    variance = sum(float(r["x_mm"]) ** 2 for r in start) / 4000
    expected = 105.658 * 4 * 500 / 180
    assert abs(variance / expected - 1) < 5 * math.sqrt(2 / 4000), (variance, expected)

    # The same particles from a file: the same crossings where they start, in the events of the file.
    table = folder / "beam.csv"
    table.write_text("event,tracker,pdg,x_mm,y_mm,z_mm,t_ns,px_MeV,py_MeV,pz_MeV,note\n"
                     "5,1,-13,10,20,-30,0,5,6,200,a\n5,0,13,0,0,1130,0,0,0,-180,b\n9,1,211,1,1,-30,0,0,0,220,c\n")
    _, truth = simulate(folder / "from_file", "--particles", table)
    first = {}
    for r in rows(truth, TRUTH):
        first.setdefault((int(r["event"]), int(r["tracker"])), r)
    assert set(first) == {(5, 0), (5, 1), (9, 1)}, set(first)
    assert first[5, 1]["pdg"] == "-13" and first[5, 0]["pdg"] == "13" and first[9, 1]["pdg"] == "211"
    assert first[5, 0]["station"] == "5" and first[5, 0]["plane"] == "2"
    assert abs(float(first[5, 1]["x_mm"]) - 10.0) < 2.0


def check_no_noise_no_particles(folder):
    digits, truth = simulate(folder / "empty", "--events", 3, "--tracks-per-event", 0, "--noise-rate", 0)
    assert digits.decode().splitlines() == [",".join(DIGITS)]
    assert truth.decode().splitlines() == [",".join(TRUTH)]


def check_dead_channels(folder):
    options = ("--events", 300, "--seed", 8)
    all_alive, truth = simulate(folder / "alive", *options)
    channel = tuple("tracker station plane channel".split())
    lit = {tuple(r[k] for k in channel) for r in rows(all_alive, DIGITS)}
    table = folder / "dead.csv"
    dead = sorted(lit)[::50]
    table.write_text(",".join(channel) + "\n" + "".join(",".join(d) + "\n" for d in dead))
    listed, same_truth = simulate(folder / "listed", *options, "--dead-channels", table)
    assert truth == same_truth, "what the particles do has nothing to do with the read-out"
    assert not {tuple(r[k] for k in channel) for r in rows(listed, DIGITS)} & set(dead)
    drawn = run("--output", folder / "drawn", *options, "--dead-share", 0.05)
    count = int(next(line for line in drawn.stdout.splitlines() if line.startswith("dead channels")).split()[2])
    assert abs(count - 320) < 5 * math.sqrt(320 * 0.95), count
    digits = len(rows((folder / "drawn_digits.csv").read_bytes(), DIGITS)) / len(rows(all_alive, DIGITS))
    assert 0.92 < digits < 0.98, digits


def check_refusals(folder):
    (folder / "wrong.csv").write_text("tracker,station,plane,channel\n0,1,0,5\n0,1,0,214\n")
    (folder / "beam_of_two.csv").write_text("event,tracker,pdg,x_mm,y_mm,z_mm,t_ns,px_MeV,py_MeV,pz_MeV\n0,2,13,0,0,0,0,0,0,200\n")
    for options, words in (
            (("--particle", "neutrino"), "'neutrino' is not known"),
            (("--pz", 300, 100), "pz"),
            (("--tracker", 2), "no tracker 2"),
            (("--events", 0), "--events"),
            (("--noise-rate", 1.5), "--noise-rate"),
            (("--dead-share", -0.1), "--dead-share"),
            (("--dead-channels", folder / "missing.csv"), "missing.csv"),
            (("--dead-channels", folder / "wrong.csv"), "wrong.csv:3: channel: 214 is outside 0 .. 213"),
            (("--dead-channels", folder / "wrong.csv", "--dead-share", 0.1), "--dead-share"),
            (("--scattering", "much"), "--scattering"),
            (("--beam", "gaussian", "--emittance", -1), "emittance"),
            (("--particles", folder / "missing.csv"), "missing.csv"),
            (("--particles", folder / "beam_of_two.csv"), "beam_of_two.csv:2: tracker: there is no tracker 2"),
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
        for check in (check_threads, check_rows, check_history, check_beams, check_no_noise_no_particles, check_dead_channels, check_refusals):
            check(pathlib.Path(name))
            print("passed:", check.__name__)
    return 0


if __name__ == "__main__":
    sys.exit(main())
