#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Checks the rules of the source tree: arrows of inclusion, length, licence line, a test for each header, nothing unbuilt.

Usage: check_layers.py ROOT [REGISTERED]
REGISTERED lists the sources CMake has taken up, one a line; without it that check is left out.
"""

import pathlib
import re
import sys

CORE = {"core"}
FIT = CORE | {"kalman", "material"}
NOUNS = FIT | {"field", "geometry", "track_model", "event"}
ARROWS = ["particle_to_hit", "hit_to_digit", "readout_to_digit", "digit_to_cluster", "cluster_to_space_point",
          "space_point_to_candidate", "candidate_to_track"]

# folder under include/scifi -> the other folders it may include
ALLOWED = {
    "core": set(),
    "kalman": CORE,
    "material": CORE,
    "field": CORE,
    "arc": CORE,
    "geometry": CORE | {"material"},
    "track_model": FIT | {"field"},
    "event": CORE | {"geometry", "kalman"},
    **{arrow: NOUNS for arrow in ARROWS},
    "space_point_to_candidate": NOUNS | {"arc"},
    "chain": NOUNS | set(ARROWS),
    "information": NOUNS | {"candidate_to_track"},
    "alignment": NOUNS | {"candidate_to_track"},
    "io": NOUNS | set(ARROWS) | {"chain"},
    "conditions": NOUNS | {"io"},
    "study": NOUNS | set(ARROWS) | {"chain", "information"},
}
# headers directly in include/scifi
UMBRELLAS = {
    "kalman.hpp": CORE | {"kalman"},
    "scifi.hpp": NOUNS | set(ARROWS) | {"chain", "information"},
    "version.hpp": set(),
}
# third-party headers, by folder; everywhere else Eigen is the only one
EIGEN = ("Eigen/", "unsupported/Eigen/")
THIRD_PARTY = {"io": EIGEN + ("nlohmann/", "zlib.h", "fcntl.h", "sys/file.h", "sys/stat.h", "unistd.h"),
               "conditions": EIGEN + ("sqlite3.h",),
               "study": EIGEN + ("boost/histogram/",)}
# headers of the standard library with a slash or a suffix in their name
STANDARD = ("immintrin.h",)

# where exceptions and run-time types may be used; elsewhere a wrong configuration goes through core/refuse.hpp, which compiles without them
WITH_EXCEPTIONS = {"io", "conditions", "study"}
EXCEPTION = re.compile(r"\b(throw|try|catch|dynamic_cast|typeid)\b")

LONGEST_HEADER = 250
SPDX = "SPDX-License-Identifier: MPL-2.0"
SPDX_SUFFIXES = {".hpp", ".cpp", ".py", ".cmake", ".in", ".txt", ".sh", ".md"}

# header -> why it has no unit test of its own
WITHOUT_TEST = {
    "core/one_alignment.hpp": "check_eigen_alignment.py links with it",
    "core/constants.hpp": "data; every physics test leans on it",
    "event/candidate.hpp": "data without behaviour",
    "event/cluster.hpp": "data without behaviour",
    "event/digit.hpp": "data without behaviour",
    "event/space_point.hpp": "data without behaviour",
    "event/track.hpp": "data without behaviour",
    "track_model/q_over_pz_prior.hpp": "data without behaviour",
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found.group(1), found.group(2)


def folder_of(name):
    """First folder of a path below include/scifi, or None for a header that lies in no folder."""
    return name.split("/")[0] if "/" in name else None


def check_header(headers, name, path, problem):
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    if len(lines) > LONGEST_HEADER:
        problem(path, 1, f"{len(lines)} lines, more than {LONGEST_HEADER}: one idea a header")
    if "#pragma once" not in lines:
        problem(path, 1, "has no #pragma once")
    folder = folder_of(name)
    if folder not in WITH_EXCEPTIONS and name != "core/refuse.hpp":
        for number, line in enumerate(lines, 1):
            if EXCEPTION.search(re.sub(r'"(\\.|[^"\\])*"', "", line.split("//")[0])):
                problem(path, number, "uses exceptions or run-time types: detail::refuse compiles without them")
    if folder is not None and folder not in ALLOWED:
        problem(path, 1, f"folder {folder} is not in the table of layers")
        return
    if folder is None and name not in UMBRELLAS:
        problem(path, 1, "lies in no folder and is no umbrella header of the table")
        return
    allowed = UMBRELLAS[name] if folder is None else ALLOWED[folder] | {folder}
    third_party = THIRD_PARTY.get(folder, EIGEN)
    for number, bracket, target in includes(path):
        if bracket == '"' or ".." in target.split("/"):
            problem(path, number, f'includes "{target}": write <scifi/...>')
        elif target.startswith("scifi/"):
            to = target.removeprefix("scifi/")
            if to not in headers:
                problem(path, number, f"includes <{target}>, which does not exist")
            elif folder_of(to) is None and folder is not None:
                problem(path, number, f"includes the umbrella <{target}>")
            elif folder_of(to) is not None and folder_of(to) not in allowed:
                problem(path, number, f"{folder or name} must not include {folder_of(to)} (<{target}>)")
        elif not target.startswith(third_party) and target not in STANDARD and ("/" in target or "." in target):
            problem(path, number, f"includes <{target}>, neither standard nor allowed in {folder or name}")


def check_cycles(headers, problem):
    arrows = {name: [t.removeprefix("scifi/") for _, _, t in includes(path) if t.startswith("scifi/")]
              for name, path in headers.items()}
    done, trail = set(), []

    def visit(name):
        if name in trail:
            loop = trail[trail.index(name):] + [name]
            problem(headers[name], 1, "includes itself: " + " -> ".join(loop))
            return
        if name in done or name not in arrows:
            return
        trail.append(name)
        for target in arrows[name]:
            visit(target)
        trail.pop()
        done.add(name)

    for name in sorted(arrows):
        visit(name)


def check_tests_exist(root, headers, problem):
    for name, path in headers.items():
        if folder_of(name) is None:
            continue
        test = root / "tests" / "unit" / name.replace(".hpp", "_test.cpp")
        if name in WITHOUT_TEST:
            if test.exists():
                problem(path, 1, "has a test: take it off the list WITHOUT_TEST")
        elif not test.exists():
            problem(path, 1, f"has no {test.relative_to(root)}")
    for name in WITHOUT_TEST:
        if name not in headers:
            problem(root / "tests/architecture/check_layers.py", 1, f"WITHOUT_TEST names {name}, which does not exist")


def check_registered(root, registered, problem):
    built = {pathlib.Path(line).resolve() for line in registered.read_text(encoding="utf-8").split("\n") if line}
    files = [path for folder in ("tests", "examples", "bench") for path in (root / folder).rglob("*.cpp")]
    for path in sorted(files + list((root / "tests").rglob("*_test.py"))):
        if path.resolve() not in built:
            problem(path, 1, "nothing builds or runs it: it lies where no glob looks")


def check_licence(root, problem):
    files = [p for folder in ("include", "tests", "examples", "bench", "cmake", "scripts", "docs", ".ci")
             for p in (root / folder).rglob("*") if p.is_file()]
    files += [root / name for name in ("CMakeLists.txt", "README.md", "CONTRIBUTING.md") if (root / name).exists()]
    for path in files:
        if path.suffix == ".pyc" or (path.suffix not in SPDX_SUFFIXES and not is_script(path)):
            continue
        if "reference" in path.parts and path.suffix == ".txt":
            continue
        head = path.read_text(encoding="utf-8").split("\n", 2)[:2]
        if not any(SPDX in line for line in head):
            problem(path, 1, f"does not begin with {SPDX}")


def is_script(path):
    with path.open("rb") as stream:
        return stream.read(2) == b"#!"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    found = []

    def problem(path, line, what):
        found.append(f"{path.relative_to(root)}:{line}: {what}")

    base = root / "include" / "scifi"
    headers = {p.relative_to(base).as_posix(): p for p in sorted(base.rglob("*.hpp"))}
    for name, path in headers.items():
        check_header(headers, name, path, problem)
    check_cycles(headers, problem)
    check_tests_exist(root, headers, problem)
    check_licence(root, problem)
    if len(sys.argv) > 2:
        check_registered(root, pathlib.Path(sys.argv[2]), problem)
    print("\n".join(found + [f"{len(headers)} headers, {len(found)} problems"]))
    return 1 if found or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
