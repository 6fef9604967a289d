#!/usr/bin/python3
"""Draws Figures 3 to 14 of Lee, Hodges & Patil (2002), the blade modes, and writes their table in docs/lee2002.md.

    scripts/lee2002_figures.py                     # three minutes; docs/figures/lee2002/figure_03.svg to figure_14.svg
    scripts/lee2002_figures.py --result FILE.h5    # of an earlier run with --keep FILE.h5
    scripts/lee2002_figures.py --check             # writes nothing; exit code 1 where the table differs
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
import matplotlib  # noqa: E402

matplotlib.use("Agg")
from samara import open_result, plot, shapes  # noqa: E402

PAGE = ROOT / "docs/lee2002.md"
FIGURES = ROOT / "docs/figures/lee2002"
# Resolves the second torsion modes, at 131 per revolution.
SETTINGS = ["floquet.steps=800", "blades.elements=2", "blades.order=6", "tower.elements=2", "tower.order=6"]

# Number of the figure, its title and frequency per revolution in the article, label in Samara.
MODES = [
    (3, "First symmetric flapping mode", 0.320, "1st blade flap symmetric"),
    (4, "Second symmetric flapping mode", 4.710, "2nd blade flap symmetric"),
    (5, "First antisymmetric flapping mode", 2.624, "1st blade flap antisymmetric"),
    (6, "Second antisymmetric flapping mode", 9.583, "2nd blade flap antisymmetric"),
    (7, "First symmetric torsion mode", 13.936, "1st blade torsion symmetric"),
    (8, "Second symmetric torsion mode", 41.610, "2nd blade torsion symmetric"),
    (9, "First antisymmetric torsion mode", 13.935, "1st blade torsion antisymmetric"),
    (10, "Second antisymmetric torsion mode", 41.662, "2nd blade torsion antisymmetric"),
    (11, "First symmetric lead-lag mode", 0.491, "1st blade lead-lag symmetric"),
    (12, "Second symmetric lead-lag mode", 4.465, "2nd blade lead-lag symmetric"),
    (13, "First antisymmetric lead-lag mode", 0.655, "1st blade lead-lag antisymmetric"),
    (14, "Second antisymmetric lead-lag mode", 5.345, "2nd blade lead-lag antisymmetric"),
]
HEADS = ["Figure", "mode", "article", "Samara", "blade tip", "tower fore-aft [m]", "tower side-side [m]", "yaw [deg]",
         "teeter [deg]", "yaw at +1, -1 [deg]"]


def number(value):
    return "0" if value < 5e-4 else f"{value:.3f}"


def row(figure, title, printed, mode):
    """Largest values over a revolution and over the tower, for a deflection of the tip of 1 m or a torsion of 10 deg."""
    tips = numpy.concatenate([mode.deflections(blade)[:, -1] for blade in ("blade 1", "blade 2")])
    kind = {"flap": 0, "lead-lag": 1, "torsion": 2}[mode.label.split()[2]]
    scale = abs(tips[:, kind]).max() / (numpy.radians(10.0) if kind == 2 else 1.0)
    tower = abs(mode.deflections("tower")).max((0, 1)) / scale
    angles = {name: values / scale for name, values in mode.joints().items()}
    # Waves of the yaw angle beside that of the mode, where they reach 0.1 degrees.
    turns = numpy.arange(96) / 96
    even = shapes.periodic(angles["yaw"], mode.turbine.phases, turns)
    waves = [numpy.degrees(abs((even * numpy.exp(-2j * numpy.pi * k * turns)).mean())) for k in (1, -1)]
    shares = ", ".join(f"{wave:.2f}" for wave in waves) if max(waves) > 0.1 else ""
    per_revolution = mode.exponent.imag * mode.turbine.period / (2.0 * numpy.pi)
    return [f"[{figure}](figures/lee2002/figure_{figure:02d}.svg)", title[0].lower() + title[1:].removesuffix(" mode"),
            f"{printed:.3f}", f"{per_revolution:.3f}", ("1 m flap", "1 m lead-lag", "10 deg torsion")[kind],
            number(tower[0]), number(tower[1]), number(numpy.degrees(abs(angles["yaw"]).max())),
            number(numpy.degrees(abs(angles["teeter"]).max())), shares]


def table(rows):
    lines = ["| " + " | ".join(HEADS) + " |", "|--:|---" + "|--:" * (len(HEADS) - 2) + "|"]
    return "\n".join(lines + ["| " + " | ".join(cells) + " |" for cells in rows]) + "\n"


def run(program, path):
    command = [program, "floquet", ROOT / "inputs/lee2002/baseline.yaml", "-o", path]
    for setting in SETTINGS:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def small(svg):
    """The same picture to a hundredth of a point, without layout of the text."""
    return re.sub(r"(?m)^ +", "", re.sub(r"(\d\.\d\d)\d+", r"\1", svg))


def draw(path, is_check):
    matplotlib.rcParams["font.sans-serif"] = ["DejaVu Sans"]
    result = open_result(path)
    modes = shapes.modes_of(result)
    if not is_check:
        FIGURES.mkdir(parents=True, exist_ok=True)
    rows = []
    for figure, title, printed, label in MODES:
        mode = shapes.find_mode(modes, path, label=label)
        rows.append(row(figure, title, printed, mode))
        if is_check:
            continue
        picture = plot.mode_shape(result, mode.number)
        second = picture._suptitle.get_text().split("\n")[1]
        picture.suptitle(f"Figure {figure}: {title}\n{second}", fontsize=10)
        file = FIGURES / f"figure_{figure:02d}.svg"
        picture.savefig(file, metadata={"Date": None})
        matplotlib.pyplot.close(picture)
        file.write_text(small(file.read_text(encoding="utf-8")), encoding="utf-8")
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "scripts/samara", type=pathlib.Path)
    parser.add_argument("--result", type=pathlib.Path, help="reads this result and runs nothing")
    parser.add_argument("--keep", type=pathlib.Path, help="keeps the result under this name")
    parser.add_argument("--check", action="store_true", help="writes nothing; exit code 1 where the table differs")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = options.result or options.keep or pathlib.Path(folder) / "lee.h5"
        if not options.result:
            run(options.program, path)
        rows = draw(path, options.check)
    page = PAGE.read_text(encoding="utf-8")
    pattern = re.compile(r"(<!-- begin figures -->\n).*?(<!-- end figures -->)", re.DOTALL)
    if not pattern.search(page):
        sys.exit(f"{PAGE}: no markers of figures")
    new = pattern.sub(lambda match: match[1] + table(rows) + match[2], page)
    if options.check:
        sys.exit(0 if new == page else f"{PAGE} differs from the results of the program")
    PAGE.write_text(new, encoding="utf-8")


main()
