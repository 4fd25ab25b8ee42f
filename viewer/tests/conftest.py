"""A browser without a window, and pages of recordings in it."""

import re
import shutil
import sys
from pathlib import Path

import pytest
from selenium import webdriver

sys.path.insert(0, str(Path(__file__).parents[2] / "python" / "tests"))

import spatial_run as spatial  # noqa: E402
from browser import COLOURS, Page, open_browser  # noqa: E402
from models import everything, falling_ball, pile  # noqa: E402

from carom import EventDriven, Recorder, Simulation, TimeStepping, write_view  # noqa: E402

COLOURS_OF_BODIES = re.findall(r"#\w{6}", re.search(r"BODIES = \[(.*?)\]", COLOURS).group(1))


@pytest.fixture(scope="session")
def browser():
    assert shutil.which("chromium"), "chromium is missing; scripts/viewer.sh installs it"
    driver = open_browser()
    yield driver
    driver.quit()


def record(system, mode, until, interval):
    simulation = Simulation(system, mode)
    with Recorder(simulation, interval=interval) as recorder:
        simulation.run_until(until)
    return recorder.recording()


@pytest.fixture(scope="session")
def recordings():
    """Recordings by name."""
    return {
        "everything": record(everything(), TimeStepping(step=1e-3), 2.0, 0.01),
        "ball": record(falling_ball(), EventDriven(), 2.0, 0.02),
        "pile": record(pile(8, 5), TimeStepping(step=1e-3), 1.5, 0.01),
        "space": spatial.recording(),
    }


@pytest.fixture
def show(browser: webdriver.Chrome, recordings, tmp_path):
    """Opens the page of a recording; after the test, the browser must have had nothing to complain of."""
    opened = []

    def open_page(name: str) -> Page:
        path = tmp_path / f"{name}.html"
        write_view(recordings[name], path)
        opened.append(name)
        return Page(browser, path.as_uri(), recordings[name])

    browser.get_log("browser")
    yield open_page
    assert [entry["message"] for entry in browser.get_log("browser")] == []
