"""The round trip in MuJoCo: conceal an effect, diagnose, export, and simulate a trial that nobody fitted.

    pip install -r lab/proofs/requirements.txt
    cargo build --release --bin palpate
    python lab/proofs/round_trip.py --palpate target/release/palpate --recordings recordings --write docs/export.md

For each effect a concealed machine is played on three commands by a PD controller on a noisy encoder. The first two trials are diagnosed
against the plain model, the result is exported into that model, and the third command is played on plain and exported model. Compared
is the drive's effort. What the sensors alone leave is the difference of two runs of the concealed machine with other noise.

The concealed machines are written here by other means than the export uses: forces in Python, tendons, gravity, clipped commands.

With `--recordings FOLDER` two real drives as well: EMPS and axis 1 of a TX40. Each model gets the recorded effort less the recorded load, and a
spring and damper that hold it to the recorded position; the force that these need is the model's error.
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import mujoco
import numpy as np

RATE_HZ = 1000
SUBSTEPS = 10
DURATION_S = 15.0
MASS_KG = 0.8
DAMPING = 4.0
KP, KD, DERIVATIVE_HZ = 2000.0, 60.0, 100.0
ENCODER_STEP, ENCODER_NOISE = 5e-6, 2e-6

PLAIN = """<mujoco model="axis">
  <!-- an axis of the bench -->
  <compiler angle="radian"/>
  <option timestep="0.0001" gravity="0 0 0" integrator="implicitfast"/>
  <worldbody>
    <body name="carriage">
      <joint name="axis" type="{kind}" axis="1 0 0" damping="4.0" armature="{armature}"/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{mass} {mass} {mass}"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="drive" joint="axis"/>   <!-- effort in SI units -->
  </actuator>
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


class Machine:
    """A model, what acts on it besides, and what becomes of a command."""

    def __init__(self, xml, force=None, friction=None, command=None, stepper=None):
        self.model = mujoco.MjModel.from_xml_string(xml)
        self.data = mujoco.MjData(self.model)
        self.force, self.friction, self.command = force, friction, command
        self.step = stepper(self.model, self.data).step if stepper else self.plain_step

    def plain_step(self):
        data, dt = self.data, self.model.opt.timestep
        applied = self.force(data.qpos[0]) if self.force else 0.0
        if self.friction:
            # The force that stops a single body within the step, as far as friction can hold it.
            free = data.ctrl[0] + applied - DAMPING * data.qvel[0]
            most = self.friction(abs(data.qvel[0]))
            applied += np.clip(-(data.qvel[0] * MASS_KG / dt + free), -most, most)
        data.qfrc_applied[0] = applied
        mujoco.mj_step(self.model, data)

    def play(self, reference, seed):
        """Time, encoder, effort of a trial; the effort is what the controller commands."""
        noise = np.random.default_rng(seed).normal(0.0, ENCODER_NOISE, len(reference))
        blend = 1.0 - math.exp(-2 * math.pi * DERIVATIVE_HZ / RATE_HZ)
        rows, before, rate = [], None, 0.0
        for row, target in enumerate(reference):
            reading = round((self.data.qpos[0] + noise[row]) / ENCODER_STEP) * ENCODER_STEP
            error = target - reading
            rate += blend * ((error - (error if before is None else before)) * RATE_HZ - rate)
            before = error
            effort = KP * error + KD * rate
            rows.append((row / RATE_HZ, reading, effort))
            for _ in range(SUBSTEPS):
                self.data.ctrl[0] = self.command(effort, self.model.opt.timestep) if self.command else effort
                self.step()
        return np.array(rows)


def reference(trial):
    """Fast and slow reversals, another mixture each trial, beginning at rest at zero."""
    rng = np.random.default_rng(1000 + trial)
    t = np.arange(int(DURATION_S * RATE_HZ)) / RATE_HZ
    x = 0.03 * np.sin(2 * np.pi * rng.uniform(0.15, 0.25) * t)
    for frequency, amplitude in ((0.9, 0.01), (2.3, 0.004), (5.1, 0.0015), (11.0, 0.0004), (17.0, 0.0002), (27.0, 0.0001)):
        x += amplitude * np.sin(2 * np.pi * frequency * rng.uniform(0.9, 1.1) * t + rng.uniform(0, 6))
    return (x - x[0]) * np.minimum(t / 0.5, 1.0)


def lagged(constant):
    state = [0.0]

    def command(effort, dt):
        state[0] += (effort - state[0]) * -math.expm1(-dt / constant)
        return state[0]

    return command


def plain(kind="slide", mass=MASS_KG, armature=0.0):
    return PLAIN.format(kind=kind, mass=mass, armature=armature)


