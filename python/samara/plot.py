"""Pictures of results: Campbell diagrams, multipliers, steady states, deflections and loads along the beams, time series, mode shapes.

    samara plot RESULT.h5 [KIND ...] [-o NAME.svg|NAME.png|NAME.pdf]
    samara plot RESULT.h5 shapes [--modes 1,2,5] [-o NAME.svg]
    samara plot COARSE.h5 ... FINE.h5 convergence [-o NAME.svg]

Colours are those of Okabe and Ito, which the colour-blind distinguish, with line styles beside them.
"""

import argparse
import difflib
import itertools
import pathlib
import re
import sys

import matplotlib
import numpy

from . import shapes as node_shapes
from .result import complex_of, open_result, unit_of

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"]
STYLES = ["-", "--", "-.", ":"]
GREY = "#888888"
GROWING = "#D00000"
WIDEST = 5.0  # points, the band of a line whose mode has all its energy in its own harmonic
LEAST_SHARE = 0.05  # of a harmonic that a diagram shows
ORDERS = (1, 2, 3, 4, 5, 6, 9, 12)  # multiples of the rotor speed in a diagram
LEAST_DRAWN = 0.01  # of the scale of a mode shape: the least range of an axis; smaller imaginary parts are left out
DRAWN_SHARE = 0.1  # of the turbine's size, the largest displacement in a view
FIRST_MODES = 6  # of the mode shapes, unless modes are named
ENDINGS = (".png", ".svg", ".pdf")
# Units of results that pictures show in others, with the factor. Any other unit remains.
TO_DEGREES = {"rad": ("deg", 180.0 / numpy.pi)}
TO_PER_CENT = {"": ("%", 100.0)}
OF_RATES = {"s": "Hz"}  # units of 1 over a unit that have a name
LEAST_RANGE = 1e-8  # of an axis beside the largest load, or the length of the beam: smaller values are round-off
ALONG_BEAMS = ("trim/blades", "trim/tower")
IN_WORDS = {"fore_aft": "fore-aft", "side_side": "side-side"}


class PlotError(ValueError):
    """A result without what a picture needs."""


def _pyplot():
    import matplotlib.pyplot as pyplot

    pyplot.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "samara", "axes.grid": True, "grid.alpha": 0.25,
                            "font.size": 9, "legend.frameon": False, "figure.constrained_layout.use": True})
    return pyplot


def _style(number):
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": STYLES[number // len(COLOURS) % len(STYLES)]}


def _label(name, unit):
    return f"{name} [{unit}]" if unit else name


def _shown(array, conversion):
    """The unit in which a picture shows an array of a result, and the factor."""
    unit = unit_of(array)
    return conversion.get(unit, (unit, 1.0))


def _rate_of(unit):
    return OF_RATES.get(unit, f"1/{unit}" if unit else "")


def _title(figure, result, text):
    figure.suptitle(f"{result.title}: {text}" if text else result.title, fontsize=10)


