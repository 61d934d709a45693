#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""scifi-compare-simulation: the simulation lies within its limits of a Geant4 simulation of the same tracker; errors say what was wrong.

Usage: compare_simulation_test.py BIN_DIRECTORY
The comparison needs the data sets that the environment variable SCIFI_SHARED_DATA points to.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(sys.argv[1]) / "scifi-compare-simulation"
SKIPPED = 77
TRUTH = "event,track,pdg,tracker,station,plane,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV\n"
HITS = "event,track,parent,pdg,tracker,station,plane,fibre,edep_MeV\n"


def run(*options):
    return subprocess.run([PROGRAM, *map(str, options)], capture_output=True, text=True, timeout=500, check=False)


def check_refusals(folder):
    truth, hits = folder / "truth.csv", folder / "hits.csv"
    hits.write_text(HITS)
    truth.write_text(TRUTH)
    for content, words in ((TRUTH, "no particle crosses"),
                           (TRUTH + "0,1,-13,7,1,0,0,0,0,0,0,200\n", "truth.csv:2: tracker: there is no tracker 7"),
                           (TRUTH + "0,1,-13,1,1,0,0,0,0,0,0,200\n1,1,-13,0,1,0,0,0,0,0,0,200\n", "truth.csv:3: tracker: 0 is not 1"),
                           (TRUTH + "0,1,-13,1,50,0,0,0,0,0,0,200\n", "truth.csv:2: plane: there is no plane 0 in station 50 of tracker 1"),
                           (TRUTH + "0,1,-13,1,1,-1,0,0,0,0,0,200\n", "truth.csv:2: plane: there is no plane -1"),
                           (TRUTH + "0,1,-13,1,1,0,0,0,0,0,0,0\n", "truth.csv:2: pz_MeV: a crossing needs"),
                           (TRUTH + "0,1,-13,1,1,0,0,0,0,0,0,200\n0,2,-13,1,1,0,0,0,0,0,0,200\n", "second particle")):
        truth.write_text(content)
        done = run("--truth", truth, "--hits", hits)
        assert done.returncode == 2, done
        assert words in done.stderr, done.stderr


def check_a_difference_is_seen(folder):
    # One muon that loses nothing and leaves next to nothing, a hundred times.
    z = [0.0, 0.6523, 1.3046]
    truth, hits = folder / "truth.csv", folder / "hits.csv"
    rows = [f"{event},1,-13,1,1,{plane},0,0,{z[plane]},0,0,{200 - 0.001 * plane}\n" for event in range(100) for plane in range(3)]
    truth.write_text(TRUTH + "".join(rows))
    hits.write_text(HITS + "".join(f"{event},1,0,-13,1,1,{plane},740,0.001\n" for event in range(100) for plane in range(3)))
    done = run("--truth", truth, "--hits", hits, "--repeat", 1, "--check")
    assert done.returncode == 1, done
    assert "OUTSIDE" in done.stdout


def check_against_geant4(data):
    sets = pathlib.Path(data) / "g4"
    done = run("--truth", sets / "tkd_helical_truth.csv.gz", "--hits", sets / "tkd_helical_hits.csv.gz", "--check")
    print(done.stdout)
    assert done.returncode == 0, done.stderr


def main():
    if not PROGRAM.exists():
        print(f"skipped: no {PROGRAM}")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        check_refusals(pathlib.Path(name))
        check_a_difference_is_seen(pathlib.Path(name))
    data = os.environ.get("SCIFI_SHARED_DATA")
    if data:
        check_against_geant4(data)
    else:
        print("the comparison is left out: SCIFI_SHARED_DATA is not set")
    return 0


if __name__ == "__main__":
    sys.exit(main())
