"""PySINDy on a case: sparse regression of the contact's force, of the free sensor and of the drive.

    python pysindy.py FOLDER

Each trial is fitted and the other one foretold. Three balances are regressed on libraries of physical terms:

| rows | left side | terms that the nominal physics has | term -> effect that it stands for |
|---|---|---|---|
| contact | F | p, v, 1 | p^2, p^3 -> nonlinear_stiffness; (p - d)+ -> layered_stiffness; p v, p^2 v -> hunt_crossley_damping; |
|         |   |         | v abs(v) -> quadratic_damping; sign v -> hysteresis; a -> environment_mass; t, t p -> time_varying_stiffness |
| free    | F | none    | 1 -> force_bias; t -> force_drift; a -> tool_inertia; sin, cos at 50 and 60 Hz -> mains_hum |
| all     | effort - F | a, v | sign v -> coulomb_friction; sign v exp(-abs(v)/u) -> stribeck_friction; F sign v -> load_dependent_friction; |
|         |   |         | 1 -> gravity_load; F -> force_gain; d(effort)/dt -> effort_lag |

A mass that is felt in free motion is beyond the sensor and not in the environment; dry friction that falls off with
speed is Stribeck's and not Coulomb's besides. What no term of a state stands for (play, delays, saturation, a moving
surface, memory) is beyond such a library.

The columns are scaled to an RMS of one. STLSQ and SR3 run over a grid of thresholds; the choice is made by
cross-validation over blocks of the trial that is fitted, the sparsest within a third of a standard error of the best. An effect
is named where a term of it is chosen on both trials and the model foretells the unseen trial better than the refitted
nominal law in both directions: by two percent, in the drive by ten.
"""

import os
import sys
import warnings

# This script is called like the library: its own folder comes last.
FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path = [path for path in sys.path if os.path.abspath(path) != FOLDER] + [FOLDER]
# Matrices of twenty columns: threads cost ten times what they save.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402
import pysindy  # noqa: E402
from signals import judge, main, rms, stack  # noqa: E402

BLOCKS = 5
THRESHOLDS = np.geomspace(1e-3, 0.1, 7)
# What a model must foretell better than the nominal law, as a share of its residual. The encoder's steps come back
# through the controller into the effort, so that terms of the drive foretell up to 7 % of it where there is nothing.
GAIN = {"contact": 0.02, "free": 0.02, "drive": 0.1}


def fit(library, target):
    """Coefficients chosen by cross-validation over blocks: the terms that are kept, and what foretells with them."""
    names = list(library)
    features = stack(library, names)
    scale = np.sqrt(np.mean(features**2, axis=0))
    scale[scale == 0.0] = 1.0
    size = max(rms(target), 1e-300)
    scaled, wanted = features / scale, target / size
    block = np.arange(len(target)) * BLOCKS // len(target)
    tried = []
    for make in optimizers():
        errors = []
        for one in range(BLOCKS):
            inner = block != one
            found = sparse(make, scaled[inner], wanted[inner], names)
            errors.append(np.mean((wanted[~inner] - scaled[~inner] @ found) ** 2))
        tried.append((np.mean(errors), np.std(errors) / np.sqrt(BLOCKS), sparse(make, scaled, wanted, names)))
    best = min(tried, key=lambda one: one[0])
    good = [one for one in tried if one[0] <= best[0] + best[1] / 3.0]
    chosen = min(good, key=lambda one: (np.count_nonzero(one[2]), one[0]))[2] * size / scale
    return [name for name, value in zip(names, chosen) if value], lambda others: stack(others, names) @ chosen


def optimizers():
    """Both of PySINDy's workhorses over their thresholds."""
    for threshold in THRESHOLDS:
        yield lambda threshold=threshold: pysindy.STLSQ(threshold=threshold, alpha=1e-8, max_iter=50)
    for threshold in THRESHOLDS:
        weight = 0.5 * threshold**2
        yield lambda weight=weight: pysindy.SR3(reg_weight_lam=weight, relax_coeff_nu=1.0, max_iter=40, unbias=True)


