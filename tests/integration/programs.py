# SPDX-License-Identifier: MPL-2.0
"""What the tests of programs from the outside share: where the programs are, a folder for each test, tables."""

import csv
import gzip
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
PAGE = "<html><script>@SCIFI_DATA@</script></html>"  # stands in for the real pages, which pages_test.py opens in a browser

BIN = None  # the folder of the programs


def find(*needed):
    """Takes the folder of the programs from the command line; ends the test as skipped where one that is needed was not built."""
    global BIN
    if len(sys.argv) < 2:
        sys.exit(sys.modules["__main__"].__doc__)
    BIN = pathlib.Path(sys.argv.pop(1)).resolve()
    for name in needed:
        if not os.access(BIN / name, os.X_OK):
            skip(f"no {BIN / name}")


def skip(why):
    print("skipped:", why)
    sys.exit(SKIPPED)


def rows(path):
    """The rows of a table, plain or gzip, as dictionaries."""
    with (gzip.open if str(path).endswith(".gz") else open)(path, "rt", newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def wait_for(condition, what, seconds=60):
    """Until the condition holds; an error that says what was waited for where that takes too long."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"waited too long for {what}")
        time.sleep(0.005)


class InAFolder(unittest.TestCase):
    """Each test has a folder of its own, in which the programs run."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="scifi_cli_")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def write(self, name, content):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def run_program(self, program, *arguments):
        return subprocess.run([BIN / program, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, errors="replace", timeout=300, check=False)

    def rows(self, name):
        return rows(self.folder / name)

    def files(self):
        return sorted(p.name for p in self.folder.iterdir())


class BesideItsPage(unittest.TestCase):
    """A copy of a program with a page beside it where it looks for one, in a folder that the tests share."""

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="scifi_cli_")
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name)

    @classmethod
    def install(cls, name, page):
        cls.program = cls.folder / "bin" / name
        cls.program.parent.mkdir()
        shutil.copy(BIN / name, cls.program)
        (cls.folder / "share/scifi").mkdir(parents=True)
        (cls.folder / "share/scifi" / page).write_text(PAGE, encoding="utf-8")

    @classmethod
    def make(cls, program, *arguments):
        """Runs a program that must succeed."""
        subprocess.run([BIN / program, *map(str, arguments)], cwd=cls.folder, check=True, capture_output=True, timeout=300)

    @classmethod
    def run_program(cls, *arguments):
        return subprocess.run([cls.program, *map(str, arguments)], cwd=cls.folder, capture_output=True, text=True, timeout=120, check=False)

    @classmethod
    def data_of(cls, name):
        """What the program put into the page."""
        text = (cls.folder / name).read_text(encoding="utf-8")
        before, after = PAGE.split("@SCIFI_DATA@")
        assert text.startswith(before) and text.endswith(after), "the page is not whole"
        return text[len(before):len(text) - len(after)]
