"""Motions of nodes in modes and time series, and pictures: samara plot RESULT.h5 shapes, and convergence."""

import math
import os
import pathlib
import subprocess
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import PROGRAM, SOURCE, ProgramTest  # noqa: E402

os.environ["SAMARA"] = PROGRAM
sys.path.insert(0, str(SOURCE / "python"))
import samara  # noqa: E402
from samara import shapes  # noqa: E402

BASELINE = SOURCE / "inputs/lee2002/baseline.yaml"
IN_WIND = SOURCE / "inputs/nrel5mw/land.yaml"
COARSE = ["--set", "blades.elements=1", "--set", "blades.order=4", "--set", "tower.elements=1", "--set",
          "tower.order=3"]
SINGLE = 2e-5  # of the largest value: shapes are single precision, and differences of large ones are small

# Roots of cos x cosh x = -1: a clamped and free beam of Euler and Bernoulli.
ROOTS = (1.8751040687, 4.6940911330, 7.8547574382)


def cantilever(root, place):
    """Its mode, 1 at the free end; place: 0 to 1."""
    sigma = (math.cosh(root) + math.cos(root)) / (math.sinh(root) + math.sin(root))
    x = root * place
    shape = numpy.cosh(x) - numpy.cos(x) - sigma * (numpy.sinh(x) - numpy.sin(x))
    end = math.cosh(root) - math.cos(root) - sigma * (math.sinh(root) - math.sin(root))
    return shape / end


