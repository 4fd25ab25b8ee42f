"""Parts, systems and runs from Python."""

import gc
import math
import threading
import weakref

import numpy
import pytest

import carom
from carom import EventDriven, ModelError, Simulation, Surface, System, TimeStepping, ground
from carom import planar
from carom.planar import Disc, Gravity, HalfPlane, Particle, Point, Prismatic, Revolute, RigidBody, SpringDamper


def floor() -> System:
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.add(HalfPlane(normal=(0.0, 1.0)), Surface(friction=0.5, normal_restitution=0.6), "floor")
    return system


def ball():
    system = floor()
    return system, system.add(Particle(mass=1.0, position=(0.0, 1.0)), name="ball")


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


def test_law_in_python_acts():
    system, body = ball()
    system.add(planar.AppliedForce(on=body, force=lambda time: (0.3 * time, 0.0)))
    simulation = Simulation(system, TimeStepping(step=1e-3))
    simulation.run_until(0.2)
    # x = 0.3 t^3/(6 m), m = 1 kg; the trapezoidal rule misses it by h^2/12 times the rate of v, 0.06 m/s^2.
    assert abs(simulation.state().q[0] - 0.05 * 0.2**3) < 1.1 * 1e-6 / 12.0 * 0.06


def test_compiled_law_is_the_same_as_the_law_in_python():
    import ctypes

    sine = ctypes.CDLL("libm.so.6").sin
    sine.restype, sine.argtypes = ctypes.c_double, [ctypes.c_double]
    ends = []
    for torque in (math.sin, sine):
        system = System()
        body = system.add(RigidBody(mass=planar.disc(1.0, 0.5)))
        system.add(planar.AppliedTorque(on=body, torque=torque))
        simulation = Simulation(system, TimeStepping(step=1e-2))
        simulation.run_until(1.0)
        ends.append(simulation.angle(body))
    assert ends[0] == ends[1]


def test_law_by_numbers_is_the_same_as_the_law_in_python():
    law = carom.Law([0.1, 0.2, -0.3], harmonics=[carom.Harmonic(0.5, frequency=3.0, phase=0.25, growth=0.1)])

    def function(time):
        polynomial = (-0.3 * time + 0.2) * time + 0.1
        return polynomial + (0.5 + 0.1 * time) * math.sin(3.0 * time + 0.25)

    ends = []
    for torque in (law, function):
        system = System()
        body = system.add(RigidBody(mass=planar.disc(1.0, 0.5)))
        system.add(planar.AppliedTorque(on=body, torque=torque))
        simulation = Simulation(system, TimeStepping(step=1e-2))
        simulation.run_until(1.0)
        ends.append(simulation.angle(body))
    assert ends[0] == ends[1] != 0.0
    assert law(0.7) == function(0.7)
    assert planar.AppliedTorque(on=ground, torque=law).torque.polynomial == [0.1, 0.2, -0.3]
    assert list(planar.AppliedForce(on=ground, force=(1.0, 2.0)).force(5.0)) == [1.0, 2.0]
    with pytest.raises(TypeError, match="torque' must be a law with at most 0 slopes"):
        planar.AppliedTorque(on=ground, torque=carom.Law([1.0], slopes=[1.0]))
    with pytest.raises(TypeError, match="torque' must be a function of 1 number, a Law or a constant"):
        planar.AppliedTorque(on=ground, torque="x")


def test_slopes_are_of_the_further_arguments_and_threads_may_call_laws():
    system = System()
    body = system.add(Particle(mass=1.0, position=(2.0, 0.0), contact=False))
    # A spring with a damper, as an actuator: m x'' = -4 (x - 1) - 0.5 x'.
    system.add(planar.LinearActuator(from_=ground, to=body, force=carom.Law([4.0], slopes=[-4.0, -0.5])))
    ends = []
    for threads in (1, 2):
        simulation = Simulation(system, TimeStepping(step=1e-3, threads=threads))
        simulation.run_until(1.0)
        ends.append(simulation.state().q[0])
    # The trapezoidal rule misses x by less than h^2 omega^3 t / 12 = 7e-7 m.
    rate, decay = (4.0 - 0.0625) ** 0.5, 0.25
    exact = 1.0 + math.exp(-decay) * (math.cos(rate) + decay / rate * math.sin(rate))
    assert abs(ends[0] - exact) < 7e-7
    assert ends[0] == ends[1]


def test_drum_has_its_motion_by_numbers():
    motion = planar.drum((0.0, 0.0), 1.0, 1.5).motion
    assert motion.angle(2.0) == 3.0 and motion.spin(2.0) == 1.5 and motion.angular_acceleration(2.0) == 0.0


