"""samara transient: time series, restarts, runs that are killed, and what it refuses."""

import os
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
from program import BASELINE, LONGEST_RUN, MINIMAL, PROGRAM, SOURCE, ProgramTest  # noqa: E402

LAND = SOURCE / "inputs/nrel5mw/land.yaml"
COARSE = ["--set", "blades.elements=2", "--set", "tower.elements=2"]
CHANNELS = "output: {channels: [RootMxb1, RootMyb1, TwrBsMyt, TTDspSS, Azimuth]}"


def block(**keys):
    """The key `transient` as one --set argument."""
    words = ", ".join(f"{key}: {value}" for key, value in keys.items())
    return ["--set", f"transient={{{words}, {CHANNELS}}}"]


def series(path):
    with h5py.File(path, "r") as file:
        group = file["transient"]
        names = list(group["channel_name"].asstr()[:])
        return (group["time"][:], group["values"][:], names, group.attrs["status"])


class TimeSeries(ProgramTest):
    def test_rows_channels_and_their_attributes(self):
        run = self.succeed("transient", BASELINE, *COARSE, "-o", "a.h5",
                           *block(duration=1, step=0.01, start="undeformed"))
        self.assertIn("result: a.h5", run.stdout)
        times, values, names, status = series(self.folder / "a.h5")
        self.assertEqual(status, "complete")
        numpy.testing.assert_allclose(times, numpy.arange(101) * 0.01, atol=1e-12)
        self.assertEqual(names, ["RootMxb1", "RootMyb1", "TwrBsMyt", "TTDspSS", "Azimuth"])
        self.assertEqual(values.shape, (101, 5))
        speed = 6.02 * 180 / numpy.pi
        numpy.testing.assert_allclose(values[:, 4], (speed * times) % 360, atol=1e-9)
        with h5py.File(self.folder / "a.h5") as file:
            self.assertEqual(list(file["transient/channel_unit"].asstr()[:2]), ["kN-m", "kN-m"])
            for name in ("time", "values", "channel_frame", "checkpoint/state"):
                self.assertTrue(file["transient/" + name].attrs["description"])

    def test_midpoint_rule_gives_its_rows_in_the_middle_of_the_steps(self):
        self.succeed("transient", BASELINE, *COARSE, "-o", "a.h5",
                     *block(duration=0.1, step=0.01, method="midpoint"))
        times = series(self.folder / "a.h5")[0]
        numpy.testing.assert_allclose(times[1:], (numpy.arange(10) + 0.5) * 0.01, atol=1e-12)

    def test_petsc_options_reach_the_integrator(self):
        run = self.succeed("transient", BASELINE, *COARSE, "-o", "a.h5",
                           *block(duration=0.1, step=0.01), "-transient_ts_type", "beuler")
        self.assertIn("beuler", run.stdout)
        self.assertNotIn("options that this run", run.stderr)

    def test_every_tenth_row_is_the_same_as_of_all(self):
        for name, output in (("all", 1), ("some", 10)):
            keys = f"transient={{duration: 1, step: 0.01, output: {{every: {output * 0.01}}}}}"
            self.succeed("transient", BASELINE, *COARSE, "-o", f"{name}.h5", "--set", keys)
        every = series(self.folder / "all.h5")
        tenth = series(self.folder / "some.h5")
        numpy.testing.assert_array_equal(every[1][::10], tenth[1])

    def test_ranks_give_the_same_series(self):
        for ranks in (1, 2, 3):
            self.succeed("transient", BASELINE, *COARSE, "-o", f"{ranks}.h5",
                         *block(duration=0.5, step=0.01), ranks=ranks)
        for ranks in (2, 3):
            numpy.testing.assert_array_equal(series(self.folder / "1.h5")[1],
                                             series(self.folder / f"{ranks}.h5")[1])


