"""Typical use, for a checker of types: mypy --strict must accept it, with these types."""

import pathlib
import sys
from typing import TYPE_CHECKING

import numpy
import numpy.typing

import carom
from carom import (
    BodyId,
    ElementId,
    EventDriven,
    JointId,
    ObstacleId,
    ShapeId,
    Simulation,
    Surface,
    System,
    TimeStepping,
)
from carom import command, planar, scene, tables, testing

if TYPE_CHECKING:
    if sys.version_info >= (3, 11):
        from typing import assert_type
    else:
        from typing_extensions import assert_type

    Numbers = numpy.typing.NDArray[numpy.float64]

    def parts(system: System) -> None:
        body = system.add(planar.RigidBody(mass=planar.disc(1.0, 0.1)), "wheel")
        assert_type(body, BodyId)
        assert_type(system.add(planar.Gravity((0.0, -9.81))), ElementId)
        assert_type(system.add(planar.Disc(body=body, radius=0.1), name="disc"), ShapeId)
        joint = system.add(planar.Revolute(from_=carom.ground, to=(body, (0.0, 0.1))))
        assert_type(joint, JointId)
        floor = planar.HalfPlane(normal=numpy.array([0.0, 1.0]))
        assert_type(system.add(floor, Surface(friction=0.5, normal_restitution=0.5), "floor"), ObstacleId)
        assert_type(system.add(floor, "second"), ObstacleId)
        system.add(planar.Disc(body=body, radius=0.1, material="steel"))
        system.between("steel", system.material("ice"), Surface(friction=0.0, normal_restitution=0.0))
        assert_type(system.law("steel", "ice"), Surface | None)
        assert_type(system.title, str)
        system.add(planar.Motor(joint=joint, torque=lambda time, angle, rate: -0.1 * rate))

    def runs(system: System, body: BodyId) -> None:
        simulation = Simulation(system, TimeStepping(step=1e-3, force_rule="energy_momentum"))
        assert_type(simulation.step(), carom.StepReport)
        simulation.switch_to(EventDriven())
        simulation.observe(lambda now: print(now.time()))
        assert_type(simulation.position(body), Numbers)
        assert_type(simulation.positions(), Numbers)
        assert_type(simulation.events()[0].kind, carom.EventKind)
        records: list[carom.EventRecord] = simulation.events()[1:]
        simulation.run_until(1.0, progress=True)
        simulation.run_until(2.0, progress=lambda reached: print(reached, len(records)))
        simulation.set_velocity(body, (1.0, 0.0), spin=2.0)
        simulation.set_position(body, numpy.zeros(2))
        simulation.state().set_velocity(body, [0.0, 1.0])
        with carom.Recorder(simulation, "run.h5", overwrite=True) as recorder:
            assert_type(recorder.recording().body_names(), list[str])
        assert_type(simulation.energy().flow("external"), float)
        assert_type(simulation.state().q, Numbers)
        assert_type(simulation.report().contacts[0].impulse[0], float)
        simulation.save(pathlib.Path("file"))
        print(tables.of_events(simulation))
        testing.ledger_closes(simulation.energy(), 1e-12)

    def scenes(path: pathlib.Path, system: System) -> None:
        read = carom.load_scene(path)
        assert_type(read, carom.Scene)
        assert_type(read.system, System)
        assert_type(read.until, float | None)
        assert_type(read.simulation(), Simulation)
        carom.save_scene(read, path)
        rules = carom.ImpactRules(order="sequential", energy_gain=carom.EnergyGain.refuse)
        carom.save_scene(system, path, mode=TimeStepping(impact_rules=rules), until=1.0)
        assert_type(scene.to_text(read), str)
        assert_type(scene.load_urdf(path, plane="xz"), carom.Scene)
        assert_type(scene.load_urdf(path).left_out, list[str])
        assert_type(command.main(["check", str(path)]), int)
        try:
            scene.from_text("")
        except carom.SceneError as error:
            assert_type(error.line, int | None)
            assert_type(error.field, str)

    def errors(simulation: Simulation) -> None:
        try:
            simulation.step()
        except carom.SolverError as error:
            assert_type(error.time, float)
            assert_type(error.parts, list[str])
            assert_type(error.problem, carom.ContactProblem | None)

    def mistakes(system: System, body: BodyId, joint: JointId) -> None:
        system.add(3)  # type: ignore[call-overload]
        surface = Surface(friction=0.5, normal_restitution=0.0)
        system.add(planar.Particle(mass=1.0), surface)  # type: ignore[call-overload]
        planar.Disc(body=joint, radius=0.1)  # type: ignore[arg-type]
        planar.Particle(masse=1.0)  # type: ignore[call-arg]
        planar.Partcle  # type: ignore[attr-defined]
        carom.Particle  # type: ignore[attr-defined]
        Simulation(system, "event_driven")  # type: ignore[arg-type]
        TimeStepping(impact_rules={"order": "sequential"})
        TimeStepping(impact_order="sequential")  # type: ignore[call-arg]
        carom.save_scene(system, 3)  # type: ignore[arg-type]
