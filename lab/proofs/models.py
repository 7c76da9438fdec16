"""The users' models: an axis alone, an axis that touches something, and two masses joined by a tendon."""

import mujoco

MASS_KG = 0.8
DAMPING = 4.0
SURFACE_M, STIFFNESS, CONTACT_DAMPING = 0.002, 1500.0, 8.0

PLAIN = """<mujoco model="axis">
  <!-- an axis of the bench -->
  <compiler angle="radian"/>
  <option timestep="0.0001" gravity="0 0 0" integrator="implicitfast"/>
  <worldbody>
    <body name="carriage">
      <joint name="axis" type="{kind}" axis="1 0 0" damping="{damping}" armature="{armature}"/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{mass} {mass} {mass}"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="drive" joint="axis"/>   <!-- effort in SI units -->
  </actuator>
</mujoco>
"""

# A soft constraint of the least impedance is spring and damper, one way.
TOUCHING = """<mujoco model="press">
  <option timestep="0.0001" gravity="0 0 0" integrator="implicitfast"/>
  <worldbody>
    <geom name="surface" type="plane" pos="{surface} 0 0" zaxis="-1 0 0" size="1 1 1" condim="1"/>
    <body name="carriage">
      <joint name="axis" type="slide" axis="1 0 0" damping="4.0"/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>
      <body name="tip">
        <inertial pos="0 0 0" mass="{beyond}" diaginertia="1e-9 1e-9 1e-9"/>
        <site name="flange"/>
        <geom name="tip" type="sphere" pos="-0.05 0 0" size="0.05" condim="1" priority="1" solref="{solref}" solimp="1e-4 1e-4 1"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="drive" joint="axis"/></actuator>
  <sensor><force name="wrist" site="flange"/></sensor>   <!-- its x is the contact's force -->
</mujoco>
"""

# Two masses joined by a tendon: `link` is its attributes.
TWO_MASSES = """<mujoco>
  <option timestep="0.0001" gravity="0 0 0" integrator="implicitfast"/>
  <worldbody>
    <body name="motor"><joint name="axis" type="slide" axis="1 0 0" damping="4.0"/>
      <inertial pos="0 0 0" mass="{motor}" diaginertia="1 1 1"/></body>
    <body name="load"><joint name="load" type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="{load}" diaginertia="1 1 1"/></body>
  </worldbody>
  <tendon><fixed name="link" {link}><joint joint="axis" coef="1"/><joint joint="load" coef="-1"/></fixed></tendon>
  <actuator><motor name="drive" joint="axis"/></actuator>
</mujoco>
"""

RIG = f"""[rig]
name = "axis"
coordinate = "linear"
[drive]
mass_kg = {MASS_KG}
viscous_n_s_m = {DAMPING}
encoder = "motor"
"""

TOUCHING_RIG = f"""{RIG}
[contact]
surface_m = {SURFACE_M}
stiffness_n_m = {STIFFNESS}
damping_n_s_m = {CONTACT_DAMPING}
"""


def plain(kind="slide", mass=MASS_KG, damping=DAMPING, armature=0.0):
    return PLAIN.format(kind=kind, mass=mass, damping=damping, armature=armature)


def touching(beyond=1e-6):
    """The axis before a surface of STIFFNESS and CONTACT_DAMPING; of its mass `beyond` is on the tool's side of the force sensor."""
    values = {"surface": SURFACE_M, "mass": MASS_KG - beyond, "beyond": beyond}
    first = mujoco.MjModel.from_xml_string(TOUCHING.format(**values, solref="-1 -1"))
    impedance = 1e-4
    inverse = first.body_invweight0[first.geom_bodyid[first.geom("tip").id], 0]
    # MuJoCo: F = (k p + b v) / ((1 - d) / d w), k = stiffness / d, b = damping / d, with the minus of solref's direct form.
    weight = (1.0 - impedance) / impedance * inverse
    solref = f"{-STIFFNESS * weight * impedance} {-CONTACT_DAMPING * weight * impedance}"
    return TOUCHING.format(**values, solref=solref)