def cases():
    """Name, the concealed machine, the user's model."""
    stribeck = lambda v: 0.6 + 0.5 * math.exp(-((v / 0.01) ** 2))
    slow = lambda v: 2.0 * (v / 0.1) ** 0.4
    wave = lambda x: -1.5 * math.sin(2 * math.pi * x / 0.006 + 0.7)
    gear = TWO_MASSES.format(motor=0.3, load=0.5, link='limited="true" range="-0.0002 0.0002" solreflimit="0.0005 1"')
    belt = TWO_MASSES.format(motor=0.3, load=0.5, link='stiffness="2500" damping="2"')
    two = plain(mass=0.5, armature=0.3)
    return [
        ("coulomb_friction", lambda: Machine(plain(), friction=lambda v: 1.5), plain()),
        ("stribeck_friction", lambda: Machine(plain(), friction=stribeck), plain()),
        ("sublinear_friction", lambda: Machine(plain(), friction=slow), plain()),
        ("gravity_load", lambda: Machine(plain().replace('gravity="0 0 0"', 'gravity="-4 0 0"')), plain()),
        ("cogging", lambda: Machine(plain(), force=wave), plain()),
        ("backlash", lambda: Machine(gear), two),
        ("transmission_compliance", lambda: Machine(belt), two),
        ("effort_saturation", lambda: Machine(plain(), command=lambda u, dt: np.clip(u, -1.5, 1.5)), plain()),
        ("effort_lag", lambda: Machine(plain(), command=lagged(0.004)), plain()),
    ]


def write(path, rows):
    np.savetxt(path, rows, delimiter=",", header="t_s,position_m,effort_N", comments="", fmt="%.12g")


RIG = f"""[rig]
name = "axis"
coordinate = "linear"
[drive]
mass_kg = {MASS_KG}
viscous_n_s_m = {DAMPING}
encoder = "motor"
"""