class Restarts(ProgramTest):
    def test_restart_goes_on_bit_by_bit(self):
        self.succeed("transient", BASELINE, *COARSE, "-o", "whole.h5",
                     *block(duration=3, step=0.01, checkpoint=0.5))
        self.succeed("transient", BASELINE, *COARSE, "-o", "parts.h5",
                     *block(duration=1, step=0.01, checkpoint=0.5))
        self.succeed("transient", BASELINE, *COARSE, "-o", "parts.h5", "--restart", "parts.h5",
                     *block(duration=2, step=0.01, checkpoint=0.5))
        self.succeed("transient", BASELINE, *COARSE, "-o", "parts.h5", "--restart", "parts.h5",
                     *block(duration=3, step=0.01, checkpoint=0.5))
        whole = series(self.folder / "whole.h5")
        parts = series(self.folder / "parts.h5")
        for a, b in zip(whole, parts):
            numpy.testing.assert_array_equal(a, b)

    def test_restart_into_its_own_file_however_it_is_written(self):
        self.succeed("transient", BASELINE, *COARSE, "-o", "a.h5",
                     *block(duration=1, step=0.01, checkpoint=0.5))
        self.succeed("transient", BASELINE, *COARSE, "-o", "./a.h5", "--restart", "a.h5",
                     *block(duration=1.5, step=0.01, checkpoint=0.5))
        times = series(self.folder / "a.h5")[0]
        numpy.testing.assert_allclose(times, 0.01 * numpy.arange(151), atol=1e-12)

    def test_restart_into_another_file_holds_the_rest(self):
        self.succeed("transient", BASELINE, *COARSE, "-o", "a.h5",
                     *block(duration=1, step=0.01, checkpoint=0.5))
        self.succeed("transient", BASELINE, *COARSE, "-o", "b.h5", "--restart", "a.h5",
                     *block(duration=1.5, step=0.01, checkpoint=0.5))
        times = series(self.folder / "b.h5")[0]
        numpy.testing.assert_allclose(times, 1.0 + 0.01 * numpy.arange(1, 51), atol=1e-12)

    def test_interrupted_run_ends_in_good_order(self):
        command = [PROGRAM, "transient", LAND, "-o", "a.h5",
                   *block(duration=5000, step=0.01, checkpoint=2)]
        run = subprocess.Popen(list(map(str, command)), cwd=self.folder, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        end = time.monotonic() + LONGEST_RUN
        while not (self.folder / "a.h5").exists():  # the first checkpoint has 201 rows
            self.assertLess(time.monotonic(), end)
            time.sleep(0.02)
        run.send_signal(signal.SIGINT)
        out, err = run.communicate(timeout=LONGEST_RUN)
        self.assertEqual(run.returncode, 130, err)
        self.assertIn("interrupted", out)
        times, values, _, status = series(self.folder / "a.h5")
        self.assertEqual(status, "interrupted")
        self.assertGreater(len(times), 100)
        self.assertTrue(numpy.isfinite(values).all())

    def test_segments_are_found_from_any_folder_and_missed_by_name(self):
        self.succeed("transient", BASELINE, *COARSE, "-o", "a.h5",
                     *block(duration=2, step=0.01, checkpoint=0.5))
        segments = sorted((self.folder / "a.h5.parts").iterdir())
        self.assertGreater(len(segments), 2)
        here = os.getcwd()
        os.chdir("/")
        try:
            self.assertTrue(numpy.isfinite(series(self.folder / "a.h5")[1]).all())
        finally:
            os.chdir(here)
        segments[1].unlink()
        run = self.samara("transient", BASELINE, *COARSE, "-o", "a.h5", "--restart", "a.h5",
                          *block(duration=3, step=0.01, checkpoint=0.5))
        self.assertEqual(run.returncode, 2)
        self.assertIn(segments[1].name, run.stderr)
        self.assertIn("missing", run.stderr)


class Starts(ProgramTest):
    """From where another run ended."""

    GRAVITY = ["--set", "gravity=9.81", "--set", "trim.harmonics=4"]

    def test_a_series_goes_on_from_the_end_of_another_on_a_new_clock(self):
        # 2.03 s are no whole number of turns: gravity would pull from elsewhere at another azimuth.
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "whole.h5",
                     *block(duration=4.06, step=0.01, checkpoint=2.03, start="undeformed"))
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "first.h5",
                     *block(duration=2.03, step=0.01, start="undeformed"))
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "then.h5",
                     *block(duration=2.03, step=0.01, start="first.h5"))
        whole = series(self.folder / "whole.h5")
        then = series(self.folder / "then.h5")
        numpy.testing.assert_allclose(then[0], whole[0][203:] - 2.03, atol=1e-12)
        size = numpy.abs(whole[1]).max(axis=0)
        numpy.testing.assert_allclose(then[1] / size, whole[1][203:] / size, atol=1e-8)
        # A third one and a restart keep the azimuth, too.
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "then.h5", "--restart",
                     "then.h5", *block(duration=2.5, step=0.01, start="first.h5"))
        last = series(self.folder / "then.h5")
        speed = 6.02 * 180 / numpy.pi
        numpy.testing.assert_allclose(last[1][:, 4], (speed * (last[0] + 2.03)) % 360, atol=1e-6)

    def test_loads_that_turn_with_the_rotor_keep_their_azimuth(self):
        loads = ["--set", "loads=[{beam: blade 1, at: 1, force: [0, 0, 300], harmonic: {per_rev: 1}}]"]
        self.succeed("transient", BASELINE, *COARSE, *loads, "-o", "whole.h5",
                     *block(duration=3, step=0.01, checkpoint=2.1, start="undeformed"))
        self.succeed("transient", BASELINE, *COARSE, *loads, "-o", "first.h5",
                     *block(duration=2.1, step=0.01, start="undeformed"))
        self.succeed("transient", BASELINE, *COARSE, *loads, "-o", "then.h5",
                     *block(duration=0.9, step=0.01, start="first.h5"))
        whole = series(self.folder / "whole.h5")[1]
        then = series(self.folder / "then.h5")[1]
        size = numpy.abs(whole).max(axis=0)
        numpy.testing.assert_allclose(then / size, whole[210:] / size, atol=1e-7)

    def test_a_start_whose_rates_are_not_known_has_no_row(self):
        # The midpoint rule ends a step with a state that has no rates of its own.
        keys = dict(step=0.01, method="midpoint")
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "first.h5",
                     *block(duration=2, **keys))
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "then.h5",
                     *block(duration=1, start="first.h5", **keys))
        times, values, _, _ = series(self.folder / "then.h5")
        numpy.testing.assert_allclose(times, 0.005 + 0.01 * numpy.arange(100), atol=1e-12)
        first = series(self.folder / "first.h5")[1]
        for column in range(4):
            self.assertLess(numpy.ptp(values[:, column]), 1.2 * numpy.ptp(first[:, column]) + 1e-9)

    def test_a_pitched_blade_goes_on_where_it_is(self):
        self.succeed("transient", BASELINE, *COARSE, "-o", "first.h5", "--set",
                     "transient={duration: 2, step: 0.01, events: [{at: 0.5, pitch: "
                     "{to_deg: 6, rate_deg: 20, blade: 1}}], output: {channels: [BldPitch1]}}")
        self.succeed("transient", BASELINE, *COARSE, "--set", "blades.each.1.pitch_deg=6", "-o",
                     "then.h5", *block(duration=0.2, step=0.01, start="first.h5"))

    def test_a_series_starts_on_the_steady_state_of_a_result(self):
        self.succeed("trim", BASELINE, *COARSE, *self.GRAVITY, "-o", "trim.h5")
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "own.h5",
                     *block(duration=0.5, step=0.01))
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "read.h5",
                     *block(duration=0.5, step=0.01, start="trim.h5"))
        numpy.testing.assert_allclose(series(self.folder / "read.h5")[1],
                                      series(self.folder / "own.h5")[1], rtol=1e-9, atol=1e-9)

    def test_loads_may_change_and_what_moves_may_not(self):
        self.succeed("trim", BASELINE, *COARSE, "-o", "trim.h5")
        keys = block(duration=0.1, step=0.01, start="trim.h5")
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY[:2], "-o", "a.h5", *keys)
        for setting, words in (
                ("shaft.speed=6.5", "the speed 6.02 rad/s, this time series begins with 6.5"),
                ("blades.pitch_deg=3", "the pitch of blade 1 0 deg"),
                ("blades.elements=3", "is of another model (blades.elements: 2 there")):
            run = self.samara("transient", BASELINE, *COARSE, "--set", setting, "-o", "b.h5", *keys)
            self.assertEqual(run.returncode, 2, setting)
            self.assertIn(words, run.stderr)
            self.assertIn("transient.start: trim.h5: ", run.stderr)
        self.succeed("check", BASELINE, *COARSE, "-o", "check.h5")
        for name, words in (("check.h5", "no state"), ("none.h5", "no such file")):
            run = self.samara("transient", BASELINE, *COARSE, "-o", "b.h5",
                              *block(duration=0.1, step=0.01, start=name))
            self.assertEqual(run.returncode, 2)
            self.assertIn(words, run.stderr)


