"""An arm of two joints in a vertical plane, with friction in the elbow that its model lacks.

The shoulder's and the elbow's loads are MuJoCo's inverse dynamics of the model along the measured motion, without armature and damping
of the joints, which are the drives' own.
"""

import json
import math

import mujoco
import numpy as np

from machine import RATE_HZ, SUBSTEPS
from tool import by, names

JOINTS = ("shoulder", "elbow")
ARMATURE, DAMPING = (0.08, 0.02), (0.6, 0.15)
KP, KD = np.array([1500.0, 400.0]), np.array([40.0, 8.0])
# An encoder of 17 bits on each motor, behind a gear of 64.
ENCODER_STEP = 2 * math.pi / 2**23
SMOOTHING_HZ = 100.0

ARM = f"""<mujoco model="arm">
  <compiler angle="radian"/>
  <option timestep="{1 / (RATE_HZ * SUBSTEPS)}" integrator="implicitfast"/>
  <worldbody>
    <body name="upper">
      <joint name="shoulder" axis="0 1 0" armature="{ARMATURE[0]}" damping="{DAMPING[0]}"/>
      <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="2" contype="0" conaffinity="0"/>
      <body name="lower" pos="0.4 0 0">
        <joint name="elbow" axis="0 1 0" armature="{ARMATURE[1]}" damping="{DAMPING[1]}"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.02" mass="1" contype="0" conaffinity="0"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="shoulder" joint="shoulder"/>
    <motor name="elbow" joint="elbow"/>
  </actuator>
</mujoco>
"""


def elbow_friction(speed):
    """N m by rad/s: it grows less than the speed, which MJCF cannot say."""
    return 0.8 * (speed / 1.0) ** 0.4


def reference(trial):
    """Both joints, rad, from rest at zero."""
    rng = np.random.default_rng(3000 + trial)
    t = np.arange(15 * RATE_HZ) / RATE_HZ
    motion = []
    for base in ((0.2, 0.8), (0.3, 1.2)):
        x = np.zeros(len(t))
        for frequency, amplitude in ((base[0], base[1]), (0.9, 0.2), (2.3, 0.05), (5.1, 0.012), (9.0, 0.004)):
            x += amplitude * np.sin(2 * np.pi * frequency * rng.uniform(0.9, 1.1) * t + rng.uniform(0, 6))
        # Begun smoothly: a corner of the command is a blow that no filtered load follows.
        motion.append((x - x[0]) * np.sin(np.pi / 2 * np.minimum(t, 1.0)) ** 2)
    return np.column_stack(motion)


def play(xml, trial, seed, friction=None, module=None):
    """Time, both encoders and both efforts."""
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    step = module.Stepper(model, data).step if module else lambda: mujoco.mj_step(model, data)
    blend = 1.0 - math.exp(-2 * math.pi * 100.0 / RATE_HZ)
    wanted = reference(trial)
    noise = np.random.default_rng(seed).normal(0.0, 0.5 * ENCODER_STEP, wanted.shape)
    rows, before, rate, applied = [], None, np.zeros(2), 0.0
    mass = np.zeros((model.nv, model.nv))
    for row, target in enumerate(wanted):
        reading = np.round((data.qpos + noise[row]) / ENCODER_STEP) * ENCODER_STEP
        error = target - reading
        rate += blend * ((error - (error if before is None else before)) * RATE_HZ - rate)
        before = error
        effort = KP * error + KD * rate
        rows.append((row / RATE_HZ, *reading, *effort))
        data.ctrl[:] = effort
        for _ in range(SUBSTEPS):
            if friction:
                # The torque at the elbow that stops it within the step, as far as friction can hold it.
                data.qfrc_applied[1] = 0.0
                mujoco.mj_forward(model, data)
                mujoco.mj_fullM(model, data, mass)
                mobility = np.linalg.inv(mass)[1, 1]
                most = friction(abs(data.qvel[1]))
                stop = -(data.qvel[1] / model.opt.timestep + data.qacc[1]) / mobility
                data.qfrc_applied[1] = min(max(stop, -most), most)
            step()
    return np.array(rows)


