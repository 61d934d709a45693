#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Checks that a file does not compile and that the reader is told why, first.

Usage: check_compile_fail.py FILE COMPILER FLAGS...
Line 2 of FILE is `// expect: sentence`. The sentence must stand in the first error the compiler prints.
"""

import pathlib
import re
import subprocess
import sys

MARK = "// expect: "


def main():
    path, command = pathlib.Path(sys.argv[1]), sys.argv[2:]
    lines = path.read_text(encoding="utf-8").splitlines()
    if len(lines) < 2 or not lines[1].startswith(MARK):
        print(f"{path}: line 2 must be `{MARK}sentence`")
        return 1
    sentence = lines[1].removeprefix(MARK).strip()
    run = subprocess.run(command + ["-fsyntax-only", "-fno-diagnostics-color", str(path)], text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if run.returncode == 0:
        print(f"{path}: compiled, although it should not")
        return 1
    # An error may be continued by notes: the first error with all that belongs to it.
    errors = re.split(r"(?m)^(?=.*\berror: )", run.stdout)[1:]
    if not errors:
        print(f"{path}: the compiler failed without an error message:\n{run.stdout[:3000]}")
        return 1
    if sentence not in re.sub(r"\s+", " ", errors[0]):
        where = "later, not in the first error" if sentence in run.stdout else "nowhere"
        print(f"{path}: expected the sentence\n  {sentence}\nand found it {where}:\n{run.stdout[:4000]}")
        return 1
    print(errors[0].splitlines()[0])
    return 0


if __name__ == "__main__":
    sys.exit(main())
