"""samara floquet --sensitivity: derivatives in the result, tables, ranks and errors."""

import pathlib
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import LONGEST_RUN, PROGRAM, SOURCE, ProgramTest  # noqa: E402

# One rigid blade on a flap hinge at the hub radius, of mass 4 kg/m and length 9 m.
CASE = """samara: 1
gravity: 0
shaft: {speed: 3}
hub: {radius: 1}
blades:
  count: 3
  length: 9
  elements: 3
  order: 2
  sections: [{mass: 4, inertia: [0, 0, 0], stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}]
  hinges: [{axis: flap, offset: 1, joint: free, stiffness: 3000, damping: 200}]
"""


class Sensitivity(ProgramTest):
    def setUp(self):
        super().setUp()
        self.case = self.folder / "hinged.yaml"
        self.case.write_text(CASE, encoding="utf-8")

    def rates_of(self, path):
        with h5py.File(self.folder / path) as file:
            group = file["floquet/sensitivity"]
            return (list(group["key"].asstr()[:]), list(group["unit"].asstr()[:]),
                    group["exponent_rate"][:] @ [1, 1j], group["error"][:], file["floquet/exponents"][:] @ [1, 1j])

    def test_an_interrupted_run_keeps_the_modes(self):
        """The signal comes later and later, until the modes are there; the derivatives take many times as long."""
        case = SOURCE / "inputs/lee2002/baseline.yaml"
        keys = "tower.sections.*,blades.sections.*.mass,shaft.speed,gravity,hub"
        delay, errors = 0.5, ""
        while "before the derivatives were found" not in errors:
            run = subprocess.Popen([PROGRAM, "floquet", case, "--first", "6", "-o", "run.h5", "--sensitivity", keys],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            time.sleep(delay)
            run.send_signal(signal.SIGINT)
            text, errors = run.communicate(timeout=LONGEST_RUN)
            self.assertEqual(run.returncode, 130, "the run has ended before the signal")
            delay *= 1.5
        self.assertIn("1st tower fore-aft", text)
        with h5py.File(self.folder / "run.h5") as file:
            self.assertGreater(len(file["floquet/exponents"]), 6)
            self.assertNotIn("sensitivity", file["floquet"])

    def test_a_hinge_has_the_derivatives_of_its_closed_form(self):
        run = self.succeed("floquet", "hinged.yaml", "--sensitivity", "blades.hinges.*.stiffness,shaft.speed,hub",
                            "-o", "run.h5")
        keys, units, rates, errors, exponents = self.rates_of("run.h5")
        self.assertEqual(keys, ["blades.hinges.0.stiffness", "shaft.speed", "hub.radius"])
        self.assertEqual(units, ["N m/rad", "rad/s", "m"])
        inertia, static = 4 * 9**3 / 3, 4 * 9**2 / 2
        exponent = -0.5 * 200 / inertia + 1j * numpy.sqrt(3000 / inertia + 9 * (1 + static / inertia)
                                                          - 0.25 * (200 / inertia) ** 2)
        slope = 2 * exponent + 200 / inertia
        copies = numpy.round((exponents - exponent).imag / 3)
        # A root further outboard, behind the same hinge: I' = 2 S, S' = m l.
        by_radius = (200 * 2 * static / inertia**2 * exponent + 3000 * 2 * static / inertia**2
                     - 9 * (4 * 9 / inertia - 2 * static**2 / inertia**2)) / slope
        expected = numpy.stack([numpy.full(3, -1 / inertia / slope), -6 * (1 + static / inertia) / slope + 1j * copies,
                                numpy.full(3, by_radius)], axis=1)
        self.assertLess(abs(rates / expected - 1).max(), 1e-6)
        self.assertLess((errors / abs(expected)).max(), 1e-4)
        # The table has the change for one per cent.
        change = 0.01 * 3 * expected[0, 1].imag / (2 * numpy.pi)
        row = next(line for line in run.stdout.split("sensitivity to shaft.speed")[1].splitlines() if line.startswith("1 "))
        self.assertIn(f"{change:.4g}", row)

    def test_ranks_find_the_same(self):
        arguments = ["floquet", "hinged.yaml", "--sensitivity", "blades.hinges,hub.radius", "-o"]
        self.succeed(*arguments, "one.h5")
        self.succeed(*arguments, "two.h5", ranks=2)
        one, two = self.rates_of("one.h5"), self.rates_of("two.h5")
        self.assertEqual(one[:2], two[:2])
        numpy.testing.assert_allclose(one[2], two[2], rtol=1e-7)

    def test_a_key_that_is_zero_has_its_derivative_per_unit(self):
        run = self.succeed("floquet", "hinged.yaml", "--set", "gravity=0", "--set", "blades.hinges.0.damping=0",
                            "--sensitivity", "blades.hinges.0.damping", "-o", "zero.h5")
        _, _, rates, _, _ = self.rates_of("zero.h5")
        inertia = 4 * 9**3 / 3
        self.assertLess(abs(rates + 0.5 / inertia).max(), 1e-6 / inertia)
        self.assertIn("per unit", run.stdout)

    def test_modes_are_kept_where_derivatives_fail(self):
        baseline = SOURCE / "inputs/lee2002/baseline.yaml"
        run = self.samara("floquet", baseline, "--set", "gravity=9.81", "--first", "8", "--sensitivity", "shaft.speed",
                          "-o", "kept.h5", "-hill_refine_ksp_max_it", "3")
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertIn("does not converge", run.stderr)
        self.assertIn("tower fore-aft", run.stdout)
        with h5py.File(self.folder / "kept.h5") as file:
            self.assertIn("exponents", file["floquet"])
            self.assertNotIn("sensitivity", file["floquet"])

    def test_derivatives_in_wind_agree_with_differences_of_runs(self):
        """Kinks of the polars pass stations at azimuths that move with the wind: few samples of the tangents in a revolution
        leave 2 % in the growth of the tower."""
        case = [SOURCE / "inputs/nrel5mw/land.yaml", "--set", "floquet.steps=108"]
        self.succeed("floquet", *case, "--set", "wind.speed=9", "--first", 6, "--sensitivity", "wind.speed", "-o", "s.h5")
        rates, errors = self.rates_of("s.h5")[2:4]
        exponents = {}
        for wind in (9.001, 8.999):
            self.succeed("floquet", *case, "--set", f"wind.speed={wind}", "-o", "d.h5")
            with h5py.File(self.folder / "d.h5") as file:
                exponents[wind] = file["floquet/exponents"][:6] @ [1, 1j]
        difference = (exponents[9.001] - exponents[8.999]) / 0.002
        for mode in range(6):
            rate, error = rates[mode][0], errors[mode][0]
            # To 1e-5 of the exponent by the number, and with four digits of the growth's derivative but for what is left by
            # the steps of the runs.
            self.assertLess(abs(rate - difference[mode]), 1e-5 * abs(exponents[9.001][mode]) / 9.0)
            self.assertLess(abs(rate.real - difference[mode].real), 2e-3 * abs(rate.real))
            self.assertLess(error, 1e-3 * abs(rate))

    def test_errors_name_the_key(self):
        for keys, words in (("blades.hinge", 'no "hinge"; did you mean "hinges"?'),
                            ("blades.sections.*.EI", 'blades.sections.0: no "EI"; did you mean "stiffness.EI2" or "stiffness.EI3"?'),
                            ("blades.sections.*.ea", 'did you mean "stiffness.EA"?'),
                            ("blades.sections.*.stiffness.GA", 'did you mean "GA2" or "GA3"?'),
                            ("blades.GJ", 'blades: no "GJ"; did you mean "sections.*.stiffness.GJ"?'),
                            ("*.sections.*.EI", 'blades.sections.0: no "EI"'),
                            ("blades.count", "blades.count"),
                            ("blades.hinges.0.axis", "no number there"),
                            ("shaft.speed,shaft", "shaft.speed is named twice")):
            with self.subTest(keys=keys):
                self.refuse("floquet", "hinged.yaml", "--sensitivity", keys, "-o", "none.h5", words=[words])
                self.assertFalse((self.folder / "none.h5").exists())
        self.refuse("modes", "hinged.yaml", "--sensitivity", "shaft.speed", words=["samara floquet does"])


if __name__ == "__main__":
    unittest.main()
