"""The notebooks run, and their tables are HTML."""

import pathlib
from typing import Any

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
jupyter_client = pytest.importorskip("jupyter_client")

NOTEBOOKS = sorted((pathlib.Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
assert NOTEBOOKS


def execute(notebook: Any, folder: pathlib.Path) -> None:
    """Runs the cells of a notebook, which get their outputs."""
    # Sockets are files of its own: a free port may be taken by another program before the kernel has it.
    kernel = jupyter_client.AsyncKernelManager(
        kernel_name="python3", transport="ipc", ip=str(folder / "kernel")
    )
    nbclient.NotebookClient(notebook, km=kernel, timeout=300, startup_timeout=300).execute()


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs(path: pathlib.Path, tmp_path: pathlib.Path) -> None:
    assert path.stat().st_size < 5000 and (NOTEBOOKS[0].parents[2] / "docs" / f"{path.stem}.md").exists()
    notebook = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells)  # stored without
    execute(notebook, tmp_path)
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("<table>" in output.get("data", {}).get("text/html", "") for output in outputs)


@pytest.mark.parametrize("with_tqdm", [True, False])
def test_progress_is_shown_in_a_notebook(with_tqdm: bool, tmp_path: pathlib.Path) -> None:
    if with_tqdm:
        pytest.importorskip("tqdm")
    hidden = "" if with_tqdm else "import sys; sys.modules['tqdm'] = sys.modules['tqdm.auto'] = None\n"
    code = """
from carom import EventDriven, Simulation, Surface, System, planar
system = System()
system.add(planar.Gravity((0.0, -9.81)))
system.add(planar.HalfPlane(normal=(0.0, 1.0)), Surface(friction=0.5, normal_restitution=0.6), "floor")
system.add(planar.Particle(mass=1.0, position=(0.0, 1.0)), "ball")
simulation = Simulation(system, EventDriven())
simulation.run_until(1.5, progress=True)
simulation.events()
"""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(hidden + code)])
    execute(notebook, tmp_path)
    outputs = notebook.cells[0].outputs
    shown = "".join(output.get("text", "") + str(output.get("data", "")) for output in outputs)
    assert "100" in shown and "1.5" in shown
    table = next(output for output in outputs if output.output_type == "execute_result")
    assert "<table>" in table.data["text/html"] and "&#x27;ball&#x27;" in table.data["text/html"]
