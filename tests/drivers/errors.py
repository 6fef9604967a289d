"""Input errors end with exit code 2, one clear line, and nothing written."""

import os
import pathlib
import sys
import unittest

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import BASELINE, MINIMAL, SOURCE, ProgramTest  # noqa: E402

COMMANDS = ["check", "modes", "trim", "floquet"]


class Cases(ProgramTest):
    """The case file itself."""

    def refuse_text(self, text, words, line=None, lines=1):
        """Every command refuses the case, at the line where there is one."""
        self.write("case.yaml", text)
        place = r"case\.yaml:" if line is None else rf"case\.yaml:{line}:\d+: "
        for command in COMMANDS:
            with self.subTest(command=command):
                self.refuse(command, "case.yaml", words=words, place=place, lines=lines)

    def test_missing_file(self):
        self.refuse("floquet", "case.yaml", words="no such file", place=r"case\.yaml:")

    def test_missing_suffix_is_suggested(self):
        self.write("case.yaml", MINIMAL)
        self.refuse("floquet", "case", words='did you mean "case.yaml"?')

    def test_directory(self):
        os.mkdir(self.folder / "case.yaml")
        self.refuse("floquet", "case.yaml", words="a directory", place=r"case\.yaml:")

    def test_empty_file(self):
        self.refuse_text("", "empty")

    def test_random_bytes(self):
        self.refuse_text(bytes(range(256)) * 8, "not a text file", line=1)

    def test_yaml_syntax_error(self):
        self.refuse_text(MINIMAL + "gravity: [1, 2\n", "not valid YAML", line=r"\d+")

    def test_unknown_key(self):
        self.refuse_text(MINIMAL + "gravty: 9.81\n", 'did you mean "gravity"?', line=9)

    def test_duplicate_key(self):
        self.refuse_text(MINIMAL + "gravity: 0\ngravity: 9.81\n", "gravity", line=10)

    def test_two_spellings_of_one_key(self):
        text = MINIMAL.replace("{speed: 6}", "{speed: 6, speed_rpm: 57}")
        self.refuse_text(text, ["speed_rpm", "leave one of them out"], line=2)

    def test_wrong_type(self):
        self.refuse_text(MINIMAL + "gravity: strong\n", ["a number", '"strong"'], line=9)

    def test_wrong_length_of_a_list(self):
        text = MINIMAL.replace("[2e-4, 1e-4, 1e-4]", "[2e-4, 1e-4]")
        self.refuse_text(text, "inertia", line=7)

    def test_mass_that_is_not_positive(self):
        for mass in ("-1", "0"):
            text = MINIMAL.replace("mass: 1\n", f"mass: {mass}\n")
            self.refuse_text(text, ["mass", "> 0"], line=6)

    def test_indefinite_stiffness(self):
        matrix = [[1e4 if i == j else 0 for j in range(6)] for i in range(6)]
        matrix[4][5] = matrix[5][4] = 2e4
        stiffness = MINIMAL.splitlines()[7].strip()
        text = MINIMAL.replace(stiffness, f"stiffness_matrix: {matrix}")
        self.refuse_text(text, "positive definite", line=r"\d+")

    def test_negative_stiffness(self):
        self.refuse_text(MINIMAL.replace("GJ: 8e3", "GJ: -8e3"), ["GJ", "> 0"], line=8)

    def test_nan(self):
        self.refuse_text(MINIMAL + "gravity: .nan\n", "gravity", line=9)

    def test_no_elements(self):
        text = MINIMAL.replace("length: 10", "length: 10\n  elements: 0")
        self.refuse_text(text, "elements", line=5)

    def test_no_blades(self):
        for count in (0, -2):
            text = MINIMAL.replace("length: 10", f"length: 10\n  count: {count}")
            self.refuse_text(text, "count", line=5)

    def test_version_of_the_future(self):
        text = MINIMAL.replace("samara: 1", "samara: 99")
        self.refuse_text(text, ["newer", "99"], line=1)

    def test_all_errors_come_at_once(self):
        text = MINIMAL.replace("mass: 1\n", "mass: -1\n") + "gravty: 1\n"
        self.refuse_text(text, ["mass", "gravty"], lines=2)


class Settings(ProgramTest):
    """--set"""

    def test_unknown_key(self):
        setting = "blades.elments=8"
        self.refuse("floquet", BASELINE, "--set", setting, words='did you mean "elements"?',
                    place=rf"--set {setting}: ")

    def test_wrong_value(self):
        self.refuse("floquet", BASELINE, "--set", "gravity=much", words=["gravity", "a number"])

    def test_no_value(self):
        self.refuse("floquet", BASELINE, "--set", "gravity", words="key=value")

    def test_nothing_behind_it(self):
        self.refuse("floquet", BASELINE, "--set", words="key=value", place="samara: ")


