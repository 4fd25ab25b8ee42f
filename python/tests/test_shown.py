"""How parts and results show themselves, what is found by its name, and what errors say of names."""

import copy
import inspect
import random
import subprocess
import sys

import pytest

import carom
from carom import EventDriven, ModelError, Simulation, Surface, System, TimeStepping, planar

from models import ball, everything, falling_ball


def test_identities_have_names() -> None:
    system, body = ball()
    assert repr(body) == "BodyId(0, 'ball')"
    assert repr(system.obstacles()[0]) == "ObstacleId(0, 'floor')"
    assert repr(system.elements()[0]) == "ElementId(0)"
    assert repr(carom.ground) == "ground" and repr(carom.BodyId()) == "BodyId()"
    simulation = Simulation(system, EventDriven())
    simulation.run_until(1.0)
    assert repr(simulation.events()[0].body) == "BodyId(0, 'ball')"
    assert "'ball'" in repr(simulation.events()[0])
    simulation.edit(lambda model: model.add(planar.Particle(mass=1.0, position=(3.0, 1.0)), "second"))
    assert repr(simulation.bodies()[1]) == "BodyId(1, 'second')"
    other = System()
    assert repr(other.add(planar.Particle(mass=1.0))) == "BodyId(0)"
    assert repr(system.material("steel")).endswith("'steel')")
    del other, system, simulation
    assert repr(body).startswith("BodyId(0")  # its system is gone


def test_names_that_copies_disagree_on_are_not_shown() -> None:
    system = falling_ball()
    other = copy.copy(system)
    first = system.add(planar.Particle(mass=1.0, position=(1.0, 1.0)), "first")
    second = other.add(planar.Particle(mass=1.0, position=(1.0, 1.0)), "second")
    assert first == second  # as in C++: identities are good in one of the copies
    assert repr(first) == repr(second) == "BodyId(1)"


def test_systems_and_simulations_say_what_they_are(tmp_path) -> None:
    system = everything()
    assert repr(System()) == "<System: no parts>"
    assert repr(system) == "<System: 9 bodies, 3 joints, 2 elements, 6 shapes, 6 obstacles>"
    assert repr(falling_ball()) == "<System: 1 body, 1 element, 1 obstacle>"
    carom.save_scene(falling_ball(), tmp_path / "incline.json")
    scene = carom.load_scene(tmp_path / "incline.json")
    assert repr(scene.system) == "<System 'incline.json': 1 body, 1 element, 1 obstacle>"
    assert "'incline.json'" in repr(scene)
    simulation = Simulation(scene.system, TimeStepping(step=1e-3))
    simulation.run_until(0.25)
    assert repr(simulation) == "<Simulation 'incline.json': 1 body, 1 element, 1 obstacle; TimeStepping at 0.25 s>"
    assert repr(simulation.system()) == repr(scene.system)
    system.title = "all"
    assert repr(system).startswith("<System 'all': 9 bodies")
    assert system.fingerprint() == everything().fingerprint()


def test_events_are_a_table_in_notebooks() -> None:
    simulation = Simulation(falling_ball(), EventDriven())
    simulation.run_until(1.5)
    events = simulation.events()
    assert isinstance(events, list) and len(events) == simulation.event_count() > 2
    assert "particle &#x27;ball&#x27; on half-plane &#x27;floor&#x27;" in events._repr_html_()
    assert events._repr_html_().count("<tr>") == len(events) + 1
    assert events[1:]._repr_html_().count("<tr>") == len(events)
    assert type(events[0]) is carom.EventRecord and simulation.events(1)[0].time == events[1].time
    assert "<td>" not in Simulation(falling_ball(), TimeStepping()).events()._repr_html_()


def compiled():
    """All compiled functions, methods and classes, with their names."""
    for module in (carom._core, carom.planar, carom.spatial):
        for name, value in vars(module).items():
            if inspect.isclass(value) and value.__module__.startswith("carom"):
                if not issubclass(value, Exception) and hasattr(value.__init__, "__nb_signature__"):
                    yield f"{name}()", value
                for member, function in vars(value).items():
                    if hasattr(function, "__nb_signature__"):
                        yield f"{name}.{member}", function
            elif hasattr(value, "__nb_signature__"):
                yield name, value


