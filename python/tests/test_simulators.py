"""What an exported module does in MuJoCo, against the definitions of the effects."""

import math
import types

import numpy as np
import pytest

import palpate

mujoco = pytest.importorskip("mujoco")

MODEL = """<mujoco>
  <option timestep="0.0005" gravity="0 0 0" integrator="implicitfast"/>
  <worldbody>
    <geom name="wall" type="plane" pos="0.01 0 0" zaxis="-1 0 0" size="1 1 1"/>
    <body name="carriage">
      <joint name="axis" type="slide" axis="1 0 0" damping="3"/>
      <geom type="sphere" pos="-0.02 0 0" size="0.02" mass="1"/>
    </body>
  </worldbody>
  <actuator><motor name="drive" joint="axis"/></actuator>
</mujoco>
"""
TABLES = '[rig]\nname = "axis"\n[drive]\nmass_kg = 1.0\nviscous_n_s_m = 3.0\n'
CONTACT = "[contact]\nsurface_m = 0.01\nstiffness_n_m = 1000.0\ndamping_n_s_m = 2.0\n"


def module(folder, effects, model=MODEL, joint="axis", rig=TABLES + CONTACT):
    """The exported module."""
    (folder / "improved.toml").write_text(rig + effects)
    (folder / "model.xml").write_text(model)
    with pytest.warns() if "adhesion" in effects else _nothing():
        text = palpate.export(folder / "improved.toml", folder / "model.xml", joint, to="python")
    made = types.SimpleNamespace()
    exec(text, made.__dict__)
    return made


class _nothing:
    def __enter__(self):
        return self

    def __exit__(self, *_):
        return False


def test_the_engines_contact_is_a_spring_and_a_damper():
    law = palpate.ContactLaw(
        {"rig": {"name": "c"}, "contact": {"surface_m": 0.01, "stiffness_n_m": 1000.0, "damping_n_s_m": 2.0}}
    )
    assert law.force(0.0, 0.009, 1.0) == 0.0
    assert law.force(0.001, 0.013, 0.5) == pytest.approx(1000.0 * 0.003 + 2.0 * 0.5, rel=1e-12)
    # It pushes and does not pull.
    assert law.force(0.002, 0.0101, -1.0) == 0.0
    with pytest.raises(palpate.InputError, match="time.*0.001 s after 0.002 s"):
        law.force(0.001, 0.0, 0.0)
    with pytest.raises(palpate.InputError, match="velocity.*NaN"):
        law.force(0.003, 0.0, math.nan)
    with pytest.raises(palpate.InputError, match=r"no \[contact\]"):
        palpate.ContactLaw({"rig": {"name": "c"}, "drive": {"mass_kg": 1.0, "viscous_n_s_m": 3.0}})


def test_a_contact_that_holds_on_pulls_in_mujoco(folder_of_test):
    """Pressed in and drawn out slowly by a spring: the pull is the greatest that the law knows."""
    effect = '[[effect]]\nname = "adhesion"\nform = "neck"\npull_off_force_n = 0.8\nrelease_height_m = 0.002\n'
    made = module(folder_of_test, effect)
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    stepper = made.Stepper(model, data, surface="wall")
    forces, depths = [], []
    for row in range(8000):
        target = 0.01 + 0.004 * math.sin(2 * math.pi * row / 8000)
        data.ctrl[0] = 3000.0 * (target - data.qpos[0]) - 60.0 * data.qvel[0]
        stepper.step()
        forces.append(stepper.reading())
        depths.append(data.qpos[0] - 0.01)
        assert data.ncon == 0, "the wall's own contact is on beside the law"
    assert min(forces) == pytest.approx(-0.8, abs=1e-9)
    # At rest in the middle of the push the spring bears it all: 4 mm of the target are shared 1000 to 3000.
    assert max(forces) == pytest.approx(1000.0 * 0.004 * 3000 / 4000, rel=0.02)
    assert forces[-1] == 0.0 and max(depths) > 0.0029


@pytest.fixture
def folder_of_test(tmp_path):
    return tmp_path


ARM = """<mujoco>
  <compiler angle="radian"/>
  <option timestep="0.001" gravity="0 0 0"/>
  <worldbody>
    <body><joint name="shoulder" axis="0 0 1"/><geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="2" contype="0"/>
      <body pos="0.4 0 0"><joint name="elbow" axis="0 0 1"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.02" mass="1" contype="0"/></body></body>
  </worldbody>
  <actuator><motor joint="shoulder"/><motor joint="elbow"/></actuator>
</mujoco>
"""


