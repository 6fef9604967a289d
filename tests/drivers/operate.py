"""samara operate: runs that are interrupted, killed or fail keep their points and go on."""

import pathlib
import random
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import LONGEST_RUN, PROGRAM, SOURCE, ProgramTest, wait_until_it_stands  # noqa: E402

LAND = SOURCE / "inputs/nrel5mw/land.yaml"
WINDS = [6, 8, 9, 11, 12, 14]
QUICK = [part for key in ("blades.elements=2", "blades.element_lengths=[1, 1]", "tower.elements=1", "blades.order=2",
                          "tower.order=2", "trim.harmonics=6", "wind.speed=8", "operation={rated_speed_rpm: 12.1, "
                          "rated_power: 5.29661e6, torque_gain: 2.332287, opt: points.opt}")
         for part in ("--set", key)]
ARGUMENTS = ["operate", LAND, *QUICK, "--set", f"operation.wind_speeds={WINDS}", "-o", "run.h5", "--csv", "run.csv"]


class Operate(ProgramTest):
    def points(self):
        with h5py.File(self.folder / "run.h5") as file:
            group = file["operation"]
            values = {key: group[key][:] for key in group if group[key].dtype.kind == "f"}
            return group.attrs["status"], values

    def require_same(self, one, other):
        """To the last bit: each steady state has the same start."""
        self.assertEqual(one.keys(), other.keys())
        for key, values in one.items():
            numpy.testing.assert_array_equal(values, other[key], err_msg=key)

    def end(self, number, seconds=0.0, points=0):
        """Ends a run after some time and with some points."""
        run = subprocess.Popen([PROGRAM, *map(str, ARGUMENTS)], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
        wait_until_it_stands(run)
        time.sleep(seconds)
        until = time.monotonic() + LONGEST_RUN
        while (len(list((self.folder / "run.h5.points").glob("*.h5"))) < points and run.poll() is None
               and time.monotonic() < until):
            time.sleep(0.002)
        run.send_signal(number)
        text, errors = run.communicate(timeout=LONGEST_RUN)
        return run.returncode, text, errors

    def test_an_ended_run_goes_on(self):
        began = time.monotonic()
        self.succeed(*ARGUMENTS)
        duration = time.monotonic() - began
        status, whole = self.points()
        self.assertEqual(status, "complete")
        folder = self.folder / "run.h5.points"
        self.assertFalse(folder.exists())
        # A result of the points so far, in all forms.
        code, text, errors = self.end(signal.SIGINT, points=1)
        self.assertEqual(code, 130, errors)
        self.assertRegex(errors, r"^samara: ends after the present point; again to end at once\n"
                                 r"samara: interrupted after \d of 6 points; hint: the same command goes on from here\n$")
        self.assertIn("torque law", text)
        status, part = self.points()
        self.assertEqual(status, "interrupted")
        count = len(part["power"])
        self.assertTrue(1 <= count < len(WINDS) - 1, count)
        self.require_same(part, {key: values[:count] for key, values in whole.items()})
        self.assertEqual(len((self.folder / "run.csv").read_text().splitlines()), 1 + count)
        self.assertEqual(len((self.folder / "points.opt").read_text().splitlines()), 1 + count)
        # A killed run has its points, and finds none twice.
        code, _, _ = self.end(signal.SIGKILL, points=count + 1)
        self.assertEqual(code, -signal.SIGKILL)
        kept = {path: path.stat().st_mtime_ns for path in folder.glob("*.h5")}
        self.assertGreater(len(kept), count)
        code, _, _ = self.end(signal.SIGINT, points=len(kept) + 1)
        for path, changed in kept.items():
            self.assertEqual(path.stat().st_mtime_ns, changed, "a point was found twice")
        self.succeed(*ARGUMENTS, ranks=2)
        self.require_same(self.points()[1], whole)
        self.assertFalse(folder.exists())
        # At any moment: one or two lines, and a whole result or none.
        random.seed(5)
        for _ in range(6):
            (self.folder / "run.h5").unlink(missing_ok=True)
            moment = random.uniform(0.0, duration)
            with self.subTest(moment=moment):
                code, _, errors = self.end(signal.SIGINT, seconds=moment)
                if code == 0:  # it had ended before
                    self.assertEqual(errors, "")
                else:
                    self.assertEqual(code, 130, errors)
                    self.assertIn(len(errors.splitlines()), (1, 2), errors)  # the first one before it began
                if (self.folder / "run.h5").exists():
                    self.assertIn(self.points()[0], ("complete", "interrupted"))
        self.succeed(*ARGUMENTS)
        self.require_same(self.points()[1], whole)

    def test_a_failing_point_leaves_those_before(self):
        self.write("table.opt", "2 wind pitch speed\n7 0 8\n10 0 11\n")
        run = self.samara("operate", LAND, *QUICK, "--set", "operation={table: table.opt, wind_speeds: [8, 9, 30]}", "-o",
                          "run.h5")
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("operation at 30 m/s: ", run.stderr)
        self.assertEqual(len(run.stderr.splitlines()), 1, run.stderr)
        status, values = self.points()
        self.assertRegex(status, "^failed: operation at 30 m/s")
        numpy.testing.assert_array_equal(values["wind_speed"], [8, 9])
        self.assertIn("result: run.h5", run.stdout)


if __name__ == "__main__":
    unittest.main()
