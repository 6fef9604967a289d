"""Each message that docs/troubleshooting.md quotes is in the sources."""

import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"])
PAGE = "docs/troubleshooting.md"
ROW = re.compile(r"(?m)^\| `([^`]+)` \| ")
LITERAL = re.compile(r'//[^\n]*|/\*.*?\*/|"((?:\\.|[^"\\\n])*)"', re.S)
LEAST_LETTERS = 9  # of the longest part of a message; a shorter one must be a whole string


def strings_of(text):
    """Text of the string literals of C++, adjacent ones joined; all else is a line break."""
    joined, end = [], 0
    for token in LITERAL.finditer(text):
        if token[1] is None:
            continue
        between = re.sub(r"//[^\n]*", "", text[end:token.start()])
        joined.append(("" if not between.strip() else "\n") + re.sub(r'\\(["\\])', r"\1", token[1]))
        end = token.end()
    return "".join(joined)


def parts_of(message):
    """The fixed parts of a quoted message."""
    parts = [part.strip(' ",:;()') for part in message.split("...")]
    return [part for part in parts if len(re.sub(r"\W", "", part)) > 2]


def quoted(page):
    """The messages in the tables of a page."""
    return ROW.findall(page)


def is_in(parts, text):
    """True if all parts are in the strings of a source, and enough of them to know the message."""
    if not all(part in text for part in parts):
        return False
    if any(len(re.sub(r"\W", "", part)) >= LEAST_LETTERS for part in parts):
        return True
    return any(line.strip(' ",:;()') in parts for line in text.splitlines())


def find_faults(page, sources):
    """Messages of the page that are in no source: all parts must be in the same file."""
    texts = [strings_of(source) for source in sources]
    return [message for message in quoted(page)
            if not any(is_in(parts_of(message), text) for text in texts)]


class Messages(unittest.TestCase):
    def test_each_message_is_in_the_sources(self):
        page = (SOURCE / PAGE).read_text(encoding="utf-8")
        files = [path for top in ("src", "include", "drivers") for path in sorted((SOURCE / top).rglob("*.?pp"))]
        self.assertGreater(len(files), 200)
        self.assertGreater(len(quoted(page)), 80)
        self.assertEqual(find_faults(page, [path.read_text(encoding="utf-8") for path in files]), [])

    def test_what_is_found(self):
        source = ('throw InputError(path + ": no such "\n  "file; did you mean \\"" + other + "\\"?");\n'
                  '// throw InputError("a comment here");\nreturn "unusual: " + words;\n')
        for message, is_there in (('no such file; did you mean "..."?', True), ("no such files in the folder", False),
                                  ("no such file...a comment here", False), ("no such", False), ("unusual: ...", True),
                                  ("usual: ...", False), ("...", False)):
            faults = find_faults(f"| `{message}` | meaning | remedy |\n", [source])
            self.assertEqual(faults == [], is_there, message)


if __name__ == "__main__":
    unittest.main()
