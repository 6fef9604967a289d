"""Animations for ParaView: samara export RESULT.h5 -o NAME.pvd, read back by VTK."""

import contextlib
import io
import math
import os
import pathlib
import sys
import unittest
import xml.etree.ElementTree

import h5py
import numpy

# This file has the name of VTK's package.
HERE = pathlib.Path(__file__).parent.resolve()
sys.path[:] = [path for path in sys.path if pathlib.Path(path or ".").resolve() != HERE]
sys.path.insert(0, str(HERE / "support"))
from program import PROGRAM, SOURCE, ProgramTest  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter  # noqa: E402
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader  # noqa: E402

os.environ["SAMARA"] = PROGRAM
sys.path.insert(0, str(SOURCE / "python"))
import samara.vtk  # noqa: E402

BASELINE = SOURCE / "inputs/lee2002/baseline.yaml"
BENT = ["--set", "gravity=9.81"]
SPEED = 6.02  # rad/s
LINE, WEDGE = 3, 13
RIGID = 1e-7  # m: a transient of a rotor that keeps its shape, with the round-off of its steps
SINGLE = 1e-6  # of the largest displacement: the shapes in the result are single precision


class Frame:
    """A VTU file as VTK reads it."""

    def __init__(self, path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        self.grid = reader.GetOutput()
        self.points = vtk_to_numpy(self.grid.GetPoints().GetData())
        self.types = [self.grid.GetCellType(i) for i in range(self.grid.GetNumberOfCells())]
        names = self.grid.GetFieldData().GetAbstractArray("part_names")
        self.part_names = [names.GetValue(i) for i in range(names.GetNumberOfValues())]
        self.time = self.grid.GetFieldData().GetArray("TimeValue").GetValue(0)

    def data(self, name):
        array = self.grid.GetPointData().GetArray(name)
        return None if array is None else vtk_to_numpy(array)

    def volumes(self):
        sizes = vtkCellSizeFilter()
        sizes.SetInputData(self.grid)
        sizes.Update()
        return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))