class Midpoint(ProgramTest):
    """Reactions of rigid strains by the midpoint rule."""

    GRAVITY = ["--set", "gravity=9.81", "--set", "nacelle.yaw.joint=locked"]

    def test_reactions_of_rigid_strains_do_not_alternate(self):
        extents = {}
        for method, step in (("bdf2", 0.0025), ("midpoint", 0.0025), ("midpoint", 0.00125)):
            self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "a.h5", "--set",
                         f"transient={{duration: 5, step: {step}, method: {method}, "
                         "output: {channels: [RootFzb1]}}")
            values = series(self.folder / "a.h5")[1][1:]
            extents[method, step] = numpy.array([values.min(), values.max()])
            if method == "midpoint":  # what alternates is the second difference
                rough = numpy.abs(numpy.diff(values[:, 0], 2)).max()
                self.assertLess(rough, 1e-3 * numpy.ptp(values))
        reference = extents["bdf2", 0.0025]
        for found in extents.values():
            numpy.testing.assert_allclose(found, reference, rtol=1e-2)

    def test_restart_goes_on_bit_by_bit(self):
        keys = dict(step=0.01, checkpoint=0.5, method="midpoint")
        self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "whole.h5",
                     *block(duration=1.5, **keys))
        for duration, more in ((1, []), (1.5, ["--restart", "parts.h5"])):
            self.succeed("transient", BASELINE, *COARSE, *self.GRAVITY, "-o", "parts.h5", *more,
                         *block(duration=duration, **keys))
        for a, b in zip(series(self.folder / "whole.h5"), series(self.folder / "parts.h5")):
            numpy.testing.assert_array_equal(a, b)

    def test_a_hinged_rotor_turns_on(self):
        # With rigid strains and free hinges: what alternates would stop it after a minute.
        path = self.write("hinged.yaml", HINGED)
        self.succeed("transient", path, "-o", "a.h5", "--set",
                     "transient={duration: 80, step: 0.01, start: undeformed, method: midpoint, "
                     "output: {channels: [RootFzb1, LagHinge1]}}")
        _, values, _, status = series(self.folder / "a.h5")
        self.assertEqual(status, "complete")
        self.assertLess(abs(values[:, 1]).max(), 25)

    def test_motions_without_inertia_do_not_depend_on_the_linear_solver(self):
        # Each hinge has one: rotations that alternate between Gauss points, without shear.
        path = self.write("hinged.yaml", HINGED)
        runs = []
        for option in ([], ["-transient_impulse_pc_factor_mat_solver_type", "mumps"]):
            self.succeed("transient", path, "-o", "a.h5", *option, "--set",
                         "transient={duration: 4, step: 0.01, start: undeformed, method: midpoint, "
                         "output: {channels: [RootFzb1, FlapHinge1, LagHinge1]}}")
            runs.append(series(self.folder / "a.h5")[1])
        numpy.testing.assert_allclose(runs[0], runs[1], rtol=0, atol=1e-9)


