"""Turbines as their repositories ship them, and what becomes of each: tests/decks/public_decks.csv.

A row names a deck and its outcome: `imports`; `--tower-only`, where that option is asked for; or
the reason of the refusal. `modes` and `floquet` name the reason where the command has no modes to
find. The table only ever improves.
"""

import csv
import math
import os
import pathlib
import re
import shlex
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
import elastodyn  # noqa: E402
from program import SOURCE, ProgramTest  # noqa: E402

FOLDER = os.environ.get("SAMARA_PUBLIC_DECKS")
REFUSED = 2
NOT_FOUND = 3


def read_table():
    with open(SOURCE / "tests/decks/public_decks.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@unittest.skipUnless(FOLDER, "SAMARA_PUBLIC_DECKS does not name the folder of public decks")
class PublicDecks(ProgramTest):
    """Every deck of the folder."""

    @staticmethod
    def rows():
        for row in read_table():
            deck = pathlib.Path(FOLDER) / row["deck"]
            if deck.exists():
                yield row, deck

    def run_import(self, deck, *options):
        kind = {".fst": "openfast", ".htc": "hawc2"}.get(deck.suffix, "windio")
        if kind == "hawc2":  # its speed at the beginning is far from that of operation
            options = (*options, "--rotor-speed-rpm", "7.5")
        return self.samara("import", kind, deck, "-o", "case.yaml", *options)

    def import_row(self, row, deck):
        """Imports what imports; whether there is a case."""
        outcome = row["outcome"]
        if outcome not in ("imports", "--tower-only"):
            return False
        run = self.run_import(deck, *([] if outcome == "imports" else [outcome]))
        self.assertEqual(run.returncode, 0, run.stderr)
        return True

    def test_the_campbell_diagram_of_the_readme(self):
        """The three commands of README.md, at two of their wind speeds on one rank."""
        text = (SOURCE / "README.md").read_text(encoding="utf-8").replace("\\\n", " ")
        imported, campbell, plot = (
            next(shlex.split(line) for line in text.splitlines() if words in line)
            for words in ("samara import openfast 5MW", "samara campbell 5mw.yaml", "samara plot campbell.h5"))
        name = imported[imported.index("openfast") + 1]
        decks = list(pathlib.Path(FOLDER).rglob(name))
        if not decks:
            self.skipTest("no " + name)
        self.succeed("import", "openfast", decks[0], *imported[imported.index(name) + 1:])
        options = [re.sub(r"wind_speeds=.*", "wind_speeds=[8, 15]", word) for word in campbell]
        self.succeed("campbell", *options[options.index("campbell") + 1:])
        self.succeed("plot", *plot[plot.index("plot") + 1:])
        self.assertIn("campbell.svg", self.files())

    def test_every_deck_of_the_folder_is_in_the_table(self):
        known = {row["deck"] for row in read_table()}
        found = {str(path.relative_to(FOLDER))
                 for suffix in ("fst", "yaml", "htc") for path in pathlib.Path(FOLDER).rglob(f"*.{suffix}")}
        self.assertEqual(found - known, set())

    def test_outcomes(self):
        for row, deck in self.rows():
            with self.subTest(deck=row["deck"]):
                if self.import_row(row, deck):
                    self.succeed("check", "case.yaml")
                    if row["outcome"] == "imports":
                        continue
                run = self.run_import(deck)
                self.assertEqual(run.returncode, REFUSED)
                self.assertEqual(len(run.stderr.splitlines()), 1, run.stderr)
                self.assertIn(row["outcome"], run.stderr)

    def analyse(self, reason, *arguments):
        run = self.samara(*arguments, "-o", "result.h5")
        if reason:
            self.assertIn(run.returncode, (REFUSED, NOT_FOUND))
            self.assertIn(reason, run.stderr)
        else:
            self.assertEqual(run.returncode, 0, run.stderr)

    def test_analyses(self):
        for row, deck in self.rows():
            with self.subTest(deck=row["deck"]):
                if not self.import_row(row, deck):
                    continue
                self.analyse(row["modes"], "modes", "case.yaml", "--parked", "--set", "aero=none")
                self.analyse("", "trim", "case.yaml")
                self.analyse(row["floquet"], "floquet", "case.yaml")
                self.analyse("", "transient", "case.yaml", "--set", "transient.duration=3",
                             "--set", "transient.step=0.01")


    def find(self, name):
        row, deck = next((item for item in self.rows() if item[0]["deck"].endswith(name)),
                         (None, None))
        if deck is None:
            self.skipTest(f"no {name} in the folder")
        self.deck = deck
        self.assertTrue(self.import_row(row, deck))

    def multipliers(self):
        """Sizes of the multipliers of `floquet`, by the names of the modes."""
        with open(self.folder / "modes.csv", encoding="utf-8", newline="") as file:
            return {row["label"]: math.hypot(float(row["multiplier_re"]),
                                            float(row["multiplier_im"]))
                    for row in csv.DictReader(file)}

    def test_awt27_decays_as_openfast_has_it(self):
        """Yaw, generator and shaft locked; OpenFAST's linearization with 100 blade nodes has the
        sizes 0.77367, 0.77354, 0.58535 and 0.54859."""
        self.find("AWT_YFix_WSt.fst")
        self.succeed("floquet", "case.yaml", "--csv", "modes.csv", "-o", "result.h5",
                     "--set", "shaft.torsion={joint: locked}", "--set", "aero=none",
                     "--set", "blades.elements=12")
        found = self.multipliers()
        for mode, size in (("1st tower side-side", 0.77367), ("1st tower fore-aft", 0.77354),
                           ("teeter", 0.58535), ("1st blade flap symmetric", 0.54859)):
            self.assertLess(abs(found[mode] / size - 1.0), 1e-3, mode)

    def frequencies(self, *arguments):
        self.succeed("modes", *arguments, "--csv", "modes.csv", "-o", "result.h5")
        with open(self.folder / "modes.csv", encoding="utf-8", newline="") as file:
            return {row["label"]: float(row["frequency_hz"]) for row in csv.DictReader(file)}

    def alone(self, block, *options, hub=0.0):
        """Frequencies of the imported tower or blade, clamped, without anything on it."""
        text = (self.folder / "case.yaml").read_text(encoding="utf-8")
        text = re.search(rf"\n{block}:.*?(?=\n[^\s#]|\Z)", text, re.S).group(0)
        text = re.sub(r"\n  airfoils:.*", "", text, flags=re.S)
        for key in ("tip_mass", "precone_deg", "pitch_deg"):
            text = re.sub(rf"\n  {key}: .*", "", text)
        text = re.sub(r"\n  count: .*", "\n  count: 1", text)
        if block == "blades":
            text = f"\nhub: {{radius: {hub}}}" + text
        self.write("alone.yaml", "samara: 1\ngravity: 0\n" + text)
        return self.frequencies("alone.yaml", *options)

    def assert_beam(self, block, beam, speed=0.0):
        """The lowest two frequencies, damping taken out, within 0.3 % of those of the tables."""
        self.alone(block, "--set", f"shaft.speed={speed}", hub=beam.root)
        with open(self.folder / "modes.csv", encoding="utf-8", newline="") as file:
            found = sorted(math.hypot(float(row["exponent_re"]), float(row["exponent_im"]))
                           for row in csv.DictReader(file) if float(row["exponent_im"]) > 0.0)
        for one, known in zip(found, beam.frequencies(speed)):
            self.assertLess(abs(one / (2 * math.pi * known) - 1.0), 3e-3, block)

    def test_blades_and_towers_have_the_frequencies_of_their_tables(self):
        """At rest and at the rotor speed; the deck's tables in elements of this test's own."""
        for name, has_tower in (("AWT_YFix_WSt", True), ("UAE_Dnwind_YRamp_WSt", True),
                                ("WP_VSP_ECD", True), ("5MW_Land_DLL_WTurb", True),
                                ("AOC_WSt", False), ("SWRT_YFree_VS_EDG01", False)):
            with self.subTest(deck=name):
                self.find(f"{name}.fst")
                main = elastodyn.Deck(self.deck).file("EDFile")
                blade = elastodyn.blade(main)
                self.assert_beam("blades", blade)
                if speed := main.number("RotSpeed") * math.pi / 30.0:
                    self.assert_beam("blades", blade, speed)
                if has_tower:
                    self.assert_beam("tower", elastodyn.tower(main))
        self.find("IEA-22-280-RWT-Monopile.fst")
        self.assert_beam("tower", elastodyn.tower(elastodyn.Deck(self.deck).file("EDFile")))

    def assert_near(self, found, known, tolerance):
        for label, value in known.items():
            self.assertLess(abs(found[label] / value - 1.0), tolerance, label)

    def test_frequencies_beside_those_of_others(self):
        """The table of docs/verification.md, section I1."""
        self.find("Ideal_Beam_Fixed_Free_Linear.fst")
        found = self.frequencies("case.yaml")
        self.assert_near(found, {"1st blade bending": 0.58410}, 2e-3)
        self.assert_near(found, {"2nd blade bending": 3.6605}, 1e-2)
        self.find("5MW_Land_DLL_WTurb.fst")
        found = self.frequencies("case.yaml", "--parked")
        self.assert_near(found, {"1st tower fore-aft": 0.3195, "1st tower side-side": 0.3164}, 2e-2)
        self.assert_near(found, {"shaft torsion": 0.6094}, 1e-2)
        self.assert_near(found, {"1st blade lead-lag sine-cyclic": 1.0740,
                                 "1st blade lead-lag cosine-cyclic": 1.0877}, 1.5e-2)
        self.write("case.yaml", (SOURCE / "inputs/iea15mw/land.yaml").read_bytes())
        self.assert_near(self.alone("tower"), {"1st tower bending": 0.7746}, 1.2e-2)
        found = self.alone("blades")
        self.assert_near(found, {"1st blade flap": 0.514}, 2e-2)
        self.assert_near(found, {"1st blade lead-lag": 0.722}, 4.5e-2)

    def test_awt27_with_a_free_yaw_names_it(self):
        self.find("AWT_YFree_WSt.fst")
        self.succeed("floquet", "case.yaml", "--csv", "modes.csv", "-o", "result.h5",
                     "--set", "aero=none")
        self.assertTrue(any("yaw" in mode for mode in self.multipliers()))

    def rotor_loads(self, case):
        """Power by the twist of the shaft [W], and thrust at the tower's foot [N]."""
        speed = 9.155 * math.pi / 30.0
        self.succeed("trim", case, "--csv", "steady.csv", "-o", "result.h5", "--set",
                     "wind.speed=8", "--set", "shaft.speed_rpm=9.155", "--set",
                     "aero={induction: full}")
        with open(self.folder / "steady.csv", encoding="utf-8", newline="") as file:
            mean = {row["name"]: float(row["mean"]) for row in csv.DictReader(file)}
        return 867637000.0 * mean["shaft torsion angle"] * speed, mean["tower root F3"]

    def test_the_5_mw_rotor_has_the_loads_of_the_case_by_hand(self):
        """inputs/nrel5mw/land.yaml has the sections of the same files, written by hand. Both have the
        standard models here."""
        self.find("5MW_Land_DLL_WTurb.fst")
        found = self.rotor_loads("case.yaml")
        known = self.rotor_loads(SOURCE / "inputs/nrel5mw/land.yaml")
        for one, other in zip(found, known):
            self.assertLess(abs(one / other - 1.0), 1e-4)

    def sections(self, deck):
        """Chord, twist and centre over the place, of the imported case."""
        self.find(deck)
        text = (self.folder / "case.yaml").read_text(encoding="utf-8")
        block = text[text.index("\n  aero_sections:"):] + "\nend"
        block = block[: re.compile(r"\n {0,2}\S").search(block, 20).start()]
        found = []
        for item in re.split(r"\n    - ", block)[1:]:
            def number(key, item=item):
                match = re.search(rf"\b{key}: ([-+.e0-9]+)", item)
                return float(match.group(1)) if match else 0.0
            center = re.search(r"center: \[(.*?), (.*?)\]", item)
            found.append((number("at"), number("chord"), number("twist_deg"),
                          *(map(float, center.groups()) if center else (0.0, 0.0))))
        return found

    @staticmethod
    def at_place(rows, at):
        for a, b in zip(rows, rows[1:]):
            if a[0] <= at <= b[0]:
                part = (at - a[0]) / (b[0] - a[0])
                return [x + part * (y - x) for x, y in zip(a[1:], b[1:])]
        raise AssertionError(at)

    def test_openfast_and_windio_describe_the_same_blade(self):
        """The 22 MW turbine: AeroDyn has its aerodynamic centre in axes of the root of a blade that
        bends 7 m upwind, windIO behind the leading edge. Chord and centre within 2 cm and 1 cm,
        twist within 0.05 degrees; the stations are not the same."""
        aerodyn = self.sections("IEA-22-280-RWT-Monopile.fst")
        windio = self.sections("examples/turbine/IEA-22-280-RWT.yaml")
        for at in (0.07, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9):
            one, other = (self.at_place(rows, at) for rows in (aerodyn, windio))
            for found, known, tolerance in zip(one, other, (0.02, 0.05, 0.01, 0.01)):
                self.assertLess(abs(found - known), tolerance, at)

    def masses(self, name):
        """Masses and centres of the parts, by `samara check`."""
        lines = self.succeed("check", name).stdout.splitlines()
        return {line[: line.index("  ")]: [float(word.rstrip(",")) for word in line.split()[1:]
                                           if re.fullmatch(r"[-+.e0-9]+,?", word)]
                for line in lines if line.startswith(("tower  ", "each blade", "nacelle", "rotor  "))}

    def operating_point(self, wind, speed_rpm, pitch_deg):
        """Power [kW] and thrust [kN] of the axisymmetric rotor: no weight, tilt or tower."""
        run = self.succeed("trim", "case.yaml", "-o", "result.h5", "--set", f"wind.speed={wind}", "--set",
                           f"shaft.speed_rpm={speed_rpm}", "--set", f"blades.pitch_deg={pitch_deg}",
                           "--set", "gravity=0", "--set", "shaft.tilt_deg=0", "--set",
                           "wind.tower.potential=none", "--set", "wind.tower.drag_load=false",
                           "--set", "blades.elements=12", "--set", "blades.order=2")
        found = re.search(r"power (\S+) kW, thrust (\S+) kN", run.stdout)
        return map(float, found.groups())

    def test_the_15_mw_turbine_of_hawc2(self):
        """Masses and frequencies beside those of the case made from windIO, and the operating points
        that HAWCStab2 wrote for the deck (its .opt file). The hub of windIO has another mass."""
        known = self.masses(SOURCE / "inputs/iea15mw/land.yaml")
        self.find("IEA_15MW_RWT_Onshore.htc")
        found = self.masses("case.yaml")
        for part, tolerance in (("tower", 1e-3), ("each blade", 1e-4), ("nacelle", 2e-4)):
            self.assertLess(abs(found[part][0] / known[part][0] - 1.0), tolerance, part)
        self.assertLess(abs(found["each blade"][1] / known["each blade"][1] - 1.0), 1e-3)
        frequencies = self.frequencies("case.yaml", "--parked", "--set", "aero=none")
        self.assert_near(frequencies, {"1st tower side-side": 0.2220, "1st tower fore-aft": 0.2251,
                                       "1st blade flap sine-cyclic": 0.4568,
                                       "1st blade flap cosine-cyclic": 0.4948,
                                       "1st blade lead-lag sine-cyclic": 0.6909}, 1e-2)
        for point, known in (((8, 5.6819, 0.000535), (6852.108, 1295.040)),
                             ((15, 7.559987, 9.189114), (15666.72, 1268.984))):
            for one, other in zip(self.operating_point(*point), known):
                self.assertLess(abs(one / other - 1.0), 0.02, point)


if __name__ == "__main__":
    unittest.main()