class Motions(ProgramTest):
    def unknowns(self, path, names):
        """Unknowns of the resolved modes over the instants [mode, instant, name], with the wave of the harmonic."""
        with h5py.File(path) as file:
            all_names = list(file["model/unknowns/name"].asstr()[:])
            modes = file["floquet/modes"][:]
            columns = [all_names.index(name) for name in names]
            values = modes[:, :, columns, 0] + 1j * modes[:, :, columns, 1]
            speed = file["floquet"].attrs["rotor_speed"]
            waves = numpy.exp(-1j * speed * numpy.outer(file["floquet/harmonic"][:], file["floquet/mode_times"][:]))
        return values * waves[:, :, None]

    def check_tips(self, path, torsion_tolerance):
        """Node motions minus the motion of the root are the unknowns of the tip, in the root's axes."""
        modes = shapes.modes_of(samara.open_result(path))
        self.assertGreater(len(modes), 5)
        for blade in (1, 2):
            tips = self.unknowns(path, [f"blade {blade} tip {name}" for name in ("u3", "u2", "theta1")])
            for number, mode in modes.items():
                found = mode.deflections(f"blade {blade}")[:, -1]
                wanted = tips[number - 1]
                # Of a rigid-body motion the tip's deflection is the small difference of large ones.
                scale = abs(mode.shape[..., :3]).max()
                numpy.testing.assert_allclose(found[:, :2], wanted[:, :2], atol=SINGLE * scale, err_msg=mode.label)
                # theta1 is about the root's axis, torsion about the bent blade's tangent.
                numpy.testing.assert_allclose(found[:, 2], wanted[:, 2],
                                              atol=torsion_tolerance * abs(mode.shape).max(), err_msg=mode.label)

    def test_deflections_are_those_of_the_unknowns(self):
        self.succeed("floquet", BASELINE, "-o", "f.h5")
        self.check_tips(self.folder / "f.h5", SINGLE)
        path = self.folder / "f.h5"
        joints = self.unknowns(path, ["yaw angle", "teeter angle"])
        tops = self.unknowns(path, [f"tower top {name}" for name in ("u3", "u2", "theta1")])
        for number, mode in shapes.modes_of(samara.open_result(path)).items():
            angles = mode.joints()
            scale = abs(mode.shape).max()
            for column, name in enumerate(("yaw", "teeter")):
                numpy.testing.assert_allclose(angles[name], joints[number - 1, :, column], atol=SINGLE * scale,
                                              err_msg=mode.label)
            # b3 of the tower is x; b2 is -y.
            wanted = tops[number - 1] * [1.0, -1.0, 1.0]
            numpy.testing.assert_allclose(mode.deflections("tower")[:, -1], wanted, atol=SINGLE * scale)

    def test_angles_of_hinges_are_those_of_the_unknowns(self):
        hinges = ", ".join(f"{{axis: {axis}, joint: free, stiffness: {stiffness}}}" for axis, stiffness in
                           (("lag", 4e6), ("flap", 3e6), ("pitch", 2e6)))
        self.succeed("floquet", BASELINE, "--set", f"blades.hinges=[{hinges}]", "-o", "h.h5")
        path = self.folder / "h.h5"
        axes = ("flap", "lag", "pitch")
        for blade in (1, 2):
            unknowns = self.unknowns(path, [f"blade {blade} {axis} hinge angle" for axis in axes])
            for number, mode in shapes.modes_of(samara.open_result(path)).items():
                angles = mode.joints()
                for column, axis in enumerate(axes):
                    numpy.testing.assert_allclose(angles[f"blade {blade} {axis}"], unknowns[number - 1, :, column],
                                                  atol=SINGLE * abs(mode.shape).max(), err_msg=f"{mode.label}, {axis}")

    def test_deflections_of_bent_blades_in_wind(self):
        self.succeed("floquet", IN_WIND, *COARSE, "-o", "w.h5")
        self.check_tips(self.folder / "w.h5", 0.01)

    def test_modes_between_instants_are_those_of_a_run_with_other_instants(self):
        # Both runs have errors of the step below 1e-6 in these modes.
        self.succeed("floquet", BASELINE, "--set", "floquet.steps=44", "-o", "a.h5")
        self.succeed("floquet", BASELINE, "--set", "floquet.steps=144", "-o", "b.h5")
        one = shapes.modes_of(samara.open_result(self.folder / "a.h5"))
        other = shapes.modes_of(samara.open_result(self.folder / "b.h5"))
        names = {mode.label: mode for mode in other.values()}
        for number in (6, 7, 8, 9, 10):  # harmonics 0, 4, 3, 4, 11
            mode = one[number]
            label = mode.label if mode.label in names else f"{mode.label} 1"
            twin = names[label]
            turbine = twin.turbine
            self.assertNotEqual(len(mode.turbine.times), len(turbine.times))
            shape = numpy.array([mode.periodic_part(t) for t in turbine.times])
            factor = numpy.vdot(shape, twin.shape) / numpy.vdot(shape, shape)
            error = abs(factor * shape - twin.shape).max() / abs(twin.shape).max()
            self.assertLess(error, 2e-3, mode.label)
            places = numpy.array([mode.turbine.place(t) for t in turbine.times])
            numpy.testing.assert_allclose(places, turbine.places, atol=1e-9)

    def test_series_through_uneven_instants_are_exact(self):
        phases = numpy.array([0, 2, 3, 5, 7, 8, 10]) / 11.6
        wave = lambda s: 1 - 2j + numpy.cos(6 * math.pi * s + 0.4) + 1j * numpy.sin(2 * math.pi * s)  # noqa: E731
        for turns in (0.0, 0.31, 1.77):
            self.assertAlmostEqual(shapes.periodic(wave(phases), phases, turns), wave(turns), places=12)

    def test_rotations_of_vectors(self):
        angle = 0.7
        turned = shapes.turned(numpy.array([[1.0, 0.0, 2.0], [1.0, 2.0, 3.0]]), numpy.array([[0, 0, angle], [0, 0, 0]]))
        numpy.testing.assert_allclose(turned, [[math.cos(angle), math.sin(angle), 2.0], [1.0, 2.0, 3.0]], atol=1e-14)


    def test_quaternions_and_rotation_vectors(self):
        for angle in (0.0, 1e-9, 0.3, math.pi - 1e-6, math.pi):
            vector = angle * numpy.array([0.6, 0.0, -0.8])
            turn = shapes.quaternions(vector)
            numpy.testing.assert_allclose(turn, [*(math.sin(angle / 2) * numpy.array([0.6, 0.0, -0.8])),
                                                 math.cos(angle / 2)], atol=1e-15)
            numpy.testing.assert_allclose(shapes.rotation_vectors(turn), vector, atol=1e-9)
        # A turn by 200 degrees is one by -160 degrees.
        numpy.testing.assert_allclose(shapes.rotation_vectors(shapes.quaternions(numpy.radians([0.0, 200.0, 0.0]))),
                                      numpy.radians([0.0, -160.0, 0.0]), atol=1e-14)
        axes = shapes.axes_of(numpy.array([[0.0, 0.0, 0.5 * math.pi]]))
        numpy.testing.assert_allclose(axes[0], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-15)


