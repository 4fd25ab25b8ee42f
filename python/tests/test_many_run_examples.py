"""The examples of many runs, with few of them."""

import subprocess
import sys

import numpy
import pytest
from conftest import PYTHON


def run(name, folder, *words):
    pytest.importorskip("matplotlib")
    command = [sys.executable, "-W", "ignore", str(PYTHON / "examples" / f"{name}.py"), str(folder), *words]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def test_one_impact_a_period_on_the_vibrating_table(tmp_path):
    out = run("13_vibrating_table", tmp_path, "13", "3")
    assert "39 runs, 0 failed" in out
    rows = numpy.loadtxt(tmp_path / "phases.csv", delimiter=",", skiprows=1)
    # At 0.9 g, below where it doubles, a start leads to the orbit of one impact a period; at 1.4 g to none.
    spread = numpy.ptp(rows[:, 2:], axis=1)
    assert (spread[numpy.isclose(rows[:, 0], 0.9)] < 1e-3).any()
    assert (spread[numpy.isclose(rows[:, 0], 1.4)] > 0.1).all()
    assert (tmp_path / "vibrating_table.png").stat().st_size > 10_000


def test_throws_scatter_about_the_flashes(tmp_path):
    out = run("15_thrown_between_tables", tmp_path, "200")
    assert out.count("200 throws, 0 failed") == 2
    flashes = numpy.loadtxt(tmp_path / "flashes_0.91.csv", delimiter=",", skiprows=1).reshape(200, 12, 2)
    spread = flashes.std(axis=0).max(axis=1)
    assert spread[0] == 0.0 and (spread[1:] > 1e-3).all() and spread[11] > spread[1]
    # Before the first impact the speeds alone scatter, by 3 %: v t s within four errors of its estimate.
    expected = 0.03 * 5.444387434554974 * 0.0309
    assert abs(flashes[:, 1, 0].std() - expected) < 4.0 * expected / numpy.sqrt(2.0 * 200)
    assert (tmp_path / "thrown_between_tables.png").stat().st_size > 10_000


def test_identification_finds_the_truth(tmp_path):
    pytest.importorskip("scipy")
    out = run("16_identification", tmp_path, "20")
    counts = [int(line.split(" in ")[1].split()[0]) for line in out.splitlines() if "within two" in line]
    assert len(counts) == 3 and min(counts) >= 16  # 19 of 20 expected; fewer than 16 once in 500 times
    assert (tmp_path / "fit.png").stat().st_size > 5_000
