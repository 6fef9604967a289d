"""Analyses decide by typed metadata: in their rooms no decision is taken from the text of a name, and
no word of a turbine's parts stands in the code (CONTRIBUTING.md)."""

import os
import pathlib
import re
import unittest

ROOMS = ["analysis", "linear", "loads"]
TOKENS = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", re.DOTALL)
PARTS = re.compile(r"yaw|teeter|tower|nacelle", re.IGNORECASE)
# In code: the key's value, and what is multiblade.
BLADE = re.compile(r"blade", re.IGNORECASE)
ALLOWED = re.compile(r"FloquetPeriod::blade|enum class FloquetPeriod[^;]*;|\w*multiblade\w*",
                     re.IGNORECASE)
TEXT = r"(?:\.|->)(?:name|label|family|quantity|part|direction)\b(?:\(\))?"
DECISION = re.compile(rf"{TEXT}\s*[=!]=(?!=)|[=!]=\s*[\w.\[\]>-]*{TEXT}(?![\w.(])|[=!]=\s*\"\"|"
                      r"\b(?:starts_with|ends_with|contains)\(\"\"")


def strip(text, keep_strings=False):
    """Code without comments; without the content of strings, unless they are kept."""
    def replace(match):
        token = match.group(0)
        if token.startswith('"'):
            return token if keep_strings else '""'
        return " " + "\n" * token.count("\n")
    return TOKENS.sub(replace, text)


def find_faults(text, is_multiblade=False):
    """Line and words of what is not allowed."""
    faults = []
    code = ALLOWED.sub("", strip(text))
    for number, line in enumerate(strip(text, keep_strings=True).splitlines(), 1):
        if not line.lstrip().startswith("#") and PARTS.search(line):
            faults.append((number, "a part of a turbine"))
    for number, line in enumerate(code.splitlines(), 1):
        if not is_multiblade and BLADE.search(line):
            faults.append((number, "a blade"))
        if DECISION.search(line):
            faults.append((number, "a decision by the text of a name"))
    return faults


class Names(unittest.TestCase):
    def test_analyses_know_no_parts_and_no_names(self):
        root = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"])
        files = [
            path
            for room in ROOMS
            for top in (root / "include" / "samara" / room, root / "src" / room)
            for path in sorted(top.glob("*.?pp"))
        ]
        self.assertGreater(len(files), 40)
        faults = [
            f"{path.relative_to(root)}:{number}: {what}"
            for path in files
            for number, what in find_faults(path.read_text(encoding="utf-8"),
                                            path.stem == "multiblade")
        ]
        self.assertEqual(faults, [])

    def test_what_is_found(self):
        for text in ['if (unknown.name() == "yaw angle") return;', "if (a.name == b.name) {",
                     "int tower_top = 0;", 'throw InputError("the nacelle");', "int blades = 3;",
                     'if (unknown.quantity == "angle") {', "if (one.family() != other.family())",
                     'if (name.starts_with("blade 1")) {']:
            self.assertNotEqual(find_faults(text), [], text)
        for text in ["// the yaw of the tower", 'throw InputError("a stiffer blade");',
                     "if (period == FloquetPeriod::blade) {", "add_multiblade();",
                     "if (unknown.role == system::UnknownRole::state) {",
                     "if (a.owner == b.owner) {", "names == other_names"]:
            self.assertEqual(find_faults(text), [], text)


if __name__ == "__main__":
    unittest.main()
