"""Signs of docs/words.md, each found by a run of a small turbine."""

import math
import re
import sys
import unittest

from support.program import ProgramTest

TURBINE = """samara: 1
tower:
  length: 50
  sections:
    - mass: 1000
      inertia: [20, 10, 10]
      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: rigid, EI2: 1e11, EI3: 1e11}
shaft: {speed: 1}
blades:
  count: 3
  length: 10
  sections:
    - mass: 10
      inertia: [2e-2, 1e-2, 1e-2]
      stiffness: {EA: rigid, GA2: rigid, GA3: rigid, GJ: 8e7, EI2: 1e6, EI3: 1e6}
"""
LEADING = "loads=[{beam: blade 1, at: 1, force: [0, 100, 0]}]"
DOWNWIND = "loads=[{beam: blade 1, at: 1, force: [0, 0, 100]}]"
RIGHT_OF_TOWER = "loads=[{beam: tower, at: 1, force: [0, 100, 0]}]"
DOWNWIND_OF_TOWER = "loads=[{beam: tower, at: 1, force: [0, 0, 100]}]"
UPWIND_ROTOR = "shaft.overhang=-5"
AIR = ["wind.speed=8", "blades.airfoils={plate: {polars: [{table: [[-180, 0, 0.01, 0], [180, 0, 0.01, 0]]}]}}",
       "blades.aero_sections=[{chord: 1, airfoil: plate}]", "aero.induction=none", "aero.airfoil_dynamics=static"]


