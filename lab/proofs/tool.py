"""The command `palpate`, as the proofs call it."""

import json
import subprocess
import types


class Tool:
    def __init__(self, program):
        self.program = program

    def run(self, folder, *arguments):
        return subprocess.run([self.program, *map(str, arguments)], cwd=folder, capture_output=True, text=True)

    def diagnose(self, folder, *arguments):
        """The JSON, or what went wrong."""
        told = self.run(folder, "diagnose", *arguments, "--model", "improved.toml", "--json", "-")
        return (None, told.stderr.strip()) if told.returncode else (json.loads(told.stdout), None)

    def export(self, folder, joint, nominal, improved="improved.toml", model="plain.xml", sensor=None):
        """The improved model, the exported module or None where it has nothing to say, and what could not be exported."""
        common = [improved, "--into", model, "--joint", joint, "--partial", *(["--sensor", sensor] if sensor else [])]
        mjcf = self.run(folder, "export", "--to", "mjcf", *common, "--nominal", nominal)
        stepper = self.run(folder, "export", "--to", "python", *common)
        if mjcf.returncode or stepper.returncode:
            raise RuntimeError((mjcf.stderr or stepper.stderr).strip().removeprefix("palpate: "))
        module = types.SimpleNamespace()
        exec(stepper.stdout, module.__dict__)
        left_out = [line for line in stepper.stderr.splitlines() if line.startswith("left out")]
        return mjcf.stdout, module if module.EFFECTS else None, left_out


def names(diagnosis):
    return ", ".join(physics["name"] for physics in diagnosis["physics"]) or "nothing"


def values(physics):
    # A dimensionless value has the unit "1".
    return ", ".join(f"{p['name']} {p['value']:.4g} {p['unit']}".removesuffix(" 1") for p in physics["parameters"])


def by(module):
    return "MJCF and stepper" if module else "MJCF"
