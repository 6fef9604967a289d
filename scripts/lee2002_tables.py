#!/usr/bin/python3
"""Writes the tables of docs/lee2002.md: Tables II and III of Lee, Hodges & Patil (2002) as printed,
beside the results of Samara.

    scripts/lee2002_tables.py            # a few minutes; rewrites docs/lee2002.md between its markers
    scripts/lee2002_tables.py --check    # writes nothing; exit code 1 where the page differs
"""

import argparse
import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/lee2002.md"
CASES = ROOT / "inputs/lee2002"

COARSE = {"steps": 500, "order": 1}  # as in the paper
FINE = {"steps": 2400, "order": 6, "elements": 2}  # relative errors of frequencies of some 1e-5

# Mode of the paper, label of Samara, printed values: Table II (2, 3, 4 elements), Table III (10, 100,
# 1000, rigid). The modes yaw and teeter do not oscillate here; the text of the page describes them.
PRINT = [
    ("1st tower side-side", "1st tower side-side", (0.282, 0.291, 0.292), (0.219, 0.292, 0.760, None)),
    ("2nd tower side-side", "2nd tower side-side", (14.711, 8.711, 8.377), (3.164, 8.377, 22.225, None)),
    ("1st tower fore-aft", "1st tower fore-aft", (0.930, 0.938, 0.938), (0.920, 0.938, 1.494, None)),
    ("2nd tower fore-aft", "2nd tower fore-aft", (11.785, 8.052, 7.615), (4.584, 7.615, 23.985, None)),
    ("1st tower torsion", "1st tower torsion", (56.940, 56.824, 56.431), (21.460, 56.431, 148.091, None)),
    ("2nd tower torsion", "2nd tower torsion", (99.990, 98.128, 97.049), (79.450, 97.049, 235.723, None)),
    ("1st symm. flap", "1st blade flap symmetric", (0.315, 0.317, 0.320), (0.217, 0.320, 0.667, 0.802)),
    ("1st antisymm. flap", "1st blade flap antisymmetric", (3.410, 2.935, 2.624), (2.624, 2.624, 2.624, 2.624)),
    ("2nd symm. flap", "2nd blade flap symmetric", (8.365, 5.937, 4.710), (4.660, 4.710, 4.737, 5.495)),
    ("2nd antisymm. flap", "2nd blade flap antisymmetric", (23.748, 12.500, 9.583), (9.578, 9.583, 9.583, 9.583)),
    ("1st symm. torsion", "1st blade torsion symmetric", (15.482, 14.078, 13.936), (13.937, 13.936, 13.937, 13.937)),
    ("1st antisymm. torsion", "1st blade torsion antisymmetric", (14.822, 14.123, 13.935), (14.093, 13.935, 13.947, 13.972)),
    ("2nd symm. torsion", "2nd blade torsion symmetric", (46.212, 43.471, 41.610), (41.610, 41.610, 41.610, 41.610)),
    ("2nd antisymm. torsion", "2nd blade torsion antisymmetric", (46.233, 43.459, 41.662), (41.724, 41.662, 41.610, 41.620)),
    ("1st symm. lead-lag", "1st blade lead-lag symmetric", (0.498, 0.490, 0.491), (0.467, 0.491, 0.494, 0.496)),
    ("1st antisymm. lead-lag", "1st blade lead-lag antisymmetric", (0.662, 0.654, 0.655), (0.477, 0.655, 0.633, 0.639)),
    ("2nd symm. lead-lag", "2nd blade lead-lag symmetric", (7.408, 5.399, 4.465), (4.223, 4.465, 5.300, 5.356)),
    ("2nd antisymm. lead-lag", "2nd blade lead-lag antisymmetric", (7.589, 5.550, 5.345), (4.660, 5.345, 5.647, 5.588)),
]

# Modes whose label differs from the paper's row, by run: chosen by shape, and marked in the tables.
# 2 elements: tower side-side bending and antisymmetric lead-lag coincide modulo one per revolution.
# Ratio 10: the tower is as soft as the blades, and most lead-lag modes strain the tower more than
# the blades.
BY_SHAPE = {
    "2 elements": {
        "1st tower side-side": "1st blade lead-lag antisymmetric",
        "2nd tower side-side": "tower side-side",
        "1st blade lead-lag antisymmetric": "2nd blade lead-lag antisymmetric",
        "2nd blade lead-lag antisymmetric": "blade lead-lag",
    },
    "ratio 10": {
        "1st blade lead-lag symmetric": "2nd tower side-side",
        "2nd tower side-side": "3rd tower side-side",
        "2nd blade lead-lag symmetric": "4th tower side-side",
    },
    "ratio 10, fine": {
        "1st blade lead-lag symmetric": "2nd tower side-side",
        "2nd tower side-side": "3rd tower side-side",
        "2nd blade lead-lag symmetric": "4th tower side-side",
        "2nd blade lead-lag antisymmetric": "4th tower fore-aft",
    },
}

# Frequencies of these modes are those of the tower, in the fixed frame. In the rotating frame they are
# higher by this number per revolution.
IN_ROTOR = {("ratio 10, fine", "4th tower fore-aft"): 1.0}


def fold_distance(a, b):
    """Distance of two frequencies per revolution if a multiple of one and the sign are free."""
    return abs(abs(a - round(a)) - abs(b - round(b)))


