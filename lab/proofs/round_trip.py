"""The round trip in MuJoCo: conceal an effect, diagnose, export, and simulate a trial that nobody fitted.

    pip install -r lab/proofs/requirements.txt dist/palpate-*.whl
    python lab/proofs/round_trip.py --palpate target/release/palpate --recordings recordings --write docs/export.md

For each effect a concealed machine is played on three commands by a PD controller on a noisy encoder. The first two trials are diagnosed
against the plain model, the result is exported into that model, and the third command is played on plain and exported model. Compared
is the drive's effort, or the reading of the force. What the sensors alone leave is the difference of two runs of the concealed machine
with other noise.

With `--recordings FOLDER` two real drives as well (recorded_drives.py).
"""

import argparse
import pathlib
import tempfile

import numpy as np

import arm
import recorded_drives
from concealed import cases
from machine import Machine
from tool import Tool, by, names


def write(path, rows):
    header = "t_s,position_m,effort_N,force_N".split(",")[: rows.shape[1]]
    np.savetxt(path, rows, delimiter=",", header=",".join(header), comments="", fmt="%.12g")


def round_trip(tool, folder, case):
    """A row of the table."""
    (folder / "plain.xml").write_text(case.model)
    (folder / "rig.toml").write_text(case.rig)
    trials, simulated = [], []
    for trial in (1, 2):
        write(folder / f"trial-{trial}.csv", case.concealed().play(case.reference(trial), trial)[:, : case.columns])
        write(folder / f"plain-{trial}.csv", Machine(case.model).play(case.reference(trial), 50 + trial)[:, : case.columns])
        trials.append(f"trial-{trial}.csv")
        simulated.append(f"plain-{trial}.csv")
    diagnosis, fault = tool.diagnose(folder, "--rig", "rig.toml", *trials, "--simulation", *simulated)
    if fault:
        return case.name, "diagnose failed: " + fault, "none", "none", "none", "not exported"
    unused = case.reference(3)
    truth = case.concealed().play(unused, 3)[:, case.channel]
    error = lambda machine: float(np.sqrt(np.mean((machine.play(unused, 4)[:, case.channel] - truth) ** 2)))
    before, sensors = f"{error(Machine(case.model)):.3f}", f"{error(case.concealed()):.3f}"
    try:
        mjcf, module, left_out = tool.export(folder, "axis", "rig.toml", sensor="wrist" if case.columns == 4 else None)
    except RuntimeError as refusal:
        return case.name, names(diagnosis), before, "none", sensors, f"not exported: {refusal}"
    after = f"{error(Machine(mjcf, module=module)):.3f}"
    return case.name, names(diagnosis), before, after, sensors, "; ".join([by(module), *left_out])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--palpate", required=True, type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--only", nargs="*", help="names of rows")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the files of each case")
    parser.add_argument("--recordings", type=pathlib.Path, help="the folder of real recordings")
    parser.add_argument("--write", type=pathlib.Path, help="a page that has the two marks: rows between them are replaced by these")
    parser.add_argument("--printed", type=pathlib.Path, nargs="*", help="what earlier runs printed, instead of a run")
    args = parser.parse_args()
    if args.printed:
        measured = [line for path in args.printed for line in path.read_text().splitlines()]
    else:
        measured = []
        for line in lines(args):
            print(line, flush=True)
            measured.append(line)
    if args.write:
        head, _, rest = args.write.read_text().partition(BEGIN)
        before, _, tail = rest.partition(END)
        rows = "\n".join(in_order(before.splitlines(), measured)).strip()
        args.write.write_text(head + BEGIN + "\n\n" + rows + "\n\n" + END + tail)


def in_order(before, measured):
    """Both tables, a row that was measured in place of the one before, in the order of the cases."""
    rows = {first_cell(line): line for line in [*before, *measured] if line.startswith("| ") and " | " in line}
    first = [case.name for case in cases()] + [name for name in rows if name.startswith("arm, ")]
    second = [case[0] for case in recorded_drives.cases(pathlib.Path())]
    for heads, names_of_rows in ((HEAD, first), (RECORDED_HEAD, second)):
        yield from heads
        yield from (rows[name] for name in names_of_rows if name in rows)
        yield ""


def first_cell(line):
    return line.split("|")[1].strip()


HEAD = (
    "| concealed | named | error before, N or N m | after | the sensors alone | exported by |",
    "|---|---|---|---|---|---|",
)
RECORDED_HEAD = (
    "| recording | named | force on the unused trial before, N or N m | after | with the published values | "
    "the diagnosis's own residual (the sensors') | exported by |",
    "|---|---|---|---|---|---|---|",
)
BEGIN, END = "<!-- written by lab/proofs/round_trip.py; not by hand -->", "<!-- end of what it wrote -->"


def lines(args):
    """The tables, as they come."""
    tool = Tool(args.palpate)
    wanted = lambda name: not args.only or name in args.only
    yield from HEAD
    for case in filter(lambda case: wanted(case.name), cases()):
        with folder_of(args, case.name) as folder:
            yield table_row(round_trip(tool, folder, case))
    if wanted("arm"):
        with folder_of(args, "arm") as folder:
            yield from map(table_row, arm.row(tool, folder))
    if args.recordings:
        yield ""
        yield from RECORDED_HEAD
        for case in filter(lambda case: wanted(case[0]), recorded_drives.cases(args.recordings.resolve())):
            with folder_of(args, case[0]) as folder:
                yield table_row(recorded_drives.row(tool, folder, case))


class folder_of:
    """The folder for a case's files: kept where the user wants it, gone after the case where not."""

    def __init__(self, args, name):
        self.temporary = None if args.keep else tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.temporary.name) if self.temporary else args.keep / name.replace(" ", "-")

    def __enter__(self):
        self.path.mkdir(parents=True, exist_ok=True)
        return self.path

    def __exit__(self, *_):
        if self.temporary:
            self.temporary.cleanup()


def table_row(cells):
    return "| " + " | ".join(" ".join(cell.split()) for cell in cells) + " |"


if __name__ == "__main__":
    main()
