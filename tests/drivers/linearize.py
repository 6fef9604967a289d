"""samara linearize: exponents and responses from the exported matrices are those of the program."""

import pathlib
import re
import sys
import unittest

import h5py
import numpy
import scipy.io
import scipy.linalg

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
from program import BASELINE, SOURCE, ProgramTest  # noqa: E402

SMALL = ["--set", "blades.elements=2", "--set", "tower.elements=2"]
FASTEST = 60.0  # rad/s: up to here the step of samara floquet is fine enough to extrapolate


def hill_eigenvalues(A, speed, harmonics):
    """Exponents of x_dot = A(psi) x, A of [mean, cos 1, sin 1, ...]: the equation for the
    coefficients x_k of x = exp(lambda t) sum_k x_k exp(i k psi)."""
    n = A.shape[1]
    parts = {0: A[0].astype(complex)}
    for k in range(1, (len(A) + 1) // 2):
        parts[k] = (A[2 * k - 1] - 1j * A[2 * k]) / 2
        parts[-k] = parts[k].conj()
    orders = range(-harmonics, harmonics + 1)
    rows = [[parts.get(i - j, numpy.zeros((n, n))) - (1j * i * speed * numpy.eye(n) if i == j else 0)
             for j in orders] for i in orders]
    return scipy.linalg.eigvals(numpy.block(rows))


def nearest(exponents, wanted, speed):
    """The exponent, or its conjugate, nearest to `wanted` modulo i Omega."""
    values = numpy.concatenate([exponents, exponents.conj()])
    values = values + 1j * speed * numpy.round((wanted - values).imag / speed)
    return values[numpy.argmin(abs(values - wanted))]


def amplitude(time, values, omega):
    """The complex amplitude of a time series at omega, beside its mean."""
    basis = numpy.column_stack([numpy.ones_like(time), numpy.cos(omega * time),
                                numpy.sin(omega * time)])
    _, cosine, sine = numpy.linalg.lstsq(basis, values, rcond=None)[0]
    return cosine - 1j * sine


class Linearize(ProgramTest):
    def exponents(self, steps, settings):
        self.succeed("floquet", BASELINE, *SMALL, *settings, "--set", f"floquet.steps={steps}",
                     "--set", "floquet.time_order=2", "-o", "floquet.h5")
        with h5py.File(self.folder / "floquet.h5") as file:
            resolved = file["/floquet/resolved"][:] == 1
            return (file["/floquet/exponents"][:] @ [1, 1j])[resolved]

    def test_exponents_from_the_matrices_are_those_of_floquet(self):
        settings = ["--set", "gravity=9.81", "--set", "blades.damping=1e-4"]
        self.succeed("linearize", BASELINE, *SMALL, *settings, "--set",
                     "linearize={azimuths: 31, harmonics: 15, inputs: [yaw_torque], "
                     "outputs: [NacYaw], forms: [state_space, hill, lyapunov_floquet], "
                     "hill_harmonics: 8}", "-o", "linear.h5")
        with h5py.File(self.folder / "linear.h5") as file:
            speed = file["/linearize"].attrs["rotor_speed"]
            self.assertLess(file["/linearize/state_space"].attrs["residual"], 1e-5)
            found = [hill_eigenvalues(file["/linearize/state_space/A"][:], speed, 8),
                     scipy.linalg.eigvals(file["/linearize/hill/A"][:])]
            floquet = file["/linearize/lyapunov_floquet/A"][:]
            self.assertLess(abs(floquet[1:]).max(), 1e-12 * abs(floquet[0]).max())
            constant = scipy.linalg.eigvals(floquet[0])
        coarse, middle, fine = (self.exponents(steps, settings) for steps in (500, 1000, 2000))
        compared = 0
        for exponent in fine:
            if not 1e-4 < abs(exponent) < FASTEST:
                continue  # round-off splits the double zero of the free yaw by its root
            half = nearest(middle, exponent, speed)
            quarter = nearest(coarse, half, speed)
            once = (4 * numpy.array([exponent, half]) - [half, quarter]) / 3
            limit = (16 * once[0] - once[1]) / 15
            for values in found:
                self.assertLess(abs(values - limit).min(), 1e-6 * max(1, abs(limit)))
            self.assertLess(abs(nearest(constant, limit, speed) - limit), 1e-6 * max(1, abs(limit)))
            compared += 1
        self.assertGreaterEqual(compared, 6)

    def test_a_closed_loop_is_the_turbine_with_that_spring_and_damper(self):
        stiffness, damping = 5e5, 2e5
        self.succeed("linearize", BASELINE, *SMALL, "--set",
                     "linearize={azimuths: 25, harmonics: 12, inputs: [yaw_torque], "
                     "outputs: [NacYaw, NacYawV]}", "-o", "linear.h5")
        with h5py.File(self.folder / "linear.h5") as file:
            speed = file["/linearize"].attrs["rotor_speed"]
            A, B, C = (file["/linearize/state_space"][name][:] for name in "ABC")
        gains = -numpy.array([stiffness, damping]) * numpy.pi / 180  # of degrees
        closed = hill_eigenvalues(A + B * (gains @ C[0]), speed, 8)
        joint = f"nacelle.yaw={{joint: free, stiffness: {stiffness}, damping: {damping}}}"
        coarse, fine = (self.exponents(steps, ["--set", joint]) for steps in (1000, 2000))
        for exponent in fine[abs(fine) < 30.0]:
            limit = (4 * exponent - nearest(coarse, exponent, speed)) / 3
            self.assertLess(abs(closed - limit).min(), 1e-5 * max(1, abs(limit)))

    def test_reduced_forms_answer_as_the_whole_within_their_bound(self):
        settings = ["--set", "shaft.speed=0", "--set", "blades.damping=0.01", "--set",
                    "tower.damping=0.01", "--set",
                    "nacelle.yaw={joint: free, stiffness: 1e6, damping: 2e5}", "--set",
                    "hub.teeter={joint: free, stiffness: 1e5, damping: 1e3}"]
        self.succeed("linearize", BASELINE, *SMALL, *settings, "--set",
                     "linearize={inputs: [top_force_n2], outputs: [TTDspFA], "
                     "reduce: {order: 6}}", "-o", "linear.h5")

        def response(group, omega):
            A, B, C, D = (group[name][:].reshape(group[name].shape[-2:]) for name in "ABCD")
            return (C @ numpy.linalg.solve(1j * omega * numpy.eye(len(A)) - A, B) + D)[0, 0]

        with h5py.File(self.folder / "linear.h5") as file:
            reduced = file["/linearize/state_space_reduced"]
            bound = reduced.attrs["error_bound"]
            self.assertEqual(reduced["A"].shape, (6, 6))
            largest = 0
            for omega in numpy.geomspace(0.1, 300, 60):
                whole = response(file["/linearize/state_space"], omega)
                largest = max(largest, abs(whole))
                self.assertLessEqual(abs(response(reduced, omega) - whole), bound)
            self.assertLess(bound, 0.05 * largest)

    def test_the_response_is_that_of_the_nonlinear_transient(self):
        """Three blades without gravity: constant in multiblade coordinates."""
        turbine = [*SMALL, "--set", "blades.count=3", "--set", "hub.teeter={joint: locked}",
                   "--set", "nacelle.yaw={joint: free, stiffness: 1e6, damping: 2e5}",
                   "--set", "blades.damping=0.01", "--set", "tower.damping=0.1"]
        outputs = ["TTDspFA", "TTDspSS", "NacYaw", "TwrBsMyt", "YawBrTAxp"]
        self.succeed("linearize", BASELINE, *turbine, "--set",
                     f"linearize={{inputs: [top_force_n2], outputs: [{', '.join(outputs)}], "
                     "forms: [multiblade, average], azimuths: 9}", "-o", "linear.h5")
        with h5py.File(self.folder / "linear.h5") as file:
            group = file["/linearize/multiblade_average"]
            A, B, C, D = (group[name][:] for name in "ABCD")
            changing = file["/linearize/multiblade/A"][1:]
            self.assertLess(abs(changing).max(), 1e-6 * abs(A).max())
        for omega in (8.0, 19.0):
            response = C @ numpy.linalg.solve(1j * omega * numpy.eye(len(A)) - A, B) + D
            self.succeed("transient", BASELINE, *turbine, "--set",
                         "loads=[{beam: tower, at: 1, force: [0, 0, 100], "
                         f"harmonic: {{frequency: {omega}}}}}]", "--set", "trim.harmonics=0",
                         "--set", "transient={duration: 12, step: 0.004, start: undeformed, "
                         f"output: {{channels: [{', '.join(outputs)}]}}}}", "-o", "run.h5")
            with h5py.File(self.folder / "run.h5") as file:
                group = file["/transient"]
                time = group["time"][:]
                values = group["values"][:]
            last = time > time[-1] - 3 * 2 * numpy.pi / omega
            largest = {}
            for i, name in enumerate(outputs):
                found = amplitude(time[last], values[last, i], omega) / 100
                unit = "m" if name.startswith("TTDsp") else name
                largest[unit] = max(largest.get(unit, 0), abs(response[i, 0]))
                self.assertLess(abs(found - response[i, 0]), 0.01 * largest[unit], (name, omega))

    def test_multiblade_coordinates_make_a_balanced_rotor_constant(self):
        turbine = [*SMALL, "--set", "blades.count=3", "--set", "hub.teeter={joint: locked}",
                   "--set", "nacelle.yaw={joint: free, stiffness: 1e6}", "--set",
                   "blades.damping=1e-4", "--set", "blades.precone_deg=4"]
        self.succeed("linearize", BASELINE, *turbine, "--set",
                     "linearize={azimuths: 9, harmonics: 4, inputs: [pitch_1, pitch_2, pitch_3, "
                     "top_force_n1, base_n2], outputs: [RootMyb1, RootMyb2, RootMyb3, TipALxb1, "
                     "TipALxb2, TipALxb3, TTDspFA], forms: [state_space, multiblade]}",
                     "-o", "linear.h5")
        with h5py.File(self.folder / "linear.h5") as file:
            speed = file["/linearize"].attrs["rotor_speed"]
            group = file["/linearize/multiblade"]
            found = scipy.linalg.eigvals(group["A"][0])
            self.assertIn("pitch_rate cos 1", list(group["inputs/name"].asstr()[:]))
            for name in "ABCD":  # rates and accelerations of a pitch bring its lower ones along
                matrix = group[name][:]
                size = numpy.sqrt(numpy.outer(abs(matrix[0]).max(axis=1),
                                              abs(matrix[0]).max(axis=0)))
                size[size == 0] = 1  # eta's own rate has no input
                self.assertLess((abs(matrix[1:]) / size).max(), 1e-5, name)
                turning = file["/linearize/state_space"][name][:]
                self.assertGreater((abs(turning[1:]) / size).max(), 0.1, name)
        coarse, fine = (self.exponents(steps, turbine) for steps in (1000, 2000))
        for exponent in fine[abs(fine) < 30.0]:
            limit = (4 * exponent - nearest(coarse, exponent, speed)) / 3
            self.assertLess(abs(nearest(found, limit, speed) - limit), 1e-6 * max(1, abs(limit)))

    def test_the_lyapunov_floquet_form_answers_as_the_periodic_one(self):
        """A teetering turbine, which is damped: time series of both under the same force, from the
        same state of the slowest modes."""
        settings = ["--set", "gravity=9.81", "--set", "blades.damping=1e-3", "--set",
                    "tower.damping=1e-3", "--set",
                    "nacelle.yaw={joint: free, stiffness: 1e6, damping: 1e5}"]
        self.succeed("linearize", BASELINE, *SMALL, *settings, "--set",
                     "linearize={azimuths: 49, harmonics: 24, inputs: [top_force_n2], "
                     "outputs: [NacYaw, TTDspFA], forms: [state_space, lyapunov_floquet], "
                     "lyapunov_floquet_states: 10}", "-o", "linear.h5")
        with h5py.File(self.folder / "linear.h5") as file:
            speed = file["/linearize"].attrs["rotor_speed"]
            whole, small, between = ([file["/linearize"][form][name][:] for name in "ABC"]
                                     for form in ("state_space", "lyapunov_floquet",
                                                  "lyapunov_floquet_map"))
        self.assertEqual(small[0].shape[1], 10)

        def at(series, psi):
            harmonics = numpy.arange(1, (len(series) + 1) // 2)
            functions = numpy.ravel([numpy.cos(harmonics * psi), numpy.sin(harmonics * psi)], "F")
            return numpy.tensordot(numpy.concatenate([[1], functions]), series, 1)

        def series(form, x, steps=4000, revolutions=2):
            # The states that the small form omits must not be excited: no input, only an initial state.
            dt = revolutions * 2 * numpy.pi / speed / steps
            rows = []
            for i in range(steps):
                rows.append(at(form[2], speed * i * dt) @ x)
                A = at(form[0], speed * (i + 0.5) * dt)
                half = dt / 2 * A
                one = numpy.eye(len(x))
                x = numpy.linalg.solve(one - half, (one + half) @ x)
            return numpy.array(rows)

        start = numpy.array([1, 0.3, -0.5, 0.2, 0.1, 0.4, -0.2, 0.1, 0.3, -0.1])
        found = series(small, start)
        wanted = series(whole, at(between[2], 0.0) @ start)
        size = abs(wanted).max(axis=0)
        self.assertLess((abs(found - wanted) / size).max(), 1e-4)
        # And inputs reach the coordinates through the map: B there = Q B.
        for psi in (0.0, 1.0, 4.0):
            numpy.testing.assert_allclose(at(small[1], psi), at(between[1], psi) @ at(whole[1], psi),
                                          rtol=1e-4, atol=1e-6 * abs(small[1]).max())

    def test_free_motions_stay_together_in_lyapunov_floquet_coordinates(self):
        """Free yaw, generator and gravity: four multipliers at one, of which two are one."""
        turbine = [*SMALL, "--set", "blades.count=3", "--set", "hub.teeter={joint: locked}",
                   "--set", "shaft.generator={joint: free, own_inertia: 2000}"]
        self.succeed("linearize", BASELINE, *turbine, "--set",
                     "linearize={azimuths: 31, forms: [state_space, lyapunov_floquet], outputs: "
                     "[NacYaw], inputs: [yaw_torque], at_deg: [12.3, 90]}", "-o", "linear.h5")
        with h5py.File(self.folder / "linear.h5") as file:
            group = file["/linearize/lyapunov_floquet_map/at_azimuths"]
            self.assertEqual(group["B"].shape[1:], (52, 52))
            for Q, P in zip(group["B"][:], group["C"][:]):
                numpy.testing.assert_allclose(Q @ P, numpy.eye(52), atol=1e-7)
            exponents = scipy.linalg.eigvals(file["/linearize/lyapunov_floquet/A"][0])
            self.assertEqual(sum(abs(exponents) < 1e-2), 4)

    def test_a_motion_with_next_to_no_inertia_is_refused(self):
        """Shaft torsion in series with the bending of both blades, on a hub without inertia: the
        weight that bends the blades gives it next to no inertia, and none twice a revolution."""
        turbine = ["--set", "shaft.torsion={joint: free, stiffness: 1e6, damping: 1e3}",
                   "--set", "hub={mass: 400, radius: 0.5, inertia: %s, teeter: {joint: locked}}",
                   "--set", "gravity=9.81", "--set", "nacelle.yaw.stiffness=1e7",
                   "--set", "blades.elements=2", "--set", "blades.order=2", "--set",
                   "blades.sections=[{mass: 67.5772, inertia: [1e-4, 1e-4, 0], stiffness: {EA: "
                   "rigid, GA2: rigid, GA3: rigid, GJ: 1e7, EI2: 1e7, EI3: 1e7}}]"]
        for inertia, runs in (("[0, 0, 0]", False), ("[0, 5, 0]", True)):
            words = [word.replace("%s", inertia) for word in turbine]
            result = self.samara("linearize", BASELINE, *words, "-o", "linear.h5")
            self.assertEqual(result.returncode, 0 if runs else 2, result.stderr)
            self.assertEqual("has no inertia or almost none" in result.stderr, not runs)
            self.assertEqual((self.folder / "linear.h5").exists(), runs)
            if not runs:
                self.assertRegex(result.stderr, r'a motion of "blade \d point \d M3"')
        # A little inertia: the matrix is right, but its eigenvalues in double precision are not.
        for inertia, is_noted in (("[0, 5e-8, 0]", True), ("[0, 5, 0]", False)):
            words = [word.replace("%s", inertia) for word in turbine]
            run = self.succeed("linearize", BASELINE, *words, "--set", "shaft.speed=0", "-o", "small.h5")
            with h5py.File(self.folder / "small.h5") as file:
                A = file["linearize/state_space/A"][:]  # parked: the same at all azimuths
            changed = A * (1 + 2.2e-16 * numpy.random.default_rng(0).choice([-1, 1], A.shape))
            own, others = scipy.linalg.eigvals(A), scipy.linalg.eigvals(changed)
            change = (abs(own[:, None] - others).min(axis=1) / abs(own).clip(0.1)).max()
            noted = re.search(r"round-off of A, .* changes its eigenvalues by up to (\S+) %", run.stderr)
            self.assertEqual(noted is not None, is_noted, run.stderr)
            if is_noted:  # another sample of the same size
                self.assertLess(abs(numpy.log(float(noted[1]) / 100 / change)), numpy.log(30))
            else:
                self.assertLess(change, 1e-4)
        # A fine mesh has a condition as large, but inertia everywhere.
        self.succeed("linearize", SOURCE / "inputs/nrel5mw/land.yaml", "--set", "aero=none", "--set", "shaft.speed=0",
                     "--set", "blades.elements=20", "--set", "blades.order=3", "--set", "tower.elements=10",
                     "--set", "linearize={inputs: [pitch], outputs: [TTDspFA]}", "-o", "fine.h5")

    def test_matrices_at_azimuths_of_ones_own(self):
        self.succeed("linearize", BASELINE, *SMALL, "--set",
                     "linearize={azimuths: 25, harmonics: 12, inputs: [yaw_torque], outputs: "
                     "[NacYaw], forms: [state_space, descriptor], at_deg: [30, 211.5]}",
                     "-o", "linear.h5")
        with h5py.File(self.folder / "linear.h5") as file:
            numpy.testing.assert_allclose(file["/linearize/azimuth"][:],
                                          numpy.radians([30, 211.5]), rtol=1e-15)
            group = file["/linearize/state_space"]
            A = group["A"][:]
            self.assertEqual(file["/linearize/descriptor/M"].shape[0], 2)
            for i, psi in enumerate(numpy.radians([30, 211.5])):
                series = A[0] + sum(A[2 * k - 1] * numpy.cos(k * psi) +
                                    A[2 * k] * numpy.sin(k * psi) for k in range(1, 13))
                numpy.testing.assert_allclose(group["at_azimuths/A"][i], series,
                                              atol=1e-4 * abs(A[0]).max())

    def test_multiblade_coordinates_of_unlike_and_of_parked_blades(self):
        """The transformation is exact whatever the blades are, and at rest a change of names."""
        turbine = [*SMALL, "--set", "blades.count=3", "--set", "hub.teeter={joint: locked}",
                   "--set", "nacelle.yaw={joint: free, stiffness: 1e6}",
                   "--set", "blades.each.2.mass_factor=1.05"]
        keys = ("linearize={azimuths: 25, harmonics: 12, inputs: [yaw_torque], outputs: [NacYaw], "
                "forms: [state_space, multiblade]}")
        for speed in ([], ["--set", "shaft.speed=0", "--set", "shaft.azimuth_deg=25"]):
            self.succeed("linearize", BASELINE, *turbine, *speed, "--set", keys, "-o", "linear.h5")
            with h5py.File(self.folder / "linear.h5") as file:
                rotor = file["/linearize"].attrs["rotor_speed"]
                A = [file["/linearize"][form]["A"][:].reshape(-1, *file["/linearize"][form]
                                                              ["A"].shape[-2:])
                     for form in ("state_space", "multiblade")]
            wanted, fewer, found = (
                hill_eigenvalues(one, rotor, harmonics) if rotor > 0 else scipy.linalg.eigvals(one[0])
                for one, harmonics in ((A[0], 6), (A[0], 5), (A[1], 6)))
            # Those at the edge of Hill's matrix are of its cutting off.
            wanted = [one for one in wanted if abs(one) < 30 and abs(fewer - one).min() < 1e-7]
            self.assertGreater(len(wanted), 6)
            for exponent in wanted:
                self.assertLess(abs(found - exponent).min(), 1e-5 * max(1, abs(exponent)))

    def test_mat_files_have_the_same_matrices(self):
        self.succeed("linearize", BASELINE, *SMALL, "--set",
                     "linearize={azimuths: 9, inputs: [yaw_torque, pitch], outputs: [NacYaw, "
                     "RootMyb1], mat: model.mat}", "-o", "linear.h5")
        mat = scipy.io.loadmat(self.folder / "model.mat")
        with h5py.File(self.folder / "linear.h5") as file:
            group = file["/linearize/state_space"]
            for name in "ABCD":
                numpy.testing.assert_array_equal(mat[f"state_space_{name}"],
                                                 group[name][:].transpose(1, 2, 0))
            names = group["inputs/name"].asstr()[:]
            self.assertEqual([word.split(" ")[0] for word in mat["state_space_inputs"]],
                             list(names))
            self.assertEqual(list(names), ["yaw_torque", "pitch", "pitch_rate",
                                           "pitch_acceleration"])
        self.write("model.mat", "something else")
        self.refuse("linearize", BASELINE, "--set", "linearize={mat: model.mat}",
                    words="no MAT-file of samara")

    def test_what_does_not_exist_is_refused(self):
        self.refuse("check", BASELINE, "--set", "linearize={outputs: [NacYav]}",
                    words='did you mean "NacYaw"')
        self.refuse("check", BASELINE, "--set", "transient={duration: 1, step: 0.1, "
                    "output: {channels: [RotSped]}}", words='did you mean "RotSpeed"')
        self.refuse("linearize", BASELINE, "--set", "linearize={inputs: []}",
                    words=["linearize.inputs: expected a list of names, got an empty one"])
        self.refuse("linearize", BASELINE, "--set", "linearize={inputs: [yaw_torqe]}",
                    words='did you mean "yaw_torque"')
        self.refuse("linearize", BASELINE, "--set", "linearize={inputs: [generator_torque]}",
                    words="generator_torque")
        self.refuse("linearize", BASELINE, "--set", "linearize={outputs: [NacYav]}",
                    words='did you mean "NacYaw"')
        self.refuse("linearize", BASELINE, "--set", "linearize={forms: [multiblade]}",
                    words="three and more blades")
        self.refuse("linearize", BASELINE, *SMALL, "--set",
                    "linearize={azimuths: 9, forms: [lyapunov_floquet], "
                    "lyapunov_floquet_states: 5000, inputs: [yaw_torque], outputs: [NacYaw]}",
                    words="has 40 of 40 states")
        small = "inputs: [yaw_torque], outputs: [NacYaw]"
        self.refuse("linearize", BASELINE, *SMALL, "--set",
                    f"linearize={{forms: [lyapunov_floquet], lyapunov_floquet_states: 1, {small}}}",
                    words="the slowest motion has")
        self.refuse("linearize", BASELINE, *SMALL, "--set", "shaft.speed=0", "--set",
                    f"linearize={{forms: [hill], {small}}}", words="rotor stands still")
        self.refuse("linearize", BASELINE, *SMALL, "--set",
                    f"linearize={{mat: linear.h5, {small}}}", "-o", "./linear.h5",
                    words="name the same file")
        self.refuse("linearize", BASELINE, "--set", "linearize={forms: [lyapunov_flocket]}",
                    words="lyapunov_floquet")
        self.refuse("linearize", BASELINE, "--set", "linearize={azimuths: 8, harmonics: 4}",
                    words="linearize.harmonics")


unittest.main()