def test_inspect_knows_every_signature() -> None:
    names = []
    for name, function in compiled():
        signature = inspect.signature(function)
        assert "args" not in signature.parameters, name
        names.append(name)
    assert len(names) > 300
    assert str(inspect.signature(Simulation(falling_ball(), TimeStepping()).run_until)) == (
        "(time: 'float', *, progress: 'bool | collections.abc.Callable[[float], typing.Any] | None' = None) -> 'None'"
    )
    assert list(inspect.signature(System.add).parameters) == ["self", "part", "surface", "name"]
    stepping = inspect.signature(TimeStepping).parameters
    assert stepping["step"].default == TimeStepping().step and list(stepping)[0] == "step"
    assert stepping["force_rule"].kind is inspect.Parameter.KEYWORD_ONLY
    assert inspect.signature(carom.EnergyRecorder).parameters["interval"].default == 0.0
    assert list(inspect.signature(Simulation).parameters) == ["system", "mode"]


def test_classes_in_python_have_their_own_signature() -> None:
    class Own(planar.ForceElement):
        def __init__(self, strength: float) -> None:
            super().__init__()
            self.strength = strength

    assert list(inspect.signature(Own).parameters) == ["strength"]


def test_materials_by_name() -> None:
    law, slippery = Surface(friction=0.5, normal_restitution=0.25), Surface(friction=0.0, normal_restitution=0.0)
    system = System()
    system.between("steel", "ice", slippery)
    body = system.add(planar.RigidBody(mass=planar.disc(1.0, 0.1)), "wheel")
    shape = planar.Disc(body=body, radius=0.1, material="steel")
    assert shape.material == "steel" and "material='steel'" in repr(shape)
    system.add(shape)
    system.add(planar.HalfPlane(point=(0.0, -1.0), normal=(0.0, 1.0), material="ice"), "lake")
    system.add(planar.HalfPlane(point=(0.0, -2.0), normal=(0.0, 1.0), material="rock"))
    system.between(system.material("rock"), "steel", law)
    assert system.materials == ["steel", "ice", "rock"] or set(system.materials) >= {"steel", "ice", "rock"}
    assert system.law("steel", "ice").friction == 0.0
    assert system.law("rock", system.material("steel")).normal_restitution == 0.25
    assert system.law("steel", system.obstacle("lake")).friction == 0.0
    added = next(part for part in system.parts() if part.role == "shape")
    assert added.part.material == system.material("steel")
    assert shape.material == "steel"  # the part that was given is as it was
    with pytest.raises(ModelError, match="material 'stel': there is none; the nearest is 'steel'; allowed"):
        system.law("stel", "ice")
    with pytest.raises(TypeError, match="material' must be a MaterialId, or the name of a material, not 3"):
        planar.Disc(body=body, radius=0.1, material=3)
    # The same model as with identities.
    same = System()
    steel, ice = same.material("steel"), same.material("ice")
    same.between(steel, ice, slippery)
    body = same.add(planar.RigidBody(mass=planar.disc(1.0, 0.1)), "wheel")
    same.add(planar.Disc(body=body, radius=0.1, material=steel))
    same.add(planar.HalfPlane(point=(0.0, -1.0), normal=(0.0, 1.0), material=ice), "lake")
    rock = same.material("rock")
    same.add(planar.HalfPlane(point=(0.0, -2.0), normal=(0.0, 1.0), material=rock))
    same.between(rock, steel, law)
    assert same.fingerprint() == system.fingerprint()
    assert carom.scene.to_text(same) == carom.scene.to_text(system)


def test_names_that_do_not_exist_have_neighbours() -> None:
    system, _ = ball()
    with pytest.raises(ModelError, match="body 'bal': there is none; the nearest is 'ball'; allowed: the name of a"):
        system.body("bal")
    with pytest.raises(ModelError, match="obstacle 'flor': there is none; the nearest is 'floor'"):
        system.obstacle("flor")
    with pytest.raises(ModelError, match="joint 'pin': there is none; allowed"):
        system.joint("pin")
    with pytest.raises(TypeError, match="Particle has no argument 'masse'; arguments: mass, .*; the nearest is 'mass'$"):
        planar.Particle(masse=1.0)
    with pytest.raises(TypeError, match="ImpactRules has no field 'ordr'; fields: order, .*; the nearest is 'order'$"):
        TimeStepping(impact_rules={"ordr": "sequential"})


