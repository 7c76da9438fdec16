"""Trials in Exudyn.

The contact is Exudyn's own between two spheres on the line of motion, K d (p/d)^n. With its own linear damping it would
pull when the tool leaves quickly, which the nominal law does not; so the damper is a spring-damper with a user function
in Exudyn's symbolic expressions: B v in contact, and never more than would make the contact pull. Friction is Exudyn's
bristle model with Stribeck's curve, the gap of a transmission its limit stops, the clamp of a clamped tool its linear
spring-damper.
"""

import os
import sys

# This script is called like the library: its own folder comes last.
FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path = [path for path in sys.path if os.path.abspath(path) != FOLDER] + [FOLDER]

import exudyn  # noqa: E402
from exudyn.advancedUtilities import CreateSymbolicUserFunction  # noqa: E402
from exudyn.itemInterface import (  # noqa: E402
    CoordinateSpringDamper,
    CoordinateSpringDamperExt,
    LoadCoordinate,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    NodeGenericData,
    NodePointGround,
    NodeRigidBody2D,
    ObjectContactSphereSphere,
    ObjectGround,
    ObjectRigidBody2D,
    SensorNode,
    SensorObject,
)

import numpy as np  # noqa: E402
from protocol import PERIOD, Track, only, serve  # noqa: E402

STEPS = 10
RADIUS = 1.0
EFFECTS = (
    "nonlinear_stiffness",
    "coulomb_friction",
    "stribeck_friction",
    "gravity_load",
    "transmission_compliance",
    "backlash",
)


class Model:
    """The multibody system of one trial."""

    def __init__(self, rig, effects, start):
        power, dry, slowing, gravity, compliance, backlash = only(effects, *EFFECTS)
        self.mbs = exudyn.SystemContainer().AddSystem()
        self.start = start
        self.ground = self.mbs.AddObject(ObjectGround())
        self.fixed = self.mbs.AddMarker(
            MarkerNodeCoordinate(nodeNumber=self.mbs.AddNode(NodePointGround()), coordinate=0)
        )
        cut = compliance or backlash
        mass = cut["tool_mass"] if cut else rig.mass
        share = mass / rig.mass
        self.node, self.body, self.tool = self.slide(mass)
        self.damper(self.fixed, self.tool, 0.0, share * rig.viscous)
        motor = self.tool
        if cut:
            _, _, motor = self.slide(rig.mass - mass)
            self.damper(self.fixed, motor, 0.0, (1 - share) * rig.viscous)
        if compliance:
            self.damper(motor, self.tool, compliance["stiffness"], compliance["damping"])
        elif backlash:
            self.stops(motor, backlash, mass * (1 - share))
        if dry or slowing:
            self.friction(motor, dry or slowing, rig)
        if gravity:
            self.mbs.AddLoad(LoadCoordinate(markerNumber=motor, load=-gravity["load"]))
        self.motor = self.mbs.AddLoad(LoadCoordinate(markerNumber=motor, load=0.0))
        self.forces = self.clamp(rig) if rig.bilateral else self.contact(rig, power)
        self.states = [
            self.mbs.AddSensor(SensorNode(nodeNumber=self.node, outputVariableType=kind, storeInternal=True, writeToFile=False))
            for kind in (exudyn.OutputVariableType.Coordinates, exudyn.OutputVariableType.Coordinates_t)
        ]
        self.mbs.Assemble()

    def slide(self, mass):
        """A body on the line of motion: its node, itself and its coordinate."""
        node = self.mbs.AddNode(
            NodeRigidBody2D(referenceCoordinates=[0, 0, 0], initialCoordinates=[self.start, 0, 0])
        )
        body = self.mbs.AddObject(ObjectRigidBody2D(mass=mass, inertia=mass * 1e-4, nodeNumber=node))
        return node, body, self.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))

    def damper(self, one, other, stiffness, damping):
        """A linear spring and damper."""
        return self.mbs.AddObject(
            CoordinateSpringDamper(markerNumbers=[one, other], stiffness=stiffness, damping=damping)
        )

    def data(self, *first):
        """A node for what a connector remembers, and what that is at first."""
        return self.mbs.AddNode(NodeGenericData(numberOfDataCoordinates=len(first), initialCoordinates=list(first)))

    def stops(self, motor, backlash, reduced):
        """A gap between two limit stops, as stiff as 10 kHz can resolve and half damped."""
        rate = 3000.0
        self.mbs.AddObject(
            CoordinateSpringDamperExt(
                markerNumbers=[motor, self.tool],
                nodeNumber=self.data(0.0, 0.0, 0.0),
                useLimitStops=True,
                limitStopsUpper=0.5 * backlash["gap"],
                limitStopsLower=-0.5 * backlash["gap"],
                limitStopsStiffness=reduced * rate * rate,
                limitStopsDamping=reduced * rate,
            )
        )

    def friction(self, marker, law, rig):
        """Exudyn's bristles, which bend by micrometres before they slip."""
        most = law.get("static", law["coulomb"])
        stiffness = most / 2e-6
        self.mbs.AddObject(
            CoordinateSpringDamperExt(
                markerNumbers=[self.fixed, marker],
                # Whether it slips, where it stuck last, and the state of limit stops that it has not.
                nodeNumber=self.data(0.0, self.start, 0.0),
                dynamicFrictionForce=law["coulomb"],
                staticFrictionOffsetForce=most - law["coulomb"],
                exponentialDecayStatic=law.get("stribeck_velocity", 1.0),
                stickingStiffness=stiffness,
                stickingDamping=(stiffness * rig.mass) ** 0.5,
            )
        )

    def clamp(self, rig):
        """K p + B v both ways."""
        spring = self.mbs.AddObject(
            CoordinateSpringDamper(
                markerNumbers=[self.fixed, self.tool],
                stiffness=rig.stiffness,
                damping=rig.damping,
                offset=rig.surface,
            )
        )
        return [self.force(spring, 0, 1.0)]

    def contact(self, rig, power):
        """Two spheres that meet at the surface, and the damper of the nominal law."""
        exponent, stiffness = 1.0, rig.stiffness
        if power:
            exponent = power["exponent"]
            stiffness = rig.stiffness * power["reference_depth"] ** (1.0 - exponent)
        wall = self.mbs.AddMarker(MarkerBodyRigid(bodyNumber=self.ground, localPosition=[rig.surface + RADIUS, 0, 0]))
        tip = self.mbs.AddMarker(MarkerBodyRigid(bodyNumber=self.body, localPosition=[-RADIUS, 0, 0]))
        gap = rig.surface - self.start
        spheres = self.mbs.AddObject(
            ObjectContactSphereSphere(
                markerNumbers=[tip, wall],
                nodeNumber=self.data(gap, 0.0, 0.0, 0.0),
                spheresRadii=[RADIUS, RADIUS],
                contactStiffness=stiffness,
                contactStiffnessExponent=exponent,
            )
        )
        damper = self.nominal_damper(rig, stiffness, exponent)
        return [self.force(spheres, 0, -1.0), self.force(damper, 0, 1.0)]

    def nominal_damper(self, rig, stiffness, exponent):
        """B v in contact, and no more than keeps the sum with the contact from pulling."""
        symbolic = exudyn.symbolic
        surface = rig.surface

        def law(mbs, t, itemNumber, displacement, velocity, stiffness_, damping_, offset):
            depth = symbolic.max(displacement - surface, symbolic.Real(0.0))
            elastic = stiffness * depth if exponent == 1.0 else stiffness * symbolic.pow(depth, symbolic.Real(exponent))
            held = symbolic.max(damping_ * velocity, -1.0 * elastic)
            return symbolic.IfThenElse(depth > 0.0, held, symbolic.Real(0.0))

        damper = self.damper(self.fixed, self.tool, 0.0, rig.damping)
        function = CreateSymbolicUserFunction(self.mbs, law, "springForceUserFunction", damper)
        self.mbs.SetObjectParameter(damper, "springForceUserFunction", function)
        self.function = function
        return damper

    def force(self, connector, component, sign):
        """A sensor of a connector's force."""
        sensor = self.mbs.AddSensor(
            SensorObject(
                objectNumber=connector,
                outputVariableType=exudyn.OutputVariableType.Force,
                storeInternal=True,
                writeToFile=False,
            )
        )
        return sensor, component, sign