def _panels(result, text, names, draw_panel, xlabel):
    """Panels in three columns, one for each name: draw_panel(axes, name) draws it and returns its label."""
    rows = -(-len(names) // 3)
    figure, grid = _pyplot().subplots(rows, 3, figsize=(10, 2.1 * rows), sharex=True, squeeze=False)
    for axes, name in itertools.zip_longest(grid.flat, names):
        if name is None:
            axes.axis("off")
        else:
            axes.set_ylabel(draw_panel(axes, name), fontsize=7)
    for axes in grid[-1]:
        axes.set_xlabel(xlabel)
    _title(figure, result, text)
    return figure


def _campbell_map(result, data):
    """Largest growth rate of all modes and number of growing ones over both keys of a map."""
    values = [numpy.unique(data[name].values) for name in ("value", "second_value")]
    if min(map(len, values)) < 2:
        raise PlotError(f"{result.path}: a map needs two values of each key")
    shape = tuple(len(axis) for axis in values)
    place = tuple(numpy.searchsorted(axis, data[name].values)
                  for axis, name in zip(values, ("value", "second_value")))
    largest = numpy.full(shape, numpy.nan)
    growing = numpy.full(shape, numpy.nan)
    found = numpy.isfinite(data["growth_rate"]).any("mode").values
    places = tuple(axis[found] for axis in place)
    largest[places] = numpy.nanmax(data["growth_rate"].values[:, found], axis=0)
    growing[places] = numpy.nansum(data["is_growing"].values[:, found], axis=0)
    figure, (left, right) = _pyplot().subplots(1, 2, figsize=(10.5, 4.6), sharey=True)
    rate = _label("largest growth rate", unit_of(data["growth_rate"]))
    for axes, field, label in ((left, largest, rate), (right, growing, "number of growing modes")):
        mesh = axes.pcolormesh(*values, field.T, shading="nearest", cmap="cividis")
        bar = figure.colorbar(mesh, ax=axes, label=label)
        if field is growing:
            bar.set_ticks(numpy.unique(growing[numpy.isfinite(growing)]))
        axes.set_xlabel(_label(data.attrs.get("key", "value"), unit_of(data["value"])))
    left.set_ylabel(_label(data.attrs.get("second_key", "value"), unit_of(data["second_value"])))
    if "edge_value" in data:  # refined along the first key
        middle = data["edge_value"].values.mean(axis=1)
        for axes in (left, right):
            axes.plot(middle, data["edge_second_value"].values, "x", color=GROWING, markersize=6)
    _title(figure, result, "stability over two keys" + (" (x: refined edges)" if "edge_value" in data else ""))
    return figure


def _band(axes, x, y, shares, color):
    """A band along a line, as wide at each place as the share, from 0 to 1, there."""
    from matplotlib.collections import LineCollection

    ends = numpy.stack([x, y], axis=1)
    widths = WIDEST * (shares[:-1] + shares[1:]) / 2.0
    shown = numpy.isfinite(ends[:-1]).all(1) & numpy.isfinite(ends[1:]).all(1) & numpy.isfinite(widths)
    axes.add_collection(LineCollection(numpy.stack([ends[:-1], ends[1:]], axis=1)[shown], colors=color,
                                       linewidths=widths[shown], alpha=0.25, zorder=1), autolim=False)


def campbell(result, frame="fixed", first=14):
    """The Campbell diagram and the damping of a result of samara campbell.

    A band around each line is as wide as the share of the kinetic energy in the mode's own harmonic at that point.
    frame: "fixed", or "own", that of the part that moves. A line whose modes have no single frequency in the fixed frame
    is drawn in its own, and marked with * in the legend. In the own frame further harmonics with more than 5 % of the kinetic energy are drawn as thin
    lines, as wide as their share: a part that turns and one that does not have no common harmonics in the fixed frame.
    first: number of modes, by their frequency.
    """
    data = result["campbell"]
    if "mode" not in data:
        raise PlotError(f"{result.path}: no point has modes")
    if "second_value" in data:
        return _campbell_map(result, data)
    data = data.sortby("value")
    pyplot = _pyplot()
    figure, (above, below) = pyplot.subplots(1, 2, figsize=(10.5, 5.2))
    values = data["value"].values
    with_points = numpy.isfinite(data["frequency_hz"]).sum("value").values > (1 if len(values) > 1 else 0)
    lines = numpy.flatnonzero(with_points)[:first]
    turns = data["rotor_speed"].values / (2 * numpy.pi)
    own = data["frequency_hz"].values
    ground = data["fixed_frame_frequency_hz"].values
    harmonics = data["harmonic"].values
    damping_unit, per_cent = _shown(data["damping_ratio"], TO_PER_CENT)
    top = 0.0
    has_own = False
    for number, line in enumerate(lines):
        name = str(data["mode"].values[line])
        style = _style(number)
        is_fixed = frame == "fixed" and 2 * numpy.isfinite(ground[line]).sum() >= numpy.isfinite(own[line]).sum()
        frequency = ground[line] if is_fixed else own[line]
        if frame == "fixed" and not is_fixed:
            name += " *"
            has_own = True
        top = max(top, numpy.nanmax(frequency))
        shares = data["participation"].values[line]
        for column, k in enumerate(harmonics):
            share = shares[:, column]
            if frame == "fixed" or k == 0 or numpy.nanmax(share, initial=0.0) < LEAST_SHARE:
                continue
            branch = numpy.where(share >= LEAST_SHARE, abs(frequency + k * turns), numpy.nan)
            above.plot(values, branch, color=style["color"], linewidth=0.3 + 1.5 * numpy.nanmax(share), alpha=0.35)
        damping = per_cent * data["damping_ratio"].values[line]
        main = shares[:, numpy.flatnonzero(harmonics == 0)[0]]
        for axes, height in ((above, frequency), (below, damping)):
            axes.plot(values, height, label=name, linewidth=1.2, marker=".", markersize=3, **style)
            _band(axes, values, height, main, style["color"])
        grows = data["is_growing"].values[line] == 1.0
        for axes, height in ((above, frequency), (below, damping)):
            axes.plot(values[grows], height[grows], "x", color=GROWING, markersize=6)
    for order in ORDERS:
        if order * numpy.nanmax(turns) == 0.0 or order * numpy.nanmin(turns) > 1.05 * top:
            continue
        above.plot(values, order * turns, color=GREY, linewidth=0.6, zorder=0)
        above.annotate(f"{order}P", (values[-1], min(order * turns[-1], 1.04 * top)), color=GREY, fontsize=7,
                       annotation_clip=True)
    key = _label(data.attrs.get("key", "value"), unit_of(data["value"]))
    words = "frame of the part" if frame == "own" else "fixed frame" + (", *: frame of the part" if has_own else "")
    frequency_unit = unit_of(data["frequency_hz" if frame == "own" else "fixed_frame_frequency_hz"])
    above.set(xlabel=key, ylabel=_label(f"frequency, {words}", frequency_unit), ylim=(0.0, 1.08 * top))
    below.set(xlabel=key, ylabel=_label("damping ratio", damping_unit))
    below.axhline(0.0, color=GREY, linewidth=0.8)
    figure.legend(*above.get_legend_handles_labels(), loc="outside lower center" if matplotlib.__version__ >= "3.7"
                  else "lower center", ncol=4, fontsize=8, bbox_to_anchor=(0.5, -0.14))
    _title(figure, result, "Campbell diagram" + (" (x: grows)" if (data["is_growing"] == 1.0).any() else ""))
    return figure


def multipliers(result):
    """The multipliers of samara floquet on the unit circle, one revolution."""
    data = result["floquet"]
    values = complex_of(data["multipliers"]).values
    resolved = data["resolved"].values == 1
    pyplot = _pyplot()
    figure, axes = pyplot.subplots(figsize=(5.6, 5.6))
    angle = numpy.linspace(0.0, 2.0 * numpy.pi, 361)
    axes.plot(numpy.cos(angle), numpy.sin(angle), color=GREY, linewidth=0.8)
    shown = values[resolved]
    both = numpy.concatenate([shown, shown.conj()])
    grows = numpy.concatenate([data["exponents"].values[resolved, 0] > data["error_growth"].values[resolved]] * 2)
    axes.plot(both[~grows].real, both[~grows].imag, "o", color=COLOURS[0], markersize=4, label="decays, or neither")
    if grows.any():
        axes.plot(both[grows].real, both[grows].imag, "x", color=GROWING, markersize=7, label="grows")
    axes.set(xlabel="Re mu", ylabel="Im mu", aspect="equal")
    axes.legend(loc="upper right")
    _title(figure, result, "multipliers of the resolved modes over a revolution")
    return figure


def _draw_distribution(axes, data, name, place, least):
    """Means of a quantity over the place along the beams as lines, the range over a revolution as bands.

    least: the least range of the axis.
    """
    means, low, high = (data[name + ending].values.reshape(-1, len(data[place]))
                        if name + ending in data else None for ending in ("", "_least", "_largest"))
    for number, mean in enumerate(means):
        style = _style(number)
        # Beams that are alike are wide lines under narrow ones.
        axes.plot(data[place].values, mean, marker=".", markersize=3, linewidth=max(1.0, 2.2 - 0.6 * number),
                  label=f"blade {number + 1}" if len(means) > 1 else None, **style)
        if low is not None:
            axes.fill_between(data[place].values, low[number], high[number], color=style["color"], alpha=0.15, linewidth=0)
    bottom, top = axes.get_ylim()
    if top - bottom < least:
        axes.set_ylim(0.5 * (bottom + top - least), 0.5 * (bottom + top + least))


def spanwise(result):
    """The steady state along the blades and the tower: deflections, internal loads, and the air.

    Of samara trim, and of floquet, modes and linearize. Lines are means, bands the range over a revolution.
    """
    if not any(group in result for group in ALONG_BEAMS):
        raise PlotError(f"{result.path}: no distribution along the blades; hint: samara trim writes one")
    load_level = float(result["trim"]["load_level"])
    loads = [f"{letter}{axis}" for letter in "FM" for axis in (1, 2, 3)]
    rows = []  # group, place, names
    for group, place in (("trim/blades", "radius"), ("trim/tower", "height"), ("trim/air", "radius")):
        if group not in result:
            continue
        data = result[group]
        names = [name for name in data if name != place and not name.endswith(("_least", "_largest"))]
        first = [name for name in names if name not in loads]
        order = ("out_of_plane", "in_plane", "fore_aft", "side_side")
        first.sort(key=lambda name: order.index(name) if name in order else len(order))
        names = first + [name for name in loads if name in data]
        rows += [(group, place, names[i : i + 3]) for i in range(0, len(names), 3)]
    figure, grid = _pyplot().subplots(len(rows), 3, figsize=(10, 2.0 * len(rows) + 0.4), squeeze=False)
    for panels, (group, place, names) in zip(grid, rows):
        data = result[group]
        extent = float(numpy.ptp(data[place].values))
        kind = "" if group == "trim/air" else group.split("/")[1].rstrip("s") + " "
        for axes, name in itertools.zip_longest(panels, names):
            if name is None:
                axes.axis("off")
                continue
            _draw_distribution(axes, data, name, place, LEAST_RANGE * (load_level if name in loads else extent))
            words = kind + IN_WORDS.get(name, name.replace("_", " "))
            axes.set_ylabel(_label(words, unit_of(data[name])), fontsize=7)
            axes.set_xlabel(_label(place, unit_of(data[place])), fontsize=7)
            axes.tick_params(labelsize=7)
    if grid[0][0].get_legend_handles_labels()[0]:
        grid[0][0].legend(loc="best", fontsize=7)
    _title(figure, result, "steady state along the " + " and the ".join(
        group.split("/")[1] for group in ALONG_BEAMS if group in result))
    return figure


def azimuth(result, unknowns=None):
    """Unknowns of the periodic steady state over the azimuth of blade 1, of samara trim or floquet.

    unknowns: their names as in /model/unknowns/name; by default tip and root of blade 1 and the tower top.
    """
    names = [str(name) for name in result["model/unknowns"]["name"].values]
    units = [str(unit) for unit in result["model/unknowns"]["unit"].values]
    usual = re.compile(r"blade 1 tip u\d|blade 1 root M\d|tower top u\d")
    chosen = list(unknowns or [name for name in names if usual.fullmatch(name)])
    for name in chosen:
        if name not in names:
            near = difflib.get_close_matches(name, names, 3, 0.5)
            raise PlotError(f"{result.path}: no unknown \"{name}\"" + (f"; near are {', '.join(near)}" if near else ""))
    if not chosen:
        raise PlotError(f"{result.path}: name the unknowns to draw, e.g. \"{names[0]}\"")
    harmonics = result["trim"]["harmonics"].values
    start = float(result["model"]["azimuth"])
    angle = numpy.linspace(0.0, 2.0 * numpy.pi, 361)
    angle_unit, degrees = _shown(result["model"]["azimuth"], TO_DEGREES)

    def draw_panel(axes, name):
        row = harmonics[names.index(name)]
        values = numpy.full_like(angle, row[0])
        for k in range(1, len(row) // 2 + 1):
            values += row[2 * k - 1] * numpy.cos(k * (angle - start)) + row[2 * k] * numpy.sin(k * (angle - start))
        axes.plot(degrees * angle, values, color=COLOURS[0], linewidth=1.2)
        axes.set_xticks([0, 90, 180, 270, 360])
        return _label(name, units[names.index(name)])

    return _panels(result, "steady state over a revolution", chosen, draw_panel, _label("azimuth of blade 1", angle_unit))


def series(result, channels=None):
    """Time series of samara transient, and their spectra."""
    data = result["transient"]
    names = [str(name) for name in data["channel_name"].values]
    chosen = list(channels or [name for name in names if not node_shapes.NODE_CHANNEL.fullmatch(name)][:6] or names[:6])
    for name in chosen:
        if name not in names:
            raise PlotError(f"{result.path}: no channel {name}; it has {', '.join(names)}")
    time = data["time"].values
    pyplot = _pyplot()
    figure, grid = pyplot.subplots(len(chosen), 2, figsize=(10, 1.7 * len(chosen) + 0.6), sharex="col", squeeze=False)
    step = numpy.median(numpy.diff(time)) if len(time) > 1 else 1.0
    even = numpy.arange(time[0], time[-1] + 0.5 * step, step)
    window = numpy.hanning(len(even))
    rate = _rate_of(unit_of(data["time"]))
    for (left, right), name in zip(grid, chosen):
        column = names.index(name)
        values = data["values"].values[:, column]
        left.plot(time, values, color=COLOURS[0], linewidth=0.8)
        unit = str(data["channel_unit"].values[column])
        left.set_ylabel(_label(name, unit), fontsize=8)
        own = numpy.interp(even, time, values)
        density = 2.0 * step * abs(numpy.fft.rfft((own - own.mean()) * window)) ** 2 / (window**2).sum()
        right.semilogy(numpy.fft.rfftfreq(len(even), step)[1:], density[1:], color=COLOURS[1], linewidth=0.8)
        right.set_ylabel(f"({unit})$^2$/{rate}", fontsize=8)
    grid[-1][0].set_xlabel(_label("time", unit_of(data["time"])))
    grid[-1][1].set_xlabel(_label("frequency", rate))
    _title(figure, result, "time series and power spectral densities (Hann window)")
    return figure


def operation(result):
    """Operating points of samara operate over the wind speed."""
    data = result["operation"]
    names = [name for name in data if data[name].dtype.kind == "f" and name != "imbalance"]

    def draw_panel(axes, name):
        axes.plot(data["wind_speed"].values, data[name].values, marker=".", linewidth=1.2, color=COLOURS[0])
        return _label(name.replace("_", " "), unit_of(data[name]))

    return _panels(result, "operating points", names, draw_panel, _label("wind speed", unit_of(data["wind_speed"])))


class _ModeUnits:
    """Units of the modes of a result in pictures, and the factors from those of the file."""

    def __init__(self, result):
        data = result.modes
        self.length, angle = (word.strip() for word in unit_of(data["node_motion"]).split(","))  # "m, rad"
        self.angle, self.degrees = TO_DEGREES.get(angle, (angle, 1.0))
        self.azimuth, self.azimuth_degrees = _shown(result["geometry"]["azimuth"], TO_DEGREES)
        self.frequency = unit_of(data["frequency_hz"])
        self.damping, self.per_cent = _shown(data["damping_ratio"], TO_PER_CENT)


class _View:
    """A turbine in space: its beams as ribbons along the second axes of their sections, its bodies as lines."""

    ELEVATION, AZIMUTH = numpy.radians(14.0), numpy.radians(-50.0)  # of the observer: downwind of the rotor, above

    def __init__(self, axes, turbine):
        self._axes = axes
        self._turbine = turbine
        up, aside = self.ELEVATION, self.AZIMUTH
        self._across = numpy.array([[-numpy.sin(aside), numpy.cos(aside), 0.0],
                                    [-numpy.sin(up) * numpy.cos(aside), -numpy.sin(up) * numpy.sin(aside),
                                     numpy.cos(up)]])
        self._toward = numpy.cross(*self._across)

    def draw(self, places, sides, colours, order):
        """sides: half the ribbons' widths [node, 3]; order: of drawing."""
        turbine = self._turbine
        is_beam = numpy.isfinite(turbine.station)
        faces = []
        for start, end in turbine.lines:
            if is_beam[start] and is_beam[end]:
                corners = numpy.array([places[start] - sides[start], places[start] + sides[start],
                                       places[end] + sides[end], places[end] - sides[end]])
                colour = colours[turbine.part_of[start]]
                faces.append((corners.mean(0) @ self._toward, corners @ self._across.T, colour))
            else:
                line = numpy.array([places[start], places[end]]) @ self._across.T
                self._axes.plot(*line.T, color=GREY, linewidth=1.5, zorder=order)
        for _, corners, colour in sorted(faces, key=lambda face: face[0]):
            self._axes.fill(*corners.T, facecolor=colour, edgecolor=colour, linewidth=0.4, zorder=order)

    def finish(self, text):
        self._axes.set_aspect("equal")
        self._axes.margins(0.04)
        self._axes.axis("off")
        self._axes.set_title(text, fontsize=8)


def _draw_view(axes, turbine, mode, colours, where, units):
    """The turbine in a mode over that without it, at the first instant."""
    view = _View(axes, turbine)
    places, sections = turbine.places[0], turbine.all_axes[0]
    half = 0.5 * numpy.maximum(turbine.width, 0.025 * turbine.size)[:, None]
    view.draw(places, half * sections[:, 1], dict.fromkeys(colours, "#CCCCCC"), 2)
    factor = mode.drawing_scale(DRAWN_SHARE)
    motion = factor * mode.motion()
    view.draw(places + motion[:, :3], half * node_shapes.turned(sections[:, 1], motion[:, 3:]), colours, 3)
    angles = [f"{name} {round(float(values[0].real), 2) + 0.0:.2f}" for name, values in _moving_joints(mode, units).items()]
    lines = [f"displacements x {factor:.3g}{where}", "grey: steady state"]
    if angles:
        lines += [_label("joints", units.angle) + ":", *(", ".join(angles[i : i + 2]) for i in range(0, min(len(angles), 8), 2))]
    view.finish("\n".join(lines))


def _limits(axes, scale):
    """Values that are small beside the scale look small."""
    low, high = axes.get_ylim()
    least = LEAST_DRAWN * scale
    if max(abs(low), abs(high)) < least:
        axes.set_ylim(-least, least)
    elif high - low < least:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * least, middle + 0.5 * least)


def _draw_span(panels, mode, name, style, scales, units):
    """Out of plane, in plane and torsion of a beam at the first instant; imaginary parts dashed."""
    nodes = mode.turbine.parts[name]
    stations = mode.turbine.station[nodes]
    length = numpy.linalg.norm(numpy.diff(mode.turbine.undeformed_places[0, nodes], axis=0), axis=-1).sum()
    values, slopes = mode.deflections(name)[0], mode.slopes(name)[0]
    for column, axes in enumerate(panels):
        own = values[:, column]
        if column < 2:
            at, line = node_shapes.curve(stations, own, slopes[:, column], length, max(3, 48 // len(stations)))
        else:
            own = own * units.degrees
            at, line = stations, own
        axes.plot(at, line.real, label=name, **style)
        axes.plot(stations, own.real, ".", color=style["color"], markersize=4)
        if abs(own.imag).max() > LEAST_DRAWN * scales[column]:
            axes.plot(at, line.imag, **{**style, "linestyle": "--", "linewidth": 0.7 * style["linewidth"]})


def mode_shape(result, mode=None, label=None):
    """A mode: deflections and torsion of blades and tower, the same over the azimuth, and the turbine in space.

    mode: its number in the table of the program, or `label`; by default the first one that oscillates. Its largest
    displacement is 1 m or its largest torsion 10 degrees, whichever is reached first. That one is real.
    """
    turbine = node_shapes.Turbine(result)
    chosen = node_shapes.find_mode(node_shapes.modes_of(result, turbine), result.path, mode, label).normalised()
    return _draw_mode(result, turbine, chosen)


def _draw_mode(result, turbine, mode):
    pyplot = _pyplot()
    units = _ModeUnits(result)
    has_tower = "tower" in turbine.beams
    kinds = (["blades"] if turbine.blades else []) + (["tower"] if has_tower else []) + (
        ["azimuth"] if turbine.turns else [])
    rows = len(kinds)
    figure = pyplot.figure(figsize=(11, max(3.2, 2.15 * rows + 0.5)))
    grid = figure.add_gridspec(rows, 4, width_ratios=[1, 1, 1, 1.15])
    scales = (1.0, 1.0, 10.0)  # m, m, deg
    # Blades that move alike are wide lines under narrow ones.
    styles = {name: {"color": COLOURS[i % 6], "linestyle": "-", "linewidth": max(1.0, 2.2 - 0.7 * i)}
              for i, name in enumerate(turbine.blades)}
    styles["tower"] = {"color": COLOURS[6], "linestyle": "-", "linewidth": 1.3}
    where = f" at azimuth {units.azimuth_degrees * turbine.azimuths[0]:.3g} {units.azimuth}" if turbine.turns else ""
    for row, kind in enumerate(kinds):
        panels = [figure.add_subplot(grid[row, column]) for column in range(3)]
        if kind == "blades":
            for name in turbine.blades:
                _draw_span(panels, mode, name, styles[name], scales, units)
            for axes, text, unit in zip(panels, ("blade out of plane", "blade in plane", "blade torsion"),
                                        (units.length, units.length, units.angle)):
                axes.set(xlabel="station of the blade, root 0, tip 1", ylabel=_label(text, unit))
            panels[0].legend(loc="best", fontsize=7)
        elif kind == "tower":
            _draw_span(panels, mode, "tower", styles["tower"], scales, units)
            for axes, text, unit in zip(panels, ("tower fore-aft", "tower side-side", "tower torsion"),
                                        (units.length, units.length, units.angle)):
                axes.set(xlabel="station of the tower, foot 0, top 1", ylabel=_label(text, unit))
        else:
            _draw_azimuth(panels, mode, styles, units)
        for axes, scale in zip(panels, scales):
            _limits(axes, scale)
            axes.tick_params(labelsize=7)
            axes.xaxis.label.set_size(7.5)
            axes.yaxis.label.set_size(8 if kind != "azimuth" else 7)
    _draw_view(figure.add_subplot(grid[:, 3]), turbine, mode, {name: style["color"] for name, style in styles.items()},
               where, units)
    speed = 2.0 * numpy.pi / turbine.period if turbine.period > 0.0 else 0.0
    rate = f" = {mode.exponent.imag / speed:.4g} per rev" if speed else ""
    _title(figure, result, f"mode {mode.number}, {mode.label}\n{mode.frequency_hz:.4g} {units.frequency}{rate}, damping ratio "
           f"{round(units.per_cent * mode.damping_ratio, 3) + 0.0:.3f} {units.damping}; solid: real part{where}, dashed: imaginary part")
    return figure


def _moving_joints(mode, units):
    """Their angles [instant] in the unit of the picture."""
    angles = {name: values * units.degrees for name, values in mode.joints().items()}
    return {name: values for name, values in angles.items() if abs(values).max() > LEAST_DRAWN}


def _draw_azimuth(panels, mode, styles, units):
    """Real parts over the azimuth, without the vibration itself: constant for a mode of one frequency."""
    turbine = mode.turbine
    angle = numpy.linspace(0.0, 360.0, 73)
    first = units.azimuth_degrees * turbine.azimuths[0]
    at_instants = 360.0 * turbine.phases

    def plot(axes, values, label=None, **style):
        wave = node_shapes.periodic(values, turbine.phases, angle / 360.0)
        axes.plot(angle + first, wave.real, label=label, **{"linewidth": 1.1, **style})
        axes.plot(at_instants + first, values.real, ".", markersize=3, color=style["color"])

    for name in turbine.blades:
        tip = mode.deflections(name)[:, -1]
        plot(panels[0], tip[:, 0], **styles[name])
        plot(panels[0], tip[:, 1], **{**styles[name], "linestyle": "--"})
    if "tower" in turbine.beams:
        top = mode.deflections("tower")[:, -1]
        plot(panels[1], top[:, 0], color=COLOURS[6], linestyle="-")
        plot(panels[1], top[:, 1], color=COLOURS[6], linestyle="--")
    for number, (name, values) in enumerate(_moving_joints(mode, units).items()):
        owner = next((blade for blade in turbine.blades if name.startswith(f"{blade} ")), None)
        style = styles[owner] if owner else {"color": COLOURS[(number + 3) % 6]}
        plot(panels[2], values, name.replace("blade ", ""), **{**style, "linestyle": STYLES[number % len(STYLES)]})
    for name in turbine.blades:
        values = mode.deflections(name)[:, -1, 2] * units.degrees
        if abs(values).max() > LEAST_DRAWN * 10.0:
            plot(panels[2], values, f"tip {name.split()[-1]} torsion", **{**styles[name], "linestyle": ":"})
    for axes, text in zip(panels, (_label("blade tips", units.length) + "\nsolid: out of plane, dashed: in plane",
                                   _label("tower top", units.length) + "\nsolid: fore-aft, dashed: side-side",
                                   _label("joints, torsion of tips", units.angle))):
        axes.set(xlabel=_label("azimuth of blade 1", units.azimuth), ylabel=text)
        axes.set_xticks(first + numpy.array([0, 90, 180, 270, 360]))
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.98), ncol=4, fontsize=6, columnspacing=1.0)


def _mode_data(result):
    """Resolved modes of the structure by label: frequency, damping and their estimated errors."""
    data = result.modes
    per_cent = _shown(data["damping_ratio"], TO_PER_CENT)[1]
    resolved = data["resolved"].values == 1
    if "node_motion" in data:  # not-a-number for modes of the air
        resolved &= numpy.isfinite(data["node_motion"].values[:, 0, -1, 0, 0])
    found = {}
    for i in numpy.flatnonzero(resolved & numpy.isfinite(data["error"].values)):
        size = float(numpy.hypot(*data["exponents"].values[i]))
        if data["frequency_hz"].values[i] <= 0.0 or size == 0.0:
            continue
        # A mode that is the only one of its kind has no number.
        name = re.sub(r" 1$", "", str(data["label"].values[i]))
        error = float(data["error"].values[i])
        found[name] = {"frequency": float(data["frequency_hz"].values[i]), "error": error,
                       "frequency error": error * size / (2.0 * numpy.pi),
                       "damping": per_cent * float(data["damping_ratio"].values[i]),
                       "damping error": per_cent * float(data["error_growth"].values[i]) / size,
                       "step": float(data["error_step"].values[i]), "mesh": float(data["error_mesh"].values[i]),
                       "round-off": float(data["error_round_off"].values[i])}
    if not found:
        raise PlotError(f"{result.path}: no resolved mode oscillates")
    return found


def _draw_errors(result):
    """Estimated errors of the modes of one result over their frequency."""
    modes = _mode_data(result)
    error_unit, per_cent = _shown(result.modes["error"], TO_PER_CENT)
    figure, axes = _pyplot().subplots(figsize=(7.5, 4.8))
    frequency = numpy.array([mode["frequency"] for mode in modes.values()])
    for number, (name, mark) in enumerate((("error", "o"), ("step", "v"), ("mesh", "s"), ("round-off", "x"))):
        values = per_cent * numpy.array([mode[name] for mode in modes.values()])
        axes.loglog(frequency[values > 0.0], values[values > 0.0], mark, color=COLOURS[number],
                    markersize=7 if name == "error" else 4, fillstyle="none" if name == "error" else "full",
                    label="sum" if name == "error" else name)
    axes.set(xlabel=_label("frequency", unit_of(result.modes["frequency_hz"])),
             ylabel=_label("estimated error of the exponent", error_unit))
    axes.legend(loc="best")
    _title(figure, result, "estimated errors of the resolved modes")
    return figure


def convergence(result, *others, first=8):
    """Frequency and damping of modes of the same label over the degrees of freedom of several results, with the errors
    that the program estimates; of one result the estimated errors over the frequency.

    first: number of modes, by their frequency in the finest result. If the degrees of freedom are equal, the axis has
    the steps of a revolution.
    """
    if not others:
        return _draw_errors(result)
    results = [result, *others]
    for key, text in (("degrees_of_freedom", "degrees of freedom"), ("steps", "steps of a revolution")):
        sizes = [int(each["model"].attrs.get(key, each.modes.attrs.get(key, 0))) for each in results]
        if len(set(sizes)) == len(sizes) and min(sizes) > 0:
            break
    else:
        raise PlotError(f"{result.path}: some results have equal degrees of freedom and steps; hint: change "
                        "blades.elements or floquet.steps between them")
    order = numpy.argsort(sizes)
    sizes = numpy.array(sizes)[order]
    tables = [_mode_data(results[i]) for i in order]
    finest = tables[-1]
    names = [name for name in finest if sum(name in table for table in tables) > 1][:first]
    if not names:
        raise PlotError(f"{result.path}: no resolved mode has the same label in two results")
    error_unit, per_cent = _shown(result.modes["error"], TO_PER_CENT)
    figure, panels = _pyplot().subplots(1, 3, figsize=(11, 4.6))
    for number, name in enumerate(names):
        style = _style(number)
        has = [i for i, table in enumerate(tables) if name in table]
        values = {key: numpy.array([tables[i][name][key] for i in has]) for key in finest[name]}
        panels[0].errorbar(sizes[has], values["frequency"], values["frequency error"], marker=".", capsize=2,
                           linewidth=1.2, label=name, **style)
        panels[1].errorbar(sizes[has], values["damping"], values["damping error"], marker=".", capsize=2, linewidth=1.2,
                           **style)
        estimated = per_cent * values["error"]
        panels[2].plot(sizes[has], numpy.where(estimated > 0.0, estimated, numpy.nan), marker=".", linewidth=1.2,
                       color=style["color"])
        if has[-1] == len(tables) - 1 and len(has) > 1:
            real = per_cent * abs(values["frequency"][:-1] / values["frequency"][-1] - 1.0)
            panels[2].plot(sizes[has[:-1]], numpy.where(real > 0.0, real, numpy.nan), marker="x", linewidth=0.9,
                           linestyle="--", color=style["color"])
    panels[0].set(ylabel=_label("frequency", unit_of(result.modes["frequency_hz"])))
    panels[1].set(ylabel=_label("damping ratio", _shown(result.modes["damping_ratio"], TO_PER_CENT)[0]))
    panels[2].set(ylabel=_label("error", error_unit), yscale="log")
    panels[2].set_title("dots: estimated; crosses: difference of the frequency from the finest", fontsize=8)
    for axes in panels:
        axes.set_xlabel(text)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="lower center", ncol=4, fontsize=8,
                  bbox_to_anchor=(0.5, -0.13))
    _title(figure, result, "convergence; bars: estimated errors")
    return figure


