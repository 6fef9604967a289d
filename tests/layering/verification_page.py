"""docs/verification.md and its figures are what scripts/verify makes of the data beside them."""

import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(os.environ["SAMARA_SOURCE_DIR"])

command = [sys.executable, ROOT / "scripts/verify", "--drawn", "--check"]
sys.exit(subprocess.run(command, check=False).returncode)
