import math

import mujoco
import numpy as np


def stribeck(p, speed, borne):
    return p["level"] + p["breakaway_excess"] * math.exp(-speed / p["stribeck_speed"])


# Friction laws: the most that each can hold at a speed, N or N m. `borne` is the force that the tool presses with, and the weight.
FRICTION = {
    "sublinear_friction": lambda p, speed, borne: p["level"] * (speed / p["reference_speed"]) ** p["exponent"],
    "stribeck_friction": stribeck,
    "load_dependent_friction": lambda p, speed, borne: p["load_coefficient"] * abs(borne),
}


def by_position(p, q):
    turn = 2.0 * math.pi * q / p["length"]
    return p["sine"] * math.sin(turn) + p["cosine"] * math.cos(turn)


# The weight at a position, N or N m, by its form. The model itself has it; friction can grow with it.
WEIGHT = {
    "constant": lambda p, q: p["load"],
    "by_angle": lambda p, q: p["sine"] * math.sin(q) + p["cosine"] * math.cos(q) + p["load"],
    "by_position": by_position,
}


class Joint:
    """A joint, its friction, the contact's law that acts along it, and what a force sensor makes of the force."""

    def __init__(self, model, name, effects, contact, contact_force):
        joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
        if joint < 0:
            raise ValueError(f"the model has no joint {name}")
        self.qpos, self.dof = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        self.frictions = [(FRICTION[effect], values) for effect, _, values in effects if effect in FRICTION]
        self.weights = [(WEIGHT[form], values) for effect, form, values in effects if effect == "gravity_load"]
        self.sensor = [effect for effect in effects if effect[0] in SENSOR]
        self.law, self.given = None, contact_force
        if contact is not None:
            import tomllib

            import palpate

            self.law = palpate.ContactLaw(tomllib.loads(contact))
        bears = self.law is not None or contact_force is not None or self.weights
        if not bears and any(effect == "load_dependent_friction" for effect, _, _ in effects):
            raise ValueError(f"load_dependent_friction of joint {name} needs contact_force")
        self.friction = 0.0  # The friction that acts in this step, N or N m.
        self.contact = 0.0  # The force that the tool presses with, N or N m.
        self.memory = {}

    def touch(self, data):
        """The contact's force at the time of `data`."""
        if self.law is not None:
            at = data.qpos[self.qpos], data.qvel[self.dof], data.qacc[self.dof]
            self.contact = self.law.force(data.time, *at)
        elif self.given is not None:
            self.contact = self.given()

    def most(self, data):
        """The most that friction can hold."""
        speed = abs(data.qvel[self.dof])
        borne = self.contact + sum(weight(values, data.qpos[self.qpos]) for weight, values in self.weights)
        return sum(law(values, speed, borne) for law, values in self.frictions)


class Stepper:
    """Steps a MuJoCo model with the physics of a joint that MJCF cannot say.

    Call `step()` in place of `mujoco.mj_step(model, data)`.

    contact_force: a function that returns the force that the tool presses with, N or N m at the joint; needed for friction that depends
        on the load, where this module holds neither a law of the contact nor a weight. A dictionary by the joint's name for several joints.
    surface: the name of the geom that is touched. Where this module holds the contact's law, the geom's own contact is switched off in
        `model`.
    also: other modules of this kind, one a joint: their frictions are found together.
    """

    def __init__(self, model, data, contact_force=None, surface=None, also=()):
        given = contact_force if isinstance(contact_force, dict) else {JOINT: contact_force}
        parts = [(JOINT, EFFECTS, CONTACT), *((part.JOINT, part.EFFECTS, part.CONTACT) for part in also)]
        self._model, self._data = model, data
        self.joints = {name: Joint(model, name, effects, law, given.get(name)) for name, effects, law in parts}
        if surface is not None and any(joint.law is not None for joint in self.joints.values()):
            geom = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, surface)
            if geom < 0:
                raise ValueError(f"the model has no geom {surface}")
            model.geom_contype[geom] = model.geom_conaffinity[geom] = 0
        self._dofs = np.array([joint.dof for joint in self.joints.values()])
        self._units = np.zeros((len(self._dofs), model.nv))
        self._units[np.arange(len(self._dofs)), self._dofs] = 1.0
        self._applied = np.zeros(len(self._dofs))

    def step(self):
        """One time step.

        Friction is the force that brings the joints to rest at the end of the step, as far as the laws can hold them: it never reverses
        a motion, and it holds at rest. The contact's force is that at the beginning of the step, which has to be short beside the
        time in which contact and masses swing.
        """
        model, data = self._model, self._data
        data.qfrc_applied[self._dofs] -= self._applied
        mujoco.mj_forward(model, data)
        joints = list(self.joints.values())
        for joint in joints:
            joint.touch(data)
        pressed = np.array([joint.contact if joint.law is not None else 0.0 for joint in joints])
        most = np.array([joint.most(data) for joint in joints])
        response = np.zeros_like(self._units)
        mujoco.mj_solveM(model, data, response, self._units)
        mobility = response[:, self._dofs]
        free = data.qvel[self._dofs] / model.opt.timestep + data.qacc[self._dofs] - mobility @ pressed
        friction = hold(mobility, free, most)
        for joint, force in zip(joints, friction):
            joint.friction = float(force)
        self._applied = friction - pressed
        data.qfrc_applied[self._dofs] += self._applied
        mujoco.mj_step(model, data)

    def reading(self, force=None, joint=JOINT):
        """What the force sensor shows of `force` (the contact's law where it is None), at the time of `data`; called once a step."""
        joint = self.joints[joint]
        force = joint.contact if force is None else force
        for name, form, values in joint.sensor:
            force = SENSOR[name](force, form, values, self._model, self._data, joint)
        return force


