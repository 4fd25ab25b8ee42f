#!/usr/bin/env python3
"""Runs the models of python/scenes and writes a page for the browser of each; needs the package carom.

    gallery.py <folder> [<name of a scene>]...      without names: all
"""

import pathlib
import sys

from carom import Recorder, load_scene, write_view

SCENES = pathlib.Path(__file__).resolve().parents[1] / "python" / "scenes"
SAMPLES = 400  # of a run; what is shown between two is on the straight way


def make(name: str, folder: pathlib.Path) -> pathlib.Path:
    """The page of a scene."""
    scene = load_scene(SCENES / f"{name}.json")
    simulation = scene.simulation()
    with Recorder(simulation, interval=scene.until / SAMPLES) as recorder:
        simulation.run_until(scene.until)
    page = folder / f"{name}.html"
    write_view(recorder.recording(), page, title=name.replace("_", " "))
    return page


def main(folder: pathlib.Path, names: list[str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name in names or sorted(path.stem for path in SCENES.glob("*.json")):
        page = make(name, folder)
        print(f"{page}: {page.stat().st_size / 1e6:.1f} MB", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), sys.argv[2:])