@pytest.mark.parametrize(
    "module, name, said",
    [
        (planar, "Partcle", "module 'carom.planar' has no attribute 'Partcle'; the nearest is 'Particle'"),
        (carom, "TimeSteping", "module 'carom' has no attribute 'TimeSteping'; the nearest is 'TimeStepping'"),
        (carom, "Particle", "module 'carom' has no attribute 'Particle'; it is in carom.planar"),
        (planar, "Simulation", "module 'carom.planar' has no attribute 'Simulation'; it is in carom"),
        (carom, "HalfPlan", "module 'carom' has no attribute 'HalfPlan'; the nearest is 'HalfPlane' in carom.planar"),
        (carom, "xyzzy", "module 'carom' has no attribute 'xyzzy'"),
    ],
)
def test_classes_that_do_not_exist_have_neighbours(module, name, said) -> None:
    with pytest.raises(AttributeError) as caught:
        getattr(module, name)
    assert str(caught.value) == said
    assert not hasattr(module, name)
    with pytest.raises(ImportError) as refused:
        exec(f"from {module.__name__} import {name}")
    assert str(refused.value).startswith(f"cannot import name '{name}' from '{module.__name__}'")
    assert said.partition(";")[2] in str(refused.value)


def test_one_wrong_letter_in_a_class_is_found() -> None:
    rng = random.Random(5)
    names = [name for name in vars(planar) if name[0].isupper() and len(name) > 6]
    for _ in range(100):
        name = rng.choice(names)
        at = rng.randrange(1, len(name))
        wrong = name[:at] + rng.choice("abcdefghij") + name[at + 1 :]
        if hasattr(planar, wrong):
            continue
        with pytest.raises(AttributeError, match="the nearest is"):
            getattr(planar, wrong)


@pytest.mark.parametrize("mode", [TimeStepping(step=1e-3), EventDriven()], ids=["stepping", "events"])
def test_motions_of_bodies_are_set(mode) -> None:
    system, particle = ball()
    wheel = system.add(planar.RigidBody(mass=planar.disc(1.0, 0.1), position=(2.0, 3.0)), "wheel")
    system.add(planar.Disc(body=wheel, radius=0.1))
    simulation = Simulation(system, mode)
    simulation.run_until(0.1)
    simulation.set_velocity(particle, (1.0, 2.0))
    simulation.set_velocity(wheel, [0.0, -1.0], spin=3.0)
    simulation.set_position(wheel, (5.0, 4.0), angle=0.5)
    assert list(simulation.velocity(particle)) == [1.0, 2.0]
    assert list(simulation.velocity(wheel)) == [0.0, -1.0] and simulation.spin(wheel) == 3.0
    assert list(simulation.position(wheel)) == [5.0, 4.0] and simulation.angle(wheel) == 0.5
    assert simulation.energy().flow("intervention") != 0.0
    assert abs(simulation.energy().residual()) < 1e-9
    simulation.run_until(0.2)
    state = simulation.state()
    state.set_velocity(particle, (0.0, 0.0))
    state.set_position(particle, (1.0, 1.0))
    assert list(state.velocity(particle)) == [0.0, 0.0] and list(state.position(particle)) == [1.0, 1.0]
    with pytest.raises(TypeError, match="set_velocity\\(\\): velocity must be two numbers"):
        simulation.set_velocity(particle, 3.0)
    with pytest.raises(ModelError, match="spin of body #0: it has none; allowed: a planar rigid body"):
        simulation.set_velocity(particle, (0.0, 0.0), spin=1.0)
    with pytest.raises(ModelError):
        simulation.set_velocity(Simulation(falling_ball(), mode).bodies()[0], (0.0, 0.0))
    with pytest.raises(ModelError, match="not finite|finite"):
        simulation.set_velocity(particle, (float("nan"), 0.0))


def test_the_command_has_a_version() -> None:
    said = subprocess.run([sys.executable, "-m", "carom", "--version"], capture_output=True, text=True, check=True)
    assert said.stdout == f"carom {carom.__version__}\n"
    from importlib import metadata

    try:
        assert metadata.version("carom") == carom.__version__
    except metadata.PackageNotFoundError:
        pytest.skip("the package is not installed by pip")
