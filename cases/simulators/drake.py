"""Trials in Drake.

Discrete multibody dynamics with compliant point contact. In Drake's SAP approximation the contact is linear,
F = max(0, k (p + tau v)) with tau the relaxation time of its material: the nominal law with k = K and tau = B / K. Its
TAMSI approximation has the contact of Hunt and Crossley instead, F = k p max(0, 1 + d v), and no linear damping.
Friction is that of a shoe which is drawn over a plane. A clamped tool has a linear spring-damper to the environment.
The force is the reaction in the weld between the carriage and the tip.

Drake's discrete step, v' = v + h (effort - F) / m and x' = x + h v', is that of Stoermer and Verlet: effort and force
act at t, where x is known, and v is the velocity half a step before. A row is therefore read half a step before the
instant of its x: there the position is x - h v / 2, the velocity is v, an effort commanded from the row on is held from
that instant on, and the force is the mean of the steps before and after. SAP has the spring of the end of its step,
k (p + h v' + tau v'), so tau is shorter by h. TAMSI has k (p + h v') (1 + d v'), a damper k h beside the law that no
value takes off: its steps are finer.
"""

import os
import sys

# This script is called like the library: its own folder comes last.
FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path = [path for path in sys.path if os.path.abspath(path) != FOLDER] + [FOLDER]

from pydrake.geometry import AddContactMaterial, Box, HalfSpace, ProximityProperties, Sphere  # noqa: E402
from pydrake.math import RigidTransform  # noqa: E402
from pydrake.multibody.plant import AddMultibodyPlant, CoulombFriction, MultibodyPlantConfig  # noqa: E402
from pydrake.multibody.tree import (  # noqa: E402
    LinearSpringDamper,
    PrismaticJoint,
    SpatialInertia,
    UnitInertia,
    WeldJoint,
)
from pydrake.systems.analysis import Simulator  # noqa: E402
from pydrake.systems.framework import DiagramBuilder  # noqa: E402

import logging  # noqa: E402

from protocol import PERIOD, Track, only, serve  # noqa: E402

STEPS = 2
STEPS_OF_TAMSI = 6
RADIUS = 0.05
ANCHOR = 1.0
EFFECTS = (
    "hunt_crossley_damping",
    "coulomb_friction",
    "gravity_load",
    "transmission_compliance",
    "tool_inertia",
    "effort_saturation",
)


