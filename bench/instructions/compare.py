#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Counts the instructions of a filter step and of a track's fit under callgrind and compares them with the figures kept for the compiler.

Usage: compare.py PROGRAM COMPILER [--keep]
Reports a change of more than 5 % and does not fail for it. --keep writes what was counted into figures.json beside this script.
Ends with 77 where there is no valgrind or no figure for the compiler.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FIGURES = pathlib.Path(__file__).with_name("figures.json")
COUNTED = {"filter_step": ("filter_steps", 1000), "track_fit": ("track_fits", 64)}
SKIPPED = 77
CHANGE = 0.05


def instructions(program, function):
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "callgrind.out"
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={output}", "--collect-atstart=no", f"--toggle-collect={function}", program]
        subprocess.run(command, check=True, capture_output=True)
        return int(re.search(r"^(?:totals|summary): (\d+)", output.read_text(encoding="utf-8"), re.MULTILINE).group(1))


def main():
    program, compiler = sys.argv[1], sys.argv[2]
    if shutil.which("valgrind") is None:
        print("skipped: there is no valgrind")
        return SKIPPED
    counted = {name: round(instructions(program, function) / times, 1) for name, (function, times) in COUNTED.items()}
    if min(counted.values()) <= 0:
        print(f"nothing was counted: {counted}", file=sys.stderr)
        return 1
    figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    if "--keep" in sys.argv[3:]:
        figures[compiler] = counted
        FIGURES.write_text(json.dumps(figures, indent=2, sort_keys=True) + "\n", encoding="utf-8")
    if compiler not in figures:
        print(f"skipped: no figures for {compiler}; counted {counted}; keep them with --keep")
        return SKIPPED
    for name, now in counted.items():
        before = figures[compiler][name]
        change = now / before - 1.0
        print(f"{name}: {now:.0f} instructions, kept {before:.0f}, {100.0 * change:+.1f} %" + (" CHANGED" if abs(change) > CHANGE else ""))
    return 0


if __name__ == "__main__":
    sys.exit(main())
