"""Help, version, PETSc options, exit codes and streams."""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import (  # noqa: E402
    BASELINE,
    LONGEST_RUN,
    MINIMAL,
    PROGRAM,
    QUICK,
    SOURCE,
    ProgramTest,
)

COMMANDS = ["check", "static", "modes", "trim", "floquet", "campbell"]


class CommandLine(ProgramTest):
    def test_help_names_commands_options_and_exit_codes(self):
        for option in ("--help", "-h"):
            text = self.succeed(option).stdout
            for word in (*COMMANDS, "--set", "-o ", "--csv", "--version", "mpirun", "exit codes"):
                self.assertIn(word, text)
            self.assertLessEqual(max(map(len, text.splitlines())), 100)

    def examples(self, command):
        """Words of the examples in the help of a command, without the name of the program."""
        text = self.succeed(command, "--help").stdout
        found = re.search(r"^examples?:? *\n?((?:.+\n?)+?)(?=\n|\Z)", text, re.MULTILINE).group(1)
        examples = [shlex.split(one)[1:] for one in " ".join(found.split()).split(";") if one.strip()]
        self.assertTrue(examples, command)
        for words in examples:
            self.assertEqual(words[0], command)
        return [[str(SOURCE / w) if w.startswith("inputs/") else w for w in words] for words in examples]

    def test_examples_of_all_helps_work(self):
        results = {"floquet": ["f.h5", "floquet.h5", "coarse.h5"], "campbell": ["c.h5", "campbell.h5"],
                   "transient": ["RESULT.h5"]}
        shutil.copytree(SOURCE / "tests/decks/files/three", self.folder, dirs_exist_ok=True)
        run = {"check", "static", "modes", "trim", "floquet", "campbell", "transient", "operate", "linearize", "new",
               "schema", "import", "plot", "report", "loads", "export"}
        first = [*results, *sorted(run - set(results))]  # those that write what others read
        for command in first:
            with self.subTest(command=command):
                for words in self.examples(command):
                    if ">" in words:
                        words = words[:words.index(">")]
                    if command in results:
                        words += ["-o", results[command][0]]
                    self.succeed(*words)
                    if command == "floquet":
                        self.succeed(*words[:-2], "-o", "fine.h5", "--set", "floquet.steps=120")
                for name in results.get(command, [])[1:]:
                    shutil.copy(self.folder / results[command][0], self.folder / name)
        listed = set(re.findall(r"^  ([a-z]+) {2,}", self.succeed("--help").stdout, re.MULTILINE))
        commands = listed & set(self.complete("samara", ""))
        self.assertGreater(len(commands), 10)
        self.assertLessEqual(commands, run)

    def complete(self, *words):
        """Bash's completions of the last word."""
        script = (f"source {SOURCE / 'completions/samara'}; COMP_WORDS=({' '.join(repr(w) for w in words)}); "
                  f"COMP_CWORD={len(words) - 1}; compopt() {{ :; }}; _samara; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        done = subprocess.run(["bash", "-c", script], cwd=self.folder, text=True, capture_output=True,
                              check=True)
        return done.stdout.split()

    def test_bash_completes_commands_options_and_files(self):
        listed = re.search(r"(?s)^commands\n(.*?)\n\n", self.succeed("--help").stdout, re.MULTILINE).group(1)
        commands = {line.split()[0] for line in listed.splitlines()}
        self.assertEqual(commands, {word for word in self.complete("samara", "") if word[0] != "-"})
        self.assertEqual(self.complete("samara", "camp"), ["campbell"])
        self.assertEqual(self.complete("samara", "campbell", "--sw"), ["--sweep"])
        self.assertEqual(self.complete("samara", "trim", "--sw"), [])
        for command in commands - {"plot", "new", "schema"}:
            for option in self.complete("samara", command, "--"):
                self.assertIn(option, self.succeed(command, "--help").stdout, command)
        for name in ("case.yaml", "result.h5", "notes.txt"):
            self.write(name, "")
        self.assertEqual(self.complete("samara", "floquet", ""), ["case.yaml"])
        self.assertEqual(self.complete("samara", "plot", ""), ["result.h5"])
        self.assertEqual(self.complete("samara", "new", "three"), ["three-bladed"])

    def test_prefixes_of_solver_options(self):
        table = self.succeed("--help-options").stdout
        page = (SOURCE / "docs/case_file.md").read_text(encoding="utf-8")
        for prefix in ("-trim_", "-static_", "-modes_", "-floquet_", "-shooting_", "-transient_"):
            self.assertIn(prefix, table)
            row = next(line for line in table.splitlines() if line.startswith(prefix))
            described = next(line for line in page.splitlines() if line.startswith(f"| `{prefix}` |"))
            for word in described.replace("`", "").replace("|", " ").split():
                self.assertIn(word, row.split())

    def test_an_option_without_its_prefix_is_matched(self):
        self.write("case.yaml", MINIMAL)
        for command, option, whole in (("trim", "-snes_monitor", "-trim_snes_monitor"),
                                       ("modes", "-eps_view", "-modes_eps_view"),
                                       ("transient", "-ts_monitor", "-transient_ts_monitor")):
            words = {"modes": ["--parked"],
                     "transient": ["--set", "transient={duration: 0.02, step: 0.01}"]}
            run = self.succeed(command, "case.yaml", *words.get(command, []), option)
            self.assertIn(f"did you mean {whole}?", run.stderr)
            self.assertIn("--help-options", run.stderr)
        run = self.succeed("trim", "case.yaml", "-nothing_of_the_kind")
        self.assertIn("misspelt", run.stderr)

    def test_help_needs_no_case(self):
        self.assertEqual(self.succeed("floquet", "no.yaml", "--help").stderr, "")
        self.assertEqual(self.files(), {})

    def test_version_names_the_libraries(self):
        text = self.succeed("--version").stdout
        self.assertRegex(text, r"^samara \d+\.\d+\.\d+\n")
        for word in ("Petsc", "SLEPc", "MPI", "HDF5"):
            self.assertRegex(text, rf"(?m)^.*{word}.* v?\d+\.\d+")

    def test_blas_uses_the_vector_instructions_of_the_processor(self):
        """OpenBLAS takes kernels without them on processors that are newer than it."""
        blas = re.search(r"(?m)^OpenBLAS [\d.]+, (\w+)$", self.succeed("--version").stdout)
        processor = pathlib.Path("/proc/cpuinfo")
        flags = re.search(r"(?m)^flags\s*:(.*)$", processor.read_text() if processor.exists() else "")
        variables = {**os.environ, "OPENBLAS_CORETYPE": "Nehalem"}
        asked = subprocess.run([PROGRAM, "--version"], env=variables, capture_output=True, text=True)
        if blas is None or flags is None or "avx2" not in flags[1].split() or "OPENBLAS_CORETYPE" in os.environ \
                or ", Nehalem\n" not in asked.stdout:
            self.skipTest("another BLAS, one for a single processor, or another processor")
        self.assertNotIn(blas[1], ("Prescott", "Core2", "Nehalem", "Sandybridge"))

    def test_own_options_may_stand_anywhere(self):
        self.succeed("-o", "x.h5", "--set=gravity=0", "check", BASELINE)
        self.assertEqual(list(self.files()), ["x.h5"])

    def test_petsc_options_reach_petsc(self):
        run = self.succeed("trim", BASELINE, "-trim_snes_monitor", "-trim_snes_rtol", "1e-6")
        self.assertRegex(run.stdout, r"0 SNES Function norm")
        self.assertNotIn("this run did not use", run.stderr)

    def test_a_negative_number_is_a_value(self):
        run = self.succeed("check", BASELINE, "-some_option", "-1.5", "-other_option")
        for option in ("-some_option", "-other_option"):
            self.assertIn(option, run.stderr)

    def test_options_that_nothing_asked_for_are_reported(self):
        run = self.succeed("trim", BASELINE, "-trim_snes_monitr")
        self.assertEqual(len(run.stderr.splitlines()), 1)
        self.assertIn("-trim_snes_monitr", run.stderr)

    def test_a_quiet_run_says_nothing_on_stderr(self):
        self.assertEqual(self.succeed("floquet", BASELINE, *QUICK).stderr, "")

    def test_a_trim_that_does_not_converge_ends_with_3(self):
        for command in ("trim", "floquet"):
            run = self.refuse(command, BASELINE, "-trim_snes_max_it", "0", code=3,
                              words=["trim: ", "hint: "])
            self.assertTrue(run.stderr.startswith("samara: "))

    def test_a_standard_output_that_is_full_ends_with_1(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            run = self.samara("check", BASELINE, stdout=full)
        self.assertEqual(run.returncode, 1)
        self.assertIn("standard output", run.stderr)

    def test_a_reader_that_leaves_costs_no_result(self):
        process = subprocess.Popen(
            [PROGRAM, "floquet", str(BASELINE), *QUICK, "-o", "x.h5"],
            cwd=self.folder,
            stdout=subprocess.PIPE,
        )
        process.stdout.close()
        process.wait(timeout=LONGEST_RUN)
        self.assertEqual(list(self.files()), ["x.h5"])


class Tables(ProgramTest):
    def test_check_reports_the_masses_of_the_paper(self):
        """Lee, Hodges and Patil (2002), Table I: 67.5772 kg/m, 8.42 m and 27 m, 6900 kg."""
        text = self.succeed("check", BASELINE).stdout
        rows = re.findall(r"(?m)^(\w+(?: \w+)*) +(\S+) +\S+, \S+, \S+  [nyhb]1", text)
        mass = {part: float(value) for part, value in rows}
        blade, tower = 67.5772 * 8.42, 67.5772 * 27
        expected = {"tower": tower, "nacelle": 6900, "each blade": blade, "rotor": 2 * blade,
                    "turbine": tower + 6900 + 2 * blade}
        for part, value in expected.items():
            self.assertAlmostEqual(mass[part], value, delta=1e-5 * value)
        radius, length, density = 1.8, 8.42, 67.5772
        inertia = 2 * density * ((radius + length) ** 3 - radius**3) / 3
        inertia += 2 * length * 4.9999 + 5  # sections about b3, and the hub
        found = float(re.search(r"rotor inertia +(\S+) kg m\^2", text).group(1))
        self.assertAlmostEqual(found, inertia, delta=1e-5 * inertia)
        self.assertIn("38 degrees of freedom", text)
        self.assertEqual(self.files(), {})

    def test_floquet_tells_what_grows(self):
        text = self.succeed("floquet", BASELINE, *QUICK).stdout
        self.assertRegex(text, r"(?m)^unstable: 1 mode grows: 1st teeter doubles in \d")
        self.assertNotRegex(text, r"-0\.0+\s")
        self.assertLessEqual(max(map(len, text.splitlines())), 140)

    def test_a_clamped_rotor_is_neutral(self):
        self.write("case.yaml", MINIMAL)
        text = self.succeed("floquet", "case.yaml", "--set", "floquet.steps=700").stdout
        self.assertRegex(text, r"(?m)^neutral: no mode grows; \d+ are undamped, neither growing")

    def test_too_few_resolved_modes_are_no_verdict(self):
        # These steps resolve some of the first ten modes, and the resolved ones neither grow nor
        # decays: nothing is known of the others.
        self.write("case.yaml", MINIMAL)
        for steps in ("12", "60", "160"):
            run = self.samara("floquet", "case.yaml", "--set", f"floquet.steps={steps}", "-o", "a.h5")
            self.assertEqual(run.returncode, 3, run.stdout)
            self.assertRegex(run.stdout, r"(?m)^no verdict: modes from \S+ Hz on are not resolved; "
                             r"hint: more floquet\.steps, or floquet\.modes$")
            self.assertIn("no verdict", run.stderr)
            self.assertIn("result: a.h5", run.stdout)

    def test_a_growth_of_the_mesh_is_none_of_the_turbine(self):
        # Pitch, unequal bending and a steady deflection break the mirror symmetry; a yaw that is
        # locked leaves nothing to grow.
        skew = ("gravity=9.81", "shaft.tilt_deg=5", "blades.pitch_deg=12",
                "blades.sections.0.stiffness.EI3=4e7", "nacelle.yaw.joint=locked")
        settings = [word for setting in skew for word in ("--set", setting)]
        text = self.succeed("floquet", BASELINE, *settings).stdout
        self.assertRegex(text, r"(?m)^neutral: no mode grows; \d+ are undamped")
        self.assertRegex(text, r"(?m)^\d+ modes have too large an error and do not count for "
                               r"the verdict")
        self.assertRegex(text, r"(?m)^ *\d+  (\d\w\w )?blade [a-z -]+ .* - +- .* error \d+ %")
        fine = ("--set", "blades.order=2", "--set", "tower.order=2")
        self.assertRegex(self.succeed("floquet", BASELINE, *settings, *fine).stdout,
                         r"(?m)^neutral: no mode grows")

    def test_an_error_of_the_growth_that_shows_is_stated(self):
        # On a coarse mesh the first tower mode has an error of 1.4 %, but one of a fifth in its
        # damping.
        text = self.succeed("floquet", SOURCE / "inputs/nrel5mw/land.yaml", "--set", "aero=none",
                            "--set", "blades.elements=2", "-o", "coarse.h5").stdout
        with h5py.File(self.folder / "coarse.h5") as file:
            group = file["floquet"]
            growth = group["exponents"][:, 0]
            error, error_growth = group["error"][:], group["error_growth"][:]
        stated = 0
        for line in text.splitlines():
            row = re.match(r" *(\d+)  .* (-?[+\d.e-]+) +\d+  \S", line)
            if not row or row.group(2) == "-":
                continue
            m = int(row.group(1)) - 1
            self.assertAlmostEqual(float(row.group(2)), growth[m], delta=6e-3 * abs(growth[m]))
            relative = error_growth[m] / abs(growth[m])
            found = re.search(r"growth error (\S+) %", line)
            self.assertEqual(found is not None, relative > max(0.01, 1.05 * error[m]), line)
            if found:
                self.assertAlmostEqual(float(found.group(1)) / 100, relative, delta=0.06 * relative)
                stated += 1
        self.assertGreater(stated, 5)
        least = re.search(r"(?m)the least damped is .* % \(error (\S+) %\)$", text)
        self.assertGreater(float(least.group(1)), 1)

    def test_growth_that_the_step_makes_of_a_free_motion_is_no_verdict(self):
        # The generator turns freely and gravity makes it swing: its whole motion a moment later is
        # a motion again, with a multiplier of one.
        text = self.succeed("floquet", SOURCE / "inputs/nrel5mw/land.yaml", "--set", "aero=none",
                            "--set", "blades.order=3", "--set", "tower.order=3", "--set",
                            "shaft.generator.joint=free").stdout
        self.assertRegex(text, r"(?m)^neutral: ")

    def test_damping_makes_it_stable(self):
        damped = MINIMAL.replace("length: 10", "length: 10\n  damping: 1e-3")
        self.write("case.yaml", damped + "gravity: 0\n")
        for command in ("floquet", "modes"):
            text = self.succeed(command, "case.yaml", "--set", "floquet.steps=700").stdout
            self.assertRegex(text, r"(?m)^stable: all \d+ modes decay; the least damped is ")

    def test_damping_ratios_are_those_of_the_first_modes(self):
        ratios = "length: 10\n  damping: {flap: 0.02, lead_lag: 0.013, torsion: 0.004}"
        self.write("case.yaml", MINIMAL.replace("length: 10", ratios) + "gravity: 0\n")
        self.assertRegex(self.succeed("check", "case.yaml").stdout,
                         r"(?m)^blade damping +flap mu \S+ s: mode 1 2 % at .*\(given 2 %\)")
        text = self.succeed("modes", "case.yaml", "--set", "shaft.speed=0").stdout
        for mode, percent in (("flap", "2.000"), ("lead-lag", "1.300"), ("torsion", "0.400")):
            self.assertRegex(text, rf"(?m)1st blade {mode} +\S+ +{percent} ")

    def test_the_generator_says_what_it_gives(self):
        laws = ("generator: {joint: free, torque: 500, torque_slope: 30}, "
                "rotor: {torque: 480, torque_slope: -20}")
        text = MINIMAL.replace("{speed: 6}", "{speed: 6, " + laws + "}")
        self.write("case.yaml", text + "gravity: 0\n")
        self.assertIn("generator    480 N m against its turning hold the mean speed: 500 by its law "
                      "and -20 in addition", self.succeed("trim", "case.yaml").stdout)

    def test_a_generator_behind_a_gear_says_what_it_gives_itself(self):
        laws = ("gear_ratio: -20, generator: {joint: free, torque: 25, torque_slope: 0.075}, "
                "rotor: {torque: 480, torque_slope: -20}")
        text = MINIMAL.replace("{speed: 6}", "{speed: 6, " + laws + "}")
        self.write("case.yaml", text + "gravity: 0\n")
        self.assertIn("generator    24 N m against its turning hold the mean speed: 25 by its law "
                      "and -1 in addition", self.succeed("trim", "case.yaml").stdout)
        self.assertRegex(self.succeed("check", "case.yaml").stdout,
                         r"(?m)^generator +inertia 0 kg m\^2 about its own axis, gear ratio -20: "
                         r"1145.9 rpm\n(.*\n)*generator torque +25 N m at its own speed, slope")

    def test_a_parked_rotor_needs_no_torque_at_rest(self):
        table = "torque_table: [[4, 0], [8, 900]]"
        laws = "{speed: 6, generator: {joint: free, own_inertia: 50, %s}, rotor: {%s}}" % (table, table)
        self.write("case.yaml", MINIMAL.replace("{speed: 6}", laws))
        self.assertEqual(self.succeed("check", "case.yaml").stderr, "")
        for command in ("static", "modes"):
            run = self.succeed(command, "case.yaml", "--set", "shaft.speed=0")
            self.assertRegex(run.stderr, r"(?m)^case.yaml:2:\d+: shaft.rotor.torque_table: note: ")
        run = self.succeed("check", "case.yaml", "--set", "shaft.generator.joint=locked")
        self.assertIn("note: without effect, the generator is locked", run.stderr)
        self.refuse("check", "case.yaml", "--set", "shaft.speed=9", lines=2,
                    words=["the table reaches from 4 to 8 rad/s", "hint: "], place=r"case\.yaml:2:")

    def test_unresolved_modes_are_explained(self):
        self.write("case.yaml", MINIMAL)
        text = self.samara("floquet", "case.yaml", "--set", "floquet.steps=16").stdout
        hidden = int(re.search(r"(?m)^(\d+) unresolved, not listed \(--all lists them\) and left out "
                               "of the verdict:$", text).group(1))
        self.assertNotIn("unresolved*", text)
        whole = self.samara("floquet", "case.yaml", "--set", "floquet.steps=16", "--all").stdout
        self.assertRegex(whole, rf"(?m)^\* {hidden} unresolved, left out of the verdict: ")
        rows = [re.findall(r"(?m)^ *(\d+)  \w+ .*?(unresolved\*)?$", each) for each in (text, whole)]
        self.assertEqual(rows[0], rows[1][:-hidden])  # the resolved ones stand first
        self.assertEqual([remark for _, remark in rows[1][-hidden:]], ["unresolved*"] * hidden)
        self.assertEqual(sorted(int(number) for number, _ in rows[1]), list(range(1, len(rows[1]) + 1)))

    def test_all_modes_are_of_commands_that_list_some(self):
        self.write("case.yaml", MINIMAL)
        self.refuse("trim", "case.yaml", "--all", words=["--all: samara trim lists no modes"])

    def test_trim_shows_harmonics_of_deflections_and_loads(self):
        text = self.succeed("trim", BASELINE, *QUICK, "--set", "gravity=9.81").stdout
        for word in ("harmonic balance, 4 harmonics", "Newton", "residual", "held", "mean", "1P",
                     "4P", "largest", "blade 1 tip", "teeter", "yaw", "tower top", "root moment"):
            self.assertIn(word, text)

    def test_the_foot_of_the_tower_carries_the_weight(self):
        """The mean vertical force at the tower's foot is the weight of all."""
        text = self.succeed("trim", BASELINE, *QUICK, "--set", "gravity=9.81").stdout
        force = float(re.search(r"tower root force n3 \(vertical\) +N +(\S+)", text).group(1))
        weight = 9.81 * (67.5772 * (27 + 2 * 8.42) + 6900)
        self.assertAlmostEqual(force, -weight, delta=1e-3 * weight)


class Inputs(ProgramTest):
    """The cases in the tree."""

    def test_all_are_read_and_say_how_to_run_them(self):
        cases = sorted((SOURCE / "inputs").rglob("*.yaml"))
        self.assertGreater(len(cases), 5)
        for case in cases:
            with self.subTest(case=case.name):
                self.assertIn("degrees of freedom", self.succeed("check", case).stdout)

    def test_the_rotating_beam_runs_with_modes_and_floquet(self):
        """Wright et al. (1982): at 6 rad/s the beam flaps at 7.3604, lead-lag at 4.2631 rad/s."""
        beam = SOURCE / "inputs/beam/rotating.yaml"
        for command in ("modes", "floquet"):
            text = self.succeed(command, beam).stdout
            for mode, omega in (("flap", 7.3604), ("lead-lag", (7.3604**2 - 36) ** 0.5)):
                found = float(re.search(rf"(?m)1st blade {mode} +(\S+)", text).group(1))
                self.assertAlmostEqual(found, omega / 6, delta=2e-4)

    def test_some_modes_by_hills_method(self):
        case = SOURCE / "inputs/nrel5mw/land.yaml"
        coarse = [part for key in ("blades.elements=1", "blades.order=3", "tower.elements=1",
                                   "tower.order=3", "aero=none") for part in ("--set", key)]
        hill = ("--set", "floquet.search=hill")
        text = self.succeed("floquet", case, *coarse, "--set", "floquet.modes=4", *hill, "-o",
                            "some.h5").stdout
        self.assertRegex(text, r"(?m)^rotor speed .*; 324 unknowns; Hill's method, ")
        self.assertRegex(text, r"(?m)^stable: all \d+ modes decay; ")
        self.assertRegex(text, r"(?m)^searched: up to \S+ Hz, growth and decay up to \S+ 1/s; none is "
                               r"missing there; other modes are not known$")
        self.succeed("floquet", case, *coarse, "-o", "all.h5")
        with h5py.File(self.folder / "some.h5") as some, h5py.File(self.folder / "all.h5") as every:
            group = some["/floquet"]
            self.assertEqual(group.attrs["searched_is_counted"], 1)
            self.assertEqual(group.attrs["searched_from_hz"], 0)
            self.assertGreater(group.attrs["searched_decay"], 0)
            self.assertGreater(group.attrs["harmonics"], 1)
            self.assertLess(group["residual"][:].max(), 1e-7)
            found = group["exponents"][:] @ [1, 1j]
            others = every["/floquet/exponents"][:] @ [1, 1j]
            distances = abs(found[:, None] - others).min(axis=1) / abs(found)
            self.assertGreaterEqual(len(found), 4)
            self.assertLess(found.imag[3], 2 * numpy.pi * group.attrs["searched_to_hz"])
            self.assertLess(distances[:4].max(), 1e-6)
            below = others[abs(others.imag) < 2 * numpy.pi * group.attrs["searched_to_hz"]]
            self.assertTrue(all(abs(found - one).min() < 1e-4 * abs(one) for one in below))
        for ranks in (2, 3):
            self.succeed("floquet", case, *coarse, "--set", "floquet.modes=4", *hill, "-o", "ranks.h5",
                         ranks=ranks)
            with h5py.File(self.folder / "ranks.h5") as file:
                other = file["/floquet/exponents"][:] @ [1, 1j]
            self.assertLess((abs(other - found) / abs(found)).max(), 1e-9)
        # Far from all modes; few eigenpairs a shift.
        self.assertIn(self.samara("floquet", case, *coarse, "--set", "floquet.modes=4", *hill, "--set",
                                  "floquet.near_hz=1000").returncode, (0, 3))
        text = self.succeed("floquet", case, *coarse, "--set", "floquet.modes=4", *hill,
                            "-hill_eps_ncv", "60").stdout
        self.assertIn("none is missing there", text)
        self.refuse("floquet", case, *coarse, "--set", "floquet.near_hz=2",
                    words=["floquet.near_hz", "needs floquet.modes"])
        self.refuse("floquet", case, *coarse, "--set", "floquet.modes=4", *hill,
                    "-hill_eps_smallest_magnitude", words=["largest eigenvalues"])

    def test_one_iteration_where_harmonics_are_not_coupled(self):
        # Without weight, the tangents of the chains are constant and the border is exact: so is the
        # preconditioner of Hill's method, with and without equal blades.
        turbine = ("nrel5mw/land.yaml", "--set", "aero=none", "--set", "gravity=0")
        for case in (turbine, ("beam/rotating.yaml",)):
            for order in (3, 5):
                orders = ("--set", f"blades.order={order}")
                text = self.succeed("floquet", SOURCE / "inputs" / case[0], *case[1:], *orders, "--set",
                                    "floquet.modes=4", "--set", "floquet.search=hill",
                                    "-hill_ksp_converged_reason",
                                    "-hill_refine_ksp_converged_reason").stdout
                iterations = re.findall(r"(?m)solve converged .* iterations (\d+)$", text)
                self.assertGreater(len(iterations), 20)
                self.assertEqual(set(iterations), {"1"})

    def test_slowest_decays(self):
        case = SOURCE / "inputs/nrel5mw/land.yaml"
        coarse = ("--set", "blades.elements=1", "--set", "blades.order=3", "--set",
                  "tower.elements=1", "--set", "tower.order=3", "--set", "aero=none")
        hill = ("--set", "floquet.search=hill")
        text = self.succeed("floquet", case, *coarse, "--set", "floquet.least_damped=5", *hill, "-o",
                            "some.h5").stdout
        self.assertIn("none is missing there", text)
        self.assertIn("all of these modes are resolved", text)
        self.succeed("floquet", case, *coarse, "-o", "all.h5")
        exponents = {}
        for name in ("some", "all"):
            with h5py.File(self.folder / f"{name}.h5") as file:
                exponents[name] = file["/floquet/exponents"][:] @ [1, 1j]
                if name == "all":
                    exponents[name] = exponents[name][file["/floquet/resolved"][:] == 1]
                else:
                    self.assertEqual(file["/floquet"].attrs["searched_is_counted"], 1)
        slowest = sorted(exponents["all"], key=lambda exponent: -exponent.real)[:5]
        for exponent in slowest:
            self.assertLess(min(abs(exponents["some"] - exponent)), 1e-6 * abs(exponent))
        self.refuse("floquet", case, *coarse, "--set", "floquet.least_damped=4", "--set",
                    "floquet.modes=4", words=["floquet.least_damped", "exclude each other"])
        for key in ("floquet.least_damped", "floquet.modes"):
            self.refuse("floquet", case, *coarse, "--set", f"{key}=900", words=[key, "degrees of freedom"])
        self.refuse("floquet", case, *coarse, "--set", "floquet.least_damped=0",
                    words=["floquet.least_damped"])

    def test_the_teetering_turbine_is_stable(self):
        case = SOURCE / "inputs/two_bladed/teetering.yaml"
        coarse = ("--set", "blades.elements=2", "--set", "tower.elements=2",
                  "--set", "floquet.steps=48", "--set", "aero=none")
        text = self.succeed("check", case).stdout
        self.assertRegex(text, r"teeter free, \S+ N m s/rad")
        self.assertRegex(self.succeed("trim", case, *coarse).stdout, r"(?m)^teeter +deg +0 ")
        text = self.succeed("floquet", case, *coarse).stdout
        self.assertRegex(text, r"(?m)^stable: all \d+ modes decay; ")
        teeter = float(re.search(r"(?m) teeter +(\S+)", text).group(1))
        self.assertAlmostEqual(teeter, 1, delta=5e-3)


class Static(ProgramTest):
    """A straight beam at rest, 10 m, EI = 1e4, with a force across its end."""

    LOADS = "loads:\n  - {beam: blades, at: 1, force: [0, 0, %g]}\ngravity: 0\n"
    AT_REST = MINIMAL.replace("speed: 6", "speed: 0").replace("length: 10", "length: 10\n  order: 3")

    def test_shows_deflections_and_loads_by_factor(self):
        self.write("case.yaml", self.AT_REST + self.LOADS % 0.01)
        text = self.succeed("static", "case.yaml").stdout
        for word in ("prescribed load factors, 10 steps", "1 prescribed load", "Newton", "residual",
                     "blade 1", "turned", "u b3", "M b2"):
            self.assertIn(word, text)
        rows = re.findall(r"(?m)^([01]\.\d{4}) +(.*)$", text)
        self.assertEqual([factor for factor, _ in rows], [f"{k / 10:.4f}" for k in range(11)])
        words = rows[-1][1].split()
        deflection, moment = float(words[2]), float(words[8])
        self.assertAlmostEqual(deflection, 0.01 * 1e3 / 3e4, delta=1e-3 * 3.3e-4)  # P l^3 / 3 EI
        self.assertAlmostEqual(moment, -0.1, delta=1e-4)  # across b3, about -b2
        self.assertLessEqual(max(map(len, text.splitlines())), 130)

    def test_refuses_a_rotor_that_turns(self):
        self.write("case.yaml", MINIMAL + self.LOADS % 1)
        self.refuse("static", "case.yaml", words=["shaft.speed: must be 0", "samara trim"],
                    place=r"case\.yaml:2:9: ")

    def half_turn(self, beam):
        moment = 3.14159265359 * 1e4 / 10  # pi EI / l
        return f"loads: [{{beam: {beam}, at: 1, moment: [0, {moment:.12g}, 0]}}]\ngravity: 0\n"

    def test_a_blade_turns_by_half_a_turn(self):
        self.write("case.yaml", self.AT_REST + self.half_turn("blades"))
        for method in ("load", "arc_length"):
            text = self.succeed("static", "case.yaml", "--set", f"static.method={method}").stdout
            words = re.findall(r"(?m)^1\.0000 +(.*)$", text)[0].split()
            self.assertAlmostEqual(float(words[0]), -10.0, delta=5e-3)  # R sin(pi) - l
            self.assertAlmostEqual(float(words[2]), -20.0 / 3.14159265, delta=5e-3)  # -2 R
            self.assertAlmostEqual(float(words[3]), 180.0, delta=0.1)

    def test_ends_with_3_and_the_factor_reached_where_the_tower_top_turns_too_far(self):
        blades = self.AT_REST[self.AT_REST.index("blades:"):]
        tower = blades.replace("blades:", "tower:")
        self.write("case.yaml", self.AT_REST + tower + self.half_turn("tower"))
        for method in ("load", "arc_length"):
            run = self.refuse("static", "case.yaml", "--set", f"static.method={method}", code=3,
                              words=["tower top: rotation beyond 170 degrees", "hint: "])
            reached = float(re.search(r"stopped at load factor (\S+) of 1", run.stderr).group(1))
            self.assertAlmostEqual(reached, 170 / 180, delta=5e-3)  # four elements

    def test_ends_with_3_where_the_steps_do_not_suffice(self):
        self.write("case.yaml", self.AT_REST + self.LOADS % 1000)
        self.refuse("static", "case.yaml", "--set", "static.max_steps=3", code=3,
                    words=["static: stopped at load factor 0.", "static.max_steps", "hint: "])

    def test_ends_with_2_where_nothing_restores_or_holds_twice(self):
        hinge = "length: 10\n  hinges: [{axis: flap, joint: free}]"  # its axis is vertical
        free = self.AT_REST.replace("length: 10", hinge).replace("speed: 0", "speed: 0, azimuth_deg: 90")
        self.write("case.yaml", free)
        self.refuse("static", "case.yaml", words=["nothing restores blade 1 flap hinge", "hint: "])
        clamp = "length: 10\n  end_support: {stiffness: {u1: rigid}}"
        twice = self.AT_REST.replace("length: 10", clamp).replace("EA: 1e8", "EA: rigid")
        self.write("case.yaml", twice + self.LOADS % 1)
        for command in ("static", "modes"):
            self.refuse(command, "case.yaml", words=["singular", "hint: ", "held twice"])

    def test_other_commands_want_loads_that_repeat(self):
        load = "loads: [{beam: blades, at: 1, force: [0, 0, 1], %s}]\n"
        for series in ("table: [[0, 0], [1, 1]]", "harmonic: {frequency: 3}"):
            self.write("case.yaml", MINIMAL + load % series)
            for command in ("trim", "floquet", "modes"):
                self.refuse(command, "case.yaml", words=["loads[0]: does not repeat", "per_rev"],
                            place=r"case\.yaml:9:\d+: ")
        self.write("case.yaml", MINIMAL + load % "harmonic: {per_rev: 6}")
        self.refuse("trim", "case.yaml", words=["trim.harmonics=6"], place=r"case\.yaml:9:\d+: ")
        self.succeed("trim", "case.yaml", "--set", "trim.harmonics=6")

    def test_other_commands_want_prescribed_angles_that_repeat(self):
        yaw = "nacelle: {yaw: {joint: prescribed, harmonic: {%s, amplitude_deg: 3}}}\n"
        self.write("case.yaml", MINIMAL + yaw % "frequency: 2")
        for command in ("trim", "floquet", "modes"):
            self.refuse(command, "case.yaml", words=["nacelle.yaw: does not repeat", "per_rev"],
                        place=r"case\.yaml:9:\d+: ")
        text = self.succeed("static", "case.yaml", "--set", "shaft.speed=0").stdout
        self.assertRegex(text, r"(?m)^yaw +3 deg$")  # where it is at t = 0
        self.write("case.yaml", MINIMAL + yaw % "per_rev: 6")
        self.refuse("trim", "case.yaml", words=["trim.harmonics=6"], place=r"case\.yaml:9:\d+: ")
        self.succeed("trim", "case.yaml", "--set", "trim.harmonics=6")
        self.refuse("modes", "case.yaml", "--set", "trim.harmonics=6", words="samara modes --parked",
                    place=r"case\.yaml: ")

    def test_petsc_options_reach_the_solver(self):
        self.write("case.yaml", self.AT_REST + self.LOADS % 1)
        run = self.succeed("static", "case.yaml", "-static_pc_factor_mat_solver_type", "mumps")
        self.assertNotIn("this run did not use", run.stderr)


unittest.main()
