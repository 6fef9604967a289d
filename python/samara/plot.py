"""Pictures of results: Campbell diagrams, multipliers, steady states, loads along the blades, time series.

    samara plot RESULT.h5 [KIND ...] [-o NAME.svg|NAME.png|NAME.pdf]

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

from .result import complex_of, open_result, unit_of

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"]
STYLES = ["-", "--", "-.", ":"]
GREY = "#888888"
GROWING = "#D00000"
LEAST_SHARE = 0.05  # of a harmonic that a diagram shows
ORDERS = (1, 2, 3, 4, 5, 6, 9, 12)  # multiples of the rotor speed in a diagram
ENDINGS = (".png", ".svg", ".pdf")


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


def campbell(result, frame="fixed", first=14):
    """The Campbell diagram and the damping of a result of samara campbell.

    frame: "fixed", or "own", that of the part that moves. A line whose modes have no single frequency in the fixed frame
    is drawn in its own. In the own frame further harmonics with more than 5 % of the kinetic energy are drawn as thin
    lines, as wide as their share: a part that turns and one that does not have no common harmonics in the fixed frame.
    first: number of modes, by their frequency.
    """
    data = result["campbell"].sortby("value")
    if "mode" not in data:
        raise PlotError(f"{result.path}: no point has modes")
    pyplot = _pyplot()
    figure, (above, below) = pyplot.subplots(1, 2, figsize=(10.5, 5.2))
    values = data["value"].values
    with_points = numpy.isfinite(data["frequency_hz"]).sum("value").values > (1 if len(values) > 1 else 0)
    lines = numpy.flatnonzero(with_points)[:first]
    turns = data["rotor_speed"].values / (2 * numpy.pi)
    own = data["frequency_hz"].values
    ground = data["fixed_frame_frequency_hz"].values
    harmonics = data["harmonic"].values
    top = 0.0
    for number, line in enumerate(lines):
        name = str(data["mode"].values[line])
        style = _style(number)
        is_fixed = frame == "fixed" and 2 * numpy.isfinite(ground[line]).sum() >= numpy.isfinite(own[line]).sum()
        frequency = ground[line] if is_fixed else own[line]
        top = max(top, numpy.nanmax(frequency))
        shares = data["participation"].values[line]
        for column, k in enumerate(harmonics):
            share = shares[:, column]
            if frame == "fixed" or k == 0 or numpy.nanmax(share, initial=0.0) < LEAST_SHARE:
                continue
            branch = numpy.where(share >= LEAST_SHARE, abs(frequency + k * turns), numpy.nan)
            above.plot(values, branch, color=style["color"], linewidth=0.3 + 1.5 * numpy.nanmax(share), alpha=0.35)
        above.plot(values, frequency, label=name, linewidth=1.6, marker=".", markersize=3, **style)
        damping = 100.0 * data["damping_ratio"].values[line]
        below.plot(values, damping, linewidth=1.4, marker=".", markersize=3, **style)
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
    above.set(xlabel=key, ylabel=f"frequency, {'fixed frame' if frame == 'fixed' else 'frame of the part'} [Hz]",
              ylim=(0.0, 1.08 * top))
    below.set(xlabel=key, ylabel="damping ratio [%]")
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


def spanwise(result):
    """The steady air along the blades, of samara trim."""
    data = result["trim/air"] if "trim" in result else None
    if data is None or not data:
        raise PlotError(f"{result.path}: no distribution along the blades; samara trim of a case with air writes one")
    place = next((name for name in data if data[name].ndim == 1 and "radius" in name), None)
    names = [name for name in data if data[name].ndim >= 1 and name != place and data[name].dtype.kind == "f"]

    def draw_panel(axes, name):
        values = data[name].values
        at = data[place].values if place else numpy.arange(values.shape[-1])
        for number, own in enumerate(values.reshape(-1, values.shape[-1])):
            axes.plot(at, own, linewidth=1.2, **_style(number))
        return _label(name.replace("_", " "), unit_of(data[name]))

    return _panels(result, "steady air along the blades", names, draw_panel,
                   _label(place.replace("_", " "), unit_of(data[place])) if place else "station")


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

    def draw_panel(axes, name):
        row = harmonics[names.index(name)]
        values = numpy.full_like(angle, row[0])
        for k in range(1, len(row) // 2 + 1):
            values += row[2 * k - 1] * numpy.cos(k * (angle - start)) + row[2 * k] * numpy.sin(k * (angle - start))
        axes.plot(numpy.degrees(angle), values, color=COLOURS[0], linewidth=1.2)
        axes.set_xticks([0, 90, 180, 270, 360])
        return _label(name, units[names.index(name)])

    return _panels(result, "steady state over a revolution", chosen, draw_panel, "azimuth of blade 1 [deg]")


def series(result, channels=None):
    """Time series of samara transient, and their spectra."""
    data = result["transient"]
    names = [str(name) for name in data["channel_name"].values]
    chosen = list(channels or names[:6])
    for name in chosen:
        if name not in names:
            raise PlotError(f"{result.path}: no channel {name}; it has {', '.join(names)}")
    time = data["time"].values
    pyplot = _pyplot()
    figure, grid = pyplot.subplots(len(chosen), 2, figsize=(10, 1.7 * len(chosen) + 0.6), sharex="col", squeeze=False)
    step = numpy.median(numpy.diff(time)) if len(time) > 1 else 1.0
    even = numpy.arange(time[0], time[-1] + 0.5 * step, step)
    window = numpy.hanning(len(even))
    for (left, right), name in zip(grid, chosen):
        column = names.index(name)
        values = data["values"].values[:, column]
        left.plot(time, values, color=COLOURS[0], linewidth=0.8)
        unit = str(data["channel_unit"].values[column])
        left.set_ylabel(_label(name, unit), fontsize=8)
        own = numpy.interp(even, time, values)
        density = 2.0 * step * abs(numpy.fft.rfft((own - own.mean()) * window)) ** 2 / (window**2).sum()
        right.semilogy(numpy.fft.rfftfreq(len(even), step)[1:], density[1:], color=COLOURS[1], linewidth=0.8)
        right.set_ylabel(f"({unit})$^2$/Hz", fontsize=8)
    grid[-1][0].set_xlabel(_label("time", unit_of(data["time"])))
    grid[-1][1].set_xlabel("frequency [Hz]")
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


KINDS = {"campbell": (campbell, "campbell"), "multipliers": (multipliers, "floquet"),
         "operation": (operation, "operation"), "spanwise": (spanwise, "trim/air"),
         "azimuth": (azimuth, "trim"), "series": (series, "transient")}


def kinds_of(result):
    """The kinds of pictures that a result allows."""
    found = []
    for kind, (_, group) in KINDS.items():
        try:
            # A constant steady state has nothing to show over the azimuth.
            is_constant = kind == "azimuth" and group in result and result[group]["harmonics"].shape[1] == 1
            if group in result and result[group] and not is_constant:
                found.append(kind)
        except (KeyError, OSError):
            continue
    return found


def draw(result, path, kind=None, **options):
    """Writes a picture of a result, by default the first kind that it allows, in the format of the path's ending."""
    result = open_result(result) if isinstance(result, (str, pathlib.Path)) else result
    path = pathlib.Path(path)
    if path.suffix not in ENDINGS:
        raise PlotError(f"{path}: expected a name that ends in {', '.join(ENDINGS)}")
    allowed = kinds_of(result)
    if not allowed:
        raise PlotError(f"{result.path}: nothing to draw; it has {', '.join(result.groups) or 'no groups'}")
    kind = kind or allowed[0]
    if kind not in allowed:
        raise PlotError(f"{result.path}: no picture {kind}; it allows {', '.join(allowed)}")
    figure = KINDS[kind][0](result, **options)
    figure.savefig(path, dpi=150, bbox_inches="tight",
                   metadata={"Date": None} if path.suffix == ".svg" else None)
    _pyplot().close(figure)
    return path


