"""Controllers in shared libraries (transient.controller): laws against those of a case, records, and libraries that
fail in all ways."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import LONGEST_RUN, PROGRAM, SOURCE, ProgramTest  # noqa: E402

LIBRARIES = pathlib.Path(os.environ["SAMARA_CONTROLLERS"])
GEAR = 97.0
SPEED = 1.2  # of the rotor [rad/s]
TORQUE = 4.0e6 / GEAR  # of the generator [N m]
GAIN = TORQUE / (SPEED * GEAR) ** 2
CORNER, PROPORTIONAL, INTEGRAL, SCHEDULE = 1.570796, 0.0188, 0.008, 0.11

# A rigid rotor whose speed its pitch holds.
ROTOR = """samara: 1
gravity: 0
shaft:
  speed: 1.2
  gear_ratio: 97
  generator: {joint: free, own_inertia: 500%s}
  rotor: {torque: 4.0e+6, torque_slope: -1.0e+6, torque_pitch_slope: -5.0e+7}
hub: {radius: 1.5, mass: 100, inertia: [10, 10, 10]}
blades:
  count: 3
  length: 60
  elements: 1
  order: 3
  sections: [{mass: 300, inertia: [0, 0, 0], stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: rigid, EI3: rigid}}]
"""
ACTUATOR = "  pitch_actuator: {frequency: 6.3, damping_ratio: 0.7, rate_limit_deg: 8}\n"
CONTROLLER = (f"controller:\n  speed_filter: {CORNER}\n  pitch: {{proportional: {PROPORTIONAL}, integral: {INTEGRAL}, "
              f"gain_schedule_deg: {numpy.degrees(SCHEDULE)}}}\n")
LAW = f"{GAIN} {CORNER} {SPEED * GEAR} {PROPORTIONAL} {INTEGRAL} {SCHEDULE}\n"
CHANNELS = ["GenSpeed", "BldPitch1", "GenTq"]


def quadratic_torque():
    """The table of k w^2 over the speed of the generator."""
    speeds = numpy.linspace(0.5, 1.5, 401) * SPEED * GEAR
    return ", torque_table: [" + ", ".join(f"[{w:.12g}, {GAIN * w * w:.12g}]" for w in speeds) + "]"


def transient(controller="", **keys):
    """The key `transient`; `controller`: the keys of the library, or none."""
    all_keys = {"duration": 2, "step": 0.01, **keys}
    words = ", ".join(f"{key}: {value}" for key, value in all_keys.items())
    library = f", controller: {{{controller}}}" if controller else ""
    channels = f"output: {{channels: [{', '.join(CHANNELS)}]}}"
    return ["--set", f"transient={{{words}{library}, {channels}}}"]


def library(name, text="", step=0.01, **keys):
    words = "".join(f", {key}: {value}" for key, value in keys.items())
    given = f", input: {text}" if text else ""
    return f"library: '{LIBRARIES / name}.so'{given}, step: {step}{words}"


def series(path):
    with h5py.File(path, "r") as file:
        group = file["transient"]
        return group["time"][:], group["values"][:], group.attrs["status"]


class Laws(ProgramTest):
    """The same law as states of the equations and as a library, after a brake of a tenth of the torque."""

    EVENTS = "[{at: 2, brake: 4000}]"
    DURATION = 20

    def inside(self, actuator):
        path = self.write("inside.yaml", ROTOR % quadratic_torque() + actuator + CONTROLLER)
        self.succeed("transient", path, "-o", "inside.h5", *transient(duration=self.DURATION, events=self.EVENTS))
        return series(self.folder / "inside.h5")[1]

    def outside(self, actuator, step, ranks=None, **keys):
        path = self.write("outside.yaml", ROTOR % "" + actuator)
        self.write("law.txt", LAW)
        run = self.succeed("transient", path, "-o", "outside.h5", ranks=ranks,
                           *transient(library("pi", "law.txt", step, **keys), duration=self.DURATION,
                                      events=self.EVENTS))
        self.assertIn("controller   ", run.stdout)
        self.assertNotIn("note", run.stderr)
        return series(self.folder / "outside.h5")[1]

    def differences(self, wanted, actuator, step):
        """Largest difference of each channel, relative to its largest excursion."""
        found = self.outside(actuator, step)
        span = numpy.ptp(wanted, axis=0)
        return numpy.abs(found - wanted).max(axis=0) / span

    def check_order(self, actuator, largest):
        wanted = self.inside(actuator)
        self.assertGreater(numpy.ptp(wanted[:, 1]), 0.3)  # the pitch moves [deg]
        coarse = self.differences(wanted, actuator, 0.04)
        fine = self.differences(wanted, actuator, 0.01)
        # The demand is late by half an interval with actuators, by 1.5 without: an error of first order.
        self.assertLess(fine.max(), largest, (coarse, fine))
        numpy.testing.assert_array_less(fine, 0.45 * coarse)

    def test_a_library_is_the_law_of_the_case_without_actuators(self):
        self.check_order("", 0.02)

    def test_a_library_commands_the_actuators(self):
        self.check_order(ACTUATOR, 0.02)

    def test_individual_demands_and_ranks_give_the_same_series(self):
        one = self.outside("", 0.02)
        numpy.testing.assert_array_equal(one, self.outside("", 0.02, individual_pitch="true"))
        numpy.testing.assert_array_equal(one, self.outside("", 0.02, ranks=2))

    def test_the_rate_of_a_prescribed_pitch_has_its_limit(self):
        values = self.outside("", 0.02, pitch_rate_limit_deg=0.2)
        rates = numpy.diff(values[:, 1]) / 0.01
        self.assertLess(numpy.abs(rates).max(), 0.2 * (1 + 1e-6))
        self.assertGreater(numpy.abs(rates).max(), 0.1999)


class Records(ProgramTest):
    def test_records_are_those_of_the_turbine(self):
        path = SOURCE / "inputs/nrel5mw/land.yaml"
        names = ["BldPitch1", "BldPitch2", "RootMyc3", "RootMxc2", "RotPwr", "GenSpeed", "RotSpeed", "GenTq",
                 "NacYaw", "Azimuth", "YawBrTAxp", "YawBrTAyp", "LSSTipMya", "LSSTipMzs", "YawBrMyn", "RotTorq",
                 "RotThrust", "LSShftFys", "LSShftFzs", "Wind1VelX", "Wind1VelY"]
        self.succeed("transient", path, "-o", "run.h5", "--set", "blades.elements=2", "--set", "tower.elements=2",
                     "--set", "wind={speed: 9, direction_deg: 10}", "--set", "trim.harmonics=2", "--set",
                     "shaft.generator.joint=free", "--set",
                     f"transient={{duration: 0.2, step: 0.01, controller: {{{library('recorder', '', 0.05)}, "
                     f"efficiency: 0.944}}, output: {{channels: [{', '.join(names)}]}}}}")
        lines = (self.folder / "run.records").read_text().splitlines()
        calls = [{int(n): float(v) for n, v in (pair.split(":") for pair in line.split())} for line in lines]
        self.assertEqual([call[1] for call in calls], [0, 1, 1, 1, -1])
        numpy.testing.assert_allclose([call[2] for call in calls], [0, 0.05, 0.1, 0.15, 0.2], rtol=1e-6)
        with h5py.File(self.folder / "run.h5") as file:
            rows = file["transient/values"][:]
        degree, rpm = numpy.pi / 180, numpy.pi / 30
        factors = {4: ("BldPitch1", degree), 33: ("BldPitch2", degree), 32: ("RootMyc3", 1e3), 70: ("RootMxc2", 1e3),
                   14: ("RotPwr", 1e3), 20: ("GenSpeed", rpm), 21: ("RotSpeed", rpm), 23: ("GenTq", 1e3),
                   37: ("NacYaw", degree), 60: ("Azimuth", degree), 53: ("YawBrTAxp", 1), 54: ("YawBrTAyp", 1),
                   73: ("LSSTipMya", 1e3), 76: ("LSSTipMzs", 1e3), 77: ("YawBrMyn", 1e3), 109: ("RotTorq", 1e3),
                   110: ("RotThrust", 1e3), 111: ("LSShftFys", 1e3), 112: ("LSShftFzs", 1e3)}
        for i, call in enumerate(calls):
            row = dict(zip(names, rows[5 * i]))
            for number, (name, factor) in factors.items():
                self.assertAlmostEqual(call[number], row[name] * factor, msg=(i, number),
                                       delta=2e-6 * (abs(row[name] * factor) + 1e-6))
            self.assertAlmostEqual(call[27], numpy.hypot(row["Wind1VelX"], row["Wind1VelY"]), places=5)
            error = numpy.arctan2(row["Wind1VelY"], row["Wind1VelX"]) - row["NacYaw"] * degree
            self.assertAlmostEqual(call[24], error, places=6)
            self.assertAlmostEqual(call[15], 0.944 * call[23] * call[20], delta=1e-4 * call[15])
            for number, value in ((3, 0.05), (10, 0), (28, 0), (35, 1), (50, 1), (61, 3), (129, 5000)):
                self.assertAlmostEqual(call[number], value, places=6)
            self.assertEqual(call[51], call[9002] + 1)
        self.assertAlmostEqual(calls[0][24], numpy.radians(10), places=3)
        # A torque that is held goes on as in the steady state.
        self.assertAlmostEqual(rows[-1][names.index("GenTq")] / rows[0][names.index("GenTq")], 1, places=3)


class Failures(ProgramTest):
    """A library fails at 0.5 s: one line, exit code 3, and the rows so far."""

    def case(self, fault, at=0.5):
        self.write("fault.txt", f"{fault} {at}\n")
        return self.write("case.yaml", ROTOR % "")

    def fail(self, fault, words, **keys):
        path = self.case(fault)
        run = self.samara("transient", path, "-o", "a.h5", *transient(library("faulty", "fault.txt", **keys)))
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertEqual(run.stdout, "")
        lines = [line for line in run.stderr.splitlines() if "transient.controller" in line]
        self.assertEqual(len(lines), 1, run.stderr)
        self.assertRegex(lines[0], r"^samara: transient\.controller: faulty\.so ")
        self.assertIn("at t = 0.5 s", lines[0])
        for word in words:
            self.assertIn(word, lines[0])
        times, values, status = series(self.folder / "a.h5")
        self.assertIn("failed", status)
        numpy.testing.assert_allclose(times, 0.01 * numpy.arange(51), atol=1e-9)
        self.assertTrue(numpy.isfinite(values).all())
        return run

    def test_exit(self):
        self.fail("exit", ["ended its process (exit code 7)"])

    def test_abort_and_crash(self):
        self.fail("abort", ["crashed (Aborted)"])
        self.fail("crash", ["crashed (Segmentation fault)"])

    def test_hang(self):
        begin = time.monotonic()
        self.fail("hang", ["did not return within 0.5 s"], timeout=0.5)
        self.assertLess(time.monotonic() - begin, 60)

    def test_no_numbers(self):
        self.fail("nan_torque", ["gives nan as the torque (record 47)"])
        self.fail("infinite_pitch", ["gives inf as the pitch (record 45)"])

    def test_a_failure_that_it_reports(self):
        self.fail("fail", ["reports a failure", ": the pitch bearing is stuck"])

    def test_failure_on_two_ranks(self):
        run = self.samara("transient", self.case("abort"), "-o", "a.h5", ranks=2,
                          *transient(library("faulty", "fault.txt")))
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertEqual(run.stderr.count("crashed (Aborted) in its call at t = 0.5 s"), 1)

    def test_a_text_that_is_too_long(self):
        run = self.samara("transient", self.case("overrun"), "-o", "a.h5", *transient(library("faulty", "fault.txt")))
        self.assertIn(run.returncode, (0, 3), run.stderr)

    def test_what_it_prints_is_no_output_of_the_program(self):
        run = self.succeed("transient", self.case("print"), "-o", "a.h5", *transient(library("faulty", "fault.txt")))
        self.assertNotIn("of the library", run.stdout)
        self.assertIn("a word of the library", run.stderr)
        self.assertIn("a complaint of the library", run.stderr)

    def test_warnings_and_demands_that_are_not_followed_are_noted_once(self):
        for fault, words in (("warn", "warns at t = 0.5 s: the oil is warm"),
                             ("yaw", "asks for a yaw rate of 0.01, which is not followed (record 48)"),
                             ("brake", "asks for the brake, state 1, which is not followed (record 36)")):
            run = self.succeed("transient", self.case(fault), "-o", "a.h5",
                               *transient(library("faulty", "fault.txt")))
            self.assertEqual(run.stderr.count(words), 1, run.stderr)

    def test_an_open_contactor_takes_the_torque_away(self):
        self.succeed("transient", self.case("off"), "-o", "a.h5", *transient(library("faulty", "fault.txt")))
        values = series(self.folder / "a.h5")[1]
        self.assertAlmostEqual(values[50, 2], TORQUE / 1e3, places=3)
        self.assertLess(abs(values[60:, 2]).max(), 1e-3)

    def test_a_crash_in_the_last_call_is_noted(self):
        run = self.succeed("transient", self.case("crash_at_end", 100), "-o", "a.h5",
                           *transient(library("faulty", "fault.txt")))
        self.assertIn("this was its last call, the result is complete", run.stderr)
        self.assertEqual(series(self.folder / "a.h5")[2], "complete")

    def test_another_procedure(self):
        self.succeed("transient", self.case("none"), "-o", "a.h5",
                     *transient(library("faulty", "fault.txt", procedure="discon_")))


class Process(ProgramTest):
    def helpers(self, parent):
        """Its children, by the files of the kernel: number, (name), state, parent."""
        found = []
        for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                number, name, _, owner = path.read_text().split()[:4]
            except (OSError, ValueError):  # it has ended
                continue
            if owner == str(parent) and name.startswith("(samara-control"):
                found.append(int(number))
        return found

    def start(self, duration):
        path = self.write("case.yaml", ROTOR % "")
        command = [PROGRAM, "transient", path, "-o", "a.h5",
                   *transient(library("recorder", "", 1), duration=duration)]
        run = subprocess.Popen(list(map(str, command)), cwd=self.folder, text=True, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, start_new_session=True)
        end = time.monotonic() + LONGEST_RUN
        while not (self.folder / "a.h5").exists():
            self.assertLess(time.monotonic(), end)
            self.assertIsNone(run.poll())
            time.sleep(0.02)
        return run, self.helpers(run.pid)

    def test_a_killed_run_takes_its_helper_along(self):
        run, helpers = self.start(100000)
        self.assertEqual(len(helpers), 1)
        run.send_signal(signal.SIGKILL)
        run.communicate(timeout=LONGEST_RUN)
        end = time.monotonic() + 20
        while pathlib.Path(f"/proc/{helpers[0]}/stat").exists() and time.monotonic() < end:
            if " Z " in pathlib.Path(f"/proc/{helpers[0]}/stat").read_text():
                break
            time.sleep(0.05)
        else:
            self.assertLess(time.monotonic(), end, "the helper goes on")

    def test_an_interrupted_run_ends_in_good_order_and_cannot_be_continued(self):
        run, _ = self.start(100000)
        os.killpg(run.pid, signal.SIGINT)  # as a terminal does, to the helper, too
        _, err = run.communicate(timeout=LONGEST_RUN)
        self.assertEqual(run.returncode, 130, err)
        self.assertIn(" 1:-1 ", (self.folder / "a.records").read_text().splitlines()[-1])
        self.assertNotIn("--restart", err)
        self.assertEqual(series(self.folder / "a.h5")[2], "interrupted")

    def test_a_program_without_its_helper_says_so(self):
        alone = self.folder / "bin/samara"
        alone.parent.mkdir()
        shutil.copy2(PROGRAM, alone)
        shutil.copy2(f"{PROGRAM}-program", alone.parent)
        path = self.write("case.yaml", ROTOR % "")
        self.write("law.txt", LAW)
        run = subprocess.run([alone, "transient", path, "-o", "a.h5", *transient(library("pi", "law.txt"))],
                             cwd=self.folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertIn("bin/samara-controller-host is missing", run.stderr)

    def test_events_act_beside_a_library(self):
        path = self.write("case.yaml", ROTOR % "")
        events = ("[{at: 0.503, pitch: {to_deg: -1, rate_deg: 2}}, {when: {channel: GenSpeed, above: 1113}, "
                  "generator_off: true}]")
        run = self.succeed("transient", path, "-o", "a.h5",
                           *transient(library("recorder", "", 0.02), events=events))
        self.assertIn("transient.events[1] at t = ", run.stdout)
        values = series(self.folder / "a.h5")[1]
        self.assertAlmostEqual(values[50, 1], 0, places=9)
        self.assertAlmostEqual(values[-1, 1], -1, places=9)
        self.assertLess(abs(values[-1, 2]), 1e-6)
        # Steps that an event repeats are not called again.
        times = [float(re.search(r" 2:(\S+)", line)[1])
                 for line in (self.folder / "a.records").read_text().splitlines()]
        numpy.testing.assert_allclose(times, 0.02 * numpy.arange(101), atol=1e-6)

    def test_restarts_are_refused_with_the_reason(self):
        path = self.write("case.yaml", ROTOR % "")
        self.write("law.txt", LAW)
        law = library("pi", "law.txt")
        self.succeed("transient", path, "-o", "a.h5", *transient(law, duration=0.1))
        self.refuse("transient", path, "-o", "a.h5", "--restart", "a.h5", *transient(law, duration=0.2),
                    words="the library's memory was lost")
        self.refuse("transient", path, "-o", "b.h5", *transient(duration=0.1, start="a.h5"),
                    words=["the demands at its end are lost"])
        # A run of a library starts from one without.
        self.succeed("transient", path, "-o", "c.h5", *transient(duration=0.1))
        self.succeed("transient", path, "-o", "d.h5", *transient(law, duration=0.1, start="c.h5"))


class Refusals(ProgramTest):
    def check(self, words, controller, text=ROTOR % "", **keys):
        path = self.write("case.yaml", text)
        self.write("law.txt", LAW)
        return self.refuse("transient", path, "-o", "a.h5", *transient(controller, **keys), words=words)

    def test_files_that_are_not_there(self):
        self.check(["transient.controller.library", "none.so: no such file"], "library: none.so")
        self.check(["transient.controller.input", "none.txt: no such file"], library("pi", "none.txt"))
        self.check(["transient.controller.library", "is a folder"], f"library: '{LIBRARIES}'")

    def test_what_is_no_library_for_this_machine(self):
        elf = bytearray((LIBRARIES / "pi.so").read_bytes())
        elf[4] = 1  # 32 bit
        self.write("narrow.so", bytes(elf))
        self.check(["narrow.so: cannot be loaded", "ELFCLASS32", "hint"], "library: narrow.so")
        self.write("text.so", "no library\n")
        self.check(["text.so: cannot be loaded", "hint"], "library: text.so")
        self.check(["at_load.so: ended its process (exit code 5) while it was loaded"], library("at_load"))

    def test_a_procedure_that_is_not_there(self):
        self.check(['has no procedure "discon"', "hint"], library("pi", "law.txt", procedure="discon"))

    def test_cases_that_have_no_use_for_it(self):
        locked = (ROTOR % "").replace("joint: free", "joint: locked")
        self.check(["transient.controller", "the generator, which is locked", "joint: free"],
                   library("pi", "law.txt"), locked)
        self.check(["controller", "exclude each other"], library("pi", "law.txt"), ROTOR % "" + CONTROLLER)
        self.check(["pitch_deg", "sets the pitch"], library("pi", "law.txt"),
                   pitch_deg="{table: [[0, 0], [2, 0]]}")
        self.check(["step", "a multiple of transient.step"], library("pi", "law.txt", 0.015))
        self.check(["missing key \"library\""], "step: 0.01")

    def test_the_helper_says_what_it_is(self):
        run = subprocess.run([pathlib.Path(PROGRAM).parent / "samara-controller-host"], capture_output=True,
                             text=True, check=False, stdin=subprocess.DEVNULL)
        self.assertEqual(run.returncode, 2)
        self.assertTrue(re.match("samara-controller-host: only samara", run.stderr))


if __name__ == "__main__":
    unittest.main()
