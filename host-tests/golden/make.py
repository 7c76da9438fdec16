"""Writes the golden vectors beside this file: the same problems, solved by other people's libraries.

Every CSV begins with `#` lines that record the seed and the versions. Inputs are rounded to single precision first, so
that the library and its double-precision reference read the very same numbers.
"""

import pathlib
import platform
from importlib.metadata import version

import numpy as np
import padasip
import pandas as pd
import statsmodels.api as sm
from scipy.optimize import minimize, minimize_scalar
from scipy.signal import butter, lfilter, lfilter_zi
from statsmodels.regression.rolling import RollingOLS

HERE = pathlib.Path(__file__).parent
PACKAGES = ["numpy", "scipy", "statsmodels", "padasip", "pandas"]
SEED = 20_110_304
SAMPLES = 400
WINDOW = 50
FORGETTING = 0.98
INITIAL_COVARIANCE = 1e3


def single(values):
    return np.asarray(values, dtype=np.float32).astype(np.float64)


def write(name, frame, note):
    versions = ", ".join(f"{package} {version(package)}" for package in PACKAGES)
    with open(HERE / name, "w", newline="\n") as out:
        out.write(f"# {note}\n# seed {SEED}\n# python {platform.python_version()}, {versions}\n")
        frame.to_csv(out, index=False, float_format="%.17g", lineterminator="\n")


def contact(rng):
    """A bench-like contact: 10 Hz dither on a slow push, K = 300 N/m and B = 5 N s/m, noise 0.09 N."""
    t = np.arange(SAMPLES) * 1e-3
    w = 20 * np.pi
    x = single(0.0135 + 0.0033 * np.sin(w * t) + 0.002 * np.sin(2 * np.pi * 0.7 * t))
    v = single(0.0033 * w * np.cos(w * t) + 0.002 * 2 * np.pi * 0.7 * np.cos(2 * np.pi * 0.7 * t))
    return x, v, single(300.0 * x + 5.0 * v + 0.09 * rng.standard_normal(SAMPLES))


def recursive(x, v, force):
    rows = np.column_stack([x, v])
    expanding = sm.RecursiveLS(force, rows).fit().recursive_coefficients.filtered.T
    rolling = RollingOLS(force, rows, window=WINDOW).fit(method="pinv").params
    rls = padasip.filters.FilterRLS(n=2, mu=FORGETTING, eps=1 / INITIAL_COVARIANCE, w="zeros")
    weighted = []
    for row, target in zip(rows, force):
        rls.adapt(target, row)
        weighted.append(rls.w.copy())
    weighted = np.array(weighted)
    ridge = np.array([lstsq_with_prior(rows[: k + 1], force[: k + 1]) for k in range(SAMPLES)])
    columns = {"penetration": x, "rate": v, "force": force}
    for name, pair in [("expanding", expanding), ("rolling", rolling), ("forgetting", weighted), ("prior", ridge)]:
        columns[f"{name}_k"], columns[f"{name}_b"] = pair[:, 0], pair[:, 1]
    note = (
        "expanding: statsmodels RecursiveLS; rolling: statsmodels RollingOLS, window 50; forgetting: padasip FilterRLS, "
        "mu 0.98, eps 1e-3; prior: numpy lstsq with the rows sqrt(1e-3) I above"
    )
    write("contact.csv", pd.DataFrame(columns), note)


def lstsq_with_prior(rows, force):
    prior = np.eye(2) / np.sqrt(INITIAL_COVARIANCE)
    return np.linalg.lstsq(np.vstack([prior, rows]), np.concatenate([[0, 0], force]), rcond=None)[0]


def front_end(rng):
    """Free space, an onset with a step of slope, dither: all through scipy's filter from rest in the first sample."""
    t = np.arange(SAMPLES) * 1e-3
    ramp = np.clip((t - 0.05) / 0.1, 0, 1) * 0.025 - 0.012
    position = single(np.round((ramp + 0.0033 * np.sin(20 * np.pi * t)) / 1e-4) * 1e-4)
    force = single(np.where(position > 0, 300 * position, 0) + 0.09 * rng.standard_normal(SAMPLES))
    period = float(np.float32(1e-3))
    b, a = butter(2, 20.0, fs=1 / period)
    zi = lfilter_zi(b, a)

    def low_pass(signal, first):
        # Of the first sample no rate is known; the filters then begin at rest in the first row that is whole.
        return np.concatenate([[first], lfilter(b, a, signal, zi=zi * signal[0])[0]])

    depth = np.maximum(position, 0)
    two_sample_mean = lambda s: 0.5 * (s[1:] + s[:-1])  # noqa: E731
    columns = {
        "position": position,
        "force": force,
        "penetration_filtered": low_pass(two_sample_mean(depth), depth[0]),
        "rate": low_pass(np.diff(depth) / period, 0.0),
        "force_filtered": low_pass(two_sample_mean(force), force[0]),
    }
    write("front_end.csv", pd.DataFrame(columns), "scipy butter(2, 20 Hz) at 1 kHz, lfilter from rest (lfilter_zi)")


def line_search(x, v, force):
    """The line search of least mean fourth from several estimates and windows, and the minimum over both unknowns."""
    records = []
    for first, length in [(0, 10), (0, 50), (37, 50), (100, 300), (250, 150)]:
        rows, f = np.column_stack([x, v])[first : first + length], force[first : first + length]
        # In units in which both unknowns are of size one, so that the simplex does not have to stretch.
        unit = np.array([300.0, 5.0])
        whole = minimize(
            lambda z: np.sum((f - rows @ (z * unit)) ** 4),
            np.ones(2),
            method="Nelder-Mead",
            options={"xatol": 1e-12, "fatol": 0, "maxiter": 4000, "maxfev": 8000},
        )
        for k0, b0 in [(0.0, 0.0), (250.0, 8.0), (310.0, 4.5), (900.0, -20.0)]:
            e = f - rows @ [k0, b0]
            u = rows.T @ e**3
            u /= np.hypot(*u)
            p = rows @ u
            coefficients = [np.sum(p**4), -3 * np.sum(p**3 * e), 3 * np.sum(p**2 * e**2), -np.sum(p * e**3)]
            roots = np.roots(coefficients)
            real = roots[np.argmin(np.abs(roots.imag))].real
            line = minimize_scalar(lambda s: np.sum((e - s * p) ** 4), bracket=(0, real), tol=1e-12)
            records.append([first, length, k0, b0, *u, *coefficients, real, line.x, *(whole.x * unit)])
    names = "first length k0 b0 u_k u_b a b c d root minimiser whole_k whole_b".split()
    note = "windows of contact.csv; root: numpy roots; minimiser: scipy minimize_scalar (Brent); whole: Nelder-Mead"
    write("line_search.csv", pd.DataFrame(records, columns=names), note)


def cubic(rng):
    records = []
    for _ in range(200):
        p, q = single(10.0 ** rng.uniform(-3, 3)), single(rng.choice([-1, 1]) * 10.0 ** rng.uniform(-3, 3))
        roots = np.roots([1, 0, 3 * p, q])
        records.append([p, q, roots[np.argmin(np.abs(roots.imag))].real])
    write("cubic.csv", pd.DataFrame(records, columns=["p", "q", "root"]), "t^3 + 3 p t + q = 0 by numpy roots")


if __name__ == "__main__":
    rng = np.random.default_rng(SEED)
    bench = contact(rng)
    recursive(*bench)
    front_end(rng)
    line_search(*bench)
    cubic(rng)
