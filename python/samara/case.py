"""Case files as objects."""

import copy
import functools
import json
import pathlib
import re
import subprocess

import jsonschema
import yaml

from .program import find_program


class CaseError(ValueError):
    """A case that the schema does not accept; `errors`: one line each, key and reason."""

    def __init__(self, errors):
        super().__init__("\n".join(errors))
        self.errors = errors


class _Loader(yaml.SafeLoader):
    """YAML 1.2 as the program reads it: numbers such as 1e5 are no texts."""


_Loader.yaml_implicit_resolvers = copy.deepcopy(yaml.SafeLoader.yaml_implicit_resolvers)
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?$"),
    list("-+0123456789."))


@functools.cache
def schema():
    """The JSON Schema of case files, of the program that is found."""
    return json.loads(subprocess.run([find_program(), "schema"], capture_output=True, text=True, check=True).stdout)


class Case:
    """Keys and values of a case file, by their paths.

        case = samara.Case.read("turbine.yaml")
        case["blades.elements"] = 8
        case.validate()
        samara.run(case, "floquet")
    """

    def __init__(self, values=None, folder="."):
        self.values = values if values is not None else {"samara": 1}
        self.folder = pathlib.Path(folder).resolve()  # of relative paths in it

    @classmethod
    def read(cls, path):
        path = pathlib.Path(path)
        return cls(yaml.load(path.read_text(encoding="utf-8"), _Loader), path.parent)

    def _walk(self, path):
        node = self.values
        words = str(path).split(".")
        for word in words[:-1]:
            node = node[int(word)] if isinstance(node, list) else node.setdefault(word, {})
        return node, int(words[-1]) if isinstance(node, list) else words[-1]

    def __getitem__(self, path):
        node = self.values
        for word in str(path).split("."):
            node = node[int(word)] if isinstance(node, list) else node[word]
        return node

    def __setitem__(self, path, value):
        node, key = self._walk(path)
        node[key] = value

    def __delitem__(self, path):
        node, key = self._walk(path)
        del node[key]

    def __contains__(self, path):
        try:
            self[path]
        except (KeyError, IndexError, ValueError, TypeError):
            return False
        return True

    def copy(self):
        return Case(copy.deepcopy(self.values), self.folder)

    def validate(self):
        """Checks keys, types and ranges by the schema. Raises CaseError with all faults.

        The program checks more, such as files and the mechanics of the model: `samara check`.
        """
        validator = jsonschema.Draft7Validator(schema())
        errors = []
        for error in sorted(validator.iter_errors(self.values), key=lambda found: list(map(str, found.path))):
            place = ".".join(str(word) for word in error.absolute_path) or "case"
            errors.append(f"{place}: {error.message if len(error.message) < 200 else error.validator + ' not met'}")
        if errors:
            raise CaseError(errors)

    def write(self, path):
        """Writes the file and returns its path."""
        path = pathlib.Path(path)
        path.write_text(yaml.safe_dump(self.values, sort_keys=False), encoding="utf-8")
        return path
