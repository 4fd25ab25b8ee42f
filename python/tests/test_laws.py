"""Laws and elements that are Python functions, functions of C, or numbers."""

import math

import pytest

import carom
from carom import ModelError, Simulation, System, TimeStepping, ground, planar
from carom.planar import Particle, RigidBody

from models import ball


def test_law_in_python_acts():
    system, body = ball()
    system.add(planar.AppliedForce(on=body, force=lambda time: (0.3 * time, 0.0)))
    simulation = Simulation(system, TimeStepping(step=1e-3))
    simulation.run_until(0.2)
    # x = 0.3 t^3/(6 m), m = 1 kg; the trapezoidal rule misses it by h^2/12 times the rate of v, 0.06 m/s^2.
    assert abs(simulation.state().q[0] - 0.05 * 0.2**3) < 1.1 * 1e-6 / 12.0 * 0.06


def angle_under(torque):
    """Angle of a disc after a second under a torque."""
    system = System()
    body = system.add(RigidBody(mass=planar.disc(1.0, 0.5)))
    system.add(planar.AppliedTorque(on=body, torque=torque))
    simulation = Simulation(system, TimeStepping(step=1e-2))
    simulation.run_until(1.0)
    return simulation.angle(body)


def test_compiled_law_is_the_same_as_the_law_in_python():
    import ctypes

    sine = ctypes.CDLL("libm.so.6").sin
    sine.restype, sine.argtypes = ctypes.c_double, [ctypes.c_double]
    assert angle_under(sine) == angle_under(math.sin)


def test_law_by_numbers_is_the_same_as_the_law_in_python():
    law = carom.Law([0.1, 0.2, -0.3], harmonics=[carom.Harmonic(0.5, frequency=3.0, phase=0.25, growth=0.1)])

    def function(time):
        polynomial = (-0.3 * time + 0.2) * time + 0.1
        return polynomial + (0.5 + 0.1 * time) * math.sin(3.0 * time + 0.25)

    assert angle_under(law) == angle_under(function) != 0.0
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
