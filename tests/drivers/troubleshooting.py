"""Messages of docs/troubleshooting.md, provoked: the program prints what the page quotes, and the remedy of the page ends
the fault."""

import pathlib
import re
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import MINIMAL, PROGRAM, SOURCE, ProgramTest  # noqa: E402

ROWS = re.findall(r"(?m)^\| `([^`]+)` \| ", (SOURCE / "docs/troubleshooting.md").read_text(encoding="utf-8"))
LEE = SOURCE / "inputs/lee2002/article_mesh.yaml"
BEAM_BLADES = SOURCE / "inputs/nrel5mw/beam_blades.yaml"
LAND = SOURCE / "inputs/nrel5mw/land.yaml"
SHORT = "transient={duration: 0.1, step: 0.01}"
DECKS = SOURCE / "tests/decks/files"


def run_of(text):
    return f"transient={{duration: 1, step: 0.01, {text}}}"


def pitch(table):
    return run_of(f"pitch_deg: {{table: {table}}}")


# The beginning of the quoted message, a command that leads to it, and the command with the remedy. Where the remedy is None,
# the message is a note or a fact, or its remedy is other input.
CASES = [
    ("unknown command", "flouet case.yaml", "floquet case.yaml"),
    ("unknown option", "check case.yaml -set gravity=1", "check case.yaml --set gravity=1"),
    ("missing case file", "trim -trim_ksp_view case.yaml", "trim case.yaml -trim_ksp_view"),
    ("expected key=value", "check case.yaml --set gravity", "check case.yaml --set gravity=9.81"),
    ("with items 0 to", "check case.yaml --set blades.sections.3.mass=2", "check case.yaml --set blades.sections.0.mass=2"),
    ("options that this run", "trim case.yaml -snes_monitor", "trim case.yaml -trim_snes_monitor"),
    ("PETSc refuses one", ["floquet", LEE, "-floquet_eps_type", "none_such"], ["floquet", LEE]),
    ("all eigenvalues are", ["floquet", LEE, "-floquet_eps_nev", "3"], ["floquet", LEE, "--set", "floquet.modes=10"]),
    ("lists no modes", "trim case.yaml --first 3", "trim case.yaml"),
    ("no such file; did", "check case", "check case.yaml"),
    ("not valid YAML", "check tab.yaml", "check case.yaml"),
    ("unknown key", "check case.yaml --set gravty=9.81", "check case.yaml --set gravity=9.81"),
    ("expected a number", "check case.yaml --set gravity=9,81", "check case.yaml --set gravity=9.81"),
    ("must be 0: samara", "static case.yaml", "static case.yaml --set shaft.speed=0"),
    ("must not be 0", "floquet case.yaml --set shaft.speed=0", "modes case.yaml --set shaft.speed=0"),
    ("the coefficients are periodic, the", "modes case.yaml --set gravity=9.81", "modes case.yaml --set gravity=9.81 --parked"),
    ("the coefficients are periodic in", ["modes", LEE], ["modes", LEE, "--parked"]),
    ('missing key "transient"', "transient case.yaml", ["transient", "case.yaml", "--set", SHORT]),
    ("a teeter hinge", "check case.yaml --set hub.teeter.joint=free --set blades.count=3",
     "check case.yaml --set hub.teeter.joint=locked --set blades.count=3"),
    ("the generator is locked", ["transient", "case.yaml", "--set", run_of("events: [{at: 0.5, generator_off: true}]")],
     ["transient", "case.yaml", "--set", run_of("events: [{at: 0.5, generator_off: true}]"),
      "--set", "shaft.generator.joint=free"]),
    ("degrees of freedom; hint", ["floquet", LEE, "--set", "floquet.modes=500"], ["floquet", LEE]),
    ("needs floquet.modes", ["floquet", LEE, "--set", "floquet.near_hz=1"],
     ["floquet", LEE, "--set", "floquet.near_hz=1", "--set", "floquet.modes=4"]),
    ("trim: ... after", "trim case.yaml --set gravity=9.81 -trim_snes_max_it 1", "trim case.yaml --set gravity=9.81 -trim_snes_max_it 200"),
    ("loads are out of balance", "trim case.yaml --set gravity=9.81 --set trim.harmonics=1",
     "trim case.yaml --set gravity=9.81 --set trim.harmonics=4"),
    ("no verdict: modes from", ["floquet", BEAM_BLADES, "--set", "floquet.steps=9"],
     ["floquet", BEAM_BLADES, "--set", "floquet.steps=120"]),
    ("too large an error and", "floquet case.yaml", "floquet case.yaml --set blades.order=3 --set blades.elements=6"),
    ("; other modes are not known", ["floquet", LEE, "--set", "floquet.modes=4", "--set", "floquet.search=hill"],
     ["floquet", LEE]),
    ("floquet.period: blade needs", ["floquet", "case.yaml", "--set", "floquet.period=blade"],
     ["floquet", "case.yaml", "--set", "floquet.period=auto"]),
    ("(static.max_steps) were", ["static", "case.yaml", "--set", "shaft.speed=0", "--set", "static.max_steps=3",
                                 "--set", "loads=[{beam: blade 1, at: 1, force: [-5000, 0, 100]}]"],
     ["static", "case.yaml", "--set", "shaft.speed=0", "--set", "static.max_steps=300",
      "--set", "loads=[{beam: blade 1, at: 1, force: [-5000, 0, 100]}]"]),
    ("Newton's iteration diverges", ["static", "case.yaml", "--set", "shaft.speed=0", "--set", "static.steps=1",
                                     "--set", "loads=[{beam: blade 1, at: 1, moment: [0, 1e6, 0]}]"], None),
    (", which nothing restores: at 0", ["static", "case.yaml", "--set", "shaft.speed=0", "--set", "shaft.generator.joint=free",
                                        "--set", "loads=[{beam: blade 1, at: 1, force: [0, 10, 0]}]"],
     ["static", "case.yaml", "--set", "shaft.speed=0", "--set", "loads=[{beam: blade 1, at: 1, force: [0, 10, 0]}]"]),
    ("transient: no step from", ["transient", "case.yaml", "--set", "gravity=9.81", "--set", "transient={duration: 1, step: 0.01, start: undeformed}",
                                 "--set", "loads=[{beam: blade 1, at: 1, force: [0, 0, 1e5]}]"], None),
    ("rotation beyond 170", ["transient", "case.yaml", "--set", "gravity=9.81", "--set", "transient={duration: 1, step: 0.01, start: undeformed}",
                             "--set", "loads=[{beam: blade 1, at: 1, force: [0, 0, 1e5]}]"], None),
    ("steps a revolution at", "transient case.yaml --set transient.duration=1 --set transient.step=0.1",
     "transient case.yaml --set transient.duration=1 --set transient.step=0.02"),
    ("expected a multiple", ["transient", "case.yaml", "--set", run_of("output: {every: 0.015}")],
     ["transient", "case.yaml", "--set", run_of("output: {every: 0.02}")]),
    ("unknown channel", ["transient", "case.yaml", "--set", run_of("output: {channels: [RotSped]}")],
     ["transient", "case.yaml", "--set", run_of("output: {channels: [RotSpeed]}")]),
    ("never comes", ["transient", "case.yaml", "--set", run_of("events: [{at: 5, pitch: {to_deg: 1, rate_deg: 8}}]")],
     ["transient", "case.yaml", "--set", run_of("events: [{at: 0.5, pitch: {to_deg: 1, rate_deg: 8}}]")]),
    ("never came", ["transient", "case.yaml", "--set",
                    run_of("events: [{when: {channel: RotSpeed, above: 500}, pitch: {to_deg: 1, rate_deg: 8}}]")],
     ["transient", "case.yaml", "--set",
      run_of("events: [{when: {channel: RotSpeed, above: 50}, pitch: {to_deg: 1, rate_deg: 8}}]")]),
    ("changes too fast", ["transient", "case.yaml", "--set", pitch("[[0, 0], [0.5, 0], [0.501, 9], [1, 9]]")],
     ["transient", "case.yaml", "--set", pitch("[[0, 0], [0.5, 0], [1, 9]]")]),
    ("; hint: prescribed motions must", ["transient", "case.yaml", "--set", pitch("[[0, 5], [1, 9]]")],
     ["transient", "case.yaml", "--set", pitch("[[0, 0], [1, 9]]")]),
    ("missing --sweep", ["campbell", LEE], ["campbell", LEE, "--sweep", "shaft.speed_rpm=20:40:20"]),
    ("operating points need", "operate case.yaml", None),
    ("the wind does not drive", ["operate", LAND, "--set", "operation.wind_speeds=[0.5]"],
     ["operate", LAND, "--set", "operation.wind_speeds=[8]"]),
    ("modes of different meshes", ["campbell", LEE, "--sweep", "blades.elements=2,3"],
     ["campbell", LEE, "--sweep", "shaft.speed=3,4"]),
    ("--sweep: the step", ["campbell", LEE, "--sweep", "shaft.speed=3:4:-1"], ["campbell", LEE, "--sweep", "shaft.speed=3:4:1"]),
    ("unknown input", ["linearize", "case.yaml", "--set", "linearize={inputs: [yaw_torque], outputs: [RotSpeed]}"],
     ["linearize", "case.yaml", "--set", "linearize={inputs: [pitch], outputs: [RotSpeed]}"]),
    ("multiblade coordinates are", ["linearize", LEE, "--set", "linearize.forms=[multiblade]"],
     ["linearize", LEE, "--set", "linearize.forms=[hill]"]),
    ("exists and is no result", "trim case.yaml -o notes.h5", "trim case.yaml -o other.h5"),
    ("there is no folder", "trim case.yaml -o none/r.h5", "trim case.yaml -o r.h5"),
    ("is no result of samara", "export notes.h5 -o r.csv", None),
    ("has no time series", "export trim.h5 -o r.csv", "export run.h5 -o r.csv"),
    ("its ending does not", "export run.h5 -o r.txt", "export run.h5 -o r.csv"),
    ("no row from", "loads run.h5 --set from=5", "loads run.h5 --set from=0.05"),
    ("was run with another transient.step", ["transient", "case.yaml", "--set", "transient={duration: 0.2, step: 0.02}", "-o", "run.h5",
                                             "--restart", "run.h5"],
     ["transient", "case.yaml", "--set", "transient={duration: 0.2, step: 0.02, start: run.h5}", "-o", "next.h5"]),
    ("reaches to t =", ["transient", "case.yaml", "--set", SHORT, "-o", "run.h5", "--restart", "run.h5"],
     ["transient", "case.yaml", "--set", "transient={duration: 0.2, step: 0.01}", "-o", "run.h5", "--restart", "run.h5"]),
    ("is of another model", ["transient", "case.yaml", "--set", run_of("start: run.h5"), "--set", "blades.elements=3", "-o", "next.h5"],
     ["transient", "case.yaml", "--set", run_of("start: run.h5"), "-o", "next.h5"]),
    ("hint: give the main file", ["import", "openfast", DECKS / "three/ElastoDyn.dat", "-o", "new.yaml"],
     ["import", "openfast", DECKS / "three/Main.fst", "-o", "new.yaml"]),
    ("not a main file of HAWC2", ["import", "hawc2", DECKS / "htc/parts/bodies.htc", "-o", "new.yaml"],
     ["import", "hawc2", DECKS / "htc/htc/turbine.htc", "-o", "new.yaml"]),
    ("missing -o CASE.yaml", ["import", "openfast", DECKS / "three/Main.fst"],
     ["import", "openfast", DECKS / "three/Main.fst", "--report"]),
    ("is not in the deck", ["import", "windio", DECKS / "windio/first.yaml", "-o", "new.yaml"], None),
]