def play(rig, loop, effects, reference):
    """One trial."""
    model = Model(rig, effects, float(reference[0]))
    mbs, track = model.mbs, Track()
    rows, step = len(reference), PERIOD / STEPS
    count = 0

    def control(mbs, _):
        nonlocal count
        row, within = divmod(count, STEPS)
        count += 1
        if within == 0 and row < rows:
            position = mbs.GetNodeOutput(model.node, exudyn.OutputVariableType.Coordinates)[0]
            reading = loop.read(position)
            effort = loop.effort(reference[row], reading)
            track.reading.append(reading)
            track.effort.append(effort)
            mbs.SetLoadParameter(model.motor, "load", effort)
        return True

    mbs.SetPreStepUserFunction(control)
    mbs.SolveDynamic(settings(rows, step), solverType=exudyn.DynamicSolverType.ExplicitMidpoint)
    position, velocity = (mbs.GetSensorStoredData(sensor)[:, 1] for sensor in model.states)
    force = sum(sign * mbs.GetSensorStoredData(sensor)[:, 1 + at] for sensor, at, sign in model.forces)
    track.position, track.velocity, track.force = (all[: rows * STEPS : STEPS] for all in (position, velocity, force))
    trapezoids = 0.5 * (force[:-1] + force[1:])
    track.force_mean = trapezoids.reshape(rows, STEPS).mean(axis=1)
    return track


def settings(rows, step):
    """Steps of even length, nothing but the sensors stored."""
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = rows * STEPS
    settings.timeIntegration.endTime = rows * STEPS * step
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    return settings


if __name__ == "__main__":
    exudyn.config.printToConsole = False
    serve(play)
