"""Systems and runs from Python."""

import gc
import pathlib
import subprocess
import sys
import weakref

import pytest

import carom
from carom import EventDriven, ModelError, Simulation, Surface, System, TimeStepping, ground
from carom import planar
from carom.planar import Disc, Particle, Revolute, RigidBody, SpringDamper

from models import ball, floor, is_lock_released


def test_ball_bounces_as_in_the_tutorial():
    system, _ = ball()
    simulation = Simulation(system, EventDriven())
    simulation.run_until(2.0)
    first = simulation.events()[0]
    # sqrt(2 / 9.81) s, and 0.6 of the speed is left; tolerance of the event-driven mode.
    assert first.time == pytest.approx((2.0 / 9.81) ** 0.5, rel=1e-9)
    assert first.velocity_after[0] == pytest.approx(0.6 * (2.0 * 9.81) ** 0.5, rel=1e-9)
    assert simulation.name(first) == "particle 'ball' on half-plane 'floor'"
    assert first.kind == carom.EventKind.impact
    ledger = simulation.energy()
    assert abs(ledger.residual()) < 1e-9 * ledger.scale()
    assert str(ledger).startswith("  total")


def test_identities_of_another_system_are_refused():
    system, body = ball()
    with pytest.raises(ModelError):
        floor().add(Disc(body=body, radius=0.1))
    with pytest.raises(ModelError):
        Simulation(floor(), TimeStepping()).position(body)


def test_views_of_a_state_stay_valid_after_an_edit():
    system, body = ball()
    simulation = Simulation(system, TimeStepping())
    state = simulation.state()
    view = state.q
    del state
    simulation.edit(lambda model: model.add(Particle(mass=2.0, position=(5.0, 5.0)), "second"))
    gc.collect()
    assert list(view) == [0.0, 1.0]
    assert simulation.system().body("second") in simulation.system()
    assert simulation.positions().shape == (2, 2)


def test_the_system_of_an_edit_ends_with_it():
    system, _ = ball()
    simulation = Simulation(system, TimeStepping())
    kept = []
    simulation.edit(kept.append)
    with pytest.raises(ModelError, match="until the function given to edit"):
        kept[0].bodies()


def test_failed_edit_changes_nothing():
    system, _ = ball()
    simulation = Simulation(system, TimeStepping())

    def change(model):
        model.add(Particle(mass=1.0))
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        simulation.edit(change)
    assert simulation.positions().shape == (1, 2)
    simulation.run_until(0.1)


def test_checkpoint_continues_bit_for_bit(tmp_path):
    system, _ = ball()
    simulation = Simulation(system, TimeStepping())
    simulation.run_until(0.5)
    simulation.save(tmp_path / "half")
    simulation.run_until(1.0)
    again = Simulation(system, TimeStepping())
    again.load(tmp_path / "half")
    again.run_until(1.0)
    assert (again.state().q == simulation.state().q).all()
    assert (again.state().v == simulation.state().v).all()


def test_observers_get_the_simulation_and_cycles_are_collected():
    system, _ = ball()
    simulation = Simulation(system, TimeStepping(step=0.1))
    times = []
    simulation.observe(lambda now: times.append((now is simulation, now.time())))
    simulation.run_until(0.3)
    assert [same for same, _ in times] == [True, True, True]

    class Marked:
        pass

    mark = Marked()
    gone = weakref.ref(mark)
    simulation.observe(lambda now, mark=mark, own=simulation: None)
    del mark, simulation, times
    gc.collect()
    assert gone() is None


def test_lock_is_released_while_nothing_in_python_is_called():
    system, _ = ball()
    simulation = Simulation(system, TimeStepping(step=1e-5))
    assert is_lock_released(simulation)
    assert simulation.time() > 0.0  # free again


CTRL_C = """
import os, signal, sys, threading, time
sys.path.insert(0, sys.argv[1])
from carom import Simulation, TimeStepping
from models import ball, is_running

signal.signal(signal.SIGINT, signal.default_int_handler)  # a program in the background may have it ignored
simulation = Simulation(ball()[0], TimeStepping(step=1e-6))

def press():
    assert is_running(simulation)
    time.sleep(0.2)  # on a busy machine it may not have made a step yet
    os.kill(os.getpid(), signal.SIGINT)

threading.Thread(target=press).start()
try:
    simulation.run_until(1e6)
except KeyboardInterrupt:
    reached = simulation.time()
    simulation.step()
    print(0.0 < reached < simulation.time() < 1e6)
"""


def test_ctrl_c_ends_a_run_of_time_stepping():
    """In a process of its own, with a limit: others have handlers of signals too, and a signal may be lost."""
    here = str(pathlib.Path(__file__).parent)
    ran = subprocess.run([sys.executable, "-c", CTRL_C, here], capture_output=True, text=True, timeout=60)
    assert ran.stdout == "True\n", ran.stderr


def test_paths_of_traces_are_texts_or_paths(tmp_path):
    system, _ = ball()
    simulation = Simulation(system, TimeStepping(step=1e-2))
    trace = carom.record_at(simulation, [0.1, 0.2])
    trace.save(tmp_path / "trace.csv")
    assert len(carom.EnergyTrace.load(tmp_path / "trace.csv")) == len(trace) == 3  # the start too
    with pytest.raises(TypeError, match="path must be a text or a path, not 3"):
        trace.save(3)


