"""samara import: decks of OpenFAST, windIO and HAWC2 as case files."""

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
    """Written cases and reports."""

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
                self.assertNotIn("error", run.stderr)
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
        for words in ("openfast|windio|hawc2", "--tower-only", "--report"):
            self.assertIn(words, run.stdout)


class Irregular(ProgramTest):
    """Decks as people have them."""

    def copy(self, name="three"):
        for file in (DECKS / name).iterdir():
            shutil.copy(file, self.folder)

    def edit(self, name, *changes):
        text = (self.folder / name).read_text(encoding="utf-8")
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write(name, text)

    def case(self, *options, deck="Main.fst"):
        kind = {".fst": "openfast", ".htc": "hawc2"}.get(deck[-4:], "windio")
        run = self.succeed("import", kind, deck, "-o", "case.yaml", *options)
        return (self.folder / "case.yaml").read_text(encoding="utf-8"), run.stderr

    def test_one_station_is_a_uniform_beam(self):
        self.copy()
        rows = (self.folder / "Tower.dat").read_text(encoding="utf-8").splitlines(True)
        first = next(i for i, row in enumerate(rows) if row.startswith("0.0000000E+00"))
        self.write("Tower.dat", "".join(rows[: first + 1] + rows[first + 4 :]))
        self.edit("Tower.dat", ("4   NTwInpSt", "1   NTwInpSt"))
        text, _ = self.case()
        tower = text[text.index("\ntower:") : text.index("\nnacelle:")]
        self.assertEqual(tower.count("\n    - "), 1)
        self.succeed("modes", "case.yaml", "--parked")

    def test_names_of_keys_do_not_matter_between_their_neighbours(self):
        self.copy()
        expected, _ = self.case()
        self.edit("Tower.dat", ("NTwInpSt    -", "NTwInptSt   -"),
                  ("TwrSSDmp(1) - ", "TwrSideDamping(1) "), ("AdjFASt     -", "stiffer     -"))
        self.edit("Blade.dat", ("NBlInpSt    - ", "NBlInpSt      "),
                  ("BldFlDmp(2) - ", "BldFlDmp(2)   "), ("AdjBlMs     -", "           -"))
        self.assertEqual(self.case()[0], expected)
        self.edit("Tower.dat", ("AdjTwMa     -", "heavier     -"), ("AdjSSSt", "     "))
        case, said = self.case()
        self.assertEqual(case, expected)
        self.assertIn("heavier: note: read as adjtwma", said)

    def test_older_name_of_the_damping_switch(self):
        self.copy()
        expected, _ = self.case(deck="Main_BeamDyn.fst")
        self.edit("BeamDyn_Blade.dat", ("damp_type", "damp_flag"))
        self.assertEqual(self.case(deck="Main_BeamDyn.fst")[0], expected)

    def test_round_off_in_key_points_and_matrices(self):
        self.copy()
        expected, _ = self.case(deck="Main_BeamDyn.fst")
        self.edit("BeamDyn.dat", ("0.0000000E+00  0.0000000E+00  0.0000000E+00  1.25",
                                  "0.0000000E+00  0.0000000E+00  -8.07793567E-28  1.25"))
        self.assertEqual(self.case(deck="Main_BeamDyn.fst")[0], expected)
        self.edit("BeamDyn_Blade.dat",
                  ("   2.000000000E+07    4.000000000E+08", "   2.000000100E+07    4.000000000E+08"))
        text, said = self.case(deck="Main_BeamDyn.fst")
        self.assertIn("symmetric part", said)
        self.assertIn("-20000000.5", text)

    def test_other_files_than_the_main_one(self):
        self.copy()
        self.refuse("import", "openfast", "ElastoDyn.dat", "-o", "c.yaml", words="a file of ElastoDyn")
        self.refuse("import", "openfast", "Blade.dat", "-o", "c.yaml", words="give the main file")
        self.refuse("import", "openfast", "BeamDyn.dat", "-o", "c.yaml", words="a file of BeamDyn")
        self.write("old.fst", "---- FAST INPUT FILE ----\nFAST 7\n False Echo - x\n"
                              " 3 ADAMSPrep - y\n 1 AnalMode - z\n 3 NumBl - blades\n")
        self.refuse("import", "openfast", "old.fst", "-o", "c.yaml", words="FAST 7")

    def test_names_of_files_in_another_case(self):
        self.copy()
        (self.folder / "Tower.dat").rename(self.folder / "TOWER.DAT")
        self.refuse("import", "openfast", "Main.fst", "-o", "c.yaml",
                    words=["no such file", "there is", "TOWER.DAT", "upper and lower case"])

    def test_what_is_left_out_is_said(self):
        self.copy()
        self.edit("Main.fst", ("0             CompServo", "1             CompServo"),
                  ("0             CompSub ", "2             CompAero - air\n"
                   "1             CompHydro - water\n3             CompMooring - lines\n"
                   "0             CompSub "))
        self.edit("ElastoDyn.dat", ("False         PtfmSgDOF", "True          PtfmSgDOF"))
        _, said = self.case()
        for words in ("AeroDyn", "ServoDyn", "HydroDyn", "MoorDyn", "PtfmSgDOF", "platform",
                      "--tower-only", "tower.support"):
            self.assertIn(words, said)
        self.assertNotIn("--tower-only", self.case("--tower-only")[1])

    def test_furling_is_locked_and_its_masses_kept(self):
        self.copy()
        self.edit("ElastoDyn.dat", ("False         Furling", "True          Furling"),
                  ("True          SumPrint", '"Furl.dat"    FurlFile - furling\nTrue  SumPrint'))
        zero = "\n".join(f" 0 {key} - furling" for key in (
            "RFrlMass", "RFrlSkew", "RFrlTilt", "RFrlIner", "TFinMass", "ShftSkew"))
        self.write("Furl.dat", f"---- FURLING ----\nTail\n{zero}\n 0.1 Yaw2Shft - y\n"
                   " 50 BoomMass - kg\n 0,0,0 RFrlCM_n - m\n 2, 0.5, 1 BoomCM_n - m\n"
                   " 0,0,0 TFinCM_n - m\n 0,0,0 RFrlPnt_n - m\n 1, 0.5, 1 TFrlPnt_n - m\n"
                   " 0 TFrlSkew - deg\n 90 TFrlTilt - deg\n 60 TFrlIner - kg m2\n")
        plain, _ = self.case(deck="Main_BeamDyn.fst")
        self.assertIn("with the bodies of the furling file", plain)
        _, said = self.case()
        self.assertIn("Yaw2Shft = 0.1 is left out", said)
        self.edit("Furl.dat", ("60 TFrlIner", "40 TFrlIner"))
        self.refuse("import", "openfast", "Main.fst", "-o", "c.yaml", words="which no body has")

    def test_a_curved_beam_bends_as_beamdyn_has_it(self):
        """OpenFAST's regression case bd_curved_beam: 600 N along y at the end of a beam whose line is
        BeamDyn's parabola through three key points; displacement along x, y and z [m]."""
        self.copy()
        text = (self.folder / "BeamDyn.dat").read_text(encoding="utf-8")
        points = text[text.index("0.0000000E+00  0.0") : text.index("---------------------- MESH")]
        self.edit("BeamDyn.dat", (points, "0 0 0 0\n7.61205 0 38.2683 0\n29.2893 0 70.7107 0\n"),
                  ("4   kp_total", "3   kp_total"), ("     1     4  ", "     1     3  "),
                  ("5   order_elem", "10   order_elem"))
        diagonal = [41.6667e5, 41.6667e5, 100e5, 8.333e5, 8.333e5, 8.333e5]
        def rows(values):
            return "\n".join(" ".join(str(values[i] if i == j else 0.0) for j in range(6))
                             for i in range(6)) + "\n"
        station = rows(diagonal) + "\n" + rows([1.0] * 6)
        head = (self.folder / "BeamDyn_Blade.dat").read_text(encoding="utf-8")
        head = head[: head.index("  0.000000")].replace(" 3   station_total", " 2   station_total")
        self.write("BeamDyn_Blade.dat", f"{head} 0.0\n{station}\n 1.0\n{station}")
        case, _ = self.case(deck="Main_BeamDyn.fst")
        blades = case[case.index("\nblades:") :]
        for key, value in (("count", 1), ("precone_deg", 0), ("pitch_deg", 0)):
            blades = re.sub(rf"\n  {key}: .*", f"\n  {key}: {value}", blades)
        blades = re.sub(r"\n  each:(\n    .*)+", "", blades)
        self.write("beam.yaml", "samara: 1\ngravity: 0\n" + blades +
                   "\nloads:\n  - {beam: blade 1, at: 1, force: [0, -600, 0]}\n")
        self.succeed("static", "beam.yaml", "--csv", "static.csv")
        with open(self.folder / "static.csv", encoding="utf-8", newline="") as file:
            last = list(csv.DictReader(file))[-1]
        found = [float(last[f"blade 1 tip u{i}"]) for i in (3, 2, 1)]
        for value, known in zip(found, (-13.720786, -53.577559, -23.646076)):
            self.assertLess(abs(value / known - 1.0), 1e-5)


