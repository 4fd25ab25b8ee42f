"""Arguments and fields of parts and options: what is taken, and what the refusal of others says."""

import numpy
import pytest

import carom
from carom import EventDriven, Simulation, System, TimeStepping, ground, planar
from carom.planar import Particle, RigidBody, SpringDamper

from models import ball


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


def test_a_dictionary_is_made_a_nested_struct():
    mode = TimeStepping(
        impact_rules={"order": "sequential", "sequence_limit": 7},
        overlaps={"never_tunnel": True},
        control={"tolerance": 1e-5},
    )
    assert mode.impact_rules.order == carom.ImpactOrder.sequential and mode.impact_rules.sequence_limit == 7
    assert mode.impact_rules.energy_gain == carom.ImpactRules().energy_gain  # not given: as by default
    assert mode.overlaps.never_tunnel and mode.control.tolerance == 1e-5
    mode.impact_rules = {"refuse_jams": True}
    assert mode.impact_rules.refuse_jams and mode.impact_rules.order == carom.ImpactOrder.simultaneous
    body = RigidBody(mass={"mass": 2.0, "inertia": 0.5})
    assert (body.mass.mass, body.mass.inertia) == (2.0, 0.5)
    law = carom.Law([0.1], harmonics=[{"amplitude": 0.5, "frequency": 3.0}])
    assert law(0.2) == carom.Law([0.1], harmonics=[carom.Harmonic(0.5, frequency=3.0)])(0.2)
    torque = planar.AppliedTorque(on=ground, torque={"polynomial": [1.0, 2.0]}).torque
    assert torque.polynomial == [1.0, 2.0]


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (
            {"ordre": "sequential"},
            "TimeStepping: argument 'impact_rules': ImpactRules has no field 'ordre'; fields: order, "
            "sequence_limit, energy_gain, refuse_jams",
        ),
        ({3: "sequential"}, "ImpactRules has no field 3; fields: order"),
        (
            {"order": "random"},
            "argument 'impact_rules'\\['order'\\] must be ImpactOrder \\('simultaneous', 'sequential'\\), not",
        ),
        ({"sequence_limit": 1.5}, "'impact_rules'\\['sequence_limit'\\] must be an integer"),
        ("sequential", "'impact_rules' must be carom.ImpactRules, not 'sequential' \\(str\\)"),
        ([("order", "sequential")], "'impact_rules' must be carom.ImpactRules, not "),
    ],
)
def test_a_dictionary_is_checked_field_by_field(given, text):
    with pytest.raises(TypeError, match=text):
        TimeStepping(impact_rules=given)
    mode = TimeStepping(impact_rules={"sequence_limit": 9})
    with pytest.raises(TypeError):
        mode.impact_rules = given
    assert mode.impact_rules.sequence_limit == 9


def test_a_field_that_a_dictionary_must_have_is_named():
    with pytest.raises(TypeError, match="RigidBody: argument 'mass': field 'inertia' of MassProperties is missing"):
        RigidBody(mass={"mass": 1.0})


@pytest.mark.parametrize("arguments", [(), (None,)])
def test_a_simulation_without_a_mode_says_which_there_are(arguments):
    text = "Simulation: argument 'mode' is missing; allowed: TimeStepping\\(step=...\\) .*EventDriven\\(\\)"
    with pytest.raises(TypeError, match=text):
        Simulation(System(), *arguments)


def test_a_simulation_without_anything_says_what_it_needs():
    with pytest.raises(TypeError, match="arguments 'system' and 'mode' are missing; .*Simulation\\(system, Time"):
        Simulation()


@pytest.mark.parametrize("system", [None, System, TimeStepping(), "ball"])
def test_what_is_no_system_is_refused(system):
    with pytest.raises(TypeError, match="Simulation: argument 'system' must be a System, not "):
        Simulation(system, TimeStepping())


@pytest.mark.parametrize("mode", [EventDriven, "event-driven", {"step": 1e-3}])
def test_what_is_no_mode_is_refused(mode):
    with pytest.raises(TypeError, match="mode must be TimeStepping\\(...\\) or EventDriven\\(...\\), not"):
        Simulation(ball()[0], mode)
