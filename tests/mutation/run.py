#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Breaks the library in small ways, one at a time, and shows that its unit tests notice each.

Usage: tests/mutation/run.py --check        # what is to be broken stands where the list says
       tests/mutation/run.py [--compiler g++] [--eigen /usr/include/eigen3] [--jobs 2] [--only TEXT] [--write docs/testing.md]

A mutation is judged by the unit test of its header and, where that does not notice, by those of its folder. It counts as noticed when a test does not
compile or fails. Exit status 0: the tests pass as they are and notice every mutation.
"""

import argparse
import concurrent.futures
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from mutations import MUTATIONS

ROOT = pathlib.Path(__file__).resolve().parents[2]
BEGIN, END = "<!-- mutations: begin -->", "<!-- mutations: end -->"


def tests_of(header):
    """The header's own unit tests first, then the rest of its folder."""
    folder, name = header.split("/")
    own = ROOT / "tests/unit" / folder / name.replace(".hpp", "_test.cpp")
    rest = sorted(set((ROOT / "tests/unit" / folder).glob("*_test.cpp")) - {own})
    return ([own] if own.exists() else []) + rest


def fails(options, include, source, scratch):
    """True where a test, compiled against `include`, does not compile or does not pass."""
    program = scratch / source.stem
    shared = [source.parent / f"{name}.cpp" for name in re.findall(r'^#include "(?:unit/\w+/)?(\w+)\.hpp"', source.read_text(encoding="utf-8"), re.MULTILINE)]
    command = [options.compiler, "-std=c++20", "-O1", "-I", include, "-I", ROOT / "tests", "-isystem", options.eigen,
               f'-DSCIFI_TEST_REFERENCE="{ROOT}/tests/reference"', '-DSCIFI_SHARED_DATA_DEFAULT=""',
               source, *(s for s in shared if s.exists()), options.main, "-o", program, "-lz", "-lpthread", *(["-lsqlite3"] if source.parent.name == "conditions" else [])]
    if subprocess.run(command, capture_output=True).returncode:
        return True
    try:
        return subprocess.run([program], capture_output=True, cwd=scratch, timeout=120).returncode not in (0, 77)
    except subprocess.TimeoutExpired:
        return True


KNOWN = {}  # test -> whether it fails as it is


def fails_as_it_is(options, source, scratch):
    if source not in KNOWN:
        KNOWN[source] = fails(options, ROOT / "include", source, scratch)
    return KNOWN[source]


def judge(options, mutation):
    header, before, after = mutation
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        include = scratch / "include"
        shutil.copytree(ROOT / "include", include)
        if standing(header, before) != 1:
            return mutation, None, f"stands there {standing(header, before)} times, not once"
        broken = include / "scifi" / header
        broken.write_text(broken.read_text(encoding="utf-8").replace(before, after), encoding="utf-8")
        for source in tests_of(header):
            if fails(options, include, source, scratch):
                # A test that fails without the mutation too notices nothing.
                if fails_as_it_is(options, source, scratch):
                    return mutation, None, f"{source.name} fails as it is"
                return mutation, True, source.name
    return mutation, False, "not noticed"


def standing(header, before):
    return (ROOT / "include/scifi" / header).read_text(encoding="utf-8").count(before)


def check():
    wrong = [f"{header}: {before}: stands there {standing(header, before)} times, not once" for header, before, _ in MUTATIONS if standing(header, before) != 1]
    print("\n".join(wrong))
    print(f"{len(MUTATIONS)} mutations, {len(wrong)} cannot be made")
    return 1 if wrong else 0


def write_table(page, results):
    rows = [f"| `{header}` | `{before.strip()}` | `{after.strip()}` | {said} |" for (header, before, after), _, said in results]
    noticed = sum(bool(found) for _, found, _ in results)
    table = "\n".join([BEGIN, f"{noticed} of {len(results)} are noticed.", "", "| header | instead of | stands | noticed by |",
                       "| --- | --- | --- | --- |", *(row.replace("||", "\\|\\|") for row in rows), END])
    text = page.read_text(encoding="utf-8")
    first, last = text.index(BEGIN), text.index(END) + len(END)
    page.write_text(text[:first] + table + text[last:], encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--eigen", default="/usr/include/eigen3")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="mutations of headers that contain this")
    parser.add_argument("--write", type=pathlib.Path, help="page whose table of mutations is replaced")
    parser.add_argument("--check", action="store_true", help="only look whether each mutation can be made")
    options = parser.parse_args()
    if options.check:
        return check()
    chosen = [m for m in MUTATIONS if options.only in m[0]]

    with tempfile.TemporaryDirectory() as folder:
        options.main = pathlib.Path(folder) / "main.o"
        subprocess.run([options.compiler, "-std=c++20", '-DSCIFI_SHARED_DATA_DEFAULT=""', "-c", ROOT / "tests/support/main.cpp",
                        "-I", ROOT / "tests", "-o", options.main], check=True)
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            results = []
            for result in pool.map(lambda m: judge(options, m), chosen):
                (header, before, after), found, said = result
                print(f"{'noticed' if found else 'WRONG  '}  {header}: {before} -> {after}: {said}", flush=True)
                results.append(result)
    if options.write:
        write_table(options.write, results)
    missed = [r for r in results if not r[1]]
    print(f"{len(results) - len(missed)} of {len(results)} mutations are noticed")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
