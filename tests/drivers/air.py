"""Air around the rotor: the commands of samara with wind, their results and their errors."""

import math
import pathlib
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import SOURCE, ProgramTest  # noqa: E402

LAND = SOURCE / "inputs/nrel5mw/land.yaml"
WING = SOURCE / "inputs/goland/wing.yaml"
QUICK = ["--set", "blades.elements=2", "--set", "blades.order=3", "--set", "tower.order=3"]
WIND = ["--set", "wind.speed=8", "--set", "shaft.speed_rpm=9.155"]
OPERATION = ["--set", "operation.wind_speeds=[8,16]"]


class Commands(ProgramTest):
    def test_check_prints_wind_and_models(self):
        text = self.succeed("check", LAND, *WIND).stdout
        self.assertIn("tip-speed ratio", text)
        self.assertIn("hgm", text)

    def test_operation_in_all_forms(self):
        text = self.succeed("operate", LAND, *QUICK, "--set", "wind.speed=8", *OPERATION, "-o",
                            "points.h5", "--csv", "points.csv", "--set", "operation.opt=points.opt").stdout
        self.assertIn("torque law", text)
        self.assertIn("rated power", text)
        with h5py.File(self.folder / "points.h5") as file:
            group = file["operation"]
            numpy.testing.assert_array_equal(group["wind_speed"][:], [8.0, 16.0])
            pitch = group["pitch"][:]
            speed = group["rotor_speed"][:]
            power = group["power"][:]
            self.assertEqual(group["power"].attrs["unit"], "W")
        rows = [line.split(",") for line in (self.folder / "points.csv").read_text().splitlines()]
        column = rows[0].index("power")
        numpy.testing.assert_allclose([float(row[column]) for row in rows[1:]], power, rtol=1e-12)
        lines = (self.folder / "points.opt").read_text().splitlines()
        self.assertEqual(lines[0].split()[0], "2")
        for i, line in enumerate(lines[1:]):
            values = [float(word) for word in line.split()]
            numpy.testing.assert_allclose(
                values[1:4], [math.degrees(pitch[i]), speed[i] * 30 / math.pi, power[i] / 1e3],
                rtol=1e-4, atol=1e-5)
        # Its own table gives the same points.
        again = self.succeed("operate", LAND, *QUICK, "--set", "wind.speed=8", "--set",
                             "operation={table: points.opt}", "-o", "again.h5").stdout
        self.assertIn("table", again)
        with h5py.File(self.folder / "again.h5") as file:
            numpy.testing.assert_allclose(file["operation/power"][:], power, rtol=1e-4)

    def test_operation_needs_its_keys(self):
        wind = ["--set", "wind.speed=8"]
        self.refuse("operate", LAND, "--set", "aero=none", words="operating points need wind")
        self.refuse("operate", LAND, *wind, "--set",
                    "operation={rated_speed_rpm: 12.1, torque_gain: 2}",
                    words='missing key "rated_power"')
        self.refuse("operate", LAND, *wind, "--set", "operation={table: none.opt}",
                    words="none.opt")
        self.refuse("operate", LAND, *QUICK, "--set", "wind.speed=2", "-o", "none.h5",
                    words="does not drive the rotor")
        self.write("notes.txt", "not a table")
        self.refuse("operate", LAND, *wind, "--set", "operation.opt=notes.txt",
                    words="is no table of operating points")

    def test_channels_of_the_air_agree_with_each_other(self):
        """Power, thrust and torque of the air from its distributed loads; the rotor's torque on the
        shaft is that of the air in a steady state."""
        self.succeed("transient", LAND, *QUICK, *WIND, "--set", "gravity=0", "--set",
                     "shaft.tilt_deg=0", "--set", "transient={duration: 0.5, step: 0.01, output: "
                     "{channels: [RtAeroFxh, RtAeroMxh, RtAeroPwr, RtAeroCp, RtAeroCt, RtTSR, "
                     "RtVAvgxh, RotTorq, RotSpeed, B1N4Alpha, B1N4VRel, B1N4Fx, B1N4Cl, B1N4Phi]}}",
                     "-o", "run.h5")
        with h5py.File(self.folder / "run.h5") as file:
            names = [name.decode() if isinstance(name, bytes) else name
                     for name in file["transient/channel_name"][:]]
            self.succeed("export", "run.h5", "-o", "run.csv")
        rows = (self.folder / "run.csv").read_text().splitlines()
        head = [name.split(" ")[0].strip('"') for name in rows[0].split(",")]
        last = dict(zip(head, [float(word) for word in rows[-1].split(",")]))
        self.assertTrue(set(names) <= set(head))
        speed = last["RotSpeed"] * math.pi / 30
        self.assertAlmostEqual(last["RtAeroPwr"] / (last["RtAeroMxh"] * speed), 1.0, places=6)
        self.assertAlmostEqual(last["RotTorq"] * 1e3 / last["RtAeroMxh"], 1.0, places=3)
        # The apex still moves a little with the tower.
        self.assertAlmostEqual(last["RtVAvgxh"], 8.0, places=3)
        radius = last["RtTSR"] * last["RtVAvgxh"] / speed
        disk = 0.5 * 1.225 * math.pi * radius**2
        self.assertAlmostEqual(last["RtAeroCp"], last["RtAeroPwr"] / (disk * 8.0**3), places=3)
        self.assertAlmostEqual(last["RtAeroCt"], last["RtAeroFxh"] / (disk * 8.0**2), places=3)
        self.assertTrue(0.3 < last["RtAeroCp"] < 16 / 27)  # Betz's limit
        self.assertTrue(0 < last["B1N4Phi"] < 15)


if __name__ == "__main__":
    unittest.main()
