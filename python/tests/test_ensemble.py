"""Many runs: the same rows from every engine, rows that fail, calls that are wrong."""

import concurrent.futures
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy
import pytest
from ensemble_models import (
    be_another_version,
    deadly,
    height,
    nothing,
    ragged,
    random_ball,
    slow,
    stiff,
    thrown_ball,
    times_read,
)

import carom
from carom import EventDriven, FileError, ModelError, SerialExecutor, Simulation, TimeStepping, Trace

GRID = {
    "surface.floor.normal_restitution": numpy.linspace(0.1, 0.9, 17),
    "body.ball.velocity.x": [0.0, 1.0, -2.5],
}
CALL = {
    "mode": EventDriven(),
    "until": 1.0,
    "outputs": ["energy.total", "body.ball.position", "body.ball.angle", "events.count", height],
}


def rows(runs):
    """Everything of the rows, to compare bit for bit."""
    return {name: runs[name].tolist() for name in runs.columns}


@pytest.fixture(scope="module")
def expected():
    return rows(carom.ensemble(thrown_ball(), GRID, executor=SerialExecutor(), **CALL))


def test_a_grid_is_what_a_loop_gives(expected):
    runs = carom.ensemble(thrown_ball(), GRID, executor=SerialExecutor(), **CALL)
    place = 0
    for e in GRID["surface.floor.normal_restitution"]:
        for speed in GRID["body.ball.velocity.x"]:
            simulation = Simulation(thrown_ball(restitution=float(e)), EventDriven())
            simulation.set_velocity(simulation.system().body("ball"), (speed, 0.0))
            simulation.run_until(1.0)
            assert runs["surface.floor.normal_restitution"][place] == e
            assert runs["body.ball.velocity.x"][place] == speed
            assert runs["energy.total"][place] == simulation.energy().total()
            assert runs["body.ball.position"][place].tolist() == simulation.positions()[0].tolist()
            assert runs["events.count"][place] == simulation.event_count()
            place += 1
    assert place == len(runs) == 51 and not runs.failed and not runs.missing


@pytest.mark.parametrize("executor", [1, 2, "threads"])
def test_every_engine_gives_the_same_rows(executor, expected):
    if executor == "threads":
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            assert rows(carom.ensemble(thrown_ball(), GRID, executor=pool, **CALL)) == expected
    else:
        assert rows(carom.ensemble(thrown_ball(), GRID, executor=executor, **CALL)) == expected


def test_processes_of_another_version_end_an_ensemble(tmp_path):
    pytest.importorskip("h5py")
    file = tmp_path / "sweep.h5"
    both = f"makes runs has carom 0.0.9, .* sends them carom {re.escape(carom.__version__)}; allowed: one version"
    with concurrent.futures.ProcessPoolExecutor(2, initializer=be_another_version) as pool:
        with pytest.raises(ModelError, match=both):
            carom.ensemble(thrown_ball(), GRID, executor=pool, file=file, **CALL)
        assert not file.exists() and not (tmp_path / "sweep.h5.parts").exists()  # no row has failed for it
        with pytest.raises(ModelError, match=both):
            carom.ensemble(stiff, {"stiffness": [1.0]}, executor=pool, **CALL)  # of functions too
        assert pool.submit(os.getpid).result() != os.getpid()  # its processes live


def test_a_process_reads_a_model_once():
    with concurrent.futures.ProcessPoolExecutor(1) as pool:
        carom.ensemble(thrown_ball(), {"body.ball.spin": numpy.linspace(0.0, 1.0, 2000)}, executor=pool, **CALL)
        had, read, *_ = pool.submit(times_read).result()
        assert read == 1 and had >= 2
        carom.ensemble(thrown_ball(friction=0.1), {"body.ball.spin": [1.0]}, executor=pool, **CALL)
        assert pool.submit(times_read).result()[1] == 2


