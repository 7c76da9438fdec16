"""The README's picture: a rotary drive's torque over its angle, measured, simulated, and with the physics that a diagnosis named.

    palpate diagnose --rig lab/rigs/dfki_pendulum.toml ddp.csv dircol.csv --model improved.toml --json diagnosis.json
    python3 docs/picture.py lab/rigs/dfki_pendulum.toml improved.toml diagnosis.json ddp.csv docs/picture.svg

The balance of the drive, J a + b v + gravity + Coulomb friction = torque, is evaluated here independently of the tool, with the values
of the two rig files. The angle passes a Gaussian before it is differentiated, the torque of the balance passes it again, and the
measured torque passes it twice: what is compared has been filtered alike.
Needs Python 3.11 and nothing else.
"""

import csv
import json
import math
import sys
import tomllib

KNOWN = {"gravity_load": "gravity load", "coulomb_friction": "Coulomb friction"}
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 860, 470, 70, 62, 20, 60
# What a second derivative of this encoder still shows cleanly; the diagnosis itself differentiates nothing.
PICTURE_BAND_HZ = 6.0
MEASURED, NOMINAL, NAMED = "#5b6472", "#d1495b", "#1f78b4"


def gaussian(values, step, bandwidth_hz):
    """Low-pass by a Gaussian whose gain is 1/sqrt(2) at the bandwidth; the ends are held."""
    sigma = math.sqrt(math.log(2.0)) / (2.0 * math.pi * bandwidth_hz * step)
    reach = math.ceil(4.0 * sigma)
    kernel = [math.exp(-0.5 * (k / sigma) ** 2) for k in range(-reach, reach + 1)]
    total = sum(kernel)
    last = len(values) - 1
    return [
        sum(w * values[min(max(at + k, 0), last)] for k, w in zip(range(-reach, reach + 1), kernel)) / total
        for at in range(len(values))
    ]


def derivative(values, time):
    """Central differences; the ends repeat their neighbours."""
    inner = [(values[k + 1] - values[k - 1]) / (time[k + 1] - time[k - 1]) for k in range(1, len(values) - 1)]
    return [inner[0], *inner, inner[-1]]


def torque(rig, angle, velocity, acceleration):
    """The balance of the drive, with those of its effects that are KNOWN."""
    drive = rig["drive"]
    value = drive["inertia_kg_m2"] * acceleration + drive["viscous_n_m_s_rad"] * velocity
    for effect in rig.get("effect", []):
        if effect["name"] == "gravity_load":
            value += effect["sine_n_m"] * math.sin(angle) + effect["cosine_n_m"] * math.cos(angle) + effect["load_n_m"]
        elif effect["name"] == "coulomb_friction":
            value += effect["level_n_m"] * math.copysign(1.0, velocity)
        else:
            sys.exit(f"{effect['name']}: this picture draws {', '.join(sorted(KNOWN))} alone")
    return value


def rms(values):
    return math.sqrt(sum(value * value for value in values) / len(values))


def main(rig_path, model_path, answer_path, trial_path, out_path):
    with open(rig_path, "rb") as file:
        nominal = tomllib.load(file)
    with open(model_path, "rb") as file:
        named = tomllib.load(file)
    with open(answer_path, encoding="utf-8") as file:
        answer = json.load(file)
    with open(trial_path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    time = [float(row["t_s"]) for row in rows]
    step = (time[-1] - time[0]) / (len(time) - 1)
    bandwidth = PICTURE_BAND_HZ
    angle = gaussian([float(row["position_rad"]) for row in rows], step, bandwidth)
    filtered = lambda values: gaussian(values, step, bandwidth)
    measured = filtered(filtered([float(row["torque_Nm"]) for row in rows]))
    velocity = derivative(angle, time)
    acceleration = derivative(velocity, time)
    curves = [
        filtered([torque(rig, *row) for row in zip(angle, velocity, acceleration)]) for rig in (nominal, named)
    ]
    residual = [rms([m - value for m, value in zip(measured, curve)]) for curve in curves]
    names = [KNOWN[p["name"]] for p in answer["physics"] if p["name"] in KNOWN]
    text = draw(angle, measured, curves, names, residual)
    with open(out_path, "w", encoding="utf-8") as file:
        file.write(text)
    print(f"residual of this trial: {residual[0]:.2f} N m as simulated, {residual[1]:.2f} N m with {' and '.join(names)}")


def draw(angle, measured, curves, names, residual):
    low, high = min(angle) - 0.15, max(angle) + 0.15
    peak = max(abs(value) for values in [measured, *curves] for value in values) * 1.05
    x = lambda value: LEFT + (value - low) / (high - low) * (WIDTH - LEFT - RIGHT)
    y = lambda value: TOP + (peak - value) / (2 * peak) * (HEIGHT - TOP - BOTTOM)
    every = max(1, len(angle) // 700)

    def line(values, colour, width):
        points = " ".join(f"{x(a):.1f},{y(v):.1f}" for a, v in list(zip(angle, values))[::every])
        return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"/>'

    def words(at, text, **style):
        given = " ".join(f'{key.replace("_", "-")}="{value}"' for key, value in style.items())
        return f'<text x="{at[0]}" y="{at[1]}" {given}>{text}</text>'

    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="DejaVu Sans, Verdana, Helvetica, sans-serif" font-size="14" fill="#1c2330">',
        "<title>Torque of a motor-driven arm over its angle: measured, simulated without and with the physics that was named</title>",
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
        words((LEFT, 26), f"Missing in the simulation: {' and '.join(names)}", font_size=18, font_weight=600),
        words((LEFT, 48), f"A motor swings up a weighted arm. Residual torque of this trial: {residual[0]:.2f} N m before, {residual[1]:.2f} N m after.",
              fill=MEASURED),
    ]
    for turn in range(-4, 5):
        at = turn * math.pi / 2
        if low <= at <= high:
            label = f"{90 * turn}°" if turn else "0°, hanging"
            parts.append(f'<line x1="{x(at):.1f}" x2="{x(at):.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" stroke="#e3e6ea"/>')
            parts.append(words((f"{x(at):.1f}", HEIGHT - BOTTOM + 20), label, text_anchor="middle"))
    unit = 1 if peak < 6 else 5
    for level in range(-int(peak // unit), int(peak // unit) + 1):
        value = level * unit
        parts.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y(value):.1f}" y2="{y(value):.1f}" stroke="#e3e6ea"/>')
        parts.append(words((LEFT - 8, f"{y(value) + 5:.1f}"), str(value).replace("-", "−"), text_anchor="end"))
    parts += [
        line(measured, MEASURED, 3.5),
        line(curves[0], NOMINAL, 1.6),
        line(curves[1], NAMED, 1.6),
        words((22, TOP + (HEIGHT - TOP - BOTTOM) / 2), "torque, N m", text_anchor="middle",
              transform=f"rotate(-90 22 {TOP + (HEIGHT - TOP - BOTTOM) / 2})"),
    ]
    legend = [(MEASURED, "measured"), (NOMINAL, "simulated: inertia and viscous friction"), (NAMED, "simulated with what was named")]
    at = LEFT
    for colour, name in legend:
        parts.append(f'<line x1="{at}" x2="{at + 26}" y1="{HEIGHT - 17}" y2="{HEIGHT - 17}" stroke="{colour}" stroke-width="3"/>')
        parts.append(words((at + 33, HEIGHT - 12), name))
        at += 60 + 7.4 * len(name)
    return "\n".join([*parts, "</svg>"]) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    main(*sys.argv[1:])
