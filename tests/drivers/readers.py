"""Results as others read them: h5py, xarray by netCDF4 and h5netcdf, Octave, scipy."""

import pathlib
import subprocess
import sys
import unittest

import h5py
import numpy
import scipy.io
import xarray

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import BASELINE, LONGEST_RUN, ProgramTest  # noqa: E402

ENGINES = ["netcdf4", "h5netcdf"]
COARSE = ["--set", "blades.elements=2", "--set", "tower.elements=2", "--set", "gravity=9.81"]
CHANNELS = ["RootMxb1", "TwrBsMyt", "Azimuth"]
TRANSIENT = (f"transient={{duration: 1, step: 0.01, checkpoint: 0.5, "
           f"output: {{channels: [{', '.join(CHANNELS)}]}}}}")
LINEARIZE = ("linearize={inputs: [yaw_torque], outputs: [NacYaw, RootMxb1], mat: model.mat, "
             "forms: [state_space, descriptor, average, hill, lyapunov_floquet]}")


def groups_of(path):
    names = ["/"]
    with h5py.File(path, "r") as file:
        file.visititems(
            lambda name, item: names.append("/" + name) if isinstance(item, h5py.Group) else None)
    return names


def plain(values):
    """An array of numbers or of str, whoever read it."""
    values = numpy.asarray(values)
    if values.dtype.kind == "S":
        return numpy.char.decode(values)
    if values.dtype.kind != "O":
        return values
    return numpy.array([item.decode() if isinstance(item, bytes) else item
                        for item in values.ravel()], dtype=str).reshape(values.shape)


