"""The pages of docs/examples: their commands are understood, their links lead somewhere, and scripts/examples finds the figures
of the cheapest page again. (scripts/examples --check, which runs for ten minutes, does so for all pages.)"""

import importlib.machinery
import importlib.util
import json
import pathlib
import re
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import PROGRAM, SOURCE, ProgramTest  # noqa: E402

SCRIPT = SOURCE / "scripts/examples"
PAGES = SOURCE / "docs/examples"
CHEAPEST = "tower_stiffness"
HAVE_CASES = {"check", "floquet", "campbell", "transient", "linearize", "operate"}
HAVE_VALUES = {"--set", "-o", "--csv", "--first", "--sensitivity", "--sweep", "--frame"}


def load_script():
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("examples_script", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def slugs_of(text):
    """Anchors of the headings, as GitHub makes them."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    words = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"[`*]", "", heading.lower())).replace(" ", "-") for heading in words}


class Examples(ProgramTest):
    def script(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, "--program", PROGRAM, *map(str, arguments)], capture_output=True,
                              text=True, check=False)

    def test_the_program_understands_the_commands(self):
        run = self.script("--list")
        self.assertEqual(run.returncode, 0, run.stderr)
        calls = [json.loads(line) for line in run.stdout.splitlines()]
        self.assertEqual({call[0] for call in calls}, {path.stem for path in PAGES.glob("*.md")})
        helps, written, checked = {}, {}, set()
        for page, command, *words in calls:
            if command not in helps:
                helps[command] = self.succeed(command, "--help").stdout
            options, files, sets = [], [], []
            while words:
                word = words.pop(0)
                if not word.startswith("-"):
                    files.append(word)
                    continue
                options.append(word)
                value = words.pop(0) if word in HAVE_VALUES else None
                if word == "--set":
                    sets += ["--set", value]
                elif word == "--sweep":
                    key, _, values = value.partition("=")
                    sets += ["--set", f"{key}={re.split('[:,]', values)[0]}"]
                elif word in ("-o", "--csv"):
                    self.assertNotIn(value, written.setdefault(page, set()), f"{page}: written twice")
                    written[page].add(value)
            for option in options:
                self.assertRegex(helps[command], rf"(?<![\w-]){option}(?![\w-])", f"{page}: samara {command}")
            if command == "plot":
                self.assertIn(files[0], written[page], page)
                self.assertIn(files[1], helps[command], page)
                continue
            self.assertIn(command, HAVE_CASES, page)
            self.assertEqual(len(files), 1, files)
            if (files[0], *sets) not in checked:
                checked.add((files[0], *sets))
                self.succeed("check", SOURCE / files[0], *sets)
        self.assertGreater(len(checked), 20)

    def test_no_link_is_dead(self):
        count = 0
        for page in sorted(PAGES.glob("*.md")):
            for url in re.findall(r"\]\(([^)]*)\)", page.read_text(encoding="utf-8")):
                path, _, anchor = url.partition("#")
                target = page.parent / path if path else page
                self.assertTrue(target.exists(), f"{page.name}: {url}")
                if anchor:
                    self.assertIn(anchor, slugs_of(target.read_text(encoding="utf-8")), f"{page.name}: {url}")
                count += 1
        self.assertGreater(count, 12)

    def test_figures_of_the_cheapest_page(self):
        before = {path: path.read_bytes() for path in PAGES.iterdir()}
        run = self.script("--check", CHEAPEST, "--keep", self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual({path: path.read_bytes() for path in PAGES.iterdir()}, before, "the check writes")

        script = load_script()

        def faults(old, new):
            page = script.KINDS[CHEAPEST](PROGRAM)
            self.assertIn(old, page.text)
            page.text = page.text.replace(old, new, 1)
            page.folder = self.folder / CHEAPEST
            return page.finish(check=True)

        self.assertEqual(faults("Question", "Question"), [])
        for old, new, words in (
                ("a factor of 9.73", "a factor of 9.74", "9.74 is 9.72"),
                ("a factor of 9.73;", "a factor of ten;", "stands 0 times"),
                ("**Question.**", "**Question.** 42", "no statement of the script has the figure 42"),
                ("| 1.557 |", "| 1.559 |", "the table 'sweep' differs"),
                ("](tower_stiffness.svg)", "](another.svg)", "draws another.svg")):
            found = faults(old, new)
            self.assertTrue(any(words in fault for fault in found), (new, found))


if __name__ == "__main__":
    unittest.main()
