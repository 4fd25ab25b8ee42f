"""Options of the tests, and the scenes that several of them read."""

import pathlib
import runpy
import sys

import pytest

PYTHON = pathlib.Path(__file__).parents[1]


def pytest_addoption(parser):
    parser.addoption(
        "--all-mutations", action="store_true", help="all 10,000 mutated scene files, not a share"
    )


def pytest_generate_tests(metafunc):
    if "scene_file" in metafunc.fixturenames:
        files = sorted((PYTHON / "scenes").glob("*.json"))
        metafunc.parametrize("scene_file", files, ids=[file.stem for file in files])


@pytest.fixture(scope="session")
def programs():
    """The program of each scene, by name."""
    sys.path.insert(0, str(PYTHON / "examples"))
    try:
        return runpy.run_path(str(PYTHON / "examples" / "scenes.py"))["SCENES"]
    finally:
        sys.path.pop(0)
