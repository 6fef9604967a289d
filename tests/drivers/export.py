"""samara export: time series in one file and in other formats, and what it refuses."""

import pathlib
import shutil
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from time_series import read_csv, read_out, read_outb, read_rows  # noqa: E402
from program import BASELINE, ProgramTest  # noqa: E402

COARSE = ["--set", "blades.elements=2", "--set", "tower.elements=2", "--set", "gravity=9.81"]
CHANNELS = ["RootMxb1", "RootMyb1", "TwrBsMyt", "TTDspSS", "TipALxb1", "Azimuth"]
UNITS = ["kN-m", "kN-m", "kN-m", "m", "m/s^2", "deg"]
SCALE_ATTRIBUTES = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}
READERS = {"csv": read_csv, "out": read_out, "outb": read_outb}


def own_attributes(item):
    """Without those by which HDF5 ties a dataset to the scales of its axes."""
    return {name: value for name, value in item.attrs.items() if name not in SCALE_ATTRIBUTES}


class ExportTest(ProgramTest):
    def run_transient(self, name, *more, duration=2, checkpoint=0.5):
        """A result of segments, one for each checkpoint."""
        keys = (f"transient={{duration: {duration}, step: 0.01, checkpoint: {checkpoint}, "
                f"output: {{channels: [{', '.join(CHANNELS)}]}}}}")
        self.succeed("transient", BASELINE, *COARSE, "-o", name, "--set", keys, *more)


    def assert_packed(self, found, values):
        """Half of 1/65500 of a channel's range, or what single precision tells apart of its size."""
        error = numpy.abs(found - values).max(axis=0)
        bound = 0.51 * numpy.ptp(values, axis=0) / 65500 + 1.3e-7 * numpy.abs(values).max(axis=0)
        self.assertTrue((error <= bound).all(), (error, bound))


