"""The notebooks run, and their tables are HTML."""

import pathlib
import re
from typing import Any

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
jupyter_client = pytest.importorskip("jupyter_client")

NOTEBOOKS = sorted((pathlib.Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
assert NOTEBOOKS
MANY_RUNS = {"vibrating_table", "basin_of_attraction", "thrown_between_tables", "identification"}


def execute(notebook: Any, folder: pathlib.Path) -> None:
    """Runs the cells of a notebook, which get their outputs."""
    # Sockets are files of its own: a free port may be taken by another program before the kernel has it.
    kernel = jupyter_client.AsyncKernelManager(
        kernel_name="python3", transport="ipc", ip=str(folder / "kernel")
    )
    nbclient.NotebookClient(notebook, km=kernel, timeout=300, startup_timeout=300).execute()


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs(path: pathlib.Path, tmp_path: pathlib.Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    page = re.search(r"Page: (docs/\w+\.md)\.", notebook.cells[0].source)
    assert path.stat().st_size < 5000 and page and (path.parents[2] / page[1]).exists()
    if path.stem in MANY_RUNS:
        pytest.importorskip("matplotlib")
        pytest.importorskip("scipy")
    assert not any(cell.get("outputs") for cell in notebook.cells)  # stored without
    execute(notebook, tmp_path)
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("<table>" in output.get("data", {}).get("text/html", "") for output in outputs)
    pictures = [output for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) == (1 if path.stem in MANY_RUNS else 0)


def test_every_example_of_many_runs_has_a_notebook() -> None:
    examples = {path.stem[3:] for path in (NOTEBOOKS[0].parents[1] / "examples").glob("1[3-9]_*.py")}
    assert examples == MANY_RUNS <= {path.stem for path in NOTEBOOKS}
    page = (NOTEBOOKS[0].parents[2] / "docs" / "ensembles.md").read_text(encoding="utf-8")
    for path in NOTEBOOKS:
        if path.stem in MANY_RUNS:
            assert f"(../python/notebooks/{path.name})" in page


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
