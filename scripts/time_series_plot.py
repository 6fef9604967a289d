#!/usr/bin/python3
"""Draws channels of a time series over time, from a result file of `samara transient`.

    scripts/time_series_plot.py RESULT.h5 [CHANNEL ...] [-o PICTURE.svg]

Without channels all of the result, if they are no more than 8. Dashed lines are its events.
docs/time_series.svg shows the time series of README.md.
"""

import argparse
import pathlib
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python"))
import samara  # noqa: E402

COLOR, EVENT_COLOR = "#1f5f9e", "#b04a00"
MOST = 8  # panels


class TimeSeries:
    """Data of a result file for the plot."""

    def __init__(self, path):
        result = samara.open_result(path)
        series = result["transient"]
        self.time = series["time"].values
        self.unit = samara.result.unit_of(series["time"])
        self.values = series["values"].values
        self.names, self.units, self.descriptions = (
            [str(text) for text in series[f"channel_{what}"].values] for what in ("name", "unit", "description"))
        checkpoint = result["transient/checkpoint"] if "transient/checkpoint" in result else {}
        times = checkpoint["event_time"].values if "event_time" in checkpoint else np.empty(0)
        self.events = times[np.isfinite(times)]  # of those that came


def draw_panel(axes, series, name):
    i = series.names.index(name)
    axes.plot(series.time, series.values[:, i], color=COLOR, linewidth=1.1)
    for time in series.events:
        axes.axvline(time, color=EVENT_COLOR, linewidth=0.9, linestyle=(0, (4, 3)))
    axes.set_title(f"{name}: {series.descriptions[i]}", fontsize=9.5, loc="left", pad=4)
    axes.set_ylabel(series.units[i], fontsize=9)
    axes.tick_params(labelsize=8.5, length=2.5)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.margins(x=0)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def draw(series, names):
    plt.rcParams.update({"svg.hashsalt": "samara", "font.family": "sans-serif",
                         "path.simplify_threshold": 0.2})  # [px]
    height = 0.55 + 1.45 * len(names)
    figure, panels = plt.subplots(len(names), 1, figsize=(10, height), sharex=True, squeeze=False)
    for axes, name in zip(panels[:, 0], names):
        draw_panel(axes, series, name)
    panels[-1, 0].set_xlabel(f"time [{series.unit}]", fontsize=9)
    figure.align_ylabels()
    figure.tight_layout(pad=0.6, h_pad=0.7)
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("result", type=pathlib.Path)
    parser.add_argument("channels", nargs="*", metavar="channel")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="by default RESULT.svg")
    options = parser.parse_args()
    series = TimeSeries(options.result)
    names = options.channels or series.names
    unknown = [name for name in names if name not in series.names]
    if unknown:
        parser.error(f"{options.result} has no channel {', '.join(unknown)}")
    if len(names) > MOST:
        parser.error(f"{len(names)} channels: name {MOST} of them at the most")
    picture = options.output or options.result.with_suffix(".svg")
    figure = draw(series, names)
    is_svg = picture.suffix == ".svg"
    figure.savefig(picture, dpi=100, metadata={"Date": None} if is_svg else None)
    print("picture:", picture)


main()
