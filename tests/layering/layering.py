"""The rooms and their order (CONTRIBUTING.md): refuses an include of a room above, and of a library
outside its room. The link graph cannot see that, for a header needs no linking."""

import os
import pathlib
import re
import sys
import tempfile

ROOMS = {  # room: the rooms it may include, itself always
    "base": [],
    "math": ["base"],
    "petsc": ["base"],
    "system": ["base", "petsc"],
    "elements": ["base", "math"],
    "model": ["base", "math", "elements"],
    "fields": ["base", "math", "elements", "model"],
    "components": ["base", "math", "petsc", "elements", "model", "system"],
    "turbine": ["base", "math", "petsc", "elements", "model", "system", "components"],
    "analysis": ["base", "math", "petsc", "system"],
    "linear": ["base", "math", "petsc", "system", "analysis"],
    "simulation": ["base", "math", "petsc", "elements", "model", "fields", "system", "turbine",
                   "analysis", "linear"],
    "loads": ["base"],
    "io": ["base", "math", "petsc", "elements", "model", "fields", "system", "turbine", "analysis",
           "linear", "simulation", "loads"],
    "decks": ["base", "math", "elements", "model", "fields", "io"],
}
DRIVERS = "drivers"  # may include every room

LIBRARIES = [  # pattern of its headers, the rooms that may include them
    (re.compile(r"(yaml-cpp|nlohmann)/"), ["io"]),
    (re.compile(r"(.*/)?(hdf5(_hl)?|H5\w+)\.h$"), ["io"]),
    (re.compile(r"(.*/)?(petsc|slepc)\w*\.(h|hpp)$"), ["petsc", "system", "components", "turbine", "analysis", "linear"]),
]

INCLUDE = re.compile(r"^\s*#\s*include\s*(?:[<\"]([^>\"]*)[>\"]|(\S.*))")
SUFFIXES = (".hpp", ".cpp", ".h", ".in")


def find_room(path):
    """The room of a file, None if it is in none."""
    parts = path.parts
    if parts[0] == DRIVERS:
        return DRIVERS
    inner = parts[2:] if parts[:2] == ("include", "samara") else parts[1:]
    return inner[0] if len(inner) > 1 and inner[0] in ROOMS else None


def find_fault(room, header):
    """The fault of a file of `room` that includes `header`, or None."""
    if ".." in header.split("/"):
        return "an include names the whole path from include/, not one relative to the file"
    if header.startswith("samara/"):
        other = header.split("/")[1]
        if other not in ROOMS:
            return f"there is no room {other}"
        allowed = room in (DRIVERS, other) or other in ROOMS[room]
        if not allowed:
            return f"{room} must not include {other}"
        return None
    for pattern, rooms in LIBRARIES:
        if pattern.match(header) and room not in rooms:
            return f"only {', '.join(rooms)} may include it"
    return None


def find_faults(root):
    """All faults below `root`, as `file:line: header: what`."""
    faults = []
    files = [
        path
        for top in ("include", "src", DRIVERS)
        for path in sorted((root / top).rglob("*"))
        if path.is_file() and path.suffix in SUFFIXES
    ]
    for path in files:
        place = path.relative_to(root)
        room = find_room(place)
        if room is None:
            faults.append(f"{place}: in no room; the rooms are {', '.join(ROOMS)}")
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            include = INCLUDE.match(line)
            if not include:
                continue
            header = include.group(1) or include.group(2)
            fault = find_fault(room, header) if include.group(1) else "an include names a file"
            if fault:
                faults.append(f"{place}:{number}: {header}: {fault}")
    return faults, len(files)


def test_itself():
    """Plants legal and illegal includes in a tree of its own: exactly the illegal ones are found."""
    cases = [  # file, include, legal
        ("src/math/a.cpp", "<Eigen/Core>", True),
        ("src/math/b.cpp", '"samara/base/error.hpp"', True),
        ("src/math/c.cpp", '"helper.hpp"', True),
        ("include/samara/elements/a.hpp", '"samara/math/types.hpp"', True),
        ("src/turbine/a.cpp", '"samara/model/turbine.hpp"', True),
        ("src/system/b.cpp", "<petscmat.h>", True),
        ("src/analysis/a.cpp", '"samara/system/periodic_system.hpp"', True),
        ("src/analysis/b.cpp", "<slepceps.h>", True),
        ("src/io/a.cpp", "<yaml-cpp/yaml.h>", True),
        ("src/io/b.cpp", "<hdf5.h>", True),
        ("src/io/c.cpp", '"samara/analysis/options.hpp"', True),
        ("drivers/a.cpp", '"samara/petsc/session.hpp"', True),
        ("src/math/d.cpp", '"samara/elements/beam.hpp"', False),
        ("src/math/e.cpp", '"../model/turbine.hpp"', False),
        ("src/math/f.cpp", '"samara/petsc/handle.hpp"', False),
        ("src/petsc/a.cpp", '"samara/math/types.hpp"', False),
        ("include/samara/base/a.hpp", '"samara/math/types.hpp"', False),
        ("include/samara/base/b.hpp.in", '"samara/io/case.hpp"', False),
        ("include/samara/model/a.hpp", '"samara/turbine/turbine_system.hpp"', False),
        ("src/model/b.cpp", "<petscvec.h>", False),
        ("src/analysis/c.cpp", '"samara/turbine/turbine_system.hpp"', False),
        ("src/analysis/d.cpp", '"samara/model/turbine.hpp"', False),
        ("src/analysis/e.cpp", '"samara/elements/beam.hpp"', False),
        ("src/analysis/f.cpp", '"samara/io/case.hpp"', False),
        ("src/analysis/g.cpp", "<hdf5.h>", False),
        ("src/io/d.cpp", "<petscvec.h>", False),
        ("drivers/b.cpp", "<yaml-cpp/yaml.h>", False),
        ("drivers/c.cpp", "<petscsys.h>", False),
        ("src/math/g.cpp", "SOME_HEADER", False),
    ]
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, include, _ in cases:
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"// a file\n  #  include {include}\n", encoding="utf-8")
        (root / "src/other").mkdir()
        (root / "src/other/a.cpp").write_text("", encoding="utf-8")
        faults, _ = find_faults(root)
    expected = {f"{name}:2" for name, _, legal in cases if not legal} | {"src/other/a.cpp"}
    found = {fault.split(": ")[0] for fault in faults}
    assert found == expected, f"missed {expected - found}, wrongly refused {found - expected}"


def main():
    test_itself()
    faults, count = find_faults(pathlib.Path(os.environ["SAMARA_SOURCE_DIR"]))
    print("\n".join(faults) or f"{count} files keep the layering")
    sys.exit(1 if faults or not count else 0)


main()
