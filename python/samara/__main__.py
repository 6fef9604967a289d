"""python3 -m samara plot RESULT.h5 [KIND ...]"""

import sys

if __name__ == "__main__":
    try:
        from .plot import main
    except ImportError as error:
        sys.exit(f"samara: {error}; hint: apt install python3-matplotlib python3-h5netcdf python3-xarray "
                 "python3-yaml python3-jsonschema")
    if sys.argv[1:2] != ["plot"]:
        sys.exit("usage: python3 -m samara plot RESULT.h5 [KIND ...]; python3 -m samara plot --help")
    sys.exit(main(sys.argv[2:]))