def test_solver_errors_have_data():
    system = System()
    body = system.add(Particle(mass=1.0, position=(2.0, 0.0), contact=False), name="ball")
    system.add(SpringDamper(from_=ground, to=body, stiffness=1e8, free_length=1.0), "strut")
    simulation = Simulation(system, TimeStepping(step=1e-2, iteration="fixed_point"))
    with pytest.raises(carom.SolverError) as caught:
        simulation.step()
    assert isinstance(caught.value, carom.Error)
    assert caught.value.time == 0.0 and caught.value.step == 1e-2 and caught.value.problem is None
    assert any("strut" in part for part in caught.value.parts)


def test_contact_problem_is_solved():
    problem = carom.ContactProblem([[2.0]], [-1.0], [carom.RowSet()])
    impulse, report = carom.SolverChain().solve(problem)
    assert report.usable() and impulse[0] == 0.5
    assert carom.residual(problem, impulse) == 0.0


def test_residuals_of_a_solver_by_sweep(tmp_path):
    friction = carom.RowSet(kind="bounded_disc", bound=0, coefficient=0.3)
    w = [[2.0, -0.5, 0.0], [-0.5, 3.0, 0.0], [0.0, 0.0, 3.0]]
    problem = carom.ContactProblem(w, [-1.0, 0.5, 0.2], [carom.RowSet(), friction, friction])
    history = carom.residual_history(problem, "dense_sweeps")
    assert history.solver == "dense sweeps" and history.outcome == carom.Outcome.solved
    assert [point.iterations for point in history.sweeps] == list(range(1, len(history.sweeps) + 1))
    assert history.answer.residual < 1e-15 and history.answer.seconds >= 0.0
    of_plane = carom.ContactProblem([[2.0]], [-1.0], [carom.RowSet()])
    carom.write_histories(tmp_path / "history.csv", [history, carom.residual_history(of_plane, "lemke")])
    lines = (tmp_path / "history.csv").read_text().splitlines()
    assert lines[0] == "solver,kind,outcome,iterations,seconds,residual"
    assert len(lines) == len(history.sweeps) + 3
    assert lines[-1].startswith("Lemke,answer,solved,")
    with pytest.raises(TypeError, match="residual_history.*solver"):
        carom.residual_history(problem, 7)


def test_inverse_dynamics_of_a_driven_bar():
    system = System()
    bar = system.add(RigidBody(mass=planar.rod(2.0, 1.0), position=(0.5, 0.0)))
    pin = system.add(Revolute(from_=ground, to=(bar, (-0.5, 0.0))))
    system.add(planar.Driver(joint=pin, position=lambda t: t * t, velocity=lambda t: 2 * t, acceleration=lambda t: 2.0))
    result = carom.inverse_dynamics(system, [0.0, 0.1])
    # I about the pin is m l^2 / 3, the angular acceleration 2 rad/s^2.
    assert result.samples[0].forces[0] == pytest.approx(4.0 / 3.0, rel=1e-12)


class Weightless(planar.ForceElement):
    """An element without loads."""

    def __init__(self, body):
        super().__init__()
        self.body = body

    def bodies(self):
        return [self.body]

    def loads(self, at, out):
        pass


def test_parts_are_listed_as_they_were_added():
    system, body = ball()
    magnet = Weightless(body)
    removed = system.add(Particle(mass=1.0), "removed")
    system.add(magnet, "magnet")
    system.remove(removed)
    wood, brass = system.material("wood"), system.material("brass")
    system.between(wood, brass, Surface(friction=0.2, normal_restitution=0.0))
    listed = system.parts()
    assert [(item.role, item.name) for item in listed] == [
        ("element", ""),
        ("obstacle", "floor"),
        ("body", "ball"),
        ("element", "magnet"),
    ]
    assert listed[2].id == body and list(listed[2].part.position) == [0.0, 1.0]
    assert listed[1].surface.friction == 0.5 and listed[2].surface is None
    assert listed[3].part is magnet
    # What is given out is a copy.
    listed[2].part.mass = 5.0
    assert listed[2].part.mass == system.parts()[2].part.mass == 1.0
    assert [(a, b, law.friction) for a, b, law in system.laws()] == [("wood", "brass", 0.2)]


def test_example_runs():
    import pathlib
    import runpy

    example = pathlib.Path(__file__).parents[1] / "examples" / "bouncing_ball.py"
    simulation = runpy.run_path(str(example))["run"]()
    assert simulation.event_count() == 23


@pytest.mark.parametrize("mode", [TimeStepping(step=1e-3), EventDriven()])
def test_forces_of_a_brick_at_rest_carry_its_weight(mode):
    system = System()
    system.add(planar.Gravity((0.0, -9.81)))
    brick = system.add(RigidBody(mass=planar.box(2.0, 0.4, 0.2), position=(0.0, 0.1)), name="brick")
    corners = [(-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1)]
    system.add(planar.Polygon(body=brick, vertices=corners))
    rough = Surface(friction=0.5, normal_restitution=0.0)
    ground_id = system.add(planar.HalfPlane(normal=(0.0, 1.0)), rough, name="floor")
    simulation = Simulation(system, mode)
    simulation.run_until(0.1)
    forces = simulation.contact_forces()
    assert len(forces) == 2 and all(one.force[0] > 0.0 for one in forces)
    for one in forces:
        assert simulation.name(one.key).endswith("on half-plane 'floor'")
    # A weight of 19.62 N, to the rounding of the solution.
    assert carom.force_on(forces, brick).mean_force == pytest.approx((0.0, 19.62), abs=1e-9)
    assert carom.force_on(forces, ground_id).mean_force == pytest.approx((0.0, -19.62), abs=1e-9)
    assert simulation.statistics().certified_share(1e-10) == 1.0
    assert len(simulation.statistics().certified_steps) > 2
