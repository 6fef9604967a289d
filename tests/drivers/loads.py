"""samara loads: evaluated loads of time series and steady states, and what it refuses."""

import csv
import pathlib
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from time_series import read_rows  # noqa: E402
from program import BASELINE, MINIMAL, SOURCE, ProgramTest  # noqa: E402

LAND = SOURCE / "inputs/nrel5mw/land.yaml"
PERIOD = 5.0
DURATION = 20.0
TURNING = ["--set", "blades.elements=2", "--set", "tower.elements=2", "--set", "gravity=9.81",
           "--set", f"shaft.speed={2 * numpy.pi / PERIOD!r}", "--set", "trim.harmonics=8", "--set",
           "aero=none"]
CHANNELS = ["RootMxb1", "RootMyb1", "RootFzb1", "LSSTipMys", "TwrBsMyt", "TTDspFA"]


def option(channels):
    return ["--set", f"channels=[{', '.join(channels)}]"]


def read_loads(path, group="loads"):
    """All datasets and attributes of a group by name."""
    found = {}
    with h5py.File(path) as file:
        file[group].visititems(lambda name, item: found.update({name: (
            item.asstr()[()] if item.dtype.kind in "SO" else item[()])})
                               if isinstance(item, h5py.Dataset) else None)
        return found, dict(file[group].attrs)


def turning_points(values):
    """Peaks and valleys with the first and the last value."""
    points = [values[0]]
    for value in values[1:]:
        if len(points) > 1 and (points[-1] - points[-2]) * (value - points[-1]) >= 0:
            points[-1] = value
        elif value != points[-1]:
            points.append(value)
    return points


def count_cycles(values):
    """Ranges and counts by four points: a pair between its neighbours goes as a cycle, and what is
    left in the end counts half. (Samara goes by three points with ASTM's rule of the start.)"""
    ranges, stack = [], []
    for point in turning_points(values):
        stack.append(point)
        while len(stack) >= 4:
            a, b, c, d = stack[-4:]
            if not (min(a, d) <= min(b, c) and max(b, c) <= max(a, d)):
                break
            ranges.append((abs(c - b), 1.0))
            del stack[-3:-1]
    ranges += [(abs(b - a), 0.5) for a, b in zip(stack, stack[1:])]
    return ranges


def equivalent_load(ranges, exponent, cycles):
    return (sum(n * r**exponent for r, n in ranges) / cycles) ** (1 / exponent)


