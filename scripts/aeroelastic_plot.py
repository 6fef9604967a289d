#!/usr/bin/python3
"""Draws the pictures of docs/aeroelastics.md, from runs of the program.

    scripts/aeroelastic_plot.py [-o docs]

operation.svg: operating points of inputs/nrel5mw/land.yaml over the wind speed. campbell.svg: frequency
and damping of its first modes at these points (samara campbell). span.svg: the air along a blade at three of them.
mesh.svg: change of the damping ratios of the first ten modes with the mesh of the blades, also of
inputs/iea15mw/land.yaml. --only draws one of them. SAMARA names the program.
"""

import argparse
import csv
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
import samara  # noqa: E402

PROGRAM = os.environ.get("SAMARA", str(ROOT / "build" / "samara"))
LAND = str(ROOT / "inputs" / "nrel5mw" / "land.yaml")
WINDS = list(range(4, 26))
SHOWN = [8.0, 12.0, 20.0]
INPUTS = {"nrel5mw": "#1f5f9e", "iea15mw": "#b04a00"}
ELEMENTS = (3, 4, 6, 8, 12, 16)  # of order 2; the inputs have 6
FINEST = 28
FIRST = 10


def run(folder, *arguments):
    subprocess.run([PROGRAM, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)


def read_points(folder):
    run(folder, "operate", LAND, "--set", f"operation.wind_speeds={WINDS}", "--csv", "points.csv")
    with open(folder / "points.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def keys_of(point):
    return ["--set", f"wind.speed={point['wind_speed']}", "--set",
            f"shaft.speed={point['rotor_speed']}", "--set", f"blades.pitch_deg={math.degrees(float(point['pitch']))}"]


def draw_operation(points, path):
    figure, axes = plt.subplots(2, 2, figsize=(8, 4.6), sharex=True)
    winds = [float(point["wind_speed"]) for point in points]
    for axis, (key, factor, label) in zip(axes.flat, (
            ("rotor_speed", 30 / math.pi, "speed [rpm]"), ("pitch", math.degrees(1), "pitch [deg]"),
            ("power", 1e-6, "power [MW]"), ("thrust", 1e-3, "thrust [kN]"))):
        axis.plot(winds, [factor * float(point[key]) for point in points], "o-", markersize=3,
                  color="#1f5f9e")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    for axis in axes[1]:
        axis.set_xlabel("wind [m/s]")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def draw_campbell(path):
    result = samara.run(LAND, "campbell", set={"operation.wind_speeds": WINDS}, ranks=2)
    samara.plot.draw(result, path, "campbell")


def draw_span(folder, points, path):
    figure, axes = plt.subplots(1, 3, figsize=(9, 3.2))
    for wind, color in zip(SHOWN, ("#1f5f9e", "#b04a00", "#2e7d32")):
        point = next(one for one in points if float(one["wind_speed"]) == wind)
        run(folder, "trim", LAND, *keys_of(point), "-o", "steady.h5")
        air = samara.open_result(folder / "steady.h5")["trim/air"]
        radius = air["radius"].values
        for axis, name, factor in zip(axes, ("angle_of_attack", "axial_induction", "normal_force"), (1, 1, 1e-3)):
            mean, least, largest = (factor * air[name + ending].values[0] for ending in ("", "_least", "_largest"))
            axis.plot(radius, mean, "o-", markersize=3, color=color, label=f"{wind:g} m/s")
            axis.fill_between(radius, least, largest, color=color, alpha=0.2)
    for axis, label in zip(axes, ("angle of attack [deg]", "axial induction", "normal force [kN/m]")):
        axis.set_xlabel("radius [m]")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    axes[0].set_ylim(-10, 25)
    axes[0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def read_damping(folder, name, elements):
    case = str(ROOT / "inputs" / name / "land.yaml")
    run(folder, "floquet", case, "--set", f"blades.elements={elements}", "--set", "blades.order=2",
        "--csv", "modes.csv", "-o", "modes.h5")
    with open(folder / "modes.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {row["label"]: float(row["damping_ratio"]) for row in rows[:FIRST]}


def draw_mesh(folder, path):
    """Largest relative difference to the finest mesh; modes are compared by their names."""
    figure, axis = plt.subplots(figsize=(5.5, 3.4))
    for name, color in INPUTS.items():
        finest = read_damping(folder, name, FINEST)
        points, largest = [], []
        for elements in ELEMENTS:
            found = read_damping(folder, name, elements)
            changes = {label: abs(found[label] / ratio - 1) for label, ratio in finest.items() if label in found}
            worst = max(changes, key=changes.get)
            print(f"{name}: {2 * elements} points a blade: {100 * changes[worst]:.2f} % in {worst}"
                  f" of {len(changes)} modes")
            points.append(2 * elements)
            largest.append(100 * changes[worst])
        axis.loglog(points, largest, "o-", markersize=4, color=color, label=name)
    axis.set_xlabel("points a blade")
    axis.set_ylabel("largest change of a damping ratio [%]")
    axis.set_xticks([6, 8, 12, 16, 24, 32], ["6", "8", "12", "16", "24", "32"])
    axis.minorticks_off()
    axis.grid(alpha=0.3)
    axis.legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "docs")
    parser.add_argument("--only", choices=["operation", "span", "campbell", "mesh"])
    arguments = parser.parse_args()
    folder = arguments.output
    chosen = [arguments.only] if arguments.only else ["operation", "span", "campbell", "mesh"]
    matplotlib.rcParams["svg.hashsalt"] = "samara"
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        points = read_points(work) if {"operation", "span"} & set(chosen) else []
        if "operation" in chosen:
            draw_operation(points, folder / "operation.svg")
        if "span" in chosen:
            draw_span(work, points, folder / "span.svg")
        if "campbell" in chosen:
            draw_campbell(folder / "campbell.svg")
        if "mesh" in chosen:
            draw_mesh(work, folder / "mesh.svg")


if __name__ == "__main__":
    main()
