"""python3 -m samara plot|report|vtk ARGUMENTS: pictures, a page, and files for ParaView of a result."""

import importlib
import sys

INTERRUPTED = 130  # exit code, 128 + SIGINT
COMMANDS = {"plot": "plot", "report": "report", "vtk": "vtk"}
PACKAGES = ("python3-matplotlib python3-h5netcdf python3-h5py python3-numpy python3-xarray python3-yaml "
            "python3-jsonschema")

if __name__ == "__main__":
    if sys.argv[1:2] == [] or sys.argv[1] not in COMMANDS:
        sys.exit(f"usage: python3 -m samara {'|'.join(COMMANDS)} RESULT.h5 [options]; --help of each explains it")
    try:
        module = importlib.import_module(f".{COMMANDS[sys.argv[1]]}", "samara")
        sys.exit(module.main(sys.argv[2:]))
    except ImportError as error:
        sys.exit(f"samara: {error}; hint: apt install {PACKAGES}")
    except KeyboardInterrupt:
        print("samara: interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