def test_dask_gives_the_same_rows(expected):
    distributed = pytest.importorskip("dask.distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            made = carom.ensemble(thrown_ball(), GRID, executor=client.get_executor(), **CALL)
    assert rows(made) == expected


def test_as_many_batches_are_under_way_as_there_are_workers():
    """Also of Dask, whose workers are not those of this machine, and come and go."""

    class Counting:
        """Counts batches that are under way, which take 5 ms more."""

        def __init__(self, pool):
            self.pool, self.running, self.most = pool, 0, 0

        def submit(self, *call):
            self.running += 1
            self.most = max(self.most, self.running)
            return self.pool.submit(self.later, *call)

        def later(self, function, *arguments):
            time.sleep(5e-3)
            self.running -= 1
            return function(*arguments)

    class Client:
        workers = {"a": 3, "b": 4}

        def ncores(self):
            return self.workers

    for client, most in ((None, 42), (Client(), 16)):
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            executor = Counting(pool)
            executor._max_workers, executor._client = 20, client
            made = carom.ensemble(thrown_ball(), {"body.ball.spin": numpy.arange(100.0)}, executor=executor, **CALL)
        assert not made.missing and most - 2 <= executor.most <= most, executor.most


def test_dask_goes_on_without_a_worker(tmp_path):
    distributed = pytest.importorskip("dask.distributed")
    parameters = {"restitution": numpy.linspace(0.1, 0.9, 60), "folder": [str(tmp_path)]}
    call = {"mode": EventDriven(), "until": 0.5, "outputs": "energy.total"}
    expected = rows(carom.ensemble(slow, parameters, executor=SerialExecutor(), **call))
    with distributed.LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            client.run(lambda path: sys.path.insert(0, path), str(Path(__file__).parent))
            victims = list(client.run(os.getpid).values())
            killed = []

            def show(count):
                if not killed and count >= 5:
                    os.kill(victims[0], signal.SIGKILL)
                    killed.append(count)

            made = carom.ensemble(slow, parameters, executor=client.get_executor(), progress=show, **call)
    assert killed and killed[0] < 60
    assert rows(made) == expected


@pytest.mark.parametrize("parameters", ["list", "frame"])
def test_rows_of_a_list_and_of_a_frame(parameters):
    points = [{"surface.floor.friction": mu, "body.ball.spin": w} for mu, w in ((0.1, 1.0), (0.2, -3.0))]
    given = points
    if parameters == "frame":
        given = pytest.importorskip("pandas").DataFrame(points)
    call = {"mode": EventDriven(), "until": 0.1, "outputs": {"spin": "body.ball.spin"}}
    runs = carom.ensemble(thrown_ball(), given, executor=1, **call)
    assert [runs.parameters(run) for run in range(2)] == points
    assert runs["spin"].tolist() == [point["body.ball.spin"] for point in points]  # nothing has touched it


def test_scene_files_say_how_they_run(tmp_path):
    path = tmp_path / "ball.json"
    carom.save_scene(thrown_ball(), path, mode=EventDriven(), until=0.5)
    grid = {"obstacles.floor.surface.friction": [0.0, 0.5], "simulation.until": [0.2, 0.9]}
    runs = carom.ensemble(path, grid, executor=1, outputs=["time", "energy.kinetic"])
    assert runs["time"].tolist() == [0.2, 0.9, 0.2, 0.9]
    stepped = carom.ensemble(
        path, {"mode.step": [1e-2, 1e-3]}, executor=1, mode=TimeStepping(), outputs="statistics.steps"
    )
    assert stepped["statistics.steps"].tolist() == [50, 500]


def test_random_numbers_are_of_the_run():
    call = {"mode": EventDriven(), "until": 0.0, "outputs": "body.drawn.position.y"}
    first = carom.ensemble(random_ball, {"spread": [0.1] * 20}, executor=SerialExecutor(), seed=7, **call)
    again = carom.ensemble(random_ball, {"spread": [0.1] * 20}, executor=2, seed=7, **call)
    other = carom.ensemble(random_ball, {"spread": [0.1] * 20}, executor=2, seed=8, **call)
    drawn = [
        1.0 + 0.1 * numpy.random.default_rng(child).standard_normal()
        for child in numpy.random.SeedSequence(7).spawn(20)
    ]
    assert first["body.drawn.position.y"].tolist() == drawn == again["body.drawn.position.y"].tolist()
    assert (other["body.drawn.position.y"] != drawn).all()


def test_traces_are_the_simulation_at_their_times():
    times = [0.0, 0.1, 0.45, 0.8]
    trace = {"height": Trace("body.ball.position.y", times), "end": "body.ball.position.y"}
    runs = carom.ensemble(thrown_ball(), GRID, executor=1, mode=EventDriven(), until=1.0, outputs=trace)
    assert runs["height"].shape == (51, 4)
    for run in (0, 20, 50):
        simulation = runs.start(run)
        for place, at in enumerate(times):
            if at > 0.0:
                simulation.run_until(at)
            assert runs["height"][run, place] == simulation.positions()[0, 1]


def test_a_run_that_fails_is_a_row():
    call = {"mode": TimeStepping(step=1e-2, iteration="fixed_point"), "until": 0.5, "outputs": "energy.total"}
    runs = carom.ensemble(stiff, {"stiffness": [1.0, 1e8, 10.0]}, executor=2, **call)
    assert [failure.run for failure in runs.failed] == [1]
    failure = runs.failed[0]
    assert failure.kind == "SolverError" and failure.parts == ["spring-damper 'strut'"]
    assert failure.parameters == {"stiffness": 1e8} and failure.time == 0.0
    assert numpy.isnan(runs["energy.total"]).tolist() == [False, True, False]
    assert runs.simulation(1).time() == failure.time
    assert runs.simulation(2).energy().total() == runs["energy.total"][2]


def test_outputs_that_fail_are_rows():
    runs = carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0, 2.0]}, executor=1, **{**CALL, "outputs": nothing})
    assert [failure.message for failure in runs.failed] == ["output 'nothing': ValueError: nothing to read"] * 2
    lengths = {"surface.floor.normal_restitution": [0.0, 0.9]}
    uneven = carom.ensemble(thrown_ball(), lengths, executor=1, **{**CALL, "until": 2.0, "outputs": ragged})
    assert [failure.run for failure in uneven.failed] == [1]
    assert "allowed: one shape" in uneven.failed[0].message


