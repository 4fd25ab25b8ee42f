"""Recordings as files of VTK, read by an XML parser, and by VTK where it is installed."""

import base64
import xml.etree.ElementTree as ElementTree

import numpy
import pytest

import carom
from carom import FileError, ModelError, Recorder, Simulation, System, TimeStepping
from carom.command import main
from carom.vtk import widened
from conftest import PYTHON

from models import everything, pile

TYPES = {"Float64": "<f8", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1"}


def recorded(system, until, interval):
    simulation = Simulation(system, TimeStepping(step=1e-3))
    with Recorder(simulation, interval=interval) as recorder:
        simulation.run_until(until)
    return recorder.recording()


@pytest.fixture(scope="module")
def all_parts(tmp_path_factory):
    """A recording of everything, and its series."""
    recording = recorded(everything(), 1.0, 0.1)
    path = tmp_path_factory.mktemp("vtk") / "run.pvd"
    recording.to_vtk(path)
    return recording, path


@pytest.fixture(scope="module")
def discs(tmp_path_factory):
    """A recording of discs with many contacts, and its series."""
    recording = recorded(pile(8, 5), 1.0, 0.1)
    path = tmp_path_factory.mktemp("vtk") / "pile.pvd"
    recording.to_vtk(path, every=4)
    return recording, path


def arrays(file):
    """Arrays of a file, by element and name: {"PointData/impulse": ...}."""
    piece = ElementTree.parse(file).getroot().find("PolyData/Piece")
    found = {}
    for group in piece:
        for array in group:
            raw = base64.b64decode(array.text)
            assert int.from_bytes(raw[:8], "little") == len(raw) - 8
            values = numpy.frombuffer(raw[8:], TYPES[array.get("type")])
            width = int(array.get("NumberOfComponents", 1))
            found[f"{group.tag}/{array.get('Name')}"] = values.reshape(-1, width) if width > 1 else values
    assert len(found["Points/points"]) == int(piece.get("NumberOfPoints"))
    for kind in ("Verts", "Lines", "Polys"):
        assert len(found[f"{kind}/offsets"]) == int(piece.get(f"NumberOf{kind}"))
        ends = found[f"{kind}/offsets"]
        assert (ends[-1] if len(ends) else 0) == len(found[f"{kind}/connectivity"])
    return found


def series(path):
    """Rows of a series: time, part, file."""
    rows = ElementTree.parse(path).getroot().findall("Collection/DataSet")
    return [(float(row.get("timestep")), row.get("name"), path.parent / row.get("file")) for row in rows]


def test_a_series_has_every_sample_and_part(all_parts, discs):
    recording, path = all_parts
    rows = series(path)
    assert [time for time, part, _ in rows if part == "bodies"] == list(recording.times)
    assert {part for _, part, _ in rows} == {"bodies", "contacts", "links", "ground"}
    files = [file for _, _, file in rows]
    assert all(file.is_file() for file in files) and len(set(files)) == len(files)  # the shaker moves
    recording, path = discs
    rows = series(path)
    assert [time for time, part, _ in rows if part == "bodies"] == list(recording.times[[0, 4, 8, 10]])
    assert len({file for _, part, file in rows if part == "ground"}) == 1  # nothing moves there


def polygons(data):
    """Points of each polygon."""
    ends = data["Polys/offsets"]
    return [data["Points/points"][part] for part in numpy.split(data["Polys/connectivity"], ends[:-1])]


def test_outlines_are_around_the_bodies(all_parts):
    recording, path = all_parts
    names = recording.body_names()
    for sample, file in enumerate(file for _, part, file in series(path) if part == "bodies"):
        data = arrays(file)
        assert (data["Points/points"][:, 2] == 0.0).all()
        bodies = data["CellData/body"]
        assert set(bodies) == set(range(len(names)))
        outlines = dict(zip(bodies[len(data["Verts/offsets"]) :], polygons(data)))
        points = data["Points/points"][data["Verts/connectivity"]]
        numpy.testing.assert_array_equal(
            points[:, :2], recording.positions[sample, bodies[: len(points)], :2]
        )
        ball, brick, bar = (names.index(f"rigid body '{name}'") for name in ("ball", "brick", "bar"))
        x, y, angle = recording.positions[sample, ball]
        # Of the size of rounding at a metre.
        numpy.testing.assert_allclose(
            numpy.hypot(*(outlines[ball][:, :2] - (x, y)).T), 0.12, rtol=0, atol=1e-15
        )
        x, y, angle = recording.positions[sample, brick]
        c, s = numpy.cos(angle), numpy.sin(angle)
        corners = [(-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1)]
        expected = [(x + c * u - s * v, y + s * u + c * v) for u, v in corners]
        numpy.testing.assert_allclose(outlines[brick][:, :2], expected, rtol=0, atol=1e-15)
        x, y, angle = recording.positions[sample, bar]
        along = (outlines[bar][:, :2] - (x, y)) @ (numpy.cos(angle), numpy.sin(angle))
        assert numpy.ptp(along) == pytest.approx(0.5 + 2.0 * 0.06, rel=1e-12)


def test_points_have_the_velocity_that_moves_them(all_parts):
    recording, path = all_parts
    _, file = [(time, file) for time, part, file in series(path) if part == "bodies"][7]
    data = arrays(file)
    bodies, velocities = data["CellData/body"], recording.velocities[7]
    numpy.testing.assert_array_equal(data["CellData/velocity"][:, :2], velocities[bodies, :2])
    numpy.testing.assert_array_equal(data["CellData/spin"], velocities[bodies, 2])
    counted = len(data["Verts/offsets"])
    for body, connected in zip(
        bodies[counted:], numpy.split(data["Polys/connectivity"], data["Polys/offsets"][:-1])
    ):
        points, moving = data["Points/points"][connected], data["PointData/point_velocity"][connected]
        arm = points[:, :2] - recording.positions[7, body, :2]
        vx, vy, spin = velocities[body]
        # Of the size of rounding at speeds of 10 m/s.
        numpy.testing.assert_allclose(moving[:, 0], vx - spin * arm[:, 1], rtol=0, atol=1e-14)
        numpy.testing.assert_allclose(moving[:, 1], vy + spin * arm[:, 0], rtol=0, atol=1e-14)


def test_contacts_have_their_impulses(discs):
    recording, path = discs
    file = [file for _, part, file in series(path) if part == "contacts"][-1]
    data, rows = arrays(file), recording.contacts_at(-1)
    assert len(rows) > 20
    numpy.testing.assert_array_equal(data["Points/points"][:, :2], rows["point"])
    normal, impulse = data["PointData/normal"], data["PointData/impulse"]
    numpy.testing.assert_array_equal(normal[:, :2], rows["normal"])
    # Resolved again along normal and tangent, which is the normal turned clockwise; rounding of 0.1 N s.
    along = (impulse * normal).sum(axis=1), impulse[:, 0] * normal[:, 1] - impulse[:, 1] * normal[:, 0]
    numpy.testing.assert_allclose(numpy.stack(along, axis=1), rows["impulse"], rtol=0, atol=1e-16)
    for name in ("gap", "mode", "impact", "name"):
        numpy.testing.assert_array_equal(data[f"PointData/{name}"], rows[name])
    assert (data["PointData/normal_impulse"] == rows["impulse"][:, 0]).all()


def test_ground_moves_and_links_join_their_ends(all_parts):
    recording, path = all_parts
    rows = series(path)
    first, last = [arrays(file)["Points/points"] for _, part, file in rows if part == "ground"][0:9:8]
    moved = numpy.hypot(*(last - first)[:, :2].T) > 1e-9
    assert 0 < numpy.count_nonzero(moved) < len(moved)
    shaker = (numpy.abs(first[:, 0] - 1.2) < 0.301) & (numpy.abs(first[:, 1] + 0.55) < 0.051)
    assert numpy.count_nonzero(shaker) == 4
    shift = recording.ground[8, 0, 0] - recording.ground[0, 0, 0]
    assert abs(shift) > 0.01
    numpy.testing.assert_allclose((last - first)[shaker, 0], shift, rtol=0, atol=1e-15)
    (links,) = [arrays(file) for time, part, file in rows if part == "links" and time == recording.times[5]]
    bob = recording.body_names().index("particle 'bob'")
    ends = links["Points/points"][links["Lines/connectivity"][:2], :2]
    numpy.testing.assert_array_equal(ends, [(0.5, 1.8), recording.positions[5, bob, :2]])


def test_vtk_reads_the_files(all_parts, discs):
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import vtk_to_numpy

    for recording, path in (all_parts, discs):
        for time, part, file in series(path):
            reader = vtk.vtkXMLPolyDataReader()
            reader.SetFileName(str(file))
            reader.Update()
            data, expected = reader.GetOutput(), arrays(file)
            assert reader.GetErrorCode() == 0
            assert data.GetNumberOfPolys() == len(expected["Polys/offsets"])
            assert data.GetNumberOfVerts() == len(expected["Verts/offsets"])
            assert data.GetNumberOfLines() == len(expected["Lines/offsets"])
            for key, values in expected.items():
                group, name = key.split("/")
                if group in ("PointData", "CellData") and len(values):
                    found = getattr(data, f"Get{group}")().GetArray(name)
                    numpy.testing.assert_array_equal(vtk_to_numpy(found), values, key)
            if part != "ground":
                assert data.GetFieldData().GetArray("TimeValue").GetValue(0) == time
            if len(expected["Points/points"]):
                numpy.testing.assert_array_equal(
                    vtk_to_numpy(data.GetPoints().GetData()), expected["Points/points"]
                )


@pytest.mark.parametrize(
    ("points", "area"),
    [
        ([(1.0, 2.0)], 0.25 * numpy.pi),
        ([(0.0, 0.0), (3.0, 0.0)], 3.0 + 0.25 * numpy.pi),
        ([(0.0, 0.0), (0.0, 2.0), (2.0, 2.0), (2.0, 0.0)], 4.0 + 8.0 * 0.5 + 0.25 * numpy.pi),
    ],
)
def test_outlines_are_widened(points, area):
    x, y = widened(numpy.array(points), 0.5).T
    found = 0.5 * float(x @ numpy.roll(y, -1) - y @ numpy.roll(x, -1))
    # A regular polygon of 32 corners has 0.6 % less than its circle.
    assert area - 0.007 * 0.25 * numpy.pi < found < area


def test_what_cannot_be_written_is_refused(all_parts, tmp_path):
    recording, _ = all_parts
    with pytest.raises(ModelError, match="path is 'run.vtu'; allowed: a name that ends in .pvd"):
        recording.to_vtk("run.vtu")
    with pytest.raises(ModelError, match="every is 0; allowed: at least 1"):
        recording.to_vtk(tmp_path / "run.pvd", every=0)
    (tmp_path / "none").write_text("no folder")
    with pytest.raises(FileError, match="none/run.pvd' cannot be written"):
        recording.to_vtk(tmp_path / "none" / "run.pvd")


def test_a_run_in_space_is_written(tmp_path):
    """A particle falls on a slope and slides, another hangs on a spring."""
    system = System()
    system.add(carom.spatial.Gravity((0.0, 0.0, -9.81)))
    normal = numpy.array([1.0, 2.0, 2.0]) / 3.0
    slope = carom.Surface(friction=0.3, normal_restitution=0.0, tangential_restitution=0.0)
    system.add(carom.spatial.HalfSpace(normal=normal), slope, name="slope")
    position, velocity = (0.0, 0.0, 0.1), (1.0, 0.5, 0.0)
    stone = system.add(carom.spatial.Particle(mass=2.0, position=position, velocity=velocity), name="stone")
    bob = system.add(carom.spatial.Particle(mass=1.0, position=(3.0, 3.0, 3.0), contact=False))
    ends = {"from_": (carom.ground, (3.0, 3.0, 5.0)), "to": bob}
    system.add(carom.spatial.SpringDamper(**ends, stiffness=50.0, free_length=1.0))
    recording = recorded(system, 0.5, 0.1)
    path = tmp_path / "run.pvd"
    recording.to_vtk(path)
    rows = series(path)
    assert {part for _, part, _ in rows} == {"bodies", "contacts", "links", "ground"}
    by_part = {part: [arrays(file) for _, name, file in rows if name == part] for _, part, _ in rows}
    for sample, data in enumerate(by_part["bodies"]):
        numpy.testing.assert_array_equal(data["Points/points"], recording.positions[sample])
        numpy.testing.assert_array_equal(data["CellData/velocity"], recording.velocities[sample])
    lines = by_part["links"][-1]
    numpy.testing.assert_array_equal(lines["Points/points"], [(3.0, 3.0, 5.0), recording.positions[-1, 1]])
    square = by_part["ground"][0]["Points/points"]
    assert len(square) == 4
    numpy.testing.assert_allclose(square @ normal, 0.0, rtol=0, atol=1e-13)  # rounding at 100 m
    contacts = by_part["contacts"][-1]
    impulse, slid = contacts["PointData/impulse"], recording.velocities[-1, 0]
    assert contacts["PointData/mode"] == [carom.ContactMode.slip.value]
    # Pressed by the weight, and friction against the velocity; the mean of a step of 1 ms.
    push = 2.0 * 9.81 * normal[2] * 1e-3
    expected = push * (normal - 0.3 * slid / numpy.linalg.norm(slid))
    numpy.testing.assert_allclose(impulse, [expected], rtol=0, atol=2e-3 * push)
    numpy.testing.assert_allclose(contacts["PointData/normal_impulse"], [push], rtol=1e-9)
    assert contacts["PointData/tangential_impulse"] == pytest.approx([0.3 * push], rel=1e-9)


def test_the_command_writes_a_series(tmp_path, capsys):
    path = tmp_path / "ball.pvd"
    scene = str(PYTHON / "scenes" / "bouncing_ball.json")
    assert main(["run", scene, "--until", "0.5", "--interval", "0.1", "--vtk", str(path)]) == 0
    assert f"vtk: {path}" in capsys.readouterr().out
    assert [time for time, part, _ in series(path) if part == "bodies"] == pytest.approx(
        [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
    )