def export(palpate, folder, target):
    command = [palpate, "export", "--to", target, "improved.toml", "--into", "plain.xml", "--joint", "axis", "--partial"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def round_trip(palpate, folder, name, concealed, model):
    """A row of the table."""
    (folder / "plain.xml").write_text(model)
    (folder / "rig.toml").write_text(RIG)
    trials, simulated = [], []
    for trial in (1, 2):
        write(folder / f"trial-{trial}.csv", concealed().play(reference(trial), trial))
        write(folder / f"plain-{trial}.csv", Machine(model).play(reference(trial), 50 + trial))
        trials.append(f"trial-{trial}.csv")
        simulated.append(f"plain-{trial}.csv")
    command = [palpate, "diagnose", "--rig", "rig.toml", *trials, "--simulation", *simulated, "--model", "improved.toml", "--json", "-"]
    diagnosis = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if diagnosis.returncode:
        return name, "diagnose failed: " + diagnosis.stderr.strip(), "none", "none", "none", "not exported"
    named = ", ".join(physics["name"] for physics in json.loads(diagnosis.stdout)["physics"]) or "nothing"
    unused = reference(3)
    truth = concealed().play(unused, 3)[:, 2]
    error = lambda machine: float(np.sqrt(np.mean((machine.play(unused, 4)[:, 2] - truth) ** 2)))
    before, sensors = f"{error(Machine(model)):.3f}", f"{error(concealed()):.3f}"
    mjcf, module = export(palpate, folder, "mjcf"), export(palpate, folder, "python")
    if mjcf.returncode or module.returncode:
        return name, named, before, "none", sensors, "not exported: " + (mjcf.stderr or module.stderr).strip().removeprefix("palpate: ")
    stepper = stepper_of(module.stdout)
    after = f"{error(Machine(mjcf.stdout, stepper=stepper)):.3f}"
    return name, named, before, after, sensors, "MJCF and stepper" if stepper else "MJCF"


def stepper_of(text):
    """The class in the text of an exported module, None where it has no effect."""
    module = {}
    exec(text, module)
    return module["Stepper"] if module["EFFECTS"] else None


def real_cases(folder):
    """Name, folder, unit of position and effort, trials diagnosed, the unused one, and the nominal values of the model."""
    emps, tx40 = folder / "emps_linear_drive", folder / "staubli_tx40_joints" / "joint1_with_load"
    return [
        ("EMPS", emps, ("m", "N"), ["track_1.csv"], "track_2.csv", "slide", 95.11, 203.5),
        ("TX40 axis 1", tx40, ("rad", "Nm"), ["trial-1.csv", "trial-2.csv"], "trial-3.csv", "hinge", 0.362, 8.05),
    ]


HOLD_HZ = 15.0


def holding_force(xml, stepper, table, inertia, columns):
    """Root mean square of the force that holds the model to the recording."""
    model = mujoco.MjModel.from_xml_string(xml)
    model.opt.timestep = 0.0005
    data = mujoco.MjData(model)
    step = stepper(model, data).step if stepper else lambda: mujoco.mj_step(model, data)
    t, x, effort, load = (table.get(name, 0.0 * table["t_s"]) for name in columns)
    stiffness, damping = inertia * (2 * math.pi * HOLD_HZ) ** 2, 1.4 * inertia * 2 * math.pi * HOLD_HZ
    velocity = np.gradient(np.convolve(np.pad(x, 10, mode="edge"), np.ones(21) / 21, mode="valid"), t)
    data.qpos[0], data.qvel[0] = x[0], velocity[0]
    forces, applied = [], 0.0
    for row in range(len(t) - 1):
        for part in range(round((t[row + 1] - t[row]) / model.opt.timestep)):
            share = part * model.opt.timestep / (t[row + 1] - t[row])
            target, rate = x[row] + share * (x[row + 1] - x[row]), velocity[row]
            force = stiffness * (target - data.qpos[0]) + damping * (rate - data.qvel[0])
            data.ctrl[0] = effort[row] - load[row]
            data.qfrc_applied[0] += force - applied
            applied = force
            step()
            forces.append(force)
    return float(np.sqrt(np.mean(np.square(forces))))


def real_round_trip(palpate, work, case):
    name, folder, (position, effort), trials, unused, kind, inertia, damping = case
    model = plain(kind, mass=inertia).replace('damping="4.0"', f'damping="{damping}"')
    (work / "plain.xml").write_text(model)
    command = [palpate, "diagnose", "--rig", folder / "rig.toml", *(folder / trial for trial in trials)]
    diagnosis = subprocess.run([*command, "--model", "improved.toml", "--json", "-"], cwd=work, capture_output=True, text=True)
    if diagnosis.returncode:
        return name, "diagnose failed: " + diagnosis.stderr.strip(), "none", "none", "not exported"
    answer = json.loads(diagnosis.stdout)
    named = ", ".join(f"{physics['name']} ({values(physics)})" for physics in answer["physics"])
    mjcf, module = export(palpate, work, "mjcf"), export(palpate, work, "python")
    if mjcf.returncode or module.returncode:
        return name, named, "none", "none", "not exported: " + (mjcf.stderr or module.stderr).strip().removeprefix("palpate: ")
    columns = ("t_s", f"position_{position}", f"effort_{effort}", f"load_{effort}")
    table = np.genfromtxt(folder / unused, delimiter=",", names=True)
    table = {column: table[column] for column in table.dtype.names}
    stepper = stepper_of(module.stdout)
    before = holding_force(model, None, table, inertia, columns)
    after = holding_force(mjcf.stdout, stepper, table, inertia, columns)
    return name, named, f"{before:.2f}", f"{after:.2f}", "MJCF and stepper" if stepper else "MJCF"


def values(physics):
    # A dimensionless value has the unit "1".
    return ", ".join(f"{p['name']} {p['value']:.4g} {p['unit']}".removesuffix(" 1") for p in physics["parameters"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--palpate", required=True, type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--only", nargs="*", help="names of effects")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the files of each case")
    parser.add_argument("--recordings", type=pathlib.Path, help="the folder of real recordings")
    parser.add_argument("--write", type=pathlib.Path, help="a page that has the two marks: the tables are written between them")
    args = parser.parse_args()
    tables = []
    for line in lines(args):
        print(line, flush=True)
        tables.append(line)
    if args.write:
        page = args.write.read_text()
        head, _, tail = page.partition(BEGIN)
        args.write.write_text(head + BEGIN + "\n\n" + "\n".join(tables) + "\n\n" + END + tail.partition(END)[2])


BEGIN, END = "<!-- written by lab/proofs/round_trip.py; not by hand -->", "<!-- end of what it wrote -->"


def lines(args):
    """The tables, as they come."""
    yield "| concealed | named | effort error before, N | after | the sensors alone, N | exported by |"
    yield "|---|---|---|---|---|---|"
    for name, concealed, model in cases():
        if args.only and name not in args.only:
            continue
        with tempfile.TemporaryDirectory() as temporary:
            folder = args.keep / name if args.keep else pathlib.Path(temporary)
            folder.mkdir(parents=True, exist_ok=True)
            yield table_row(round_trip(args.palpate, folder, name, concealed, model))
    if args.recordings:
        yield ""
        yield "| recording | named | force on the unused trial before, N or N m | after | exported by |"
        yield "|---|---|---|---|---|"
        for case in real_cases(args.recordings.resolve()):
            with tempfile.TemporaryDirectory() as work:
                yield table_row(real_round_trip(args.palpate, pathlib.Path(work), case))


def table_row(cells):
    return "| " + " | ".join(" ".join(cell.split()) for cell in cells) + " |"


if __name__ == "__main__":
    main()
