"""samara campbell: sweeps, lines, ranks, interruptions, failing points, wrong arguments."""

import csv
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
from program import BASELINE, LONGEST_RUN, PROGRAM, SOURCE, ProgramTest  # noqa: E402

QUICK = [part for key in ("blades.elements=2", "tower.elements=2", "floquet.steps=120")
         for part in ("--set", key)]
# For what does not depend on the modes.
QUICKEST = [part for key in ("blades.elements=1", "tower.elements=1", "floquet.steps=48")
            for part in ("--set", key)]
SPEEDS = "shaft.speed=0.5:3.5:0.5"
# Steady states of a sweep start from their neighbours: they differ by the tolerance of the trim.
SAME = 1e-7


class Campbell(ProgramTest):
    def diagram(self, name):
        with h5py.File(self.folder / name) as file:
            group = file["campbell"]
            values = {key: group[key][:] for key in group if group[key].dtype.kind == "f"}
            for key in ("mode", "stability"):
                values[key] = list(group[key].asstr()[:])
            values["status"] = group.attrs["status"]
            return values

    def require_same(self, one, other):
        self.assertEqual(one["mode"], other["mode"])
        numpy.testing.assert_array_equal(one["value"], other["value"])
        for key in ("frequency_hz", "growth_rate", "likeness"):
            numpy.testing.assert_allclose(one[key], other[key], rtol=SAME, atol=SAME, err_msg=key)

    def test_the_lines_are_those_of_floquet_at_each_point(self):
        text = self.succeed("campbell", BASELINE, *QUICK, "--sweep", SPEEDS, "-o", "c.h5", "--csv",
                            "c.csv").stdout
        self.assertIn("tower fore-aft", text)
        found = self.diagram("c.h5")
        self.assertEqual(found["status"], "complete")
        with h5py.File(self.folder / "c.h5") as file:
            self.assertEqual(file["campbell/value"].attrs["unit"], "rad/s")
        numpy.testing.assert_allclose(found["value"], numpy.arange(0.5, 3.6, 0.5), rtol=1e-12)
        numpy.testing.assert_allclose(found["rotor_speed"], found["value"], rtol=1e-12)
        self.assertFalse((self.folder / "c.h5.points").exists())
        point = 3
        self.succeed("floquet", BASELINE, *QUICK, "--set", "shaft.speed=2", "-o", "f.h5")
        with h5py.File(self.folder / "f.h5") as file:
            exponents = file["floquet/exponents"][:] @ [1, 1j]
        lines = numpy.flatnonzero(numpy.isfinite(found["growth_rate"][:, point]))
        self.assertGreaterEqual(len(lines), 8)
        for line in lines:
            # The copy of a line differs from that of the mode by a multiple of the rotor speed.
            wanted = found["growth_rate"][line, point] + 2j * numpy.pi * found["frequency_hz"][line, point]
            apart = [min(abs(wanted.real - own.real) + abs(numpy.angle(numpy.exp(
                1j * numpy.pi * (wanted.imag - sign * own.imag)))) / numpy.pi for sign in (1, -1))
                for own in exponents]
            self.assertLess(min(apart), 1e-6, found["mode"][line])
        # The second difference of a frequency is small: another copy is 0.08 Hz or more away.
        for line, name in enumerate(found["mode"]):
            steps = numpy.diff(found["frequency_hz"][line], 2)
            self.assertLess(numpy.nanmax(abs(steps), initial=0.0), 0.05, name)
        with open(self.folder / "c.csv", newline="") as table:
            for row in csv.DictReader(table):
                line = found["mode"].index(row["mode"])
                at = list(found["value"]).index(float(row["value"]))
                for key in ("frequency_hz", "growth_rate", "damping_ratio", "likeness"):
                    self.assertEqual(float(row[key]), found[key][line, at], key)
        shares = found["participation"].sum(axis=2)
        self.assertTrue(((shares > 0.5) & (shares < 1 + 1e-9) | (shares == 0.0)).all())

    def test_two_keys_make_a_map(self):
        sweep = ["--sweep", "shaft.speed=1:3:1"]
        self.succeed("campbell", BASELINE, *QUICK, *sweep, "--sweep", "gravity=0,9.81", "-o", "map.h5", "--csv", "map.csv")
        found = self.diagram("map.h5")
        # There and back, so that neighbours differ in one key.
        numpy.testing.assert_array_equal(found["value"], [1, 2, 3, 3, 2, 1])
        numpy.testing.assert_array_equal(found["second_value"], [0, 0, 0, 9.81, 9.81, 9.81])
        self.succeed("campbell", BASELINE, *QUICK, *sweep, "--bands", "0", "--set", "gravity=9.81", "-o", "row.h5")
        row = self.diagram("row.h5")
        compared = 0
        for name, own in zip(row["mode"], row["frequency_hz"]):
            if name not in found["mode"] or not numpy.isfinite(own).all():
                continue
            whole = found["frequency_hz"][found["mode"].index(name)]
            # Lines of a row may follow other copies.
            speed = row["value"] / (2 * numpy.pi)
            apart = whole[:2:-1] - own
            numpy.testing.assert_allclose(apart, numpy.round(apart / speed) * speed, atol=1e-6, err_msg=name)
            compared += 1
        self.assertGreaterEqual(compared, 6)  # others have another number in their name
        self.succeed("plot", "map.h5", "-o", "map.svg")
        picture = (self.folder / "map.svg").read_text(encoding="utf-8")
        for word in ("shaft.speed [rad/s]", "gravity [m/s^2]", "largest growth rate [1/s]"):
            self.assertIn(word, picture)
        with open(self.folder / "map.csv", encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual({line["second_value"] for line in rows}, {"0", "9.8100000000000005"})
        self.refuse("campbell", BASELINE, *sweep, *sweep, words=["two keys for a map"])
        self.refuse("campbell", BASELINE, *sweep, "--sweep", "gravity=0,1", "--sweep", "hub.radius=1,2",
                    words=["given 3 times"])

    def test_ranks_share_the_points(self):
        for ranks in (1, 2, 3):
            self.succeed("campbell", BASELINE, *QUICK, "--sweep", SPEEDS, "-o", f"{ranks}.h5",
                         ranks=ranks)
        for ranks in (2, 3):
            self.require_same(self.diagram("1.h5"), self.diagram(f"{ranks}.h5"))

    def test_ranks_of_a_group_share_a_point(self):
        sweep = ["campbell", BASELINE, *QUICKEST, "--sweep", SPEEDS]
        self.succeed(*sweep, "-o", "1.h5")
        for ranks, groups in ((2, 1), (3, 2)):
            self.succeed(*sweep, "-samara_groups", groups, "-o", f"{ranks}.h5", ranks=ranks)
            self.require_same(self.diagram("1.h5"), self.diagram(f"{ranks}.h5"))
        for groups in (0, 2, 0.5, "two"):
            self.refuse(*sweep, "-samara_groups", groups,
                        words=[f"-samara_groups {groups}: the run has 1 rank"])
        run = self.samara(*sweep, "-samara_groups", 3, ranks=2)
        self.assertEqual(run.returncode, 2)
        own = [line for line in run.stderr.splitlines() if line.startswith("samara:")]
        self.assertEqual(len(own), 1, run.stderr)  # no rank that mpiexec ends adds a line

    def interrupt(self, number, arguments, points):
        run = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        folder = self.folder / "c.h5.points"
        until = time.monotonic() + LONGEST_RUN
        while len(list(folder.glob("*.h5"))) < points and time.monotonic() < until:
            self.assertIsNone(run.poll(), "ended before it was interrupted")
            time.sleep(0.002)
        run.send_signal(number)
        out, errors = run.communicate(timeout=LONGEST_RUN)
        return run.returncode, out, errors

    def test_an_ended_run_goes_on(self):
        arguments = ["campbell", BASELINE, *QUICKEST, "--sweep", "shaft.speed=1:4:0.25", "-o", "c.h5"]
        self.succeed(*arguments[:-1], "whole.h5")
        whole = self.diagram("whole.h5")
        self.interrupt(signal.SIGKILL, arguments, 2)
        points = self.folder / "c.h5.points"
        kept = {path: path.stat().st_mtime_ns for path in points.glob("*.h5")}
        self.assertGreaterEqual(len(kept), 2)
        code, out, errors = self.interrupt(signal.SIGINT, arguments, len(kept) + 2)
        self.assertEqual(code, 130, errors)
        self.assertIn("goes on from here", errors)
        self.assertIn("result: c.h5", out)
        part = self.diagram("c.h5")
        self.assertEqual(part["status"], "interrupted")
        self.assertTrue(4 <= len(part["value"]) < len(whole["value"]))
        for path, changed in kept.items():
            self.assertEqual(path.stat().st_mtime_ns, changed, "a point was found twice")
        # Other settings: the points of the run before are not theirs.
        self.succeed(*arguments, "--set", "nacelle.mass=7000", "--bands", "0")
        self.assertFalse(points.exists())
        self.interrupt(signal.SIGKILL, arguments, 3)
        self.succeed(*arguments)
        self.require_same(self.diagram("c.h5"), whole)
        self.assertFalse(points.exists())

    def test_a_point_that_fails_does_not_end_the_others(self):
        run = self.samara("campbell", BASELINE, *QUICK, "--sweep", "gravity=0,1e7,9.81", "-o", "c.h5")
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertIn("gravity=1e+07: ", run.stderr)
        self.assertIn("1 of 3 points have no modes", run.stderr)
        found = self.diagram("c.h5")
        self.assertTrue(found["stability"][1].startswith("failed: "))
        lines = numpy.isfinite(found["frequency_hz"])
        self.assertFalse(lines[:, 1].any())
        self.assertGreater((lines[:, 0] & lines[:, 2]).sum(), 8)

    def test_nothing_foreign_is_touched(self):
        foreign = self.write("c.h5.points/00002.h5", b"something else")
        note = self.write("c.h5.points/notes.txt", b"mine")
        self.succeed("campbell", BASELINE, *QUICK, "--sweep", "shaft.speed=1,2", "-o", "c.h5")
        self.assertEqual(note.read_bytes(), b"mine")
        self.assertEqual(foreign.read_bytes(), b"something else")
        self.assertEqual(set((self.folder / "c.h5.points").iterdir()), {note, foreign})

    def test_a_band_between_two_stable_points_is_found(self):
        """The edges are those of an integration of the equations of single blades by Runge-Kutta (docs/examples/two_blades.md)."""
        case = SOURCE / "inputs/ground_resonance/hammond.yaml"
        sweep = ["campbell", case, "--set", "blades.count=2", "--set", "blades.hinges.0.damping=100",
                 "--sweep", "shaft.speed_rpm=200,420", "-o", "c.h5"]
        text = self.succeed(*sweep).stdout
        self.assertRegex(text, "grows at +remark")
        grows = re.search(r"antisymmetric .* ([0-9.]+) to ([0-9.]+)$", text, re.MULTILINE)
        self.assertAlmostEqual(float(grows[1]), 247.15, delta=0.02)
        self.assertAlmostEqual(float(grows[2]), 373.00, delta=0.02)
        self.assertRegex(text, r"searched at \d+ crossings of frequencies, found at 2")
        found = self.diagram("c.h5")
        self.assertEqual([found["value"][0], found["value"][-1]], [200, 420])
        self.assertEqual((numpy.diff(found["value"]) > 0).all(), True)
        for ranks in (2, 3):  # 3: some share an edge
            self.succeed(*sweep, ranks=ranks)
            other = self.diagram("c.h5")
            self.assertEqual(found["mode"], other["mode"])
            for key in ("value", "growth_rate", "edge_value"):
                numpy.testing.assert_allclose(found[key], other[key], rtol=1e-5, atol=1e-7)
        text = self.succeed(*sweep, "--bands", "0").stdout
        self.assertRegex(text, r"not searched at \d crossings of frequencies \(hint: --bands \d\)")
        self.assertEqual(self.diagram("c.h5")["value"].tolist(), [200, 420])
        self.refuse(*sweep, "--bands", "-1", words="from 0 to 999999")
        self.refuse("floquet", case, "--bands", "3", words="samara campbell does")

    def test_a_spring_from_nothing(self):
        """A part without stiffness at one point has no energy there, and the others are compared."""
        self.succeed("campbell", BASELINE, *QUICK, "--sweep", "hub.teeter.stiffness=0:2e5:1e5", "-o", "c.h5")
        found = self.diagram("c.h5")
        line = next(i for i, name in enumerate(found["mode"]) if "tower side-side" in name)
        self.assertTrue(numpy.isfinite(found["frequency_hz"][line]).all())
        self.assertTrue((found["likeness"][line] > 0.9).all())

    def test_ranges_are_free_of_round_off(self):
        self.succeed("campbell", BASELINE, *QUICK, "--sweep", "shaft.speed=1.2:0:-0.4", "-o", "c.h5")
        numpy.testing.assert_array_equal(self.diagram("c.h5")["value"], [1.2, 0.8, 0.4, 0.0])

    def test_an_interrupted_run_goes_on_with_finer_steps(self):
        arguments = ["campbell", BASELINE, *QUICK, "-o", "c.h5", "--sweep"]
        self.interrupt(signal.SIGKILL, [*arguments, "shaft.speed=1:4:0.5"], 2)
        kept = {path: path.stat().st_mtime_ns for path in (self.folder / "c.h5.points").glob("*.h5")}
        code, _, _ = self.interrupt(signal.SIGINT, [*arguments, "shaft.speed=1:4:0.25"], len(kept) + 1)
        self.assertEqual(code, 130)
        for path, changed in kept.items():
            self.assertEqual(path.stat().st_mtime_ns, changed, "a point was found twice")
        self.succeed(*arguments, "shaft.speed=3,3.5")
        self.assertFalse((self.folder / "c.h5.points").exists())

    def test_wrong_arguments(self):
        for sweep, words in (("shaft.speed", "KEY=FROM:TO:STEP"),
                             ("shaft.speed=1:2", "KEY=FROM:TO:STEP"),
                             ("shaft.speed=1:2:-1", "a step of the other sign"),
                             ("shaft.speed=1:2:0", "a step of the other sign"),
                             ("shaft.speed=0:1e9:1", "at most 10000"),
                             ("shaft.speed=1,2,2", "2 is given twice"),
                             ("shaft.speed=1,x", '"x" is no number'),
                             ("shaft.spede=1,2", "did you mean"),
                             ("shaft.speed=1,-2", "expected a number >= 0"),
                             ("blades.elements=2,3", "different meshes")):
            self.refuse("campbell", BASELINE, *QUICK, "--sweep", sweep, words=words)
        self.refuse("campbell", BASELINE, words="missing --sweep")
        case = SOURCE / "inputs/nrel5mw/land.yaml"
        self.refuse("campbell", case, "--set", "floquet.modes=5000", words="degrees of freedom")
        self.refuse("campbell", case, "--set", "floquet.near_hz=1", words="floquet.modes")
        self.refuse("floquet", BASELINE, "--sweep", "shaft.speed=1,2", words="samara campbell has one")

    def test_operating_points(self):
        case = SOURCE / "inputs/nrel5mw/land.yaml"
        coarse = [part for key in ("blades.elements=2", "blades.element_lengths=[1, 1]", "blades.order=3",
                                   "tower.elements=1", "tower.order=3", "floquet.steps=60",
                                   "operation.wind_speeds=[8, 10, 16]") for part in ("--set", key)]
        self.succeed("campbell", case, *coarse, "-o", "c.h5")
        found = self.diagram("c.h5")
        self.succeed("operate", case, *coarse, "-o", "o.h5")
        with h5py.File(self.folder / "o.h5") as file:
            numpy.testing.assert_allclose(found["pitch"], file["operation/pitch"][:], rtol=1e-6)
            numpy.testing.assert_allclose(found["rotor_speed"], file["operation/rotor_speed"][:],
                                          rtol=1e-6)
        numpy.testing.assert_array_equal(found["wind_speed"], found["value"])
        line = found["mode"].index("1st blade flap collective")
        self.assertTrue((found["damping_ratio"][line] > 0.2).all())  # by the air


if __name__ == "__main__":
    unittest.main()
