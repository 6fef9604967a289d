"""One page of results: model, modes, Campbell diagram, moving turbine, time series.

    samara report RESULT.h5 [RESULT.h5 ...] -o report.html

The page needs no network and no other file. Its program is page/report.js, made by scripts/report_page from the
sources in report/; this module adds the data of the results. docs/report.md describes the page and the data.
"""

import argparse
import base64
import html
import json
import os
import pathlib
import sys

import h5py
import numpy

from .result import complex_of, open_result, unit_of
from .shapes import LARGEST_GAP, NODE_CHANNEL, Transient, Turbine

PAGE = pathlib.Path(__file__).parent / "page"
MOST_MEGABYTES = 5.0
# Left for the tables, the text of the case and the frame of the page.
SPARE_BYTES = 300_000
LEAST_HARMONICS = (1e-5, 1e-4, 1e-3, 3e-3)  # relative to the largest one of a mode; the first that fits
SERIES_BYTES = 1_200_000  # of the time series in a page, as base64
FRAME_BYTES = 1_200_000  # of the places and rotations in time series, the same
MOST_FRAMES = 4000  # of one time series

MARK = "<!-- written by samara report -->"

# As in analysis/mode.hpp, simulation/stability.hpp and drivers/mode_report.cpp.
ZERO_EXPONENT = 1e-6  # relative to the rotor speed, or 1 rad/s
REAL_EXPONENT = 1e-6
SEVERAL = 10.0  # errors of the step within which a real exponent may be zero, as in analysis/mode_error.cpp
MARKED_ERROR = 0.01
LARGEST_ERROR = 0.1
VISIBLE_SHARE = 0.05
MOST_HARMONICS = 2


class ReportError(ValueError):
    """A result without anything that a page can show."""


def pack(values, kind="<f4"):
    """An array as base64 of its little-endian numbers."""
    values = numpy.ascontiguousarray(values, dtype=kind)
    return {"type": kind[1:], "shape": list(values.shape), "base64": base64.b64encode(values.tobytes()).decode()}


def _texts(array):
    return [str(text) for text in numpy.atleast_1d(array.values)]


def _number(value):
    """A number for JSON, None where it is not finite."""
    return float(value) if numpy.isfinite(value) else None


def model_of(result):
    """Rotor, size and masses of /model."""
    if "model" not in result:
        return None
    data = result["model"]
    found = {"rotor_speed": _number(data["rotor_speed"]) if "rotor_speed" in data else None, "masses": [],
             **{name: int(data.attrs[name]) if name in data.attrs else None
                for name in ("degrees_of_freedom", "unknowns", "blades")}}
    with h5py.File(result.path) as file:
        group = file["model"]
        if "mass" in group:
            found["masses"] = [{"part": name.replace("_", " "), "mass": float(group["mass"][name][()])}
                               for name in group["mass"] if group["mass"][name].shape == ()]
        if "inertia/rotor_about_shaft" in group:
            found["rotor_inertia"] = float(group["inertia/rotor_about_shaft"][()])
    return found


def classify(exponents, error, error_of_step, error_growth, rotor_speed):
    """Motions of modes and whether their errors are too large, as simulation/stability.cpp has them.

    error_of_step: that of step and round-off, which may hide a real exponent near zero; the mesh does not. The pairs of
    growth and decay of a conservative system are left out: the file does not state whether it is one.
    """
    zero = ZERO_EXPONENT * (rotor_speed if rotor_speed > 0.0 else 1.0)
    modulus, growth = abs(exponents), exponents.real
    hidden = (exponents.imag == 0.0) & (modulus < error_growth) & (SEVERAL * error_of_step > 1.0)
    rigid = (modulus < zero) | hidden
    undamped = ~rigid & (abs(growth) <= error_growth)
    motions = numpy.where(rigid, "rigid-body",
                          numpy.where(undamped, "undamped", numpy.where(growth > 0.0, "growing", "decaying")))
    rough = (error > LARGEST_ERROR) | (error_growth > numpy.maximum(MARKED_ERROR * modulus, abs(growth)))
    return motions, rough


