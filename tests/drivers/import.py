"""samara import: decks of OpenFAST and windIO as case files."""

import csv
import os
import pathlib
import re
import shutil
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import MINIMAL, SOURCE, ProgramTest  # noqa: E402

DECKS = SOURCE / "tests/decks/files"
THREE = DECKS / "three/Main.fst"
TEETER = DECKS / "teeter/Main.fst"
SECOND = DECKS / "windio/second.yaml"
REAL = os.environ.get("SAMARA_DECKS")


class Imports(ProgramTest):
    """What is written."""

    def test_the_case_can_be_checked(self):
        for arguments in (
            ("openfast", THREE),
            ("openfast", TEETER),
            ("openfast", DECKS / "three/Main_BeamDyn.fst"),
            ("windio", SECOND, "--tower-only"),
            ("windio", DECKS / "windio/first.yaml"),
        ):
            with self.subTest(deck=arguments[1].name):
                run = self.succeed("import", *arguments, "-o", "case.yaml")
                self.assertEqual(run.stderr, "")
                self.assertIn("case: case.yaml", run.stdout)
                self.assertIn("blade", self.succeed("check", "case.yaml").stdout)

    def test_the_report_has_three_parts(self):
        run = self.succeed("import", "openfast", THREE, "-o", "case.yaml")
        parts = re.findall(r"^(taken|derived|ignored): ", run.stdout, re.MULTILINE)
        self.assertEqual(parts, ["taken", "derived", "ignored"])
        self.assertRegex(run.stdout, r"ElastoDyn\.dat:\d+ +OverHang +shaft\.overhang")
        self.assertRegex(run.stdout, r"YawDOF +.*locked")

    def test_report_only(self):
        run = self.succeed("import", "openfast", THREE, "--report")
        self.assertIn("derived", run.stdout)
        self.assertEqual(self.files(), {})
        with_case = self.succeed("import", "openfast", THREE, "--report", "-o", "case.yaml")
        self.assertTrue(with_case.stdout.startswith(run.stdout))

    def test_the_case_is_commented(self):
        self.succeed("import", "openfast", THREE, "-o", "case.yaml")
        text = (self.folder / "case.yaml").read_text(encoding="utf-8")
        for words in ("# Imported by samara from OpenFAST", "# m; OverHang", "docs/case_file.md"):
            self.assertIn(words, text)

    def test_a_case_is_overwritten(self):
        self.write("case.yaml", MINIMAL)
        self.succeed("import", "openfast", THREE, "-o", "case.yaml")
        self.assertIn(b"OverHang", self.files()["case.yaml"])

    def test_two_ranks_write_one_case(self):
        run = self.succeed("import", "openfast", THREE, "-o", "case.yaml", ranks=2)
        self.assertEqual(run.stdout.count("case: case.yaml"), 1)

    def test_help(self):
        run = self.succeed("import", "--help")
        for words in ("openfast|windio", "--tower-only", "--report"):
            self.assertIn(words, run.stdout)


class Refusals(ProgramTest):
    """What the user can mend."""

    def test_monopile(self):
        run = self.samara("import", "windio", SECOND, "-o", "case.yaml")
        self.assertEqual(run.returncode, 2)
        self.assertIn("implausible", run.stderr)
        self.assertIn("--tower-only", run.stderr)
        self.assertEqual(self.files(), {})

    def test_file_of_the_user(self):
        for content in ("my notes\n", "a: 1\n", b"\x00\x01"):
            self.write("notes", content)
            self.refuse("import", "openfast", THREE, "-o", "notes", words="it would be lost")

    def test_paths(self):
        self.refuse("import", "openfast", THREE, "-o", "no/case.yaml", words="no folder no")
        self.refuse("import", "openfast", "no.fst", "-o", "case.yaml", words="no such file")
        self.refuse("import", "windio", "no.yaml", "-o", "case.yaml", words="no such file")

    def test_broken_deck(self):
        for file in (DECKS / "three").iterdir():
            shutil.copy(file, self.folder)
        text = (self.folder / "ElastoDyn.dat").read_text(encoding="utf-8")
        self.write("ElastoDyn.dat", text.replace("       -3.2   OverHang", "       -3.z   OverHang"))
        self.refuse("import", "openfast", "Main.fst", "-o", "case.yaml",
                    words=["OverHang", "a number"], place=r"samara: ElastoDyn\.dat:\d+: ")

    def test_command_line(self):
        self.refuse("import", words="missing format")
        self.refuse("import", "openfast", words="missing deck")
        self.refuse("import", "openfst", THREE, words='did you mean "openfast"?')
        self.refuse("import", "bladed", THREE, words="the formats are openfast, windio")
        self.refuse("import", "openfast", THREE, words=["missing -o", "--report"])
        self.refuse("import", "openfast", THREE, "-o", "a.yaml", "--set", "gravity=0",
                    words="--set")
        self.refuse("import", "openfast", THREE, "-o", "a.yaml", "-ksp_view", words="-ksp_view")
        self.refuse("check", THREE, "--tower-only", words="--tower-only")