def sparse(make, features, target, names):
    """What PySINDy keeps of the features."""
    model = pysindy.SINDy(optimizer=make(), feature_library=pysindy.IdentityLibrary())
    with warnings.catch_warnings():
        # A threshold that keeps nothing, or a grid point that has not settled, is a candidate as any other.
        warnings.simplefilter("ignore")
        model.fit(features, t=1.0, x_dot=target[:, None], feature_names=names)
    return np.nan_to_num(model.coefficients()[0])


def contact(rows, scene):
    """Terms of the force in contact."""
    p, v = rows.depth, rows.velocity
    terms = {"p": p, "v": v, "1": np.ones_like(p), "p^2": p**2, "p^3": p**3}
    for share in (0.35, 0.5, 0.65):
        terms[f"(p-{share}D)+"] = np.maximum(p - share * scene["depth"], 0.0)
    terms |= {"p v": p * v, "p^2 v": p**2 * v, "v|v|": v * np.abs(v)}
    terms |= {"sign v": np.tanh(v / scene["slow"]), "a": rows.acceleration, "t": rows.time, "t p": rows.time * p}
    return terms


def free(rows, _):
    """Terms of the force out of contact."""
    terms = {"1": np.ones_like(rows.time), "t": rows.time, "a": rows.acceleration}
    for hz in (50, 60):
        turn = 2.0 * np.pi * hz * rows.time
        terms |= {f"sin {hz} Hz": np.sin(turn), f"cos {hz} Hz": np.cos(turn)}
    return terms


def drive(rows, scene):
    """Terms of what the effort does beside the contact force."""
    v, sign = rows.velocity, np.tanh(rows.velocity / scene["slow"])
    terms = {"a": rows.acceleration, "v": v, "sign v": sign, "1": np.ones_like(v)}
    for share in (0.1, 0.4):
        terms[f"sign v exp(-|v|/{share}V)"] = sign * np.exp(-np.abs(v) / (share * scene["speed"]))
    terms |= {"F sign v": rows.force * sign, "F": rows.force, "du/dt": rows.effort_rate}
    return terms


LIBRARIES = {"contact": contact, "free": free, "drive": drive}
NOMINAL = {"contact": ("p", "v", "1"), "free": (), "drive": ("a", "v")}
MEANING = {
    "contact": {
        "p^2": "nonlinear_stiffness",
        "p^3": "nonlinear_stiffness",
        "(p-0.35D)+": "layered_stiffness",
        "(p-0.5D)+": "layered_stiffness",
        "(p-0.65D)+": "layered_stiffness",
        "p v": "hunt_crossley_damping",
        "p^2 v": "hunt_crossley_damping",
        "v|v|": "quadratic_damping",
        "sign v": "hysteresis",
        "a": "environment_mass",
        "t": "time_varying_stiffness",
        "t p": "time_varying_stiffness",
    },
    "free": {
        "1": "force_bias",
        "t": "force_drift",
        "a": "tool_inertia",
        "sin 50 Hz": "mains_hum",
        "cos 50 Hz": "mains_hum",
        "sin 60 Hz": "mains_hum",
        "cos 60 Hz": "mains_hum",
    },
    "drive": {
        "sign v": "coulomb_friction",
        "1": "gravity_load",
        "sign v exp(-|v|/0.1V)": "stribeck_friction",
        "sign v exp(-|v|/0.4V)": "stribeck_friction",
        "F sign v": "load_dependent_friction",
        "F": "force_gain",
        "du/dt": "effort_lag",
    },
}


def balance(name, trials, left, raw, scene):
    """The effects that one balance names, and how well it foretells."""
    terms, measured = judge(GAIN[name], trials, lambda rows: LIBRARIES[name](rows, scene), fit, NOMINAL[name], left, raw)
    return {MEANING[name][term] for term in terms if term in MEANING[name]}, measured


if __name__ == "__main__":
    main(balance)
