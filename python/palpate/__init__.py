"""Names the physics that a simulation leaves out of a recording.

>>> import palpate
>>> d = palpate.diagnose(["track_1.csv", "track_2.csv"], "rig.toml")
>>> d.verdict, [physics.name for physics in d.physics]
"""

from __future__ import annotations

import contextlib as _contextlib
import html as _html
import json as _json
import os
import signal as _signal
import sys as _sys
import tempfile as _tempfile
import warnings as _warnings
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from . import _palpate

__version__ = _palpate.__version__
__all__ = [
    "ContactLaw",
    "Diagnosis",
    "FleetRig",
    "InputError",
    "JointsDiagnosis",
    "Parameter",
    "Physics",
    "RigResult",
    "diagnose",
    "diagnose_joints",
    "diagnose_rig",
    "export",
    "fleet",
    "main",
    "read",
]

# Work that gets a process of its own is started as this package, not as the interpreter alone.
_palpate.declare_program([_sys.executable, "-P", "-m", "palpate"], _palpate.__file__)


class InputError(ValueError):
    """An input at fault: `place` (file and line, column or key), what was `found`, what was `expected`."""

    def __init__(self, place: str, found: str, expected: str):
        super().__init__(f"{place}: found {found}, expected {expected}")
        self.place, self.found, self.expected = place, found, expected


@dataclass(frozen=True, eq=False)
class Parameter:
    """A value of an effect in `unit` (SI; "1" where it has none), with its 95 % interval `ci95`, an array of two."""

    name: str
    value: float
    unit: str
    ci95: np.ndarray


@dataclass(frozen=True, eq=False)
class Physics:
    """An effect that the simulation leaves out: `acts_in` the contact, the drive or the sensor."""

    name: str
    acts_in: str
    statement: str
    parameters: list[Parameter]
    evidence: dict = field(repr=False)


class Diagnosis:
    """What a diagnosis found. Every key of the JSON (`palpate schema diagnosis`) is an attribute.

    `physics` is a list of `Physics`, in order of evidence; `json` is the text that `palpate diagnose --json` writes, `html` the report's
    page, `model` the text of the improved rig file.
    """

    def __init__(self, json: str, html: str, model: str):
        self.json, self.html, self.model = json, html, model
        self._values = _json.loads(json)
        self.physics = [_physics(entry) for entry in self._values["physics"]]

    def __getattr__(self, name: str):
        if not name.startswith("_") and name in self._values:
            return self._values[name]
        raise AttributeError(f"a diagnosis has no {name}: {', '.join(self._values)}, html, json, model")

    def __dir__(self):
        return sorted({*super().__dir__(), *self._values})

    def as_dict(self) -> dict:
        """The JSON as Python's objects."""
        return _json.loads(self.json)

    def __repr__(self) -> str:
        return f"<palpate.Diagnosis {self.verdict}: {', '.join(p.name for p in self.physics) or 'nothing missing'}>"

    def _repr_html_(self) -> str:
        """The report, in a frame of its own: its page is whole and may not touch the notebook's."""
        return _frame(self.html)


class JointsDiagnosis(Mapping):
    """The diagnoses of an arm's joints, by the joint's name.

    `json` is the text that `palpate diagnose-joints --json` writes, `html` its page.
    """

    def __init__(self, json: str, html: str, joints: dict[str, Diagnosis]):
        self.json, self.html, self._joints = json, html, joints

    def __getitem__(self, joint: str) -> Diagnosis:
        return self._joints[joint]

    def __iter__(self):
        return iter(self._joints)

    def __len__(self) -> int:
        return len(self._joints)

    def __repr__(self) -> str:
        return f"<palpate.JointsDiagnosis {self._joints!r}>"

    def _repr_html_(self) -> str:
        """The report of all joints."""
        return _frame(self.html)


def _frame(page: str) -> str:
    return f'<iframe srcdoc="{_html.escape(page)}" style="width: 100%; height: 800px; border: 0"></iframe>'


def _physics(entry: dict) -> Physics:
    parameters = [
        Parameter(p["name"], p["value"], p["unit"], np.array(p["ci95"], dtype=float)) for p in entry["parameters"]
    ]
    return Physics(entry["name"], entry["acts_in"], entry["statement"], parameters, entry["evidence"])


