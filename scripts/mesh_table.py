#!/usr/bin/env python3
"""Error of the first ten modes, degrees of freedom and CPU time of meshes, as a table.

    scripts/mesh_table.py inputs/nrel5mw/land.yaml 4x3,4x3 2x4,2x4

Each mesh is BLADE[,TOWER][@STEPS], elements x order, and floquet.steps; errors are against the mesh
of --reference, which ought to be much finer. The figures behind a row are the errors mode by mode [%].
"""

import argparse
import csv
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(__file__).resolve().parent / "samara"
COUNTED = 10


def settings_of(mesh, more):
    settings = list(more)
    mesh, _, steps = mesh.partition("@")
    if steps:
        settings.append(f"floquet.steps={steps}")
    for part, text in zip(("blades", "tower"), mesh.split(",")):
        elements, order = text.split("x")
        settings += [f"{part}.elements={elements}", f"{part}.order={order}"]
    return [word for setting in settings for word in ("--set", setting)]


def run(command, case, mesh, more, folder):
    """Rows of the table of modes, degrees of freedom, CPU seconds of the whole process."""
    table = pathlib.Path(folder) / "modes.csv"
    arguments = [str(PROGRAM), command, case, *settings_of(mesh, more), "--csv", str(table), "-o",
                 str(pathlib.Path(folder) / "modes.h5")]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(arguments, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if not table.exists():
        sys.exit(f"{mesh}: {done.stderr}")
    words = done.stdout.split(" degrees of freedom")[0].split()
    with open(table, encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["resolved"] == "1"]
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return rows, int(words[-1]), cpu


def exponent(row):
    return complex(float(row["exponent_re"]), float(row["exponent_im"]))


def distance(row, others):
    """Relative, to the nearest exponent of the others."""
    return min(abs(exponent(row) - exponent(other)) for other in others) / abs(exponent(row))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case")
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--reference", required=True)
    parser.add_argument("--command", default="floquet")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--runs", type=int, default=3)
    arguments = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with tempfile.TemporaryDirectory() as folder:
        fine, _, _ = run(arguments.command, arguments.case, arguments.reference, arguments.set, folder)
        moving = [row for row in fine if abs(exponent(row)) > 1e-5]
        print("| mesh | degrees of freedom | largest error of the first ten modes | CPU [s] |")
        print("|---|---|---|---|")
        for mesh in arguments.meshes:
            times = []
            for _ in range(arguments.runs):
                rows, freedom, cpu = run(arguments.command, arguments.case, mesh, arguments.set, folder)
                times.append(cpu)
            errors = [distance(row, rows) for row in moving[:COUNTED]]
            print(f"| {mesh} | {freedom} | {100.0 * max(errors):.2g} % | {sorted(times)[len(times) // 2]:.2f} |",
                  " ".join(f"{100.0 * error:.2g}" for error in errors), flush=True)


if __name__ == "__main__":
    main()
