"""The notebooks run, and their tables are HTML."""

import pathlib

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
jupyter_client = pytest.importorskip("jupyter_client")

NOTEBOOKS = sorted((pathlib.Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
assert NOTEBOOKS


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs(path: pathlib.Path, tmp_path: pathlib.Path) -> None:
    assert path.stat().st_size < 5000 and (NOTEBOOKS[0].parents[2] / "docs" / f"{path.stem}.md").exists()
    notebook = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells)  # stored without
    # Sockets are files of its own: a free port may be taken by another program before the kernel has it.
    sockets = str(tmp_path / "kernel")
    kernel = jupyter_client.AsyncKernelManager(kernel_name="python3", transport="ipc", ip=sockets)
    nbclient.NotebookClient(notebook, km=kernel, timeout=300, startup_timeout=300).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("<table>" in output.get("data", {}).get("text/html", "") for output in outputs)
