"""Models in MJCF as planar scenes."""

import math

import numpy
import pytest

import carom
from carom import EventDriven, SceneError, Simulation, Surface, System, TimeStepping, ground, planar
from carom.command import main
from carom.scene import load_mjcf, load_robot

# A cart on a rail with a pendulum of two capsules, a ball that is free in the plane, a floor and a step. The file has
# degrees; its second hinge turns about -y, and the pole hangs in a frame that is turned by half a turn.
CART = """<mujoco model="cart">
  <compiler autolimits="true"/>
  <option timestep="0.002" gravity="0 0 -9.81"><!-- numerics are left out --></option>
  <visual><global azimuth="90"/></visual>
  <default>
    <geom friction="0.4 0.1 0.1" rgba="1 0 0 1"/>
    <default class="pole"><joint damping="0.02"/><geom type="capsule" size="0.05" density="500"/></default>
  </default>
  <worldbody>
    <light pos="0 0 3"/>
    <geom name="floor" type="plane" size="0 0 1" pos="0 0 -1"/>
    <body name="stand" pos="2 0 -0.75"><geom name="step" type="box" size="0.5 1 0.25" friction="0.9"/></body>
    <body name="cart" pos="0 0 0.5">
      <joint name="rail" type="slide" axis="2 0 0" range="-1.5 1.5" damping="0.5" stiffness="3" springref="0.2"/>
      <geom name="cart" type="box" size="0.2 0.1 0.1" mass="2" contype="0" conaffinity="0"/>
      <site name="mount"/>
      <body name="upper" euler="0 180 0" childclass="pole">
        <joint name="swing" axis="0 1 0" range="-170 170"/>
        <geom name="upper" fromto="0 0 0 0 0 0.4"/>
        <body name="lower" pos="0 0 0.4">
          <joint name="knee" axis="0 -1 0" stiffness="0.7" springref="30" frictionloss="0.01"/>
          <geom name="lower" size="0.05 0.15" pos="0.1 0 0.2" zaxis="0.5 0 1"/>
        </body>
      </body>
    </body>
    <body name="ball" pos="0.9 0 0.3">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint axis="0 1 0"/>
      <inertial pos="0 0 0" mass="0.5" diaginertia="0.001 0.002 0.003"/>
      <geom name="ball" size="0.1" condim="1"/>
    </body>
  </worldbody>
  <actuator><motor joint="rail" gear="100"/></actuator>
</mujoco>
"""


def capsule(radius, half, density):
    """Mass and inertia of a capsule about an axis across, of the parts of which books have it."""
    tube, ball = density * 2.0 * math.pi * radius**2 * half, density * 4.0 / 3.0 * math.pi * radius**3
    across = tube * (radius**2 / 4.0 + half**2 / 3.0)
    return tube + ball, across + ball * (0.4 * radius**2 + half**2 + 0.75 * half * radius)


def by_hand():
    """The same model, written down in the plane."""
    system = System()
    system.add(planar.Gravity((0.0, -9.81)))
    usual, rough, smooth = (system.material(name) for name in ("usual", "rough", "smooth"))
    for one, other, friction in (
        (usual, usual, 0.4),
        (usual, rough, 0.9),
        (rough, rough, 0.9),
        (smooth, usual, 0.4),
        (smooth, rough, 0.9),
        (smooth, smooth, 0.0),
    ):
        system.between(one, other, Surface(friction=friction, normal_restitution=0.25))
    system.add(planar.HalfPlane(point=(0.0, -1.0), normal=(0.0, 1.0), material=usual))
    step = [(1.5, -1.0), (2.5, -1.0), (2.5, -0.5), (1.5, -0.5)]
    system.add(planar.Block(vertices=step, material=rough))
    cart = system.add(planar.RigidBody(mass=planar.box(2.0, 0.4, 0.2), position=(0.0, 0.5)), "cart")
    rail = system.add(planar.Prismatic(from_=(ground, (0.0, 0.5)), to=cart, axis=(1.0, 0.0)))
    system.add(planar.Stop(joint=rail, lower=-1.5, upper=1.5))
    system.add(planar.Motor(joint=rail, torque=lambda t, x, v: 3.0 * (0.2 - x) - 0.5 * v))

    mass, inertia = capsule(0.05, 0.2, 500.0)
    part = planar.MassProperties(mass=mass, inertia=inertia)
    upper = system.add(planar.RigidBody(mass=part, position=(0.0, 0.3)), "upper")
    swing = system.add(planar.Revolute(from_=cart, to=(upper, (0.0, 0.2))))
    system.add(planar.Stop(joint=swing, lower=-math.radians(170.0), upper=math.radians(170.0)))
    system.add(planar.TorsionalSpring(from_=cart, to=upper, damping=0.02))
    system.add(planar.Segment(body=upper, from_=(0.0, 0.2), to=(0.0, -0.2), radius=0.05, material=usual))

    mass, inertia = capsule(0.05, 0.15, 500.0)
    part = planar.MassProperties(mass=mass, inertia=inertia)
    lower = system.add(planar.RigidBody(mass=part, position=(-0.1, -0.1)), "lower")
    knee = system.add(planar.Revolute(from_=(upper, (0.0, -0.2)), to=(lower, (0.1, 0.2))))
    # Half a turn about y makes -y the axis: the knee turns counter-clockwise in the plane of x and z.
    system.add(
        planar.TorsionalSpring(
            from_=upper, to=lower, stiffness=0.7, damping=0.02, free_angle=math.radians(30.0)
        )
    )
    system.add(planar.JointFriction(joint=knee, bound=0.01))
    along = 0.15 * numpy.array([-0.5, -1.0]) / math.hypot(0.5, 1.0)
    system.add(planar.Segment(body=lower, from_=-along, to=along, radius=0.05, material=usual))

    round_ = planar.MassProperties(mass=0.5, inertia=0.002)
    ball = system.add(planar.RigidBody(mass=round_, position=(0.9, 0.3)), "ball")
    system.add(planar.Disc(body=ball, radius=0.1, material=smooth))
    return system


