#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Compiles every header by itself, without a warning.

Usage: check_headers_alone.py FOLDER EXCLUDE JOBS COMPILER FLAGS...
FOLDER is searched for *.hpp; a header whose path matches the regular expression EXCLUDE is left out.
"""

import concurrent.futures
import pathlib
import re
import subprocess
import sys


def compile_alone(command, folder, header):
    source = f"#include <{header.relative_to(folder).as_posix()}>\n" * 2  # twice: the guard works
    run = subprocess.run(command + ["-fsyntax-only", "-Werror", "-x", "c++", "-"], input=source, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return header, run.returncode, run.stdout


def main():
    folder, exclude, jobs, command = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), sys.argv[4:]
    headers = sorted(h for h in folder.rglob("*.hpp") if not re.search(exclude, h.as_posix()))
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for header, code, output in pool.map(lambda h: compile_alone(command, folder, h), headers):
            if code != 0:
                failed += 1
                print(f"{header.relative_to(folder)} does not compile alone:\n{output[:3000]}")
    print(f"{len(headers)} headers compiled alone, {failed} failed")
    return 1 if failed or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
