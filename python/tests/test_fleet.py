"""A fleet on a local Dask cluster, against `palpate diagnose-all`."""

import importlib.util
import pathlib
import shutil
import subprocess
import sys

import pytest
from dask.distributed import Client, LocalCluster
from test_palpate import RIG_TEXT, command, trial

import numpy as np

import palpate

EXAMPLE = pathlib.Path(__file__).parent.parent / "examples" / "fleet_dask.py"


def example():
    spec = importlib.util.spec_from_file_location("fleet_dask", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def fleet(tmp_path_factory):
    """Three rigs of two recordings each; the rig file of the last is none."""
    folder = tmp_path_factory.mktemp("fleet")
    for rig in (1, 2, 3):
        place = folder / f"axis {rig}"
        place.mkdir()
        (place / "rig.toml").write_text(RIG_TEXT if rig < 3 else "[rig]\nname = 3\n")
        for at in (1, 2):
            columns = trial(10 * rig + at)
            table = np.stack(list(columns.values()), axis=1)
            np.savetxt(place / f"trial-{at}.csv", table, delimiter=",", header=",".join(columns), comments="", fmt="%.17g")
    return folder


@pytest.fixture(scope="module")
def on_cluster(fleet, tmp_path_factory):
    """The output of the example's tasks on two processes, and their results."""
    out = tmp_path_factory.mktemp("cluster") / "out"
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        return out, example().diagnose_fleet(client, fleet, out)


def test_a_rig_on_the_cluster_gives_the_bytes_of_the_command(fleet, on_cluster):
    out, results = on_cluster
    for name in ("axis 1", "axis 2"):
        place = fleet / name
        told = command("diagnose", "--rig", place / "rig.toml", place / "trial-1.csv", place / "trial-2.csv", "--json", "-")
        assert told.returncode == 0, told.stderr
        assert results[name].json.encode() == told.stdout
        assert (out / "rigs" / name / "diagnosis.json").read_bytes() == told.stdout
        assert results[name].error is None


def test_a_rig_that_fails_on_the_cluster_is_its_own_result(on_cluster):
    _, results = on_cluster
    assert sorted(results) == ["axis 1", "axis 2", "axis 3"]
    assert results["axis 3"].json is None and "rig.toml:2" in results["axis 3"].error


def test_the_command_goes_on_from_what_the_cluster_did_to_the_same_table(fleet, on_cluster, tmp_path):
    out = tmp_path / "out"
    shutil.copytree(on_cluster[0], out)
    # By the same package: another build's answers are another program's.
    again = [sys.executable, "-P", "-m", "palpate", "diagnose-all", fleet, "--out", out]
    told = subprocess.run(again, capture_output=True, text=True)
    assert told.returncode == 0, told.stderr
    assert "3 rigs: 1 failed, 2 done before" in told.stderr
    alone = command("diagnose-all", fleet, "--out", tmp_path / "alone", "--jobs", "2")
    assert alone.returncode == 0, alone.stderr
    for table in ("table.csv", "table.parquet"):
        assert (out / table).read_bytes() == (tmp_path / "alone" / table).read_bytes()


def test_a_folder_that_is_no_fleet_is_an_input_error(tmp_path):
    with pytest.raises(palpate.InputError, match="no rig"):
        palpate.fleet(tmp_path, tmp_path / "out")
