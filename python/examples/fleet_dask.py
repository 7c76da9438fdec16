"""Diagnoses a fleet on a Dask cluster.

    python fleet_dask.py FLEET --out DIR [--scheduler tcp://host:8786]

Each rig is a task: `palpate.diagnose_rig`, the worker of `palpate diagnose-all`, which then finds every rig done and writes table and
page. Without a scheduler the cluster is this machine's processors. Workers on other machines need this package and the same paths: a
shared file system. A run that was broken off is completed by the same command.
"""

import argparse
import subprocess
import sys

from dask.distributed import Client, LocalCluster, as_completed

import palpate


def diagnose_fleet(client, source, out, seed=1):
    """The result of each rig of the fleet, by its name; what goes wrong with a task is the error of its rig."""
    rigs = palpate.fleet(source, out)
    # Not pure: a task that is asked for again has to look at its files again.
    tasks = {client.submit(palpate.diagnose_rig, rig, out, seed=seed, pure=False): rig for rig in rigs}
    results = {}
    for task in as_completed(tasks):
        rig = tasks[task]
        # A worker that is lost takes its task with it, and no other.
        failed = task.status != "finished"
        result = palpate.RigResult(rig.name, None, str(task.exception())) if failed else task.result()
        print(f"{rig.name}: {result.error or 'diagnosed'}", file=sys.stderr)
        results[rig.name] = result
    return results


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("fleet")
    arguments.add_argument("--out", required=True)
    arguments.add_argument("--scheduler")
    given = arguments.parse_args()
    # One thread a process: a diagnosis is a process of its own anyway.
    cluster = given.scheduler or LocalCluster(threads_per_worker=1, dashboard_address=None)
    with Client(cluster) as client:
        diagnose_fleet(client, given.fleet, given.out)
    table = [sys.executable, "-P", "-m", "palpate", "diagnose-all", given.fleet, "--out", given.out]
    return subprocess.run(table).returncode


if __name__ == "__main__":
    sys.exit(main())
