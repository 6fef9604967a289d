"""Animations for ParaView as PVD and VTU files: a mode, the periodic steady state, a transient, the states of statics.

    samara export RESULT.h5 -o NAME.pvd [--mode N | --label TEXT | --steady] [--held [DEG]] [--cycles N] [--frames N]
    samara export RUN.h5 -o NAME.pvd [--from T] [--until T] [--frames N | --every S]

NAME.pvd lists the frames NAME/frame_0000.vtu ... with their times. Beams are tubes of wedges with elliptic sections,
rigid bodies are lines. The XML is written here and not by a library: the files have the names of the parts, the time
and a mark of their origin, by which a later run knows which files it may replace.
"""

import argparse
import base64
import os
import pathlib
import shutil
import sys
import tempfile
import xml.sax.saxutils

import numpy

from .result import open_result
from .shapes import ShapeError, Transient, Turbine, axes_of, find_mode, modes_of, turned

AROUND = 16  # points around a section
FRAMES = 24  # of a cycle
MOST_ROWS = 300  # of a transient, unless the frames are asked for
MOST_FRAMES = 10000
DRAWN_SHARE = 0.05  # of the turbine's size, the largest displacement of a mode
MARK = "<!-- written by samara export -->"
LINE, WEDGE = 3, 13  # types of cells in VTK
TYPES = {"float64": "Float64", "int32": "Int32", "int64": "Int64", "uint8": "UInt8"}


class ExportError(ValueError):
    """Arguments or a result that give no animation."""


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise ExportError(f"{message}; hint: samara export RESULT.h5 -o NAME.pvd")


class Tubes:
    """The mesh of a turbine: its points are the nodes, in their order, and points around the sections of the beams."""

    def __init__(self, turbine):
        beam = numpy.isfinite(turbine.station)
        count = len(beam)
        self.ringed = numpy.flatnonzero(beam & (turbine.width > 0.0))
        first = numpy.full(count, -1)
        first[self.ringed] = count + AROUND * numpy.arange(len(self.ringed))
        self.node = numpy.concatenate([numpy.arange(count), numpy.repeat(self.ringed, AROUND)])
        angle = 2.0 * numpy.pi * numpy.arange(AROUND) / AROUND
        sizes = 0.5 * numpy.stack([turbine.width, turbine.thickness], -1)[self.ringed]
        self._arms = numpy.stack([numpy.outer(sizes[:, 0], numpy.cos(angle)),
                                  numpy.outer(sizes[:, 1], numpy.sin(angle))], -1)  # [beam node, around, axis]
        next_one = (numpy.arange(AROUND) + 1) % AROUND
        cells, types, parts = [], [], []
        numbers = {name: number for number, name in enumerate(turbine.parts)}
        self.part = numpy.array([numbers[turbine.part_of[node]] for node in self.node], dtype=numpy.int32)
        self.station = turbine.station[self.node]
        lengths = numpy.linalg.norm(numpy.diff(turbine.undeformed_places[0][turbine.lines], axis=1)[:, 0], axis=-1)
        for (start, end), length in zip(turbine.lines, lengths):
            if length == 0.0:
                continue
            owner = turbine.part_of[start]
            if first[start] >= 0 and first[end] >= 0 and owner == turbine.part_of[end]:
                for j in range(AROUND):  # the first triangle of a wedge faces outward
                    cells.append([start, first[start] + next_one[j], first[start] + j,
                                  end, first[end] + next_one[j], first[end] + j])
                    types.append(WEDGE)
                    parts.append(numbers[owner])
            else:
                cells.append([start, end])
                types.append(LINE)
                parts.append(numbers[owner])
        self.connectivity = numpy.concatenate(cells).astype(numpy.int64)
        self.offsets = numpy.cumsum([len(cell) for cell in cells]).astype(numpy.int64)
        self.types = numpy.array(types, dtype=numpy.uint8)
        self.cell_part = numpy.array(parts, dtype=numpy.int32)

    def points(self, places, axes):
        """Points for places [node, 3] and axes [node, axis, 3] of the nodes."""
        rings = places[self.ringed, None] + numpy.einsum("nja,nac->njc", self._arms, axes[self.ringed, 1:])
        return numpy.concatenate([places, rings.reshape(-1, 3)])


def _array(name, values, components=None):
    values = numpy.ascontiguousarray(values)
    header = numpy.array([values.nbytes], dtype="<u8").tobytes()
    data = base64.b64encode(header + values.astype(values.dtype.newbyteorder("<")).tobytes()).decode()
    kind = TYPES[str(values.dtype)]
    several = f' NumberOfComponents="{components}"' if components else ""
    return f'<DataArray type="{kind}" Name="{name}"{several} format="binary">{data}</DataArray>\n'