def test_a_joint_rubs_by_the_weight_that_it_carries(folder_of_test):
    """A quarter of the weight, which the model itself has: at a quarter of a turn 1 N m of 4, hanging down none."""
    physics = (
        '[[effect]]\nname = "gravity_load"\nform = "by_angle"\nsine_n_m = 4.0\ncosine_n_m = 0.0\nload_n_m = 0.0\n'
        '[[effect]]\nname = "load_dependent_friction"\nload_coefficient = 0.25\n'
    )
    rig = '[rig]\nname = "j"\ncoordinate = "rotary"\n[drive]\ninertia_kg_m2 = 0.1\nviscous_n_m_s_rad = 0.0\n'
    made = module(folder_of_test, physics, ARM, "shoulder", rig)

    def pushed(angle, torque):
        model = mujoco.MjModel.from_xml_string(ARM)
        data = mujoco.MjData(model)
        data.qpos[0] = angle
        data.ctrl[0] = torque
        stepper = made.Stepper(model, data)
        for _ in range(50):
            stepper.step()
        return abs(data.qpos[0] - angle)

    assert pushed(np.pi / 2, 0.99) < 1e-9 < 1e-4 < pushed(np.pi / 2, 1.2)
    assert pushed(0.0, 0.2) > 1e-4


def test_one_stepper_holds_several_joints(folder_of_test):
    """Two joints whose friction holds more than is asked of it stand still; one alone would be dragged along by the other."""
    rub = '[[effect]]\nname = "sublinear_friction"\nlevel_n_m = 2.0\nexponent = 0.0\nreference_speed_rad_s = 1.0\n'
    rig = '[rig]\nname = "j"\ncoordinate = "rotary"\n[drive]\ninertia_kg_m2 = 0.1\nviscous_n_m_s_rad = 0.0\n'
    shoulder, elbow = (module(folder_of_test, rub, ARM, joint, rig) for joint in ("shoulder", "elbow"))

    def run(torques, also):
        model = mujoco.MjModel.from_xml_string(ARM)
        data = mujoco.MjData(model)
        stepper = shoulder.Stepper(model, data, also=also)
        for _ in range(500):
            data.ctrl[:] = torques
            stepper.step()
        return data, stepper

    held, stepper = run([1.9, -1.9], [elbow])
    assert np.abs(held.qvel).max() < 1e-9
    assert [joint.friction for joint in stepper.joints.values()] == pytest.approx([-1.9, 1.9], abs=1e-6)
    # Beyond what it holds the elbow slides, and the friction is all that there is against it; the shoulder still stands.
    slides, stepper = run([0.0, 2.3], [elbow])
    assert slides.qvel[1] > 0.1 and abs(slides.qvel[0]) < 1e-9
    assert stepper.joints["elbow"].friction == pytest.approx(-2.0, abs=1e-9)
    loose, _ = run([1.9, -1.9], [])
    assert abs(loose.qvel[1]) > 0.1
    model = mujoco.MjModel.from_xml_string(ARM.replace('name="elbow"', 'name="knee"').replace('joint="elbow"', 'joint="knee"'))
    with pytest.raises(ValueError, match="no joint elbow"):
        shoulder.Stepper(model, mujoco.MjData(model), also=[elbow])



SENSOR = {
    "force_gain": ("gain_error = 0.05\n", lambda f, t: 1.05 * f),
    "force_bias": ("bias_n = 0.3\n", lambda f, t: f + 0.3),
    "force_drift": ("rate_n_s = 0.2\n", lambda f, t: f + 0.2 * t),
    "mains_hum": (
        "sine_n = 0.3\ncosine_n = 0.1\nfrequency_hz = 50.0\n",
        lambda f, t: f + 0.3 * np.sin(100 * np.pi * t) + 0.1 * np.cos(100 * np.pi * t),
    ),
    "force_saturation": (
        'form = "rounded"\nlimit_n = 2.0\nknee = 0.05\n',
        lambda f, t: f - 0.1 * np.log1p(np.exp((np.abs(f) - 2.0) / 0.1)) * np.sign(f),
    ),
    # The closed form for a force that grows evenly from zero at rest.
    "force_lag": ("time_constant_s = 0.02\n", lambda f, t: 3.0 * (t - 0.02 * -np.expm1(-t / 0.02))),
}