def other_harmonics(shares, harmonics, own, most):
    """The harmonics except the identified one, the largest first, as the program prints them."""
    entries = [(-int(numpy.floor(100.0 * share + 0.5)), abs(int(k) - own), int(k) - own)
               for share, k in zip(shares, harmonics) if int(k) != own and share > VISIBLE_SHARE]
    return " ".join(f"k{offset:+d}:{-percent}%" for percent, _, offset in sorted(entries)[:most])


def modes_of(result):
    """The table of modes of /floquet or /modes."""
    data = result.modes
    group = "floquet" if "floquet" in result else "modes"
    rotor_speed = float(data.attrs["rotor_speed"])
    exponents = complex_of(data["exponents"]).values
    error, error_growth = data["error"].values, data["error_growth"].values
    motions, rough = classify(exponents, error, data["error_step"].values + data["error_round_off"].values,
                              error_growth, rotor_speed)
    resolved = data["resolved"].values == 1
    harmonic = data["harmonic"].values if "harmonic" in data else None
    remarks = []
    for m, motion in enumerate(motions):
        marked = error[m] > MARKED_ERROR
        others = ""
        if "participation" in data:
            others = other_harmonics(data["participation"].values[m], data["participation_harmonic"].values,
                                     int(harmonic[m]), 1 if marked else MOST_HARMONICS)
        if not resolved[m]:
            remarks.append("unresolved")
        elif motion == "rigid-body":
            remarks.append("rigid-body")
        elif marked:
            size = "error > 100 %" if error[m] >= 1.0 else f"error {100.0 * error[m]:.2g} %"
            remarks.append("; ".join(filter(None, [size, others])))
        else:
            remarks.append(others)
    labels = _texts(data["label"])
    air = numpy.zeros(len(labels), bool)
    if "node_motion" in data:  # not-a-number for a mode of the air and one that is not resolved
        air = resolved & numpy.isnan(data["node_motion"].values[:, 0, 0, 0, 0])
    attributes = data.attrs
    found = {"group": group, "rotor_speed": rotor_speed, "label": labels,
             "frequency_hz": pack(data["frequency_hz"].values, "<f8"),
             "real": (exponents.imag < REAL_EXPONENT * abs(exponents)).astype(int).tolist(),
             "omega": pack(exponents.imag, "<f8"), "growth": pack(exponents.real, "<f8"),
             "damping_ratio": pack(data["damping_ratio"].values, "<f8"),
             "error": pack(error, "<f8"), "error_growth": pack(error_growth, "<f8"),
             "motion": motions.tolist(), "rough": rough.astype(int).tolist(),
             "resolved": resolved.astype(int).tolist(), "air": air.astype(int).tolist(), "remark": remarks,
             "part": _texts(data["part"]), "part_share": pack(data["part_share"].values, "<f8"),
             "reach_hz": _number(attributes["reach_hz"]) if "reach_hz" in attributes else None,
             "states_deflated": int(attributes.get("states_deflated", 0)),
             "deflated_rate": _number(attributes.get("deflated_rate", numpy.inf)),
             "searched": {key: _number(attributes[key]) for key in attributes if key.startswith("searched_")}}
    if "fixed_frame_frequency_hz" in data:
        found["fixed_frame_frequency_hz"] = pack(data["fixed_frame_frequency_hz"].values, "<f8")
    if harmonic is not None:
        found["harmonic"] = harmonic.astype(int).tolist()
    return found


def real_series(samples):
    """Mean and the cosines and sines of a periodic real array over its first axis: mean, cos 1, sin 1, ..."""
    count = len(samples)
    spectrum = numpy.fft.rfft(samples, axis=0) / count
    rows = [spectrum[0].real]
    for k in range(1, len(spectrum)):
        factor = 1.0 if 2 * k == count else 2.0
        rows += [factor * spectrum[k].real, -factor * spectrum[k].imag]
    return numpy.array(rows)


def _shortened(series, least):
    """Without the last harmonics, where they are all below a limit."""
    last = len(series)
    while last > 1 and abs(series[last - 2:last]).max() < least:
        last -= 2
    return series[:last]


def _is_a_revolution(time, rotor_speed):
    """Whether equal steps from t = 0 divide one revolution."""
    count = len(time)
    if count < 3 or rotor_speed <= 0.0:
        return False
    period = 2.0 * numpy.pi / rotor_speed
    return bool(numpy.allclose(time, numpy.arange(count) * period / count, atol=1e-6 * period))


