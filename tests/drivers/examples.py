"""The pages of docs/examples: their commands are understood, their links lead somewhere, scripts/examples finds the figures of
the cheapest page again, and the quick commands of the other pages give their figures. (scripts/examples --check, which runs for ten
minutes, does so for all commands and figures.)"""

import importlib.machinery
import importlib.util
import json
import math
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

    def run_some(self, name, is_chosen):
        """A page whose chosen commands were run in the folder of the test, and its script."""
        script = load_script()
        page = script.KINDS[name](PROGRAM)
        page.folder = self.folder
        (self.folder / "inputs").symlink_to(SOURCE / "inputs")
        chosen = [words for words in script.list_commands(page) if is_chosen(words)]
        for words in chosen:
            self.succeed(*words)
        return script, page, chosen

    def cells(self, page, block):
        """Rows of a table of a page, by their first cell."""
        text = re.search(f"<!-- begin {block} -->\n(.*?)<!-- end", page.text, re.S)[1]
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()[2:]]
        return {row[0]: row[1:] for row in rows}

    def near(self, script, text, value):
        self.assertTrue(script.agrees(text, value, script.BLOCK_TOLERANCE), (text, value))

    def test_quick_figures_of_two_blades(self):
        """The sweep with its edges and its picture, the averaged model at three speeds, and exponents at four."""
        few = ("220", "280", "400")
        script, page, chosen = self.run_some("two_blades", lambda words: words[0] == "floquet" or words[-1] in (
            "two.h5", "two_blades_campbell.svg", "multiblade.h5", *(f"averaged_{rpm}.h5" for rpm in few)))
        self.assertEqual(len(chosen), 1 + 1 + 1 + 3 + 5)
        two = script.Diagram(self.folder / "two.h5")
        page.statements = lambda: [
            ("between {} and {} rpm and between {} and {} rpm", *two.edges.flatten()),
            ("has the largest growth {} 1/s, Floquet's theory", page.averaged(self.folder / "multiblade.h5", "multiblade_average").real.max())]
        found = [fault for fault in page.faults_of_text() if not fault.startswith(("no statement", "missing"))]
        self.assertEqual(found, [])
        picture = "two_blades_campbell.svg"
        self.assertEqual(script.words_of(self.folder / picture), script.words_of(PAGES / picture))
        growth = self.cells(page, "growth")
        for rpm in few:
            self.near(script, growth[rpm][0], two.growth[two.line("blade lag hinge antisymmetric"), two.at(int(rpm))])
            self.near(script, growth[rpm][1], page.averaged(self.folder / f"averaged_{rpm}.h5").real.max())
        for rpm, cells in self.cells(page, "series").items():
            self.near(script, cells[0], page.antisymmetric(rpm))

    def test_quick_figures_of_nrel5mw(self):
        """Damping without the air, and two of the operating points."""
        script, page, chosen = self.run_some("nrel5mw", lambda words: words[-1].startswith("none_"))
        self.assertEqual(len(chosen), 2)
        damping = self.cells(page, "damping")
        self.assertEqual(len(damping), len(page.MODES))
        for column, wind in ((2, 8), (5, 18)):
            without = page.modes(f"none_{wind}")
            for mode, cells in damping.items():
                self.near(script, cells[column], without[mode][0])
        operate = next(words for words in script.list_commands(page) if words[0] == "operate")
        self.succeed(*[re.sub(r"wind_speeds=.*", "wind_speeds=[8, 18]", word) for word in operate])
        rows = script.read_csv(self.folder / "points.csv")
        self.assertEqual(len(rows), 2)
        points = self.cells(page, "points")
        for row in rows:
            cells = points[f"{float(row['wind_speed']):g}"]
            for cell, value in zip(cells, (float(row["rotor_speed"]) * 30 / math.pi, math.degrees(float(row["pitch"])),
                                           float(row["power"]) / 1e6, float(row["thrust"]) / 1e3)):
                self.near(script, cell, value)
            self.assertEqual(cells[-1], row["region"])


if __name__ == "__main__":
    unittest.main()