class TimeSeries(ProgramTest):
    """Places of nodes in samara transient."""

    def run_of(self, name, *settings, step=0.01, every=0.01, duration=1.0, more=""):
        given = f"transient={{duration: {duration}, step: {step}, {more}output: {{every: {every}, places: true}}}}"
        self.succeed("transient", BASELINE, *settings, "--set", given, "-o", name)
        result = samara.open_result(self.folder / name)
        return result, shapes.Transient(result, shapes.Turbine(result))

    def test_the_first_row_is_the_start(self):
        result, transient = self.run_of("x.h5", "--set", "gravity=9.81", duration=0.2)
        turbine = shapes.Turbine(result)
        numpy.testing.assert_allclose(transient.places[0], turbine.places[0], atol=1e-12)
        numpy.testing.assert_allclose(shapes.axes_of(transient.rotations[0]), turbine.all_axes[0], atol=1e-12)

    def test_values_between_rows_are_of_second_order(self):
        """Blades that bend under their weight, the rotor starting without strain: compared with rows of the same steps."""
        begin = ("--set", "gravity=9.81")
        exact = self.run_of("fine.h5", *begin, step=0.005, every=0.005, more="start: undeformed, ")[1]
        errors = []
        for every in (0.04, 0.02):
            rows = self.run_of(f"r{round(1000 * every)}.h5", *begin, step=0.005, every=every,
                               more="start: undeformed, ")[1]
            found = [rows.at(t) for t in exact.times]
            errors.append([abs(numpy.array([place for place, _ in found]) - exact.places).max(),
                           abs(numpy.array([shapes.axes_of(turn) - shapes.axes_of(own) for (_, turn), own in
                                            zip(found, exact.rotations)])).max()])
            for row, t in enumerate(rows.times):
                numpy.testing.assert_array_equal(rows.at(t)[0], rows.places[row])
        self.assertGreater(numpy.ptp(exact.deflections(exact.places[-1], exact.rotations[-1])), 1e-3)
        for coarse, fine in zip(*errors):
            self.assertGreater(coarse / fine, 3.0)
        # On the chord of its arc the tip would be 0.074 m away, radius * (1 - cos(half the turn)).
        self.assertLess(errors[0][0], 0.01)
        print(f"errors between rows: places {errors[0][0]:.2e} and {errors[1][0]:.2e} m, axes {errors[0][1]:.2e} and "
              f"{errors[1][1]:.2e}")

    def test_deflections_of_a_part_are_those_of_its_channels(self):
        result, transient = self.run_of("x.h5", "--set", "gravity=9.81", more="start: undeformed, ")
        turbine = shapes.Turbine(result)
        names = list(result["transient"]["channel_name"].values)
        tip = turbine.parts["blade 1"][-1]
        own = numpy.array([transient.deflections(place, turn) for place, turn in zip(transient.places, transient.rotations)])
        root = turbine.parts["blade 1"][0]
        axes = numpy.array([shapes.axes_of(turn)[root] for turn in transient.rotations])
        local = numpy.einsum("ric,rc->ri", axes, own[:, tip])
        for axis, sense, name in ((2, 1, "TipDxb1"), (1, -1, "TipDyb1")):  # b3 is x_b, b2 is -y_b
            channel = result["transient"]["values"].values[:, names.index(name)]
            moved = channel - channel[0]
            self.assertGreater(numpy.ptp(moved), 1e-3)
            numpy.testing.assert_allclose(sense * local[:, axis], moved, atol=1e-9, err_msg=name)

    def test_a_result_without_places_is_refused(self):
        self.succeed("transient", BASELINE, "--set", "transient={duration: 0.1, step: 0.01}", "-o", "x.h5")
        with self.assertRaisesRegex(shapes.ShapeError, "no places of nodes .*transient.output.places=true"):
            shapes.Turbine(samara.open_result(self.folder / "x.h5"))

    def test_pictures_leave_out_the_channels_of_nodes(self):
        self.succeed("transient", BASELINE, "--set", "transient={duration: 0.1, step: 0.01, output: {channels: [RotSpeed, "
                     "Azimuth], places: true}}", "-o", "x.h5")
        result = samara.open_result(self.folder / "x.h5")
        self.assertEqual(len(samara.plot.series(result).axes), 4)  # two channels, each with its spectrum
        self.assertEqual(len(samara.plot.series(result, channels=["Node3Px"]).axes), 2)