class TimeSeries(ProgramTest):
    """Against sums in Python over the same rows."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.maker = cls("make_series")
        cls.maker.setUp()
        cls.maker.make_series()
        cls.result = cls.maker.folder / "a.h5"

    @classmethod
    def tearDownClass(cls):
        cls.maker.doCleanups()
        super().tearDownClass()

    def make_series(self):
        """From rest under gravity: cycles of all sizes."""
        self.succeed("transient", BASELINE, "--set", "gravity=9.81", "-o", "a.h5", "--set",
                     f"transient={{duration: {DURATION}, step: 0.01, start: undeformed, "
                     "checkpoint: 5, output: {channels: [RootMxb1, RootMyb1, TwrBsMyt, Azimuth]}}")

    def evaluate(self, *options):
        self.run_output = self.succeed("loads", self.result, "-o", "l.h5", *options).stdout
        return read_loads(self.folder / "l.h5")

    def test_statistics_are_those_of_the_rows(self):
        found, attributes = self.evaluate()
        times, values = read_rows(self.result)
        values = values[:, :3]  # the azimuth has no statistics
        self.assertEqual(list(found["channel_name"]), ["RootMxb1", "RootMyb1", "TwrBsMyt"])
        self.assertEqual(attributes["rows"], 2001)
        self.assertAlmostEqual(attributes["duration"], DURATION)
        numpy.testing.assert_array_equal(found["minimum"], values.min(axis=0))
        numpy.testing.assert_array_equal(found["maximum"], values.max(axis=0))
        numpy.testing.assert_array_equal(found["time_of_maximum"], times[values.argmax(axis=0)])
        mean = numpy.trapz(values, times, axis=0) / DURATION
        numpy.testing.assert_allclose(found["mean"], mean, rtol=1e-10, atol=1e-12)
        square = numpy.trapz((values - mean) ** 2, times, axis=0) / DURATION
        numpy.testing.assert_allclose(found["standard_deviation"], numpy.sqrt(square), rtol=1e-10)
        self.assertIn("RootMxb1  kN-m", self.run_output)

    def test_extreme_events_have_all_channels_of_their_row(self):
        found, _ = self.evaluate()
        _, values = read_rows(self.result)
        self.assertEqual(list(found["event/kind"]), ["minimum", "maximum"] * 3)
        for event in range(6):
            channel = event // 2
            row = values[:, channel].argmax() if event % 2 else values[:, channel].argmin()
            numpy.testing.assert_array_equal(found["event/values"][event], values[row, :3])
            self.assertEqual(found["event/channel"][event], found["channel_name"][channel])

    def test_equivalent_loads_by_another_way_of_counting(self):
        found, _ = self.evaluate("--set", "exponents=[3, 8]", "--set", "equivalent_frequency=2")
        _, values = read_rows(self.result)
        numpy.testing.assert_array_equal(found["damage/exponent"], [3, 8])
        for c in range(3):
            ranges = count_cycles(values[:, c])
            self.assertGreater(len(ranges), 20)
            expected = [equivalent_load(ranges, m, 2 * DURATION) for m in (3, 8)]
            numpy.testing.assert_allclose(found["damage/equivalent_load"][c], expected, rtol=1e-9)
            self.assertAlmostEqual(found["rainflow/counts"][c].sum(), sum(n for _, n in ranges))
            self.assertAlmostEqual(found["rainflow/range_edges"][c, -1], max(ranges)[0])

    def test_goodman_makes_cycles_about_a_mean_count_more(self):
        plain = self.evaluate(*option(["RootMxb1"]))[0]["damage/equivalent_load"]
        limit = 10 * max(abs(read_rows(self.result)[1][:, 0]))
        found = self.evaluate(*option(["RootMxb1"]), "--set",
                              f"goodman.RootMxb1.ultimate_load={limit}")[0]
        self.assertTrue((found["damage/equivalent_load"] > plain).all())

    def test_a_part_of_the_series(self):
        found, attributes = self.evaluate("--set", "from=1", "--set", "until=3")
        times, values = read_rows(self.result)
        kept = (times > 0.999) & (times < 3.001)
        self.assertEqual(attributes["rows"], 201)
        numpy.testing.assert_array_equal(found["maximum"], values[kept, :3].max(axis=0))

    def test_bins_and_channels_are_those_asked_for(self):
        found, _ = self.evaluate(*option(["TwrBsMyt", "Azimuth"]), "--set", "bins=[6, 3]", "--set",
                                 "harmonics=2")
        self.assertEqual(list(found["channel_name"]), ["TwrBsMyt", "Azimuth"])
        self.assertEqual(found["rainflow/counts"].shape, (2, 6, 3))
        self.assertEqual(found["harmonics/amplitude"].shape, (3, 2))

    def test_all_that_is_written_has_attributes_and_the_case(self):
        self.evaluate()
        with h5py.File(self.folder / "l.h5") as file, h5py.File(self.result) as source:
            self.assertEqual(file["case"][()], source["case"][()])
            self.assertEqual(file.attrs["case_path"], source.attrs["case_path"])
            self.assertEqual(file["loads"].attrs["source"], str(self.result))

            def check(name, item):
                if isinstance(item, h5py.Dataset):
                    for key in ("unit", "frame", "description"):
                        self.assertIn(key, item.attrs, name)

            file.visititems(check)

    def test_the_table_holds_the_same(self):
        found, _ = self.evaluate("--csv", "l.csv")
        with open(self.folder / "l.csv", encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual([row["channel"] for row in rows], list(found["channel_name"]))
        for c, row in enumerate(rows):
            self.assertEqual(row["result"], str(self.result))
            for name in ("mean", "standard_deviation", "minimum", "maximum", "range"):
                self.assertEqual(float(row[name]), found[name][c])
            for i, exponent in enumerate(("4", "10")):
                self.assertEqual(float(row["equivalent_load_" + exponent]),
                                 found["damage/equivalent_load"][c, i])
        self.succeed("loads", self.result, "--csv", "l.csv")  # a table of ours

    def test_a_lifetime_adds_the_damage_of_its_series(self):
        self.succeed("loads", self.result, self.result, "-o", "l.h5", "--set", "hours=[1, 3]",
                     "--set", "equivalent_cycles=1e5")
        found, _ = read_loads(self.folder / "l.h5")
        _, values = read_rows(self.result)
        for c in range(3):
            ranges = count_cycles(values[:, c])
            expected = [equivalent_load(ranges, m, 1e5 * DURATION / (4 * 3600)) for m in (4, 10)]
            numpy.testing.assert_allclose(found["lifetime/equivalent_load"][c], expected, rtol=1e-9)
        self.assertEqual(found["2/channel_name"][0], "RootMxb1")

    def test_without_an_azimuth_there_are_no_harmonics(self):
        case = self.write("case.yaml", MINIMAL)
        self.succeed("transient", case, "-o", "b.h5", "--set",
                     "transient={duration: 1, step: 0.01, output: {channels: [RootMxb1]}}")
        self.assertIn("no harmonics: ", self.succeed("loads", "b.h5").stdout)
        self.refuse("loads", "b.h5", "--set", "harmonics=2", words=["no channel Azimuth", "hint"])

    def test_exported_results_give_the_same(self):
        self.succeed("export", self.result, "-o", "b.h5")
        before = self.evaluate()[0]
        self.succeed("loads", "b.h5", "-o", "l2.h5")
        after = read_loads(self.folder / "l2.h5")[0]
        for name, value in before.items():
            numpy.testing.assert_array_equal(after[name], value)


class SteadyStates(ProgramTest):
    def test_a_trim_has_the_loads_of_a_transient_that_stays_on_it(self):
        self.succeed("trim", LAND, *TURNING, "-o", "t.h5")
        self.succeed("transient", LAND, *TURNING, "-o", "h.h5", "--set",
                     "transient={duration: 30, step: 0.005, output: {channels: "
                     f"[{', '.join([*CHANNELS, 'Azimuth'])}]}}}}")
        self.succeed("loads", "t.h5", "-o", "steady.h5", *option(CHANNELS))
        self.succeed("loads", "h.h5", "-o", "time_series.h5", "--set", "from=25")
        steady, attributes = read_loads(self.folder / "steady.h5")
        series, _ = read_loads(self.folder / "time_series.h5")
        self.assertAlmostEqual(attributes["period"], PERIOD, places=9)
        self.assertEqual(attributes["rows"], 720)
        self.assertEqual(list(steady["channel_name"]), CHANNELS)
        # Error of the time step, which is a thousandth of a revolution.
        small = 2e-3 * steady["range"]
        for name in ("mean", "minimum", "maximum", "standard_deviation"):
            with self.subTest(name=name):
                self.assertTrue((abs(series[name] - steady[name]) < small).all(),
                                (series[name] - steady[name]) / steady["range"])

        def first_harmonic(found):
            amplitude, phase = found["harmonics/amplitude"][1], found["harmonics/phase"][1]
            return amplitude * numpy.exp(1j * phase)

        error = abs(first_harmonic(series) - first_harmonic(steady))
        self.assertTrue((error < small).all(), error / steady["range"])
        # Five revolutions have the damage of the steady state, but for cycles that begin before
        # them or end after them: less than one of the five.
        self.succeed("loads", "h.h5", "-o", "five.h5", "--set", "from=5")
        five = read_loads(self.folder / "five.h5")[0]["damage/equivalent_load"][:, 0]
        ratio = five / steady["damage/equivalent_load"][:, 0]
        self.assertTrue(((ratio > 0.8 ** (1 / 4)) & (ratio < 1 + 2e-3)).all(), ratio)

    def test_equivalent_loads_are_those_of_a_revolution_without_end(self):
        self.succeed("trim", BASELINE, "--set", "gravity=9.81", "-o", "t.h5")
        self.succeed("loads", "t.h5", "-o", "l.h5", *option(["RootMyb1", "TwrBsMyt"]), "--set",
                     "azimuths=360")
        self.succeed("loads", "t.h5", "-o", "all.h5", "--set", "azimuths=360")
        found, attributes = read_loads(self.folder / "l.h5")
        # The harmonics give back the revolution: there are no more of them than in the trim.
        self.succeed("loads", "t.h5", "-o", "h.h5", *option(["RootMyb1", "TwrBsMyt"]), "--set",
                     "azimuths=360", "--set", "harmonics=20")
        harmonics, _ = read_loads(self.folder / "h.h5")
        azimuth = 2 * numpy.pi * numpy.arange(360) / 360
        for c in range(2):
            waves = [a * numpy.cos(k * azimuth + p) for k, (a, p) in enumerate(
                zip(harmonics["harmonics/amplitude"][:, c], harmonics["harmonics/phase"][:, c]))]
            values = numpy.sum(waves, axis=0)
            start = values.argmax()
            ranges = count_cycles([*values[start:], *values[:start + 1]])
            expected = [equivalent_load(ranges, m, attributes["period"]) for m in (4, 10)]
            numpy.testing.assert_allclose(found["damage/equivalent_load"][c], expected, rtol=1e-4)
        names = list(read_loads(self.folder / "all.h5")[0]["channel_name"])
        self.assertIn("RootMyb2", names)
        self.assertNotIn("Azimuth", names)

    def test_the_case_is_rebuilt_with_its_settings(self):
        # A case that begins with a comment like ours keeps it.
        text = "# --set nothing, it says\n" + MINIMAL
        self.write("case.yaml", text)
        settings = ["gravity=9.81", "shaft.speed=5", "blades.sections.0.stiffness.EI3=1e9",
                    "floquet.steps=2700"]
        self.succeed("floquet", "case.yaml", *(f"--set={setting}" for setting in settings), "-o",
                     "f.h5")
        (self.folder / "case.yaml").unlink()
        self.succeed("loads", "f.h5", "-o", "l.h5")
        found, attributes = read_loads(self.folder / "l.h5")
        self.assertAlmostEqual(attributes["period"], 2 * numpy.pi / 5)
        weight = 9.81 * 10  # of a stiff blade of 1 kg/m that goes round
        vertical = found["harmonics/amplitude"][1, list(found["channel_name"]).index("RootFzc1")]
        self.assertAlmostEqual(1e3 * vertical, weight, delta=1e-3 * weight)
        with h5py.File(self.folder / "l.h5") as file:
            self.assertEqual(file["case"].asstr()[()],
                             "".join(f"# --set {setting}\n" for setting in settings) + text)

    def test_ranks(self):
        self.succeed("trim", self.write("case.yaml", MINIMAL), "-o", "t.h5")
        one = self.succeed("loads", "t.h5").stdout
        self.assertEqual(self.succeed("loads", "t.h5", ranks=2).stdout, one)


class Refusals(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("case.yaml", MINIMAL)
        self.succeed("trim", "case.yaml", "-o", "t.h5")
        self.succeed("transient", "case.yaml", "-o", "h.h5", "--set",
                     "transient={duration: 2, step: 0.01, output: "
                     "{channels: [RootMxb1, RootMyb1, Azimuth]}}")

    def test_keys(self):
        for key, words in (
            ("chanels=[RootMxb1]", 'did you mean "channels"'),
            ("nonsense=1", "known keys: channels, from"),
            ("channels=RootMxb1", "expected a list of names"),
            ("channels=[RootMxb1, RootMxb1]", "twice"),
            ("channels=[RootMbx1]", 'did you mean "RootMxb1"'),
            ("from=100", "lasts from 0 to 2 s"),
            ("exponents=[0.5]", "expected a number >= 1"),
            ("exponents=[]", "expected a list of numbers"),
            ("equivalent_frequency=0", "expected a number > 0"),
            ("harmonics=1.5", "expected an integer"),
            ("harmonics=150", "do not separate 150 harmonics"),
            ("bins=0", "expected an integer"),
            ("bins=[1, 2, 3]", "a list of 2 integers"),
            ("goodman.RootMxb1={fixed_mean: 1}", 'missing key "ultimate_load"'),
            ("goodman.RootMbx1={ultimate_load: 1}", 'did you mean "RootMxb1"'),
            ("goodman=1", "expected channels"),
            ("goodman.RootMxb1.ultimate_load=1e-9", "Goodman"),
            ("hours=[1, 2]", "1 result"),
            ("equivalent_cycles=1e7", "lifetime"),
        ):
            with self.subTest(key=key):
                self.refuse("loads", "h.h5", "--set", key, "-o", "l.h5", words=words)
        self.refuse("loads", "h.h5", "--set", "from=2", "--set", "until=1", words="more than from")
        self.refuse("loads", "t.h5", "--set", "from=1", words="one revolution")
        self.refuse("loads", "t.h5", "--set", "channels=[RootMbx1]",
                    words=["--set channels", 'did you mean "RootMxb1"'])

    def test_results(self):
        self.refuse("loads", words="missing result")
        self.refuse("loads", "no.h5", words="no such file")
        self.refuse("loads", "case.yaml", words="no result of samara")
        self.refuse("loads", "t.h5", "h.h5", words="hours")
        self.refuse("loads", "t.h5", "h.h5", "--set", "hours=[1, 2]", words="other channels")
        self.refuse("loads", "t.h5", "-o", "t.h5", words="is read by this run")
        self.refuse("loads", "h.h5", "t.h5", "--set", "hours=[1, 2]", "-o", "t.h5",
                    words="is read by this run")
        self.succeed("static", "case.yaml", "--set", "shaft.speed=0", "-o", "s.h5")
        self.refuse("loads", "s.h5", words="has no loads")
        self.succeed("trim", "case.yaml", "--set", "shaft.speed=0", "-o", "still.h5")
        self.refuse("loads", "still.h5", words="stands still")
        self.write("l.csv", "mine")
        self.refuse("loads", "t.h5", "--csv", "l.csv", words="it would be lost")

    def test_numbers_of_a_type_that_no_machine_has(self):
        """HDF5 converts an integer of 16672 bits in 4 bytes beyond the end of its memory."""
        integer = bytes([0x10, 8, 0, 0, 4, 0, 0, 0, 0, 0, 0x20, 0])  # signed, little endian, 32 bits
        content = bytearray((self.folder / "h.h5").read_bytes())
        place = content.index(integer, content.index(b"generator_lost"))
        content[place + 11] = 0x41
        (self.folder / "h.h5").write_bytes(content)
        self.refuse("loads", "h.h5", words=["generator_lost", "has numbers that are neither"])
        self.refuse("export", "h.h5", "-o", "x.csv", words="has numbers that are neither")

    def test_too_short_a_series(self):
        self.refuse("loads", "h.h5", "--set", "from=1.999", words="too few rows")
        text = self.succeed("loads", "h.h5", "--set", "from=1.9").stdout
        self.assertIn("no harmonics: azimuth: it grows by", text)


if __name__ == "__main__":
    unittest.main()
