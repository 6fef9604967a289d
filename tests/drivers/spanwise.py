"""Deflections and internal loads along the beams in /trim/blades and /trim/tower: closed forms, the printed table, several
ranks, and the picture."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import MINIMAL, PROGRAM, SOURCE, ProgramTest  # noqa: E402

os.environ["SAMARA"] = PROGRAM
sys.path.insert(0, str(SOURCE / "python"))
import samara  # noqa: E402

LENGTH, WEIGHT, STIFFNESS, TORSION, SPEED = 10.0, 0.1, 1e4, 8e3, 6.0  # of MINIMAL, with a gravity of 0.1 m/s^2
ROTATING = SOURCE / "inputs/beam/rotating.yaml"
LAND = [SOURCE / "inputs/nrel5mw/land.yaml", "--set", "blades.elements=2", "--set", "blades.element_lengths=[1,1]", "--set",
        "blades.order=3", "--set", "tower.order=3", "--set", "wind.speed=15", "--set", "shaft.speed_rpm=12.1", "--set",
        "blades.pitch_deg=10", "--set", "trim.harmonics=4"]
QUANTITIES = ["out_of_plane", "in_plane", "twist", "F1", "F2", "F3", "M1", "M2", "M3"]
# Strains of the closed forms below: 2e-5 axially, and slopes of 2e-3 in bending, which count by their squares.
STRAIN = 5e-5
# A table has four digits.
PRINTED = 6e-4


class Spanwise(ProgramTest):
    def trim(self, *arguments, ranks=None):
        name = f"{len(list(self.folder.glob('*.h5')))}.h5"
        self.text = self.succeed("trim", *arguments, "-o", name, ranks=ranks).stdout
        return samara.open_result(self.folder / name)

    def beam(self, *settings):
        """The blades of MINIMAL at rest or turning."""
        case = self.write("beam.yaml", MINIMAL)
        words = [word for setting in ("blades.elements=4", "blades.order=3", *settings) for word in ("--set", setting)]
        return self.trim(case, *words)["trim/blades"]

    def near(self, data, name, expected, scale=None):
        found = data[name].values[0]
        scale = scale or abs(numpy.asarray(expected)).max()
        self.assertLess(abs(found - expected).max(), STRAIN * scale, (name, found, expected))

    def zero(self, data, names, scale):
        for name in names:
            self.assertLess(abs(data[name].values).max(), 1e-9 * scale, name)

    def test_tension_of_a_rotating_beam(self):
        """F1 = m Omega^2 (L^2 - r^2) / 2."""
        data = self.trim(ROTATING)["trim/blades"]
        radius = data["radius"].values
        numpy.testing.assert_allclose(radius, LENGTH * data["station"].values, atol=1e-12)
        self.assertEqual((radius[0], radius[-1]), (0.0, LENGTH))
        self.near(data, "F1", SPEED**2 * (LENGTH**2 - radius**2) / 2)
        self.zero(data, [name for name in QUANTITIES if name != "F1"], 1.0)
        for name in QUANTITIES:  # nothing changes with the azimuth
            for ending in ("_least", "_largest"):
                numpy.testing.assert_array_equal(data[name].values, data[name + ending].values)

    def test_a_level_cantilever_with_pitch(self):
        """The weight of the blade at azimuth 90 deg acts along +b2 at zero pitch, against in_plane. Its deflection does not
        depend on the pitch; its loads turn with the root."""
        data = self.beam("shaft.speed=0", "shaft.azimuth_deg=90", "gravity=0.1", "blades.pitch_deg=30")
        x = data["radius"].values
        rest = LENGTH - x
        self.near(data, "in_plane", -WEIGHT * x**2 * (6 * LENGTH**2 - 4 * LENGTH * x + x**2) / (24 * STIFFNESS))
        self.zero(data, ["out_of_plane"], 0.0125)
        sine, cosine = 0.5, numpy.sqrt(0.75)
        self.near(data, "F2", WEIGHT * rest * cosine)
        self.near(data, "F3", WEIGHT * rest * sine)
        self.near(data, "M2", -WEIGHT * rest**2 / 2 * sine)
        self.near(data, "M3", WEIGHT * rest**2 / 2 * cosine)
        self.zero(data, ["twist", "M1"], 1.0)

    def test_range_of_a_slow_revolution(self):
        """The weight stretches the blade below the shaft and shortens it above. Of N equally spaced instants the first one has
        the blade up, and two are pi / N beside its lowest place."""
        result = self.trim(self.write("beam.yaml", MINIMAL), "--set", "shaft.speed=1e-3", "--set", "gravity=0.1", "--set",
                           "trim.harmonics=3")
        data = result["trim/blades"]
        weight = WEIGHT * (LENGTH - data["radius"].values)
        instants = 6 * int(result["trim"].attrs["harmonics"]) + 1
        turning = 1e-6 * (LENGTH**2 - data["radius"].values ** 2) / 2
        self.near(data, "F1_least", turning - weight)
        self.near(data, "F1_largest", turning + weight * numpy.cos(numpy.pi / instants))
        self.near(data, "F1", turning, scale=1.0)
        self.near(data, "F2_largest", weight * numpy.sin(2 * numpy.pi * round(instants / 4) / instants))

    def test_a_load_at_the_tip_is_in_the_load_of_the_last_station(self):
        for follower in ("false", "true"):
            data = self.beam("shaft.speed=0", "gravity=0",
                             f"loads=[{{beam: blades, at: 1, force: [0, 0, 0.2], moment: [0.3, 0, 0], follower: {follower}}}]")
            x = data["radius"].values
            self.near(data, "F3", 0.2 + 0 * x)
            self.near(data, "M1", 0.3 + 0 * x)
            self.near(data, "M2", -0.2 * (LENGTH - x))
            self.near(data, "out_of_plane", 0.2 * x**2 * (3 * LENGTH - x) / (6 * STIFFNESS))
            self.near(data, "twist", -numpy.degrees(0.3 * x / TORSION))

    def test_root_and_ends_are_those_of_the_printed_table(self):
        result = self.trim(*LAND)
        printed = {match[1].strip(): float(match[2]) for match in re.finditer(
            r"(?m)^(.*?) +(?:N|m|N m) +(-?[\d.]+(?:e[-+]\d+)?) ", self.text)}

        def near(value, name, scale):
            self.assertLess(abs(value - printed[name]), PRINTED * scale, name)

        blade, tower = result["trim/blades"], result["trim/tower"]
        force, moment = abs(blade["F1"].values).max(), abs(blade["M2"].values).max()
        for data, part, words in ((blade, "blade 1 root", ("b1 (axial)", "b2", "b3", "b1 (torsion)", "b2 (flap)", "b3 (lead-lag)")),
                                  (tower, "tower root", ("n3 (vertical)", "n1 (side-side)", "n2 (downwind)", "n3 (torsion)",
                                                         "n1 (fore-aft)", "n2 (side-side)"))):
            for i, word in enumerate(words):
                kind, letter = ("force", "F") if i < 3 else ("moment", "M")
                at_root = data[f"{letter}{i % 3 + 1}"].values
                at_root = at_root[0, 0] if at_root.ndim == 2 else at_root[0]
                value = printed[f"{part} {kind} {word}"]
                near(at_root, f"{part} {kind} {word}", abs(value))
        tip = [printed[f"blade 1 tip along {word}"] for word in ("b2 (lead-lag)", "b3 (flap)")]
        sine, cosine = numpy.sin(numpy.radians(10)), numpy.cos(numpy.radians(10))
        # b2 and b3 of the root are turned by the pitch about -b1.
        size = numpy.hypot(*tip)
        self.assertLess(abs(blade["out_of_plane"].values[0, -1] - (cosine * tip[1] - sine * tip[0])), PRINTED * size)
        self.assertLess(abs(blade["in_plane"].values[0, -1] + sine * tip[1] + cosine * tip[0]), PRINTED * size)
        near(tower["fore_aft"].values[-1], "tower top along n2 (downwind)", 0.3)
        near(-tower["side_side"].values[-1], "tower top along n1 (side-side)", 0.1)
        # The blades are equal over a revolution.
        for name in QUANTITIES:
            scale = force if name[0] == "F" else moment if name[0] == "M" else 1.0
            self.assertLess(abs(blade[name].values - blade[name].values[0]).max(), 1e-6 * scale, name)
            for data in (blade, tower):
                name = {"out_of_plane": "fore_aft", "in_plane": "side_side"}.get(name, name) if data is tower else name
                self.assertTrue((data[name + "_least"].values <= data[name].values + 1e-12 * scale).all(), name)
                self.assertTrue((data[name].values <= data[name + "_largest"].values + 1e-12 * scale).all(), name)
        # The stations between root and tip are those of the air.
        numpy.testing.assert_allclose(blade["radius"].values[1:-1], result["trim/air"]["radius"].values, rtol=1e-14)
        self.assertEqual(tower["height"].values[-1], 87.6)
        for data in (blade, tower):
            for name in data:
                for attribute in ("unit", "frame", "description"):
                    self.assertTrue(data[name].attrs[attribute], name)
        self.assertEqual([blade[name].attrs["unit"] for name in ("F1", "M1", "out_of_plane", "twist")], ["N", "N m", "m", "deg"])

    def test_every_rank_count_writes_the_same(self):
        """A mesh that several ranks share; sums round in another order."""
        results = [self.trim(ROTATING, *[word for setting in ("blades.elements=320", "blades.order=1", "gravity=9.81",
                                                              "trim.harmonics=3") for word in ("--set", setting)], ranks=ranks)
                   for ranks in (1, 2, 3)]
        first = results[0]["trim/blades"]
        for other in results[1:]:
            data = other["trim/blades"]
            self.assertEqual(set(data), set(first))
            for name in data:
                self.assertEqual(data[name].attrs, first[name].attrs)
                # A component that is zero has the round-off of the others.
                unit = first[name].attrs["unit"]
                alike = [abs(one.values).max() for one in first.values() if one.attrs["unit"] == unit]
                self.assertLess(abs(data[name].values - first[name].values).max(), 1e-8 * (max(alike) + 1e-3), name)

    def test_other_commands_with_a_steady_state_have_it_too(self):
        case = SOURCE / "inputs/lee2002/article_mesh.yaml"
        quick = ["--set", "blades.elements=2", "--set", "tower.elements=2", "--set", "floquet.steps=24"]
        alone = self.trim(case, *quick)
        for command, settings in (("floquet", []), ("modes", ["--parked"]), ("linearize", [])):
            name = f"{command}.h5"
            self.samara(command, case, *quick, *settings, "-o", name)
            result = samara.open_result(self.folder / name)
            for group in ("trim/blades", "trim/tower"):
                self.assertIn(group, result)
                self.assertNotIn("trim/air", result)
                if not settings:
                    numpy.testing.assert_allclose(result[group]["F1"].values, alone[group]["F1"].values, atol=1e-6)

    def test_a_tower_alone(self):
        """F1 = - m g (L - x)."""
        case = self.write("tower.yaml", MINIMAL.replace("shaft: {speed: 6}\n", "").replace("blades:", "tower:"))
        result = self.trim(case, "--set", "gravity=0.1", "--set", "tower.elements=3")
        self.assertNotIn("trim/blades", result)
        tower = result["trim/tower"]
        self.assertEqual(tower["F1"].dims, ("station",))
        weight = WEIGHT * (LENGTH - tower["height"].values)
        self.assertLess(abs(tower["F1"].values + weight).max(), STRAIN)
        self.assertIn("steady state along the tower", samara.plot.spanwise(result)._suptitle.get_text())
        self.plot(result, "-o", "tower.svg")
        self.assertIn("tower F1 [N]", (self.folder / "tower.svg").read_text(encoding="utf-8"))

    def plot(self, result, *arguments):
        run = subprocess.run([PROGRAM, "plot", result.path, "spanwise", *arguments], cwd=self.folder, text=True,
                             capture_output=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_the_picture_shows_what_the_file_has(self):
        result = self.trim(*LAND)
        figure = samara.plot.spanwise(result)
        panels = {axes.get_ylabel(): axes for axes in figure.axes if axes.get_ylabel()}
        for label in ("blade out of plane [m]", "blade in plane [m]", "blade twist [deg]", "blade F1 [N]", "blade M2 [N m]",
                      "tower fore-aft [m]", "tower side-side [m]", "tower M2 [N m]", "angle of attack [deg]", "Cl"):
            self.assertIn(label, panels)
        self.assertEqual(len(panels), 9 + 9 + 11)
        blade = result["trim/blades"]
        lines = panels["blade M2 [N m]"].get_lines()
        self.assertEqual(len(lines), 3)
        numpy.testing.assert_array_equal(lines[1].get_ydata(), blade["M2"].values[1])
        numpy.testing.assert_array_equal(lines[1].get_xdata(), blade["radius"].values)
        band = panels["blade M2 [N m]"].collections[1].get_paths()[0].vertices
        self.assertAlmostEqual(band[:, 1].min(), blade["M2_least"].values[1].min())
        self.assertEqual(panels["tower F1 [N]"].get_xlabel(), "height [m]")
        for path in (ROTATING, SOURCE / "inputs/lee2002/baseline.yaml"):  # without air
            self.plot(self.trim(path), "-o", "picture.svg")
            self.assertIn("blade F1 [N]", (self.folder / "picture.svg").read_text(encoding="utf-8"))
        figure = samara.plot.spanwise(self.trim(SOURCE / "inputs/lee2002/baseline.yaml"))
        shear = next(axes for axes in figure.axes if axes.get_ylabel() == "tower F2 [N]")
        self.assertGreater(numpy.ptp(shear.get_ylim()), 1e-4)  # round-off is a straight line


if __name__ == "__main__":
    unittest.main()