@pytest.fixture
def model(tmp_path):
    def write(text=CART):
        file = tmp_path / "model.xml"
        file.write_text(text)
        return file

    return write


def test_a_cart_moves_as_the_one_written_by_hand(model):
    ends = []
    for system in (load_mjcf(model(), restitution=0.25).system, by_hand()):
        simulation = Simulation(system, TimeStepping(step=1e-3))
        simulation.run_until(1.5)
        ends.append([*simulation.state().q, simulation.energy().kinetic()])
        assert simulation.statistics().impacts > 0
    # Half a turn about y is exact to 1e-16, and the motion of the pendulum doubles that ten times or so.
    assert ends[0] == pytest.approx(ends[1], abs=1e-11)


@pytest.mark.parametrize(
    ("geom", "mass", "inertia"),
    [
        ('type="sphere" size="0.2"', 1000.0 * 4.0 / 3.0 * math.pi * 0.008, 0.4 * 0.04),
        ('type="box" size="0.1 0.2 0.3" density="10"', 10.0 * 0.048, (0.01 + 0.09) / 3.0),
        ('type="cylinder" size="0.1 0.4" mass="3"', 3.0, 0.01 / 4.0 + 0.16 / 3.0),
        ('type="cylinder" size="0.1 0.4" mass="3" euler="90 0 0"', 3.0, 0.01 / 2.0),
        ('type="box" size="0.1 0.2 0.3" mass="2" axisangle="1 0 0 90"', 2.0, (0.01 + 0.04) / 3.0),
        ('type="box" size="0.1 0.2 0.3" mass="2" xyaxes="0 0 1 0 1 0"', 2.0, (0.01 + 0.09) / 3.0),
        ('type="box" size="0.1 0.2 0.3" mass="2" quat="1 1 0 0"', 2.0, (0.01 + 0.04) / 3.0),
    ],
)
def test_masses_are_those_of_the_solids(model, geom, mass, inertia):
    system = load_mjcf(
        model(f"<mujoco><worldbody><body><joint axis='0 1 0'/><geom {geom}/></body></worldbody></mujoco>")
    ).system
    (body,) = [part.part for part in system.parts() if part.role == "body"]
    assert body.mass.mass == pytest.approx(mass, rel=1e-14)
    assert body.mass.inertia == pytest.approx(inertia * mass, rel=1e-14)


def test_a_body_of_several_solids_has_the_mass_of_all(model):
    geoms = '<geom size="0.1" mass="1" pos="1 0 0"/><geom size="0.1" mass="3" pos="0 0 1"/>'
    text = f"<mujoco><worldbody><body><joint axis='0 1 0'/>{geoms}</body></worldbody></mujoco>"
    (body,) = [part.part for part in load_mjcf(model(text)).system.parts() if part.role == "body"]
    assert list(body.position) == [0.25, 0.75]
    # 1 kg at 3/4 of sqrt(2) m, 3 kg at 1/4 of it, and 2/5 m r^2 of each.
    assert body.mass.inertia == pytest.approx(2.0 * 9.0 / 16.0 + 3.0 * 2.0 / 16.0 + 4.0 * 0.004, rel=1e-14)


CHAIN = """<mujoco><worldbody><geom type="plane" pos="0 0 -9"/>
  <body name="a"><joint axis="0 1 0"/><geom size="0.1"/>
    <body name="b" pos="1 0 0"><geom size="0.1"/>
      <body name="c" pos="1 0 0"><joint axis="0 1 0"/><geom size="0.1"/>
        <body name="d" pos="1 0 0"><joint axis="0 1 0"/><geom size="0.1" contype="0" conaffinity="2"/></body>
      </body>
    </body>
  </body>
</worldbody>
<equality><connect body1="d" body2="a" anchor="0 0 1"/></equality>
<contact><exclude body1="b" body2="d"/></contact></mujoco>
"""


