"""A MuJoCo model under a PD controller on a noisy encoder, and the trials that it plays."""

import math

import mujoco
import numpy as np

RATE_HZ = 1000
SUBSTEPS = 10
DURATION_S = 15.0
KP, KD, DERIVATIVE_HZ = 2000.0, 60.0, 100.0
ENCODER_STEP, ENCODER_NOISE = 5e-6, 2e-6
FORCE_NOISE = 0.01


class Machine:
    """A model of one axis, what acts on it besides, and what becomes of a command and of a force.

    force: by position. friction: the most that it holds, by speed and contact force. command: what the drive makes of the commanded
    effort. contact: a law of time step, position and velocity, instead of the model's own contact. reading: what the sensor makes of
    the force, an array at the rate of the steps. module: an exported one.
    """

    def __init__(self, xml, force=None, friction=None, command=None, contact=None, reading=None, module=None):
        self.model = mujoco.MjModel.from_xml_string(xml)
        self.data = mujoco.MjData(self.model)
        self.force, self.friction, self.command, self.contact, self.reading = force, friction, command, contact, reading
        self.has_surface = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_GEOM, "surface") >= 0
        if contact:
            surface = self.model.geom("surface").id
            self.model.geom_contype[surface] = self.model.geom_conaffinity[surface] = 0
        self.pressed = 0.0
        self.stepper = None
        self.step = self.plain_step
        if module:
            pressed = (lambda: self.data.sensordata[0]) if self.has_surface else None
            self.stepper = module.Stepper(self.model, self.data, pressed, "surface" if module.CONTACT else None)
            self.step = self.stepped

    def stepped(self):
        self.stepper.step()
        sensed = self.data.sensordata[0] if self.has_surface else 0.0
        (joint,) = self.stepper.joints.values()
        self.pressed = self.stepper.reading(joint.contact if joint.law else sensed)

    def plain_step(self):
        data, dt = self.data, self.model.opt.timestep
        applied = self.force(data.qpos[0]) if self.force else 0.0
        if self.contact:
            self.pressed = self.contact(dt, data.qpos[0], data.qvel[0])
            applied -= self.pressed
        if self.friction:
            # The force that stops a single body within the step, as far as friction can hold it.
            mass, damping = self.model.body_subtreemass[1], self.model.dof_damping[0]
            free = data.ctrl[0] + applied - damping * data.qvel[0] - (0.0 if self.contact else self.pressed)
            most = self.friction(abs(data.qvel[0]), abs(self.pressed))
            applied += np.clip(-(data.qvel[0] * mass / dt + free), -most, most)
        data.qfrc_applied[0] = applied
        mujoco.mj_step(self.model, data)
        if self.has_surface and not self.contact:
            self.pressed = self.data.sensordata[0]

    def play(self, reference, seed):
        """Time, encoder, effort and force of a trial; the effort is what the controller commands."""
        rng = np.random.default_rng(seed)
        noise, force_noise = (rng.normal(0.0, size, len(reference)) for size in (ENCODER_NOISE, FORCE_NOISE))
        blend = 1.0 - math.exp(-2 * math.pi * DERIVATIVE_HZ / RATE_HZ)
        rows, before, rate = [], None, 0.0
        # A step leaves the force of its beginning.
        forces = np.zeros(len(reference) * SUBSTEPS)
        for row, target in enumerate(reference):
            reading = round((self.data.qpos[0] + noise[row]) / ENCODER_STEP) * ENCODER_STEP
            error = target - reading
            rate += blend * ((error - (error if before is None else before)) * RATE_HZ - rate)
            before = error
            effort = KP * error + KD * rate
            rows.append((row / RATE_HZ, reading, effort))
            for part in range(SUBSTEPS):
                self.data.ctrl[0] = self.command(effort, self.model.opt.timestep) if self.command else effort
                self.step()
                forces[row * SUBSTEPS + part] = self.pressed
        if self.reading:
            forces = self.reading(forces, self.model.opt.timestep)
        return np.column_stack([np.array(rows), forces[::SUBSTEPS] + force_noise])


def free_motion(trial):
    """Fast and slow reversals, another mixture each trial, beginning at rest at zero."""
    rng = np.random.default_rng(1000 + trial)
    t = np.arange(int(DURATION_S * RATE_HZ)) / RATE_HZ
    x = 0.03 * np.sin(2 * np.pi * rng.uniform(0.15, 0.25) * t)
    for frequency, amplitude in ((0.9, 0.01), (2.3, 0.004), (5.1, 0.0015), (11.0, 0.0004), (17.0, 0.0002), (27.0, 0.0001)):
        x += amplitude * np.sin(2 * np.pi * frequency * rng.uniform(0.9, 1.1) * t + rng.uniform(0, 6))
    return (x - x[0]) * np.minimum(t / 0.5, 1.0)


def contacts(trial):
    """A contact each 1.5 s, each to another depth at another speed, with free motion between, beginning at rest at zero."""
    rng = np.random.default_rng(2000 + trial)
    t = np.arange(int(DURATION_S * RATE_HZ)) / RATE_HZ
    x = np.zeros(len(t))
    wanted, at = 0.0, [0.0, 0.0]
    for row, time in enumerate(t):
        phase = time % 1.5
        if row % int(1.5 * RATE_HZ) == 0:
            depth, lag = rng.uniform(0.006, 0.014), rng.uniform(0.03, 0.12)
        wanted = depth if phase > 0.5 else -0.003
        at[0] += (wanted - at[0]) / (lag * RATE_HZ)
        at[1] += (at[0] - at[1]) / (lag * RATE_HZ)
        x[row] = at[1]
    for frequency, amplitude in ((2.3, 0.0004), (5.1, 0.0003), (11.0, 0.0002), (23.0, 0.0001)):
        x += amplitude * np.sin(2 * np.pi * frequency * rng.uniform(0.9, 1.1) * t + rng.uniform(0, 6))
    return (x - x[0]) * np.minimum(t / 0.5, 1.0)