@pytest.mark.parametrize("name", SENSOR)
def test_the_sensor_shows_what_the_effect_says(folder_of_test, name):
    keys, wanted = SENSOR[name]
    made = module(folder_of_test, f'[[effect]]\nname = "{name}"\n{keys}')
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    stepper = made.Stepper(model, data)
    times = np.arange(2000) * model.opt.timestep
    shown = []
    for time in times:
        data.time = time
        shown.append(stepper.reading(3.0 * time))
    assert shown == pytest.approx(wanted(3.0 * times, times), abs=1e-9)


PARASITIC = {
    "cable": (
        'form = "by_place"\norigin_m = 0.01\nlength_m = 0.02\nconstant_n = 0.1\nlinear_n = 0.2\nsquare_n = 0.3\ncubic_n = 0.4\n',
        # q = -1/2 at the origin of the joint.
        0.1 - 0.2 / 2 + 0.3 / 4 - 0.4 / 8,
    ),
    # q = -2.
    "water": ('form = "by_speed"\nspeed_m_s = 0.1\nlinear_n = 0.2\nsquare_n = 0.3\n', -0.2 * 2 - 0.3 * 4),
}


@pytest.mark.parametrize("name", PARASITIC)
def test_the_sensor_shows_a_force_of_free_motion(folder_of_test, name):
    keys, wanted = PARASITIC[name]
    made = module(folder_of_test, f'[[effect]]\nname = "parasitic_force"\n{keys}')
    model = mujoco.MjModel.from_xml_string(MODEL)
    data = mujoco.MjData(model)
    data.qvel[0] = -0.2
    assert made.Stepper(model, data).reading(3.0) == pytest.approx(3.0 + wanted, abs=1e-12)


URDF = """<robot name="r">
  <link name="base"/>
  <link name="slide"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="axis" type="prismatic"><parent link="base"/><child link="slide"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" velocity="9" effort="9"/></joint>
</robot>
"""


def test_an_exported_urdf_is_one_to_mujoco(folder_of_test):
    effects = (
        '[[effect]]\nname = "coulomb_friction"\nform = "symmetric"\nlevel_n = 0.45\n'
        '[[effect]]\nname = "effort_saturation"\nlimit_n = 6.0\n'
    )
    (folder_of_test / "improved.toml").write_text(TABLES + effects)
    (folder_of_test / "r.urdf").write_text(URDF)
    text = palpate.export(folder_of_test / "improved.toml", folder_of_test / "r.urdf", "axis", to="urdf")
    model = mujoco.MjModel.from_xml_string(text)
    assert model.dof_frictionloss[0] == 0.45 and model.dof_damping[0] == 3.0
    assert list(model.jnt_actfrcrange[0]) == [-6.0, 6.0]


def test_an_exported_model_is_one_to_drake(folder_of_test):
    """Where Drake is installed, which the other tests do not need."""
    drake = pytest.importorskip("pydrake.all")
    (folder_of_test / "improved.toml").write_text(TABLES + '[[effect]]\nname = "effort_saturation"\nlimit_n = 6.0\n')
    motor = '<transmission><type>transmission_interface/SimpleTransmission</type><joint name="axis">'
    motor += '<hardwareInterface>EffortJointInterface</hardwareInterface></joint><actuator name="m"/></transmission>'
    sdf = '<sdf version="1.9"><model name="m"><link name="base"/><link name="slide"/><joint name="axis" type="prismatic">'
    sdf += "<parent>base</parent><child>slide</child><axis><xyz>1 0 0</xyz></axis></joint></model></sdf>"
    for to, model in (("drake", URDF.replace("</robot>", motor + "</robot>")), ("sdf", sdf)):
        suffix = "urdf" if to == "drake" else to
        (folder_of_test / f"r.{suffix}").write_text(model)
        text = palpate.export(folder_of_test / "improved.toml", folder_of_test / f"r.{suffix}", "axis", to=to)
        plant = drake.MultibodyPlant(0.001)
        drake.Parser(plant).AddModelsFromString(text, suffix)
        plant.Finalize()
        assert plant.GetJointByName("axis").default_damping() == 3.0
        limits = [plant.get_joint_actuator(index).effort_limit() for index in plant.GetJointActuatorIndices()]
        assert limits == [6.0]
