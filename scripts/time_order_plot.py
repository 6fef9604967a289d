#!/usr/bin/python3
"""Draws the error of modes by the time steps of `samara floquet` over CPU time, for each time order.

    scripts/time_order_plot.py CASE.yaml ... [-o PICTURE.svg] [--set KEY=VALUE ...]

The error is the largest relative one of the ten slowest modes against 240 steps of order 6. The CPU
time is that of the whole process, the least of three runs. Also prints the figures as a table.
docs/time_order.svg shows three inputs.
"""

import argparse
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SCRIPTS = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(SCRIPTS.parent / "python"))
import samara  # noqa: E402

PROGRAM = SCRIPTS / "samara"
STEPS = {2: (60, 120, 240, 480), 4: (24, 36, 60, 96), 6: (18, 24, 36, 48, 72)}
REFERENCE = (6, 240)
COUNTED = 10
RUNS = 3
COLORS = {2: "#b04a00", 4: "#1f5f9e", 6: "#2e7d32"}
MARKS = {2: "o", 4: "s", 6: "^"}


def run(case, order, steps, settings, folder):
    """Exponents of the resolved modes that move, slowest first, and CPU seconds."""
    result = pathlib.Path(folder) / "floquet.h5"
    words = [f"floquet.time_order={order}", f"floquet.steps={steps}", *settings]
    arguments = [str(PROGRAM), "floquet", case, "-o", str(result)]
    arguments += [word for setting in words for word in ("--set", setting)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(arguments, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, 3):  # 3: no verdict
        sys.exit(f"{case}: {done.stderr}")
    found = samara.open_result(result)["floquet"]
    exponents = samara.result.complex_of(found["exponents"]).values[found["resolved"].values == 1]
    moving = exponents[abs(exponents) > 1e-5 * found.attrs["rotor_speed"]]
    return (moving[np.argsort(abs(moving))],
            after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def error(found, reference):
    return max(min(abs(reference - one)) / abs(one) for one in found[:COUNTED])


def measure(case, settings, folder):
    """(order, steps, resolved modes, error, CPU seconds) of all rules."""
    reference, _ = run(case, *REFERENCE, settings, folder)
    rows = []
    for order, all_steps in STEPS.items():
        for steps in all_steps:
            runs = [run(case, order, steps, settings, folder) for _ in range(RUNS)]
            found = runs[0][0]
            if len(found) >= COUNTED:
                rows.append((order, steps, len(found), error(found, reference),
                             min(seconds for _, seconds in runs)))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="+")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("-o", "--output", default="time_order.svg")
    arguments = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    plt.rcParams.update({"svg.hashsalt": "samara", "font.family": "sans-serif"})
    figure, panels = plt.subplots(1, len(arguments.cases), figsize=(4.2 * len(arguments.cases), 3.6),
                                  squeeze=False, sharey=True)
    print("| case | order | steps | resolved modes | error of the first ten | CPU [s] |")
    print("|---|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        for axes, case in zip(panels[0], arguments.cases):
            rows = measure(case, arguments.set, folder)
            name = "/".join(pathlib.Path(case).parts[-2:])
            for order, steps, resolved, worst, seconds in rows:
                print(f"| {name} | {order} | {steps} | {resolved} | {worst:.1e} | {seconds:.2f} |",
                      flush=True)
            for order in STEPS:
                own = np.array([row[3:] for row in rows if row[0] == order])
                if len(own):
                    axes.loglog(own[:, 1], own[:, 0], marker=MARKS[order], color=COLORS[order],
                                label=f"order {order}")
            axes.set_title(name, fontsize=9.5, loc="left")
            axes.set_xlabel("CPU time [s]", fontsize=9)
            axes.grid(color="#dddddd", linewidth=0.6, which="both")
    panels[0][0].set_ylabel("largest relative error of the ten slowest modes", fontsize=9)
    panels[0][0].legend(fontsize=8.5)
    figure.tight_layout()
    figure.savefig(arguments.output, metadata={"Date": None} if arguments.output.endswith(".svg") else None)


if __name__ == "__main__":
    main()