HINGED = """samara: 1
gravity: 9.81
shaft: {speed: 6}
hub: {radius: 0.5}
blades:
  length: 10
  elements: 2
  order: 2
  hinges: [{axis: flap, offset: 0.5, joint: free}, {axis: lag, joint: free}]
  sections:
    - mass: 1
      inertia: [2e-4, 1e-4, 1e-4]
      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: 8e3, EI2: 1e4, EI3: 1e4}
loads:
  - {beam: blades, at: 1, force: [0, 10, 40], table: [[0, 0], [0.3, 1], [0.6, 0], [1000, 0]]}
"""


class RoughInput(ProgramTest):
    """Rough motions are noted, motions that steps cannot resolve are refused."""

    ROUGH = ["--set", "gravity=5", "--set", "trim.method=shooting", "--set", "trim.steps=4"]

    @staticmethod
    def series(words, duration=0.1, step=0.01):
        return ["--set", f"transient={{duration: {duration}, step: {step}, {words}, "
                "output: {channels: [RootMxb1]}}"]

    def test_every_command_says_that_a_steady_state_is_rough(self):
        beam = SOURCE / "inputs/beam/rotating.yaml"
        words = "the steady state is rough: loads are out of balance by"
        run = self.succeed("trim", beam, *self.ROUGH, "-o", "trim.h5")
        self.assertIn("rough        loads are out of balance by", run.stdout)
        with h5py.File(self.folder / "trim.h5") as file:
            self.assertGreater(file["trim/imbalance"][()], 1e-2)
        for command, more in (("floquet", []), ("linearize", []),
                              ("transient", self.series("start: trim")),
                              ("transient", self.series("start: trim.h5"))):
            run = self.succeed(command, beam, *self.ROUGH, "-o", "a.h5", *more)
            self.assertIn(words, run.stderr, command)
        run = self.succeed("loads", "trim.h5", "--set", "channels=[RootMxb1]", "-o", "l.h5")
        self.assertIn("trim.h5: " + words, run.stderr)
        run = self.succeed("floquet", beam, "--set", "gravity=5", "-o", "a.h5")
        self.assertNotIn("rough", run.stderr)

    def test_tolerances_without_sense_are_refused_with_their_range(self):
        for key, words in (("trim.tolerance=0.99", "from 1e-14 to 1e-3"),
                           ("trim.tolerance=1e-300", "from 1e-14 to 1e-3"),
                           ("trim.auto_tolerance=0.1", "from 1e-14 to 1e-3"),
                           ("static.tolerance=1e10", "from 1e-14 to 1e-3"),
                           ("transient={duration: 1, step: 0.1, tolerance: 1}",
                            "from 1e-14 to 1e-3"),
                           ("transient={duration: 1, step: 0.1, step_tolerance: 1e-300}",
                            "from 1e-12 to 0.1")):
            run = self.samara("check", self.write("m.yaml", MINIMAL), "--set", key)
            self.assertEqual(run.returncode, 2, key)
            self.assertIn("expected a number " + words, run.stderr)

    def test_motions_that_jump_are_refused_and_kinks_are_noted(self):
        def run(motion, step=0.01):
            return self.samara("transient", self.write("m.yaml", MINIMAL), "-o", "a.h5",
                               *self.series(f"start: undeformed, {motion}", 1, step))
        for motion, words in (
                ('pitch_deg: {formula: "t<0.5 ? 0 : 20"}', "jumps, by 20 deg within less than a step, "
                                                         "at t = 0.5 s"),
                ("pitch_deg: {table: [[0, 0], [1e-9, 90], [1, 90]]}", "jumps, by 90 deg"),
                ('pitch_deg: {formula: "sin(1e9*t)"}', "within less than a step"),
                ('pitch_deg: {formula: "sin(300*t)"}', "changes too fast for the steps"),
                ('speed: {formula: "t<0.5 ? 6 : 7"}', "jumps, by 1 rad/s")):
            found = run(motion)
            self.assertEqual(found.returncode, 2, motion)
            self.assertIn(words, found.stderr)
        bent = run('pitch_deg: {formula: "t<0.5 ? 0 : 3*(t-0.5)"}')
        self.assertEqual(bent.returncode, 0, bent.stderr)
        self.assertIn("transient.pitch_deg: the rate jumps at t = 0.5 s by 3 deg/s", bent.stderr)
        before = run('pitch_deg: {formula: "t<0 ? 50 : t"}')  # nobody asks what was before 0
        self.assertEqual(before.returncode, 0, before.stderr)
        self.assertNotIn("jumps", before.stderr)

    def test_few_steps_a_revolution_are_said(self):
        path = self.write("m.yaml", MINIMAL)
        run = self.succeed("transient", path, "-o", "a.h5", *self.series("start: trim", 1, 0.05))
        self.assertIn("fewer than 40; motions faster than 1 Hz have fewer than 20 steps a cycle",
                      run.stderr)
        self.assertIn("resolved     motions up to 1 Hz, with 20 steps a cycle", run.stdout)
        run = self.succeed("transient", path, "-o", "a.h5", *self.series("start: trim", 1, 0.01))
        self.assertNotIn("steps a revolution", run.stderr)


