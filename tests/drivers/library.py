"""The installed library: five programs that find it from outside, against closed forms, and what of
it is seen."""

import cmath
import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
from csv import DictReader as csv_reader

import numpy
from scipy.integrate import solve_ivp

SOURCE = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"])
BUILD = pathlib.Path(os.environ["SAMARA_PROGRAM"]).parent


def run(*words, cwd=None):
    done = subprocess.run([str(word) for word in words], cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{words}: {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="samara library ")
        folder = pathlib.Path(cls.temporary.name)
        cls.tree = folder / "tree"
        run("cmake", "--install", BUILD, "--prefix", cls.tree)
        shutil.copytree(SOURCE / "examples" / "cpp", folder / "cpp")
        cls.built = folder / "build"
        run("cmake", "-S", folder / "cpp", "-B", cls.built, "-DCMAKE_BUILD_TYPE=Debug",
            "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror", f"-DCMAKE_PREFIX_PATH={cls.tree}")
        run("cmake", "--build", cls.built, "-j2")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def found(self, example, pattern):
        """Numbers of the lines of an example's output, and the output."""
        text = run(self.built / example)
        return [tuple(map(float, groups)) for groups in re.findall(pattern, text)], text

    def test_the_programs_stand_beside_each_other(self):
        for name in ("samara", "samara-program", "samara-controller-host"):
            self.assertTrue(os.access(self.tree / "bin" / name, os.X_OK), name)

    def test_the_installed_program_has_its_templates_and_its_pictures(self):
        folder = pathlib.Path(self.temporary.name) / "installed"
        folder.mkdir()
        program = self.tree / "bin/samara"
        run(program, "new", "beam", "mine", cwd=folder)
        run(program, "floquet", "mine.yaml", cwd=folder)
        self.assertEqual(run(program, "plot", "mine.h5", cwd=folder), "picture: mine_multipliers.svg\npicture: mine_spanwise.svg\n")

    def test_a_beam_has_the_frequencies_of_euler_and_bernoulli(self):
        rows, _ = self.found("beam", r"(\S+) Hz +(\S+)\n")
        factors = sorted(factor for _, factor in rows)
        self.assertEqual(len(factors), 4)
        exact = sorted([3.516015, 2 * 3.516015, 22.034492, 2 * 22.034492])  # EI3 = 4 EI2
        for found, wanted in zip(factors, exact):
            self.assertAlmostEqual(found, wanted, delta=3e-3 * wanted)

    def test_the_article_has_the_exponents_of_the_program(self):
        rows, text = self.found("article", r"(\S+) per rev +(\S+) 1/s")
        csv = self.built / "modes.csv"
        run(self.tree / "bin" / "samara", "floquet", SOURCE / "inputs/lee2002/baseline.yaml", "-o",
            self.built / "f.h5", "--csv", csv)
        with open(csv, encoding="utf-8") as file:
            table = list(csv_reader(line for line in file if not line.startswith("#")))
        self.assertEqual(len(rows), 10)
        for (frequency, growth), mode in zip(rows, table):
            self.assertAlmostEqual(frequency, float(mode["frequency_per_rev"]), delta=1e-5)
            self.assertAlmostEqual(growth, float(mode["exponent_re"]), delta=5e-3 * abs(growth) + 1e-11)
        self.assertIn("1 modes grow", text)

    def test_mathieu_has_the_multipliers_of_an_integration(self):
        text = run(self.built / "mathieu")
        for q in (0.1, 0.5):
            def rates(t, y, q=q):
                return [y[1], -0.1 * y[1] - (1.0 - 2.0 * q * math.cos(2.0 * t)) * y[0]]
            columns = [solve_ivp(rates, (0.0, math.pi), start, rtol=1e-11, atol=1e-13).y[:, -1]
                       for start in ([1.0, 0.0], [0.0, 1.0])]
            wanted = sorted(numpy.linalg.eigvals(numpy.array(columns).T), key=lambda mu: mu.real)
            found = sorted((complex(float(a), float(b)) for a, b in re.findall(
                rf"q = {q}: multiplier (\S+) (\S+)i", text)), key=lambda mu: mu.real)
            self.assertGreaterEqual(len(found), 1)
            for mu in found:
                self.assertLess(min(abs(mu - other) for other in wanted), 2e-6)

    def test_a_component_of_ones_own_has_its_roots(self):
        rows, text = self.found("component", r"J (\S+) kg m\^2, tau (\S+) s, c (\S+) N")
        inertia, lag, slope = rows[0]
        root = (-1.0 + cmath.sqrt(1.0 - 4.0 * lag * slope / inertia)) / (2.0 * lag)
        modes = [complex(float(a), float(b)) for a, b in re.findall(r"(\S+) (\S+)i 1/s", text)]
        self.assertLess(min(abs(mode - root) for mode in modes), 1e-8 * abs(root))

    def test_a_transient_is_observed_in_a_petsc_of_the_callers(self):
        table, text = self.found("transient", r"(\S+) s +(\S+) rpm +(\S+) kN m")
        inertia = float(re.search(r"J (\S+) kg", text).group(1))
        self.assertEqual(len(table), 21)
        brake = 0.5 + 0.3 * inertia / 80.0
        self.assertAlmostEqual(float(re.search(r"brake at (\S+) s", text).group(1)), brake,
                               delta=1e-6)
        for t, speed, torque in table:
            exact = 6.0 if t <= 0.5 else 6.0 + 80.0 / inertia * (t - 0.5)
            if t > brake:
                exact = 6.3 - 220.0 / inertia * (t - brake)
            # The brake's torque is smooth about rest, less by (0.01 / speed)^2 / 2.
            self.assertAlmostEqual(speed * math.pi / 30.0, exact, delta=1e-4)
            self.assertAlmostEqual(torque, 0.08 if t <= 0.5 else 0.0, delta=1e-9)
        self.assertIn("PETSc runs on", text)

    def test_only_names_of_the_library_are_seen(self):
        library = next((self.tree / "lib").rglob("libsamara.so"))
        self.assertTrue(library.is_symlink())
        symbols = run("nm", "-DC", "--defined-only", library).splitlines()
        names = [line.split(" ", 2)[2] for line in symbols if " " in line]
        strangers = [name for name in names
                     if "samara::" not in name and not name.startswith("SAMARA_")]
        self.assertEqual(strangers, [])
        self.assertTrue(all("@@SAMARA_" in name or name.startswith("SAMARA_") for name in names))
        self.assertGreater(len(names), 200)


if __name__ == "__main__":
    unittest.main()
