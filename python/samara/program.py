"""Runs the program."""

import os
import pathlib
import shlex
import shutil
import subprocess
import tempfile
import weakref

from .result import Result


class ProgramError(RuntimeError):
    """The program ended with an error: `code` 2 for its input, 3 for a computation (docs/case_file.md)."""

    def __init__(self, code, message, result=None):
        super().__init__(message.strip() or f"samara ended with exit code {code}")
        self.code = code
        self.result = result  # where one was written all the same


def find_program():
    """The path of the program: SAMARA in the environment, the one of this checkout, or the one in PATH.

    Raises FileNotFoundError.
    """
    named = os.environ.get("SAMARA")
    if named:
        return named
    built = pathlib.Path(__file__).resolve().parents[2] / "build" / "samara"
    if built.exists():
        return str(built)
    found = shutil.which("samara")
    if found is None:
        raise FileNotFoundError("samara is not in PATH; SAMARA in the environment may name it")
    return found


def words_of(value):
    """A value of the case as --set takes it: YAML on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {words_of(item)}" for key, item in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(words_of(item) for item in value) + "]"
    return repr(float(value)) if isinstance(value, float) else str(value)


def sweep_of(sweep):
    """KEY=VALUES of a pair of a key and its values."""
    if isinstance(sweep, str):
        return sweep
    key, values = sweep
    return f"{key}=" + ",".join(repr(float(value)) for value in values)


def run(case, command="floquet", *, set=None, sweep=None, output=None, ranks=1, options=(), check=True):
    """Runs `samara COMMAND CASE` and returns its Result, or None where the command writes none.

    case: path, or a Case. set: keys of the case and their values, {"blades.elements": 8}. sweep: of the command
    campbell, "KEY=FROM:TO:STEP" or (key, values). output: path of the result; without it a temporary file that lasts
    as long as the Result. options: further arguments, of PETSc too. check: raise ProgramError where the exit code is
    not 0; otherwise only where there is no result.
    """
    folder = None if output else tempfile.mkdtemp(prefix="samara_")
    path = pathlib.Path(output) if output else pathlib.Path(folder) / "result.h5"
    written = None
    if not isinstance(case, (str, os.PathLike)):
        # In its own folder, from where the files that it names are found.
        handle, name = tempfile.mkstemp(prefix=".samara_", suffix=".yaml", dir=case.folder)
        os.close(handle)
        case = written = case.write(name)
    arguments = [find_program(), command, str(case), "-o", str(path)]
    for key, value in (set or {}).items():
        arguments += ["--set", f"{key}={words_of(value)}"]
    if sweep is not None:
        arguments += ["--sweep", sweep_of(sweep)]
    arguments += [str(option) for option in options]
    if ranks > 1:
        arguments = shlex.split(os.environ.get("SAMARA_MPIEXEC", "mpirun")) + ["-n", str(ranks), *arguments]
    before = path.stat().st_mtime_ns if path.exists() else None
    try:
        done = subprocess.run(arguments, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    finally:
        if written is not None:
            written.unlink()
    result = None
    if path.exists() and path.stat().st_mtime_ns != before:
        result = Result(path)
        result.output = done.stdout
        result.messages = done.stderr
    if folder is not None:
        if result is None:
            shutil.rmtree(folder)
        else:
            weakref.finalize(result, shutil.rmtree, folder)
    if done.returncode != 0 and (check or result is None):
        raise ProgramError(done.returncode, done.stderr, result)
    return result
