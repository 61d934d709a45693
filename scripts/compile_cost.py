#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Compiles each source of bench/compile_cost and writes what that took as JSON: seconds of processor time and peak memory in MB.

Usage: compile_cost.py EIGEN_INCLUDE_FOLDER OUTPUT.json [COMPILER]   (c++ unless given)
The least of three times: whatever else the machine does only adds to it.
"""

import json
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
REPETITIONS = 3


def cost(command):
    child = os.posix_spawnp(command[0], command, os.environ)
    _, status, used = os.wait4(child, 0)
    if status != 0:
        sys.exit(f"does not compile: {' '.join(command)}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0


def main():
    eigen, output = sys.argv[1], sys.argv[2]
    compiler = sys.argv[3] if len(sys.argv) > 3 else "c++"
    found = {}
    for source in sorted((ROOT / "bench" / "compile_cost").glob("*.cpp")):
        command = [compiler, "-std=c++20", "-O2", "-DNDEBUG", "-I", str(ROOT / "include"), "-isystem", eigen, "-c", str(source), "-o", os.devnull]
        costs = [cost(command) for _ in range(REPETITIONS)]
        found[source.stem] = {"seconds": min(c[0] for c in costs), "megabytes": max(c[1] for c in costs)}
    pathlib.Path(output).write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
