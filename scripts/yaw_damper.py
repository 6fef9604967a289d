#!/usr/bin/python3
"""Example of a linear model in Python: a spring and a damper on the free yaw of the turbine of Lee,
Hodges & Patil (2002), designed with the matrices of `samara linearize`.

    scripts/yaw_damper.py [--program build/samara] [--plot yaw_damper.png]

The yaw torque is u = -stiffness y - damping y_dot with the yaw y. As the rotor has two blades, the
matrices change with the azimuth: x_dot = (A(psi) + B(psi) K) x, and what tells stability are the
exponents of this equation, found by harmonic lifting.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import matplotlib
import numpy as np
import scipy.integrate
import scipy.linalg

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
import samara  # noqa: E402

CASE = ROOT / "inputs/lee2002/article_mesh.yaml"
MODEL = ("linearize={azimuths: 25, harmonics: 10, inputs: [yaw_torque, top_force_n1], "
         "outputs: [NacYaw, NacYawV]}")
SETTINGS = ["blades.elements=2", "tower.elements=2", "blades.damping=2e-3", "tower.damping=5e-3",
            "hub.teeter={joint: free, damping: 2e3}", MODEL]
STIFFNESS = 5e5  # N m/rad
DAMPINGS = np.linspace(0, 4e5, 21)  # N m s/rad
CHOSEN = 1e5
HARMONICS = 6


class Model:
    """x_dot = A(psi) x + B(psi) u, y = C(psi) x; matrices [mean, cos 1, sin 1, ...]."""

    def __init__(self, path):
        result = samara.open_result(path)
        form = "linearize/state_space"
        self.A, self.B, self.C = (result[form][name].values for name in "ABC")
        self.inputs = [str(name) for name in result[f"{form}/inputs"]["name"].values]
        self.outputs = [str(name) for name in result[f"{form}/outputs"]["name"].values]
        self.speed = result["linearize"].attrs["rotor_speed"]

    def close(self, gains):
        """A of the loop u_0 = gains y, where y does not depend on the azimuth."""
        assert np.abs(self.C[1:]).max() < 1e-6 * np.abs(self.C[0]).max()
        row = np.asarray(gains) @ self.C[0]
        return self.A + self.B[:, :, :1] * row


def at(series, psi):
    orders = np.arange(1, (len(series) + 1) // 2)
    weights = np.empty(len(series))
    weights[0], weights[1::2], weights[2::2] = 1, np.cos(orders * psi), np.sin(orders * psi)
    return np.tensordot(weights, series, 1)


def exponents(A, speed):
    """The eigenvalues of the lifted matrix whose shapes are least near its edge, one a motion."""
    n = A.shape[1]
    parts = {0: A[0].astype(complex)}
    for k in range(1, (len(A) + 1) // 2):
        parts[k] = (A[2 * k - 1] - 1j * A[2 * k]) / 2
        parts[-k] = parts[k].conj()
    orders = np.arange(-HARMONICS, HARMONICS + 1)
    zero = np.zeros((n, n))
    lifted = np.block([[parts.get(i - j, zero) - (1j * i * speed * np.eye(n) if i == j else 0)
                        for j in orders] for i in orders])
    values, shapes = scipy.linalg.eig(lifted)
    weights = np.abs(shapes.reshape(len(orders), n, -1)).max(axis=1)
    middle = (weights.T @ np.abs(orders)) / weights.sum(axis=0)
    return values[np.argsort(middle)[:n]]


def yaw_series(model, A, times):
    """Yaw [deg] after a push of 20 kN across the tower top, half a second long."""
    force = model.B[:, :, model.inputs.index("top_force_n1")]

    def rate(t, x):
        return at(A, model.speed * t) @ x + (2e4 * at(force, model.speed * t) if t < 0.5 else 0)

    run = scipy.integrate.solve_ivp(rate, times[[0, -1]], np.zeros(A.shape[1]), "Radau",
                                    t_eval=times, rtol=1e-6, atol=1e-9,
                                    jac=lambda t, x: at(A, model.speed * t))
    return model.C[0, model.outputs.index("NacYaw")] @ run.y


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "build/samara")
    parser.add_argument("--plot", default="yaw_damper.png")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        result = pathlib.Path(folder) / "model.h5"
        settings = [word for setting in SETTINGS for word in ("--set", setting)]
        subprocess.run([options.program, "linearize", CASE, *settings, "-o", result], check=True)
        model = Model(result)

    def loop(stiffness, damping):  # outputs are in degrees
        return model.close(-np.array([stiffness, damping]) * np.pi / 180)

    loci = [exponents(loop(STIFFNESS, damping), model.speed) for damping in DAMPINGS]
    print("free yaw: growth %.5f 1/s" % exponents(model.A, model.speed).real.max())
    for damping, values in list(zip(DAMPINGS, loci))[::5]:
        print("stiffness %.1e N m/rad, damping %.1e N m s/rad: growth %.5f 1/s"
              % (STIFFNESS, damping, values.real.max()))

    times = np.linspace(0, 15, 501)
    _, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    for damping, values in zip(DAMPINGS, loci):
        slow = values[(abs(values.imag) < 2 * model.speed) & (values.imag >= 0)]
        points = left.scatter(slow.real, slow.imag, s=12, c=np.full(len(slow), damping),
                              vmin=DAMPINGS[0], vmax=DAMPINGS[-1])
    plt.colorbar(points, ax=left, label="damping of the yaw [N m s/rad]")
    left.axvline(0, color="k", lw=0.5)
    left.set(xlabel="real part of the exponents [1/s]", ylabel="imaginary part [rad/s]",
             xlim=(-8, 0.5))
    right.plot(times, yaw_series(model, model.A, times), label="free")
    right.plot(times, yaw_series(model, loop(STIFFNESS, CHOSEN), times), label="damped")
    right.set(xlabel="time [s]", ylabel="yaw after a push [deg]")
    right.legend()
    plt.savefig(options.plot)
    print("plot:", options.plot)


main()
