"""Scene files: round trips, and errors with line and field."""

import json
import sys

import pytest

import carom
from carom import ModelError, SceneError, Surface, System, TimeStepping, ground, planar, scene, spatial
from carom.planar import Disc, Particle, RigidBody

# What the slow ones run, so that each takes less than half a second.
SHORT = {"discs_in_a_box": 0.05, "bars_in_a_drum": 0.2}


def ends(simulation, until):
    simulation.run_until(until)
    state = simulation.state()
    return list(state.q), list(state.v), repr(simulation.energy().total())


def test_each_scene_runs_as_its_program_to_the_bit(scene_file, programs):
    program, read = programs[scene_file.stem](), carom.load_scene(scene_file)
    until = SHORT.get(scene_file.stem, read.until)
    assert read.until == program.until
    assert read.system.fingerprint() == program.system.fingerprint()
    assert ends(read.simulation(), until) == ends(program.simulation(), until)


def test_each_program_has_a_scene(programs):
    from conftest import PYTHON

    assert sorted(programs) == sorted(file.stem for file in (PYTHON / "scenes").glob("*.json"))


def test_the_motion_by_numbers_is_that_of_the_program(programs):
    plane = sys.modules["04_block_on_a_moving_plane"]
    functions, numbers = plane.by_functions(), plane.by_numbers()
    for name in ("displacement", "velocity", "acceleration"):
        for time in (0.0, 0.3, 1.7, plane.END):
            wanted, found = getattr(functions, name)(time), getattr(numbers, name)(time)
            # Angles up to 38 rad are rounded by 4e-15, three times; accelerations are up to 8.5 m/s^2.
            assert max(abs(a - b) for a, b in zip(wanted, found)) < 2e-13


def test_a_scene_is_written_as_it_was_read(scene_file):
    assert scene.to_text(carom.load_scene(scene_file)) == scene_file.read_text()


def everything():
    """Names that are missing, doubled over roles or words of the format; decisions; removed parts."""
    system = System()
    wood, brass = system.material("wood"), system.material("brass")
    system.between(wood, brass, Surface(friction=0.2, normal_restitution=0.1, impact_law="poisson"))
    system.set_default_law(Surface(friction=0.3, normal_restitution=0.0))
    unnamed = system.add(RigidBody(mass=planar.disc(1.0, 0.5), position=(0.0, 2.0)))
    gone = system.add(Particle(mass=1.0), "gone")
    odd = system.add(RigidBody(mass=planar.disc(2.0, 0.5), position=(2.0, 2.0), angle=-0.0), name="ground")
    quoted = system.add(Particle(mass=1.0, position=(9.0, 1e-300), material=brass), name='quote " and \\ é')
    system.remove(gone)
    system.add(
        Disc(body=unnamed, radius=0.1, material=wood, filter=carom.ContactFilter(3, touches=4294967295))
    )
    system.add(Disc(body=odd, radius=0.1), name="same")
    pin = system.add(planar.Revolute(from_=(unnamed, (0.0, 0.5)), to=ground), name="same")
    system.add(planar.Gear(from_=unnamed, to=odd, ratio=-2.0))
    system.add(planar.Stop(joint=pin, lower=-1.0))
    system.add(planar.SpringDamper(from_=quoted, to=(odd, (0.1, -0.0)), stiffness=3.0, free_length=0.1))
    system.add(planar.Motor(joint=pin, torque=carom.Law([1.0], slopes=[0.5])))
    system.add(planar.AppliedForce(on=quoted, force=(1.0, 2.0), breaks=[0.5, 0.75]))
    system.add(
        planar.Terrain([(-20.0, 0.0), (0.0, -1.0), (20.0, 0.0)], depth=1.0),
        Surface(0.1, normal_restitution=0.0),
    )
    system.allow_contact(unnamed, odd, False)
    system.keep_place(odd)
    return system


def test_references_decisions_and_materials_survive():
    system = everything()
    text = scene.to_text(system)
    again = scene.from_text(text).system
    assert scene.to_text(again) == text
    data = json.loads(text)
    assert data["shapes"][0]["body"] == 0 and data["elements"][0]["from"] == 'quote " and \\ é'
    assert data["joints"][0]["to"] == "ground" and data["shapes"][1]["body"] == 1
    assert again.materials == ["wood", "brass"]
    assert again.law(again.material("brass"), again.material("wood")).impact_law == carom.ImpactLaw.poisson
    mode = TimeStepping(step=1e-3)
    assert ends(carom.Simulation(again, mode), 0.3) == ends(carom.Simulation(system, mode), 0.3)