def test_a_process_that_ends_is_a_row():
    values = [0.1, 0.2, 0.3, 0.5, 0.6, 0.7, 0.8]
    runs = carom.ensemble(deadly, {"restitution": values}, executor=2, mode=EventDriven(), until=0.5)
    assert [(failure.run, failure.message) for failure in runs.failed] == [(3, "its process ended")]
    assert not runs.missing
    assert numpy.isfinite(numpy.delete(runs["energy.total"], 3)).all()


WRONG_PATHS = {
    "surface.flor.friction": "floor",
    "body.ball.velo": "velocity",
    "bodi.ball.spin": "body",
    "body.ball.velocity.w": "no 'w'",
    "body.ball.velocity.2": "has 2",
    "surface.floor": "all of Surface",
    "mode.relative_tol": "relative_tolerance",
    "default_law.friction": "no default law",
    "law.a.b.friction": "no law",
    "until.x": "allowed: 'until'",
    "element.3.strength": "no element 3",
}


@pytest.mark.parametrize("path", WRONG_PATHS)
def test_wrong_paths_are_refused_with_what_is_there(path):
    with pytest.raises(ModelError, match=WRONG_PATHS[path]):
        carom.ensemble(thrown_ball(), {path: [1.0]}, executor=1, **CALL)


WRONG_OUTPUTS = {
    "energy.totl": "total",
    "body.ball.place": "position",
    "ball.position": "body",
    "statistics.step": "steps",
    "events": "events.count",
}


@pytest.mark.parametrize("output", WRONG_OUTPUTS)
def test_wrong_outputs_are_refused_with_what_is_there(output):
    with pytest.raises(ModelError, match=WRONG_OUTPUTS[output]):
        carom.ensemble(thrown_ball(), GRID, executor=1, **{**CALL, "outputs": output})


