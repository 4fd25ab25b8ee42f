"""What calls return and keep alive: reports, callbacks, views after edits, foreign identities, errors."""

import gc
import weakref
from collections.abc import Callable

import pytest

import carom
from carom import ImpactRules, ModelError, Simulation, SolverError, Surface, System, TimeStepping, ground, planar
from carom.planar import (
    Disc,
    Gravity,
    HalfPlane,
    MassProperties,
    Particle,
    Point,
    Revolute,
    RigidBody,
    SpringDamper,
)

from models import is_lock_released


def falling(step: float = 1e-2) -> tuple[Simulation, carom.BodyId]:
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.add(HalfPlane(normal=(0.0, 1.0)), Surface(friction=0.5, normal_restitution=0.6), "floor")
    body = system.add(Particle(mass=1.0, position=(0.0, 1.0)), "ball")
    return Simulation(system, TimeStepping(step=step)), body


def test_step_returns_its_report_as_a_copy() -> None:
    simulation, _ = falling()
    first = simulation.step()
    second = simulation.step()
    assert isinstance(first, carom.StepReport)
    assert (first.time, second.time) == (0.01, 0.02)
    assert first.step == 0.01 and second.time == simulation.report().time
    while not (report := simulation.step()).contacts:
        pass
    contact = report.contacts[0]
    del report, simulation
    gc.collect()
    assert contact.impulse[0] > 0.0


class Observer:
    """A function that can be seen to be gone."""

    def __init__(self) -> None:
        self.calls = 0

    def __call__(self, *_: object) -> None:
        self.calls += 1


@pytest.mark.parametrize("begin", [Simulation.observe, lambda simulation, f: simulation.every(1e-3, f)])
def test_removed_callbacks_are_freed_and_keep_no_lock(begin: Callable) -> None:
    simulation, _ = falling(step=1e-5)
    observer = Observer()
    callback = begin(simulation, observer)
    simulation.run_until(1e-3)
    calls, gone = observer.calls, weakref.ref(observer)
    assert calls > 0
    simulation.remove_callback(callback)
    assert is_lock_released(simulation)
    assert observer.calls == calls
    del observer
    assert gone() is None
    with pytest.raises(ModelError):
        simulation.remove_callback(callback)


def test_observer_may_remove_itself() -> None:
    simulation, _ = falling()
    seen = []

    def once(now: Simulation) -> None:
        seen.append(now.time())
        now.remove_callback(callback)

    callback = simulation.observe(once)
    simulation.run_until(0.05)
    assert seen == [0.01]


def test_refused_callbacks_are_not_kept() -> None:
    simulation, _ = falling()
    action = Observer()
    gone = weakref.ref(action)
    with pytest.raises(ModelError):
        simulation.every(-1.0, action)
    del action
    assert gone() is None


def test_callback_of_another_simulation_is_refused() -> None:
    first, second = falling()[0], falling()[0]
    observer = Observer()
    callback = first.observe(observer)
    second.observe(Observer())
    with pytest.raises(ModelError):
        second.remove_callback(callback)
    first.step()
    assert observer.calls == 1


def test_sink_of_the_log_is_freed_when_another_takes_its_place() -> None:
    simulation, _ = falling(step=1e-5)
    sink = Observer()
    gone = weakref.ref(sink)
    simulation.set_log(sink)
    del sink
    assert gone() is not None
    simulation.set_log(None)
    assert gone() is None and is_lock_released(simulation)


def test_views_belong_to_their_state_before_and_after_an_edit() -> None:
    simulation, body = falling()
    state = simulation.state()
    place = state.position(body)
    simulation.edit(
        lambda model: (model.remove(body), model.add(Particle(mass=1.0, position=(3.0, 1.0)), "new"))
    )
    del state
    gc.collect()
    assert list(place) == [0.0, 1.0]
    place[0] = 7.0  # writes to the old state, which is nobody's now
    assert simulation.positions().tolist() == [[3.0, 1.0]] and simulation.bodies() != [body]
    with pytest.raises(ModelError):
        simulation.position(body)


def test_writing_to_a_state_changes_the_simulation_when_it_is_set() -> None:
    simulation, body = falling()
    state = simulation.state()
    state.position(body)[:] = (2.0, 3.0)
    state.v[:] = (0.5, 0.0)
    assert list(simulation.position(body)) == [0.0, 1.0]
    simulation.set_state(state)
    assert list(simulation.position(body)) == [2.0, 3.0] and list(simulation.velocity(body)) == [0.5, 0.0]
    with pytest.raises(TypeError, match="State.q must be 2 numbers, not 3"):
        state.q = [1.0, 2.0, 3.0]


def test_state_of_another_model_is_refused() -> None:
    simulation, _ = falling()
    before = simulation.state()
    simulation.edit(lambda model: model.add(Particle(mass=1.0, position=(5.0, 1.0))))
    with pytest.raises(ModelError):
        simulation.set_state(before)
    assert simulation.positions().shape == (2, 2)


