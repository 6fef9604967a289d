"""The same results and exit codes on 1, 2 and 3 ranks."""

import pathlib
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import BASELINE, QUICK, SOURCE, ProgramTest  # noqa: E402

# Sums over ranks round in another order; well-conditioned eigenvalues move with round-off.
EXPONENTS = 1e-9
# The double zero of free yaw is defective: round-off of 1e-16 moves it by its square root and more.
ZEROS = 1e-4


class Ranks(ProgramTest):
    def exponents(self, ranks):
        """Resolved exponents over the rotor speed, and their labels."""
        name = f"{ranks}.h5"
        self.succeed("floquet", BASELINE, "-o", name, ranks=ranks)
        with h5py.File(self.folder / name) as file:
            group = file["/floquet"]
            self.assertEqual(file.attrs["ranks"], ranks)
            values = group["exponents"][:] @ [1, 1j] / group.attrs["rotor_speed"]
            resolved = group["resolved"][:] == 1
            return values[resolved], group["label"].asstr()[:][resolved]

    def test_exponents_do_not_depend_on_the_number_of_ranks(self):
        first, labels = self.exponents(1)
        is_zero = abs(first) < ZEROS
        self.assertEqual(numpy.count_nonzero(is_zero), 2)
        for ranks in (2, 3):
            other, other_labels = self.exponents(ranks)
            self.assertEqual(len(other), len(first))
            self.assertLess(abs(other[is_zero]).max(), ZEROS)
            # Real exponents share a frequency: their order among themselves does not matter.
            a = numpy.sort_complex(first[~is_zero] * -1j)
            b = numpy.sort_complex(other[~is_zero] * -1j)
            self.assertLess((abs(a - b) / abs(a)).max(), EXPONENTS)
            self.assertEqual(sorted(labels), sorted(other_labels))

    def test_a_search_for_some_modes_finds_the_same(self):
        """Two blades that teeter: eigenpairs are replaced by their neighbours, harmonics added."""
        coarse = [part for key in ("blades.elements=2", "tower.elements=2", "gravity=9.81",
                                   "aero=none", "floquet.search=hill") for part in ("--set", key)]
        case = SOURCE / "inputs/two_bladed/teetering.yaml"
        for wanted in ("floquet.modes=8", "floquet.least_damped=4"):
            found = []
            for ranks in (1, 2, 3):
                self.succeed("floquet", case, *coarse, "--set", wanted, "-o", "some.h5",
                             ranks=ranks)
                with h5py.File(self.folder / "some.h5") as file:
                    group = file["/floquet"]
                    self.assertEqual(group.attrs["searched_is_counted"], 1)
                    self.assertLess(group["residual"][:].max(), 1e-8)
                    found.append(group["exponents"][:] @ [1, 1j] / group.attrs["rotor_speed"])
                    labels = sorted(group["label"].asstr()[:])
                self.assertEqual(len(found[-1]), len(found[0]))
                if ranks == 1:
                    of_one_rank = labels
                self.assertEqual(labels, of_one_rank)
                distances = abs(found[-1][:, None] - found[0]).min(axis=1)
                self.assertLess((distances / numpy.maximum(1, abs(found[-1]))).max(), 1e-8)

    def test_a_search_of_constant_tangents_finds_the_same(self):
        case = SOURCE / "inputs/nrel5mw/land.yaml"
        found = []
        for ranks in (1, 2, 3):
            self.succeed("modes", case, "--parked", "--set", "aero=none", "--set", "floquet.modes=8",
                         "-o", "some.h5", ranks=ranks)
            with h5py.File(self.folder / "some.h5") as file:
                group = file["/modes"]
                self.assertEqual(group.attrs["searched_is_counted"], 1)
                found.append((group["exponents"][:] @ [1, 1j], list(group["label"].asstr()[:])))
        for exponents, labels in found[1:]:
            self.assertLess((abs(exponents - found[0][0]) / abs(found[0][0])).max(), EXPONENTS)
            self.assertEqual(labels, found[0][1])

    def test_a_search_in_wind_on_a_distributed_mesh_finds_the_same(self):
        """The mesh is that of test_verification_mpi.hill_air, which is distributed."""
        settings = ["blades.elements=40", f"blades.element_lengths={[1] * 40}", "blades.order=2", "tower.elements=40",
                    "tower.order=2", "floquet.least_damped=5", "floquet.search=hill"]
        words = [part for setting in settings for part in ("--set", setting)]
        found = []
        for ranks in (1, 2):
            self.succeed("floquet", SOURCE / "inputs/nrel5mw/land.yaml", *words, "-o", "some.h5", ranks=ranks)
            with h5py.File(self.folder / "some.h5") as file:
                group = file["/floquet"]
                self.assertEqual(group.attrs["searched_is_counted"], 1)
                found.append((group["exponents"][:] @ [1, 1j] / group.attrs["rotor_speed"],
                              list(group["label"].asstr()[:]),
                              [group.attrs[f"searched_{end}"] for end in ("from_hz", "to_hz", "decay", "growth")]))
        self.assertGreaterEqual(len(found[0][0]), 5)
        self.assertEqual(found[1][1], found[0][1])
        # Changes of exponents with more harmonics are below 3e-4; on one number of ranks and another they are the same.
        self.assertLess((abs(found[1][0] - found[0][0]) / numpy.maximum(1, abs(found[0][0]))).max(), 1e-7)
        numpy.testing.assert_allclose(found[1][2], found[0][2], rtol=1e-3)

    def test_a_distributed_trim_has_the_table_of_one_rank(self):
        case = [SOURCE / "inputs/beam/rotating.yaml", "--set", "blades.elements=320", "--set",
                "blades.order=1", "--set", "gravity=9.81", "--set", "trim.harmonics=3"]
        tables = []
        for ranks in (1, 2, 3):
            text = self.succeed("trim", *case, ranks=ranks).stdout
            self.assertEqual(text.count(f"mesh on {ranks} ranks"), 1 if ranks > 1 else 0)
            tables.append([line for line in text.splitlines() if line.startswith("blade 1")])
            self.assertEqual(tables[-1], tables[0])
        self.assertEqual(len(tables[0]), 9)

    def test_a_distributed_time_series_has_the_rows_of_one_rank(self):
        case = [SOURCE / "inputs/beam/rotating.yaml", "--set", "blades.elements=320", "--set",
                "blades.order=1", "--set", "gravity=9.81", "--set", "trim.harmonics=3"]

        def rows(name):
            with h5py.File(self.folder / name) as file:
                return file["/transient/values"][:]

        def setting(duration):
            return ["--set", f"transient={{duration: {duration}, step: 0.005, checkpoint: 0.02}}"]

        for ranks in (1, 2, 3):
            text = self.succeed("transient", *case, *setting(0.06), "-o", f"{ranks}.h5",
                                ranks=ranks).stdout
            self.assertEqual(text.count(f"mesh on {ranks} ranks"), 1 if ranks > 1 else 0)
            self.assertEqual(text.count("result: "), 1)
        one = rows("1.h5")
        self.assertEqual(len(one), 13)
        scale = abs(one).max(axis=0) + 1e-12
        for ranks in (2, 3):
            self.assertLess((abs(rows(f"{ranks}.h5") - one) / scale).max(), 1e-6)
        # The series of three ranks goes on with two, that of two with one.
        for before, ranks in ((3, 2), (2, 1)):
            self.succeed("transient", *case, *setting(0.1), "--restart", f"{before}.h5", "-o",
                         f"{before}.h5", ranks=ranks)
            self.assertEqual(len(rows(f"{before}.h5")), 21)
        self.assertLess((abs(rows("3.h5") - rows("2.h5")) / scale).max(), 1e-6)

    def test_tables_are_printed_once(self):
        for command in ("check", "trim", "floquet"):
            text = self.succeed(command, BASELINE, *QUICK, ranks=2).stdout
            self.assertEqual(text.count("Two-bladed teetering turbine"), 1)
        self.assertEqual(self.succeed("--help", ranks=2).stdout.count("exit codes"), 1)
        self.assertEqual(self.succeed("--version", ranks=2).stdout.count("SLEPc"), 1)

    def test_errors_are_printed_once_and_keep_their_code(self):
        for code, words, arguments in (
            (2, "no such file", ["floquet", "no.yaml"]),
            (2, "unknown command", ["floqet", BASELINE]),
            (2, "there is no folder", ["floquet", BASELINE, "-o", "missing/x.h5"]),
            (2, "samara floquet, or samara modes --parked", ["modes", BASELINE]),
            (3, "trim: ", ["trim", BASELINE, "-trim_snes_max_it", "0"]),
            (2, "largest eigenvalues", ["floquet", SOURCE / "inputs/nrel5mw/land.yaml", "--set",
                                        "floquet.modes=8", "--set", "floquet.search=hill", "--set", "aero=none",
                                        "-hill_eps_smallest_magnitude"]),
        ):
            with self.subTest(words=words):
                run = self.samara(*arguments, ranks=2)
                self.assertEqual(run.returncode, code, run.stderr)
                self.assertEqual(run.stderr.count(words), 1, run.stderr)
                self.assertEqual(self.files(), {})


unittest.main()
