"""SysIdentPy on a case: polynomial models with exogenous inputs, of the contact's force, the free sensor and the drive.

    python sysidentpy.py FOLDER

Structure by FROLS (forward regression with orthogonal least squares), its length by BIC, parameters by least squares.
The models are NFIR, so without the output's own past: a force that is foretold from the force a sample before is
foretold well by anything, and names nothing. The inputs stand one row ahead, so that SysIdentPy's shortest lag is the
present. What the terms stand for, as products of inputs:

| rows | output | inputs | term -> effect that it stands for |
|---|---|---|---|
| contact | F | p, v, a, s = sign v, to the third degree | p p, p p p -> nonlinear_stiffness; p v, p p v -> hunt_crossley_damping; |
|         |   |                      | v v s, v v v -> quadratic_damping; s, p s -> hysteresis; a, p a -> environment_mass |
| free    | F | t, a, sin and cos at 50 and 60 Hz, linear | constant -> force_bias; t -> force_drift; a -> tool_inertia; sin, cos -> mains_hum |
| all     | effort - F | a, v, s, e = s exp(-abs(v)/u), F, d(effort)/dt, to the second degree | s -> coulomb_friction; e -> stribeck_friction; |
|         |   |                      | F s -> load_dependent_friction; constant -> gravity_load; F -> force_gain; d(effort)/dt -> effort_lag |

Inputs and output are scaled to an RMS of one. An effect is named where a term of it is chosen on both trials and the
model foretells the unseen trial better than the refitted nominal law in both directions: by two percent, in the drive by fifteen.
"""

import os
import sys

# This script is called like the library: its own folder comes last.
FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path = [path for path in sys.path if os.path.abspath(path) != FOLDER] + [FOLDER]
# Matrices of twenty columns: threads cost ten times what they save.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402
from signals import judge, main, rms  # noqa: E402
from sysidentpy.basis_function import Polynomial  # noqa: E402
from sysidentpy.model_structure_selection import FROLS  # noqa: E402
from sysidentpy.parameter_estimation import LeastSquares  # noqa: E402

# What a model must foretell better than the nominal law, as a share of its residual. The encoder's steps come back
# through the controller into the effort, so that terms of the drive foretell up to 13 % of it where there is nothing.
GAIN = {"contact": 0.02, "free": 0.02, "drive": 0.15}
DEGREE = {"contact": 3, "free": 1, "drive": 2}
NOMINAL = {"contact": ("p", "v", "1"), "free": (), "drive": ("a", "v")}
MEANING = {
    "contact": {
        "p p": "nonlinear_stiffness",
        "p p p": "nonlinear_stiffness",
        "p v": "hunt_crossley_damping",
        "p p v": "hunt_crossley_damping",
        "s v v": "quadratic_damping",
        "v v v": "quadratic_damping",
        "s": "hysteresis",
        "p s": "hysteresis",
        "a": "environment_mass",
        "a p": "environment_mass",
    },
    "free": {
        "": "force_bias",
        "t": "force_drift",
        "a": "tool_inertia",
        "sin50": "mains_hum",
        "cos50": "mains_hum",
        "sin60": "mains_hum",
        "cos60": "mains_hum",
    },
    "drive": {
        "s": "coulomb_friction",
        "e": "stribeck_friction",
        "F s": "load_dependent_friction",
        "": "gravity_load",
        "F": "force_gain",
        "du": "effort_lag",
    },
}


def contact(rows, scene):
    """Inputs of the force in contact."""
    v = rows.velocity
    return {"p": rows.depth, "v": v, "a": rows.acceleration, "s": np.tanh(v / scene["slow"])}


def free(rows, _):
    """Inputs of the force out of contact."""
    inputs = {"t": rows.time, "a": rows.acceleration}
    for hz in (50, 60):
        turn = 2.0 * np.pi * hz * rows.time
        inputs |= {f"sin{hz}": np.sin(turn), f"cos{hz}": np.cos(turn)}
    return inputs


def drive(rows, scene):
    """Inputs of what the effort does beside the contact force."""
    v = rows.velocity
    sign = np.tanh(v / scene["slow"])
    fading = sign * np.exp(-np.abs(v) / (0.2 * scene["speed"]))
    return {"a": rows.acceleration, "v": v, "s": sign, "e": fading, "F": rows.force, "du": rows.effort_rate}


INPUTS = {"contact": contact, "free": free, "drive": drive}


def fit(library, target, degree):
    """What FROLS keeps, as products of inputs in order of the alphabet, and what foretells with it."""
    names = [name for name in library if name != "1"]
    scale = np.array([max(rms(library[name]), 1e-300) for name in names])
    size = max(rms(target), 1e-300)

    def table(library):
        return np.column_stack([library[name] for name in names]) / scale

    model = FROLS(
        order_selection=True,
        info_criteria="bic",
        n_info_values=12 if degree > 1 else len(names) + 1,
        xlag=[[1]] * len(names),
        ylag=1,
        model_type="NFIR",
        estimator=LeastSquares(),
        basis_function=Polynomial(degree=degree),
    )
    model.fit(X=ahead(table(library)), y=ahead(target[:, None] / size, 0.0))
    # SysIdentPy's code of an input is 1000 times its number, counted from 2, and its lag.
    factors = [[names[code // 1000 - 2] for code in term if code > 0] for term in model.final_model]
    kept = [" ".join(sorted(term)) for term in factors]

    def foretell(others):
        inputs = table(others)
        ones = np.ones(len(inputs))
        columns = [ones * np.prod([inputs[:, names.index(one)] for one in term], axis=0) for term in factors]
        return size * np.column_stack(columns) @ model.theta.ravel()

    return kept, foretell


def ahead(values, shift=None):
    """One row more at the end, so that the row before a row is its own; of the output, at the beginning."""
    return np.vstack([values, values[-1:]]) if shift is None else np.vstack([[[shift]], values])


def balance(name, trials, left, raw, scene):
    """The effects that one balance names, and how well it foretells."""

    def terms(rows):
        # The nominal law needs its constant, which SysIdentPy adds by itself.
        return INPUTS[name](rows, scene) | {"1": np.ones(len(rows))}

    def one(library, target):
        return fit(library, target, DEGREE[name])

    kept, measured = judge(GAIN[name], trials, terms, one, NOMINAL[name], left, raw)
    return {MEANING[name][term] for term in kept if term in MEANING[name]}, measured


if __name__ == "__main__":
    main(balance)