def _texts(name, texts):
    codes = " ".join(f"{' '.join(str(code) for code in text.encode())} 0" for text in texts)
    return f'<Array type="String" Name="{name}" NumberOfTuples="{len(texts)}" format="ascii">{codes}</Array>\n'


def _write_frame(path, tubes, names, time, points, vectors):
    """vectors: by their names, of each point; the first one is that which ParaView shows."""
    path.write_text(
        f'<?xml version="1.0"?>\n{MARK}\n'
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
        "<UnstructuredGrid>\n<FieldData>\n"
        f'<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{time!r}</DataArray>\n'
        f'{_texts("part_names", names)}</FieldData>\n'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(tubes.types)}">\n'
        f'<PointData Vectors="{next(iter(vectors))}">\n'
        f'{"".join(_array(name, values, 3) for name, values in vectors.items())}'
        f'{_array("part", tubes.part)}{_array("node", tubes.node.astype(numpy.int32))}'
        f'{_array("station", tubes.station)}</PointData>\n'
        f'<CellData>\n{_array("part", tubes.cell_part)}</CellData>\n'
        f'<Points>\n{_array("Points", points, 3)}</Points>\n'
        f'<Cells>\n{_array("connectivity", tubes.connectivity)}{_array("offsets", tubes.offsets)}'
        f'{_array("types", tubes.types)}</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n', encoding="ascii")


class _Frames:
    """Frames to write: count, and of each its time, points and vectors; text: of the message."""

    def __init__(self, count, at, text):
        self.count, self.at, self.text = count, at, text


def _mode_frames(turbine, tubes, mode, given):
    if not mode.oscillates and not turbine.turns:
        raise ExportError(f"{turbine.path}: mode {mode.number}, {mode.label}, does not oscillate and the rotor does not "
                          "turn: nothing moves; hint: --mode of another one")
    held_at = None
    if given.held is not None:
        held_at = _time_of(turbine, given.held)
    if held_at is not None and not mode.oscillates:
        raise ExportError(f"{turbine.path}: mode {mode.number}, {mode.label}, does not oscillate; hint: without --held "
                          "the rotor turns")
    scale = mode.drawing_scale(DRAWN_SHARE) if given.scale is None else given.scale
    cycle = mode.vibration_period or turbine.period
    count = given.frames or FRAMES

    def at(i):
        time = cycle * i / count
        stand = time if held_at is None else held_at
        places, axes = turbine.place(stand), turbine.axes(stand)
        motion = scale * mode.motion(time, held_at)
        moved = tubes.points(places + motion[:, :3], turned(axes, motion[:, 3:]))
        return time, moved, {"displacement": moved - tubes.points(places, axes), "rotation": motion[tubes.node, 3:]}

    return _Frames(given.cycles * count, at,
                   f"mode {mode.number}, {mode.label}; {cycle:.5g} s a cycle, displacements x {scale:.3g}")


def _time_of(turbine, degrees):
    """The time within the revolution at which blade 1 is at an azimuth."""
    if not turbine.turns:
        if degrees % 360.0 != 0.0:
            raise ExportError(f"{turbine.path}: the result has one azimuth only; hint: --held without a number")
        return 0.0
    return (numpy.radians(degrees) - turbine.azimuths[0]) / (2.0 * numpy.pi) % 1.0 * turbine.period


def _steady_frames(turbine, tubes, given):
    scale = 1.0 if given.scale is None else given.scale
    count = (given.frames or FRAMES) if turbine.turns else 1

    def at(i):
        time = turbine.period * i / count if turbine.turns else 0.0
        return time, *_scaled_state(tubes, turbine.undeformed(time), turbine.place(time), turbine.axes(time), scale)

    return _Frames(given.cycles * count if turbine.turns else 1, at,
                   f"the periodic steady state, displacements x {scale:.3g}")


def _state_frames(turbine, tubes, factors, given):
    if given.frames or given.cycles != 1:
        raise ExportError(f"{turbine.path}: the frames are the {turbine.count} states of samara static; hint: without "
                          "--frames and --cycles")
    scale = 1.0 if given.scale is None else given.scale

    def at(i):
        return float(factors[i]), *_scaled_state(tubes, turbine.undeformed_places[i], turbine.places[i],
                                                 turbine.all_axes[i], scale)

    return _Frames(turbine.count, at, f"the states of samara static, time: load factor, displacements x {scale:.3g}")


def _scaled_state(tubes, undeformed, places, axes, scale):
    moved = scale * (places - undeformed)
    # The file has no undeformed axes: the sections are those of the state, without a rotation.
    return tubes.points(undeformed + moved, axes), {"displacement": moved[tubes.node]}