class Readers(ProgramTest):
    @classmethod
    def setUpClass(cls):
        """A result of each kind, for all tests to read."""
        maker = cls("test_every_axis_has_a_scale")
        maker.setUp()
        cls.addClassCleanup(maker.doCleanups)
        cls.results = maker.folder
        maker.succeed("floquet", BASELINE, *COARSE, "--set", "floquet.steps=24", "-o",
                      "floquet.h5")
        maker.succeed("modes", BASELINE, *COARSE, "--parked", "--set", "hub.teeter.joint=locked",
                      "-o", "modes.h5")  # a free teeter falls
        maker.succeed("static", BASELINE, *COARSE, "--set", "shaft.speed=0", "--set",
                      "hub.teeter.joint=locked", "--set", "nacelle.yaw.joint=locked", "-o",
                      "static.h5")
        maker.succeed("trim", BASELINE, *COARSE, "-o", "trim.h5")
        maker.succeed("transient", BASELINE, *COARSE, "--set", TRANSIENT, "-o", "time_series.h5")
        maker.succeed("export", "time_series.h5", "-o", "joined.h5")
        maker.succeed("linearize", BASELINE, *COARSE, "--set", LINEARIZE, "-o", "linear.h5")
        maker.succeed("loads", "time_series.h5", "-o", "loads.h5")
        maker.succeed("loads", "trim.h5", "--set", "channels=[RootMxb1]", "-o", "steady.h5")
        maker.succeed("loads", "time_series.h5", "joined.h5", "--set", "hours=[1, 2]", "-o",
                      "lifetime.h5")
        cls.paths = sorted(cls.results.glob("*.h5"))

    def setUp(self):
        super().setUp()
        if hasattr(self, "results"):
            self.folder = self.results

    def test_every_axis_has_a_scale(self):
        self.assertEqual(len(self.paths), 10)
        count = 0

        def check(name, item):
            nonlocal count
            if not isinstance(item, h5py.Dataset):
                return
            with self.subTest(file=path.name, dataset=name):
                for axis, dimension in enumerate(item.dims):
                    count += 1
                    if h5py.h5ds.is_scale(item.id):
                        self.assertEqual(item.ndim, 1)
                        continue
                    self.assertEqual(len(dimension), 1)
                    self.assertEqual(dimension[0].shape, (item.shape[axis],))
                for attribute in ("unit", "frame", "description"):
                    self.assertIn(attribute, item.attrs)

        for path in self.paths:
            with h5py.File(path, "r") as file:
                file.visititems(check)
        self.assertGreater(count, 300)

    def test_xarray_reads_what_h5py_reads(self):
        count = 0
        for path in self.paths:
            with h5py.File(path, "r") as file:
                for engine in ENGINES:
                    for group in groups_of(path):
                        with xarray.open_dataset(path, group=group, engine=engine) as dataset:
                            names = {name for name, item in file[group].items()
                                     if isinstance(item, h5py.Dataset)}
                            self.assertEqual(names, set(dataset.variables))
                            for name in names:
                                with self.subTest(file=path.name, engine=engine, name=name):
                                    numpy.testing.assert_array_equal(
                                        plain(dataset[name].values), plain(file[group][name][()]))
                                    count += 1
        self.assertGreater(count, 600)

    def test_axes_choose_by_name(self):
        with h5py.File(self.results / "time_series.h5", "r") as file:
            rows = file["transient/values"][:]
        with h5py.File(self.results / "floquet.h5", "r") as file:
            exponents = file["floquet/exponents"][:]
        for engine in ENGINES:
            with self.subTest(engine=engine):
                with xarray.open_dataset(self.results / "time_series.h5", group="transient",
                                         engine=engine) as series:
                    self.assertEqual(series["values"].dims, ("time", "channel_name"))
                    tower = series["values"].sel(channel_name="TwrBsMyt")
                    numpy.testing.assert_array_equal(tower, rows[:, 1])
                    self.assertEqual(float(tower.sel(time=0.5, method="nearest")), rows[50, 1])
                with xarray.open_dataset(self.results / "floquet.h5", group="floquet",
                                         engine=engine) as floquet:
                    numpy.testing.assert_array_equal(floquet.exponents.sel(re_im="im"),
                                                     exponents[:, 1])
                    self.assertEqual(floquet["modes"].dims,
                                     ("mode", "mode_times", "unknown", "re_im"))

    def octave(self, *statements):
        run = subprocess.run(
            ["octave", "--no-gui", "--no-window-system", "--norc", "--quiet", "--eval",
             "pkg load netcdf; " + "; ".join(statements)],
            cwd=self.results, stdin=subprocess.DEVNULL, capture_output=True, text=True,
            timeout=LONGEST_RUN, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        return numpy.array([float(word) for word in run.stdout.split()])

    def test_octave_reads_the_numbers(self):
        show = 'printf("%.17g\\n", ncread("{}", "{}")(:))'  # the first axis runs fastest
        for name, dataset in [("time_series.h5", "/transient/values"), ("joined.h5", "/transient/time"),
                              ("floquet.h5", "/floquet/exponents"), ("trim.h5", "/trim/harmonics"),
                              ("linear.h5", "/linearize/state_space/A")]:
            with self.subTest(dataset=dataset), h5py.File(self.results / name, "r") as file:
                numpy.testing.assert_array_equal(self.octave(show.format(name, dataset)),
                                                 file[dataset][:].ravel())

    def test_octave_and_scipy_read_the_model(self):
        mat = scipy.io.loadmat(self.results / "model.mat")
        with h5py.File(self.results / "linear.h5", "r") as file:
            series = file["linearize/state_space/A"][:]
        numpy.testing.assert_array_equal(mat["state_space_A"], numpy.moveaxis(series, 0, 2))
        found = self.octave('m = load("model.mat")', 'printf("%.17g\\n", m.state_space_A(:))')
        numpy.testing.assert_array_equal(found, numpy.moveaxis(series, 0, 2).ravel(order="F"))

    def test_octave_reads_the_tables(self):
        self.succeed("export", "time_series.h5", "-o", "series.csv")
        with h5py.File(self.results / "time_series.h5", "r") as file:
            rows = file["transient/values"][:]
        found = self.octave('m = dlmread("series.csv", ",", 1, 1)', 'printf("%.17g\\n", m\'(:))')
        numpy.testing.assert_array_equal(found, rows.ravel())


if __name__ == "__main__":
    unittest.main()