def main(arguments=None):
    """The command line; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="samara plot", description="Draws pictures of a result, each kind that it allows, or those named.",
        epilog="example: samara plot c.h5 campbell -o campbell.svg")
    parser.add_argument("result", metavar="RESULT.h5")
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("-o", dest="output", metavar="FILE",
                        help="name of the picture, .svg, .png or .pdf; several kinds have their names in it. Without "
                        "it RESULT_KIND.svg in the current folder")
    parser.add_argument("--channels", help="of a time series, separated by commas")
    parser.add_argument("--unknowns", help="of a steady state over the azimuth, separated by commas")
    parser.add_argument("--frame", choices=("fixed", "own"), help="of the frequencies in a Campbell diagram")
    parser.add_argument("--first", type=int, metavar="N", help="number of modes in a Campbell diagram")
    given = parser.parse_args(arguments)
    matplotlib.use("Agg")
    options = {"series": {"channels": given.channels.split(",")} if given.channels else {},
               "azimuth": {"unknowns": given.unknowns.split(",")} if given.unknowns else {},
               "campbell": {key: value for key, value in (("frame", given.frame), ("first", given.first)) if value}}
    try:
        result = open_result(given.result)
        kinds = given.kinds or kinds_of(result)
        for kind in kinds:
            if kind not in KINDS:
                raise PlotError(f"no picture {kind}; they are {', '.join(KINDS)}")
        if not kinds:
            draw(result, given.output or "picture.svg")  # says what is missing
        for kind in kinds:
            name = pathlib.Path(given.output or f"{result.path.stem}_{kind}.svg")
            if given.output and len(kinds) > 1:
                name = name.with_name(f"{name.stem}_{kind}{name.suffix}")
            print(f"picture: {draw(result, name, kind, **options.get(kind, {}))}")
    except (PlotError, OSError, ValueError) as error:
        print(f"samara: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
