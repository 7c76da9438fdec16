"""Two real drives: EMPS, and axis 1 of a TX40.

A model of a drive has no position of its own to return to, so a free run of it wanders off however good it is. Therefore it is held to
the recorded motion by a spring and damper, and the force that these need is the model's error. What they follow is the straight line
between recorded positions, and its slope: a velocity from a smoothed position lags at each reversal, and the damper tells the lag as an
error of the model.
"""

import math

import mujoco
import numpy as np

from models import plain
from tool import by, values

# The spring and damper let errors through up to this frequency; a higher one lets more of the encoder's noise through.
HOLD_HZ = 15.0
STEP_S = 0.0005


def cases(folder):
    """Name, folder, units, trials diagnosed, the unused one, kind of joint, nominal inertia and damping, and the published friction, load."""
    emps, tx40 = folder / "emps_linear_drive", folder / "staubli_tx40_joints" / "joint1_with_load"
    return [
        ("EMPS", emps, ("m", "N"), ["track_1.csv"], "track_2.csv", "slide", 95.11, 203.5, 20.39, -3.16),
        ("TX40 axis 1", tx40, ("rad", "Nm"), ["trial-1.csv", "trial-2.csv"], "trial-3.csv", "hinge", 0.362, 8.05, 7.14, 0.39),
    ]


def holding_force(xml, module, table, inertia, columns):
    """The force that holds the model to the recording, a value a step."""
    model = mujoco.MjModel.from_xml_string(xml)
    model.opt.timestep = STEP_S
    data = mujoco.MjData(model)
    step = module.Stepper(model, data).step if module else lambda: mujoco.mj_step(model, data)
    t, x, effort, load = (table.get(name, 0.0 * table["t_s"]) for name in columns)
    stiffness, damping = inertia * (2 * math.pi * HOLD_HZ) ** 2, 1.4 * inertia * 2 * math.pi * HOLD_HZ
    slope = np.diff(x) / np.diff(t)
    data.qpos[0], data.qvel[0] = x[0], slope[0]
    forces, applied = [], 0.0
    for row, period in enumerate(np.diff(t)):
        for part in range(round(period / STEP_S)):
            target = x[row] + slope[row] * part * STEP_S
            force = stiffness * (target - data.qpos[0]) + damping * (slope[row] - data.qvel[0])
            data.ctrl[0] = effort[row] - load[row]
            data.qfrc_applied[0] += force - applied
            applied = force
            step()
            forces.append(force)
    return np.array(forces)


def published(xml, friction, load):
    """The user's model with what the makers published."""
    model = xml.replace("<joint ", f'<joint frictionloss="{friction}" solreffriction="{2 * STEP_S} 1" ')
    side = math.copysign(math.pi / 2, -load)
    constant = f'<dcmotor name="load" joint="axis" input="none" motorconst="0" resistance="1" cogging="{abs(load)} 0 {side}"/>'
    return model.replace("</actuator>", constant + "</actuator>")


def row(tool, work, case):
    """A row of the table."""
    name, folder, (position, effort), trials, unused, kind, inertia, damping, friction, load = case
    plain_model = plain(kind, inertia, damping).replace('timestep="0.0001"', f'timestep="{STEP_S}"')
    (work / "plain.xml").write_text(plain_model)
    diagnosis, fault = tool.diagnose(work, "--rig", folder / "rig.toml", *(folder / trial for trial in trials))
    if fault:
        return name, "diagnose failed: " + fault, *["none"] * 5, "not exported"
    named = ", ".join(f"{physics['name']} ({values(physics)})" for physics in diagnosis["physics"])
    model, module, _ = tool.export(work, "axis", folder / "rig.toml")
    columns = ("t_s", f"position_{position}", f"effort_{effort}", f"load_{effort}")
    table = np.genfromtxt(folder / unused, delimiter=",", names=True)
    table = {column: table[column] for column in table.dtype.names}
    measured = lambda xml, module=None: float(np.sqrt(np.mean(holding_force(xml, module, table, inertia, columns) ** 2)))
    told = diagnosis["fit"]
    own = f"{told['improved']:.2f} ({told['noise_floor']:.2f})"
    figures = (measured(plain_model), measured(model, module), measured(published(plain_model, friction, load)))
    return name, named, *(f"{figure:.2f}" for figure in figures), own, by(module)
