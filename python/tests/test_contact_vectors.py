"""Records of contacts as vectors in the fixed frame, against the change of momentum."""

import numpy
import pytest

import carom
from carom import EventDriven, Simulation, Surface, System, TimeStepping, planar, spatial

MASS, STEP = 2.0, 1e-3
ROUNDING = 1e-14  # of numbers up to ten


def test_impulses_of_a_step_in_the_plane_change_the_momentum():
    system = System()
    law = Surface(friction=0.3, normal_restitution=0.5)
    system.add(planar.Gravity((0.0, -9.81)))
    for normal in ((0.6, 0.8), (-0.8, 0.6)):
        system.add(planar.HalfPlane(normal=normal), law)
    ball = system.add(planar.Particle(mass=MASS, position=(0.0, 0.0), velocity=(0.3, -1.0)))
    simulation = Simulation(system, TimeStepping(step=STEP))
    before = simulation.velocity(ball)
    contacts = simulation.step().contacts
    assert len(contacts) == 2
    expected = MASS * (simulation.velocity(ball) - before - STEP * numpy.array([0.0, -9.81]))
    total = sum(contact.impulse_vector for contact in contacts)
    numpy.testing.assert_allclose(total, [*expected, 0.0], rtol=0.0, atol=ROUNDING)
    for contact in contacts:
        n = contact.normal
        numpy.testing.assert_array_equal(contact.tangents, [[n[1], -n[0], 0.0], [0.0, 0.0, 0.0]])
        numpy.testing.assert_array_equal(contact.vector_of(contact.impulse), contact.impulse_vector)
        numpy.testing.assert_allclose(contact.velocity_before_vector, [*before, 0.0], rtol=0.0, atol=ROUNDING)
        after = [*simulation.velocity(ball), 0.0]
        numpy.testing.assert_allclose(contact.velocity_after_vector, after, rtol=0.0, atol=ROUNDING)


def test_impulses_of_events_change_the_momentum():
    system = System()
    system.add(planar.HalfPlane(normal=(0.6, 0.8)), Surface(friction=0.3, normal_restitution=0.5))
    ball = system.add(planar.Particle(mass=MASS, position=(0.6, 0.8), velocity=(0.3, -2.0)))
    simulation = Simulation(system, EventDriven(interval=1.0))
    before = simulation.velocity(ball)
    simulation.run_until(1.0)
    (event,) = simulation.events()
    expected = MASS * (simulation.velocity(ball) - before)
    numpy.testing.assert_allclose(event.impulse_vector, [*expected, 0.0], rtol=0.0, atol=ROUNDING)


def test_impulses_and_forces_in_space():
    normal = numpy.array([0.3, -0.5, 0.9])
    gravity = numpy.array([0.4, 0.2, -9.81])
    system = System()
    system.add(spatial.Gravity(gravity))
    system.add(spatial.HalfSpace(normal=normal), Surface(friction=0.2, normal_restitution=0.0))
    ball = system.add(spatial.Particle(mass=MASS, velocity=(1.0, 2.0, -0.5)))
    simulation = Simulation(system, TimeStepping(step=STEP))
    for _ in range(3):
        before = simulation.velocity(ball)
        (contact,) = simulation.step().contacts
        expected = MASS * (simulation.velocity(ball) - before - STEP * gravity)
        numpy.testing.assert_allclose(contact.impulse_vector, expected, rtol=0.0, atol=ROUNDING)
        numpy.testing.assert_allclose(
            contact.velocity_after_vector, simulation.velocity(ball), rtol=0.0, atol=ROUNDING
        )
    (lasting,) = simulation.contact_forces()
    numpy.testing.assert_allclose(STEP * lasting.force_vector, expected, rtol=0.0, atol=ROUNDING)
    numpy.testing.assert_array_equal(lasting.vector_of(lasting.velocity), lasting.velocity_vector)
    axes = numpy.array([lasting.normal, *lasting.tangents])
    numpy.testing.assert_allclose(axes @ axes.T, numpy.eye(3), rtol=0.0, atol=ROUNDING)


def test_limits_of_joints_have_no_direction():
    system = System()
    bar = system.add(planar.RigidBody(mass=planar.rod(1.0, 2.0), position=(1.0, 0.0), spin=-1.0))
    pin = system.add(planar.Revolute(from_=carom.ground, to=(bar, (-1.0, 0.0))))
    system.add(planar.Stop(joint=pin, lower=-0.01, restitution=0.5))
    simulation = Simulation(system, TimeStepping(step=STEP))
    while not (contacts := simulation.step().contacts):
        assert simulation.time() < 0.1
    assert contacts[0].directions == 1 and contacts[0].impulse[0] > 0.0
    assert not contacts[0].impulse_vector.any() and not numpy.any(contacts[0].tangents)


def test_numbers_that_are_no_vector_are_refused():
    system = System()
    system.add(planar.HalfPlane(normal=(0.0, 1.0)), Surface(friction=0.3, normal_restitution=0.0))
    system.add(planar.Particle(mass=MASS, position=(0.0, 0.0), velocity=(0.3, -1.0)))
    contact = Simulation(system, TimeStepping(step=STEP)).step().contacts[0]
    with pytest.raises((TypeError, ValueError), match="by_direction"):
        contact.vector_of((1.0, 2.0))