class Formats(ExportTest):
    def test_tables_hold_every_bit(self):
        self.run_transient("a.h5")
        times, values = read_rows(self.folder / "a.h5")
        for ending, read in READERS.items():
            with self.subTest(ending=ending):
                run = self.succeed("export", "a.h5", "-o", f"b.{ending}")
                self.assertIn(f"export: b.{ending}", run.stdout)
                self.assertIn("201 rows of 6 channels, t = 0 to 2 s", run.stdout)
                names, units, rows = read(self.folder / f"b.{ending}")
                if ending == "csv":
                    self.assertEqual(names, ["time", *CHANNELS])
                    self.assertEqual(units, ["s", *UNITS])
                else:
                    self.assertEqual(names, ["Time", *CHANNELS])
                    self.assertEqual(units, ["(s)", *(f"({unit})" for unit in UNITS)])
                if ending == "outb":  # which has 16 bits a value, and the step only
                    self.assert_packed(rows[:, 1:], values)
                    numpy.testing.assert_allclose(rows[:, 0], times, rtol=0, atol=1e-12)
                else:
                    numpy.testing.assert_array_equal(rows[:, 1:], values)
                    numpy.testing.assert_array_equal(rows[:, 0], times)

    def test_the_joined_result_is_the_same_without_its_parts(self):
        self.run_transient("a.h5")
        self.assertGreater(len(list((self.folder / "a.h5.parts").iterdir())), 2)
        self.succeed("export", "a.h5", "-o", "b.h5")
        expected = {}
        with h5py.File(self.folder / "a.h5") as file:
            file.visititems(lambda name, item: expected.update({name: (
                item[()] if isinstance(item, h5py.Dataset) else None, own_attributes(item))}))
            root = dict(file.attrs)
        shutil.rmtree(self.folder / "a.h5.parts")
        found = []
        with h5py.File(self.folder / "b.h5") as file:
            self.assertEqual({**root}, dict(file.attrs))
            file.visit(found.append)
            self.assertEqual(sorted(found), sorted(expected))
            for name, (value, attributes) in expected.items():
                with self.subTest(name=name):
                    self.assertEqual(own_attributes(file[name]), attributes)
                    if value is None:
                        continue
                    self.assertFalse(file[name].is_virtual)
                    if "segment" in name:
                        self.assertEqual(len(file[name]), 0)
                    else:
                        numpy.testing.assert_array_equal(file[name][()], value)

    def test_the_joined_result_can_be_gone_on_with(self):
        self.run_transient("whole.h5", duration=3)
        self.run_transient("a.h5")
        self.succeed("export", "a.h5", "-o", "b.h5")
        shutil.rmtree(self.folder / "a.h5.parts")
        (self.folder / "a.h5").unlink()
        self.run_transient("b.h5", "--restart", "b.h5", duration=3)
        for a, b in zip(read_rows(self.folder / "b.h5"), read_rows(self.folder / "whole.h5")):
            numpy.testing.assert_array_equal(a, b)

    def test_a_result_from_before_there_were_scales_gets_those_of_its_rows(self):
        self.run_transient("a.h5")
        with h5py.File(self.folder / "a.h5", "r+") as file:
            def strip(_, item):
                for name in SCALE_ATTRIBUTES & set(item.attrs):
                    del item.attrs[name]
            file.visititems(strip)
        self.succeed("export", "a.h5", "-o", "b.h5")
        with h5py.File(self.folder / "b.h5") as file:
            values = file["transient/values"]
            self.assertEqual([axis[0].name for axis in values.dims],
                             ["/transient/time", "/transient/channel_name"])
            self.assertTrue(all(h5py.h5ds.get_scale_name(axis[0].id) for axis in values.dims))

    def test_a_result_without_segments_is_copied(self):
        self.run_transient("a.h5", duration=0.1, checkpoint="none")
        self.assertFalse((self.folder / "a.h5.parts").exists())
        self.succeed("export", "a.h5", "-o", "b.h5")
        self.assertEqual(self.files()["a.h5"], self.files()["b.h5"])

    def test_what_was_exported_may_be_written_again(self):
        self.run_transient("a.h5", duration=0.1)
        for ending in ("h5", "csv", "out", "outb"):
            with self.subTest(ending=ending):
                self.succeed("export", "a.h5", "-o", f"b.{ending}")
                before = self.files()[f"b.{ending}"]
                self.succeed("export", "a.h5", "-o", f"b.{ending}")
                self.assertEqual(self.files()[f"b.{ending}"], before)

    def test_many_rows_go_in_slices(self):
        self.succeed("transient", BASELINE, *COARSE, "-o", "a.h5", "--set",
                     "nacelle.yaw.joint=locked", "--set", "transient={duration: 150, step: 0.01}")
        times, values = read_rows(self.folder / "a.h5")
        self.assertGreater(values.size, 2**20)  # more than a slice
        self.succeed("export", "a.h5", "-o", "b.outb")
        self.assert_packed(read_outb(self.folder / "b.outb")[2][:, 1:], values)
        self.succeed("export", "a.h5", "-o", "b.csv")
        rows = numpy.loadtxt(self.folder / "b.csv", delimiter=",", skiprows=1)
        numpy.testing.assert_array_equal(rows[:, 0], times)
        numpy.testing.assert_array_equal(rows[:, 1:], values)

    def test_channels_of_any_size_are_packed(self):
        # Constant, zero, a small change of a large value, tiny, huge: as another program wrote them.
        self.run_transient("a.h5", duration=0.5, checkpoint="none")
        t = numpy.arange(51.0)
        columns = [numpy.full(51, 0.123), 0.0 * t, 1e6 + 1e-3 * numpy.sin(t), 1e-30 * t, 1e30 * t,
                   -7.0 + t % 2]
        with h5py.File(self.folder / "a.h5", "r+") as file:
            file["transient/values"][:] = numpy.column_stack(columns)
        self.succeed("export", "a.h5", "-o", "b.outb")
        self.assert_packed(read_outb(self.folder / "b.outb")[2][:, 1:], numpy.column_stack(columns))
        with h5py.File(self.folder / "a.h5", "r+") as file:
            file["transient/values"][3, 2] = numpy.nan
        self.refuse("export", "a.h5", "-o", "c.outb", words=["TwrBsMyt", "no numbers", ".csv"])

    def test_ranks(self):
        self.run_transient("a.h5", duration=0.1)
        self.succeed("export", "a.h5", "-o", "one.csv")
        run = self.succeed("export", "a.h5", "-o", "two.csv", ranks=2)
        self.assertEqual(run.stdout.count("export:"), 1)
        self.assertEqual(self.files()["one.csv"], self.files()["two.csv"])


