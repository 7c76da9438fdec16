"""Trials in MuJoCo.

The contact is MuJoCo's own soft constraint between a sphere and a plane. At a constant impedance d its force is

    F = max(0, K p + B v + M a),    M = d / ((1 - d) w),    w: MuJoCo's approximate inverse inertia of the contact,

so at the smallest impedance that MuJoCo knows it is the nominal law, and a larger one moves a mass along. A clamped
tool hangs on a spatial tendon, which is a spring and damper both ways. The force is that of a force sensor in the
weld between the carriage and the tip.
"""

import os
import sys

# This script is called like the library: its own folder comes last.
FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path = [path for path in sys.path if os.path.abspath(path) != FOLDER] + [FOLDER]

import mujoco  # noqa: E402

from protocol import PERIOD, Track, only, serve  # noqa: E402

STEPS = 10
SOFTEST = 1e-4
RADIUS = 0.05
ANCHOR = 1.0
EFFECTS = (
    "coulomb_friction",
    "gravity_load",
    "transmission_compliance",
    "backlash",
    "effort_saturation",
    "effort_lag",
    "tool_inertia",
    "channel_delay",
    "force_saturation",
    "environment_mass",
    "soft_constraint",
)

MODEL = """
<mujoco>
  <option timestep="{step}" gravity="{gravity} 0 0" integrator="implicitfast"/>
  <worldbody>
    <site name="anchor" pos="{anchor} 0 0"/>
    <geom name="surface" type="plane" pos="{surface} 0 0" zaxis="-1 0 0" size="1 1 1" condim="1" {solid}/>
    {motor}
    <body name="carriage">
      <joint name="tool" type="slide" axis="1 0 0" damping="{viscous}" {friction}/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>
      <body name="tip">
        <inertial pos="0 0 0" mass="{beyond}" diaginertia="1e-9 1e-9 1e-9"/>
        <site name="force_sensor"/>
        <geom name="tip" type="sphere" pos="-{radius} 0 0" size="{radius}" condim="1" priority="1" {solid}/>
      </body>
    </body>
  </worldbody>
  <tendon>{link}{clamp}</tendon>
  <actuator><general name="motor" joint="{driven}" {actuator}/></actuator>
  <sensor><force name="force" site="force_sensor" {force_sensor}/></sensor>
</mujoco>
"""

MOTOR = """
    <body name="motor">
      <joint name="motor" type="slide" axis="1 0 0" damping="{viscous}" {friction}/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>
    </body>"""


def build(rig, effects):
    """The model of `rig` with `effects`."""
    friction, gravity, compliance, backlash, saturation, lag, inertia, delay, end, moved, soft = only(effects, *EFFECTS)
    beyond = inertia["mass"] if inertia else 1e-6 * rig.mass
    dry = f'frictionloss="{friction["coulomb"]}"' if friction else ""
    cut = compliance or backlash
    tool = cut["tool_mass"] if cut else rig.mass
    share = tool / rig.mass
    motor = ""
    if cut:
        motor = MOTOR.format(viscous=(1 - share) * rig.viscous, mass=rig.mass - tool, friction=dry)
    text = MODEL.format(
        step=PERIOD / STEPS,
        gravity=-gravity["load"] / rig.mass if gravity else 0.0,
        anchor=ANCHOR,
        surface=rig.surface,
        radius=RADIUS,
        solid='contype="0" conaffinity="0"' if rig.bilateral else "",
        motor=motor,
        viscous=share * rig.viscous,
        friction="" if cut else dry,
        mass=tool - beyond,
        beyond=beyond,
        link=link(compliance, backlash),
        clamp=clamp(rig) if rig.bilateral else "",
        driven="motor" if cut else "tool",
        actuator=actuator(saturation, lag),
        force_sensor=force_sensor(delay, end),
    )
    model = mujoco.MjModel.from_xml_string(text)
    if not rig.bilateral:
        soften(model, rig, moved, soft)
    return model


def link(compliance, backlash):
    """Between motor and tool: a tendon with a spring, or one that is slack between two ends."""
    if compliance:
        law = f'stiffness="{compliance["stiffness"]}" damping="{compliance["damping"]}"'
    elif backlash:
        # The stops are MuJoCo's own limits, at the shortest time constant that its steps allow.
        half = 0.5 * backlash["gap"]
        law = f'limited="true" range="{-half} {half}" solreflimit="{2 * PERIOD / STEPS} 1"'
    else:
        return ""
    return f'<fixed name="link" {law}><joint joint="motor" coef="1"/><joint joint="tool" coef="-1"/></fixed>'


def clamp(rig):
    """To the environment: K p + B v both ways."""
    law = f'stiffness="{rig.stiffness}" damping="{rig.damping}" springlength="{ANCHOR - rig.surface}"'
    return f'<spatial name="clamp" {law}><site site="force_sensor"/><site site="anchor"/></spatial>'


def actuator(saturation, lag):
    """The motor."""
    law = f'dyntype="filterexact" dynprm="{lag["time_constant"]}"' if lag else 'dyntype="none"'
    if saturation:
        law += f' forcelimited="true" forcerange="{-saturation["limit"]} {saturation["limit"]}"'
    return law


def force_sensor(delay, end):
    """The force sensor."""
    law = ""
    if end:
        law += f' cutoff="{end["limit"]}"'
    if delay:
        samples = int(delay["delay"] / PERIOD * STEPS) + 4
        law += f' delay="{delay["delay"]}" nsample="{samples}" interp="linear"'
    return law


def soften(model, rig, moved, soft):
    """The constraint's stiffness, damping and impedance: K and B at d0, or in the middle where it changes."""
    tip = model.geom("tip").id
    inverse = model.body_invweight0[model.geom_bodyid[tip], 0]
    if soft:
        low, high, width = soft["impedance"], soft["deep_impedance"], soft["width"]
    else:
        low = SOFTEST
        if moved:
            low = max(SOFTEST, moved["mass"] * inverse / (1.0 + moved["mass"] * inverse))
        high, width = low, 1.0
    middle = 0.5 * (low + high)
    weight = (1.0 - middle) / middle * inverse
    # MuJoCo: k = stiffness d(p) / high^2, b = damping / high, F = (k p + b v + a) / ((1 - d) / d w).
    model.geom_solref[tip] = [-rig.stiffness * weight * high * high / middle, -rig.damping * weight * high]
    model.geom_solimp[tip] = [low, high, width, 0.5, 2.0]


def play(rig, loop, effects, reference):
    """One trial."""
    model = build(rig, effects)
    data = mujoco.MjData(model)
    data.qpos[:] = reference[0]
    tool = model.joint("tool").qposadr[0]
    track = Track()
    for wanted in reference:
        # At the row itself, under the effort so far: a step leaves the forces of its beginning.
        mujoco.mj_forward(model, data)
        track.force.append(pushed(data))
        position, velocity = float(data.qpos[tool]), float(data.qvel[tool])
        reading = loop.read(position)
        effort = loop.effort(wanted, reading)
        track.state(position, velocity, reading, effort)
        data.ctrl[0] = effort
        total = 0.0
        for _ in range(STEPS):
            mujoco.mj_step(model, data)
            total += pushed(data)
        track.force_mean.append(total / STEPS)
    return track


def pushed(data):
    """What the sensor feels, N, positive when the tool pushes."""
    return float(data.sensordata[0])


if __name__ == "__main__":
    serve(play)