class Turbines(ProgramTest):
    """windIO as people have it."""

    def deck(self, *changes):
        text = SECOND.read_text(encoding="utf-8")
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("deck.yaml", text)

    def case(self, *options):
        run = self.succeed("import", "windio", "deck.yaml", "--tower-only", "-o", "case.yaml",
                           *options)
        return (self.folder / "case.yaml").read_text(encoding="utf-8"), run.stderr

    def test_what_is_stated_counts(self):
        self.deck()
        text, _ = self.case("--nacelle-mass", "12345", "--nacelle-center=-1,2,3", "--hub-inertia",
                            "1,2,3")
        for words in ("mass: 12345 ", "center_of_mass: [-1, 2, 3]", "inertia: [1, 2, 3]",
                      "from the command line"):
            self.assertIn(words, text)
        self.refuse("import", "windio", "deck.yaml", "-o", "c.yaml", "--tower-only", "--hub-mass",
                    "-5", words="hub.mass: expected a number >= 0")
        self.refuse("import", "openfast", THREE, "-o", "c.yaml", "--tower-only", "--hub-mass", "5",
                    words="--hub-mass")

    def test_each_quantity_that_a_deck_lacks_is_said(self):
        text = SECOND.read_text(encoding="utf-8")
        for block in ("drivetrain", "hub"):
            start = text.index(f"\n  {block}:")
            first = text.index("\n    elastic_properties:", start)
            last = re.compile(r"\n {2,4}\S").search(text, first + 5).start()
            text = text[:first] + text[last:]
        self.write("deck.yaml", text)
        _, said = self.case("--nacelle-mass", "5e5", "--hub-mass", "5e4")
        for option in ("--nacelle-center", "--nacelle-inertia", "--hub-center", "--hub-inertia"):
            self.assertIn(f"{option} states it", said)

    def test_inertia_about_the_tower_top_is_moved_by_what_is_stated(self):
        text = SECOND.read_text(encoding="utf-8")
        start = text.index("\n    elastic_properties:", text.index("\n  drivetrain:"))
        end = text.index("\n  ", text.index("inertia_tt", start))
        block = text[start:end]
        kept = "\n".join(line for line in block.split("\n")
                         if not re.match(r"\s*(inertia|location):", line))
        self.write("deck.yaml", text[:start] + kept + text[end:])
        case, _ = self.case("--nacelle-mass", "100", "--nacelle-center", "0,3,4")
        about_top = [float(word) for word in
                     re.search(r"inertia_tt: \[(.*?)\]", block).group(1).split(",")][:3]
        found = re.search(r"\nnacelle:.*?inertia: \[(.*?)\]", case, re.DOTALL).group(1).split(",")
        for value, known in zip(map(float, found),
                                (about_top[1] - 2500, about_top[0] - 1600, about_top[2] - 900)):
            self.assertAlmostEqual(value, known, delta=1e-6 * abs(known))
        for options in (("--nacelle-center", "1,2"), ("--hub-mass", "heavy"), ("--hub-mass",)):
            self.refuse("import", "windio", "deck.yaml", "-o", "c.yaml", *options,
                        words=options[0] + " needs")
        self.refuse("import", "openfast", THREE, "-o", "c.yaml", "--hub-mass", "3", words="windio")

    def test_order_of_damping(self):
        mu = "mu: [0.001, 0.002, 0.003, 0.004, 0.005, 0.006]"
        kxyz = "mu: [0.004, 0.003, 0.0004, 0, 0, 0]"
        tower = ("mu: [0.001, 0.001, 0.001, 0.002, 0.003, 0.001]", kxyz)
        self.deck(tower)  # the deck states no shear stiffness of the tower
        text, said = self.case()
        self.assertEqual(text.count("[0, 0, 0, 4e-04, 0.004, 0.003]"), 1)
        self.assertIn("--mu-order beamdyn", said)
        self.deck(tower, (mu, kxyz))  # of the blade it does
        text, _ = self.case()
        self.assertEqual(text.count("[0, 0, 0, 4e-04, 0.004, 0.003]"), 1)
        self.assertEqual(text.count("[4e-04, 0.003, 0.004, 0, 0, 0]"), 1)
        text, said = self.case("--mu-order", "hawc2")
        self.assertEqual(text.count("[0, 0, 0, 4e-04, 0.004, 0.003]"), 2)
        self.assertIn("HAWC2", said)
        text, _ = self.case("--mu-order", "beamdyn")
        self.assertEqual(text.count("[4e-04, 0.003, 0.004, 0, 0, 0]"), 2)
        self.refuse("import", "windio", "deck.yaml", "-o", "c.yaml", "--mu-order", "bladed",
                    words="beamdyn or hawc2")

    def test_a_missing_final_newline_is_nothing(self):
        self.deck()
        expected, _ = self.case()
        text = (self.folder / "deck.yaml").read_text(encoding="utf-8")
        self.write("deck.yaml", text.rstrip("\n"))
        self.assertEqual(self.case()[0], expected)

    def test_a_tower_alone(self):
        text = SECOND.read_text(encoding="utf-8")
        tower = re.search(r"\n  tower:\n(    .*\n)+", text).group(0)
        materials = re.search(r"\nmaterials:\n((  |- ).*\n)+", text).group(0)
        self.write("deck.yaml", f"windIO_version: '2.0'\nname: tower\ncomponents:{tower}{materials}")
        run = self.succeed("import", "windio", "deck.yaml", "-o", "case.yaml")
        self.assertIn("the tower alone", run.stderr)
        self.assertNotIn("blades:", (self.folder / "case.yaml").read_text(encoding="utf-8"))
        self.succeed("check", "case.yaml")
        self.assertIn("tower", self.succeed("modes", "case.yaml", "--parked").stdout)
        self.succeed("static", "case.yaml")
        self.refuse("floquet", "case.yaml", words="shaft.speed: must not be 0")
        for setting, words in (("shaft.speed=1", "there are no blades"),
                               ("loads=[{beam: blades, at: 1, force: [0, 0, 1]}]", "no blades"),
                               ("nacelle={mass: 5, yaw: {joint: free}}", "yaw axis"),
                               ("linearize={inputs: [pitch]}", "unknown input \"pitch\""),
                               ("linearize={blade_stations: [0.5]}", "there are no blades")):
            self.refuse("check", "case.yaml", "--set", setting, words=words)
        self.succeed("check", "case.yaml", "--set", "linearize={tower_stations: [0.5]}")
        for setting in ("pitch_deg: {table: [[0, 0], [1, 2]]}", "speed: {table: [[0, 1], [1, 2]]}",
                        "events: [{at: 0.5, pitch: {to_deg: 3, rate_deg: 8}}]",
                        "events: [{at: 0.5, brake: 1000}]", "output: {blade_stations: [0.5]}"):
            with self.subTest(setting):
                self.refuse("transient", "case.yaml", "--set",
                            f"transient={{duration: 1, step: 0.05, start: undeformed, {setting}}}",
                            words="there are no blades")

    def test_lay_ups_alone_are_refused_in_one_line(self):
        text = SECOND.read_text(encoding="utf-8")
        start = text.index("      elastic_properties:", text.index("  blade:"))
        end = text.index("\n  hub:")
        self.write("deck.yaml", text[:start] + "      layers: []" + text[end:])
        self.refuse("import", "windio", "deck.yaml", "-o", "c.yaml",
                    words=["missing key", "components.blade.structure.elastic_properties", "lay-up"])