def _times_of(transient, given, path):
    """Times of the frames of a transient, and words on them."""
    times = transient.times
    near = 1e-9 * max(1.0, abs(times[-1]))
    begin = times[0] if given.begin is None else max(given.begin, times[0])
    end = times[-1] if given.until is None else min(given.until, times[-1])
    if begin > end + near:
        raise ExportError(f"{path}: no rows between --from and --until; hint: the series is from {times[0]:g} to "
                          f"{times[-1]:g} s")
    if given.frames is None and given.every is None:
        rows = numpy.flatnonzero((times >= begin - near) & (times <= end + near))
        if len(rows) == 0:
            raise ExportError(f"{path}: no row between {begin:g} and {end:g} s; hint: --frames for values between rows")
        step = -(-len(rows) // MOST_ROWS)
        words = "each row" if step == 1 else f"one row of {step}, {len(rows)} in all; --every gives more frames"
        return times[rows[::step]], words
    if given.frames is not None:
        found = numpy.linspace(begin, end, given.frames)
    else:
        count = int(numpy.floor((end - begin) / given.every + 1e-6)) + 1
        if count > MOST_FRAMES:
            raise ExportError(f"{count} frames are more than {MOST_FRAMES}; hint: a larger --every")
        found = begin + given.every * numpy.arange(count)
    # Rounding does not move a frame away from its row.
    nearest = times[numpy.minimum(numpy.searchsorted(times, found - near), len(times) - 1)]
    found = numpy.where(abs(nearest - found) <= near, nearest, found)
    if numpy.isin(found, times).all():
        return found, "rows"
    transient.require_between(path)
    return found, "rows and values between them"


def _transient_frames(result, turbine, tubes, given):
    transient = Transient(result, turbine)
    times, words = _times_of(transient, given, result.path)

    def at(i):
        places, rotations = transient.at(times[i])
        return times[i], tubes.points(places, axes_of(rotations)), {
            "deflection": transient.deflections(places, rotations)[tubes.node], "rotation": rotations[tubes.node]}

    return _Frames(len(times), at, f"the transient, {times[0]:g} to {times[-1]:g} s: {words}")


def _check_options(result, given):
    """Raises where an option does not belong to the kind of the result."""
    if "transient" in result:
        used = [name for name in ("mode", "label", "held", "scale") if getattr(given, name) is not None]
        used += ["steady"] * given.steady + ["cycles"] * (given.cycles is not None)
        if used:
            raise ExportError(f"{result.path}: a transient has no --{used[0]}; hint: --from, --until, --frames, --every")
        return
    used = [option for option, name in (("from", "begin"), ("until", "until"), ("every", "every"))
            if getattr(given, name) is not None]
    if used:
        raise ExportError(f"{result.path}: --{used[0]} is for a result of samara transient; hint: --frames, --cycles")
    if given.cycles is None:
        given.cycles = 1


def _frames_of(result, turbine, tubes, given):
    if "transient" in result:
        return _transient_frames(result, turbine, tubes, given)
    wants_mode = given.mode is not None or given.label is not None
    if turbine.is_path:
        if wants_mode or given.held is not None:
            raise ExportError(f"{result.path}: states of samara static have no modes; hint: samara modes")
        return _state_frames(turbine, tubes, result["static"]["factor"].values, given)
    has_modes = "floquet" in result or "modes" in result
    if given.steady or (not has_modes and not wants_mode and given.held is None):
        return _steady_frames(turbine, tubes, given)
    mode = find_mode(modes_of(result, turbine), result.path, given.mode, given.label)
    return _mode_frames(turbine, tubes, mode, given)


def _is_ours(path):
    with open(path, "rb") as file:
        return MARK.encode() in file.read(200)


def _check_targets(pvd, folder, names):
    """Raises where something would be overwritten that samara export did not write."""
    hint = "; hint: another name behind -o, or remove it"
    if pvd.is_symlink() or pvd.is_dir() or (pvd.exists() and not _is_ours(pvd)):
        raise ExportError(f"{pvd}: exists and is no file of samara export{hint}")
    if not pvd.parent.is_dir():
        raise ExportError(f"{pvd.parent}: no such folder; hint: make it first")
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        raise ExportError(f"{folder}: exists and is no folder; the frames go there{hint}")
    for name in names:
        path = folder / name
        if path.is_symlink() or (path.exists() and not (path.is_file() and _is_ours(path))):
            raise ExportError(f"{path}: exists and is no file of samara export{hint}")


def export(result, path, frames):
    """Writes the frames and their list; returns the number of frames."""
    turbine, tubes, frames = frames
    pvd = pathlib.Path(path)
    folder = pvd.with_suffix("")
    names = [f"frame_{i:04d}.vtu" for i in range(frames.count)]
    _check_targets(pvd, folder, names)
    part_names = list(turbine.parts)
    draft = pathlib.Path(tempfile.mkdtemp(prefix=f".{folder.name}_", dir=pvd.parent))
    try:
        entries = []
        for i, name in enumerate(names):
            time, points, vectors = frames.at(i)
            _write_frame(draft / name, tubes, part_names, float(time), points, vectors)
            entries.append(f'<DataSet timestep="{float(time)!r}" part="0" '
                           f"file={xml.sax.saxutils.quoteattr(f'{folder.name}/{name}')}/>\n")
        text = (f'<?xml version="1.0" encoding="utf-8"?>\n{MARK}\n<VTKFile type="Collection" version="1.0" '
                f'byte_order="LittleEndian">\n<Collection>\n{"".join(entries)}</Collection>\n</VTKFile>\n')
        (draft / pvd.name).write_text(text, encoding="utf-8")
        folder.mkdir(exist_ok=True)
        for name in names:
            os.replace(draft / name, folder / name)
        os.replace(draft / pvd.name, pvd)
        for old in folder.glob("frame_*.vtu"):
            if old.name not in names and old.is_file() and not old.is_symlink() and _is_ours(old):
                old.unlink()
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return frames.count


def main(arguments=None):
    """The command line; returns the exit code."""
    parser = _Parser(prog="samara export", description="Writes an animation for ParaView: NAME.pvd and its frames in "
                     "NAME/. Without --mode, --label and --steady: the first mode that oscillates; of samara trim the "
                     "periodic steady state, of samara static its states, of samara transient its rows.",
                     epilog="example: samara export lee.h5 -o flap.pvd --label \"1st blade flap symmetric\" --held")
    parser.add_argument("result", metavar="RESULT.h5")
    parser.add_argument("-o", dest="output", required=True, metavar="NAME.pvd")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--mode", type=int, metavar="N", help="number of the mode in the table of the program")
    what.add_argument("--label", metavar="TEXT", help="name of the mode, or a part of it that no other one has")
    what.add_argument("--steady", action="store_true", help="the periodic steady state, of a result with modes too")
    parser.add_argument("--held", nargs="?", type=float, const=0.0, metavar="DEG",
                        help="the rotor stands with blade 1 at this azimuth, by default 0; without it the rotor turns")
    parser.add_argument("--cycles", type=int, metavar="N",
                        help="vibrations of a mode, or revolutions of the steady state; by default 1")
    count = parser.add_mutually_exclusive_group()
    count.add_argument("--frames", type=int, metavar="N",
                       help=f"frames a cycle, by default {FRAMES}; of a transient, frames in all, evenly spaced. "
                       f"By default a frame of a transient is a row, or one of several rows: at most {MOST_ROWS} in all")
    count.add_argument("--every", type=float, metavar="S", help="time between frames of a transient, in s")
    parser.add_argument("--from", dest="begin", type=float, metavar="T", help="first time of a transient, in s")
    parser.add_argument("--until", type=float, metavar="T", help="last time of a transient, in s")
    parser.add_argument("--scale", type=float, metavar="X",
                        help="factor of the displacements; by default 1, of a mode such that its largest one is "
                        f"{DRAWN_SHARE:g} of the turbine's size")
    try:
        given = parser.parse_args(arguments)
        if pathlib.Path(given.output).suffix != ".pvd":
            raise ExportError(f"{given.output}: expected a name that ends in .pvd")
        for name in ("cycles", "frames"):
            value = getattr(given, name)
            if value is not None and not 1 <= value <= MOST_FRAMES:
                raise ExportError(f"--{name} {value}: expected 1 to {MOST_FRAMES}")
        for option, value in (("from", given.begin), ("until", given.until), ("every", given.every)):
            if value is not None and not numpy.isfinite(value):
                raise ExportError(f"--{option} {value}: expected a time in s")
        if given.every is not None and given.every <= 0.0:
            raise ExportError(f"--every {given.every:g}: expected a time > 0 s")
        if given.scale is not None and not numpy.isfinite(given.scale):
            raise ExportError(f"--scale {given.scale}: expected a finite number")
        if given.held is not None and (given.steady or not numpy.isfinite(given.held)):
            raise ExportError("--held: expected an azimuth in degrees, and a mode; hint: --mode N --held 90")
        result = open_result(given.result)
        _check_options(result, given)
        turbine = Turbine(result)
        tubes = Tubes(turbine)
        frames = _frames_of(result, turbine, tubes, given)
        if frames.count > MOST_FRAMES:
            raise ExportError(f"{frames.count} frames are more than {MOST_FRAMES}; hint: fewer --cycles or --frames")
        count = export(result, given.output, (turbine, tubes, frames))
    except (ExportError, ShapeError, OSError, ValueError) as error:
        print(f"samara: {str(error).splitlines()[0]}", file=sys.stderr)
        return 2
    print(f"animation: {given.output}, {count} frame{'s' if count > 1 else ''} of {frames.text}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
