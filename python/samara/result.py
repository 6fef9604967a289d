"""Result files as labelled arrays."""

import pathlib

import h5py
import xarray


class Result:
    """A result of the program: its groups as xarray.Dataset.

    Each variable has the attributes unit, frame and description; each axis has a name and, where the file lists its
    entries, coordinates. Complex numbers have an axis re_im; `complex_of` joins it.
    """

    def __init__(self, path):
        self.path = pathlib.Path(path)
        with h5py.File(self.path) as file:
            if "samara_schema" not in file.attrs:
                raise ValueError(f"{path}: is no result of samara")
            self.attributes = {name: value for name, value in file.attrs.items()}
            self.groups = [name for name, item in file.items() if isinstance(item, h5py.Group)]
        self._datasets = {}

    def __repr__(self):
        return f"Result({str(self.path)!r}): {', '.join(self.groups)}"

    def __contains__(self, group):
        if "/" not in group:
            return group in self.groups
        with h5py.File(self.path) as file:
            return isinstance(file.get(group), h5py.Group)

    def __getitem__(self, group):
        """The variables of a group, "floquet" or "model/unknowns". Read once."""
        if group not in self._datasets:
            if group not in self:
                raise KeyError(f"{self.path} has no /{group}; it has {', '.join(self.groups)}")
            with xarray.open_dataset(self.path, group=group, engine="h5netcdf",
                                     phony_dims="access") as dataset:
                self._datasets[group] = dataset.load()
        return self._datasets[group]

    @property
    def title(self):
        return self.attributes.get("title", "") or self.path.stem

    @property
    def command_line(self):
        return self.attributes.get("command_line", "")

    @property
    def case(self):
        """The text of the case as it was run, with its --set arguments as comments at the top."""
        with h5py.File(self.path) as file:
            return file["/case"].asstr()[()]

    @property
    def modes(self):
        """The group of the modes, /floquet or /modes."""
        for group in ("floquet", "modes"):
            if group in self:
                return self[group]
        raise KeyError(f"{self.path} has no modes")


def complex_of(array):
    """The complex numbers of an array with an axis re_im."""
    return array.isel(re_im=0, drop=True) + 1j * array.isel(re_im=1, drop=True)


def unit_of(array):
    """Its unit, empty for a pure number."""
    unit = array.attrs.get("unit", "")
    return "" if unit == "1" else unit


def open_result(path):
    """The result at a path. Raises OSError or ValueError where there is none, with a hint."""
    try:
        return Result(path)
    except FileNotFoundError as error:
        raise FileNotFoundError(f"{path}: no such file; hint: samara floquet CASE.yaml -o {path}") from error
    except OSError as error:
        raise OSError(f"{path}: cannot be read as a result; hint: the .h5 of a run") from error