def geometry_of(result):
    """Nodes, lines and their places over a revolution or over the states of a load path."""
    data = result["geometry"]
    rotor_speed = float(result["model"]["rotor_speed"])
    place = data["place"].values
    size = max(float(numpy.ptp(place.reshape(-1, 3), axis=0).max()), float(data["width"].values.max())) or 1.0
    found = {"part": _texts(data["part"]), "station": pack(data["station"].values),
             "width": pack(data["width"].values), "thickness": pack(data["thickness"].values),
             "lines": data["lines"].values.astype(int).tolist(), "size": size,
             "azimuth": [float(value) for value in data["azimuth"].values],
             "time": [float(value) for value in data["time"].values], "rotor_speed": rotor_speed}
    names = ("place", "undeformed", "axes")
    arrays = [data[name].values.reshape(*data[name].shape[:2], -1) for name in names]
    if "static" in result:
        found.update(kind="path", factor=[float(value) for value in result["static"]["factor"].values])
    elif _is_a_revolution(data["time"].values, rotor_speed):
        found["kind"] = "periodic"
        arrays = [_shortened(real_series(array), 1e-7 * (1.0 if name == "axes" else size))
                  for name, array in zip(names, arrays)]
    else:
        found["kind"] = "fixed"
        arrays = [array[:1] for array in arrays]
    found.update({name: pack(array) for name, array in zip(names, arrays)})
    return found


def shape_series(samples, harmonic):
    """Numbers of harmonics, counted from the identified one, and the coefficients of a mode's motion over a revolution.

    The samples repeat with the rotor. Between them the motion is a series of the harmonics next to the identified one:
    the same samples also fit other harmonics, which differ by multiples of the number of samples.
    """
    count = len(samples)
    if count == 1:
        return numpy.array([0]), samples
    turns = numpy.arange(count) / count
    centred = samples * numpy.exp(-2j * numpy.pi * harmonic * turns)[:, None, None]
    return numpy.fft.fftfreq(count, 1.0 / count).round().astype(int), numpy.fft.fft(centred, axis=0) / count


