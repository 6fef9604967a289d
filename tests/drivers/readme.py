"""The table in README.md is what the program prints."""

import re
import sys
import unittest

from support.program import SOURCE, ProgramTest


class Readme(ProgramTest):
    def test_first_command_prints_its_table(self):
        text = (SOURCE / "README.md").read_text(encoding="utf-8")
        rows = re.findall(r"(?m)^ *\d+  (?:\d\w\w )?(?:yaw|tower|blade|teeter)\b.*$", text)
        self.assertGreater(len(rows), 5)
        printed = self.succeed("floquet", str(SOURCE / "inputs/lee2002/baseline.yaml")).stdout
        found = [line.split() for line in printed.splitlines()]
        for row in rows:
            self.assertTrue(any(self.alike(row.split(), words) for words in found), row)

    def alike(self, row, words):
        """Equal, but that the last of two digits of a share may be rounded otherwise."""
        if len(row) != len(words):
            return False
        shares = re.compile(r"\d{1,2}")
        return all(a == b or (shares.fullmatch(a) and shares.fullmatch(b) and place > 5
                              and abs(int(a) - int(b)) < 2)
                   for place, (a, b) in enumerate(zip(row, words)))


if __name__ == "__main__":
    sys.exit(unittest.main())