def test_space():
    system = System()
    system.add(spatial.Gravity((0.0, 0.0, -9.81)))
    system.add(spatial.HalfSpace(normal=(0.0, 0.0, 1.0)), Surface(friction=0.1, normal_restitution=0.5))
    ball = system.add(spatial.Particle(mass=1.0, position=(0.0, 0.0, 1.0)), name="ball")
    system.add(spatial.AppliedForce(on=ball, force=spatial.VectorLaw([(0.1, 0.2, 0.3), (0.0, 1.0, 0.0)])))
    again = scene.from_dict(scene.to_dict(system)).system
    assert again.dimension() == 3
    mode = TimeStepping(step=1e-3)
    assert ends(carom.Simulation(again, mode), 1.0) == ends(carom.Simulation(system, mode), 1.0)


def test_options_survive():
    mode = TimeStepping(step=2e-3, control=carom.StepControl(tolerance=1e-4), iteration="anderson", threads=2)
    read = scene.from_text(scene.to_text(everything(), mode, 1.5))
    assert repr(read.mode) == repr(mode) and read.until == 1.5
    with pytest.raises(ModelError, match="it has no mode"):
        scene.from_text(scene.to_text(everything())).simulation()


def test_functions_of_the_user_are_refused_by_name(tmp_path):
    system = System()
    body = system.add(Particle(mass=1.0))
    system.add(planar.AppliedForce(on=body, force=lambda time: (0.0, 0.0)), name="push")
    with pytest.raises(
        SceneError, match="elements\\[0\\].force: element AppliedForce 'push': is a function of the user"
    ):
        carom.save_scene(system, tmp_path / "scene.json")
    assert not (tmp_path / "scene.json").exists()

    class Magnet(planar.ForceElement):
        def bodies(self):
            return [body]

    system = System()
    body = system.add(Particle(mass=1.0))
    system.add(Magnet())
    with pytest.raises(SceneError, match="element Magnet #0 is written in Python"):
        scene.to_text(system)


def test_infinite_numbers_are_refused_by_name():
    system = System()
    system.add(planar.AppliedForce(on=system.add(Particle(mass=1.0)), force=(0.0, 0.0)))
    with pytest.raises(SceneError, match="simulation.options.interval: is inf"):
        scene.to_text(system, carom.EventDriven(interval=float("inf")))


BALL = """{
  "carom": 1,
  "bodies": [
    {"type": "Particle", "name": "ball", "mass": 1.0,
     "position": [0.0, 1.0]},
    {"type": "RigidBody", "name": "rod", "position": [3, 2], "mass": {"mass": 1, "inertia": 0.5}}
  ],
  "shapes": [{"type": "Disc", "body": "rod", "radius": 0.5}],
  "obstacles": [
    {"type": "HalfPlane", "normal": [0, 1], "surface": {"friction": 0.5, "normal_restitution": 0.5}}
  ],
  "simulation": {"mode": "event-driven", "options": {"interval": 0.1}}
}
"""

