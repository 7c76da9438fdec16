"""The package as a user drives it, against the command."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import palpate

RIG = {"rig": {"name": "axis"}, "drive": {"mass_kg": 1.0, "viscous_n_s_m": 3.0}}
RIG_TEXT = '[rig]\nname = "axis"\n[drive]\nmass_kg = 1.0\nviscous_n_s_m = 3.0\n'


def trial(seed, rows=3000, rate=500.0):
    """A mass of 1 kg with 3 N s/m and a load of 2 N, moved along two sines; the encoder has steps of 10 um."""
    rng = np.random.default_rng(seed)
    t = np.arange(rows) / rate
    x, v, a = np.zeros(rows), np.zeros(rows), np.zeros(rows)
    for f, amplitude in ((0.7, 0.02), (3.1, 0.004)):
        w, phase = 2 * np.pi * f * rng.uniform(0.9, 1.1), rng.uniform(0, 6)
        x += amplitude * np.sin(w * t + phase)
        v += amplitude * w * np.cos(w * t + phase)
        a -= amplitude * w * w * np.sin(w * t + phase)
    # The effort is held from row to row: the mean over the interval, nearly the value in its middle.
    effort = 1.0 * a + 3.0 * v + 2.0
    effort = np.append((effort[1:] + effort[:-1]) / 2, effort[-1])
    noisy = np.round((x + rng.normal(0, 3e-6, rows)) / 1e-5) * 1e-5
    return {"t_s": t, "position_m": noisy, "effort_N": effort}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("trials")
    (folder / "rig.toml").write_text(RIG_TEXT)
    for at in (1, 2):
        columns = trial(at)
        table = np.stack(list(columns.values()), axis=1)
        np.savetxt(folder / f"{at}.csv", table, delimiter=",", header=",".join(columns), comments="", fmt="%.17g")
    return folder


@pytest.fixture(scope="module")
def diagnosis(folder):
    return palpate.diagnose([folder / "1.csv", folder / "2.csv"], folder / "rig.toml")


def command(*arguments, cwd=None):
    named = os.environ.get("PALPATE_COMMAND")
    program = [named] if named else [sys.executable, "-m", "palpate"]
    return subprocess.run([*program, *map(str, arguments)], cwd=cwd, capture_output=True)


def test_the_json_is_that_of_the_command_to_the_byte(folder, diagnosis):
    told = command("diagnose", "--rig", folder / "rig.toml", folder / "1.csv", folder / "2.csv", "--json", "-")
    assert told.returncode == 0, told.stderr
    assert told.stdout == diagnosis.json.encode()


def test_the_fields_of_the_json_are_attributes(diagnosis):
    assert diagnosis.verdict == "explained"
    (load,) = diagnosis.physics
    assert load.name == "gravity_load" and load.acts_in == "drive"
    value = load.parameters[0]
    assert value.unit == "N" and abs(value.value - 2.0) < 0.05
    assert isinstance(value.ci95, np.ndarray) and value.ci95[0] < value.value < value.ci95[1]
    assert diagnosis.fit["unit"] == "N" and diagnosis.as_dict()["verdict"] == "explained"
    assert "gravity_load" in diagnosis.model and "gravity_load" in repr(diagnosis)
    assert diagnosis._repr_html_().startswith("<iframe srcdoc=")
    with pytest.raises(AttributeError, match="nonsense"):
        diagnosis.nonsense


def test_arrays_and_tables_give_the_same_answer_as_files(diagnosis):
    steps = []
    same = palpate.diagnose([trial(1), trial(2)], RIG, progress=steps.append)
    names = lambda text: text.replace("recording 1", "1.csv").replace("recording 2", "2.csv")
    assert names(same.json) == diagnosis.json
    assert steps


def test_a_load_and_an_effort_are_added(folder):
    known = palpate.diagnose([trial(1), trial(2)], RIG, load=[np.full(3000, 2.0)] * 2)
    assert "gravity_load" not in [physics.name for physics in known.physics]
    bare = {name: values for name, values in trial(1).items() if name != "effort_N"}
    read = palpate.read(trial(1), RIG)
    assert np.array_equal(read["effort"], trial(1)["effort_N"]) and read["time"].dtype == float
    with pytest.raises(palpate.InputError, match="force_N or effort_N"):
        palpate.diagnose(bare, RIG)
    assert palpate.diagnose(bare, RIG, effort=trial(1)["effort_N"]).verdict


def test_joints_are_those_of_the_command_to_the_byte(folder):
    """Two joints of one recording: one with the load of 2 N known, one without."""
    columns = '[columns]\neffort = "effort_N"\nload = "known_N"\n'
    (folder / "one.toml").write_text(RIG_TEXT + columns)
    for at in (1, 2):
        table = np.column_stack([*trial(at).values(), np.full(3000, 2.0)])
        np.savetxt(folder / f"arm-{at}.csv", table, delimiter=",", header="t_s,position_m,effort_N,known_N", comments="", fmt="%.17g")
    files = [folder / "arm-1.csv", folder / "arm-2.csv"]
    rigs = {"one": folder / "one.toml", "two": folder / "rig.toml"}
    arm = palpate.diagnose_joints(files, rigs)
    assert list(arm) == ["one", "two"] and len(arm) == 2
    assert [physics.name for physics in arm["two"].physics] == ["gravity_load"] and not arm["one"].physics
    joints = [word for name, rig in rigs.items() for word in ("--joint", f"{name}={rig}")]
    told = command("diagnose-joints", *joints, *files, "--json", "-", "--report", folder / "arm.html")
    assert told.returncode == 0, told.stderr
    assert told.stdout == arm.json.encode() and (folder / "arm.html").read_bytes() == arm.html.encode()
    # The load as arrays, by the joint's name.
    given = palpate.diagnose_joints(
        [trial(1), trial(2)], {"one": RIG, "two": RIG}, load={"one": [np.full(3000, 2.0)] * 2}
    )
    assert [len(joint.physics) for joint in given.values()] == [0, 1]
    assert arm._repr_html_().startswith("<iframe srcdoc=")
    with pytest.raises(palpate.InputError, match=r"load\['three'\].*one, two"):
        palpate.diagnose_joints(files, rigs, load={"three": [np.zeros(3000)] * 2})
    with pytest.raises(palpate.InputError, match=r"load\['one'\].*1 arrays.*2 in all"):
        palpate.diagnose_joints(files, rigs, load={"one": [np.zeros(3000)]})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"effort_N": np.zeros(2999)}, "effort_N.*2999 values.*3000"),
        ({"effort_N": np.full(3000, np.nan)}, "effort_N, value 1.*no number"),
        ({"effort_N": np.array([{}] * 3000, dtype=object)}, "effort_N.*object.*numbers"),
        ({"effort_N": np.zeros((3000, 2))}, "shape"),
        ({"t_s": np.zeros(3000)}, "strictly increases"),
    ],
)
def test_arrays_at_fault_are_named(change, words):
    with pytest.raises(palpate.InputError, match=words) as caught:
        palpate.diagnose({**trial(1), **change}, RIG)
    assert caught.value.place and caught.value.found and caught.value.expected


def test_files_and_rigs_at_fault_are_named(folder):
    with pytest.raises(palpate.InputError, match="no such file"):
        palpate.diagnose(folder / "3.csv", folder / "rig.toml")
    with pytest.raises(palpate.InputError, match=r"mass_kg.*-1"):
        palpate.diagnose(folder / "1.csv", {**RIG, "drive": {"mass_kg": -1, "viscous_n_s_m": 3.0}})
    with pytest.raises(palpate.InputError, match="one a recording, 2 in all"):
        palpate.diagnose([folder / "1.csv"] * 2, RIG, simulation=[folder / "1.csv"])
    fault = command("diagnose", "--rig", folder / "rig.toml", folder / "3.csv")
    assert fault.returncode == 1 and b"no such file" in fault.stderr
    assert command("nonsense").returncode == 2
    assert command("--version").stdout.split()[1].decode() == palpate.__version__


MODEL = """<mujoco>
  <worldbody>   <!-- mine -->
    <body><joint name="axis" type="slide"/><geom size="0.1"/></body>
  </worldbody>
  <actuator><motor name="drive" joint="axis"/></actuator>