def diagnose(recordings, rig, *, simulation=None, load=None, effort=None, seed: int = 1, progress=None) -> Diagnosis:
    """Finds where simulation and recordings differ, and which physics is missing.

    recordings: one or a list, one a trial. Each is the path of a file (CSV, NPZ, MAT version 5, Parquet, MCAP) or a mapping of column names
        to arrays, a data frame say: `t_s`, `position_m`, `force_N`, `effort_N`, ..., or `position_rad`, `torque_Nm`, `effort_Nm`.
    rig: the simulation: the path of a rig file, or a dictionary of its tables.
    simulation: what your own simulator gave for each recording, in the same order and columns.
    load: what your rigid-body model explains of the effort, N or N m, an array a recording: the drive's balance is effort - load.
    effort: the effort at the tool, N or N m, an array a recording.
    seed: of the noise that is drawn to estimate what the sensors alone would show in the drive; the contact draws none. The same seed
        gives the same answer to the bit.
    progress: called with a sentence at each step.

    Raises InputError for a file, array or value at fault. Ctrl-C ends the wait at once; the work itself ends at its next step.
    """
    with _as_input_error():
        return Diagnosis(*_palpate.diagnose(*_joint(recordings, rig, simulation, load, effort), seed, progress))


def diagnose_joints(
    recordings, rigs, *, simulation=None, load=None, effort=None, seed: int = 1, progress=None
) -> JointsDiagnosis:
    """Diagnoses each joint of an arm by itself, in one report.

    recordings, simulation, seed, progress: as in `diagnose`; the recordings hold all joints.
    rigs: each joint's rig, a path or a dictionary of its tables, by the joint's name. Its `[columns]` name what is this joint's.
    load, effort: what `diagnose` takes, by the joint's name, for those joints that have it.

    Raises InputError for a file, array or value at fault, and for a load or effort of a joint that has no rig.
    """
    load, effort = load or {}, effort or {}
    for name, given in (("load", load), ("effort", effort)):
        for joint in given:
            if joint not in rigs:
                raise InputError(f"{name}[{joint!r}]", "a joint without a rig", f"one of {', '.join(rigs)}")
    arm = [
        (name, *_joint(recordings, rig, simulation, load.get(name), effort.get(name), f"[{name!r}]"))
        for name, rig in rigs.items()
    ]
    with _as_input_error():
        json, page, answers = _palpate.diagnose_joints(arm, seed, progress)
    return JointsDiagnosis(json, page, {name: Diagnosis(*answer) for name, answer in zip(rigs, answers, strict=True)})


def _joint(recordings, rig, simulation, load, effort, of=""):
    """Rig, recordings and simulation as the extension module takes them; `of` names the joint in errors."""
    recordings, tables = _list(recordings), _rig(rig)
    simulation = [] if simulation is None else _list(simulation)
    if simulation and len(simulation) != len(recordings):
        raise InputError("simulation", f"{len(simulation)} of them", f"one a recording, {len(recordings)} in all")
    added = [[] for _ in recordings]
    for name, arrays in (("load", load), ("effort", effort)):
        if arrays is not None:
            arrays = [arrays] if len(recordings) == 1 and not isinstance(arrays, (list, tuple)) else list(arrays)
            if len(arrays) != len(recordings):
                raise InputError(name + of, f"{len(arrays)} arrays", f"one a recording, {len(recordings)} in all")
            for columns, array in zip(added, arrays, strict=True):
                columns.append((_column_name(name, rig), _array(name + of, array)))
    trials = [_recording(recording, columns) for recording, columns in zip(recordings, added, strict=True)]
    return tables, trials, [_recording(run, []) for run in simulation]


class ContactLaw:
    """The contact of a rig with its effects, for a simulator that has none of them: the tool's own engine, instant by instant.

    rig: the path of a rig file, or a dictionary of its tables; it needs a `[contact]`.

    Raises InputError for a rig at fault.
    """

    def __init__(self, rig):
        with _as_input_error():
            self._law = _palpate.ContactLaw(_rig(rig))

    def force(self, time: float, position: float, velocity: float, acceleration: float = 0.0) -> float:
        """The force on the tool in N (N m where the rig turns), positive when the tool pushes.

        Called once an instant, in the order of time: the law may remember what was. time in s; position in m or rad as the rig counts it,
        velocity and acceleration its rates.

        Raises InputError for a value that is not finite, and for time that goes back.
        """
        with _as_input_error():
            return self._law.force(time, position, velocity, acceleration)


def read(recording, rig) -> dict[str, np.ndarray]:
    """The channels of a recording as arrays in SI units: `time`, `position`, and those that it has of `velocity`, `force`, `effort`,
    `reference` and `load`. An effort that was not recorded is computed as the rig's `[effort]` says.

    Raises InputError for a file, array or value at fault.
    """
    with _as_input_error():
        return {name: np.frombuffer(values) for name, values in _palpate.read(_recording(recording, []), _rig(rig))}