class Refusals(ExportTest):
    def test_missing_and_damaged_segments(self):
        self.run_transient("a.h5")
        segment = sorted((self.folder / "a.h5.parts").iterdir())[1]
        content = segment.read_bytes()
        for damage, word in ((segment.unlink, "missing or damaged"),
                             (lambda: segment.write_bytes(content[:100]), segment.name)):
            damage()
            for ending in ("h5", "csv", "out", "outb"):
                with self.subTest(ending=ending, word=word):
                    self.refuse("export", "a.h5", "-o", f"b.{ending}", words=[segment.name, word])

    def test_files_that_are_not_ours(self):
        self.run_transient("a.h5", duration=0.1)
        for ending in ("h5", "csv", "out", "outb"):
            self.write(f"b.{ending}", "time 1 2 3\n" * 20)
            with self.subTest(ending=ending):
                self.refuse("export", "a.h5", "-o", f"b.{ending}", words=["it would be lost", "-o"])
        with h5py.File(self.folder / "other.h5", "w") as file:
            file["x"] = 1
        self.refuse("export", "a.h5", "-o", "other.h5", words="another program")

    def test_inputs_that_have_no_series(self):
        self.succeed("trim", BASELINE, *COARSE, "-o", "t.h5")
        self.refuse("export", "t.h5", "-o", "b.csv", words=["no time series", "hint"])
        self.refuse("export", "no.h5", "-o", "b.csv", words="no such file")
        self.refuse("export", self.folder, "-o", "b.csv", words="a directory")
        self.write("x.h5", "text")
        self.refuse("export", "x.h5", "-o", "b.csv", words="no result of samara")

    def test_command_line(self):
        self.run_transient("a.h5", duration=0.1)
        self.refuse("export", words=["missing result", "samara export RESULT.h5"])
        self.refuse("export", "a.h5", words=["missing -o FILE", ".outb"])
        self.refuse("export", "a.h5", "-o", "b.txt", words=["b.txt", ".h5, .csv, .out or .outb"])
        self.refuse("export", "a.h5", "-o", "a.h5", words="is the result itself")
        self.refuse("export", "a.h5", "b.h5", "-o", "b.csv", words="one per run")
        self.refuse("export", "a.h5", "-o", "b.csv", "--set", "x=1", words="--set")
        self.refuse("export", "a.h5", "-o", "b.csv", "--csv", "c.csv", words="--csv")
        self.refuse("export", "a.h5", "-o", "b.csv", "--restart", "a.h5", words="--restart")
        self.refuse("export", "a.h5", "-o", "b.csv", "-ts_type", words="solves nothing")
        self.refuse("export", "a.h5", "-o", "no/b.csv", words="there is no folder")

    def test_binary_output_wants_equal_steps_and_short_names(self):
        self.run_transient("a.h5", "--set", "transient.method=midpoint", duration=0.1)
        self.refuse("export", "a.h5", "-o", "b.outb", words=["not equally spaced", "hint"])
        self.succeed("export", "a.h5", "-o", "b.out")


if __name__ == "__main__":
    unittest.main()
