import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

__version__: str

PathOrTables: TypeAlias = str | os.PathLike[str] | Mapping[str, Any]
Recording: TypeAlias = str | os.PathLike[str] | Mapping[str, ArrayLike] | Any

class InputError(ValueError):
    place: str
    found: str
    expected: str
    def __init__(self, place: str, found: str, expected: str) -> None: ...

class Parameter:
    name: str
    value: float
    unit: str
    ci95: np.ndarray

class Physics:
    name: str
    acts_in: str
    statement: str
    parameters: list[Parameter]
    evidence: dict[str, Any]

class Diagnosis:
    schema: str
    verdict: str
    summary: str
    physics: list[Physics]
    rivals: list[dict[str, Any]]
    locations: list[dict[str, Any]]
    fit: dict[str, Any]
    channels: list[dict[str, Any]]
    nominal: list[dict[str, Any]]
    correlations: list[dict[str, Any]]
    checked: list[str]
    findings: list[dict[str, Any]]
    json: str
    html: str
    model: str
    def __init__(self, json: str, html: str, model: str) -> None: ...
    def __getattr__(self, name: str) -> Any: ...
    def as_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...

class JointsDiagnosis(Mapping[str, Diagnosis]):
    json: str
    html: str
    def __init__(self, json: str, html: str, joints: dict[str, Diagnosis]) -> None: ...
    def __getitem__(self, joint: str) -> Diagnosis: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def _repr_html_(self) -> str: ...

class ContactLaw:
    def __init__(self, rig: PathOrTables) -> None: ...
    def force(self, time: float, position: float, velocity: float, acceleration: float = 0.0) -> float: ...

def diagnose(
    recordings: Recording | Sequence[Recording],
    rig: PathOrTables,
    *,
    simulation: Recording | Sequence[Recording] | None = None,
    load: ArrayLike | Sequence[ArrayLike] | None = None,
    effort: ArrayLike | Sequence[ArrayLike] | None = None,
    seed: int = 1,
    progress: Callable[[str], object] | None = None,
) -> Diagnosis: ...
def diagnose_joints(
    recordings: Recording | Sequence[Recording],
    rigs: Mapping[str, PathOrTables],
    *,
    simulation: Recording | Sequence[Recording] | None = None,
    load: Mapping[str, ArrayLike | Sequence[ArrayLike]] | None = None,
    effort: Mapping[str, ArrayLike | Sequence[ArrayLike]] | None = None,
    seed: int = 1,
    progress: Callable[[str], object] | None = None,
) -> JointsDiagnosis: ...
def read(recording: Recording, rig: PathOrTables) -> dict[str, np.ndarray]: ...
def export(
    improved: Diagnosis | str | os.PathLike[str],
    into: str | os.PathLike[str],
    joint: str,
    *,
    to: Literal["mjcf", "urdf", "sdf", "drake", "python"] = "mjcf",
    actuator: str | None = None,
    sensor: str | None = None,
    nominal: str | os.PathLike[str] | None = None,
    partial: bool = False,
) -> str: ...
@dataclass(frozen=True)
class FleetRig:
    name: str
    rig: str
    recordings: tuple[str, ...]

@dataclass(frozen=True)
class RigResult:
    name: str
    json: str | None
    error: str | None

def fleet(source: str | os.PathLike[str], out: str | os.PathLike[str]) -> list[FleetRig]: ...
def diagnose_rig(
    rig: FleetRig, out: str | os.PathLike[str], *, seed: int = 1, threads: int = 1
) -> RigResult: ...
def main() -> int: ...