def export(improved, into, joint: str, *, to: str = "mjcf", actuator=None, sensor=None, nominal=None, partial: bool = False) -> str:
    """The text of the model in the file `into`, with the physics that was found at `joint`; the file itself stays as it is.

    improved: a Diagnosis, or the path of an improved rig file. The joint's coordinate is taken for the rig's position and the force of its
        actuator for the effort: same sign, same zero, SI units.
    into: the path of the model, in MJCF, URDF or SDF.
    to: "mjcf", "urdf", "sdf", "drake" or "python", a module that steps MuJoCo with what MJCF cannot say.
    actuator: the joint's, where it has several. sensor: that of the contact force, for effects of the sensor.
    nominal: the path of the rig file that was diagnosed: what the recordings add to its inertia becomes armature of the joint (MJCF).
    partial: leave out, with a warning, what the format cannot say.

    Raises InputError for a joint that the model does not have, an element that it has already and, unless `partial`, an effect that the
    format cannot say. What else has to be known (the refitted inertia, say) is a warning.
    """
    with _contextlib.ExitStack() as stack, _as_input_error():
        if isinstance(improved, Diagnosis):
            text, folder = improved.model, stack.enter_context(_tempfile.TemporaryDirectory())
            improved = os.path.join(folder, "improved.toml")
            with open(improved, "w", encoding="utf-8") as file:
                file.write(text)
        paths = os.fspath(improved), os.fspath(into)
        text, notes, left_out = _palpate.export(to, *paths, joint, actuator, sensor, nominal and os.fspath(nominal), partial)
    for warning in [*notes, *(f"left out: {effect}" for effect in left_out)]:
        _warnings.warn(warning, stacklevel=2)
    return text


@dataclass(frozen=True)
class FleetRig:
    """A rig of a fleet: its `name`, its `rig` file and its `recordings`, absolute paths."""

    name: str
    rig: str
    recordings: tuple[str, ...]


@dataclass(frozen=True)
class RigResult:
    """What came of a rig of a fleet: the `json` of its diagnosis, or the `error` why there is none."""

    name: str
    json: str | None
    error: str | None


def fleet(source, out) -> list[FleetRig]:
    """The rigs that `palpate diagnose-all SOURCE --out OUT` diagnoses: a folder with a subfolder for each, or a manifest.

    Raises InputError where there is none.
    """
    with _as_input_error():
        listed = _palpate.fleet(os.path.abspath(source), os.path.abspath(out))
    return [FleetRig(name, str(rig), tuple(map(str, recordings))) for name, rig, recordings in listed]


def diagnose_rig(rig: FleetRig, out, *, seed: int = 1, threads: int = 1) -> RigResult:
    """Diagnoses one rig of a fleet, in a process of its own, into its folder below `out`: the worker of `palpate diagnose-all`, for
    engines that run functions on many machines (examples/fleet_dask.py). What is there of the same inputs is not done again. `threads`
    are those of the diagnosis; its answer does not depend on them.

    Whatever is wrong with the rig is the `error` of its result.
    """
    listed = rig.name, rig.rig, list(rig.recordings)
    return RigResult(rig.name, *_palpate.diagnose_rig(listed, os.path.abspath(out), seed, threads))


def main() -> int:
    """The command `palpate`."""
    # Python would only take note of Ctrl-C until the command is done.
    _signal.signal(_signal.SIGINT, _signal.SIG_DFL)
    return _palpate.command(["palpate", *_sys.argv[1:]])


class _as_input_error:
    """Turns the native error, whose arguments are its parts, into an InputError."""

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if isinstance(error, _palpate.NativeInputError):
            raise InputError(*error.args) from None
        return False


def _list(given) -> list:
    return [given] if isinstance(given, (str, os.PathLike, Mapping)) or hasattr(given, "columns") else list(given)


def _rig(rig):
    """A path, or tables as JSON in a tuple."""
    return (_json.dumps(rig),) if isinstance(rig, Mapping) else os.fspath(rig)


def _column_name(role: str, rig) -> str:
    """The name under which the rig looks for an added column."""
    if isinstance(rig, Mapping):
        tables = rig
    else:
        import tomllib

        try:
            with open(rig, "rb") as file:
                tables = tomllib.load(file)
        except (OSError, ValueError):
            # The rig file is read again, by the reader that says what is wrong with it.
            tables = {}
    given = tables.get("columns", {}).get(role)
    is_rotary = tables.get("rig", {}).get("coordinate") == "rotary"
    return given or f"{role}_{'Nm' if is_rotary else 'N'}"


def _recording(recording, added):
    if isinstance(recording, (str, os.PathLike)):
        return os.fspath(recording), added
    columns = recording.items()
    return [(str(name), _array(str(name), array)) for name, array in columns if _is_series(array)], added


def _is_series(array) -> bool:
    """Text and single numbers in a data frame or mapping are none of the recording."""
    array = np.asarray(array)
    return array.ndim > 0 and array.dtype.kind not in "USMm"


def _array(name: str, array) -> np.ndarray:
    array = np.asarray(array)
    if array.dtype.kind not in "fiub":
        raise InputError(name, f"an array of {array.dtype}", "numbers")
    if array.ndim != 1:
        raise InputError(name, f"an array of shape {array.shape}", "one number a row")
    return np.ascontiguousarray(array, dtype=np.float64)