def test_who_touches_whom(model):
    system = load_mjcf(model(CHAIN)).system
    a, b, c, d = (system.body(name) for name in "abcd")
    # A weld makes one of a and b, which does not touch its child c; an equality does not keep d from a.
    # None: undecided, which keeps those apart that a joint binds.
    allowed = {"ab": None, "ac": False, "bc": None, "bd": False, "cd": None, "ad": True}
    bodies = {"a": a, "b": b, "c": c, "d": d}
    for (one, other), may in allowed.items():
        assert system.is_contact_allowed(bodies[one], bodies[other]) == may, (one, other)
    kinds = [type(part.part).__name__ for part in system.parts() if part.role == "joint"]
    assert kinds == ["Revolute", "Weld", "Revolute", "Revolute", "Revolute"]
    filters = [part.part.filter for part in system.parts() if part.role in ("shape", "obstacle")]
    # contype 1 meets conaffinity 2 nowhere: the last touches none but what has contype 2.
    assert all((filters[-1].groups & each.touches) == 0 for each in filters)
    assert all((filters[0].groups & each.touches) != 0 for each in filters[:-1])


REFUSED = [
    ('axis="0 1 0" range', 'axis="1 0 0" range', "joint 'swing': a hinge along [-1.0, 0.0"),
    ('type="slide" axis="2 0 0"', 'type="ball"', "joint 'rail': type is 'ball'; allowed: hinge, slide"),
    ('type="slide" axis="2 0 0"', 'type="slide" axis="0 0 0"', "joint 'rail': axis is zero"),
    (' axis="0 1 0" range', ' armature="0.1" range', "joint 'swing': armature is '0.1'; a planar scene"),
    ('axis="0 1 0" range="', 'axis="0 1 0" solreflimit="1 1" range="', "solreflimit has no counterpart"),
    ('<joint type="slide" axis="1 0 0"/>', "", "is the second joint of a body"),
    ('slide" axis="1 0 0"/>', 'slide" axis="1 0 0" damping="1"/>', "damping of a body that is free"),
    ('axis="1 0 0"/><joint type', 'axis="0 0 2"/><joint type', "one of two slides along one line"),
    ('<inertial pos="0 0 0"', "<inertial", "<inertial>: pos must be 3 finite numbers, not None"),
    ('mass="0.5"', 'mass="-0.5"', "rigid body 'ball': mass is -0.5 kg"),
    ('size="0.1" condim="1"', 'type="mesh" size="0.1"', "geom 'ball': type is 'mesh'; allowed: sphere,"),
    ('condim="1"', 'condim="6"', "geom 'ball': condim is '6'"),
    ('condim="1"', 'pos="0 0.2 0"', "geom 'ball' stands beside the plane xz"),
    ('condim="1"', 'solref="0.01 1"', "geom 'ball': solref has no counterpart in a planar scene"),
    ('size="0.1" condim="1"', 'size="0"', "geom 'ball': size is [0.0]; allowed: more than 0"),
    ('zaxis="0.5 0 1"', 'zaxis="0.5 1 1"', "geom 'lower': the capsule stands at an angle to the plane"),
    ('zaxis="0.5 0 1"', 'zaxis="0 0 0"', "geom 'lower': zaxis is zero; allowed: a direction"),
    ('zaxis="0.5 0 1"', 'zaxis="1 0 0" quat="1 0 0 0"', "geom 'lower' has quat and zaxis; allowed: one"),
    ('pos="0 0 -1"', 'euler="90 45 0"', "geom 'floor': its normal leaves the plane xz"),
    ('size="0 0 1" pos', 'class="mine" size="0 0 1" pos', "geom 'floor': class is 'mine'"),
    (
        'gravity="0 0 -9.81"',
        'gravity="0 1 0"',
        "gravity is [0.0, 1.0, 0.0], which leaves the plane",
    ),
    (
        'gravity="0 0 -9.81"',
        'density="1.2"',
        "<option>: density is '1.2'; a planar scene can only have '0'",
    ),
    ("<!-- numerics are left out -->", "<flag contact='disable'/>", "<flag>: has no counterpart"),
    ('<compiler autolimits="true"/>', '<compiler coordinate="global"/>', "coordinate is 'global'"),
    ("<site ", "<freejoint/><site ", "<freejoint>: has no counterpart in a planar scene"),
    ('<light pos="0 0 3"/>', "<joint/>", "<joint>: is of the world; allowed: of a body"),
    ('<motor joint="rail" gear="100"/>', '<position joint="rail"/>', "<position>: has no counterpart"),
    ("<visual>", "<tendon/><visual>", "<tendon>: has no counterpart in a planar scene"),
    ('name="lower" pos="0 0 0.4"', 'name="upper"', "body 'upper': there is a body of this name already"),
    ('<default class="pole">', "<default>", "<default>: has no class; allowed: a name"),
    ('damping="0.02"', 'dampin="0.02"', "<joint>: dampin has no counterpart"),
    ("</mujoco>", "", "is no XML: no element found"),
]