def with_loads(xml, rows):
    """The rows with the load of each joint beside them."""
    model = mujoco.MjModel.from_xml_string(xml)
    model.dof_armature[:], model.dof_damping[:] = 0.0, 0.0
    data = mujoco.MjData(model)
    q, v, a = (smoothed(rows[:, 1:3], order) for order in range(3))
    loads = np.empty((len(rows), 2))
    for row in range(len(rows)):
        data.qpos[:], data.qvel[:], data.qacc[:] = q[row], v[row], a[row]
        mujoco.mj_inverse(model, data)
        loads[row] = data.qfrc_inverse
    # At its ends the mirror image turns the acceleration over: what the filter reaches there is left out.
    ends = slice(RATE_HZ // 5, -RATE_HZ // 5)
    return np.column_stack([rows, loads])[ends]


def smoothed(positions, order):
    """A derivative of a motion below SMOOTHING_HZ, by its spectrum without shift of phase; the motion is continued by its mirror image."""
    line = np.linspace(0, 1, len(positions))[:, None] * (positions[-1] - positions[0]) + positions[0]
    # What is left begins and ends at zero: turned about its ends it has no corner.
    rest = positions - line
    doubled = np.vstack([rest, -rest[::-1]])
    frequency = np.fft.rfftfreq(len(doubled), 1 / RATE_HZ)
    spectrum = np.fft.rfft(doubled, axis=0) * (1.0 / (1.0 + (frequency / SMOOTHING_HZ) ** 8))[:, None]
    spectrum *= ((2j * np.pi * frequency) ** order)[:, None]
    values = np.fft.irfft(spectrum, len(doubled), axis=0)[: len(positions)]
    if order == 0:
        return values + line
    return values + (line[-1] - line[0]) * (order == 1) * RATE_HZ / (len(positions) - 1)


HEADER = "t_s,q_shoulder,q_elbow,tau_shoulder,tau_elbow,load_shoulder,load_elbow"


def rig(joint):
    at = JOINTS.index(joint)
    return f"""[rig]
name = "{joint}"
coordinate = "rotary"
[columns]
position = "q_{joint}"
effort = "tau_{joint}"
load = "load_{joint}"
[drive]
inertia_kg_m2 = {ARMATURE[at]}
viscous_n_m_s_rad = {DAMPING[at]}
"""


def row(tool, folder):
    """Rows of the table: what is named in each joint, and the effort's error of each before and after."""
    (folder / "plain.xml").write_text(ARM)
    for trial in (1, 2):
        rows = with_loads(ARM, play(ARM, trial, trial, elbow_friction))
        np.savetxt(folder / f"trial-{trial}.csv", rows, delimiter=",", header=HEADER, comments="", fmt="%.12g")
    for joint in JOINTS:
        (folder / f"{joint}.toml").write_text(rig(joint))
    joints = [word for joint in JOINTS for word in ("--joint", f"{joint}={joint}.toml")]
    trials = ["trial-1.csv", "trial-2.csv"]
    told = tool.run(folder, "diagnose-joints", *joints, *trials, "--json", "joints.json", "--report", "joints.html", "--models", "improved")
    if told.returncode:
        return [("arm", "diagnose-joints failed: " + told.stderr.strip().splitlines()[-1], *["none"] * 3, "not exported")]
    named = {one["joint"]: one["diagnosis"] for one in json.loads((folder / "joints.json").read_text())["joints"]}
    model, module = ARM, None
    for joint in JOINTS:
        (folder / "model.xml").write_text(model)
        model, exported, _ = tool.export(folder, joint, f"{joint}.toml", f"improved/{joint}.toml", "model.xml")
        module = exported or module
    truth = play(ARM, 3, 3, elbow_friction)
    runs = (play(ARM, 3, 4), play(model, 3, 4, module=module), play(ARM, 3, 4, elbow_friction))
    def error(run, at):
        return f"{np.sqrt(np.mean((run[:, 3 + at] - truth[:, 3 + at]) ** 2)):.3f}"

    return [
        (f"arm, {joint}: {'sublinear_friction' if at else 'nothing'}", names(named[joint]), *(error(run, at) for run in runs), by(module if at else None))
        for at, joint in enumerate(JOINTS)
    ]
