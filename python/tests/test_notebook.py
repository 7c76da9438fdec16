"""The notebook, from top to bottom."""

import os
import pathlib

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("mujoco")

NOTEBOOK = pathlib.Path(__file__).parents[1] / "examples" / "emps.ipynb"


@pytest.mark.parametrize("is_recorded", [False, True], ids=["simulated", "recorded"])
def test_the_notebook_runs_from_top_to_bottom(tmp_path, monkeypatch, is_recorded):
    recordings = pathlib.Path(os.environ.get("PALPATE_RECORDINGS", tmp_path))
    if is_recorded and not (recordings / "emps_linear_drive").is_dir():
        pytest.skip("PALPATE_RECORDINGS names no folder with emps_linear_drive")
    monkeypatch.setenv("PALPATE_RECORDINGS", str(recordings.resolve() if is_recorded else tmp_path))
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbclient.NotebookClient(notebook, timeout=900, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    text = "".join(output.get("text", "") for output in outputs)
    assert "coulomb_friction" in text and "frictionloss=" in text
    shown = {kind for output in outputs for kind in output.get("data", {})}
    assert {"image/png", "text/html"} <= shown
    assert ("recorded: EMPS" in text) == is_recorded