class Physics(ProgramTest):
    """A case that the command cannot treat."""

    def test_floquet_needs_a_speed(self):
        self.write("case.yaml", MINIMAL.replace("speed: 6", "speed: 0"))
        self.refuse("floquet", "case.yaml", words=["shaft.speed: must not be 0", "use samara modes"],
                    place=r"case\.yaml:2:9: ")

    def test_modes_need_constant_coefficients(self):
        self.refuse("modes", BASELINE, words=["periodic", "samara floquet, or samara modes --parked"])

    def test_a_line_that_turns_back_and_masses_too_near(self):
        text = MINIMAL.replace("length: 10", "reference_line: [[0, 0, 0], [-10, 0, 0.3]]")
        self.write("case.yaml", text)
        self.refuse("check", "case.yaml", words=["reference_line", "turns back"])
        masses = "length: 10\n  point_masses: [{at: 0.5, mass: 1}, {at: 0.51, mass: 1}]"
        self.write("case.yaml", MINIMAL.replace("length: 10", masses))
        self.refuse("check", "case.yaml", words=["point masses", "increase elements"])


# A blade for which the matrix of harmonic balance needs more room than MUMPS estimates.
HEAVY_TIP = """samara: 1
gravity: 0
shaft: {speed: 8}
blades:
  length: 31.623
  tip_mass: 3162.3
  elements: 8
  order: 3
  sections:
    - mass: 100
      inertia: [2e-2, 1e-2, 1e-2]
      stiffness: {EA: 1e10, GA2: 4e9, GA3: 4e9, GJ: 1e8, EI2: 1e8, EI3: 1e8}
"""

# Blades whose tangents have entries that vanish at most states but for round-off.
WHIRLING = """samara: 1
gravity: 9.81
shaft: {speed: 18.949601294659434}
hub: {radius: 0.25}
blades:
  length: 5
  tip_mass: 75
  elements: 4
  order: 2
  sections:
    - mass: 300
      inertia: [0.04, 0.02, 0.02]
      stiffness: {EA: 6e10, GA2: 2e10, GA3: 2e10, GJ: 2e6, EI2: 4e6, EI3: 1.3e7}
"""


class Solvers(ProgramTest):
    """Requests that a solver cannot fulfil have a message of their own; the others are fulfilled."""

    def test_a_work_array_that_is_too_small_is_no_singular_matrix(self):
        self.write("case.yaml", HEAVY_TIP)
        small = ["-trim_mat_mumps_icntl_14", "-50"]
        self.refuse("trim", "case.yaml", *small, code=3,
                    words=["INFOG(1) = -9", "work array", "hint: a larger -trim_mat_mumps_icntl_14"])
        run = self.succeed("trim", "case.yaml")
        self.assertEqual(run.stderr, "")

    def test_options_of_the_trim_do_as_petsc_says(self):
        for options, solver in (
                ([], "gmres, "),
                (["-trim_ksp_type", "bcgs"], "bcgs, "),
                (["-trim_snes_mf_operator"], "gmres, "),
                (["-trim_snes_mf"], "gmres, "),
                (["-trim_ksp_type", "gmres", "-trim_pc_type", "lu"], "gmres, "),
                (["-trim_ksp_type", "preonly"], "lu (mumps)")):
            run = self.succeed("trim", BASELINE, "--set", "gravity=9.81", *options)
            self.assertIn("\nlinear       " + solver, run.stdout)

    def test_a_factorization_without_pivoting_names_its_zero_pivot(self):
        self.refuse("trim", BASELINE, "--set", "gravity=9.81", "-trim_pc_factor_mat_solver_type",
                    "petsc", code=3, words=["FACTOR_NUMERIC_ZEROPIVOT",
                                            "hint: -trim_pc_factor_mat_solver_type mumps"])

    def test_values_that_petsc_refuses_are_input_errors(self):
        for command, option, value, word in (("trim", "-trim_snes_rtol", "abc", "abc has no numeric"),
                                             ("trim", "-trim_ksp_type", "best", "KSP type best"),
                                             ("modes", "-modes_ksp_type", "best", "KSP type best"),
                                             ("floquet", "-floquet_eps_type", "best", "best"),
                                             ("transient", "-transient_ts_type", "best", "best")):
            beams = {"modes": "rotating.yaml", "transient": "spun_up.yaml"}
            case = SOURCE / "inputs/beam" / beams[command] if command in beams else BASELINE
            self.refuse(command, case, option, value,
                        words=[f"options {option[:option.index('_') + 1]}...", word, "hint: "])

    def test_options_that_the_solvers_cannot_follow_are_refused(self):
        for option, value, word in (("-mat_type", "dense", "fixed"),
                                    ("-trim_mat_type", "baij", "fixed"),
                                    ("-floquet_mat_type", "aij", "fixed"),
                                    ("-vec_type", "mpi", "fixed"),
                                    ("-trim_snes_fd", None, "exact")):
            self.refuse("trim", BASELINE, option, *([value] if value else []),
                        place=f"samara: {option}: ", words=[word])
        self.refuse("trim", BASELINE, "-trim_ksp_type", "cg", words=["does not support"])

    def test_entries_that_only_rounding_makes_are_in_the_pattern(self):
        self.write("case.yaml", WHIRLING)
        self.succeed("trim", "case.yaml")

    def test_a_partial_spectrum_is_refused_before_anything_is_solved(self):
        self.write("case.yaml", MINIMAL)
        for command in ("floquet", "modes"):
            for option in (["nev", "10"], ["largest_magnitude"], ["target", "1"], ["hermitian"]):
                name = f"-{command}_eps_{option[0]}"
                self.refuse(command, "case.yaml", name, *option[1:], place=f"samara: {name}: ",
                            words=["all eigenvalues are computed", "hint: "])

    def test_an_unstable_order_is_refused(self):
        series = ["--set", "transient={duration: 0.1, step: 0.01}"]
        self.write("case.yaml", MINIMAL)
        for order in (3, 6):
            self.refuse("transient", "case.yaml", *series, "-transient_ts_bdf_order", order,
                        place=f"samara: -transient_ts_bdf_order {order}: ",
                        words=["unstable", "hint: "])
        self.succeed("transient", "case.yaml", *series, "-transient_ts_bdf_order", 2)


