"""What is concealed in a machine, by other means than the export uses: forces in Python, tendons, gravity, altered commands and readings."""

import math
from dataclasses import dataclass
from collections.abc import Callable

import numpy as np

from machine import Machine, contacts, free_motion
from models import CONTACT_DAMPING, RIG, STIFFNESS, SURFACE_M, TOUCHING_RIG, TWO_MASSES, plain, touching


@dataclass(frozen=True)
class Case:
    """`channel` is the column that is compared: 2 the effort, 3 the force."""

    name: str
    concealed: Callable[[], Machine]
    model: str
    rig: str = RIG
    reference: Callable = free_motion
    channel: int = 2
    columns: int = 3


def cases():
    return [*drives(), *sensors(), *contact_laws()]


def drives():
    stribeck = lambda v, _: 0.6 + 0.5 * math.exp(-((v / 0.01) ** 2))
    exponential = lambda v, _: 0.6 + 0.5 * math.exp(-v / 0.01)
    slow = lambda v, _: 2.0 * (v / 0.1) ** 0.4
    wave = lambda x: -1.5 * math.sin(2 * math.pi * x / 0.006 + 0.7)
    gear = TWO_MASSES.format(motor=0.3, load=0.5, link='limited="true" range="-0.0002 0.0002" solreflimit="0.0005 1"')
    belt = TWO_MASSES.format(motor=0.3, load=0.5, link='stiffness="2500" damping="2"')
    two = plain(mass=0.5, armature=0.3)
    loaded = lambda: Machine(touching(), friction=lambda v, pressed: 0.15 * pressed)
    return [
        Case("coulomb_friction", lambda: Machine(plain(), friction=lambda v, _: 1.5), plain()),
        Case("stribeck_friction", lambda: Machine(plain(), friction=stribeck), plain()),
        Case("stribeck_friction, exponential", lambda: Machine(plain(), friction=exponential), plain()),
        Case("sublinear_friction", lambda: Machine(plain(), friction=slow), plain()),
        Case("load_dependent_friction", loaded, touching(), TOUCHING_RIG, contacts, 2, 4),
        Case("gravity_load", lambda: Machine(plain().replace('gravity="0 0 0"', 'gravity="-4 0 0"')), plain()),
        Case("cogging", lambda: Machine(plain(), force=wave), plain()),
        Case("backlash", lambda: Machine(gear), two),
        Case("transmission_compliance", lambda: Machine(belt), two),
        Case("effort_saturation", lambda: Machine(plain(), command=lambda u, dt: np.clip(u, -3.0, 3.0)), plain()),
        Case("effort_lag", lambda: Machine(plain(), command=lagged_command(0.004)), plain()),
    ]


def sensors():
    def case(name, reading):
        return Case(name, lambda: Machine(touching(), reading=reading), touching(), TOUCHING_RIG, contacts, 3, 4)

    time = lambda force, dt: np.arange(len(force)) * dt
    # MuJoCo's own sensor feels what it carries.
    heavy_tool = lambda: Machine(touching(beyond=0.05))
    return [
        case("channel_delay", lambda force, dt: np.interp(time(force, dt) - 0.0035, time(force, dt), force)),
        case("force_saturation", lambda force, dt: np.clip(force, -7.0, 7.0)),
        case("force_gain", lambda force, dt: 1.08 * force),
        case("force_lag", low_pass(0.004)),
        case("force_bias", lambda force, dt: force + 0.4),
        case("force_drift", lambda force, dt: force + 0.05 * time(force, dt)),
        case("mains_hum", lambda force, dt: force + 0.2 * np.sin(2 * np.pi * 50.0 * time(force, dt))),
        Case("tool_inertia", heavy_tool, touching(), TOUCHING_RIG, contacts, 3, 4),
    ]


