"""Every test of the executables is in an entry of ctest."""

import collections
import json
import pathlib
import subprocess
import unittest


def top_level_tests(executable):
    """Suites and cases that stand outermost, as the executable lists them."""
    run = subprocess.run([executable, "--list_content"], capture_output=True, text=True, check=True)
    lines = (run.stderr + run.stdout).splitlines()
    return {line.rstrip("*") for line in lines if line and not line.startswith(" ")}


class Entries(unittest.TestCase):
    def test_each_test_is_in_one(self):
        build = pathlib.Path.cwd().parent  # ctest starts in build/tests
        run = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"],
                             capture_output=True, text=True, check=True)
        listed = collections.defaultdict(set)
        for entry in json.loads(run.stdout)["tests"]:
            command = entry.get("command", [])
            for word in command:
                if word.startswith("--run_test="):
                    executable = command[command.index(word) - 1]
                    listed[executable] |= set(word.removeprefix("--run_test=").split(","))
        self.assertGreater(len(listed), 10)
        for executable, names in listed.items():
            with self.subTest(executable=pathlib.Path(executable).name):
                self.assertEqual(names, top_level_tests(executable))


if __name__ == "__main__":
    unittest.main()