ERRORS = [
    ('"mass": 1.0', '"mass": "1"', '4: bodies[0].mass: must be a number, not "1"'),
    ('"mass": 1.0', '"mass": -1.0', "4: bodies[0].mass: particle 'ball': mass is -1 kg"),
    (
        '"mass": 1.0',
        '"mass": NaN',
        "4: bodies[0].mass: must be a value of JSON (numbers are finite), not NaN",
    ),
    ('"mass": 1.0', '"mass": -Infinity', "4: bodies[0].mass: must be a value of JSON"),
    ('"mass": 1.0', '"mass": 1e400', "4: bodies[0].mass: must be a number in the range of double"),
    ('"mass": 1.0', '"mass": ' + "9" * 400, "4: bodies[0].mass: must be a number in the range of double"),
    ('"mass": 1.0', '"mass": true', "4: bodies[0].mass: must be a number, not true"),
    (
        '"mass": 1.0',
        '"masse": 1.0',
        '4: bodies[0].masse: Particle has no such field; the nearest known: "mass"',
    ),
    ('"mass": 1.0,', "", "4: bodies[0]: Particle needs the field 'mass'"),
    ('"position": [0.0, 1.0]', '"position": [0.0]', "5: bodies[0].position: must have 2 items, not 1"),
    (
        '"position": [0.0, 1.0]',
        '"position": [0.0, null]',
        "5: bodies[0].position[1]: must be a number, not null",
    ),
    ('"position": [0.0, 1.0]', '"mass": 2', "5: bodies[0].mass: is given twice; first in line 4"),
    ('"inertia": 0.5', '"inertia": -0.5', "6: bodies[1].mass.inertia: rigid body 'rod'"),
    ('"Particle"', '"particle"', '4: bodies[0].type: is "particle"; the nearest known: "Particle"'),
    ('"name": "rod"', '"name": "ball"', "6: bodies[1]: rigid body 'ball': name is taken"),
    (
        '"body": "rod"',
        '"body": "rood"',
        '8: shapes[0].body: there is no body of the name "rood"; the nearest known: "rod"',
    ),
    ('"body": "rod"', '"body": 2', "8: shapes[0].body: there is no body 2; before it there are 2"),
    ('"body": "rod"', '"body": 1.0', "8: shapes[0].body: must be the name of a body, not 1.0"),
    ('"radius": 0.5', '"radius": 0', "8: shapes[0].radius: disc"),
    ('"friction": 0.5', '"friction": -0.5', "10: obstacles[0].surface.friction: half-plane"),
    ('"event-driven"', '"events"', '12: simulation.mode: is "events"; allowed: time-stepping, event-driven'),
    ('"interval": 0.1', '"step": 0.1', "12: simulation.options.step: EventDriven has no such field"),
    (
        '"interval": 0.1',
        '"interval": 0',
        "12: simulation.options.interval: event-driven mode: interval is 0; allowed",
    ),
    (
        '"event-driven", "options": {"interval": 0.1}',
        '"time-stepping", "options": {"contact_budget": {"sweeps": -1}}',
        "12: simulation.options.contact_budget.sweeps: time stepping: contact_budget.sweeps is -1; allowed",
    ),
    ('"interval": 0.1', '"event_limit": []', "12: simulation.options.event_limit: must be a number"),
    ('"carom": 1', '"carom": 2', "2: carom: the file is of version 2; this carom reads versions up to 1"),
    ('"carom": 1', '"carom": 1.0', "2: carom: must be the version"),
    (
        '"event-driven"',
        '"event_driven"',
        '12: simulation.mode: is "event_driven"; the nearest known: "event-driven"',
    ),
    ('"event-driven"', "1", "12: simulation.mode: is 1; allowed: time-stepping"),
    ('"carom": 1,', "", "1: a scene needs the field 'carom'"),
    ('"shapes"', '"shape"', '8: shape: a scene has no such field; the nearest known: "shapes"'),
    ('"radius": 0.5}]', '"radius": 0.5}', "9: shapes: needs ',' or ']' after item 1, not \":\""),
    ('"rod", "pos', '"rod" "pos', "6: bodies[1].name: needs ',' or '}' after it"),
    ('"Disc"', '"Disc', "8: shapes[0].type: needs ',' or '}' after it"),
    ('"Disc"', '"Di\nsc"', "8: shapes[0].type: text in quotes: invalid control character"),
    ('"ball"', '"\\ud800"', "4: bodies[0].name: must be a text without half characters"),
    ("}\n", "} x\n", "6: bodies: needs ',' or ']' after item 1"),
    (
        '"mass": 1.0',
        '"mass": ' + "[" * 5000 + "]" * 5000,
        "4: bodies[0].mass[0]: is nested more than 32 deep",
    ),
]


@pytest.mark.parametrize(("old", "new", "message"), ERRORS, ids=[error[2][:40] for error in ERRORS])
def test_errors_have_line_and_field(tmp_path, old, new, message):
    assert old in BALL
    file = tmp_path / "scene.json"
    file.write_text(BALL.replace(old, new, 1))
    with pytest.raises(SceneError) as caught:
        carom.load_scene(file)
    assert str(caught.value).startswith(f"{file}:{message}")


def test_the_scene_of_the_errors_is_right():
    assert ends(scene.from_text(BALL).simulation(), 0.5)[0][1] >= 0.0


def test_files(tmp_path):
    with pytest.raises(carom.FileError, match="cannot be read"):
        carom.load_scene(tmp_path / "none.json")
    with pytest.raises(carom.FileError, match="cannot be written"):
        carom.save_scene(System(), tmp_path / "none" / "scene.json")
    (tmp_path / "latin.json").write_bytes(b'{\n"carom": 1, "space": "pl\xe4nar"}')
    with pytest.raises(SceneError, match="latin.json:2: is not in UTF-8"):
        carom.load_scene(tmp_path / "latin.json")
    (tmp_path / "mark.json").write_bytes(b'\xef\xbb\xbf{"carom": 1}')
    assert carom.load_scene(tmp_path / "mark.json").system.bodies() == []


def test_what_is_no_scene_or_path_is_named(tmp_path):
    system = carom.System()
    system.add(planar.Particle(mass=1.0))
    simulation = carom.Simulation(system, carom.TimeStepping())
    with pytest.raises(TypeError, match="a System or a Scene, not a Simulation"):
        carom.save_scene(simulation, tmp_path / "scene.json")
    with pytest.raises(TypeError, match="from_dict"):
        carom.load_scene({})


def test_errors_have_data():
    with pytest.raises(SceneError) as caught:
        scene.from_text(BALL.replace('"inertia": 0.5', '"inertia": "x"'), "scene.json")
    error = caught.value
    assert isinstance(error, ModelError)
    assert (error.file, error.line, error.field) == ("scene.json", 6, "bodies[1].mass.inertia")
    assert error.path == ("bodies", 1, "mass", "inertia")


def test_keys_of_parts_are_no_fields():
    for record in carom.described():
        if record["role"]:
            assert not {"type", "name", "surface"} & {field["name"] for field in record["fields"]}
