"""Places of a turbine's nodes in modes and time series, over time and along the beams, from a result file.

    turbine = shapes.Turbine(result)
    mode = shapes.modes_of(result, turbine)[4]
    turbine.place(0.1), mode.motion(0.1)               # of all nodes, 0.1 s after t = 0
    shapes.Transient(run, shapes.Turbine(run)).at(2.5) # places and rotation vectors in a time series

Components are in x y z of the ground: x downwind at zero yaw, z up. Between the instants of a revolution all values are
trigonometric series over it. Between the rows of a time series they are linear in the axes of the hub.
"""

import difflib
import re

import numpy

from .result import complex_of

LARGEST_TURN = 0.6  # of a drawn rotation [rad]
LARGEST_GAP = 2.0  # of the rotor between two rows with values between them [rad]
NODE_CHANNEL = re.compile(r"Node(\d+)([PR])([xyz])")
PLACES_HINT = "--set transient.output.places=true in the run"
NOT_ON_ROTOR = ("tower", "nacelle")


class ShapeError(ValueError):
    """A result without places or motions of nodes."""


def _waves(count, turns):
    """The first `count` of 1, cos, sin, cos 2, sin 2 ... after `turns` revolutions [..., count]."""
    number = numpy.arange(count)
    angle = 2.0 * numpy.pi * numpy.multiply.outer(turns, (number + 1) // 2)
    return numpy.where(number % 2 == 1, numpy.cos(angle), numpy.where(number == 0, 1.0, numpy.sin(angle)))


def periodic(values, phases, turns):
    """The trigonometric series through values [instant, ...] at phases of a revolution, after `turns` revolutions."""
    weights = numpy.linalg.solve(_waves(len(phases), phases).T, _waves(len(phases), numpy.asarray(turns)).T).T
    return numpy.tensordot(weights, values, 1)


def turned(vectors, rotation):
    """Vectors [node, ..., 3] turned by the rotation vectors [node, 3]."""
    angle = numpy.linalg.norm(rotation, axis=-1)
    axis = rotation / numpy.where(angle > 0.0, angle, 1.0)[:, None]
    middle = (1,) * (vectors.ndim - 2)
    axis = axis.reshape(len(axis), *middle, 3)
    angle = angle.reshape(len(angle), *middle, 1)
    along = (vectors * axis).sum(-1, keepdims=True) * axis
    return along + (vectors - along) * numpy.cos(angle) + numpy.cross(axis, vectors) * numpy.sin(angle)


class Turbine:
    """Nodes, lines and places in the group /geometry of a result.

    parts: nodes of each part, by its name. count: number of instants of a revolution, or of states.
    """

    def __init__(self, result):
        if "geometry" not in result:
            hint = PLACES_HINT if "transient" in result else "samara modes, floquet, trim and static write them"
            raise ShapeError(f"{result.path}: no places of nodes (/geometry); hint: {hint}")
        data = result["geometry"]
        names = [str(name) for name in data["part"].values]
        self.path = result.path
        self.part_of = names
        self.parts = {name: numpy.flatnonzero([other == name for other in names]) for name in dict.fromkeys(names)}
        self.station = data["station"].values
        self.width = data["width"].values
        self.thickness = data["thickness"].values
        self.lines = data["lines"].values.astype(int)
        self.places = data["place"].values
        self.undeformed_places = data["undeformed"].values
        self.all_axes = data["axes"].values
        self.times = data["time"].values
        self.azimuths = data["azimuth"].values
        self.count = len(self.times)
        self.is_path = "state" in data["place"].dims
        period = float(result["model"]["period"]) if "model" in result else 0.0
        self.period = 0.0 if self.is_path else period
        self.phases = self.times / self.period if self.period > 0.0 else self.times
        gaps = numpy.diff(self.phases, append=1.0)
        if self.turns and not 0.5 < gaps.min() * self.count <= gaps.max() * self.count < 1.5:
            raise ShapeError(f"{result.path}: the instants of /geometry are not spread over a revolution")

    @property
    def turns(self):
        """True if the places are those of a turning rotor."""
        return self.period > 0.0 and self.count > 1

    @property
    def beams(self):
        """Names of the parts that are beams."""
        return [name for name, nodes in self.parts.items() if numpy.isfinite(self.station[nodes]).all()]

    @property
    def blades(self):
        return [name for name in self.beams if name != "tower"]

    @property
    def size(self):
        """The largest extent of the undeformed turbine [m]."""
        return float(numpy.ptp(self.undeformed_places[0], axis=0).max())

    def _at(self, values, t):
        return periodic(values, self.phases, t / self.period) if self.turns else values[0]

    def place(self, t=0.0):
        """Places of the nodes in the steady state [node, 3], in m."""
        return self._at(self.places, t)

    def undeformed(self, t=0.0):
        return self._at(self.undeformed_places, t)

    def axes(self, t=0.0):
        """Unit vectors of the nodes [node, axis, 3]."""
        vectors = self._at(self.all_axes, t)
        return vectors / numpy.linalg.norm(vectors, axis=-1, keepdims=True)

    def directions(self, name):
        """Out of the rotor's plane and in it, of a blade at its root [instant, 2, 3]; fore-aft and side-side of a tower.

        At zero pitch these are b3 and b2 of the root. In the plane, positive is the direction of +s2 rotation.
        """
        root = self.parts[name][0]
        if name == "tower":
            return numpy.broadcast_to(numpy.eye(3)[:2], (self.count, 2, 3))
        along = self.all_axes[:, root, 0]
        shaft = self.all_axes[:, self.parts["hub"][-1], 0]
        out = shaft - (shaft * along).sum(-1, keepdims=True) * along
        size = numpy.linalg.norm(out, axis=-1, keepdims=True)
        if size.min() < 0.1:  # a beam along the shaft has no plane
            return self.all_axes[:, root, :0:-1]
        out = out / size
        return numpy.stack([out, numpy.cross(out, along)], 1)


class Mode:
    """A mode: the motion at time t is the real part of periodic part times exp(exponent t).

    number: as in the table of the program, from 1 on. shape: its periodic part at the instants [instant, node, 6],
    displacement [m] and rotation [rad], relative to the exponent with its harmonic.
    """

    def __init__(self, turbine, number, label, exponent, shape, **values):
        self.turbine = turbine
        self.number = number
        self.label = label
        self.exponent = exponent
        self.shape = shape
        self.frequency_hz = exponent.imag / (2.0 * numpy.pi)
        self.damping_ratio = values.get("damping_ratio", 0.0)
        self.is_resolved = values.get("is_resolved", True)

    @property
    def oscillates(self):
        return self.exponent.imag > 1e-6 * max(abs(self.exponent), 1e-12)

    @property
    def vibration_period(self):
        return 1.0 / self.frequency_hz if self.oscillates else 0.0

    def periodic_part(self, t=0.0):
        """Displacement and rotation of the nodes [node, 6], complex."""
        turbine = self.turbine
        return periodic(self.shape, turbine.phases, t / turbine.period) if turbine.turns else self.shape[0]

    def motion(self, t=0.0, held_at=None):
        """Displacement and rotation of the nodes [node, 6] at time t, without growth and decay.

        held_at: the rotor stands at this time, only the vibration goes on.
        """
        return (self.periodic_part(t if held_at is None else held_at) * numpy.exp(1j * self.exponent.imag * t)).real

    def scaled(self, factor):
        return Mode(self.turbine, self.number, self.label, self.exponent, self.shape * factor,
                    damping_ratio=self.damping_ratio, is_resolved=self.is_resolved)

    def deflections(self, name):
        """Of the nodes of a beam [instant, node, 3]: out of plane and in plane [m] and torsion [rad].

        Those of a blade are relative to its root. Those of a tower are fore-aft and side-side, along x and y.
        """
        return self._deflections(name)[0]

    def slopes(self, name):
        """The first two deflections per length along the beam, by the rotations of the nodes."""
        return self._deflections(name)[1]

    def _deflections(self, name):
        nodes = self.turbine.parts[name]
        moved, rotated = self.shape[:, nodes, :3], self.shape[:, nodes, 3:]
        tangents = self.turbine.all_axes[:, nodes, 0]
        if name != "tower":
            arms = self.turbine.places[:, nodes] - self.turbine.places[:, nodes[:1]]
            moved = moved - moved[:, :1] - numpy.cross(rotated[:, :1], arms)
            rotated = rotated - rotated[:, :1]
        directions = self.turbine.directions(name)
        lateral = numpy.einsum("inc,idc->ind", moved, directions)
        torsion = (rotated * tangents).sum(-1, keepdims=True)
        slopes = numpy.einsum("inc,idc->ind", numpy.cross(rotated, tangents), directions)
        return numpy.concatenate([lateral, torsion], -1), slopes

    def joints(self):
        """Angles [instant] of yaw, teeter, shaft and of the blades' roots [rad], by the rotations of their bodies.

        Of each root: flap, positive downwind, lag, positive against the direction of the rotation, and pitch, positive toward
        feather, as the hinges of a case.
        """
        nodes = self.turbine.parts
        rotated = {name: self.shape[:, nodes[name][-1], 3:] for name in ("nacelle", "shaft", "hub")}
        axes = {name: self.turbine.all_axes[:, nodes[name][-1]] for name in rotated}
        ground = self.shape[:, nodes["tower"][-1], 3:] if "tower" in nodes else 0.0
        angles = {"yaw": ((rotated["nacelle"] - ground) * axes["nacelle"][:, 2]).sum(-1),
                  "teeter": -((rotated["hub"] - rotated["shaft"]) * axes["shaft"][:, 1]).sum(-1),
                  "shaft": ((rotated["shaft"] - rotated["nacelle"]) * axes["nacelle"][:, 0]).sum(-1)}
        for name in self.turbine.blades:
            root = nodes[name][0]
            turn = self.shape[:, root, 3:] - rotated["hub"]
            out, inside = numpy.moveaxis(self.turbine.directions(name), 1, 0)
            angles[f"{name} flap"] = -(turn * inside).sum(-1)
            angles[f"{name} lag"] = -(turn * out).sum(-1)
            angles[f"{name} pitch"] = -(turn * self.turbine.all_axes[:, root, 0]).sum(-1)
        return angles

    def normalised(self, displacement=1.0, rotation=numpy.radians(10.0)):
        """The mode with the largest displacement [m] or the largest torsion [rad], whichever is reached first.

        The largest one at the first instant is real and positive.
        """
        parts = [self.shape[..., :3].reshape(self.turbine.count, -1) / displacement]
        for name in self.turbine.beams:
            parts.append(self.deflections(name)[..., 2] / rotation)
        everything = numpy.concatenate(parts, 1)
        first = everything[0, numpy.argmax(abs(everything[0]))]
        phase = abs(first) / first if first != 0.0 else 1.0
        return self.scaled(phase / abs(everything).max())

    def drawing_scale(self, share):
        """A factor: the largest displacement becomes this share of the turbine's size, no rotation exceeds 0.6 rad."""
        factors = [largest / abs(values).max() for largest, values in (
            (share * self.turbine.size, numpy.linalg.norm(self.shape[..., :3], axis=-1)),
            (LARGEST_TURN, numpy.linalg.norm(self.shape[..., 3:], axis=-1))) if abs(values).max() > 0.0]
        return float(min(factors, default=1.0))


def quaternions(rotations):
    """Unit quaternions [..., 4], the real part last, of rotation vectors [..., 3]."""
    half = 0.5 * numpy.linalg.norm(rotations, axis=-1, keepdims=True)
    return numpy.concatenate([0.5 * numpy.sinc(half / numpy.pi) * rotations, numpy.cos(half)], -1)


def rotation_vectors(turns):
    """Rotation vectors [..., 3] of unit quaternions, at most half a turn long."""
    turns = numpy.where(turns[..., 3:] < 0.0, -turns, turns)
    sine = numpy.linalg.norm(turns[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * numpy.arctan2(sine, turns[..., 3:])
    factor = numpy.where(sine > 0.0, angle / numpy.where(sine > 0.0, sine, 1.0), 2.0)
    return factor * turns[..., :3]


def _product(first, second):
    """Of quaternions: the second turn, then the first one."""
    a, b = first[..., :3], second[..., :3]
    c, d = first[..., 3:], second[..., 3:]
    return numpy.concatenate([c * b + d * a + numpy.cross(a, b), c * d - (a * b).sum(-1, keepdims=True)], -1)


def _inverse(turns):
    return turns * numpy.array([-1.0, -1.0, -1.0, 1.0])


def _turned_by(turn, vectors):
    """Vectors [..., 3] turned by one quaternion."""
    return turned(vectors, numpy.broadcast_to(rotation_vectors(turn), vectors.shape))


def axes_of(rotations):
    """Axes [node, axis, 3] of nodes with the rotation vectors [node, 3] from x y z of the ground."""
    return turned(numpy.broadcast_to(numpy.eye(3), (len(rotations), 3, 3)), rotations)


class Transient:
    """Places and rotations of the nodes in a time series, of a run with transient.output.places.

    times: of the rows. places [row, node, 3]: in m. rotations [row, node, 3]: rotation vectors in rad, which turn x y z
    of the ground into the axes of each node.
    """

    def __init__(self, result, turbine):
        data = result["transient"]
        count = len(turbine.part_of)
        columns = numpy.full((2, count, 3), -1)
        for column, name in enumerate(data["channel_name"].values):
            match = NODE_CHANNEL.fullmatch(str(name))
            if match and 1 <= int(match[1]) <= count:
                columns["PR".index(match[2]), int(match[1]) - 1, "xyz".index(match[3])] = column
        if columns.min() < 0:
            raise ShapeError(f"{result.path}: the time series has no places of nodes (Node1Px); hint: {PLACES_HINT}")
        self.times = data["time"].values
        if len(self.times) == 0:
            raise ShapeError(f"{result.path}: the time series has no rows; hint: a longer transient.duration")
        values = data["values"].values
        self.places = values[:, columns[0]]
        self.rotations = numpy.radians(values[:, columns[1]])
        self._hub = int(turbine.parts["hub"][-1]) if "hub" in turbine.parts else 0
        self.on_rotor = numpy.array([name not in NOT_ON_ROTOR for name in turbine.part_of])
        self._first_of_part = numpy.array([turbine.parts[name][0] for name in turbine.part_of])
        self._speed = float(result["model"]["rotor_speed"]) if "model" in result else 0.0

    def turns_between(self, rows):
        """Angles of the hub between successive rows of a list, at least those at constant rotor speed [rad]."""
        hub = quaternions(self.rotations[:, self._hub])
        steps = numpy.linalg.norm(rotation_vectors(_product(_inverse(hub[:-1]), hub[1:])), axis=-1)
        turned_by = numpy.concatenate([[0.0], numpy.cumsum(steps)])[rows]
        return numpy.maximum(numpy.diff(turned_by), self._speed * numpy.diff(self.times[rows]))

    def require_between(self, path):
        """Raises where the rotor turns too far between rows for values between them."""
        most = self.turns_between(numpy.arange(len(self.times))).max(initial=0.0)
        if most > LARGEST_GAP:
            raise ShapeError(f"{path}: the rotor turns by {numpy.degrees(most):.0f} degrees between two rows, too far "
                             "for frames between them; hint: transient.output.every, or without --frames and --every")

    def at(self, t):
        """Places and rotation vectors [node, 3] at a time within the series.

        Between rows the axes of a node turn about one axis. The nodes of the rotor move linearly in the axes of the hub: a
        rigid rotor stays rigid. Tower and nacelle move linearly.
        """
        last = len(self.times) - 1
        row = int(numpy.clip(numpy.searchsorted(self.times, t, side="right") - 1, 0, max(0, last - 1)))
        for whole in (row, min(row + 1, last)):
            if self.times[whole] == t or last == 0:
                return self.places[whole], self.rotations[whole]
        part = (t - self.times[row]) / (self.times[row + 1] - self.times[row])
        ends, turns = self.places[row : row + 2], quaternions(self.rotations[row : row + 2])
        place = ends[0] + part * (ends[1] - ends[0])
        turn = self._between(turns[0], turns[1], part)
        rotor = self.on_rotor
        hubs = turns[:, self._hub]
        arms = [_turned_by(_inverse(hubs[i]), ends[i][rotor] - ends[i][self._hub]) for i in (0, 1)]
        place[rotor] = place[self._hub] + _turned_by(turn[self._hub], arms[0] + part * (arms[1] - arms[0]))
        return place, rotation_vectors(turn)

    @staticmethod
    def _between(first, second, part):
        """Quaternions on the way from the first to the second turn, about one axis."""
        return _product(first, quaternions(part * rotation_vectors(_product(_inverse(first), second))))

    def deflections(self, places, rotations):
        """Displacements [node, 3] since the first row, relative to the first node of each part and its axes.

        The part as it was in the first row moves with its first node like a rigid body; the deflection is the rest.
        """
        roots = self._first_of_part
        since = rotation_vectors(_product(quaternions(rotations), _inverse(quaternions(self.rotations[0]))))
        arms = self.places[0] - self.places[0][roots]
        return places - places[roots] - turned(arms, since[roots])


def modes_of(result, turbine=None):
    """The modes of a result that have motions of nodes, by their numbers."""
    group = next((name for name in ("floquet", "modes") if name in result), None)
    if group is None:
        raise ShapeError(f"{result.path}: no modes; hint: samara floquet and samara modes write them")
    turbine = turbine or Turbine(result)
    data = result[group]
    if "node_motion" not in data:
        raise ShapeError(f"{result.path}: the modes have no motions of nodes (/{group}/node_motion)")
    exponents = complex_of(data["exponents"]).values
    harmonics = data["harmonic"].values if "harmonic" in data else numpy.zeros(len(exponents))
    speed = float(data.attrs.get("rotor_speed", 0.0)) if "harmonic" in data else 0.0
    motions = complex_of(data["node_motion"]).values.astype(complex)
    # Without the waves of the harmonic the shapes are slow enough for the instants of the file.
    waves = numpy.exp(-1j * speed * numpy.outer(harmonics, turbine.times[: motions.shape[1]]))
    shapes = motions * waves[:, :, None, None]
    labels = [str(label) for label in data["label"].values]
    damping = data["damping_ratio"].values
    resolved = data["resolved"].values == 1 if "resolved" in data else numpy.ones(len(labels), bool)
    return {i + 1: Mode(turbine, i + 1, labels[i], exponents[i], shapes[i], damping_ratio=float(damping[i]),
                        is_resolved=bool(resolved[i]))
            for i in range(len(labels)) if numpy.isfinite(shapes[i]).all()}


def find_mode(modes, path, number=None, label=None):
    """The mode of a number or a label. Without both, the first one that oscillates."""
    if not modes:
        raise ShapeError(f"{path}: no mode is resolved; hint: more floquet.steps")
    if number is not None:
        if number not in modes:
            raise ShapeError(f"{path}: no mode {number} with a shape; hint: there are {_ranges(modes)}")
        return modes[number]
    if label is None:
        return next((mode for mode in modes.values() if mode.oscillates), next(iter(modes.values())))
    found = [mode for mode in modes.values() if mode.label == label]
    found = found or [mode for mode in modes.values() if label.lower() in mode.label.lower()]
    if len(found) == 1:
        return found[0]
    names = [mode.label for mode in found] or difflib.get_close_matches(
        label, [mode.label for mode in modes.values()], 3, 0.3)
    raise ShapeError(f"{path}: {len(found) or 'no'} modes \"{label}\"" +
                     (f"; hint: {', '.join(names[:6])}" if names else f"; hint: there are {_ranges(modes)}"))


def _ranges(numbers):
    """1-4, 7, 9 of numbers in order."""
    runs = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(f"{a}-{b}" if a < b else str(a) for a, b in runs)


def curve(stations, values, slopes, length, count=12):
    """Stations and values of a deflection along a beam: cubic between the nodes, with the slopes of the nodes."""
    share = numpy.linspace(0.0, 1.0, count, endpoint=False)
    at, found = [], []
    for i in range(len(stations) - 1):
        step = stations[i + 1] - stations[i]
        if step <= 0.0:
            continue
        at.append(stations[i] + step * share)
        found.append((1 + 2 * share) * (1 - share) ** 2 * values[i] + share**2 * (3 - 2 * share) * values[i + 1]
                     + step * length * share * (1 - share) * ((1 - share) * slopes[i] - share * slopes[i + 1]))
    return numpy.concatenate([*at, stations[-1:]]), numpy.concatenate([*found, values[-1:]])
