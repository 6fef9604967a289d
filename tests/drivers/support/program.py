"""Runs the program as its users do, each test in a folder of its own."""

import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

SOURCE = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"])
PROGRAM = os.environ["SAMARA_PROGRAM"]
MPIEXEC = os.environ.get("SAMARA_MPIEXEC", "mpiexec")
BASELINE = SOURCE / "inputs/lee2002/article_mesh.yaml"

LONGEST_RUN = 600  # seconds: only a run that hangs takes longer, on a slow machine too

# The turbine of these tests: a small baseline, quick to solve.
QUICK = ["--set", "blades.elements=2", "--set", "tower.elements=2", "--set", "floquet.steps=24"]

# A blade on a rigid hub, eight lines; tests append from line 9.
MINIMAL = """samara: 1
shaft: {speed: 6}
blades:
  length: 10
  sections:
    - mass: 1
      inertia: [2e-4, 1e-4, 1e-4]
      stiffness: {EA: 1e8, GA2: 4e7, GA3: 4e7, GJ: 8e3, EI2: 1e4, EI3: 1e4}
"""


def wait_until_it_stands(run):
    """Until the program of a process holds signals back or catches them."""
    end = time.monotonic() + LONGEST_RUN
    while run.poll() is None and time.monotonic() < end:
        status = pathlib.Path(f"/proc/{run.pid}/status").read_text(encoding="utf-8")
        fields = dict(line.split(":", 1) for line in status.splitlines())
        if fields["Name"].strip().startswith("samara") and any(
                int(fields.get(key, "0"), 16) >> (signal.SIGINT - 1) & 1 for key in ("SigBlk", "SigCgt")):
            return


class ProgramTest(unittest.TestCase):
    """A test with a temporary folder, in which the program runs."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="samara_test_")
        self.addCleanup(self._folder.cleanup)
        self.folder = pathlib.Path(self._folder.name)

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def files(self):
        """Names and contents of all files of the folder."""
        return {
            str(path.relative_to(self.folder)): path.read_bytes()
            for path in sorted(self.folder.rglob("*"))
            if path.is_file()
        }

    def samara(self, *arguments, ranks=None, stdout=subprocess.PIPE):
        """Runs the program; the result has returncode, stdout and stderr."""
        command = [PROGRAM, *map(str, arguments)]
        if ranks is not None:
            command = [MPIEXEC, "-n", str(ranks), *command]
        return subprocess.run(
            command,
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            stderr=subprocess.PIPE,
            text=True,
            timeout=LONGEST_RUN,
            check=False,
        )

    def succeed(self, *arguments, **options):
        run = self.samara(*arguments, **options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run

    def refuse(self, *arguments, words=(), place=None, code=2, lines=1):
        """The program ends with the code and one clear line, and writes nothing."""
        before = self.files()
        run = self.samara(*arguments)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(len(run.stderr.splitlines()), lines, run.stderr)
        if place is not None:
            self.assertRegex(run.stderr, rf"^{place}")
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, run.stderr)
        self.assertEqual(self.files(), before, "something was written")
        return run
