"""What every simulator here has in common: requests, the controller, and the track that is recorded.

A request is one line of JSON on standard input, followed by its references as raw little-endian doubles, one trial
after the other:

    {"rows": [n1, n2],
     "nominal": {"mass", "viscous", "stiffness", "damping", "surface", "bilateral"},    kg, N s/m, N/m, N s/m, m
     "control": {"proportional", "derivative", "filter_hz"},                             N/m, N s/m, Hz
     "encoder": {"step", "offset"},                                                      m
     "effects": {"coulomb_friction": {"coulomb": 0.1}, ...}}                             as the answers state them

The answer is one line, {"rows": [n1, n2], "columns": [...]}, followed by raw doubles: for each trial its columns one
after the other. What the simulator has not is answered by {"error": "..."}, and a trial that it could not bring to an
end by {"gave_up": "..."}. Before the first request a script says {"ready": true}.
"""

import json
import math
import sys
import traceback
from dataclasses import dataclass, field

import numpy as np

PERIOD = 1e-3
COLUMNS = ("position", "velocity", "reading", "force", "force_mean", "effort")


@dataclass
class Rig:
    """The nominal rig: m a + b v = effort - F, F = max(0, K p + B v) for p = x - surface > 0."""

    mass: float
    viscous: float
    stiffness: float
    damping: float
    surface: float
    bilateral: bool


@dataclass
class Loop:
    """The controller at 1 kHz on the encoder's reading: PD with a filtered difference, its output held for a period."""

    proportional: float
    derivative: float
    filter_hz: float
    step: float
    offset: float
    last: float | None = None
    slope: float = 0.0

    def read(self, position):
        """What the encoder says: whole steps, with the zero anywhere between two of them."""
        return self.step * math.floor((position + self.offset) / self.step + 0.5)

    def effort(self, wanted, reading):
        """N until the next row."""
        error = wanted - reading
        before = error if self.last is None else self.last
        self.last = error
        share = -math.expm1(-2.0 * math.pi * self.filter_hz * PERIOD)
        self.slope += share * ((error - before) / PERIOD - self.slope)
        return self.proportional * error + self.derivative * self.slope


@dataclass
class Track:
    """One trial, row by row at 1 kHz."""

    position: list = field(default_factory=list)
    velocity: list = field(default_factory=list)
    reading: list = field(default_factory=list)
    force: list = field(default_factory=list)
    force_mean: list = field(default_factory=list)
    effort: list = field(default_factory=list)

    def state(self, position, velocity, reading, effort):
        """The state at a row, and what is commanded from there on."""
        self.position.append(position)
        self.velocity.append(velocity)
        self.reading.append(reading)
        self.effort.append(effort)


class Unplayable(Exception):
    """The simulator has no such physics."""


def serve(play):
    """Answers requests by `play(rig, loop, effects, reference) -> Track` until standard input ends."""
    source, sink = sys.stdin.buffer, sys.stdout.buffer
    # What a simulator prints must not fall into the answers.
    sys.stdout = sys.stderr
    _say(sink, {"ready": True})
    while line := source.readline():
        request = json.loads(line)
        references = [np.frombuffer(source.read(8 * rows), dtype="<f8") for rows in request["rows"]]
        try:
            tracks = [_trial(play, request, reference) for reference in references]
        except Unplayable as missing:
            _say(sink, {"error": f"there is no {missing} here"})
        except Exception as error:
            traceback.print_exc()
            _say(sink, {"gave_up": f"{type(error).__name__}: {error}"})
        else:
            values = [np.asarray(getattr(track, column), dtype="<f8") for track in tracks for column in COLUMNS]
            _say(sink, {"rows": request["rows"], "columns": COLUMNS}, values)


def _say(sink, head, values=()):
    sink.write(json.dumps(head).encode() + b"\n")
    for column in values:
        sink.write(column.tobytes())
    sink.flush()


def _trial(play, request, reference):
    rig = Rig(**request["nominal"])
    loop = Loop(**request["control"], **request["encoder"])
    track = play(rig, loop, request["effects"], reference)
    for column in COLUMNS:
        if len(getattr(track, column)) != len(reference):
            raise RuntimeError(f"{column}: {len(getattr(track, column))} rows for {len(reference)}")
    return track


def only(effects, *known):
    """The values of each of `known`, none where it is not concealed; anything else cannot be played."""
    unknown = set(effects) - set(known)
    if unknown:
        raise Unplayable(", ".join(sorted(unknown)))
    return [effects.get(name) for name in known]