KINDS = {"campbell": (campbell, "campbell"), "multipliers": (multipliers, "floquet"),
         "operation": (operation, "operation"), "spanwise": (spanwise, *ALONG_BEAMS),
         "azimuth": (azimuth, "trim"), "series": (series, "transient")}
ON_REQUEST = {"shapes": mode_shape, "convergence": convergence}  # drawn only where they are named


def kinds_of(result):
    """The kinds of pictures that a result allows, without those on request."""
    found = []
    for kind, (_, *groups) in KINDS.items():
        try:
            # A constant steady state has nothing to show over the azimuth.
            is_constant = kind == "azimuth" and "trim" in result and result["trim"]["harmonics"].shape[1] == 1
            if any(group in result and result[group] for group in groups) and not is_constant:
                found.append(kind)
        except (KeyError, OSError):
            continue
    return found


def draw(result, path, kind=None, others=(), **options):
    """Writes a picture of a result, by default the first kind that it allows, in the format of the path's ending.

    others: further results, of kind "convergence".
    """
    result = open_result(result) if isinstance(result, (str, pathlib.Path)) else result
    path = pathlib.Path(path)
    if path.suffix not in ENDINGS:
        raise PlotError(f"{path}: expected a name that ends in {', '.join(ENDINGS)}")
    if kind in ON_REQUEST:
        if not any(group in result for group in ("floquet", "modes")):
            raise PlotError(f"{result.path}: no modes; hint: samara floquet and samara modes write them")
        function = ON_REQUEST[kind]
    else:
        allowed = kinds_of(result)
        if not allowed:
            raise PlotError(f"{result.path}: nothing to draw; it has {', '.join(result.groups) or 'no groups'}")
        kind = kind or allowed[0]
        if kind not in allowed:
            raise PlotError(f"{result.path}: no picture {kind}; it allows {', '.join(allowed)}")
        function = KINDS[kind][0]
    figure = function(result, *others, **options)
    figure.savefig(path, dpi=150, bbox_inches="tight",
                   metadata={"Date": None} if path.suffix == ".svg" else None)
    _pyplot().close(figure)
    return path