# A stiff rotor that a constant torque holds against a constant torque of the generator.
ROTOR = """samara: 1
gravity: 0
shaft:
  speed: 6
  generator: {joint: free, torque: 100, own_inertia: 50}
  rotor: {torque: 100}
blades:
  count: 2
  length: 10
  elements: 1
  order: 2
  sections:
    - mass: 1
      inertia: [2e-4, 1e-4, 1e-4]
      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: 1e9, EI2: 1e9, EI3: 1e9}
"""
INERTIA = 50 + 2 * (1000 / 3 + 10 * 1e-4)  # about the shaft


class Operation(ProgramTest):
    """Actions in time, against closed forms of a rigid rotor."""

    def test_events_at_the_start_and_next_to_a_row(self):
        # One row an instant, and the loads before the first step are those of the trim.
        for trigger in ("at: 0", "at: 1e-9", "when: {channel: RotSpeed, above: 3}", "at: 0.00999999",
                        "at: 0.0100001"):
            _, times, values = self.run_rotor(
                f"duration: 0.5, step: 0.01, events: [{{{trigger}, brake: 300}}], "
                "output: {channels: [RotSpeed, RootFxb1, RootMzb1, RootFzb1]}")
            numpy.testing.assert_allclose(times, numpy.arange(51) * 0.01, atol=1e-12)
            begun = 0.01 if "009" in trigger or "010" in trigger else 0
            speed = values["RotSpeed"] * 2 * numpy.pi / 60
            expected = 6 - 300 / INERTIA * numpy.maximum(times - begun, 0)
            numpy.testing.assert_allclose(speed, expected, rtol=1e-5)
            pull = values["RootFzb1"]  # m r omega^2 of the blade, as kN
            numpy.testing.assert_allclose(pull[0], 50 * 36 / 1e3, rtol=1e-3)
            self.assertLess(abs(pull).max(), 1.1 * abs(pull[0]))

    def test_motions_do_not_reach_back_into_the_trim(self):
        """A pitch that begins level after less than a revolution: until then nothing moves."""
        land = SOURCE / "inputs/nrel5mw/land.yaml"
        still = ("--set", "aero=none")
        self.succeed("transient", land, *COARSE, *still, "-o", "a.h5", "--set",
                     "transient={duration: 2, step: 0.02, pitch_deg: {table: [[0, 0], [1, 0], [2, 3]]}, "
                     "output: {channels: [RotSpeed, TTDspSS, RootMyb1]}}")
        times, values, _, _ = series(self.folder / "a.h5")
        numpy.testing.assert_allclose(values[:, 0], 12.1, rtol=1e-3)
        before = values[times <= 1]
        self.succeed("transient", land, *COARSE, *still, "-o", "b.h5", "--set",
                     "transient={duration: 1, step: 0.02, "
                     "output: {channels: [RotSpeed, TTDspSS, RootMyb1]}}")
        numpy.testing.assert_allclose(before, series(self.folder / "b.h5")[1],
                                      rtol=1e-6, atol=1e-6)
        run = self.samara("transient", land, *COARSE, *still, "-o", "c.h5", "--set",
                          "transient={duration: 1, step: 0.02, pitch_deg: {formula: 2 + t}}")
        self.assertEqual(run.returncode, 2)
        self.assertIn("transient.start: trim: has the pitch of blade 1 0 deg, this time series begins "
                      "with 2", run.stderr)

    def test_a_new_torque_law_takes_the_place_of_what_held_the_speed(self):
        case = ROTOR.replace("torque: 100, own_inertia", "own_inertia")
        path = self.write("rotor.yaml", case)
        self.succeed("trim", path, "-o", "trim.h5")
        for law, speed in ((["--set", "shaft.generator.torque=100"], 6),
                           (["--set", "shaft.generator.torque=40"], 6 + 60 / INERTIA)):
            self.succeed("transient", path, *law, "-o", "a.h5", "--set",
                         "transient={duration: 1, step: 0.01, start: trim.h5, "
                         "output: {channels: [RotSpeed]}}")
            last = series(self.folder / "a.h5")[1][-1, 0] * 2 * numpy.pi / 60
            self.assertAlmostEqual(last, speed, delta=1e-6)

    def test_what_events_did_to_the_drive_train_stays_done(self):
        keys = "step: 0.01, output: {channels: [RotSpeed]}"
        run, times, values = self.run_rotor(
            f"duration: 1, {keys}, events: [{{at: 0.5, generator_off: true, brake: 300}}]")
        path = self.folder / "rotor.yaml"
        (self.folder / "a.h5").rename(self.folder / "first.h5")
        for name, start in (("second", "first.h5"), ("third", "second.h5")):
            run = self.succeed("transient", path, "-o", f"{name}.h5", "--set",
                               f"transient={{duration: 1, {keys}, start: {start}}}")
            self.assertIn("the generator stays lost", run.stderr)
            self.assertIn("the brake stays set", run.stderr)
        speed = series(self.folder / "third.h5")[1][:, 0] * 2 * numpy.pi / 60
        time = series(self.folder / "third.h5")[0] + 2
        numpy.testing.assert_allclose(speed, 6 - 200 / INERTIA * (time - 0.5), rtol=1e-5)
        run = self.samara("transient", path, "-o", "first.h5", "--set",
                          f"transient={{duration: 1, {keys}, start: first.h5}}")
        self.assertEqual(run.returncode, 2)
        self.assertIn("is read by this run", run.stderr)

    def run_rotor(self, keys, case=ROTOR):
        path = self.write("rotor.yaml", case)
        run = self.succeed("transient", path, "-o", "a.h5", "--set", f"transient={{{keys}}}")
        times, values, names, _ = series(self.folder / "a.h5")
        return run, times, dict(zip(names, values.T))

    def test_lost_generator_and_brake(self):
        # Free of its generator the rotor gains T/J; a brake of 300 N m takes 200/J.
        output = "output: {channels: [RotSpeed, Azimuth]}"
        events = ("events: [{at: 1.003, generator_off: true}, "
                  "{when: {channel: RotSpeed, above: 60}, brake: 300}]")
        run, times, values = self.run_rotor(f"duration: 6, step: 0.01, {events}, {output}")
        limit = 60 * 2 * numpy.pi / 60
        braked = 1.003 + (limit - 6) * INERTIA / 100
        expected = numpy.where(
            times < 1.003, 6,
            numpy.where(times < braked, 6 + 100 / INERTIA * (times - 1.003),
                        limit - 200 / INERTIA * (times - braked)))
        speed = values["RotSpeed"] * 2 * numpy.pi / 60
        numpy.testing.assert_allclose(speed, expected, rtol=2e-5)
        self.assertIn("transient.events[0] at t = 1.003 s", run.stdout)
        self.assertIn(f"transient.events[1] at t = {braked:.3f}"[:-1], run.stdout)

    def test_generator_and_brake_act_behind_the_gear(self):
        # The rotor of ROTOR behind a gear of 50, in either sense: inertia 50^2, torques 50 times.
        for ratio in ("50", "-50"):
            case = ROTOR.replace("torque: 100, own_inertia: 50", "torque: 2, own_inertia: 0.02")
            case = case.replace("  generator:", f"  gear_ratio: {ratio}\n  generator:")
            _, times, values = self.run_rotor(
                "duration: 4, step: 0.01, events: [{at: 1, generator_off: true}, "
                "{at: 3, brake: 6}], output: {channels: [RotSpeed, GenSpeed, GenTq, HSSBrTq]}", case)
            expected = numpy.where(
                times < 1, 6, numpy.where(times < 3, 6 + 100 / INERTIA * (times - 1),
                                          6 + 200 / INERTIA - 200 / INERTIA * (times - 3)))
            speed = values["RotSpeed"] * numpy.pi / 30
            numpy.testing.assert_allclose(speed, expected, rtol=2e-5)
            numpy.testing.assert_allclose(values["GenSpeed"], 50 * values["RotSpeed"], rtol=1e-12)
            # Torques in the middle of each part: by law, none, the brake.
            for time, generator, brake in ((0.5, 2, 0), (2, 0, 0), (3.5, 0, 6)):
                row = int(round(time / 0.01))
                self.assertAlmostEqual(1e3 * values["GenTq"][row], generator, delta=1e-5)
                self.assertAlmostEqual(1e3 * values["HSSBrTq"][row], brake, delta=1e-5)

    def test_events_survive_a_restart(self):
        keys = ("step: 0.01, checkpoint: 0.5, output: {channels: [RotSpeed, BldPitch1, RootMzb1]}, "
                "events: [{at: 0.25, generator_off: true}, {when: {channel: RotSpeed, above: 58}, "
                "pitch: {to_deg: 20, rate_deg: 10}}]")
        path = self.write("rotor.yaml", ROTOR)
        for name, parts in (("whole", (4,)), ("parts", (1.5, 4))):
            for i, duration in enumerate(parts):
                restart = ["--restart", f"{name}.h5"] if i > 0 else []
                self.samara("transient", path, "-o", f"{name}.h5", *restart, "--set",
                            f"transient={{duration: {duration}, {keys}}}")
        whole = series(self.folder / "whole.h5")
        parts = series(self.folder / "parts.h5")
        self.assertEqual(whole[1][-1][1], 20.0)
        numpy.testing.assert_array_equal(whole[1], parts[1])

    def test_pitch_ramp_loads_the_pitch_bearing(self):
        # A rotor at rest: the root carries I1 L times the angular acceleration, about -b1.
        case = ROTOR.replace("speed: 6", "speed: 0").replace("inertia: [2e-4, 1e-4, 1e-4]",
                                                             "inertia: [6, 3, 3]")
        case = case.replace("generator: {joint: free, torque: 100, own_inertia: 50}",
                            "generator: {joint: locked}").replace("  rotor: {torque: 100}\n", "")
        _, times, values = self.run_rotor(
            "duration: 3, step: 0.002, start: undeformed, output: {channels: [BldPitch1, "
            "RootMzb1]}, events: [{at: 1, pitch: {to_deg: 30, rate_deg: 30}}]", case)
        time = numpy.pi / 2  # of the ramp
        inside = (times > 1) & (times < 1 + time)
        phase = numpy.pi * (times - 1) / time
        angle = numpy.where(inside, 15 * (1 - numpy.cos(phase)), numpy.where(times <= 1, 0, 30))
        numpy.testing.assert_allclose(values["BldPitch1"], angle, atol=1e-9)
        acceleration = numpy.radians(15) * (numpy.pi / time) ** 2 * numpy.cos(phase)
        moment = numpy.where(inside, 6 * 10 * acceleration, 0) / 1e3
        calm = (times > 1.1) & (times < 1 + time - 0.1)
        numpy.testing.assert_allclose(values["RootMzb1"][calm], moment[calm], atol=2e-4)

    def test_an_actuator_limits_the_rate_of_the_pitch(self):
        # An event asks for 30 deg/s and 20 deg; the actuator gives 8 deg/s, and ends at 12 deg.
        case = ROTOR.replace("blades:", "blades:\n  pitch_actuator: {frequency: 6, damping_ratio: 0.7, "
                             "rate_limit_deg: 8, highest_deg: 12}")
        _, times, values = self.run_rotor(
            "duration: 6, step: 0.01, start: undeformed, output: {channels: [BldPitch1]}, "
            "events: [{at: 1, pitch: {to_deg: 20, rate_deg: 30}}]", case)
        pitch = values["BldPitch1"]
        rate = numpy.diff(pitch) / 0.01
        self.assertLess(numpy.abs(rate).max(), 8 + 1e-6)
        self.assertGreater(rate.max(), 7.9)
        self.assertLess(numpy.abs(pitch[times < 1]).max(), 1e-9)
        self.assertAlmostEqual(pitch[-1], 12, delta=1e-3)

    def test_controlled_rotors_restart_bit_by_bit_and_hold_their_speed(self):
        case = ROTOR.replace("generator: {joint: free, torque: 100", "generator: {joint: free")
        case = case.replace("blades:", "controller: {speed_filter: 3, torque: {proportional: 40, "
                            "integral: 20}}\ntuned_mass_dampers:\n  - {on: blades, at: 1, mass: 0.1, "
                            "lead_lag: {stiffness: 30, damping: 0.1}}\nblades:")
        keys = "step: 0.01, checkpoint: 0.5, output: {channels: [GenSpeed, GenTq, CtrlSpdErr, BStC1_B1_YQ]}"
        path = self.write("rotor.yaml", case)
        for name, parts in (("whole", (3,)), ("parts", (1.5, 3))):
            for i, duration in enumerate(parts):
                restart = ["--restart", f"{name}.h5"] if i > 0 else []
                self.succeed("transient", path, "-o", f"{name}.h5", *restart, "--set",
                             f"transient={{duration: {duration}, {keys}}}")
        whole = series(self.folder / "whole.h5")
        parts = series(self.folder / "parts.h5")
        numpy.testing.assert_array_equal(whole[1], parts[1])
        numpy.testing.assert_allclose(whole[1][:, 0], 60 * 3 / numpy.pi, rtol=1e-6)
        numpy.testing.assert_allclose(whole[1][:, 1], 0.1, rtol=1e-5)
        # A lost generator: no torque of the controller.
        _, times, values = self.run_rotor(
            "duration: 2, step: 0.01, output: {channels: [GenTq, GenSpeed]}, "
            "events: [{at: 1, generator_off: true}]", case)
        numpy.testing.assert_allclose(values["GenTq"][times > 1.02], 0, atol=1e-9)
        self.assertGreater(values["GenSpeed"][-1], values["GenSpeed"][0] + 0.1)

    def test_prescribed_speed_turns_and_loads_the_shaft(self):
        case = ROTOR.replace("generator: {joint: free, torque: 100, own_inertia: 50}",
                             "generator: {joint: locked}").replace("  rotor: {torque: 100}\n", "")
        for speed in ("{table: [[0, 6], [4, 8]]}", "{formula: 6 + 0.5*t}"):
            _, times, values = self.run_rotor(
                f"duration: 4, step: 0.01, start: undeformed, speed: {speed}, "
                "output: {channels: [RotSpeed, Azimuth, RotTorq]}", case)
            speeds = values["RotSpeed"] * numpy.pi / 30
            self.assertAlmostEqual(speeds[0], 6, delta=1e-4)  # of the step that finds the rates
            numpy.testing.assert_allclose(speeds[1:], (6 + 0.5 * times)[1:], rtol=1e-9)
            azimuth = numpy.degrees(6 * times + 0.25 * times**2)
            error = (values["Azimuth"] - azimuth + 180) % 360 - 180
            numpy.testing.assert_allclose(error, 0, atol=1e-7)
            late = times > 1
            numpy.testing.assert_allclose(values["RotTorq"][late], -(INERTIA - 50) * 0.5 / 1e3,
                                          rtol=1e-3)

    def test_teeter_stops_hold_the_teeter(self):
        # One blade is heavier: the rotor at rest falls against its stop, k (q - q0) = m g L cos q.
        case = """samara: 1
gravity: 10
shaft: {azimuth_deg: 0}
hub:
  inertia: [500, 5, 500]
  center_of_mass: 1
  mass: 100
  teeter: {damping: 300, stops: {angle_deg: 5, stiffness: 1e5, damping: 1e4}}
""" + ROTOR[ROTOR.index("blades:"):]
        _, _, values = self.run_rotor(
            "duration: 20, step: 0.01, start: undeformed, output: {channels: [TeetDefl]}", case)
        angle = numpy.radians(abs(values["TeetDefl"][-1]))
        self.assertAlmostEqual(1e5 * (angle - numpy.radians(5)), 100 * 10 * numpy.cos(angle),
                               delta=0.5)

    def test_event_that_never_comes(self):
        path = self.write("rotor.yaml", ROTOR)
        run = self.samara("transient", path, "-o", "a.h5", "--set",
                          "transient={duration: 1, step: 0.01, events: "
                          "[{when: {channel: RotSpeed, above: 99}, brake: 300}]}")
        self.assertEqual(run.returncode, 2)
        self.assertIn("transient.events[0] never came: RotSpeed was never above 99", run.stderr)
        self.assertEqual(series(self.folder / "a.h5")[3], "complete")

        def refuse(word, keys):
            with self.subTest(keys=keys):
                self.refuse("transient", path, "-o", "b.h5", "--set",
                            "transient={duration: 10, step: 0.01, " + keys + "}", words=[word])

        refuse("never comes: transient.duration is 10 s", "events: [{at: 11, brake: 3}]")
        refuse("did you mean \"RotSpeed\"",
               "events: [{when: {channel: RotSped, above: 1}, brake: 3}]")
        refuse("reaches from 0 to 5 s, the run from 0 to 10 s",
               "pitch_deg: {table: [[0, 0], [5, 10]]}")
        refuse("the generator is free", "speed: {formula: 6 + t}")
        refuse("Unexpected token", "pitch_deg: {formula: 3 + xyz*t}")
        refuse("there is no such blade", "events: [{at: 1, pitch: {blade: 3, to_deg: 1, rate_deg: 1}}]")