class Hawc2(ProgramTest):
    """A deck of HAWC2."""

    DECK = "deck/htc/turbine.htc"

    def setUp(self):
        super().setUp()
        shutil.copytree(DECKS / "htc", self.folder / "deck")

    def test_a_deck_becomes_a_case_that_runs(self):
        run = self.succeed("import", "hawc2", self.DECK, "-o", "case.yaml", "--rotor-speed-rpm", "25")
        for words in ("taken:", "derived:", "ignored:", "concentrated_mass", "relative to the folder"):
            self.assertIn(words, run.stdout)
        for words in ("controller", "turb_format", "Tower.st"):
            self.assertIn(words, run.stderr)
        self.assertNotIn("--rotor-speed-rpm", run.stderr)
        self.assertIn("speed_rpm: 25 ", (self.folder / "case.yaml").read_text(encoding="utf-8"))
        self.assertIn("clamped", self.succeed("check", "case.yaml").stdout)
        self.succeed("trim", "case.yaml", "-o", "result.h5")
        run = self.succeed("floquet", "case.yaml", "--set", "aero=none", "-o", "result.h5")
        self.assertIn("all 14 modes decay", run.stdout)

    def test_options(self):
        run = self.succeed("import", "hawc2", self.DECK, "--report")
        self.assertIn("shaft.speed_rpm is 18.1437", run.stderr)
        self.refuse("import", "hawc2", self.DECK, "-o", "c.yaml", "--hub-mass", "3", words="windio")
        self.refuse("import", "openfast", THREE, "-o", "c.yaml", "--rotor-speed-rpm", "3",
                    words="windio and hawc2")
        self.refuse("import", "hawc2", "deck/parts/bodies.htc", "-o", "c.yaml",
                    words="not a main file of HAWC2")
        self.refuse("import", "hawc2", "deck/missing.htc", "-o", "c.yaml", words="missing.htc")


class Refusals(ProgramTest):
    """Input errors."""

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
        self.refuse("import", "bladed", THREE, words="the formats are openfast, windio, hawc2")
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
        for label, published in (("tower side-side", 0.3120), ("tower fore-aft", 0.3195),
                                 ("blade flap", 0.6675), ("blade lead-lag", 1.0793)):
            found = [f for f, name in rows if f > 0 and label in name]
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
