"""Robot descriptions as planar scenes."""

import math

import pytest

import carom
from carom import EventDriven, SceneError, Simulation, Surface, System, ground, planar
from carom.command import main
from carom.scene import load_urdf

# An arm of two rods in the plane of x and z. Its second link is described in a frame that is turned by a
# quarter about y, and its first joint turns about -y.
ARM = """<robot name="arm">
  <link name="world">
    <collision><origin xyz="0 0 -3"/><geometry><box size="10 2 1"/></geometry></collision>
  </link>
  <link name="upper">
    <inertial><origin xyz="0.5 0 0"/><mass value="2"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.17" iyz="0" izz="0.17"/></inertial>
    <collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.2"/></geometry></collision>
  </link>
  <link name="fore">
    <inertial><origin xyz="0 0 0.4"/><mass value="1"/>
      <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.001"/></inertial>
    <collision><origin xyz="0 0 0.8"/><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute"><parent link="world"/><child link="upper"/><origin xyz="0 0 1"/>
    <axis xyz="0 -1 0"/><limit lower="-2" upper="0.5" effort="1" velocity="1"/>
    <dynamics damping="0.3"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/>
    <origin xyz="1 0 0" rpy="0 1.5707963267948966 0"/><axis xyz="0 2 0"/><dynamics friction="0.2"/></joint>
</robot>
"""


def by_hand():
    """The same arm, written down in the plane."""
    system = System()
    system.add(planar.Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.3, normal_restitution=0.2))
    system.add(planar.Block(vertices=[(-5.0, -3.5), (5.0, -3.5), (5.0, -2.5), (-5.0, -2.5)]))
    upper = system.add(
        planar.RigidBody(mass=planar.MassProperties(mass=2.0, inertia=0.17), position=(0.5, 1.0)),
        name="upper",
    )
    system.add(planar.Polygon(body=upper, vertices=[(-0.5, -0.1), (0.5, -0.1), (0.5, 0.1), (-0.5, 0.1)]))
    shoulder = system.add(
        planar.Revolute(from_=(ground, (0.0, 1.0)), to=(upper, (-0.5, 0.0)), zero_angle=0.0)
    )
    system.add(planar.Stop(joint=shoulder, lower=-2.0, upper=0.5))
    system.add(planar.TorsionalSpring(from_=ground, to=upper, damping=0.3))
    fore = system.add(
        planar.RigidBody(mass=planar.MassProperties(mass=1.0, inertia=0.05), position=(1.4, 1.0)), name="fore"
    )
    system.add(planar.Disc(body=fore, centre=(0.4, 0.0), radius=0.1))
    elbow = system.add(planar.Revolute(from_=(upper, (0.5, 0.0)), to=(fore, (-0.4, 0.0)), zero_angle=0.0))
    system.add(planar.JointFriction(joint=elbow, bound=0.2))
    return system


@pytest.fixture
def robot(tmp_path):
    def write(text=ARM):
        file = tmp_path / "robot.urdf"
        file.write_text(text)
        return file

    return write


def test_an_arm_moves_as_the_one_written_by_hand(robot):
    law = Surface(friction=0.3, normal_restitution=0.2)
    read = load_urdf(robot(), law=law).system
    ends = []
    for system in (read, by_hand()):
        simulation = Simulation(system, EventDriven())
        simulation.run_until(1.0)
        ends.append([*simulation.state().q, simulation.energy().total()])
    assert abs(ends[0][2]) > 1.0  # it has fallen
    # A turn by a quarter is exact to 1e-16; through six events at the stop that grows to 3e-14.
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)


def test_signs_of_limits_follow_the_axis(robot):
    # In this plane the normal is -y.
    for axis, lower, upper in (("0 -1 0", -2.0, 0.5), ("0 1 0", -0.5, 2.0)):
        (stop,) = [
            part.part
            for part in load_urdf(robot(ARM.replace("0 -1 0", axis))).system.parts()
            if isinstance(part.part, planar.Stop)
        ]
        assert (stop.lower, stop.upper) == (lower, upper)


