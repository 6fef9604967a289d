"""The tree stands on its own: no file names the folder beside the checkout or a path of the machine
it was written on. The one exception is the line of .ci/run that looks for the turbine decks."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

OUTSIDE = re.compile(r"\.\./" + r"shared|(?<![\w.~/-])/" + r"work(?![-\w])")
EXCEPTION = ".ci/run"  # one line


def list_files(root):
    """The files that are, or would be, in the repository; without git, all but builds."""
    git = ["git", "-c", f"safe.directory={root}", "-C", str(root)]
    if (root / ".git").exists() and shutil.which("git"):
        listing = subprocess.run(
            git + ["ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            capture_output=True,
            text=True,
            check=False,
        )
        if listing.returncode == 0:
            return [root / name for name in listing.stdout.split("\0") if name]
    return [
        path
        for path in root.rglob("*")
        if not re.match(r"(\.git|build[^/]*)(/|$)", path.relative_to(root).as_posix())
    ]


def find_faults(root):
    """All mentions, as `file:line: text`."""
    faults = []
    exceptions = 0
    for path in sorted(list_files(root)):
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
        except (UnicodeDecodeError, OSError):
            continue
        name = path.relative_to(root).as_posix()
        for number, line in enumerate(lines, 1):
            if not OUTSIDE.search(line):
                continue
            if name == EXCEPTION and not exceptions:
                exceptions += 1
            else:
                faults.append(f"{name}:{number}: {line.strip()}")
    return faults


def test_itself():
    """Plants mentions in a tree of its own: exactly these are found."""
    folder_beside, machine = "../" + "shared", "/" + "work"
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / ".ci").mkdir()
        (root / "build").mkdir()
        (root / "build/log").write_text(f"{machine}/main\n", encoding="utf-8")
        (root / EXCEPTION).write_text(f"{folder_beside}/a\n{folder_beside}/b\n", encoding="utf-8")
        (root / "a.md").write_text(f"x\nsee {folder_beside}/design\n", encoding="utf-8")
        (root / "b.cpp").write_text(f'"{machine}/main/x"\n{machine}\n', encoding="utf-8")
        (root / "c.md").write_text("frame/work, /workspace, ~/work, /work-a and some/work/too\n", encoding="utf-8")
        found = {fault.split(": ")[0] for fault in find_faults(root)}
    expected = {f"{EXCEPTION}:2", "a.md:2", "b.cpp:1", "b.cpp:2"}
    assert found == expected, f"missed {expected - found}, wrongly refused {found - expected}"


def main():
    test_itself()
    faults = find_faults(pathlib.Path(os.environ["SAMARA_SOURCE_DIR"]))
    print("\n".join(faults) or "no mention")
    sys.exit(1 if faults else 0)


main()
