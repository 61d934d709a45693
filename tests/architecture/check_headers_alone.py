#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Compiles every header by itself, without a warning.

Usage: check_headers_alone.py FOLDER EXCLUDE JOBS COMPILER FLAGS...
FOLDER is searched for *.hpp; a header whose path matches the regular expression EXCLUDE is left out. Eigen takes most of the time of most headers: where a header
includes it, itself or through others of FOLDER, it is precompiled.
"""

import concurrent.futures
import pathlib
import re
import subprocess
import sys
import tempfile

EIGEN = "Eigen/Core"


def includes(path):
    return set(re.findall(r'^#include [<"]([^>"]+)', path.read_text(encoding="utf-8"), re.MULTILINE))


def with_eigen(folder, headers):
    """Those of the headers that come to include Eigen."""
    direct = {h.relative_to(folder).as_posix(): includes(h) for h in headers}
    found = {h for h, of in direct.items() if EIGEN in of}
    while more := {h for h, of in direct.items() if h not in found and of & found}:
        found |= more
    return found


def compile_alone(command, folder, header):
    """Whether it compiles, and what the compiler says."""
    source = f"#include <{header.relative_to(folder).as_posix()}>\n" * 2  # twice: the guard works
    run = subprocess.run(command + ["-fsyntax-only", "-Werror", "-x", "c++", "-"], input=source, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return header, run.returncode, run.stdout


def main():
    folder, exclude, jobs, command = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), sys.argv[4:]
    headers = sorted(h for h in folder.rglob("*.hpp") if not re.search(exclude, h.as_posix()))
    failed = 0
    eigen = with_eigen(folder, sorted(folder.rglob("*.hpp")))
    with tempfile.TemporaryDirectory() as made, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        begin = pathlib.Path(made) / "begin.hpp"
        begin.write_text(f"#include <{EIGEN}>\n", encoding="utf-8")
        subprocess.run(command + ["-x", "c++-header", str(begin), "-o", f"{begin}.gch"], check=True)
        precompiled = command + ["-include", str(begin)]
        of = lambda h: precompiled if h.relative_to(folder).as_posix() in eigen else command
        for header, code, output in pool.map(lambda h: compile_alone(of(h), folder, h), headers):
            if code != 0:
                failed += 1
                print(f"{header.relative_to(folder)} does not compile alone:\n{output[:3000]}")
    print(f"{len(headers)} headers compiled alone, {failed} failed")
    return 1 if failed or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