def test_slides_and_welds(robot):
    text = ARM.replace('name="elbow" type="continuous"', 'name="elbow" type="fixed"')
    text = text.replace('type="revolute"', 'type="prismatic"').replace("0 -1 0", "1 0 1")
    law = Surface(friction=0.3, normal_restitution=0.2)
    system = load_urdf(robot(text), gravity=0.0, plane="xz", law=law).system
    kinds = [type(part.part).__name__ for part in system.parts() if part.role == "joint"]
    assert kinds == ["Prismatic", "Stop", "Weld"]
    assert Simulation(system, carom.TimeStepping()).mobility().degrees_of_freedom == 1
    (axis,) = [part.part.axis for part in system.parts() if part.name == "shoulder"]
    assert list(axis) == pytest.approx([math.sqrt(0.5), math.sqrt(0.5)], rel=1e-15)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "0 -1 0",
            "1 0 0",
            "joint 'shoulder': revolute about or along \\[1.0, 0.0, 0.0\\] leaves the plane xz",
        ),
        ("0 -1 0", "0 0 0", "joint 'shoulder': axis is zero"),
        ("0 -1 0", "0 -1", "joint 'shoulder': axis: xyz must be 3 finite numbers, not '0 -1'"),
        ('type="revolute"', 'type="ball"', "joint 'shoulder': type is 'ball'; allowed: fixed"),
        ('<parent link="upper"/>', '<parent link="uper"/>', "joint 'elbow': parent is 'uper'"),
        ('<parent link="world"/>', '<parent link="fore"/>', "link 'upper' hangs on joints in a circle"),
        ('<child link="fore"/>', '<child link="upper"/>', "joints must make a tree of all links"),
        (
            '<mass value="1"/>',
            '<mass value="nan"/>',
            "link 'fore': mass: value must be 1 finite number, not 'nan'",
        ),
        ('<mass value="1"/>', '<mass value="-1"/>', "rigid body 'fore': mass is -1 kg"),
        ('<sphere radius="0.1"/>', '<mesh filename="a.stl"/>', "link 'fore': collision is a <mesh>"),
        ('<origin xyz="0 0 -3"/>', '<origin rpy="0.5 0 0"/>', "the box stands at an angle to the plane xz"),
        ("</robot>", "", ":21: is no XML: no element found"),
        ("robot", "model", "is no robot description: its first element is <model>"),
    ],
)
def test_what_is_not_planar_is_refused_by_name_and_line(robot, old, new, message):
    assert old in ARM
    around = max(0, *(ARM.rfind(tag, 0, ARM.index(old) + 1) for tag in ("<link", "<joint")))
    line = ARM.count("\n", 0, around) + 1
    if "circle" in message:  # where it is seen
        line = ARM.count("\n", 0, ARM.index('<link name="upper"')) + 1
    elif "tree" in message:
        line = 1
    elif old == "</robot>":
        line = ARM.count("\n") + 1
    file = robot(ARM.replace(old, new))
    with pytest.raises(SceneError, match=message) as caught:
        load_urdf(file)
    assert caught.value.file == str(file) and caught.value.line == line


def test_command_makes_a_scene(robot, tmp_path, capsys):
    file = tmp_path / "scene.json"
    assert main(["import", str(robot()), str(file)]) == 0
    assert [part.name for part in carom.load_scene(file).system.parts() if part.role == "body"] == [
        "upper",
        "fore",
    ]
    with pytest.raises(carom.FileError):
        load_urdf(tmp_path / "none.urdf")
    with pytest.raises(carom.ModelError, match="plane is 'zx'; allowed: xy, xz, yz"):
        load_urdf(robot(), plane="zx")


def test_what_is_left_out_is_told(tmp_path, capsys):
    file = tmp_path / "arm.urdf"
    visual = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    text = ARM.replace('<link name="upper">', f'<link name="upper">{visual}')
    text = text.replace('<link name="fore">', f'<link name="fore">{visual}')
    text = text.replace("</robot>", '<transmission name="gear"/><gazebo/><material name="red"/></robot>')
    file.write_text(text)
    scene = load_urdf(file)
    assert scene.left_out == [
        "<transmission>: 'gear'",
        "<gazebo>",
        "<material>: 'red'",
        "<visual> (2): link 'upper', link 'fore'",
        "limit of effort: joint 'shoulder'",
        "limit of velocity: joint 'shoulder'",
    ]
    assert repr(scene.system).startswith("<System 'arm.urdf': 2 bodies")
    assert main(["import", str(file), str(tmp_path / "arm.json")]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said == [f"scene: {tmp_path / 'arm.json'}", *(f"left out: {each}" for each in scene.left_out)]
    file.write_text(ARM.replace(' effort="1" velocity="1"', ""))
    assert load_urdf(file).left_out == []
    assert carom.load_scene(tmp_path / "arm.json").left_out == []