@pytest.mark.parametrize(("old", "new", "message"), REFUSED)
def test_what_has_no_counterpart_is_refused_with_its_line(model, old, new, message):
    assert CART.count(old) == 1
    line = CART[: CART.index(old)].count("\n") + (2 if old == "</mujoco>" else 1)  # there the end of the file
    file = model(CART.replace(old, new))
    with pytest.raises(SceneError) as caught:
        load_mjcf(file)
    assert message in caught.value.message
    assert caught.value.line == line and str(caught.value).startswith(f"{file}:{line}: ")


def test_equalities_and_exclusions_are_checked(model):
    for old, new, message in (
        ('body2="a"', 'body2="x"', "body2 is 'x'; allowed: the name of a body"),
        ("<connect", '<connect solref="1 1"', "<connect>: solref has no counterpart"),
        (
            '<exclude body1="b"',
            '<exclude body1="world"',
            "one of its bodies is fixed; allowed: two that move",
        ),
        ("<exclude", "<pair", "<pair>: has no counterpart in a planar scene"),
    ):
        with pytest.raises(SceneError, match=message):
            load_mjcf(model(CHAIN.replace(old, new, 1)))


def test_angles_may_be_in_radians_and_limits_off(model):
    text = CART.replace('autolimits="true"', 'autolimits="false" angle="radian"').replace(
        '"0 180 0"', '"0 3 0"'
    )
    parts = [part.part for part in load_mjcf(model(text)).system.parts()]
    assert not any(isinstance(part, planar.Stop) for part in parts)
    (spring,) = [part for part in parts if isinstance(part, planar.TorsionalSpring) and part.stiffness]
    assert spring.free_angle == 30.0


def test_the_command_makes_a_scene_of_either_form(model, tmp_path, capsys):
    file = tmp_path / "scene.json"
    assert main(["import", str(model()), str(file)]) == 0
    assert [part.name for part in carom.load_scene(file).system.parts() if part.role == "body"] == [
        "cart",
        "upper",
        "lower",
        "ball",
    ]
    with pytest.raises(
        SceneError, match="is no robot description \\(URDF or MJCF\\): its first element is <x>"
    ):
        load_robot(model("<x/>"))
    with pytest.raises(SceneError, match="is no model in MJCF: its first element is <robot>"):
        load_mjcf(model("<robot/>"))
    with pytest.raises(carom.ModelError, match="load_mjcf\\(\\): plane is 'zx'; allowed: xy, xz, yz"):
        load_mjcf(model(), plane="zx")
    with pytest.raises(carom.FileError):
        load_mjcf(tmp_path / "none.xml")


def test_gravity_is_that_of_mjcf_unless_given(model):
    (gravity,) = [part.part for part in load_mjcf(model("<mujoco/>"), plane="yz").system.parts()]
    assert list(gravity.acceleration) == [0.0, -9.81]
    with pytest.raises(SceneError, match="gravity is \\[0.0, 0.0, -9.81\\], which leaves the plane xy"):
        load_mjcf(model("<mujoco/>"), plane="xy")
    assert load_mjcf(model("<mujoco><option gravity='0 0 0'/></mujoco>"), plane="xy").system.parts() == []


def test_a_long_chain_is_read(model):
    link = "<body pos='1 0 0'><joint axis='0 1 0'/><geom size='0.1'/>"
    file = model(f"<mujoco><worldbody>{600 * link}{600 * '</body>'}</worldbody></mujoco>")
    bodies = [part.part for part in load_mjcf(file).system.parts() if part.role == "body"]
    # Each is the mean of one solid: m x/m, to rounding.
    assert [body.position[0] for body in bodies] == pytest.approx(range(1, 601), rel=1e-15)


def test_what_is_left_out_is_told(tmp_path, capsys):
    file = tmp_path / "cart.xml"
    file.write_text(CART)
    scene = load_mjcf(file)
    assert set(scene.left_out) == {
        "timestep of <option>",
        "<visual>",
        "rgba of <geom>",
        "<light>",
        "<site>: mount",
        "geom that touches nothing: cart",
        "actuator <motor>",
    }
    assert load_robot(file).left_out == scene.left_out
    assert main(["import", str(file), str(tmp_path / "cart.json")]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[1:] == [f"left out: {each}" for each in scene.left_out]
