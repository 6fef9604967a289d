"""samara schema: what the JSON Schema accepts and refuses, and the tables that are made from it."""

import copy
import json
import os
import random
import re
import subprocess
import sys
import unittest

import jsonschema
import yaml
from support.program import PROGRAM, SOURCE, ProgramTest


class Loader(yaml.SafeLoader):
    """YAML 1.2: 1e7 is a number, yes is a word."""


Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in all if "float" not in tag and "bool" not in tag]
    for first, all in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(
    r"^[-+]?(\d+\.\d*|\.\d+|\d+(?=[eE]))([eE][-+]?\d+)?$"), list("-+.0123456789"))
Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), list("tf"))


def load(text):
    return yaml.load(text, Loader)


def with_text_keys(node):
    """JSON has no keys but texts."""
    if isinstance(node, dict):
        return {str(key): with_text_keys(value) for key, value in node.items()}
    return [with_text_keys(value) for value in node] if isinstance(node, list) else node


class Schema(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        text = subprocess.run([PROGRAM, "schema"], check=True, capture_output=True).stdout
        cls.schema = json.loads(text)
        jsonschema.Draft7Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft7Validator(cls.schema)
        cls.cases = {path: with_text_keys(load(path.read_text(encoding="utf-8")))
                     for path in sorted((SOURCE / "inputs").rglob("*.yaml"))}

    def test_accepts_all_inputs(self):
        self.assertGreater(len(self.cases), 10)
        for path, case in self.cases.items():
            errors = [error.message for error in self.validator.iter_errors(case)]
            self.assertEqual(errors, [], path)

    def test_refuses(self):
        case = next(case for path, case in self.cases.items() if path.name == "baseline.yaml")
        for change in ("blades.count=0", "blades.length=0", "blades.lenght=3", "shaft.tilt_deg=90",
                       "shaft.speed_rpm=3", "trim.harmonics=some", "samara=2", "hub=[]",
                       "blades.sections=[]", "transient.step=1", "loads=[{beam: tower}]",
                       "blades.pitch_actuator.frequency=3", "tower.support=free",
                       "static.method=newton", "blades.each.one.pitch_deg=3"):
            changed = copy.deepcopy(case)
            path, value = change.split("=", 1)
            node = changed
            *outer, last = path.split(".")
            for key in outer:
                node = node.setdefault(key, {})
            node[last] = load(value)
            self.assertFalse(self.validator.is_valid(changed), change)

    def test_refuses_nothing_that_the_program_accepts(self):
        """Numbers, words and keys of the inputs change places; seed printed where it fails."""
        seed = int(os.environ.get("SEED", "1"))
        draw = random.Random(seed)
        cases = [case for case in self.cases.values() if len(json.dumps(case)) < 20000]
        values = [0, -1, 1, 2.5, 200, "free", "rigid", "locked", "auto", "clamped", True, [1, 2],
                  [0, 0, 0], {}, [[0, 1], [1, 2]]]
        accepted = refused = 0
        for trial in range(80):
            case = copy.deepcopy(draw.choice(cases))
            places = list(places_of(case))
            node, key = draw.choice(places)
            other, its_key = draw.choice(places)
            node[key] = copy.deepcopy(draw.choice([*values, *[other[its_key]] * 10]))
            file = self.write(f"case{trial}.yaml", json.dumps(case))
            program = self.samara("check", file)
            is_valid = self.validator.is_valid(case)
            self.assertIn(program.returncode, (0, 2))
            if program.returncode == 0:
                self.assertTrue(is_valid, f"seed {seed} trial {trial}: "
                                f"{[e.message for e in self.validator.iter_errors(case)]}")
                accepted += 1
            refused += not is_valid
        self.assertGreater(accepted, 4)
        self.assertGreater(refused, 5)

    def test_tables_of_the_documents(self):
        script = subprocess.run([SOURCE / "scripts/case_tables", "--check"], capture_output=True,
                                text=True, check=False, env={**os.environ, "SAMARA": PROGRAM})
        self.assertEqual(script.returncode, 0, script.stderr)

    def test_takes_nothing(self):
        self.refuse("schema", "case.yaml", words="takes none")
        self.refuse("schema", "-o", "x.json", words="takes no options")


def places_of(node):
    for key in list(node) if isinstance(node, dict) else range(len(node)):
        yield node, key
        if isinstance(node[key], (dict, list)):
            yield from places_of(node[key])


if __name__ == "__main__":
    sys.exit(unittest.main())