def row_of(beginning):
    """The message of the page that begins so."""
    found = [row for row in ROWS if row.startswith(beginning)]
    if len(found) != 1:
        raise AssertionError(f"{len(found)} messages begin with: {beginning}")
    return found[0]


def pattern_of(row):
    parts = [re.escape(part.strip(' "')) for part in row.split("...")]
    return re.compile(".*".join(parts), re.S)


class Provoked(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("case.yaml", MINIMAL)
        self.write("tab.yaml", MINIMAL.replace("  length", "\tlength"))
        self.write("notes.h5", "my notes")
        self.succeed("trim", "case.yaml", "-o", "trim.h5")
        self.succeed("transient", "case.yaml", "--set", SHORT, "-o", "run.h5")

    def printed(self, words):
        run = self.samara(*(words.split() if isinstance(words, str) else words))
        return run.returncode, run.stdout + run.stderr

    def test_messages_and_remedies(self):
        self.assertGreater(len(CASES), 50)
        for beginning, fault, remedy in CASES:
            with self.subTest(message=beginning):
                pattern = pattern_of(row_of(beginning))
                self.assertRegex(self.printed(fault)[1], pattern)
                if remedy is None:
                    continue
                code, text = self.printed(remedy)
                self.assertEqual(code, 0, text)
                self.assertNotRegex(text, pattern)

    def test_a_result_that_another_run_writes(self):
        words = ["transient", "case.yaml", "--set", "transient={duration: 5000, step: 0.001}", "-o", "long.h5"]
        with subprocess.Popen([PROGRAM, *words], cwd=self.folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True) as process:
            try:
                until = time.monotonic() + 60
                while not (self.folder / "long.h5").exists() and time.monotonic() < until:
                    time.sleep(0.1)
                self.assertRegex(self.printed("trim case.yaml -o long.h5")[1], pattern_of(row_of("is being written")))
                self.assertEqual(self.printed("trim case.yaml -o other.h5")[0], 0)
            finally:
                process.send_signal(signal.SIGINT)
            self.assertIn("hint: --restart", process.communicate()[1])
            self.assertEqual(process.returncode, 130)


if __name__ == "__main__":
    sys.exit(unittest.main())
