"""The examples of many runs, with few of them."""

import importlib.util
import os
import shutil
import subprocess
import sys

import numpy
import pytest
from conftest import PYTHON

import carom
from carom import EventDriven, EventKind, Simulation


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


@pytest.fixture(scope="module")
def basin():
    """Example 14 as a module."""
    spec = importlib.util.spec_from_file_location("basin", PYTHON / "examples" / "14_basin_of_attraction.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def shaken(basin, crest, periods):
    """Impacts of the oscillator from a crest of the force on: times [s], and speeds before [m/s]; and how it ends."""
    simulation = Simulation(basin.oscillator(*crest), EventDriven(interval=basin.PERIOD, relative_tolerance=1e-12))
    simulation.run_until(periods * basin.PERIOD)
    impacts = [event for event in simulation.events() if event.kind == EventKind.impact]
    ends = int(basin.motions(*(numpy.array(value) for value in basin.last_impacts(simulation)[::2])))
    return numpy.array([(event.time, event.motions[0].velocity_before[0]) for event in impacts]).reshape(-1, 2), ends


def test_orbits_of_the_shaken_mass_are_those_of_the_closed_form(basin):
    fast, slow = basin.orbits(2)
    for number, crest in enumerate(fast.crests):
        impacts, ends = shaken(basin, crest, 40)
        # An impact in the period before the last crest of an orbit, then every second period.
        times = fast.time + basin.PERIOD * (1 - number + 2 * numpy.arange(20))
        numpy.testing.assert_allclose(impacts, numpy.column_stack([times, numpy.full(20, fast.speed)]), rtol=1e-8)
        assert ends == 2 - number
    # The other is not stable: errors become 3.2 times as large from impact to impact.
    impacts, _ = shaken(basin, slow.crests[0], 8)
    numpy.testing.assert_allclose(impacts[:4, 1], slow.speed, rtol=1e-8)
    assert not basin.orbits(1)
    # And the third never reaches the stop.
    impacts, ends = shaken(basin, basin.FORCED, 40)
    assert len(impacts) == 0 and ends == 0


def test_basins_meet_at_the_orbit_that_is_not_stable(basin):
    place, speed = basin.orbits(2)[1].crests[1]
    ends = {shaken(basin, (place, speed + change), 80)[1] for change in (-0.02, 0.02)}
    assert len(ends) == 2


def test_a_map_of_basins(basin, tmp_path):
    out = run("14_basin_of_attraction", tmp_path, "24")
    assert "576 runs, 0 failed" in out
    rows = numpy.loadtxt(tmp_path / "basin.csv", delimiter=",", skiprows=1)
    counts = [int((rows[:, 2] == number).sum()) for number in range(4)]
    assert min(counts[:3]) > 20 and counts[3] <= 3, counts
    impacting = numpy.isin(rows[:, 2], (1, 2))
    fast = basin.orbits(2)[0]
    assert abs(rows[impacting, 4] - fast.speed).max() < 0.02
    assert numpy.median(abs(rows[impacting, 4] - fast.speed)) < 1e-4
    # Each start near a motion ends in it: the one without impacts, and both with them.
    for motion, (place, speed) in enumerate([basin.FORCED, *reversed(fast.crests)]):
        nearest = numpy.argmin(numpy.hypot(rows[:, 0] - place, rows[:, 1] - speed))
        assert rows[nearest, 2] == motion
    assert (tmp_path / "basin_of_attraction.png").stat().st_size > 10_000


def test_throws_scatter_about_the_flashes(tmp_path):
    out = run("15_thrown_between_tables", tmp_path, "200")
    assert out.count("200 throws, 0 failed") == 2
    flashes = numpy.loadtxt(tmp_path / "flashes_0.91.csv", delimiter=",", skiprows=1).reshape(200, 12, 2)
    spread = flashes.std(axis=0).max(axis=1)
    assert spread[0] == 0.0 and (spread[1:] > 1e-3).all() and spread[11] > spread[1]
    # Before the first impact the speeds alone scatter, by 3 %: v t s within four errors of its estimate.
    expected = 0.03 * 5.444387434554974 * 0.0309
    assert abs(flashes[:, 1, 0].std() - expected) < 4.0 * expected / numpy.sqrt(2.0 * 200)
    for e_t in ("0.91", "0.68"):
        at = numpy.loadtxt(tmp_path / f"stated_{e_t}.csv", delimiter=",", skiprows=1)
        flashes = numpy.loadtxt(tmp_path / f"flashes_{e_t}.csv", delimiter=",", skiprows=1).reshape(200, 12, 2)
        assert at[0].tolist() == [0.0, 0.25] and (at[:, 1] > 0.0131 - 2e-3).all() and (at[:, 1] < 0.530 - 0.0131 + 2e-3).all()
        off = numpy.linalg.norm(at - flashes.mean(axis=0), axis=1)
        # A cloud is about the place without errors, but for what is not linear in them.
        assert (off[1:] < numpy.sqrt(flashes.var(axis=0).sum(axis=1))[1:]).all()
        # Before the first impact it is a parabola, but for steps of h: v h t.
        t = 0.0309
        start = [5.444387434554974 if e_t == "0.91" else 6.18975, -5.0 - 0.5 * 9.81 * t]
        assert numpy.linalg.norm(at[1] - numpy.array([0.0, 0.25]) - numpy.array(start) * t) < 1e-3
    assert (tmp_path / "thrown_between_tables.png").stat().st_size > 10_000


def test_identification_finds_the_truth(tmp_path):
    pytest.importorskip("scipy")
    out = run("16_identification", tmp_path, "20")
    counts = [int(line.split(" in ")[1].split()[0]) for line in out.splitlines() if "within two" in line]
    assert len(counts) == 3 and min(counts) >= 16  # 19 of 20 expected; fewer than 16 once in 500 times
    assert (tmp_path / "fit.png").stat().st_size > 5_000


SLURM = PYTHON / "examples" / "slurm"
SCENE = PYTHON / "scenes" / "ball_between_tables.json"
VARY = "surface.lower table.normal_restitution"


def test_the_batch_script_sweeps_by_mpi(tmp_path):
    """With an `srun` that starts three ranks of this machine."""
    pytest.importorskip("mpi4py")
    pytest.importorskip("h5py")
    mpiexec = shutil.which("mpiexec") or pytest.skip("there is no mpiexec")
    said = subprocess.run([mpiexec, "--version"], capture_output=True, text=True).stdout.lower()
    more = "--oversubscribe --allow-run-as-root" if "open" in said else ""
    tools = tmp_path / "tools"
    tools.mkdir()
    for name, text in (("srun", f'exec {mpiexec} -n 3 {more} "$@"'), ("python", f'exec {sys.executable} "$@"')):
        (tools / name).write_text(f"#!/bin/sh\n{text}\n")
        (tools / name).chmod(0o755)
    file = tmp_path / "rows.h5"
    words = [SCENE, "--vary", f"{VARY}=0.5:1.0:30", "--output", "body.ball.position", "--file", file]
    environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"}
    out = subprocess.run(
        [SLURM / "sweep_mpi.sh", *map(str, words)], capture_output=True, text=True, env=environment, timeout=120
    )
    assert out.returncode == 0 and "30 runs, 0 failed" in out.stdout, out.stderr
    call = {"outputs": "body.ball.position", "executor": carom.SerialExecutor()}
    grid = {VARY: numpy.linspace(0.5, 1.0, 30)}
    there = carom.ensemble(SCENE, grid, file=file, **call)["body.ball.position"]
    assert (there == carom.ensemble(SCENE, grid, **call)["body.ball.position"]).all()


FAKE_CLUSTER = """
from dask.distributed import LocalCluster

class SLURMCluster(LocalCluster):
    def __init__(self, cores, processes, memory, walltime):
        assert cores == processes
        super().__init__(n_workers=2, threads_per_worker=1, dashboard_address=None)

    def scale(self, jobs):
        print(f"asked for {jobs} jobs")
        super().scale(min(jobs, 2))  # none at its end
"""


def test_the_program_for_dask_jobqueue_sweeps(tmp_path):
    """With a cluster of this machine in the place of Slurm's."""
    pytest.importorskip("dask.distributed")
    pytest.importorskip("h5py")
    (tmp_path / "dask_jobqueue.py").write_text(FAKE_CLUSTER)
    file = tmp_path / "rows.h5"
    out = subprocess.run(
        [sys.executable, str(SLURM / "sweep_dask.py"), str(SCENE), str(file)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        timeout=120,
    )
    assert out.returncode == 0, out.stderr
    assert "asked for 32 jobs" in out.stdout and "10201 of" in out.stdout and "; 0 failed" in out.stdout
    assert file.exists()