@unittest.skipUnless(REAL, "SAMARA_DECKS does not name a folder of real decks")
class RealDecks(ProgramTest):
    """Decks that are not part of the project."""

    def decks(self, suffix):
        found = sorted(pathlib.Path(REAL).rglob(f"*{suffix}"))
        if not found:
            self.skipTest(f"no *{suffix} below SAMARA_DECKS")
        return found

    def import_openfast(self, deck, case):
        self.succeed("import", "openfast", deck, "--tower-only", "-o", case)

    def test_all_import_without_a_hand_edit(self):
        for deck in self.decks(".fst"):
            with self.subTest(deck=deck.name):
                self.import_openfast(deck, "case.yaml")
                run = self.samara("check", "case.yaml")
                if "reference_line is not available" not in run.stderr:
                    self.assertEqual(run.returncode, 0, run.stderr)
        for deck in self.decks(".yaml"):
            if "components:" not in deck.read_text(encoding="utf-8"):
                continue
            with self.subTest(deck=deck.name):
                self.succeed("import", "windio", deck, "--tower-only", "-o", "case.yaml")

    def five_megawatts(self, switch):
        """A copy of the NREL 5 MW deck with blades of ElastoDyn (1) or BeamDyn (2)."""
        for deck in self.decks(".fst"):
            text = deck.read_text(encoding="utf-8")
            if "NREL 5.0 MW" in text and re.search(rf"^\s*{switch}\s+CompElast", text, re.MULTILINE):
                shutil.copytree(deck.parent, self.folder / f"deck{switch}")
                for folder, _, files in os.walk(self.folder / f"deck{switch}"):
                    for file in files:
                        os.chmod(pathlib.Path(folder) / file, 0o644)
                    os.chmod(folder, 0o755)
                return self.folder / f"deck{switch}" / deck.name
        return self.skipTest("no NREL 5 MW deck below SAMARA_DECKS")

    def test_masses_of_the_5_mw_turbine(self):
        # Jonkman et al., NREL/TP-500-38060: tower 347460, hub 56780, nacelle 240000 kg. The blade
        # has 17740 kg; its deck 17609, for the factor in it is meant for ElastoDyn's coarse sum.
        self.import_openfast(self.five_megawatts(1), "case.yaml")
        text = self.succeed("check", "case.yaml").stdout
        for part, mass, tolerance in (("tower", 347460, 1e-4), ("nacelle", 240000, 1e-6),
                                      ("hub", 56780, 1e-6), ("each blade", 17740, 1e-2)):
            found = float(re.search(rf"^{part} +(\S+)", text, re.MULTILINE).group(1))
            self.assertLess(abs(found / mass - 1), tolerance, part)

    def test_frequencies_of_the_5_mw_turbine(self):
        # NREL/TP-500-38060, table 9-1 (FAST, ADAMS), parked. There the shaft twists and yaw is
        # elastic, so only modes that these do not enter are compared.
        self.import_openfast(self.five_megawatts(1), "case.yaml")
        self.succeed("modes", "case.yaml", "--set", "shaft.speed_rpm=0", "--csv", "modes.csv")
        with open(self.folder / "modes.csv", encoding="utf-8") as file:
            rows = [(float(row["frequency_hz"]), row["label"]) for row in csv.DictReader(file)]
        for label, published in (("tower lateral", 0.3120), ("tower fore-aft", 0.3195),
                                 ("blade flap", 0.6675), ("blade lead-lag", 1.0793)):
            found = [f for f, name in rows if f > 0 and name.startswith(label)]
            nearest = min(found, key=lambda f: abs(f - published))
            self.assertLess(abs(nearest / published - 1), 0.03, label)

    def frequencies(self, blade):
        """First two flap and first edge frequency of a clamped blade [Hz]."""
        self.write("blade.yaml", blade)
        self.succeed("modes", "blade.yaml", "--csv", "blade.csv",
                     *(word for key in ("blades.count=1", "blades.precone_deg=0", "gravity=0")
                       for word in ("--set", key)))
        with open(self.folder / "blade.csv", encoding="utf-8") as file:
            header = file.readline().strip().split(",")
            rows = [dict(zip(header, row)) for row in csv.reader(file)]
        os.remove(self.folder / "blade.csv")
        moving = sorted((float(row["frequency_hz"]), row["label"]) for row in rows
                        if float(row["frequency_hz"]) > 0)
        flap = [f for f, label in moving if "flap" in label]
        edge = [f for f, label in moving if "lead-lag" in label]
        return flap[0], flap[1], edge[0]

    def test_elastodyn_and_beamdyn_agree(self):
        deck = self.five_megawatts(1)
        for file in deck.parent.rglob("*Blade.dat"):
            text = file.read_text(encoding="utf-8")
            file.write_text(re.sub(r"^\s*\S+(\s+AdjBlMs)", r"1.0\1", text, flags=re.MULTILINE),
                            encoding="utf-8")
        cases = []
        for number, path in ((1, deck), (2, self.five_megawatts(2))):
            self.import_openfast(path, f"case{number}.yaml")
            text = (self.folder / f"case{number}.yaml").read_text(encoding="utf-8")
            cases.append("samara: 1\n" + text[text.index("blades:"):])
        # ElastoDyn's blades have no shear; the shear stiffness of the BeamDyn deck, a tenth of EA,
        # alone lowers the second flap and the first edge mode by 2.7 %.
        stiff = re.sub(r"GA2: [^,]+, GA3: [^,]+,", "GA2: rigid, GA3: rigid,", cases[1])
        for blade, tolerance in ((stiff, 0.02), (cases[1], 0.03)):
            for a, b in zip(self.frequencies(cases[0]), self.frequencies(blade)):
                self.assertLess(abs(a / b - 1), tolerance)


unittest.main()