def motions_of(result, room):
    """Motions of the nodes in the modes within a number of bytes of base64, modes of low frequency first."""
    data = result.modes
    if "node_motion" not in data or "geometry" not in result:
        return None
    harmonic = data["harmonic"].values if "harmonic" in data else numpy.zeros(data["exponents"].shape[0], int)
    values = data["node_motion"].values
    modes = [m for m in range(len(values)) if numpy.isfinite(values[m]).all()]
    modes.sort(key=lambda m: float(data["frequency_hz"].values[m]))
    for least in LEAST_HARMONICS:
        series, used, complete = {}, 0, True
        for m in modes:
            offsets, rows = shape_series(values[m, ..., 0] + 1j * values[m, ..., 1], int(harmonic[m]))
            sizes = abs(rows).max(axis=(1, 2))
            kept = [i for i in numpy.argsort(offsets, kind="stable") if sizes[i] > least * sizes.max()]
            rows = numpy.stack([rows[kept].real, rows[kept].imag], axis=-1)
            used += 4 * (4 * rows.size // 3 + 1) + 100
            if used > room:
                complete = False
                break
            series[m] = {"offset": offsets[kept].tolist(), "values": pack(rows)}
        if complete:
            break
    return {"least_harmonic": least, "left_out": len(modes) - len(series),
            "series": {str(m): entry for m, entry in series.items()}}


def campbell_of(result):
    """Lines of a Campbell diagram in the order of the swept value."""
    if "second_value" in result["campbell"]:
        raise ReportError(f"{result.path}: is a map over two keys; hint: samara plot draws it")
    data = result["campbell"].sortby("value")
    found = {"key": str(data.attrs.get("key", "value")), "status": str(data.attrs.get("status", "")),
             "unit": unit_of(data["value"]), "value": pack(data["value"].values, "<f8"),
             "rotor_speed": pack(data["rotor_speed"].values, "<f8"), "stability": _texts(data["stability"]),
             "mode": _texts(data["mode"]) if "mode" in data else []}
    if found["mode"]:
        for name in ("frequency_hz", "fixed_frame_frequency_hz", "damping_ratio", "growth_rate", "is_growing"):
            found[name] = pack(data[name].values, "<f8")
        found["harmonic"] = [int(k) for k in data["harmonic"].values]
        found["participation"] = pack(data["participation"].values)
    return found


def thinned(time, values, most):
    """At most so many rows: of equal groups of rows the least and the largest value of each channel, in their order."""
    if len(time) <= most:
        return time, values
    groups = max(1, most // 2)
    edges = numpy.linspace(0, len(time), groups + 1).astype(int)
    times, rows = [], []
    for begin, end in zip(edges[:-1], edges[1:]):
        part = values[begin:end]
        least, largest = numpy.argmin(part, axis=0), numpy.argmax(part, axis=0)
        columns = numpy.arange(part.shape[1])
        rows += [part[numpy.minimum(least, largest), columns], part[numpy.maximum(least, largest), columns]]
        times += [time[begin], time[(begin + end) // 2]]
    return numpy.array(times), numpy.array(rows)


def transient_of(result, share=1):
    """Channels of a time series, without those of nodes. share: number of time series in the page."""
    data = result["transient"]
    time, values = data["time"].values, data["values"].values
    names, units, descriptions = (_texts(data[f"channel_{key}"]) for key in ("name", "unit", "description"))
    own = [column for column, name in enumerate(names) if not NODE_CHANNEL.fullmatch(name)]
    nodes = [column for column, name in enumerate(names) if NODE_CHANNEL.fullmatch(name)]
    order = own + nodes
    values = values[:, order]
    most = max(16, SERIES_BYTES * 3 // (4 * 4 * max(1, len(own)) * share))
    short_time, short_values = thinned(time, values[:, :len(own)], most)
    return {"name": [names[c] for c in order], "unit": [units[c] for c in order],
            "description": [descriptions[c] for c in order], "own": len(own), "rows": len(time),
            "is_thinned": len(short_time) < len(time), "status": str(data.attrs.get("status", "")),
            "time": pack(short_time, "<f8"), "values": pack(short_values.T),
            "least": pack(values.min(axis=0)), "mean": pack(values.mean(axis=0)),
            "largest": pack(values.max(axis=0))}


def frames_of(result, share=1):
    """Nodes and lines, and places and rotation vectors at rows of a time series. share: as in transient_of.

    is_even: values between the frames are possible, since the rotor turns little from one to the next.
    """
    turbine = Turbine(result)
    transient = Transient(result, turbine)
    data = result["geometry"]
    count = len(turbine.part_of)
    most = min(MOST_FRAMES, max(2, FRAME_BYTES * 3 // (4 * 4 * 6 * count * share)))
    rows = numpy.arange(0, len(transient.times), -(-len(transient.times) // most))
    places = transient.places[rows]
    gap = max(transient.turns_between(numpy.arange(len(transient.times))).max(initial=0.0),
              transient.turns_between(rows).max(initial=0.0))
    hub = int(turbine.parts["hub"][-1]) if "hub" in turbine.parts else 0
    return {"kind": "transient", "part": turbine.part_of, "station": pack(turbine.station), "width": pack(turbine.width),
            "thickness": pack(turbine.thickness), "lines": turbine.lines.tolist(), "hub": hub,
            "on_rotor": transient.on_rotor.astype(int).tolist(),
            "size": max(turbine.size, float(data["width"].values.max())) or 1.0,
            "azimuth": [float(value) for value in turbine.azimuths], "rotor_speed": float(result["model"]["rotor_speed"]),
            "is_even": bool(gap <= LARGEST_GAP), "rows": len(transient.times), "time": pack(transient.times[rows], "<f8"),
            "place": pack(places.reshape(len(rows), -1)), "rotation": pack(transient.rotations[rows].reshape(len(rows), -1))}


def _has_places(result):
    return any(NODE_CHANNEL.fullmatch(str(name)) for name in result["transient"]["channel_name"].values)


def trim_of(result):
    """How the periodic steady state was found and how well it is closed."""
    data = result["trim"]
    found = {key: (value.item() if hasattr(value, "item") else value) for key, value in data.attrs.items()
             if key in ("method", "harmonics", "newton_steps", "convergence")}
    if "imbalance" in data:
        found["imbalance"] = _number(data["imbalance"])
    return found


def section_of(result, share=1):
    """What a page shows of one result, without the motions of its modes. share: number of time series in the page."""
    attributes = result.attributes
    found = {"file": result.path.name, "title": result.title, "case": result.case,
             **{key: str(attributes.get(key, "")) for key in ("program", "command_line", "case_path", "time",
                                                              "libraries")}}
    found["model"] = model_of(result)
    if "floquet" in result or "modes" in result:
        found["modes"] = modes_of(result)
    if "geometry" in result and "place" in result["geometry"]:
        is_run = "transient" in result and _has_places(result)
        found["geometry"] = frames_of(result, share) if is_run else geometry_of(result)
    if "campbell" in result:
        found["campbell"] = campbell_of(result)
    if "transient" in result:
        found["transient"] = transient_of(result, share)
    if "trim" in result:
        found["trim"] = trim_of(result)
    return found


def page_of(results):
    """The text of the page of some results."""
    share = max(1, sum("transient" in result for result in results))
    sections = [section_of(result, share) for result in results]
    shown = ("modes", "geometry", "campbell", "transient")
    for result, section in zip(results, sections):
        if not any(key in section for key in shown):
            raise ReportError(f"{result.path}: nothing for a page; it has {', '.join(result.groups) or 'no groups'}. "
                              "It shows results of modes, floquet, trim, static, campbell and transient")
    template = (PAGE / "report.html").read_text(encoding="utf-8")
    parts = {"STYLE": (PAGE / "report.css").read_text(encoding="utf-8"),
             "PROGRAM": (PAGE / "report.js").read_text(encoding="utf-8"),
             "TITLE": html.escape(sections[0]["title"])}
    used = sum(map(len, parts.values())) + len(json.dumps(sections)) + SPARE_BYTES
    room = int(MOST_MEGABYTES * 1e6) - used
    for result, section in zip(results, sections):
        if "modes" in section:
            motions = motions_of(result, max(0, room))
            if motions is not None:
                section["modes"]["motions"] = motions
                room -= len(json.dumps(motions))
    # In a script element only "<" could end it.
    parts["DATA"] = json.dumps({"results": sections}, separators=(",", ":")).replace("<", "\\u003c")
    for name, text in parts.items():
        template = template.replace(f"@{name}@", text, 1)
    return template


def write(paths, output):
    """Writes the page of the results at some paths."""
    output = pathlib.Path(output)
    if output.suffix not in (".html", ".htm"):
        raise ReportError(f"{output}: expected a name that ends in .html")
    if output.exists() and MARK not in output.read_bytes()[:200].decode("utf-8", "replace"):
        raise ReportError(f"{output}: exists and is no page of samara report; hint: another name behind -o, or remove it")
    if not output.parent.is_dir():
        raise ReportError(f"{output.parent}: no such folder; hint: make it first")
    results = [open_result(path) for path in paths]
    page = page_of(results).replace("\n", f"\n{MARK}\n", 1)
    whole = output.with_name(f".{output.name}.{os.getpid()}")  # a page that is there stays until the new one is whole
    try:
        whole.write_text(page, encoding="utf-8")
        whole.replace(output)
    finally:
        whole.unlink(missing_ok=True)
    return output


def main(arguments=None):
    """The command line; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="samara report", description="Writes one page of results that needs no network: model, modes, Campbell "
        "diagram, moving turbine, time series.",
        epilog="example: samara report floquet.h5 campbell.h5 -o report.html")
    parser.add_argument("results", nargs="+", metavar="RESULT.h5")
    parser.add_argument("-o", dest="output", metavar="FILE.html",
                        help="name of the page. Without it RESULT.html in the current folder")
    given = parser.parse_args(arguments)
    try:
        output = given.output or f"{pathlib.Path(given.results[0]).stem}.html"
        print(f"report: {write(given.results, output)}")
    except (OSError, ValueError, KeyError) as error:
        text = error.args[0] if isinstance(error, KeyError) and error.args else error
        print(f"samara: {text}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
