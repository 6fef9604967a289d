"""python3 -m samara plot|report|vtk ARGUMENTS: pictures, a page, and files for ParaView of a result."""

import contextlib
import importlib
import io
import os
import signal
import sys

INTERRUPTED = 130  # exit code, 128 + SIGINT
COMMANDS = {"plot": "plot", "report": "report", "vtk": "vtk"}
PACKAGES = ("python3-matplotlib python3-h5netcdf python3-h5py python3-numpy python3-xarray python3-yaml "
            "python3-jsonschema")


def _write(text):
    """Writes to standard output, as samara does: a pipe that nobody reads ends the process by SIGPIPE."""
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGPIPE)
    except OSError:
        os.write(2, b"samara: standard output cannot be written\n")
        os._exit(1)  # the interpreter would try to write again


def _run(arguments):
    """Runs a command to its end, whatever becomes of its lines; the exit code."""
    lines = io.StringIO()
    try:
        module = importlib.import_module(f".{COMMANDS[arguments[0]]}", "samara")
        with contextlib.redirect_stdout(lines):
            return module.main(arguments[1:])
    except ImportError as error:
        return f"samara: {error}; hint: apt install {PACKAGES}"
    except KeyboardInterrupt:
        print("samara: interrupted", file=sys.stderr)
        return INTERRUPTED
    finally:
        _write(lines.getvalue())


if __name__ == "__main__":
    if sys.argv[1:2] == [] or sys.argv[1] not in COMMANDS:
        sys.exit(f"usage: python3 -m samara {'|'.join(COMMANDS)} RESULT.h5 [options]; --help of each explains it")
    sys.exit(_run(sys.argv[1:]))