class Run:
    """The modes of one case: frequency per revolution and whether it is resolved, by label."""

    def __init__(self, program, name, case, settings):
        self.name = name
        self.steps = settings["steps"]
        has_tower = case != "rigid_tower"
        arguments = [f"floquet.steps={self.steps}", "floquet.time_order=2"]
        for part in ("blades", "tower") if has_tower else ("blades",):
            for key in ("order", "elements"):
                if key in settings:
                    arguments.append(f"{part}.{key}={settings[key]}")
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "modes.csv"
            command = [program, "floquet", CASES / f"{case}.yaml", "--csv", table]
            command += ["-o", pathlib.Path(folder) / "modes.h5"]
            for argument in arguments:
                command += ["--set", argument]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            with open(table, encoding="utf-8", newline="") as lines:
                rows = list(csv.DictReader(lines))
        self.modes = {
            row["label"]: (float(row["frequency_per_rev"]), row["resolved"] == "1") for row in rows
        }

    def label(self, wanted):
        return BY_SHAPE.get(self.name, {}).get(wanted, wanted)

    def find(self, wanted):
        label = self.label(wanted)
        # A mode that is alone has no number where the shape does not tell it; the label ends in
        # "(unresolved)" if the mode is not resolved.
        alone = label.removeprefix("1st ")
        for name in (label, alone, f"{label} (unresolved)", f"{alone} (unresolved)"):
            if name in self.modes:
                frequency, resolved = self.modes[name]
                return frequency + IN_ROTOR.get((self.name, label), 0.0), resolved
        sys.exit(f"{self.name}: no mode {label!r} among {sorted(self.modes)}")

    def frequency(self, wanted):
        return self.find(wanted)[0]

    def text(self, wanted):
        frequency, resolved = self.find(wanted)
        mark = "" if self.label(wanted) == wanted else "†"
        return f"{frequency:.3f}" + ("" if resolved else "*") + mark

    def stepped(self, wanted):
        """The frequency of the sequence of steps, (2/dt) atan(omega dt/2), as in the article."""
        half = math.pi / self.steps
        return math.atan(self.frequency(wanted) * half) / half

    def fine_text(self, wanted):
        frequency = self.frequency(wanted)
        return f"{frequency:.1f}" if frequency > 100 else f"{frequency:.3f}"


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|---" + "|--:" * (len(heads) - 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def cells(printed, run, label):
    return [
        f"{printed:.3f}",
        run.text(label),
        f"{fold_distance(printed, run.stepped(label)):.3f}",
    ]


def table_2(runs, fine):
    heads = ["mode"]
    for n in (2, 3, 4):
        heads += [f"n = {n}: print", "Samara", "fold"]
    rows = []
    for name, label, printed, _ in PRINT:
        row = [name]
        for value, run in zip(printed, runs):
            row += cells(value, run, label)
        rows.append(row + [fine.fine_text(label)])
    return table(heads + ["converged"], rows)


def table_3(runs, fines, columns):
    heads = ["mode"]
    for column in columns:
        heads += [f"{('10', '100', '1000', 'rigid')[column]}: print", "Samara", "fold", "converged"]
    rows = []
    for name, label, _, printed in PRINT:
        row = [name]
        for column in columns:
            if printed[column] is None:
                row += [""] * 4
            else:
                row += cells(printed[column], runs[column], label)
                row.append(fines[column].fine_text(label))
        rows.append(row)
    return table(heads, rows)


def statistics(pairs):
    """Counts of printed values near those of Samara, as printed, folded, and expected by chance."""
    rows = []
    for limit in (0.01, 0.02, 0.05, 0.1):
        near = sum(abs(a - b) < limit for a, b in pairs)
        folded = sum(fold_distance(a, b) < limit for a, b in pairs)
        chance = len(pairs) * (1 - (1 - 2 * limit) ** 2)
        rows.append([f"{limit}", f"{near}", f"{folded}", f"{chance:.1f}"])
    heads = ["closer than", "as printed", "folded", "folded, by chance"]
    return f"{len(pairs)} entries; those of Table III at ratio 100 are counted once.\n\n" + table(heads, rows)


def make_blocks(program):
    coarse = [
        Run(program, f"{n} elements", "baseline", {**COARSE, "elements": n}) for n in (2, 3, 4)
    ]
    names = ["ratio 10", "ratio 100", "ratio 1000", "rigid"]
    cases = ["ratio10", "baseline", "ratio1000", "rigid_tower"]
    stiffness = [Run(program, n, c, {**COARSE, "elements": 4}) for n, c in zip(names, cases)]
    fines = [Run(program, f"{n}, fine", c, FINE) for n, c in zip(names, cases)]
    pairs = [
        (value, run.stepped(label))
        for _, label, printed, _ in PRINT
        for value, run in zip(printed, coarse)
    ]
    pairs += [
        (printed[i], stiffness[i].stepped(label))
        for _, label, _, printed in PRINT
        for i in (0, 2, 3)
        if printed[i] is not None
    ]
    return {
        "table 2": table_2(coarse, fines[1]),
        "table 3, soft": table_3(stiffness, fines, (0, 1)),
        "table 3, stiff": table_3(stiffness, fines, (2, 3)),
        "statistics": statistics(pairs),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "scripts/samara", type=pathlib.Path)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    page = PAGE.read_text(encoding="utf-8")
    result = page
    for name, text in make_blocks(options.program).items():
        pattern = re.compile(f"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        if not pattern.search(result):
            sys.exit(f"{PAGE}: no markers of {name!r}")
        result = pattern.sub(lambda match, text=text: match[1] + text + match[2], result)
    if options.check:
        sys.exit(0 if result == page else f"{PAGE} differs from the results of the program")
    PAGE.write_text(result, encoding="utf-8")


main()