def test_threads_refuse_laws_in_python_by_name():
    system, body = ball()
    system.add(planar.AppliedForce(on=body, force=lambda time: (0.0, 0.0)), name="push")
    with pytest.raises(ModelError, match="AppliedForce 'push': force is in Python.*threads is 2"):
        Simulation(system, TimeStepping(threads=2))


class Magnet(planar.ForceElement):
    def __init__(self, body, strength):
        super().__init__()
        self.body, self.strength = body, strength

    def bodies(self):
        return [self.body]

    def loads(self, at, out):
        self.seen = at
        out.conservative(self.body, -self.strength * at.position(self.body))

    def potential(self, at):
        return 0.5 * self.strength * float(at.position(self.body) @ at.position(self.body))


def test_element_in_python_keeps_its_energy():
    system = System()
    body = system.add(Particle(mass=1.0, position=(1.0, 0.0), contact=False))
    magnet = Magnet(body, 4.0)
    system.add(magnet, "magnet")
    simulation = Simulation(system, TimeStepping(step=1e-2))
    simulation.run_until(1.0)
    # Linear forces: the trapezoidal rule keeps the energy to rounding.
    assert simulation.energy().total() == pytest.approx(2.0, rel=1e-12)
    with pytest.raises(ModelError, match="during the call only"):
        magnet.seen.position(body)


def test_exceptions_of_laws_come_out_unchanged():
    system, body = ball()

    def fail(time):
        if time > 0.1:
            raise KeyError("mine")
        return (0.0, 0.0)

    system.add(planar.AppliedForce(on=body, force=fail))
    simulation = Simulation(system, TimeStepping(step=1e-2))
    with pytest.raises(KeyError, match="mine"):
        simulation.run_until(1.0)
    assert 0.08 < simulation.time() < 0.11


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: Particle(mass="x"), "Particle: argument 'mass' must be a number, not 'x'"),
        (lambda: Particle(position=(0, 1)), "Particle: argument 'mass' is missing"),
        (lambda: Particle(mass=1, position=(0, 1, 2)), "argument 'position' must be two numbers"),
        (lambda: Particle(mass=1, position=numpy.zeros((2, 2))), "argument 'position' must be two numbers"),
        (lambda: Particle(masse=1), "Particle has no argument 'masse'"),
        (lambda: TimeStepping(max_sweeps=2.5), "argument 'max_sweeps' must be an integer"),
        (lambda: TimeStepping(force_rule="euler"), "argument 'force_rule' must be ForceRule"),
        (lambda: SpringDamper(from_=(ground, 3), to=ground), "from'\\[1\\] must be two numbers"),
    ],
)
def test_wrong_arguments_are_named(make, text):
    with pytest.raises(TypeError, match=text):
        make()


def test_fields_are_read_and_written():
    part = RigidBody(mass=planar.disc(2.0, 0.5), position=(1.0, 2.0))
    assert part.mass.mass == 2.0 and list(part.position) == [1.0, 2.0] and part.angle == 0.0
    part.position, part.angle = (3.0, 4.0), 0.5
    assert list(part.position) == [3.0, 4.0] and part.angle == 0.5
    with pytest.raises(TypeError, match="RigidBody.angle must be a number, not 'x'"):
        part.angle = "x"


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
    simulation = Simulation(system, TimeStepping(step=2e-6))
    thread = threading.Thread(target=lambda: simulation.run_until(1.0))
    thread.start()
    refused = 0
    while thread.is_alive():
        try:
            simulation.time()
        except ModelError as error:
            assert "another thread" in str(error)
            refused += 1
    thread.join()
    assert refused > 0
    assert simulation.time() == 1.0


def test_ctrl_c_ends_a_run_of_time_stepping():
    import os
    import signal

    system, _ = ball()
    simulation = Simulation(system, TimeStepping(step=1e-6))
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.run_until(1e3)
    timer.join()
    reached = simulation.time()
    simulation.step()
    assert 0.0 < reached < simulation.time() < 1e3


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


def test_inverse_dynamics_of_a_driven_bar():
    system = System()
    bar = system.add(RigidBody(mass=planar.rod(2.0, 1.0), position=(0.5, 0.0)))
    pin = system.add(Revolute(from_=ground, to=(bar, (-0.5, 0.0))))
    system.add(planar.Driver(joint=pin, position=lambda t: t * t, velocity=lambda t: 2 * t, acceleration=lambda t: 2.0))
    result = carom.inverse_dynamics(system, [0.0, 0.1])
    # I about the pin is m l^2 / 3, the angular acceleration 2 rad/s^2.
    assert result.samples[0].forces[0] == pytest.approx(4.0 / 3.0, rel=1e-12)


def test_parts_are_listed_as_they_were_added():
    system, body = ball()
    magnet = Magnet(body, 4.0)
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
