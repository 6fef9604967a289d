"""samara new: every template is a case that its own comments work on."""

import re
import sys
import unittest

from support.program import SOURCE, ProgramTest

KINDS = sorted(path.stem for path in (SOURCE / "templates").glob("*.yaml"))


class New(ProgramTest):
    def test_every_kind_is_a_case_on_which_its_comments_work(self):
        self.assertEqual(KINDS, ["beam", "rotor-in-air", "three-bladed", "two-bladed"])
        for kind in KINDS:
            with self.subTest(kind=kind):
                name = f"my-{kind}"
                run = self.succeed("new", kind, name)
                self.assertEqual(run.stdout, f"case: {name}.yaml\nnext: samara check {name}.yaml\n")
                text = (self.folder / f"{name}.yaml").read_text(encoding="utf-8")
                self.assertIn(f'title: "{name}"', text)
                self.assertNotIn("NAME", text)
                commands = re.findall(r"(?m)^#   samara (\w+ \S+(?: --sweep \S+)?)", text)
                self.assertGreaterEqual(len(commands), 3)
                for command in commands:
                    words = command.split()
                    if words[0] in ("operate", "campbell") and kind == "rotor-in-air":
                        words += ["--set", "operation.wind_speeds=[8, 16]", "--set", "blades.elements=2"]
                    elif words[0] == "campbell":
                        words[-1] = words[-1].split("=")[0] + "=6,8"
                    if words[0] == "campbell":  # tests/drivers/campbell.py searches bands
                        words += ["--bands", "0"]
                    self.succeed(*words)

    def test_the_rotor_in_air_runs_in_every_wind(self):
        """Stations beside the hub must not stall: their induced velocities would jump."""
        self.succeed("new", "rotor-in-air", "mine")
        for wind in (4, 5.1, 5.5, 9, 17):
            with self.subTest(wind=wind):
                run = self.succeed("transient", "mine.yaml", "--set", f"wind.speed={wind}", "--set",
                                   "transient={duration: 0.5, step: 0.02, start: trim}", "-o", "series.h5")
                self.assertEqual(run.stderr, "")

    def test_a_file_is_never_overwritten(self):
        self.write("mine.yaml", "mine")
        self.refuse("new", "beam", "mine", words="exists")
        self.refuse("new", "beam", "mine.yaml", words="exists")

    def test_wrong_arguments(self):
        for arguments, words in (([], "expected a kind and a name"), (["beam"], "expected a kind"),
                                 (["bea", "x"], "did you mean"), (["beam", "x", "y"], "expected"),
                                 (["boat", "x"], "the kinds are"), (["beam", "--force"], "--force"),
                                 (["beam", "none/x"], "none")):
            self.refuse("new", *arguments, words=words)
        text = self.succeed("new", "--help").stdout
        for kind in KINDS:
            self.assertIn(kind, text)


if __name__ == "__main__":
    sys.exit(unittest.main())
