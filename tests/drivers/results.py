"""The HDF5 result and the table: names, attributes, atomicity."""

import csv
import pathlib
import subprocess
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import (  # noqa: E402
    BASELINE,
    LONGEST_RUN,
    MINIMAL,
    PROGRAM,
    QUICK,
    SOURCE,
    ProgramTest,
)

FLOQUET = [  # names of docs/case_file.md
    "/case", "/trim/harmonics", "/trim/residual", "/floquet/multipliers", "/floquet/exponents",
    "/floquet/frequency_hz", "/floquet/frequency_per_rev", "/floquet/damping_ratio",
    "/floquet/harmonic", "/floquet/label", "/floquet/participation", "/floquet/modes",
]


def datasets(file):
    """All datasets of a file by name."""
    found = {}
    file.visititems(lambda name, item: found.update({"/" + name: item})
                    if isinstance(item, h5py.Dataset) else None)
    return found


class Floquet(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("floquet", BASELINE, "--set", "gravity=9.81", "--csv", "modes.csv",
                     "-floquet_eps_type", "lapack")
        self.file = h5py.File(self.folder / "article_mesh.h5", "r")
        self.addCleanup(self.file.close)

    def test_all_names_are_there_with_their_attributes(self):
        found = datasets(self.file)
        for name in FLOQUET:
            self.assertIn(name, found)
        for name, dataset in found.items():
            with self.subTest(name=name):
                self.assertIsInstance(dataset.attrs["unit"], str)
                self.assertTrue(dataset.attrs["frame"])
                self.assertTrue(dataset.attrs["description"])

    def test_the_run_is_recorded(self):
        text = self.file["/case"].asstr()[()]
        self.assertEqual(text, "# --set gravity=9.81\n" + BASELINE.read_text(encoding="utf-8"))
        attributes = self.file.attrs
        self.assertEqual(attributes["samara_schema"], 1)
        self.assertIn("--set gravity=9.81", attributes["command_line"])
        self.assertIn("-floquet_eps_type lapack", attributes["petsc_options"])
        for library in ("Petsc", "SLEPc", "MPI", "HDF5"):
            self.assertIn(library, attributes["libraries"])
        for name in ("program", "time", "title", "ranks"):
            self.assertIn(name, attributes)

    def test_pairs_and_reals_are_twice_the_degrees_of_freedom(self):
        group = self.file["/floquet"]
        multipliers = group["multipliers"][:]
        pairs = numpy.count_nonzero(multipliers[:, 1])
        reals = len(multipliers) - pairs
        self.assertEqual(2 * pairs + reals, 2 * group.attrs["degrees_of_freedom"])
        self.assertEqual(group.attrs["degrees_of_freedom"], 38)

    def test_rows_are_sorted_and_consistent(self):
        group = self.file["/floquet"]
        speed = group.attrs["rotor_speed"]
        rates, frequencies = group["exponents"][:].T
        self.assertTrue(numpy.all(frequencies >= 0))
        # The slowest first, those that are not resolved behind the others.
        resolved = group["resolved"][:] == 1
        self.assertTrue(numpy.all(numpy.diff(resolved.astype(int)) <= 0))
        for some in (resolved, ~resolved):
            self.assertTrue(numpy.all(numpy.diff(frequencies[some]) >= 0))
        for name, unit in (("frequency_hz", 2 * numpy.pi), ("frequency_per_rev", speed)):
            numpy.testing.assert_allclose(group[name][:] * unit, frequencies, rtol=1e-14)
        # exp(lambda T) is the multiplier, whatever harmonic was identified.
        period = self.file["/model/period"][()]
        multipliers = group["multipliers"][:] @ [1, 1j]
        steps = group["step_exponents"][:] @ [1, 1j]
        numpy.testing.assert_allclose(numpy.exp(steps * period), multipliers, rtol=1e-9)
        # The step maps an exponent by the diagonal Pade approximant of exp of its order.
        step = group.attrs["step"]
        self.assertEqual(group.attrs["order"], 6)
        x = ((rates + 1j * frequencies) * step)[resolved]
        above, below = (1 + s * x / 2 + x**2 / 10 + s * x**3 / 120 for s in (1, -1))
        numpy.testing.assert_allclose(above / below, numpy.exp(steps * step)[resolved], rtol=1e-9)
        self.assertLessEqual(len(rates), group.attrs["states_found"])
        self.assertEqual(group.attrs["states_found"] + group.attrs["states_deflated"], group.attrs["states"])
        self.assertEqual(len(group["label"]), len(rates))

    def test_participations_and_parts_are_shares(self):
        group = self.file["/floquet"]
        self.assertEqual(group["participation"].shape,
                         (len(group["label"]), len(group["participation_harmonic"])))
        for name in ("participation", "part_share"):
            numpy.testing.assert_allclose(group[name][:].sum(axis=1), 1.0, atol=1e-6)

    def test_shapes_have_the_axes_that_are_promised(self):
        shapes = self.file["/floquet/modes"]
        unknowns = self.file["/model/unknowns/name"]
        times = self.file["/floquet/mode_times"]
        self.assertEqual(shapes.shape,
                         (len(self.file["/floquet/label"]), len(times), len(unknowns), 2))
        self.assertTrue(numpy.all(numpy.diff(times[:]) > 0))
        position = self.file["/model/unknowns/role"].asstr()[:] == "position"
        resolved = self.file["/floquet/resolved"][:] == 1
        self.assertTrue(resolved.any() and not resolved.all())
        largest = numpy.abs(shapes[:] @ [1, 1j])[:, :, position].max(axis=(1, 2))
        numpy.testing.assert_allclose(largest[resolved], 1.0, rtol=1e-5)
        self.assertTrue(numpy.isnan(shapes[:][~resolved]).all())

    def test_places_of_the_nodes_are_those_of_the_unknowns(self):
        names = list(self.file["model/unknowns/name"].asstr()[:])
        geometry = self.file["geometry"]
        parts = geometry["part"].asstr()[:]
        top = numpy.flatnonzero(parts == "tower")[-1]
        moved = geometry["place"][:, top] - geometry["undeformed"][:, top]
        series = self.file["trim/harmonics"][:]
        phase = self.file["model/rotor_speed"][()] * geometry["time"][:]
        basis = [numpy.ones_like(phase)]
        for k in range(1, series.shape[1] // 2 + 1):
            basis += [numpy.cos(k * phase), numpy.sin(k * phase)]
        rows = [names.index(f"tower top u{i}") for i in (1, 2, 3)]
        up, side, downwind = series[rows] @ numpy.array(basis)
        numpy.testing.assert_allclose(moved, numpy.transpose([downwind, -side, up]), atol=1e-12)
        # In a mode the top moves as its shape says.
        shape = self.file["floquet/modes"][:, :, rows, :]
        motion = self.file["floquet/node_motion"][:, :, top, :3, :]
        known = self.file["floquet/resolved"][:] == 1
        expected = numpy.stack([shape[:, :, 2], -shape[:, :, 1], shape[:, :, 0]], axis=2)
        numpy.testing.assert_allclose(motion[known], expected[known], atol=2e-6)
        self.assertTrue((abs(numpy.linalg.norm(geometry["axes"][:], axis=-1) - 1) < 1e-12).all())

    def test_trim_has_a_row_an_unknown(self):
        harmonics = self.file["/trim/harmonics"]
        self.assertEqual(harmonics.shape, (len(self.file["/model/unknowns/name"]), 2 * 4 + 1))
        self.assertEqual(self.file["/trim"].attrs["harmonics"], 4)
        self.assertEqual(self.file["/trim/residual"].shape, (2,))

    def test_the_table_agrees_to_the_last_digit(self):
        group = self.file["/floquet"]
        with open(self.folder / "modes.csv", newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual(len(rows), len(group["label"]))
        for name in ("frequency_hz", "frequency_per_rev", "damping_ratio", "harmonic", "residual",
                     "resolved"):
            numpy.testing.assert_array_equal([float(row[name]) for row in rows], group[name][:])
        for name in ("exponent", "multiplier"):
            numpy.testing.assert_array_equal(
                [[float(row[name + "_re"]), float(row[name + "_im"])] for row in rows],
                group[name + "s"][:])
        labels = group["label"].asstr()[:]
        self.assertEqual([row["label"] for row in rows],
                         [label.removesuffix(" (unresolved)") for label in labels])
        numpy.testing.assert_array_equal([label.endswith(" (unresolved)") for label in labels],
                                         group["resolved"][:] == 0)


class Others(ProgramTest):
    def test_modes_have_the_names_that_make_sense(self):
        self.succeed("modes", BASELINE, "--set", "shaft.speed=0", "--csv", "modes.csv")
        with h5py.File(self.folder / "article_mesh.h5") as file:
            group = file["/modes"]
            for name in ("exponents", "frequency_hz", "damping_ratio", "label", "modes"):
                self.assertIn(name, group)
            self.assertNotIn("multipliers", group)
            self.assertNotIn("/floquet", file)
            imaginary = group["exponents"][:, 1]
            count = len(imaginary) + numpy.count_nonzero(imaginary)
            self.assertEqual(count, 2 * group.attrs["degrees_of_freedom"])

    def test_modes_of_a_parked_blade_are_those_of_a_cantilever(self):
        """Blevins, Formulas for Natural Frequency: (1.87510, 4.69409)^2 sqrt(EI/(m L^4))."""
        stiff_flap = MINIMAL.replace("EI2: 1e4", "EI2: 4e4")
        self.write("case.yaml", stiff_flap.replace("speed: 6", "speed: 0"))
        self.succeed("modes", "case.yaml", "--set", "blades.order=3", "--set", "gravity=0")
        beta = numpy.array([1.8751040687, 4.6940911330])
        with h5py.File(self.folder / "case.h5") as file:
            labels = file["/modes/label"].asstr()[:]
            frequencies = 2 * numpy.pi * file["/modes/frequency_hz"][:]
        for stem, rigidity in (("blade flap", 4e4), ("blade lead-lag", 1e4)):
            found = [f for f, label in zip(frequencies, labels) if stem in label][:2]
            expected = beta**2 * numpy.sqrt(rigidity / 1.0 / 10.0**4)
            # Shear and rotary inertia of this slender blade take off less than 0.2 %.
            numpy.testing.assert_allclose(found, expected, rtol=2e-3)

    def test_frequencies_in_the_fixed_frame_are_those_of_the_names(self):
        self.succeed("floquet", SOURCE / "inputs/nrel5mw/land.yaml", *QUICK, "--set", "aero=none",
                     "-o", "x.h5")
        with h5py.File(self.folder / "x.h5") as file:
            group = file["/floquet"]
            rotating = group["frequency_hz"][:]
            fixed = group["fixed_frame_frequency_hz"][:]
            labels = group["label"].asstr()[:]
            speed = numpy.median((group["frequency_hz"][:] / group["frequency_per_rev"][:])[:5])
        words = {"collective": 0.0, "regressive": -1.0, "progressive": 1.0}
        seen = set()
        for label, f, ground in zip(labels, rotating, fixed):
            for word, shift in words.items():
                if word in label and numpy.isfinite(ground):
                    self.assertAlmostEqual(ground, abs(f + shift * speed), places=9)
                    seen.add(word)
            if "tower" in label and numpy.isfinite(ground):
                self.assertEqual(ground, f)
        self.assertEqual(seen, set(words))
        self.succeed("floquet", BASELINE, *QUICK, "-o", "two.h5")
        with h5py.File(self.folder / "two.h5") as file:
            self.assertNotIn("fixed_frame_frequency_hz", file["/floquet"])

    def test_trim_and_check_write_what_they_know(self):
        self.succeed("trim", BASELINE, *QUICK, "-o", "trim.h5", "--csv", "trim.csv")
        self.succeed("check", BASELINE, *QUICK, "-o", "check.h5")
        with h5py.File(self.folder / "check.h5") as check:
            self.assertEqual(set(check), {"case", "model"})
            blade = check["/model/mass/blade_1"][()]
            self.assertAlmostEqual(blade, 67.5772 * 8.42, delta=1e-9)
        with h5py.File(self.folder / "trim.h5") as trim:
            self.assertEqual(set(trim), {"case", "geometry", "model", "trim"})
            names = trim["/model/unknowns/name"].asstr()[:]
            with open(self.folder / "trim.csv", newline="", encoding="utf-8") as stream:
                rows = list(csv.reader(stream))
            self.assertEqual([row[0] for row in rows[1:]], list(names))
            numpy.testing.assert_array_equal([[float(v) for v in row[2:]] for row in rows[1:]],
                                             trim["/trim/harmonics"][:])

    def test_static_has_a_row_a_state(self):
        settings = ["--set", "shaft.speed=0", "--set", "gravity=9.81", "--set", "static.steps=5"]
        self.succeed("static", BASELINE, *QUICK, *settings, "-o", "x.h5", "--csv", "x.csv")
        self.succeed("static", BASELINE, *QUICK, *settings, "-o", "x.h5", "--csv", "x.csv")
        with h5py.File(self.folder / "x.h5") as file:
            self.assertEqual(set(file), {"case", "geometry", "model", "static"})
            group = file["/static"]
            names = file["/model/unknowns/name"].asstr()[:]
            numpy.testing.assert_allclose(group["factor"][:], numpy.arange(6) / 5)
            self.assertEqual(group["states"].shape, (6, len(names)))
            for name in ("residual", "newton_steps"):
                self.assertEqual(group[name].shape, (6,))
            self.assertEqual(group["limit_points"].shape, (0,))
            self.assertEqual(group.attrs["method"], "load")
            for name, dataset in datasets(file).items():
                self.assertIn("unit", dataset.attrs, name)
            with open(self.folder / "x.csv", newline="", encoding="utf-8") as stream:
                rows = list(csv.reader(stream))
            self.assertEqual(rows[0], ["factor", "newton_steps", "residual", *names])
            numpy.testing.assert_array_equal([[float(v) for v in row[3:]] for row in rows[1:]],
                                             group["states"][:])
            weight = 9.81 * (67.5772 * (27 + 2 * 8.42) + 6900)
            root = group["states"][-1, list(names).index("tower root F1")]
            self.assertAlmostEqual(root, -weight, delta=1e-6 * weight)

    def test_the_default_path_is_in_the_current_folder(self):
        self.write("sub/my case.yaml", MINIMAL)
        run = self.succeed("floquet", "sub/my case.yaml", "--set", "floquet.steps=700")
        self.assertIn("result: my case.h5", run.stdout)
        self.assertEqual(sorted(self.files()), ["my case.h5", "sub/my case.yaml"])

    def test_a_result_may_be_overwritten(self):
        for command in ("trim", "floquet"):
            self.succeed(command, BASELINE, *QUICK, "-o", "x.h5", "--csv", "x.csv")
        with h5py.File(self.folder / "x.h5") as file:
            self.assertIn("floquet", file)
        self.assertEqual(sorted(self.files()), ["x.csv", "x.h5"])

    def test_an_existing_result_survives_a_run_that_fails(self):
        self.succeed("trim", BASELINE, *QUICK, "-o", "x.h5", "--csv", "x.csv")
        self.refuse("floquet", BASELINE, *QUICK, "-o", "x.h5", "--csv", "x.csv",
                    "-trim_snes_max_it", "0", code=3)
        self.refuse("floquet", BASELINE, "-o", "x.h5", "--set", "gravty=1", code=2)

    def test_a_full_disk_is_an_error_of_the_environment(self):
        before = self.files()
        limited = 'trap "" XFSZ; ulimit -f 16; exec "$@"'  # blocks of 1024 bytes
        run = subprocess.run(
            ["bash", "-c", limited, "-", PROGRAM, "floquet", str(BASELINE), "-o", "x.h5"],
            cwd=self.folder, capture_output=True, text=True, timeout=LONGEST_RUN, check=False)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertIn("x.h5: cannot be written", run.stderr)
        self.assertIn("yaw", run.stdout)
        self.assertEqual(self.files(), before)


unittest.main()
