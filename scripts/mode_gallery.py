#!/usr/bin/python3
"""Draws docs/modes.svg: six modes of the turbine of Lee, Hodges & Patil (2002), from a result file.

    scripts/mode_gallery.py [--program build/samara] [--png FILE]
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
import samara  # noqa: E402

CASE = ROOT / "inputs/lee2002/baseline.yaml"
TOWER, OVERHANG, RADIUS, BLADE = 27.0, 2.388, 1.8, 8.42  # of the case [m]
LARGEST = 3.2  # drawn, of the largest displacement [m]

N1, N2, N3 = np.eye(3)
# Attachment axes (b1, b2, b3) in n1 n2 n3 at azimuth 0, as columns.
TOWER_AXES = np.column_stack((N3, N1, N2))
BLADE_AXES = {1: np.column_stack((N3, N1, N2)), 2: np.column_stack((-N3, -N1, N2))}

# Label, title, horizontal direction of the view.
PANELS = [
    ("1st tower fore-aft", "tower fore-aft", N2),
    ("1st blade flap symmetric", "flap, symmetric", N2),
    ("1st blade flap antisymmetric", "flap, antisymmetric", N2),
    ("1st tower side-side", "tower side-side", N1),
    ("1st blade lead-lag symmetric", "lead-lag, symmetric", N1),
    ("1st blade lead-lag antisymmetric", "lead-lag, antisymmetric", N1),
]
TOWER_COLOR, BLADE_COLOR = "#b04a00", "#1f5f9e"


class Result:
    """Data of a result file for the plot."""

    def __init__(self, path):
        result = samara.open_result(path)
        modes = result["floquet"]
        self.place = {str(name): i for i, name in enumerate(result["model/unknowns"]["name"].values)}
        self.shapes = samara.result.complex_of(modes["modes"]).values[:, 0]  # azimuth 0.4 degrees
        self.labels = [str(label) for label in modes["label"].values]
        self.per_rev = modes["frequency_per_rev"].values
        self.hertz = modes["frequency_hz"].values
        self.parts = [str(part) for part in modes["part"].values]
        self.shares = modes["part_share"].values

    def vector(self, shape, name):
        return np.array([shape[self.place[f"{name}{i}"]] for i in (1, 2, 3)])

    def stations(self, beam):
        """Names of the points of a beam from root to tip, and their fractions of the length."""
        count = sum(name.startswith(f"{beam} point") and name.endswith(" u1") for name in self.place)
        nodes, _ = np.polynomial.legendre.leggauss(count)  # of one element
        return [f"{beam} point {p + 1}" for p in range(count)], 0.5 * (1 + nodes)


def displacements(result, shape):
    """Undeformed places and displacements [(x, d)] of tower and blades, n1 n2 n3 components."""
    points, at = result.stations("tower")
    places = [np.zeros(3)] + [TOWER * f * N3 for f in at] + [TOWER * N3]
    moves = [np.zeros(3)] + [TOWER_AXES @ result.vector(shape, f"{p} u") for p in points]
    moves.append(TOWER_AXES @ result.vector(shape, "tower top u"))
    curves = [(np.array(places), np.array(moves))]
    turn = TOWER_AXES @ result.vector(shape, "tower top theta") + shape[result.place["yaw angle"]] * N3
    apex = TOWER * N3 + OVERHANG * N2
    apex_move = moves[-1] + np.cross(turn, OVERHANG * N2)
    curves.append((np.array([TOWER * N3, apex]), np.array([moves[-1], apex_move])))
    hub_turn = turn + shape[result.place["teeter angle"]] * N1
    for blade, axes in BLADE_AXES.items():
        points, at = result.stations(f"blade {blade}")
        own = [np.zeros(3), np.zeros(3)] + [result.vector(shape, f"blade {blade} point {p + 1} u")
                                            for p in range(len(points))]
        own.append(result.vector(shape, f"blade {blade} tip u"))
        arms = [0.0, RADIUS] + [RADIUS + BLADE * f for f in at] + [RADIUS + BLADE]
        places = np.array([apex + r * axes[:, 0] for r in arms])
        moves = np.array([apex_move + np.cross(hub_turn, r * axes[:, 0]) + axes @ u
                          for r, u in zip(arms, own)])
        curves.append((places, moves))
    return curves


def draw_panel(axes, result, label, title, across):
    mode = result.labels.index(label)
    curves = displacements(result, result.shapes[mode])
    everything = np.concatenate([moves for _, moves in curves])
    visible = everything @ np.column_stack((across, N3))
    biggest = visible.flat[np.argmax(np.abs(visible))]
    factor = LARGEST / biggest  # also turns the phase: the largest displacement is real
    styles = [(TOWER_COLOR, 4.0), ("#666666", 4.0), (BLADE_COLOR, 3.0), (BLADE_COLOR, 3.0)]
    for (places, moves), (color, width) in zip(curves, styles):
        axes.plot(places @ across, places @ N3, color="#c9c9c9", linewidth=width, zorder=1,
                  solid_capstyle="round")
        for sign, alpha in ((-1, 0.28), (1, 1.0)):
            drawn = places + sign * (moves * factor).real
            axes.plot(drawn @ across, drawn @ N3, color=color, linewidth=width * 0.75, alpha=alpha,
                      zorder=2 + alpha, solid_capstyle="round")
    axes.axhline(0, color="#999999", linewidth=1.2)
    order = np.argsort(-result.shares[mode])
    energy = ", ".join(f"{result.parts[p]} {100 * result.shares[mode, p]:.0f} %" for p in order[:2])
    axes.set_title(title, fontsize=11, fontweight="bold", pad=22)
    axes.text(0.5, 1.012, f"{result.per_rev[mode]:.2f} per rev = {result.hertz[mode]:.2f} Hz",
              ha="center", va="bottom", fontsize=10.5, transform=axes.transAxes)
    axes.text(0.5, -0.012, energy, ha="center", va="top", fontsize=9.5, color="#555555",
              transform=axes.transAxes)
    middle = 0.5 * OVERHANG if across is N2 else 0.0
    axes.set_xlim(middle - 6, middle + 6)
    axes.set_ylim(-0.5, 39)
    axes.set_aspect("equal")
    axes.axis("off")


def draw(result):
    plt.rcParams.update({"svg.hashsalt": "samara", "font.family": "sans-serif"})
    figure, panels = plt.subplots(1, len(PANELS), figsize=(13.6, 5.9))
    for axes, (label, title, across) in zip(panels, PANELS):
        draw_panel(axes, result, label, title, across)
    figure.text(0.258, 0.945, "seen from the side", ha="center", fontsize=11, color="#555555")
    figure.text(0.745, 0.945, "looking downwind", ha="center", fontsize=11,
                color="#555555")
    figure.subplots_adjust(left=0.01, right=0.99, top=0.82, bottom=0.05, wspace=0.02)
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "scripts/samara", type=pathlib.Path)
    parser.add_argument("--png", type=pathlib.Path, help="writes a bitmap, too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "modes.h5"
        command = [options.program, "floquet", CASE, "-o", path]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        figure = draw(Result(path))
    figure.savefig(ROOT / "docs/modes.svg", metadata={"Date": None})
    if options.png:
        figure.savefig(options.png, dpi=100)


main()