class Signs(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("case.yaml", TURBINE)

    def arguments(self, settings):
        return [word for setting in settings for word in ("--set", setting)]

    def centre(self, part, *settings):
        """Centre of mass of a part, as check prints it."""
        text = self.succeed("check", "case.yaml", *self.arguments(settings)).stdout
        return [float(x) for x in re.search(rf"(?m)^{part} +\S+ +(\S+), (\S+), (\S+) ", text).groups()]

    def first(self, channel, *settings, **transient):
        """The least and the largest value of a channel near t = 0; their sign is the same."""
        keys = {"duration": 0.02, "step": 0.01, **transient}
        words = ", ".join(f"{key}: {value}" for key, value in keys.items())
        run = self.succeed("transient", "case.yaml", "--set", f"transient={{{words}, output: {{channels: [{channel}]}}}}",
                           *self.arguments(settings))
        least, _, largest, last = map(float, re.search(rf"(?m)^{channel} +\S+ +(\S+) +(\S+) +(\S+) +(\S+)$",
                                                       run.stdout).groups())
        return last if keys.get("start") else least if abs(least) > abs(largest) else largest

    def test_precone_moves_the_tips_downwind(self):
        self.assertGreater(self.centre("rotor", "blades.precone_deg=10")[1], 0.5)

    def test_tilt_raises_the_downwind_end(self):
        level = self.centre("turbine", UPWIND_ROTOR)
        tilted = self.centre("turbine", UPWIND_ROTOR, "shaft.tilt_deg=-5")
        self.assertLess(level[1], -0.01)  # the rotor is upwind
        self.assertGreater(tilted[2], level[2])

    def test_pitch_turns_the_leading_edge_upwind(self):
        self.assertLess(self.first("RootFyc1", LEADING), -0.09)
        self.assertLess(self.first("RootFxc1", LEADING, "blades.pitch_deg=90"), -0.09)

    def test_twist_turns_the_leading_edge_upwind(self):
        # The soft axis of bending turns from downwind toward the leading edge, against yc.
        moved = self.first("TipDyc1", DOWNWIND, "blades.sections.0.stiffness.EI3=1e9", "blades.sections.0.twist_deg=30")
        self.assertLess(moved, -0.01)

    def test_flap_is_positive_downwind_and_channels_have_the_signs_of_openfast(self):
        self.assertGreater(self.first("TipDxc1", DOWNWIND), 0.01)
        self.assertGreater(self.first("RootMyb1", DOWNWIND), 0.9)
        self.assertLess(self.first("TTDspSS", RIGHT_OF_TOWER), -1e-5)
        self.assertGreater(self.first("TwrBsMxt", RIGHT_OF_TOWER), 4)
        self.assertGreater(self.first("TwrBsMyt", DOWNWIND_OF_TOWER), 4)

    def test_yaw_is_counter_clockwise_from_above(self):
        # An upwind rotor goes to the right: its weight turns the ground about +x.
        yawed = ["gravity=9.81", UPWIND_ROTOR, "nacelle={mass: 1, yaw: {joint: prescribed, angle_deg: 90}}"]
        self.assertGreater(self.first("TwrBsMxt", *yawed), 14)
        self.assertAlmostEqual(self.first("NacYaw", *yawed), 90)

    def test_teeter_of_a_case_and_of_a_channel_are_opposite(self):
        hub = "hub={mass: 10, inertia: [1, 1, 1], teeter: {joint: %s}}"
        self.assertAlmostEqual(self.first("TeetDefl", "blades.count=2", hub % "prescribed, angle_deg: 5"), -5)
        moved = self.first("TeetDefl", "blades.count=2", hub % "free", DOWNWIND, duration=0.5, start="undeformed")
        self.assertGreater(moved, 1)

    def test_undersling_moves_the_apex_downwind(self):
        hub = "hub={mass: 10, inertia: [1, 1, 1], teeter: {joint: locked, undersling: 1}}"
        self.assertGreater(self.centre("rotor", "blades.count=2", hub)[1], 0.5)

    def test_azimuth_counts_with_the_turning(self):
        self.assertAlmostEqual(self.first("Azimuth", "shaft.azimuth_deg=30"), 31.15, 2)

    def test_wind_turns_counter_clockwise_and_rises(self):
        self.assertGreater(self.first("Wind1VelY", *AIR, "wind.direction_deg=20"), 2)  # to the left
        self.assertGreater(self.first("Wind1VelZ", *AIR, "wind.upflow_deg=20"), 2)

    def test_delta3_of_a_teeter_hinge_and_of_a_flap_hinge_are_opposite(self):
        # A force along the chord to the leading edge, which has then gone downwind, is thrust: the blade pitches by
        # 10 deg sin(45 deg), the part of the turn about the skewed axis along the blade.
        hinge = "blades.hinges=[{axis: flap, joint: prescribed, angle_deg: 10, delta3_deg: %d}]"
        thrust = [self.first("RotThrust", "hub.radius=1", LEADING, hinge % delta3) for delta3 in (0, 45)]
        self.assertAlmostEqual(thrust[1] - thrust[0], 0.1 * math.sin(math.radians(10 * math.sin(math.pi / 4))), 3)
        # A teeter angle < 0 moves blade 1 downwind; its leading edge then goes upwind.
        hub = "hub={mass: 10, inertia: [1, 1, 1], teeter: {joint: prescribed, angle_deg: -10, delta3_deg: %d}}"
        thrust = [self.first("RotThrust", "blades.count=2", LEADING, hub % delta3) for delta3 in (0, 45)]
        self.assertLess(thrust[1] - thrust[0], -0.005)

    def test_frequency_is_damped_and_the_damping_ratio_positive(self):
        run = self.succeed("modes", "case.yaml", "--parked", "--set", "blades.damping={flap: 0.2}", "--csv", "modes.csv")
        self.assertIn("log decr", run.stdout)
        rows = [line.split(",") for line in (self.folder / "modes.csv").read_text(encoding="utf-8").splitlines()
                if line and not line.startswith("#")]
        table = [dict(zip(rows[0], row)) for row in rows[1:]]
        damped = [row for row in table if 0.05 < float(row["damping_ratio"]) < 0.9]
        self.assertGreater(len(damped), 0)
        for row in damped:
            growth, speed = float(row["exponent_re"]), float(row["exponent_im"])
            self.assertAlmostEqual(float(row["frequency_hz"]), speed / 6.283185307179586, 6)
            self.assertAlmostEqual(float(row["damping_ratio"]), -growth / abs(complex(growth, speed)), 6)
            self.assertAlmostEqual(float(row["logarithmic_decrement"]), -6.283185307179586 * growth / speed, 5)


if __name__ == "__main__":
    sys.exit(unittest.main())
