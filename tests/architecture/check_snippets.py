#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Checks that the C++ and JSON shown in the documents are those of the examples, which the tests compile, run or read.

Usage: check_snippets.py ROOT [--write]
A block is preceded by a line `<!-- snippet: FILE NAME -->`; in FILE the region stands between two lines `// [NAME]`. Without NAME it is the whole FILE.
With --write the documents are brought up to date instead.
"""

import pathlib
import re
import sys
import textwrap

BLOCK = re.compile(r"(?P<head>(?:<!-- snippet: (?P<file>\S+)(?: (?P<name>\S+))? -->\n)?)```(?P<language>cpp|json)\n(?P<code>.*?)^```$", re.M | re.S)


def region(path, name):
    """The lines between two marks, or the whole file; None unless there are exactly two."""
    if name is None:
        return path.read_text(encoding="utf-8")
    lines = path.read_text(encoding="utf-8").splitlines()
    marks = [i for i, line in enumerate(lines) if line.strip() == f"// [{name}]"]
    if len(marks) != 2:
        return None
    return textwrap.dedent("\n".join(lines[marks[0] + 1:marks[1]]) + "\n")


def main():
    root, write = pathlib.Path(sys.argv[1]), "--write" in sys.argv[2:]
    problems, blocks = [], 0

    def check(match):
        nonlocal blocks
        blocks += 1
        line = text.count("\n", 0, match.start()) + 1
        if not match["head"]:
            problems.append(f"{document}:{line}: code without a line `<!-- snippet: FILE NAME -->` before it")
            return match[0]
        source = root / match["file"]
        code = region(source, match["name"]) if source.exists() else None
        if code is None:
            problems.append(f"{document}:{line}: {match['file']} has no region [{match['name']}]")
            return match[0]
        if code != match["code"] and not write:
            problems.append(f"{document}:{line}: differs from region [{match['name']}] of {match['file']}")
        return f"{match['head']}```{match['language']}\n{code}```"

    for path in [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]:
        if not path.exists():
            continue
        document, text = path.relative_to(root), path.read_text(encoding="utf-8")
        updated = BLOCK.sub(check, text)
        if write and updated != text:
            path.write_text(updated, encoding="utf-8")
    print("\n".join(problems + [f"{blocks} blocks of code, {len(problems)} problems"]))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