class Cantilever(ProgramTest):
    def test_modes_of_a_uniform_beam(self):
        self.succeed("new", "beam", "beam.yaml")
        self.succeed("modes", "beam.yaml", "--parked", "-o", "beam.h5")
        modes = shapes.modes_of(samara.open_result(self.folder / "beam.h5"))
        # Of templates/beam.yaml: 10 m, 1 kg/m, 1e4 N m^2 out of the plane and 4e4 N m^2 in it.
        for kind, column, rigidity in (("flap", 0, 1e4), ("lead-lag", 1, 4e4)):
            for number, root in zip(("1st", "2nd", "3rd", "4th"), ROOTS):
                mode = shapes.find_mode(modes, "", label=f"{number} blade {kind}")
                frequency = (root / 10.0) ** 2 * math.sqrt(rigidity / 1.0) / (2.0 * math.pi)
                self.assertAlmostEqual(mode.frequency_hz / frequency, 1.0, delta=0.01)
                nodes = mode.turbine.parts["blade 1"]
                stations = mode.turbine.station[nodes]
                values = mode.deflections("blade 1")[0, :, column]
                end = values[-1]
                numpy.testing.assert_allclose((values / end).real, cantilever(root, stations), atol=0.01)
                slopes = mode.slopes("blade 1")[0, :, column]
                at, line = shapes.curve(stations, values / end, slopes / end, 10.0)
                numpy.testing.assert_allclose(line.real, cantilever(root, at), atol=0.01)
                others = numpy.delete(mode.deflections("blade 1")[0], column, axis=1)
                self.assertLess(abs(others).max(), 1e-4 * abs(end))

    def test_torsion_of_a_uniform_beam(self):
        self.succeed("new", "beam", "beam.yaml")
        self.succeed("modes", "beam.yaml", "--parked", "--set", "blades.sections=[{at: 0, mass: 1, inertia: [2e-4, 1e-4, "
                     "1e-4], stiffness: {EA: 1e8, GA2: 4e7, GA3: 4e7, GJ: 8, EI2: 1e6, EI3: 4e6}}]", "-o", "t.h5")
        mode = shapes.find_mode(shapes.modes_of(samara.open_result(self.folder / "t.h5")), "", label="1st blade torsion")
        self.assertAlmostEqual(mode.frequency_hz / (math.sqrt(8 / 2e-4) / 40.0), 1.0, delta=0.01)
        values = mode.normalised().deflections("blade 1")[0, :, 2]
        wanted = math.radians(10.0) * numpy.sin(0.5 * math.pi * mode.turbine.station[mode.turbine.parts["blade 1"]])
        numpy.testing.assert_allclose(values.real, wanted, atol=math.radians(0.1))
        self.assertGreater(values[-1].real, 0.0)