def hold(mobility, free, most):
    """Forces within -most to most that bring free + mobility force to zero where they can: projected Gauss-Seidel."""
    force = np.zeros(len(free))
    for _ in range(100):
        before = force.copy()
        for i in range(len(force)):
            rest = free[i] + mobility[i] @ force
            force[i] = min(max(force[i] - rest / mobility[i, i], -most[i]), most[i])
        if len(force) == 1 or np.abs(force - before).max() <= 1e-9 * most.max():
            break
    return force


def low_pass(force, values, step, joint):
    """A first-order low-pass, exact for a force that is straight between two steps."""
    before, state = joint.memory.get("low_pass", (force, force))
    ratio = step / values["time_constant"]
    decay = math.exp(-ratio)
    slope = (force - before) / ratio
    state = decay * state + (1.0 - decay) * (before - slope) + slope * ratio
    joint.memory["low_pass"] = force, state
    return state


def drift(time, form, values):
    """The zero of the force sensor at a time."""
    if form == "settling":
        return -values["settled"] * math.expm1(-time / values["time_constant"])
    if form == "wandering":
        zeros = [values[f"zero_{knot}"] for knot in range(1, 9)]
        return float(np.interp(time, np.linspace(0.0, values["span"], 8), zeros))
    return values["rate"] * time + values.get("offset", 0.0)


def hum(time, values):
    """A tone."""
    phase = 2.0 * math.pi * values["frequency"] * time
    return values["sine"] * math.sin(phase) + values["cosine"] * math.cos(phase)


def parasitic(form, values, position, velocity):
    """A force of free motion, as of a cable or of water, that the force sensor feels."""
    if form == "by_place":
        q = (position - values["origin"]) / values["length"]
        return values["constant"] + values["linear"] * q + values["square"] * q**2 + values["cubic"] * q**3
    q = velocity / values["speed"]
    return values["linear"] * q + values["square"] * q * abs(q)


def saturated(force, values):
    """The end of a sensor's range, rounded where it has a knee."""
    beyond = abs(force) - values["limit"]
    knee = values.get("knee", 0.0) * values["limit"]
    if knee == 0.0:
        return force - math.copysign(max(beyond, 0.0), force)
    cut = max(beyond, 0.0) + knee * math.log1p(math.exp(-abs(beyond) / knee))
    return force - math.copysign(cut, force)


# What the force sensor makes of a force, N or N m.
SENSOR = {
    "tool_inertia": lambda f, form, p, model, data, joint: f + p["beyond_mass"] * data.qacc[joint.dof],
    "parasitic_force": lambda f, form, p, model, data, joint: f
    + parasitic(form, p, data.qpos[joint.qpos], data.qvel[joint.dof]),
    "force_gain": lambda f, form, p, model, data, joint: f * (1.0 + p["gain_error"]),
    "force_lag": lambda f, form, p, model, data, joint: low_pass(f, p, model.opt.timestep, joint),
    "force_bias": lambda f, form, p, model, data, joint: f + p["bias"],
    "force_drift": lambda f, form, p, model, data, joint: f + drift(data.time, form, p),
    "mains_hum": lambda f, form, p, model, data, joint: f + hum(data.time, p),
    "force_saturation": lambda f, form, p, model, data, joint: saturated(f, p),
}
