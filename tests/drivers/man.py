"""The man page, docs/samara.1, has all that the help texts say, and roff reads it without a warning."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import PROGRAM, SOURCE, ProgramTest  # noqa: E402

PAGE = SOURCE / "docs/samara.1"


def check(root):
    """scripts/man_page --check of a tree."""
    return subprocess.run([sys.executable, root / "scripts/man_page", "--check"], text=True, capture_output=True,
                          env=dict(os.environ, SAMARA=PROGRAM), check=False)


def plain(page):
    """Text of a page, one blank between words; independent of the script that writes it."""
    for name, character in (("\\-", "-"), ("\\(aq", "'"), ("\\(dq", '"'), ("\\(ti", "~"), ("\\(ha", "^"), ("\\&", ""),
                            ("\\%", ""), ("\\e", "\\")):
        page = page.replace(name, character)
    page = re.sub(r'(?m)^\.BI (\S+) " (.*)"$', r"\1 \2", page)
    page = re.sub(r"(?m)^\.(?:B|SS|SH) ", "", page)
    return " ".join(page.split())


class ManPage(ProgramTest):
    def tree(self, page):
        """A tree with the script and a page."""
        for folder in ("scripts", "docs"):
            (self.folder / folder).mkdir()
        shutil.copy(SOURCE / "scripts/man_page", self.folder / "scripts")
        (self.folder / "docs/samara.1").write_text(page, encoding="utf-8")
        return self.folder

    def test_page_is_what_the_help_texts_give(self):
        run = check(SOURCE)
        self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_a_page_that_differs_is_seen(self):
        page = PAGE.read_text(encoding="utf-8")
        changed = page.replace("\\-\\-sweep", "\\-\\-swep")
        self.assertTrue(page != changed)
        run = check(self.tree(changed))
        self.assertEqual(run.returncode, 1)
        self.assertIn("scripts/man_page", run.stderr)

    def test_each_command_and_option_is_in_it(self):
        page = plain(PAGE.read_text(encoding="utf-8"))
        text = self.succeed("--help").stdout
        commands = re.findall(r"(?m)^  (\w+) +\S", re.search(r"(?s)\ncommands\n(.*?)\n\n", text)[1])
        self.assertGreater(len(commands), 12)
        sections = {}
        for part in re.split(r"(?m)^\.SS samara ", PAGE.read_text(encoding="utf-8"))[1:]:
            name = part.split()[0]
            sections[name] = sections.get(name, "") + " " + plain(part.split("\n.SH ")[0])
        self.assertEqual(set(sections), set(commands))
        general = page.split(" OPTIONS ", 1)[1].split(" COMMANDS ")[0]
        own = re.findall(r"(?m)^  (--?\w[\w-]*)", text.split("\noptions\n")[1])
        self.assertGreater(len(own), 10)
        for option in own:
            self.assertRegex(general, rf"(?<!\S){option}(?![\w-])")
        for command in commands:
            shown = self.succeed(command, "--help").stdout
            further = re.findall(rf"samara ({command} --[\w -]+?) --help", " ".join(shown.split()))
            shown += "".join(self.succeed(*words.split(), "--help").stdout for words in further)
            for option in re.findall(r"(?<![\w-])--?[a-z][\w-]*", shown):
                self.assertRegex(general + sections[command], rf"(?<![\w-]){option}(?![\w-])", command)
        for line in self.succeed("--help-options").stdout.splitlines():
            if line.startswith("-"):
                self.assertIn(f" {line.split()[0]} ", page)
        codes = text.split("\nexit codes\n")[1].split("\n\n")[0]
        for line in codes.splitlines():
            self.assertIn(" ".join(line.split()), page)

    def test_roff_reads_it_without_a_warning(self):
        for command in (["man", "--warnings", "--local-file", PAGE], ["mandoc", "-Tlint", "-Wstyle", PAGE]):
            with self.subTest(command=command[0]):
                if shutil.which(command[0]) is None:
                    self.skipTest(f"no {command[0]}")
                run = subprocess.run(command, text=True, capture_output=True, check=False,
                                     env=dict(os.environ, LC_ALL="C.UTF-8", MANWIDTH="100"))
                said = run.stderr if command[0] == "man" else run.stdout + run.stderr
                self.assertEqual((run.returncode, said), (0, ""))


if __name__ == "__main__":
    sys.exit(unittest.main())