</mujoco>
"""


def test_what_was_found_is_written_into_a_model(folder, diagnosis):
    model = folder / "model.xml"
    model.write_text(MODEL)
    with pytest.warns(UserWarning, match="inertia"):
        text = palpate.export(diagnosis, model, "axis")
    assert "<!-- mine -->" in text and "<dcmotor" in text and model.read_text() == MODEL
    (folder / "improved.toml").write_text(diagnosis.model)
    arguments = ["--to", "mjcf", folder / "improved.toml", "--into", model, "--joint", "axis"]
    assert command("export", *arguments).stdout == text.encode()
    with pytest.warns(UserWarning, match="left out: gravity_load"):
        palpate.export(diagnosis, write(folder / "model.urdf", URDF), "axis", to="urdf", partial=True)


URDF = '<robot name="r"><joint name="axis" type="prismatic"/></robot>'


def write(path, text):
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    ("to", "joint", "model", "words"),
    [
        ("mjcf", "axsi", MODEL, "joint axsi.*axis"),
        ("mjcf", "axis", URDF, "<robot>.*<mujoco>"),
        ("urdf", "axis", URDF, "gravity_load"),
        ("step", "axis", MODEL, "to: found step.*mjcf, urdf"),
    ],
)
def test_models_at_fault_are_named(folder, diagnosis, to, joint, model, words):
    with pytest.raises(palpate.InputError, match=words):
        palpate.export(diagnosis, write(folder / "fault.xml", model), joint, to=to)


def test_an_element_that_the_model_has_is_named(folder):
    rig = RIG_TEXT + '[[effect]]\nname = "coulomb_friction"\nform = "symmetric"\nlevel_n = 0.45\n'
    model = MODEL.replace('type="slide"', 'type="slide" frictionloss="0.3"')
    with pytest.raises(palpate.InputError, match="frictionloss 0.3"):
        palpate.export(write(folder / "rubs.toml", rig), write(folder / "rubs.xml", model), "axis")


FORMATS = pathlib.Path(__file__).parents[2] / "lab" / "tests" / "formats"


@pytest.mark.parametrize(
    ("file", "columns", "words"),
    [
        ("object.npz", {}, "force_N.*object array"),
        ("unequal.npz", {}, "force_N.*49 values.*50"),
        ("nan.npz", {}, "force_N, value 8.*no number"),
        ("trial.mcap", {"position": "/joint_states:knee.position"}, "knee.position.*elbow.position"),
    ],
)
def test_files_of_other_formats_at_fault_are_named(file, columns, words):
    with pytest.raises(palpate.InputError, match=f"{file}.*{words}"):
        palpate.read(FORMATS / file, {**RIG, "columns": columns})


def test_another_format_than_the_ending_says_is_named(folder):
    (folder / "archive.csv").write_bytes((FORMATS / "trial.npz").read_bytes())
    with pytest.raises(palpate.InputError, match="archive.csv.*NPZ"):
        palpate.read(folder / "archive.csv", RIG)


def test_ctrl_c_ends_the_wait():
    trials = [trial(seed, rows=20000) for seed in (1, 2, 3)]
    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        palpate.diagnose(trials, RIG)
    assert time.monotonic() - start < 2.0


def test_an_error_of_progress_comes_through():
    def progress(step):
        raise RuntimeError(step)

    with pytest.raises(RuntimeError):
        palpate.diagnose(trial(1), RIG, progress=progress)


def test_stubs_and_marker_are_installed(diagnosis):
    home = pathlib.Path(palpate.__file__).parent
    assert (home / "py.typed").exists()
    stubs = (home / "__init__.pyi").read_text()
    missing = [key for key in [*diagnosis.as_dict(), *palpate.__all__] if key not in stubs]
    assert not missing, f"not in the stubs: {missing}"
