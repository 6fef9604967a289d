"""Results, runs, cases and pictures of Samara.

    import samara
    result = samara.run("inputs/lee2002/baseline.yaml", "floquet", set={"gravity": 9.81})
    result["floquet"]["frequency_hz"]                  # an xarray.DataArray with its unit
    samara.plot.draw(result, "multipliers.svg")

Units, coordinates and names come from the files.
"""

from . import plot
from .case import Case, CaseError
from .program import ProgramError, find_program, run
from .result import Result, open_result

__all__ = ["Case", "CaseError", "ProgramError", "Result", "find_program", "open_result", "plot", "run"]