def contact_laws():
    def case(name, law):
        return Case(name, lambda: Machine(touching(), contact=law()), touching(), TOUCHING_RIG, contacts, 3, 4)

    return [
        case("hunt_crossley_damping", lambda: Pressed(damping=lambda depth: CONTACT_DAMPING + 6000.0 * depth)),
        case("nonlinear_stiffness", lambda: Pressed(spring=lambda depth: STIFFNESS * depth + 1.5e7 * depth**3)),
        case("adhesion", lambda: Pressed(pull=0.8, release=0.0012)),
        case("plastic_set", lambda: Pressed(dent=0.25)),
        case("hysteresis (Bouc-Wen)", lambda: Pressed(loop=1.2, reach=0.0004)),
        case("stress_relaxation", lambda: Pressed(branch=600.0, fades=0.25)),
        case("layered_stiffness", lambda: Pressed(spring=lambda depth: STIFFNESS * depth + 1500.0 * max(0.0, depth - 0.003))),
        case("quadratic_damping", lambda: Pressed(drag=150.0)),
        case("lost_motion", lambda: Pressed(play=0.0004)),
        case("time_varying_stiffness", lambda: Pressed(stiffening=lambda time: 1.0 if time < 7.0 else 1.25)),
        case("surface_motion", lambda: Pressed(moved=lambda time: 0.0004 * math.sin(2 * math.pi * 0.3 * time))),
    ]


@dataclass
class Pressed:
    """A law of the contact with a memory. It never pulls, but for what holds on to the tool."""

    spring: Callable = lambda depth: STIFFNESS * depth
    damping: Callable = lambda depth: CONTACT_DAMPING
    # N s^2/m^2, of the square of the speed.
    drag: float = 0.0
    # N, and m above the surface at which it lets go.
    pull: float = 0.0
    release: float = 0.0
    # Share of the deepest contact that stays.
    dent: float = 0.0
    # N, and m over which it builds up.
    loop: float = 0.0
    reach: float = 1.0
    # N/m, and s.
    branch: float = 0.0
    fades: float = 1.0
    # m, whole width between the sensor and the tip.
    play: float = 0.0
    # Of the time in s: factor of the spring, and m by which the surface lies deeper.
    stiffening: Callable = lambda time: 1.0
    moved: Callable = lambda time: 0.0

    def __post_init__(self):
        self.time, self.tip, self.deepest, self.strain, self.spring_of_branch, self.is_held = 0.0, 0.0, 0.0, 0.0, 0.0, False

    def __call__(self, dt, position, velocity):
        depth, velocity = self.tip_within(dt, position, velocity)
        self.deepest = max(self.deepest, depth)
        depth -= self.dent * self.deepest
        if depth <= 0.0:
            self.strain = self.spring_of_branch = 0.0
            return self.neck(depth)
        self.is_held = True
        force = self.stiffening(self.time) * self.spring(depth)
        force += self.damping(depth) * velocity + self.drag * velocity * abs(velocity)
        if self.loop:
            # Bouc and Wen's with a sharpness of two, integrated as it moves.
            moved = velocity * dt / self.reach
            self.strain += (1.0 - abs(self.strain) ** 2 * (self.strain * moved > 0.0)) * moved
            force += self.loop * self.strain
        if self.branch:
            self.spring_of_branch += (self.branch * velocity - self.spring_of_branch / self.fades) * dt
            force += self.spring_of_branch
        return max(force, 0.0) + (max(min(force, 0.0), -self.pull) if velocity < 0.0 else 0.0)

    def tip_within(self, dt, position, velocity):
        """Depth and rate of the tip, which the sensor takes along at the ends of its play, in what is touched, which may move."""
        before, self.time = self.tip, self.time + dt
        self.tip = min(max(before, position - self.play / 2), position + self.play / 2)
        surface, earlier = self.moved(self.time), self.moved(self.time - dt)
        velocity = (velocity if self.tip != before else 0.0) - (surface - earlier) / dt
        return self.tip - SURFACE_M - surface, velocity

    def neck(self, depth):
        """Above the surface: what still holds on pulls as the spring would, and no more than `pull`."""
        self.is_held = self.is_held and depth > -self.release
        return max(STIFFNESS * depth, -self.pull) if self.is_held else 0.0


def lagged_command(constant):
    state = [0.0]

    def command(effort, dt):
        state[0] += (effort - state[0]) * -math.expm1(-dt / constant)
        return state[0]

    return command


def low_pass(constant):
    def reading(force, dt):
        state, out = force[0], np.empty(len(force))
        for at, value in enumerate(force):
            state += (value - state) * -math.expm1(-dt / constant)
            out[at] = state
        return out

    return reading