class Pictures(ProgramTest):
    def plot(self, *arguments):
        return subprocess.run([PROGRAM, "plot", *map(str, arguments)], cwd=self.folder, text=True,
                              capture_output=True, check=False)

    def test_pictures_of_modes(self):
        self.succeed("floquet", BASELINE, "-o", "f.h5")
        run = self.plot("f.h5", "shapes", "--modes", "8", "-o", "mode.svg")
        self.assertEqual((run.returncode, run.stdout), (0, "picture: mode.svg\n"), run.stderr)
        text = (self.folder / "mode.svg").read_text(encoding="utf-8")
        for word in ("mode 8, 1st blade lead-lag antisymmetric", "3.302 Hz = 3.447 per rev", "blade in plane [m]",
                     "blade torsion [deg]", "tower fore-aft [m]", "azimuth of blade 1 [deg]", "displacements x"):
            self.assertIn(word, text)
        run = self.plot("f.h5", "shapes", "--modes", "5,9", "-o", "m.png")
        self.assertEqual(run.stdout, "picture: m_5.png\npicture: m_9.png\n", run.stderr)
        self.assertEqual(self.plot("f.h5", "shapes", "--modes", "6", "-o", "m.pdf").returncode, 0)
        for name in ("m_5.png", "m_9.png", "m.pdf"):
            self.assertGreater((self.folder / name).stat().st_size, 10000)
        # The drawn line is that of the unknowns: the tips of the antisymmetric lead-lag, at most 1 m as a displacement.
        result = samara.open_result(self.folder / "f.h5")
        figure = samara.plot.mode_shape(result, label="1st blade lead-lag antisymmetric")
        lines = [line for line in figure.axes[1].get_lines() if line.get_label() == "blade 1"]
        with h5py.File(self.folder / "f.h5") as file:
            names = list(file["model/unknowns/name"].asstr()[:])
            columns = [names.index(f"blade {blade} tip u2") for blade in (1, 2)]
            tips = file["floquet/modes"][7, 0, columns]
        tips = tips[:, 0] + 1j * tips[:, 1]
        other = [line for line in figure.axes[1].get_lines() if line.get_label() == "blade 2"]
        drawn = [lines[0].get_ydata()[-1], other[0].get_ydata()[-1]]
        self.assertAlmostEqual(drawn[1] / drawn[0], (tips[1] / tips[0]).real, places=5)
        self.assertLess(drawn[0] * drawn[1], 0.0)

    def test_pictures_of_modes_at_rest_without_a_tower(self):
        self.succeed("new", "beam", "beam.yaml")
        self.succeed("modes", "beam.yaml", "-o", "beam.h5")
        run = self.plot("beam.h5", "shapes", "--modes", "1,2")
        self.assertEqual(run.stdout, "picture: beam_shapes_1.svg\npicture: beam_shapes_2.svg\n", run.stderr)
        text = (self.folder / "beam_shapes_1.svg").read_text(encoding="utf-8")
        self.assertIn("blade out of plane [m]", text)
        self.assertNotIn("tower", text)
        self.assertNotIn("azimuth", text)

    def test_pictures_of_convergence(self):
        self.succeed("new", "beam", "beam.yaml")
        for elements in (1, 2, 4):
            self.succeed("modes", "beam.yaml", "--set", f"blades.elements={elements}", "--set", "blades.order=2", "-o",
                         f"b{elements}.h5")
        run = self.plot("b4.h5", "b1.h5", "b2.h5", "convergence", "--first", "2", "-o", "c.svg")
        self.assertEqual((run.returncode, run.stdout), (0, "picture: c.svg\n"), run.stderr)
        text = (self.folder / "c.svg").read_text(encoding="utf-8")
        for word in ("degrees of freedom", "frequency [Hz]", "damping ratio [%]", "error [%]", "blade flap"):
            self.assertIn(word, text)
        paths = [self.folder / f"b{elements}.h5" for elements in (1, 2, 4)]
        figure = samara.plot.convergence(*map(samara.open_result, paths), first=1)
        drawn = figure.axes[0].get_lines()[0].get_xydata()
        for (size, frequency), path in zip(drawn, paths):
            with h5py.File(path) as file:
                self.assertEqual(size, file["model"].attrs["degrees_of_freedom"])
                labels = list(file["modes/label"].asstr()[:])
                self.assertEqual(frequency, file["modes/frequency_hz"][labels.index("1st blade flap")])
        run = self.plot("b4.h5", "convergence", "-o", "e.svg")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("estimated error of the exponent [%]", (self.folder / "e.svg").read_text(encoding="utf-8"))
        for steps in (24, 44):
            self.succeed("floquet", BASELINE, "--set", f"floquet.steps={steps}", "-o", f"f{steps}.h5")
        run = self.plot("f24.h5", "f44.h5", "convergence", "-o", "s.svg")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("steps of a revolution", (self.folder / "s.svg").read_text(encoding="utf-8"))
        run = self.plot("b4.h5", "b4.h5", "convergence", "-o", "x.svg")
        self.assertEqual(run.returncode, 2)
        self.assertIn("equal degrees of freedom", run.stderr)

    def test_wrong_arguments(self):
        self.succeed("trim", BASELINE, "-o", "trim.h5")
        self.succeed("floquet", BASELINE, "-o", "f.h5")
        for arguments, words in ((["trim.h5", "shapes"], "no modes; hint: samara floquet"),
                                 (["f.h5", "shapes", "--modes", "99"], "no mode 99"),
                                 (["f.h5", "shapes", "--modes", "a"], "separated by commas"),
                                 (["f.h5", "trim.h5"], "convergence only"),
                                 (["f.h5", "shape"], "they are campbell"),
                                 (["shapes"], "no result is named"),
                                 (["f.h5", "shapes", "--modes", "5", "-o", "x.gif"], "ends in .png, .svg, .pdf")):
            run = self.plot(*arguments)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertEqual(len(run.stderr.splitlines()), 1, run.stderr)
            self.assertIn(words, run.stderr)


if __name__ == "__main__":
    unittest.main()
