"""A case as a rival is given it: the columns of its trials, filtered alike, in and out of contact.

Care that every rival needs, taken once. The position is a staircase, so its derivatives come from a Savitzky-Golay
filter, and every other channel goes through the same filter: what is linear stays so. How wide the filter is, the data
say: the width with which the nominal law foretells raw readings best. Rows within half a filter of touching or leaving
mix two regimes and are left out.
"""

import json
import sys
import time
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.ndimage import binary_erosion
from scipy.signal import savgol_filter

WIDTHS = (15, 25, 41, 61, 91)
STRIDE = 8


@dataclass
class Trial:
    """One recording: raw readings."""

    time: np.ndarray
    position: np.ndarray
    force: np.ndarray
    effort: np.ndarray | None


@dataclass
class Rows:
    """Filtered rows of one trial in one regime, with the raw readings that are to be foretold."""

    time: np.ndarray
    depth: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    force: np.ndarray
    effort: np.ndarray | None
    effort_rate: np.ndarray | None
    raw_force: np.ndarray

    def pick(self, rows):
        """Some of the rows."""
        return Rows(*(None if values is None else values[rows] for values in vars(self).values()))

    def __len__(self):
        return len(self.time)


class Case:
    """A case's folder."""

    def __init__(self, folder):
        folder = Path(folder)
        rig = tomllib.loads((folder / "rig.toml").read_text())
        self.rotary = rig["rig"]["coordinate"] == "rotary"
        self.surface = rig["contact"]["surface_rad" if self.rotary else "surface_m"]
        self.bilateral = rig["contact"].get("bilateral", False)
        self.trials = [read(path) for path in sorted(folder.glob("trial-*.csv"))]
        self.width = min(WIDTHS, key=lambda width: sum(self.foretold(trial, width) for trial in self.trials))

    @property
    def unit(self):
        """Of the force."""
        return "N m" if self.rotary else "N"

    def foretold(self, trial, width):
        """RMS of raw readings against the nominal law, fitted on the filtered rows of the same trial."""
        rows = self.rows(trial, width)[0]
        features = np.column_stack([rows.depth, rows.velocity, np.ones(len(rows))])
        law = np.linalg.lstsq(features, rows.force, rcond=None)[0]
        return np.sqrt(np.mean((rows.raw_force - features @ law) ** 2))

    def rows(self, trial, width=None):
        """The rows in contact, those in free motion, and both together."""
        width = width or self.width
        step = float(np.median(np.diff(trial.time)))

        def smooth(values, derivative=0):
            return savgol_filter(values, width, 3, deriv=derivative, delta=step)

        # What is commanded at a row acts until the next one: at the row itself, half of it and half of the one before.
        acting = None if trial.effort is None else 0.5 * (trial.effort + np.roll(trial.effort, 1))
        effort, rate = (None, None) if acting is None else (smooth(acting), smooth(acting, 1))
        all_rows = Rows(
            trial.time,
            smooth(trial.position) - self.surface,
            smooth(trial.position, 1),
            smooth(trial.position, 2),
            smooth(trial.force),
            effort,
            rate,
            trial.force,
        )
        touching = self.touching(trial, all_rows, width)
        whole = binary_erosion(np.ones(len(touching), bool), iterations=width)
        within = binary_erosion(touching, iterations=width // 2 + 1) & whole
        outside = binary_erosion(~touching, iterations=width // 2 + 1) & whole
        kept = np.arange(len(touching)) % STRIDE == 0
        return all_rows.pick(within & kept), all_rows.pick(outside & kept), all_rows.pick((within | outside) & kept)

    def touching(self, trial, rows, width):
        """Where the tool touches, by the force: the surface is known by a tenth of the depth only."""
        if self.bilateral:
            return np.ones(len(trial.time), bool)
        reach = rows.depth.max()
        free = rows.depth < -0.3 * reach
        level = np.median(trial.force[free]) if free.any() else 0.0
        noise = np.std(np.diff(trial.force)) / np.sqrt(2.0) / np.sqrt(width / 3.0)
        threshold = max(5.0 * noise, 0.015 * (rows.force.max() - level))
        return (rows.force - level > threshold) & (rows.depth > -0.3 * reach)


def read(path):
    """A trial's columns."""
    with open(path, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        values = np.loadtxt(file, delimiter=",")
    column = {name.rsplit("_", 1)[0]: values[:, at] for at, name in enumerate(names)}
    force = column["force"] if "force" in column else column["torque"]
    return Trial(column["t"], column["position"], force, column.get("effort"))


def rms(values):
    """Root mean square, none of nothing."""
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else None


def together(parts):
    """RMS over parts of which each is an RMS and a count."""
    parts = [(value, count) for value, count in parts if value is not None]
    total = sum(count for _, count in parts)
    return float(np.sqrt(sum(value * value * count for value, count in parts) / total)) if total else None


def judge(gain, trials, terms, fit, nominal, left, raw):
    """Fits each of two trials and foretells the other; the terms that both fits keep, and for each direction what is
    left of the raw readings, what the refitted nominal law leaves, and their count.

    `terms(rows)` is a library by name, `fit(library, target)` returns the kept terms and a function that foretells from
    another library. No term is kept unless the model foretells the unseen trial better than the nominal law both ways,
    by the share `gain` of its residual.
    """
    kept, measured = [], []
    for seen, unseen in ((0, 1), (1, 0)):
        library, others = terms(trials[seen]), terms(trials[unseen])
        target = left(trials[seen])
        names, ahead = fit(library, target)
        law = np.linalg.lstsq(stack(library, nominal), target, rcond=None)[0]
        wanted = raw(trials[unseen])
        measured.append((rms(wanted - ahead(others)), rms(wanted - stack(others, nominal) @ law), len(wanted)))
        kept.append(set(names))
    if any(held > (1.0 - gain) * refitted for held, refitted, _ in measured):
        return set(), measured
    return kept[0] & kept[1], measured


def stack(library, names):
    """The columns of some terms."""
    rows = len(next(iter(library.values())))
    return np.column_stack([library[name] for name in names]) if names else np.zeros((rows, 0))


def answer(case, balance):
    """Runs `balance(name, trials, left, raw, scene)`, which returns names and measures, on the contact, the free sensor
    and the drive, and puts the answer together."""
    within, outside, everywhere = zip(*(case.rows(trial) for trial in case.trials[:2]))
    speed = rms(np.concatenate([rows.velocity for rows in everywhere]))
    scene = {"depth": max(rows.depth.max() for rows in within), "speed": speed, "slow": 0.05 * speed}
    named, measured = balance("contact", within, lambda it: it.force, lambda it: it.raw_force, scene)
    if min(len(rows) for rows in outside) > 200:
        also, more = balance("free", outside, lambda it: it.force, lambda it: it.raw_force, scene)
        named, measured = named | also, measured + more
    if everywhere[0].effort is not None:
        # Both sides filtered: the raw effort holds the encoder's steps, which no model predicts.
        def both(rows):
            return rows.effort - rows.force

        named |= balance("drive", everywhere, both, both, scene)[0]
    # Felt in free motion, a mass is beyond the sensor; falling off with speed, dry friction is Stribeck's.
    for wider, narrower in (("tool_inertia", "environment_mass"), ("stribeck_friction", "coulomb_friction")):
        if wider in named:
            named.discard(narrower)
    return {
        "named": sorted(named),
        "held_out": together([(held, count) for held, _, count in measured]),
        "refitted": together([(refitted, count) for _, refitted, count in measured]),
        "unit": case.unit,
    }


def main(balance):
    """One case from the command line."""
    started = time.perf_counter()
    found = answer(Case(sys.argv[1]), balance)
    found["seconds"] = time.perf_counter() - started
    print(json.dumps(found))