def other() -> tuple[System, carom.BodyId, carom.JointId, carom.ElementId, carom.ShapeId, carom.ObstacleId]:
    """A system with one part of each kind; the same serial numbers as in any other."""
    system = System()
    body = system.add(RigidBody(mass=planar.disc(1.0, 0.1), position=(0.5, 0.0)), "body")
    joint = system.add(Revolute(from_=ground, to=(body, (-0.5, 0.0))), "pin")
    element = system.add(Gravity((0.0, -9.81)), "gravity")
    shape = system.add(Disc(body=body, radius=0.1), "disc")
    surface = Surface(friction=0.0, normal_restitution=0.0)
    obstacle = system.add(HalfPlane(point=(0.0, -5.0), normal=(0.0, 1.0)), surface, "floor")
    return system, body, joint, element, shape, obstacle


def test_identities_of_another_system_are_refused_everywhere() -> None:
    _, body, joint, element, shape, obstacle = other()
    system = other()[0]
    simulation = Simulation(system, TimeStepping())
    state, report = simulation.state(), simulation.step()
    calls: list[Callable[[], object]] = [
        *(lambda part=part: system.remove(part) for part in (body, joint, element, shape, obstacle)),
        lambda: system.add(Disc(body=body, radius=0.1)),
        lambda: system.add(SpringDamper(from_=ground, to=body, stiffness=1.0)),
        lambda: system.add(Revolute(from_=ground, to=(body, (0.0, 0.0)))),
        lambda: system.add(planar.Motor(joint=joint, torque=lambda time, angle, rate: 0.0)),
        lambda: system.keep_place(body),
        lambda: system.allow_contact(body, ground, False),
        lambda: system.body_of(shape),
        lambda: system.has_orientation(body),
        lambda: simulation.position(body),
        lambda: simulation.velocity(body),
        lambda: simulation.angle(body),
        lambda: simulation.spin(body),
        lambda: simulation.coordinate(joint),
        lambda: simulation.rate(joint),
        lambda: simulation.reaction(joint),
        lambda: state.position(body),
        lambda: state.velocity(body),
        lambda: state.set_angle(body, 1.0),
        lambda: state.set_spin(body, 1.0),
        lambda: state.coordinate(joint),
        lambda: carom.CsvRecorder(simulation, "/dev/null", [body]),
    ]
    for i, call in enumerate(calls):
        with pytest.raises(ModelError):
            print(i, call())
    assert system.name(body) == "part of another system"  # names are for messages: no error
    assert not any(part in system for part in (body, joint, element, shape, obstacle))
    assert system.bodies() and len(system.joints()) == 1  # nothing was removed or added
    assert len(report.contacts) == 0


def test_solver_error_has_the_problem() -> None:
    system = System()
    surface = Surface(friction=1.0, normal_restitution=1.0, tangential_restitution=0.0)
    system.add(HalfPlane(normal=(0.0, 1.0)), surface, "floor")
    mass = MassProperties(mass=1.0, inertia=1.0)
    body = system.add(RigidBody(mass=mass, position=(0.0, 1.0), velocity=(1.0, -2.0)), "body")
    system.add(Point(body=body, position=(-1.0, -1.0)))
    simulation = Simulation(system, TimeStepping(impact_rules=ImpactRules(energy_gain="refuse")))
    with pytest.raises(SolverError, match="body 'body'.*half-plane 'floor'") as caught:
        simulation.step()
    error = caught.value
    assert error.time == 0.0 and error.step == TimeStepping().step
    assert any("body" in part for part in error.parts)
    assert isinstance(error.problem, carom.ContactProblem)
    # W_nn = W_tt = 1/m + 1/I, W_nt = -1/I; b = (1 + e) gamma of the rows, here with e_n = 1 and e_t = 0.
    assert error.problem.matrix().tolist() == [[2.0, 1.0], [1.0, 2.0]] or error.problem.rows() == 2
    impulse, report = carom.SolverChain().solve(error.problem)
    assert report.usable() and carom.residual(error.problem, impulse) < 1e-12
    assert simulation.time() == 0.0 and list(simulation.velocity(body)) == [1.0, -2.0]


def test_errors_form_a_tree() -> None:
    for kind in (carom.ModelError, carom.SolverError, carom.FileError, carom.Cancelled):
        assert issubclass(kind, carom.Error)
    assert issubclass(carom.ModelError, ValueError) and issubclass(carom.FileError, OSError)
    with pytest.raises(carom.FileError, match="/nowhere/at/all"):
        falling()[0].save("/nowhere/at/all")
    simulation, _ = falling()
    simulation.stop_when(lambda: True)
    with pytest.raises(carom.Cancelled):
        simulation.step()
    simulation.stop_when(None)
    assert simulation.step().time == 0.01