class Model:
    """The diagram of one trial."""

    def __init__(self, rig, effects, start):
        deep, friction, gravity, compliance, inertia, saturation = only(effects, *EFFECTS)
        builder = DiagramBuilder()
        self.steps = STEPS_OF_TAMSI if deep else STEPS
        self.step = PERIOD / self.steps
        # Drake's lagged approximation has the same contact and takes four times as long a step; it is what is left once
        # TAMSI, which Drake means to drop, is gone.
        config = MultibodyPlantConfig(
            time_step=self.step,
            contact_model="point",
            discrete_contact_approximation="tamsi" if deep else "sap",
        )
        self.plant, _ = AddMultibodyPlant(config, builder)
        weight = -gravity["load"] / rig.mass if gravity else 0.0
        self.plant.mutable_gravity_field().set_gravity_vector([weight, 0.0, 0.0])
        mass = compliance["tool_mass"] if compliance else rig.mass
        share = mass / rig.mass
        beyond = inertia["mass"] if inertia else 1e-6 * rig.mass
        carriage, self.tool = self.slide("tool", mass - beyond, share * rig.viscous)
        tip = self.plant.AddRigidBody("tip", point_mass(beyond))
        self.force_sensor = self.plant.AddJoint(WeldJoint("force_sensor", carriage.body_frame(), tip.body_frame(), RigidTransform()))
        driven, motor = carriage, self.tool
        if compliance:
            driven, motor = self.slide("motor", rig.mass - mass, (1 - share) * rig.viscous)
            self.spring(driven, carriage, compliance["stiffness"], compliance["damping"], ANCHOR)
        if friction:
            self.shoe(driven, friction["coulomb"])
        limit = saturation["limit"] if saturation else float("inf")
        self.plant.AddJointActuator("motor", motor, limit)
        if rig.bilateral:
            self.spring(tip, None, rig.stiffness, rig.damping, ANCHOR - rig.surface)
        else:
            self.surface(tip, rig, deep)
        self.plant.Finalize()
        self.simulator = Simulator(builder.Build())
        self.context = self.plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        for joint in {self.tool, motor}:
            joint.set_translation(self.context, start)
        self.effort = self.plant.get_actuation_input_port().FixValue(self.context, [0.0])
        self.reactions = self.plant.get_reaction_forces_output_port()
        self.simulator.Initialize()

    def slide(self, name, mass, viscous):
        """A body on the line of motion, and its joint."""
        body = self.plant.AddRigidBody(name, point_mass(mass))
        joint = PrismaticJoint(name, self.plant.world_frame(), body.body_frame(), [1, 0, 0], damping=viscous)
        return body, self.plant.AddJoint(joint)

    def spring(self, behind, ahead, stiffness, damping, length):
        """A spring and damper to a point ahead on the other body, or in the world."""
        law = {"free_length": length, "stiffness": stiffness, "damping": damping}
        ahead = ahead or self.plant.world_body()
        self.plant.AddForceElement(LinearSpringDamper(behind, [0, 0, 0], ahead, [ANCHOR, 0, 0], **law))

    def surface(self, tip, rig, deep):
        """A sphere that meets a wall at the surface."""
        dissipation = deep["alpha"] / rig.stiffness if deep else 0.0
        relaxation = max(rig.damping / rig.stiffness - self.step, 0.0)
        material = solid(rig.stiffness, 0.0, dissipation, relaxation)
        self.plant.RegisterCollisionGeometry(tip, RigidTransform([-RADIUS, 0, 0]), Sphere(RADIUS), "tip", material)
        wall = RigidTransform([rig.surface + 0.5, 0, 0])
        self.plant.RegisterCollisionGeometry(self.plant.world_body(), wall, Box(1, 1, 1), "wall", material)

    def shoe(self, body, level):
        """A shoe that the guide presses into a plane beside the motion by a millimetre, which is a newton."""
        material = solid(1000.0, level, 0.0, 0.0)
        shoe, floor = RigidTransform([-1.0, 0, -1.0 + RADIUS - 1e-3]), RigidTransform([-1.0, 0, -1.5])
        self.plant.RegisterCollisionGeometry(body, shoe, Sphere(RADIUS), "shoe", material)
        self.plant.RegisterCollisionGeometry(self.plant.world_body(), floor, Box(1, 1, 1), "floor", material)

    def pushed(self):
        """What the weld feels, N, positive when the tool pushes."""
        reactions = self.reactions.Eval(self.context)
        return reactions[int(self.force_sensor.index())].translational()[0]


def point_mass(mass):
    """Nothing here turns."""
    return SpatialInertia(mass, [0, 0, 0], UnitInertia.SolidSphere(RADIUS))


def solid(stiffness, friction, dissipation, relaxation):
    """One of two equal materials that together have these properties: stiffness in series halves, the rest adds up."""
    properties = ProximityProperties()
    AddContactMaterial(
        dissipation=dissipation,
        point_stiffness=2.0 * stiffness,
        friction=CoulombFriction(friction, friction),
        properties=properties,
    )
    properties.AddProperty("material", "relaxation_time", 0.5 * relaxation)
    return properties


def play(rig, loop, effects, reference):
    """One trial."""
    model = Model(rig, effects, float(reference[0]))
    track, count, before = Track(), 0, None
    for wanted in reference:
        velocity = model.tool.get_translation_rate(model.context)
        position = model.tool.get_translation(model.context) - 0.5 * model.step * velocity
        reading = loop.read(position)
        effort = loop.effort(wanted, reading)
        track.state(position, velocity, reading, effort)
        model.effort.GetMutableData().set_value([effort])
        forces = []
        for _ in range(model.steps):
            count += 1
            model.simulator.AdvanceTo(count * model.step)
            forces.append(model.pushed())
        # Drake knows of no force before its first step: a clamped tool is taken to have rested until then.
        track.force.append(0.5 * (forces[0] + (forces[0] if before is None else before)))
        track.force_mean.append(sum(forces) / model.steps)
        before = forces[-1]
    return track


if __name__ == "__main__":
    logging.getLogger("drake").setLevel(logging.ERROR)
    serve(play)
