import math

import mujoco
import numpy as np

# Friction laws: the most that each can hold at a speed, N or N m. `contact` is the force that the tool presses with.
LAWS = {
    "sublinear_friction": lambda p, speed, contact: p["level"] * (speed / p["reference_speed"]) ** p["exponent"],
    "stribeck_friction": lambda p, speed, contact: (
        p["level"] + p["breakaway_excess"] * math.exp(-speed / p["stribeck_speed"])
    ),
    "load_dependent_friction": lambda p, speed, contact: p["load_coefficient"] * abs(contact),
}


class Stepper:
    """Steps a MuJoCo model with the friction of one joint that MJCF cannot say.

    Call `step()` in place of `mujoco.mj_step(model, data)`. `contact_force()` returns the force that the tool presses with, in newtons
    or newton metres at the joint; it is needed for friction that depends on the load. `reading(force)`, once a step, is what the force
    sensor shows of a true force.
    """

    def __init__(self, model, data, contact_force=None):
        joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, JOINT)
        if joint < 0:
            raise ValueError(f"the model has no joint {JOINT}")
        frictions = [(LAWS[name], values) for name, values in EFFECTS if name in LAWS]
        if contact_force is None and any(name == "load_dependent_friction" for name, _ in EFFECTS):
            raise ValueError("load_dependent_friction needs contact_force")
        self._model, self._data, self._frictions = model, data, frictions
        self._dof = model.jnt_dofadr[joint]
        self._contact_force = contact_force or (lambda: 0.0)
        self._applied = 0.0
        self._unit = np.zeros((1, model.nv))
        self._unit[0, self._dof] = 1.0
        self._lagged = None

    def step(self):
        """One time step.

        Friction is the force that brings the joint to rest at the end of the step, as far as the laws can hold it: it never reverses a
        motion, and it holds at rest.
        """
        model, data, dof = self._model, self._data, self._dof
        data.qfrc_applied[dof] -= self._applied
        mujoco.mj_forward(model, data)
        speed, contact = abs(data.qvel[dof]), self._contact_force()
        most = sum(law(values, speed, contact) for law, values in self._frictions)
        response = np.zeros_like(self._unit)
        mujoco.mj_solveM(model, data, response, self._unit)
        hold = -(data.qvel[dof] / model.opt.timestep + data.qacc[dof]) / response[0, dof]
        self._applied = min(max(hold, -most), most)
        data.qfrc_applied[dof] += self._applied
        mujoco.mj_step(model, data)

    def reading(self, force):
        """What the force sensor shows of `force`, at the time of `data`; called once a step."""
        values = dict(EFFECTS)
        force *= 1.0 + values.get("force_gain", {}).get("gain_error", 0.0)
        if "force_lag" in values:
            before = force if self._lagged is None else self._lagged
            part = -math.expm1(-self._model.opt.timestep / values["force_lag"]["time_constant"])
            force = self._lagged = before + part * (force - before)
        return force + values.get("force_bias", {}).get("bias", 0.0)