class Export(ProgramTest):
    def export(self, *arguments):
        """Exit code, output and messages, in the test's folder."""
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors), _in_folder(self.folder):
            try:
                code = samara.vtk.main([str(argument) for argument in arguments])
            except SystemExit as leave:
                code = leave.code
        return code, out.getvalue(), errors.getvalue()

    def frames(self, *arguments):
        """The frames of an export to a.pvd, in the order and with the times of the list."""
        code, out, errors = self.export(*arguments, "-o", "a.pvd")
        self.assertEqual((code, errors), (0, ""))
        sets = xml.etree.ElementTree.parse(self.folder / "a.pvd").getroot().findall("Collection/DataSet")
        frames = []
        for entry in sets:
            frames.append(Frame(self.folder / entry.get("file")))
            self.assertEqual(float(entry.get("timestep")), frames[-1].time)
        self.assertIn(f"{len(frames)} frame", out)
        self.assertEqual({path.name for path in (self.folder / "a").iterdir()},
                         {pathlib.Path(entry.get("file")).name for entry in sets})
        return frames

    def test_steady_state_is_that_of_the_result(self):
        self.succeed("trim", BASELINE, *BENT, "-o", "t.h5")
        frames = self.frames("t.h5")
        with h5py.File(self.folder / "t.h5") as file:
            places, undeformed = file["geometry/place"][:], file["geometry/undeformed"][:]
            times, parts = file["geometry/time"][:], list(file["geometry/part"].asstr()[:])
            stations = file["geometry/station"][:]
        self.assertEqual(len(frames), len(times))
        nodes = places.shape[1]
        for frame, place, straight, time in zip(frames, places, undeformed, times):
            self.assertAlmostEqual(frame.time, time, places=12)
            numpy.testing.assert_allclose(frame.points[:nodes], place, atol=1e-9)
            numpy.testing.assert_allclose(frame.data("displacement")[:nodes], place - straight, atol=1e-9)
            self.assertIsNone(frame.data("rotation"))
        self.assertGreater(abs(places - undeformed).max(), 1e-3)
        self.assertEqual([frames[0].part_names[i] for i in frames[0].data("part")[:nodes]], parts)
        numpy.testing.assert_array_equal(frames[0].data("station")[:nodes], stations)
        numpy.testing.assert_array_equal(frames[0].data("node")[:nodes], numpy.arange(nodes))
        thrice = self.frames("t.h5", "--scale", "3")
        numpy.testing.assert_allclose(thrice[5].data("displacement")[:nodes],
                                      3.0 * (places[5] - undeformed[5]), atol=1e-9)

    def shape(self, number):
        """Motion of the nodes at the first instant, exponent and axes of a mode in f.h5."""
        with h5py.File(self.folder / "f.h5") as file:
            motion = file["floquet/node_motion"][number - 1, 0].astype(float)
            frequency = 2.0 * math.pi * file["floquet/frequency_hz"][number - 1]
            return motion[..., 0] + 1j * motion[..., 1], frequency, file["geometry/place"][0]

    def test_modes_with_the_rotor_held(self):
        self.succeed("floquet", BASELINE, "-o", "f.h5")
        frames = self.frames("f.h5", "--label", "1st blade flap symmetric", "--held", "--cycles", "2", "--frames", "12",
                             "--scale", "0.5")
        self.assertEqual(len(frames), 24)
        motion, frequency, places = self.shape(9)
        nodes = len(places)
        scale = abs(motion).max()
        for i, frame in enumerate(frames):
            time = 2.0 * math.pi / frequency * i / 12
            self.assertAlmostEqual(frame.time, time, places=12)
            wanted = 0.5 * (motion * numpy.exp(1j * frequency * time)).real
            moved = frame.data("displacement")[:nodes]
            numpy.testing.assert_allclose(moved, wanted[:, :3], atol=SINGLE * scale)
            numpy.testing.assert_allclose(frame.data("rotation")[:nodes], wanted[:, 3:], atol=SINGLE * scale)
            numpy.testing.assert_allclose(frame.points[:nodes], places + moved, atol=1e-12)
        for name in ("displacement", "rotation"):
            numpy.testing.assert_allclose(frames[12].data(name), frames[0].data(name), atol=1e-12)
            self.assertGreater(abs(frames[3].data(name) - frames[0].data(name)).max(), 0.05)
        # Twice the scale is twice the displacement of the nodes, at any azimuth.
        one = self.frames("f.h5", "--mode", "8", "--held", "90", "--frames", "3", "--scale", "1")
        two = self.frames("f.h5", "--mode", "8", "--held", "90", "--frames", "3", "--scale", "2")
        numpy.testing.assert_allclose(two[1].data("displacement")[:nodes], 2.0 * one[1].data("displacement")[:nodes],
                                      atol=1e-12)
        # Blade 1 is level, in the direction of the rotation.
        root = [i for i in range(nodes) if one[1].part_names[one[1].data("part")[i]] == "blade 1"][0]
        still = one[1].points[root] - one[1].data("displacement")[root]
        numpy.testing.assert_allclose(still, [2.388, -1.8, 27.0], atol=1e-9)

    def test_modes_with_the_rotor_turning(self):
        self.succeed("floquet", BASELINE, "-o", "f.h5")
        frames = self.frames("f.h5", "--mode", "5", "--frames", "8", "--cycles", "3")
        self.assertEqual(len(frames), 24)
        _, frequency, places = self.shape(5)
        roots = [i for i in range(len(places)) if frames[0].part_names[frames[0].data("part")[i]] == "blade 1"]
        tops = [i for i in range(len(places)) if frames[0].part_names[frames[0].data("part")[i]] == "tower"]
        for i, frame in enumerate(frames):
            angle = SPEED * 2.0 * math.pi / frequency * i / 8
            still = (frame.points - frame.data("displacement"))[roots]
            for radius, place in ((1.8, still[0]), (1.8 + 8.42, still[-1])):
                wanted = [2.388, -radius * math.sin(angle), 27.0 + radius * math.cos(angle)]
                numpy.testing.assert_allclose(place, wanted, atol=1e-9)
        top = numpy.array([frame.data("displacement")[tops[-1], 0] for frame in frames])
        numpy.testing.assert_allclose(top[:8], -numpy.roll(top, -4)[:8], atol=0.02 * abs(top).max())

    def test_the_program_hands_its_arguments_on(self):
        self.succeed("floquet", BASELINE, "-o", "f.h5")
        own = self.frames("f.h5", "--mode", "8", "--held", "90", "--frames", "3", "--scale", "2")
        run = self.succeed("export", "f.h5", "-o", "b.pvd", "--mode", "8", "--held", "90", "--frames", "3", "--scale", "2")
        self.assertEqual(run.stdout, "animation: b.pvd, 3 frames of mode 8, 1st blade lead-lag antisymmetric; 0.30282 s a "
                         "cycle, displacements x 2\n")
        numpy.testing.assert_array_equal(Frame(self.folder / "b/frame_0001.vtu").points, own[1].points)
        self.refuse("export", "f.h5", "-o", "c.pvd", "--mode", "99", words="no mode 99")

    def test_a_transient_turns_by_its_azimuth(self):
        """Without gravity the baseline keeps its shape: the tips are on a circle at the channel Azimuth."""
        self.succeed("transient", BASELINE, "--set",
                     "transient={duration: 1.5, step: 0.01, output: {every: 0.05, places: true}}", "-o", "x.h5")
        with h5py.File(self.folder / "x.h5") as file:
            times = file["transient/time"][:]
            column = list(file["transient/channel_name"].asstr()[:]).index("Azimuth")
            azimuth = numpy.radians(file["transient/values"][:, column])
        numpy.testing.assert_allclose(numpy.unwrap(azimuth), SPEED * times, atol=1e-6)
        frames = self.frames("x.h5")
        self.assertEqual([frame.time for frame in frames], list(times))
        between = self.frames("x.h5", "--every", "0.02", "--from", "0.1", "--until", "1.2")
        numpy.testing.assert_allclose([frame.time for frame in between], 0.1 + 0.02 * numpy.arange(56), atol=1e-9)
        self.assertEqual(len(self.frames("x.h5", "--frames", "7")), 7)
        nodes = frames[0].data("node")
        parts = numpy.array([frames[0].part_names[i] for i in frames[0].data("part")])
        for frame in frames + between:
            angle = SPEED * frame.time
            for name, start in (("blade 1", 0.0), ("blade 2", math.pi)):
                blade = numpy.unique(nodes[parts == name])
                for node, radius in ((blade[0], 1.8), (blade[-1], 1.8 + 8.42)):
                    wanted = [2.388, -radius * math.sin(angle + start), 27.0 + radius * math.cos(angle + start)]
                    numpy.testing.assert_allclose(frame.points[node], wanted, atol=RIGID)
                # The axes turn about x: of a vector along the blade and of the ring around the tip.
                around = frame.points[nodes == blade[-1]][1:] - frame.points[blade[-1]]
                self.assertLess(abs(around @ [0, -math.sin(angle + start), math.cos(angle + start)]).max(), RIGID)
                first = frames[0].points[nodes == blade[-1]][1:] - frames[0].points[blade[-1]]
                c, s = math.cos(angle), math.sin(angle)
                turn = numpy.array([[1, 0, 0], [0, c, -s], [0, s, c]])
                numpy.testing.assert_allclose(around, first @ turn.T, atol=RIGID)
            self.assertLess(abs(frame.data("deflection")).max(), RIGID)
            self.assertIsNone(frame.data("displacement"))
            hub = numpy.flatnonzero(parts == "hub")[-1]
            turn = numpy.linalg.norm(frame.data("rotation")[hub])
            self.assertAlmostEqual(math.cos(turn), math.cos(angle), places=6)

    def test_a_transient_moves_the_tower_top_by_its_channels(self):
        self.succeed("transient", BASELINE, "--set", "gravity=9.81", "--set", "transient={duration: 1, step: 0.01, start: "
                     "undeformed, output: {places: true}}", "-o", "x.h5")
        with h5py.File(self.folder / "x.h5") as file:
            names = list(file["transient/channel_name"].asstr()[:])
            top = [file["transient/values"][:, names.index(name)] for name in ("TTDspFA", "TTDspSS")]
            times = file["transient/time"][:]
        frames = self.frames("x.h5", "--from", "0.2")
        rows = numpy.flatnonzero(times >= 0.2 - 1e-9)
        self.assertEqual(len(frames), len(rows))
        parts = [frames[0].part_names[i] for i in frames[0].data("part")]
        node = max(n for n, part in zip(frames[0].data("node"), parts) if part == "tower")
        for column, channel in enumerate(top):
            moved = numpy.array([frame.data("deflection")[node, column] for frame in frames])
            self.assertGreater(numpy.ptp(moved), 1e-5)
            numpy.testing.assert_allclose(moved, channel[rows] - channel[0], atol=1e-9)

    def test_a_long_transient_is_thinned(self):
        self.succeed("transient", BASELINE, "--set", "transient={duration: 7, step: 0.01, output: {places: true, channels: "
                     "[RotSpeed]}}", "-o", "x.h5")
        code, out, errors = self.export("x.h5", "-o", "a.pvd")
        self.assertEqual((code, errors), (0, ""))
        self.assertIn("234 frames of the transient, 0 to 6.99 s: one row of 3, 701 in all", out)
        before = self.files()
        for arguments, words in ((["--from", "8"], "the series is from 0 to 7 s"), (["--cycles", "2"], "no --cycles"),
                                 (["--mode", "1"], "no --mode"), (["--steady"], "no --steady"), (["--held"], "no --held"),
                                 (["--every", "0"], "expected a time > 0"), (["--every", "1e-5"], "more than 10000"),
                                 (["--frames", "3", "--every", "1"], "not allowed with"),
                                 (["--from", "0.001", "--until", "0.002"], "no row between")):
            code, out, errors = self.export("x.h5", "-o", "b.pvd", *arguments)
            self.assertEqual((code, out), (2, ""), errors)
            self.assertIn(words, errors)
            self.assertEqual(len(errors.splitlines()), 1, errors)
        self.assertEqual(self.files(), before)
        self.succeed("transient", BASELINE, "--set", "transient={duration: 3, step: 0.01, output: {every: 0.5, places: "
                     "true}}", "-o", "y.h5")
        code, out, errors = self.export("y.h5", "-o", "b.pvd", "--frames", "50")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("turns by 172 degrees between two rows", errors)
        self.assertEqual(self.export("y.h5", "-o", "b.pvd")[0], 0)

    def test_tubes_are_solid_and_have_the_size_of_the_sections(self):
        self.succeed("new", "beam", "beam.yaml")
        self.succeed("modes", "beam.yaml", "--parked", "-o", "beam.h5")
        still = self.frames("beam.h5", "--steady")
        self.assertEqual(len(still), 1)
        with h5py.File(self.folder / "beam.h5") as file:
            beam = numpy.flatnonzero(numpy.isfinite(file["geometry/station"][:]))
            width, thickness = file["geometry/width"][:], file["geometry/thickness"][:]
        wedges = 16 * (len(beam) - 1)
        self.assertEqual(still[0].types.count(WEDGE), wedges)
        volumes = still[0].volumes()[numpy.array(still[0].types) == WEDGE]
        # A prism of 10 m whose base is the polygon of 16 corners in an ellipse.
        area = 16 / 2 * math.sin(2 * math.pi / 16) * 0.25 * width[beam[0]] * thickness[beam[0]]
        self.assertAlmostEqual(volumes.sum() / (10.0 * area), 1.0, places=9)
        for frame in self.frames("beam.h5", "--mode", "3"):
            volumes = frame.volumes()[numpy.array(frame.types) == WEDGE]
            self.assertEqual(len(volumes), wedges)
            self.assertGreater(volumes.min(), 0.0)
            node = frame.data("node")
            for i in beam:
                around = numpy.linalg.norm(frame.points[node == i][1:] - frame.points[i], axis=1)
                self.assertEqual(len(around), 16)
                self.assertAlmostEqual(around.max(), 0.5 * width[i], places=9)
                self.assertAlmostEqual(around.min(), 0.5 * thickness[i], places=9)

    def test_cells_of_a_turbine(self):
        self.succeed("floquet", BASELINE, "-o", "f.h5")
        with h5py.File(self.folder / "f.h5") as file:
            lines = file["geometry/lines"][:].astype(int)
            parts = file["geometry/part"].asstr()[:]
            straight = file["geometry/undeformed"][0]
        beams = sum(parts[a] == parts[b] and parts[a] in ("tower", "blade 1", "blade 2") for a, b in lines)
        bodies = sum(parts[a] in ("nacelle", "shaft", "hub") and not numpy.array_equal(straight[a], straight[b])
                     for a, b in lines)
        for frame in self.frames("f.h5", "--mode", "14", "--frames", "5"):
            self.assertEqual(frame.types.count(WEDGE), 16 * beams)
            self.assertEqual(frame.types.count(LINE), bodies)
            self.assertGreater(frame.volumes()[numpy.array(frame.types) == WEDGE].min(), 0.0)

    def test_states_of_statics(self):
        self.succeed("static", BASELINE, *BENT, "--set", "nacelle.yaw.joint=locked", "--set", "hub.teeter.joint=locked",
                     "--set", "shaft.speed=0", "-o", "s.h5")
        frames = self.frames("s.h5")
        with h5py.File(self.folder / "s.h5") as file:
            factors, places = file["static/factor"][:], file["geometry/place"][:]
        self.assertEqual([frame.time for frame in frames], list(factors))
        for frame, place in zip(frames, places):
            numpy.testing.assert_array_equal(frame.points[: len(place)], place)
        self.assertEqual(self.export("s.h5", "-o", "b.pvd", "--frames", "3")[0], 2)

    def test_foreign_files_stay(self):
        self.succeed("trim", BASELINE, "-o", "t.h5")
        self.write("a/notes.txt", "mine")
        self.assertEqual(self.export("t.h5", "-o", "a.pvd", "--frames", "4")[0], 0)
        self.assertEqual(self.export("t.h5", "-o", "a.pvd", "--frames", "2")[0], 0)
        self.assertEqual(sorted(path.name for path in (self.folder / "a").iterdir()),
                         ["frame_0000.vtu", "frame_0001.vtu", "notes.txt"])
        self.write("a/frame_0003.vtu", "mine")
        for arguments, words in ((["-o", "a.pvd", "--frames", "4"], "frame_0003.vtu: exists and is no file of samara"),
                                 (["-o", "b.pvd"], "b.pvd: exists and is no file of samara"),
                                 (["-o", "c.pvd"], "c: exists and is no folder"),
                                 (["-o", "none/d.pvd"], "none: no such folder")):
            self.write("b.pvd", "mine")
            self.write("c", "mine")
            before = self.files()
            code, out, errors = self.export("t.h5", *arguments)
            self.assertEqual((code, out), (2, ""))
            self.assertIn(words, errors)
            self.assertIn("hint:", errors)
            self.assertEqual(len(errors.splitlines()), 1, errors)
            self.assertEqual(self.files(), before)
        self.assertEqual(self.export("t.h5", "-o", "a.pvd", "--frames", "2")[0], 0)
        self.assertEqual((self.folder / "a/frame_0003.vtu").read_text(), "mine")

    def test_wrong_arguments(self):
        self.succeed("trim", BASELINE, "-o", "t.h5")
        self.succeed("floquet", BASELINE, "-o", "f.h5")
        self.succeed("transient", BASELINE, "--set", "transient={duration: 0.1, step: 0.01}", "-o", "x.h5")
        before = self.files()
        for arguments, words in ((["t.h5", "-o", "a.pvd", "--mode", "1"], "no modes; hint: samara floquet"),
                                 (["f.h5", "-o", "a.pvd", "--mode", "30"], "no mode 30 with a shape; hint: there are 1-15"),
                                 (["f.h5", "-o", "a.pvd", "--label", "flap"], "hint: 1st blade flap symmetric"),
                                 (["f.h5", "-o", "a.pvd", "--label", "flop symmetric"], "blade flap symmetric"),
                                 (["f.h5", "-o", "a.pvd", "--mode", "1", "--held"], "does not oscillate; hint:"),
                                 (["f.h5", "-o", "a.vtu"], "ends in .pvd"),
                                 (["f.h5"], "hint: samara export RESULT.h5 -o NAME.pvd"),
                                 (["f.h5", "-o", "a.pvd", "--frames", "0"], "expected 1 to 10000"),
                                 (["f.h5", "-o", "a.pvd", "--mode", "x"], "hint:"),
                                 (["x.h5", "-o", "a.pvd"], "no places of nodes (/geometry); hint: "
                                  "--set transient.output.places=true"),
                                 (["t.h5", "-o", "a.pvd", "--until", "1"], "--until is for a result of samara transient"),
                                 (["none.h5", "-o", "a.pvd"], "none.h5: no such file; hint:"),
                                 ([BASELINE, "-o", "a.pvd"], "cannot be read as a result; hint:")):
            code, out, errors = self.export(*arguments)
            self.assertEqual((code, out), (2, ""), errors)
            self.assertIn(words, errors)
            self.assertEqual(len(errors.splitlines()), 1, errors)
            self.assertTrue(errors.startswith("samara: "), errors)
        self.assertEqual(self.files(), before)


@contextlib.contextmanager
def _in_folder(folder):
    back = os.getcwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(back)


if __name__ == "__main__":
    unittest.main()
