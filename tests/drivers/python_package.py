"""The Python package: results as labelled arrays, runs, cases, pictures; and samara plot."""

import ast
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import BASELINE, PROGRAM, SOURCE, ProgramTest, wait_until_it_stands  # noqa: E402

os.environ["SAMARA"] = PROGRAM
sys.path.insert(0, str(SOURCE / "python"))
import samara  # noqa: E402

QUICK = {"blades.elements": 2, "tower.elements": 2, "floquet.steps": 120}


class Package(ProgramTest):
    def test_results_are_labelled_and_have_units(self):
        result = samara.run(BASELINE, "floquet", set=QUICK)
        self.assertIn("floquet", result)
        frequency = result["floquet"]["frequency_hz"]
        self.assertEqual(frequency.dims, ("mode",))
        self.assertEqual(frequency.attrs["unit"], "Hz")
        with h5py.File(result.path) as file:
            numpy.testing.assert_array_equal(frequency.values, file["floquet/frequency_hz"][:])
        exponents = samara.result.complex_of(result.modes["exponents"])
        numpy.testing.assert_allclose(abs(exponents.imag), 2 * numpy.pi * frequency, rtol=1e-12)
        names = list(result["floquet"]["label"].values)
        self.assertTrue(any("tower fore-aft" in name for name in names))
        self.assertIn("--set", result.command_line)
        self.assertTrue(result.case.startswith("# --set blades.elements=2\n"))
        with self.assertRaisesRegex(KeyError, "no /campbell"):
            result["campbell"]
        with self.assertRaisesRegex(ValueError, "no result of samara"):
            path = self.folder / "other.h5"
            h5py.File(path, "w").close()
            samara.open_result(path)

    def test_errors_of_the_program_are_exceptions(self):
        with self.assertRaisesRegex(samara.ProgramError, "did you mean") as caught:
            samara.run(BASELINE, "floquet", set={"blades.elemnts": 2})
        self.assertEqual(caught.exception.code, 2)
        run = samara.run(BASELINE, "campbell", set=QUICK, sweep=("gravity", [0, 1e7]), check=False)
        self.assertTrue(str(run["campbell"]["stability"].values[1]).startswith("failed"))
        with self.assertRaises(samara.ProgramError) as caught:
            samara.run(BASELINE, "campbell", set=QUICK, sweep=("gravity", [0, 1e7]))
        self.assertEqual(caught.exception.code, 3)
        self.assertIn("campbell", caught.exception.result)

    def test_cases_are_objects(self):
        case = samara.Case.read(SOURCE / "inputs/lee2002/article_mesh.yaml")
        case.validate()
        case["blades.elements"] = 2
        case["tower.elements"] = 2
        case["floquet.steps"] = 120
        self.assertIn("shaft.speed", case)
        self.assertNotIn("shaft.sped", case)
        one = samara.run(case, "floquet", output=self.folder / "one.h5")
        other = samara.run(BASELINE, "floquet", set=QUICK)
        numpy.testing.assert_array_equal(one["floquet"]["exponents"], other["floquet"]["exponents"])
        self.assertEqual(list(case.folder.glob(".samara_*")), [])
        wrong = case.copy()
        wrong["blades.elemnts"] = 3
        wrong["gravity"] = "much"
        with self.assertRaises(samara.CaseError) as caught:
            wrong.validate()
        text = str(caught.exception)
        self.assertIn("elemnts", text)
        self.assertIn("gravity", text)
        self.assertNotIn("blades.elemnts", case)

    def plot(self, *arguments):
        return subprocess.run([PROGRAM, "plot", *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, check=False)

    def test_pictures(self):
        self.succeed("campbell", BASELINE, *self.settings(), "--sweep", "shaft.speed=1:3:0.5", "-o",
                     "c.h5")
        run = self.plot("c.h5", "-o", "c.svg")
        self.assertEqual(run.returncode, 0, run.stderr)
        text = (self.folder / "c.svg").read_text(encoding="utf-8")
        for word in ("tower fore-aft", "blade flap symmetric", "damping ratio [%]", "shaft.speed", "[Hz]", "2P"):
            self.assertIn(word, text)
        # The drawn line is that of the file: its first and last points are at its frequencies.
        figure = samara.plot.campbell(samara.open_result(self.folder / "c.h5"), frame="own")
        with h5py.File(self.folder / "c.h5") as file:
            names = list(file["campbell/mode"].asstr()[:])
            own = file["campbell/frequency_hz"][:]
        drawn = {line.get_label(): line for line in figure.axes[0].get_lines()}
        for name in ("tower fore-aft", "blade flap symmetric"):
            label = next(found for found in names if name in found)
            numpy.testing.assert_array_equal(drawn[label].get_ydata(), own[names.index(label)])
        # Pictures are drawn whatever becomes of the lines that name them.
        for end, code, said in ((">/dev/full", 1, "samara: standard output cannot be written\n"),
                                (">&-", 1, "samara: standard output cannot be written\n"),
                                ("| true; exit ${PIPESTATUS[0]}", 141, "")):
            done = subprocess.run(["bash", "-c", f"{PROGRAM} plot c.h5 -o said.svg {end}"], cwd=self.folder,
                                  capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (code, said), end)
            (self.folder / "said.svg").unlink()
        # While the program and then the interpreter start, while modules are loaded, and while it draws.
        for delay in (0.0, 0.04, 0.08, 0.1, 0.15, 0.3, 0.6, 1.0):
            with self.subTest(delay=delay):
                run = subprocess.Popen([PROGRAM, "plot", "c.h5", "-o", "late.svg"], cwd=self.folder,
                                       stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
                wait_until_it_stands(run)
                time.sleep(delay)
                run.send_signal(signal.SIGINT)
                error = run.communicate()[1]
                if run.returncode != 0:  # not yet done
                    self.assertEqual((run.returncode, error), (130, "samara: interrupted\n"))
        # The band along a line is as wide as the share of the mode's own harmonic.
        with h5py.File(self.folder / "c.h5") as file:
            own_harmonic = list(file["campbell/harmonic"][:]).index(0)
            first = file["campbell/participation"][0, :, own_harmonic]
        widths = figure.axes[0].collections[0].get_linewidths()
        numpy.testing.assert_allclose(numpy.asarray(widths) / samara.plot.WIDEST, (first[1:] + first[:-1]) / 2)
        self.assertIn("*: frame of the part",  # two blades have no single frequency in the fixed frame
                      samara.plot.campbell(samara.open_result(self.folder / "c.h5")).axes[0].get_ylabel())
        self.succeed("floquet", BASELINE, *self.settings(), "-o", "f.h5")
        run = self.plot("f.h5")
        self.assertEqual(run.stdout, "picture: f_multipliers.svg\npicture: f_spanwise.svg\n", run.stderr)
        for ending in ("png", "pdf"):
            self.assertEqual(self.plot("f.h5", "multipliers", "-o", f"f.{ending}").returncode, 0)
            self.assertGreater((self.folder / f"f.{ending}").stat().st_size, 5000)
        self.succeed("transient", BASELINE, *self.settings(), "--set",
                     "transient={duration: 2, step: 0.01}", "-o", "t.h5")
        run = self.plot("t.h5", "series", "--channels", "TwrBsMyt,YawPzn", "-o", "t.svg")
        self.assertIn("no channel YawPzn", run.stderr)
        run = self.plot("t.h5", "series", "--channels", "TwrBsMyt", "-o", "t.svg")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("TwrBsMyt [kN-m]", re.sub(r"[·*]", "-", (self.folder / "t.svg").read_text()))

    def settings(self):
        return [word for key, value in QUICK.items() for word in ("--set", f"{key}={value}")]

    def test_pictures_of_the_air(self):
        case = SOURCE / "inputs/nrel5mw/land.yaml"
        coarse = ["--set", "blades.elements=1", "--set", "blades.order=3", "--set",
                  "tower.elements=1", "--set", "tower.order=3", "--set", "wind.speed=8"]
        self.succeed("trim", case, *coarse, "-o", "t.h5")
        run = self.plot("t.h5")
        self.assertEqual(run.stdout, "picture: t_spanwise.svg\npicture: t_azimuth.svg\n", run.stderr)
        self.succeed("operate", case, *coarse, "--set", "operation.wind_speeds=[8, 9]", "-o", "o.h5")
        run = self.plot("o.h5")
        self.assertEqual(run.stdout, "picture: o_operation.svg\n", run.stderr)
        self.assertIn("wind speed [m/s]", (self.folder / "o_operation.svg").read_text())

    def test_units_of_pictures_are_those_of_the_file(self):
        self.succeed("campbell", BASELINE, *self.settings(), "--sweep", "shaft.speed=1:2:1", "-o", "c.h5")
        self.succeed("floquet", BASELINE, *self.settings(), "--set", "gravity=9.81", "-o", "f.h5")
        self.succeed("transient", BASELINE, *self.settings(), "--set", "transient={duration: 1, step: 0.01}", "-o", "t.h5")

        def labels(name, kind, **units):
            """Texts of the picture of a result whose datasets have other units."""
            with h5py.File(self.folder / name, "r+") as file:
                for dataset, unit in units.items():
                    file[dataset.replace("__", "/")].attrs["unit"] = unit
            function = samara.plot.ON_REQUEST.get(kind) or samara.plot.KINDS[kind][0]
            figure = function(samara.open_result(self.folder / name))
            figure.savefig(self.folder / "labels.svg")
            return (self.folder / "labels.svg").read_text(encoding="utf-8")

        self.assertIn("frequency, frame of the part [ppm]", samara.plot.campbell(
            self.with_unit("c.h5", "campbell/frequency_hz", "ppm"), frame="own").axes[0].get_ylabel())
        text = labels("c.h5", "campbell", campbell__fixed_frame_frequency_hz="1/h", campbell__damping_ratio="dB")
        self.assertIn("[1/h]", text)
        self.assertIn("damping ratio [dB]", text)
        self.assertIn("frequency [Hz]", labels("t.h5", "series"))
        self.assertIn("frequency [1/min]", labels("t.h5", "series", transient__time="min"))
        self.assertIn("azimuth of blade 1 [deg]", labels("f.h5", "azimuth"))
        self.assertIn("azimuth of blade 1 [turns]", labels("f.h5", "azimuth", model__azimuth="turns"))
        text = labels("f.h5", "shapes", floquet__node_motion="ft, turns", floquet__frequency_hz="bpm", geometry__azimuth="gon")
        for words in ("blade in plane [ft]", "blade torsion [turns]", "tower fore-aft [ft]", "joints [turns]", " bpm = ",
                      "azimuth of blade 1 [gon]", "at azimuth 0 gon", "damping ratio"):
            self.assertIn(words, text)
        text = labels("f.h5", "convergence", floquet__error="ppm")
        self.assertIn("frequency [bpm]", text)
        self.assertIn("[ppm]", text)
        text = labels("f.h5", "spanwise", trim__blades__F1="kN", trim__tower__height="ft")
        self.assertIn("blade F1 [kN]", text)
        self.assertIn("height [ft]", text)

    def with_unit(self, name, dataset, unit):
        with h5py.File(self.folder / name, "r+") as file:
            file[dataset].attrs["unit"] = unit
        return samara.open_result(self.folder / name)

    def test_no_unit_is_typed_in_the_code_of_pictures(self):
        """Units in brackets, and the names of units in other texts. The tables of conversions have them alone."""
        tree = ast.parse((SOURCE / "python/samara/plot.py").read_text(encoding="utf-8"))
        documents = {id(node.body[0].value) for node in ast.walk(tree) if isinstance(node, (ast.Module, ast.FunctionDef, ast.ClassDef))
                     and isinstance(node.body[0], ast.Expr)}
        texts = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)
                 and id(node) not in documents]
        self.assertGreater(len(texts), 200)

        def typed(text):
            return re.search(r"\[(?!KIND\])[^\]\[]+\]", text) or re.search(r"[ \[](Hz|deg|rad|rpm|m|s|N|kN|N m|%)([ \],;:)]|$)", text)

        for text in ("frequency [Hz]", "damping ratio [%]", "blade tips [m]\nsolid", "station [-]", " Hz", "angle in deg, "):
            self.assertTrue(typed(text), text)
        self.assertEqual([text for text in texts if typed(text)], [])

    def test_wrong_arguments_of_plot(self):
        self.succeed("trim", BASELINE, *self.settings(), "-o", "trim.h5")
        self.succeed("static", BASELINE, *self.settings(), "--set", "shaft.speed=0", "-o", "static.h5")
        for arguments, words in ((["none.h5"], "none.h5"), (["static.h5"], "nothing to draw"),
                                 (["trim.h5", "campbel"], "they are campbell"),
                                 (["static.h5", "campbell"], "nothing to draw"),
                                 (["trim.h5", "campbell"], "no picture campbell; it allows spanwise"),
                                 (["trim.h5", "-o", "x.gif"], "ends in .png, .svg, .pdf")):
            run = self.plot(*arguments)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertEqual(len(run.stderr.splitlines()), 1, run.stderr)
            self.assertIn(words, run.stderr)
        self.assertEqual(self.plot("--help").returncode, 0)
        self.refuse("--set", "a=1", "plot", "x.h5", words="the command comes first")

    def test_a_missing_module_is_named(self):
        self.succeed("modes", SOURCE / "inputs/beam/rotating.yaml", "-o", "run.h5")
        (self.folder / "lib").mkdir()
        (self.folder / "lib/h5py.py").write_text(
            "raise ModuleNotFoundError(\"No module named 'h5py'\", name='h5py')\n", encoding="utf-8")
        os.environ["PYTHONPATH"] = str(self.folder / "lib")
        self.addCleanup(os.environ.pop, "PYTHONPATH")
        for command in ("plot", "report"):
            self.refuse(command, "run.h5", words=["module h5py is not installed", "python3-h5py"])

    def test_it_can_be_installed(self):
        place = self.folder / "environment"
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", place], check=True)
        # A copy: the installation writes beside the sources.
        source = self.folder / "python"
        for path in (SOURCE / "python").rglob("*"):
            if path.suffix in (".py", ".toml"):
                self.write(f"python/{path.relative_to(SOURCE / 'python')}", path.read_bytes())
        subprocess.run([place / "bin/pip", "install", "--quiet", "--no-build-isolation", "--no-deps",
                        "--disable-pip-version-check", source], check=True, capture_output=True)
        clean = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        done = subprocess.run([place / "bin/python", "-c", "import samara; print(samara.__file__)"],
                              env=clean, cwd="/", text=True, capture_output=True, check=True)
        self.assertIn(str(place), done.stdout)


if __name__ == "__main__":
    unittest.main()