class Refusals(ProgramTest):
    def test_bad_keys(self):
        def refuse(word, keys):
            with self.subTest(keys=keys):
                self.refuse("transient", BASELINE, "--set", "transient={" + keys + "}",
                            words=[word])

        refuse("expected a number > 0", "duration: 1, step: 0")
        refuse("expected a number > 0", "duration: -1, step: 0.1")
        refuse("missing key \"step\"", "duration: 1")
        refuse("longer than transient.duration", "duration: 1, step: 2")
        refuse("multiple of transient.step", "duration: 1, step: 0.1, checkpoint: 0.25")
        refuse("did you mean \"RootMxb1\"",
               "duration: 1, step: 0.1, output: {channels: [RootMbx1]}")
        refuse("expected trim, undeformed or the name of a result", "duration: 1, step: 0.1, start: rest")

    def test_missing_block(self):
        self.refuse("transient", BASELINE, words=["missing key \"transient\"", "hint"])

    def test_restarts_that_cannot_be(self):
        path = self.write("case.yaml", MINIMAL)
        keys = block(duration=1, step=0.01)
        keys[1] = keys[1].replace(", TwrBsMyt, TTDspSS", "")
        self.succeed("transient", path, "-o", "a.h5", *keys)
        longer = [keys[0], keys[1].replace("duration: 1", "duration: 2")]
        self.refuse("transient", path, *longer, "--set", "shaft.speed=5", "-o", "b.h5",
                    "--restart", "a.h5", words=["another model", "shaft.speed: 6 there",
                                                "shaft.speed: 6 there, 5 here"])
        self.refuse("transient", path, *keys, "-o", "b.h5", "--restart", "a.h5",
                    words=["reaches to t = 1 s already"])
        self.refuse("transient", path, *longer, "-o", "b.h5", "--restart", "case.yaml",
                    words=["no result of samara"])
        self.refuse("trim", path, "--restart", "a.h5", words=["samara transient does"])

    def test_run_that_diverges_says_where_and_keeps_what_it_has(self):
        # A soft blade on which a load grows until it has turned by half a turn.
        path = self.write("case.yaml", MINIMAL.replace("speed: 6", "speed: 0") + """gravity: 0
loads:
  - {beam: blades, at: 1, moment: [0, -1000, 0], table: [[0, 0], [10, 10]]}
""")
        run = self.samara("transient", path, "-o", "a.h5", "--set",
                          "transient={duration: 10, step: 0.01, start: undeformed}")
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertIn("170 degrees", run.stderr)
        self.assertIn("the unknown that changes most: blade 1", run.stderr)
        times, values, _, status = series(self.folder / "a.h5")
        self.assertIn("failed", status)
        self.assertGreater(len(times), 10)
        self.assertTrue(numpy.isfinite(values).all())


if __name__ == "__main__":
    unittest.main()
