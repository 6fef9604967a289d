#!/usr/bin/python3
"""Draws time and memory over the number of elements from the figures of `scripts/bench sizes`.

    scripts/bench sizes --json sizes.json && scripts/bench_plot.py sizes.json [-o PICTURE.svg]

Also prints the figures as a table, with the exponent of the growth of CPU time between the two
largest meshes of each command. docs/sizes.svg is its picture.
"""

import argparse
import json
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLORS = {"trim": "#1f5f9e", "all modes": "#b04a00", "ten modes": "#2e7d32", "transient": "#6a3d9a"}


def style(command):
    """Colour of the command's kind; dashed with actuators, dotted on two ranks."""
    kind = command.split(",")[0]
    line = "--" if "actuators" in command else ":" if "ranks" in command else "-"
    return {"color": COLORS[kind], "linestyle": line, "marker": "o", "markersize": 3.5,
            "linewidth": 1.3, "label": command}


def growth(rows):
    """Exponent of the CPU time in the number of elements between the two largest meshes."""
    if len(rows) < 2:
        return float("nan")
    first, last = rows[-2:]
    return math.log(last["cpu"] / first["cpu"]) / math.log(last["elements"] / first["elements"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("figures")
    parser.add_argument("-o", "--output", default="sizes.svg")
    arguments = parser.parse_args()
    rows = json.loads(pathlib.Path(arguments.figures).read_text())
    commands = list(dict.fromkeys(row["command"] for row in rows))
    sizes = sorted({row["elements"] for row in rows})
    print("| CPU time [s], memory [MB] | " + " | ".join(str(size) for size in sizes) + " | growth |")
    print("|---" + "|--:" * (len(sizes) + 1) + "|")
    plt.rcParams.update({"svg.hashsalt": "samara", "font.family": "sans-serif"})
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 4.0))
    for command in commands:
        own = [row for row in rows if row["command"] == command]
        cells = {row["elements"]: f"{row['cpu']:.2f}, {row['memory']:.0f}" for row in own}
        print(f"| {command} | " + " | ".join(cells.get(size, "") for size in sizes) +
              f" | {growth(own):.2f} |")
        elements = [row["elements"] for row in own]
        panels[0].loglog(elements, [row["wall"] for row in own], **style(command))
        panels[1].loglog(elements, [row["memory"] for row in own], **style(command))
    for axes, name in zip(panels, ("time of the whole process [s]", "memory of a rank [MB]")):
        axes.set_xlabel("beam elements of order 1, blades and tower", fontsize=9)
        axes.set_ylabel(name, fontsize=9)
        axes.grid(color="#dddddd", linewidth=0.6, which="both")
    panels[0].legend(fontsize=7.5)
    figure.tight_layout()
    figure.savefig(arguments.output,
                   metadata={"Date": None} if arguments.output.endswith(".svg") else None)


if __name__ == "__main__":
    main()
