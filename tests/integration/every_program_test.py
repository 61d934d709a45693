# SPDX-License-Identifier: MPL-2.0
"""What all programs have in common: every_program_test.py BIN"""

import re
import unittest

import programs


class EveryProgram(programs.InAFolder):
    def each(self):
        found = sorted(p.name for p in programs.BIN.glob("scifi-*"))
        self.assertIn("scifi-reconstruct", found)
        for name in found:
            with self.subTest(program=name):
                yield name

    def test_says_its_version(self):
        for name in self.each():
            done = self.run_program(name, "--version")
            self.assertEqual(done.returncode, 0)
            self.assertRegex(done.stdout, re.compile(r"^\d+\.\d+\.\d+$", re.MULTILINE))

    def test_explains_itself(self):
        for name in self.each():
            done = self.run_program(name, "--help")
            self.assertEqual(done.returncode, 0)
            self.assertIn("--help", done.stdout)

    def test_refuses_an_option_it_does_not_have(self):
        for name in self.each():
            done = self.run_program(name, "--no-such-option")
            self.assertEqual(done.returncode, 2)
            self.assertNotEqual(done.stderr, "")
            self.assertEqual(self.files(), [])


if __name__ == "__main__":
    programs.find("scifi-reconstruct")
    unittest.main()