class Results(ProgramTest):
    """Where the result goes."""

    def refuse_path(self, path, words):
        for option in ("-o", "--csv"):
            with self.subTest(option=option):
                self.refuse("floquet", BASELINE, option, path, words=words)

    def test_missing_folder(self):
        self.refuse_path("missing/x", "there is no folder missing")

    def test_folder_that_is_a_file(self):
        self.write("file", "")
        self.refuse_path("file/x", "file is not a folder")

    def test_folder(self):
        os.mkdir(self.folder / "results")
        self.refuse_path("results", "a folder")

    def test_device(self):
        self.refuse_path("/dev/null", "not a plain file")

    def test_file_of_the_user(self):
        self.write("notes", "my notes\n")
        self.refuse_path("notes", "it would be lost")

    def test_hdf5_of_another_program(self):
        with h5py.File(self.folder / "other.h5", "w") as file:
            file["x"] = [1, 2, 3]
        self.refuse("floquet", BASELINE, "-o", "other.h5", words=["another program", "hint"])

    def test_case_as_result(self):
        self.write("case.yaml", MINIMAL)
        self.refuse("floquet", "case.yaml", "-o", "case.yaml", words="it would be lost")

    def test_default_path(self):
        self.write("sub/case.yaml", MINIMAL)
        self.write("case.h5", "not a result")
        self.refuse("floquet", "sub/case.yaml", words=["case.h5", "it would be lost"])

    def test_write_protection(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        os.chmod(self.folder, 0o500)
        self.addCleanup(os.chmod, self.folder, 0o700)
        self.refuse_path("x", "no permission")


class CommandLine(ProgramTest):
    """Faults of the command line."""

    def test_nothing(self):
        self.refuse(words=["missing command", "check, static, modes, trim, floquet"])

    def test_unknown_command(self):
        self.refuse("floqet", BASELINE, words='did you mean "floquet"?')
        self.refuse("xyzzy", BASELINE, words="the commands are")

    def test_missing_case(self):
        for command in COMMANDS:
            self.refuse(command, words=["missing case file", f"samara {command} --help"])

    def test_case_taken_for_the_value_of_an_option(self):
        self.refuse("floquet", "-floquet_ksp_view", BASELINE, words="value of -floquet_ksp_view")

    def test_two_cases(self):
        self.refuse("floquet", BASELINE, "other.yaml", words='unexpected argument "other.yaml"')

    def test_unknown_option(self):
        self.refuse("floquet", BASELINE, "--sett", "a=1", words='did you mean "--set"?')
        self.refuse("floquet", BASELINE, "--xyzzy", words="samara --help")

    def test_own_option_with_one_dash(self):
        self.refuse("floquet", BASELINE, "-set", "a=1", words='did you mean "--set"?')

    def test_option_without_its_value(self):
        for option in ("-o", "--csv"):
            self.refuse("floquet", BASELINE, option, words="needs a path")

    def test_option_given_twice(self):
        self.refuse("floquet", BASELINE, "-o", "a.h5", "-o", "b.h5", words="given twice")

    def test_one_path_for_two_files(self):
        self.refuse("floquet", BASELINE, "-o", "a", "--csv", "a", words="the same file")

    def test_table_of_check(self):
        self.refuse("check", BASELINE, "--csv", "a.csv", words="no table")


unittest.main()
