"""The reference of the library's headers is made without a warning."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"])


def reference(folder, source=SOURCE):
    """Warnings of Doxygen on the headers of `source`."""
    settings = (SOURCE / "docs" / "Doxyfile").read_text(encoding="utf-8")
    return subprocess.run(["doxygen", "-"], cwd=source, capture_output=True, text=True,
                          input=settings + f"\nOUTPUT_DIRECTORY = \"{folder}\"\n", check=False)


class Reference(unittest.TestCase):
    def test_no_warning(self):
        with tempfile.TemporaryDirectory() as folder:
            run = reference(folder)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            pages = list((pathlib.Path(folder) / "html").glob("*.html"))
            self.assertGreater(len(pages), 150)

    def test_a_wrong_word_is_seen(self):
        with tempfile.TemporaryDirectory() as folder:
            header = pathlib.Path(folder) / "include" / "samara" / "wrong.hpp"
            header.parent.mkdir(parents=True)
            header.write_text("/// \\param there is none\nint wrong(int here);\n", encoding="utf-8")
            run = reference(folder, folder)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn("there", run.stderr)


if __name__ == "__main__":
    unittest.main()
