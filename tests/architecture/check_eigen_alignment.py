#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Two translation units of one program, compiled with different vector flags: linked where they agree on Eigen's alignment, refused where not.

Usage: check_eigen_alignment.py SCRATCH COMPILER FLAGS...
"""

import pathlib
import platform
import subprocess
import sys

SYMBOL = "scifi_error_define_EIGEN_MAX_STATIC_ALIGN_BYTES_alike_in_all_translation_units"
SOURCES = pathlib.Path(__file__).parent / "eigen_alignment"


def program(scratch, compiler, library_flags, program_flags, link_flags=()):
    """(status of the linker, what it said, status of the program)"""
    for name, flags in (("library", library_flags), ("program", program_flags)):
        subprocess.run([*compiler, *flags, "-c", SOURCES / f"{name}.cpp", "-o", scratch / f"{name}.o"], check=True)
    link = subprocess.run([compiler[0], *link_flags, scratch / "library.o", scratch / "program.o", "-o", scratch / "both"],
                          capture_output=True, text=True)
    status = None if link.returncode else subprocess.run([scratch / "both"]).returncode
    return link.returncode, link.stderr, status


def main():
    scratch, compiler = pathlib.Path(sys.argv[1]), sys.argv[2:]
    scratch.mkdir(parents=True, exist_ok=True)
    if platform.machine() != "x86_64":
        print("skipped: the flags of this test are those of x86-64")
        return 77
    wide, alike = ["-mavx"], ["-DEIGEN_MAX_STATIC_ALIGN_BYTES=16"]
    failures = []

    for what, flags in (("no flags", ([], [])), ("the same flags", (wide, wide)), ("different flags, one alignment", (wide + alike, alike)),
                        ("link-time optimisation", (["-flto"], ["-flto"], ["-flto"]))):
        linked, said, ran = program(scratch, compiler, *flags)
        if linked or ran:
            failures.append(f"{what}: linker {linked}, program {ran}\n{said}")

    linked, said, _ = program(scratch, compiler, wide, [])
    if not linked:
        failures.append("different alignments: linked, and would have crashed")
    elif SYMBOL not in said:
        failures.append(f"different alignments: the linker does not say what to do\n{said}")

    print("\n".join(failures) or "alignments are told apart")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