def test_wrong_calls_are_refused():
    call = {"mode": EventDriven(), "until": 1.0, "executor": 1}
    with pytest.raises(ModelError, match="a list of values"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": 3.0}, **call)
    with pytest.raises(ModelError, match="has no values"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": []}, **call)
    with pytest.raises(ModelError, match="same names"):
        carom.ensemble(thrown_ball(), [{"body.ball.spin": 1.0}, {"body.ball.angle": 1.0}], **call)
    with pytest.raises(ModelError, match="other processes cannot import"):
        carom.ensemble(lambda spin: thrown_ball(), {"spin": [1.0]}, **call)
    with pytest.raises(ModelError, match="has none of that name"):
        carom.ensemble(stiff, {"stifness": [1.0]}, **call)
    with pytest.raises(ModelError, match="no mode"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0]}, until=1.0, executor=1)
    with pytest.raises(ModelError, match="until"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0]}, mode=EventDriven(), executor=1)
    with pytest.raises(ModelError, match="until"):
        carom.ensemble(stiff, {"stiffness": [1.0]}, mode=EventDriven(), executor=1)
    with pytest.raises(ModelError, match="two of the name"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0]}, outputs=["time", "time"], **call)
    with pytest.raises(ModelError, match="a parameter has that name"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0]}, outputs="body.ball.spin", **call)
    with pytest.raises(ModelError, match="each later"):
        Trace("time", [0.2, 0.1])
    with pytest.raises(ModelError, match="ends in .parquet"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0]}, file="sweep.txt", **call)
    with pytest.raises(FileError, match="no folder"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0]}, file="nowhere/sweep.h5", **call)


def test_what_is_shown(tmp_path):
    runs = carom.ensemble(thrown_ball(), GRID, executor=1, **CALL)
    assert repr(runs) == "<Runs: 51 of surface.floor.normal_restitution, body.ball.velocity.x; 0 failed>"
    assert "energy.total" in runs._repr_html_()
    with pytest.raises(KeyError, match=r"energy\.total"):
        runs["energy"]
    with pytest.raises(ModelError, match="allowed: 0 to 50"):
        runs.simulation(51)
    counts = []
    carom.ensemble(thrown_ball(), GRID, executor=1, progress=counts.append, **CALL)
    assert counts[-1] == 51 and counts == sorted(counts)


def test_ranks_of_mpi_give_the_same_rows(tmp_path):
    pytest.importorskip("mpi4py")
    mpiexec = shutil.which("mpiexec") or pytest.skip("there is no mpiexec")
    scene = tmp_path / "ball.json"
    carom.save_scene(thrown_ball(), scene, mode=EventDriven(), until=0.8)
    vary = ["--vary", "surface.floor.normal_restitution=0.1:0.9:40", "--output", "energy.total", "--output", "events.count"]
    sweep = ["-m", "carom", "sweep", str(scene), *vary]
    file = tmp_path / "rows.h5"
    pytest.importorskip("h5py")
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    ranks = [mpiexec, "-n", "3", *(["--oversubscribe"] if "open" in mpi_of(mpiexec, environment) else [])]
    subprocess.run(
        [*ranks, sys.executable, "-m", "mpi4py.futures", *sweep, "--mpi", "--file", str(file)],
        check=True,
        capture_output=True,
        timeout=120,
        env=environment,
    )
    grid = {"surface.floor.normal_restitution": numpy.linspace(0.1, 0.9, 40)}
    call = {"outputs": ["energy.total", "events.count"], "executor": SerialExecutor()}
    assert rows(carom.ensemble(scene, grid, file=file, **call)) == rows(carom.ensemble(scene, grid, **call))


def mpi_of(mpiexec, environment):
    """What mpiexec says of itself."""
    said = subprocess.run([mpiexec, "--version"], capture_output=True, text=True, env=environment)
    return (said.stdout + said.stderr).lower()