def _numbers(text):
    try:
        return [int(word) for word in text.split(",")]
    except ValueError as error:
        raise PlotError(f"--modes {text}: expected numbers of modes, separated by commas, e.g. 1,2,5") from error


def _split(words):
    """Names of results and kinds among the arguments."""
    kinds = [word for word in words if word in KINDS or word in ON_REQUEST]
    results = [word for word in words if word not in kinds]
    wrong = next((word for word in results[1:] if not word.endswith(".h5") and not pathlib.Path(word).exists()), None)
    if wrong:
        raise PlotError(f"no picture {wrong}; they are {', '.join([*KINDS, *ON_REQUEST])}")
    if not results:
        raise PlotError("no result is named; hint: samara plot RESULT.h5")
    if len(results) > 1 and kinds != ["convergence"]:
        raise PlotError("several results are drawn by convergence only; hint: samara plot A.h5 B.h5 convergence")
    return results, kinds


def main(arguments=None):
    """The command line; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="samara plot", description="Draws pictures of a result, each kind that it allows, or those named.",
        epilog="examples: samara plot c.h5 campbell -o campbell.svg; samara plot f.h5 shapes --modes 5,7; "
        "samara plot coarse.h5 fine.h5 convergence")
    parser.add_argument("words", nargs="+", metavar="RESULT.h5 [KIND]",
                        help=f"kinds: {', '.join(KINDS)}; only where named: {', '.join(ON_REQUEST)}; convergence takes "
                        "several results")
    parser.add_argument("-o", dest="output", metavar="FILE",
                        help="name of the picture, .svg, .png or .pdf; several kinds and modes have their names in it. "
                        "Without it RESULT_KIND.svg in the current folder")
    parser.add_argument("--channels", help="of a time series, separated by commas")
    parser.add_argument("--unknowns", help="of a steady state over the azimuth, separated by commas")
    parser.add_argument("--modes", help="numbers of the modes of shapes, separated by commas; without it the first "
                        f"{FIRST_MODES} that oscillate")
    parser.add_argument("--frame", choices=("fixed", "own"), help="of the frequencies in a Campbell diagram")
    parser.add_argument("--first", type=int, metavar="N", help="number of modes in a Campbell diagram and of convergence")
    given = parser.parse_args(arguments)
    matplotlib.use("Agg")
    first = {"first": given.first} if given.first else {}
    options = {"series": {"channels": given.channels.split(",")} if given.channels else {},
               "azimuth": {"unknowns": given.unknowns.split(",")} if given.unknowns else {},
               "campbell": {**({"frame": given.frame} if given.frame else {}), **first}, "convergence": first}
    try:
        names, kinds = _split(given.words)
        result, *others = (open_result(name) for name in names)
        for kind in kinds or kinds_of(result):
            name = pathlib.Path(given.output or f"{result.path.stem}_{kind}.svg")
            if given.output and len(kinds or kinds_of(result)) > 1:
                name = name.with_name(f"{name.stem}_{kind}{name.suffix}")
            if kind == "shapes":
                modes = _numbers(given.modes) if given.modes else _first_modes(result)
                for mode in modes:
                    own = name if len(modes) == 1 and given.output else name.with_name(
                        f"{name.stem}_{mode}{name.suffix}")
                    print(f"picture: {draw(result, own, kind, mode=mode)}")
            else:
                print(f"picture: {draw(result, name, kind, others, **options.get(kind, {}))}")
        if not kinds and not kinds_of(result):
            draw(result, given.output or "picture.svg")  # says what is missing
    except (PlotError, OSError, ValueError) as error:
        print(f"samara: {error}", file=sys.stderr)
        return 2
    return 0


def _first_modes(result):
    modes = node_shapes.modes_of(result)
    chosen = [number for number, mode in modes.items() if mode.oscillates][:FIRST_MODES]
    if not chosen:
        node_shapes.find_mode(modes, result.path)
    return chosen or list(modes)[:FIRST_MODES]


if __name__ == "__main__":
    sys.exit(main())
