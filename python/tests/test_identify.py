"""Parameters from measurements: closed forms of gradients through impacts, made-up noise, what cannot be told apart."""

import concurrent.futures
import math

import numpy
import pytest
from ensemble_models import be_another_version, thrown_ball

import carom
from carom import AtImpact, EventDriven, Free, Measured, MeasuredImpacts, ModelError, Simulation, Surface, System, TimeStepping
from carom.planar import Disc, Gravity, HalfPlane, Particle, RigidBody, solid_sphere

pytest.importorskip("scipy")

G = 9.81
FLASHES = 0.0309 * numpy.arange(1, 12)  # [s]


def drop(height: float, restitution: float) -> System:
    """A particle above a floor."""
    system = System()
    system.add(Gravity((0.0, -G)))
    surface = Surface(friction=0.0, normal_restitution=restitution)
    system.add(HalfPlane(normal=(0.0, 1.0)), surface, "floor")
    system.add(Particle(mass=1.0, position=(0.0, height)), "ball")
    return system


def tables(e_n: float = 0.91, e_t: float = 0.7, lower: float = 0.5, upper: float = 0.3, speed: float = 5.4) -> System:
    """The ball between two tables of Johansson (1999), with less friction, so that it slides too."""
    system = System()
    system.add(Gravity((0.0, -G)))
    for height, normal, friction, name in ((0.0, 1.0, lower, "lower"), (0.53, -1.0, upper, "upper")):
        surface = Surface(friction=friction, normal_restitution=e_n, tangential_restitution=e_t)
        system.add(HalfPlane(point=(0.0, height), normal=(0.0, normal)), surface, name)
    ball = system.add(
        RigidBody(mass=solid_sphere(0.00859, 0.0131), position=(0.0, 0.25), velocity=(speed, -5.0), spin=-50.0), "ball"
    )
    system.add(Disc(body=ball, radius=0.0131))
    return system


def flashes(model: System, noise: float, seed: int) -> "list[Measured]":
    """Positions at the flashes, with errors of a size [m]."""
    random = numpy.random.default_rng(seed)
    simulation = Simulation(model, EventDriven(relative_tolerance=1e-12))
    values = []
    for time in FLASHES:
        simulation.run_until(time)
        values.append(simulation.positions()[0].copy())
    return [Measured("body.ball.position", FLASHES, numpy.array(values) + noise * random.standard_normal((11, 2)), noise)]


# After one impact of a particle that falls from h: y = e v t - g t^2 / 2 with v = sqrt(2 g h), t since t_1 = v / g.
def test_gradients_through_an_impact_are_those_of_the_closed_form():
    height, e, end = 1.0, 0.8, 0.7
    result = carom.identify(
        drop, {"height": height, "restitution": (e, 0.0, 1.0)}, [Measured("body.ball.position.y", [end], [exact(height, e, end)])]
    )
    assert result.jacobian.shape == (1, 2)
    speed = math.sqrt(2.0 * G * height)
    since = end - speed / G
    by_height = e * G / speed * since - e + G * since / speed
    numpy.testing.assert_allclose(result.jacobian[0], [by_height, speed * since], rtol=1e-6)
    # One number, two parameters.
    assert any("do not say what height, restitution is" in note for note in result.notes)
    assert all(math.isinf(error) for error in result.standard_errors.values())


def exact(height, e, end):
    speed = math.sqrt(2.0 * G * height)
    since = end - speed / G
    return e * speed * since - 0.5 * G * since**2


def test_gradients_through_two_bodies_that_meet():
    """Two particles of masses 1 and m on a line: velocity after is linear in e, and rational in m."""

    result = carom.identify(
        meeting, {"mass": 2.0, "restitution": (0.5, 0.0, 1.0)}, [Measured("body.a.velocity.x", [1.0], [0.0])]
    )
    m, e = (result.values[name] for name in ("mass", "restitution"))
    # v_a = (1 - m e) / (1 + m) for v = 1 against rest
    expected = [(-e * (1.0 + m) - (1.0 - m * e)) / (1.0 + m) ** 2, -m / (1.0 + m)]
    numpy.testing.assert_allclose(result.jacobian[0], expected, rtol=1e-6)


def meeting(mass: float, restitution: float) -> System:
    system = System()
    system.set_default_law(Surface(friction=0.0, normal_restitution=restitution))
    for name, x, v, m in (("a", 0.0, 1.0, 1.0), ("b", 0.5, 0.0, mass)):
        body = system.add(RigidBody(mass={"mass": m, "inertia": 1.0}, position=(x, 0.0), velocity=(v, 0.0)), name)
        system.add(Disc(body=body, radius=0.1))
    return system


def two_balls(left: float = 0.0, right: float = 0.52, fast: float = 1.0, slow: float = 0.0, e: float = 1.0) -> System:
    """Two equal balls on a line, without friction and gravity: places of their centres, speeds to the right, restitution."""
    system = System()
    system.set_default_law(Surface(friction=0.0, normal_restitution=e))
    for name, x, v in (("left", left, fast), ("right", right, slow)):
        body = system.add(RigidBody(mass=solid_sphere(1.0, 0.1), position=(x, 0.0), velocity=(v, 0.0)), name)
        system.add(Disc(body=body, radius=0.1))
    return system


@pytest.mark.parametrize("e", [1.0, 0.5])
def test_gradients_of_the_two_balls_that_meet(e):
    """The scene of "Consufing Gradients on a Simple Scene" (github.com/keenon/nimblephysics, 4 November 2022): where the right
    ball is after T = 1 s. Elastic, it is at v T + x_left + 2 r, so that the gradient by both places and both speeds is
    (1, 0, 1, 0); the report has (0.75, 0.25, 0.91, 0.08). With a restitution e it is at
    x_right + u T + (1 + e) / 2 ((v - u) T - (x_right - x_left - 2 r)).
    """
    end, share = 1.0, 0.5 * (1.0 + e)
    free = {"left": Free(0.0, scale=0.1), "right": 0.52, "fast": 1.0, "slow": Free(0.0, scale=0.1)}
    by_places_and_speeds = [share, 1.0 - share, share * end, (1.0 - share) * end]
    expected = [*by_places_and_speeds, 0.5 * (1.0 * end - 0.32)]
    if e < 1.0:
        free["e"] = Free(e, 0.0, 1.0)
    else:
        del expected[-1]  # no ball has more than e = 1
    at = 0.52 + share * (1.0 * end - 0.32)
    result = carom.identify(two_balls, free, [Measured("body.right.position.x", [end], [at])])
    assert abs(result.residuals[0]) < 1e-9
    numpy.testing.assert_allclose(result.jacobian[0], expected, rtol=1e-6, atol=1e-8)


def weightless_ball(height: float, speed: float, restitution: float = 1.0) -> System:
    """A ball that is thrown down to a floor, without gravity."""
    system = System()
    surface = Surface(friction=0.0, normal_restitution=restitution)
    system.add(HalfPlane(normal=(0.0, 1.0)), surface, "floor")
    ball = system.add(RigidBody(mass=solid_sphere(1.0, 0.25), position=(0.0, height), velocity=(0.0, -speed)), "ball")
    system.add(Disc(body=ball, radius=0.25))
    return system


@pytest.mark.parametrize("e", [1.0, 0.7])
def test_gradients_of_the_ball_without_gravity(e):
    """The scene of "Brax contact modeling results in non-physical behavior (and non-physical gradients)"
    (github.com/google/brax, 8 March 2023): a ball from 2.9 to 3 m, which falls at a steady speed, bounces once and is looked
    at after T = 1 s. The report finds that the last height jumps as the first one changes. It is r + e v T - e (h - r):
    the gradient by the first height is -e, by the speed e T. Radius and speed are chosen here: 0.25 m, 5 m/s.
    """
    end, radius, speed = 1.0, 0.25, 5.0
    heights = numpy.linspace(2.9, 3.0, 101)
    runs = carom.ensemble(
        weightless_ball,
        {"height": heights, "speed": [speed], "restitution": [e]},
        mode=EventDriven(),
        until=end,
        outputs="body.ball.position.y",
        executor=carom.SerialExecutor(),
    )
    last = radius + e * (speed * end - (heights - radius))
    numpy.testing.assert_allclose(runs["body.ball.position.y"], last, rtol=1e-12)
    for height in (2.9, 2.95, 3.0):
        at = radius + e * (speed * end - (height - radius))
        free = {"height": height, "speed": speed, "restitution": Free(e, 0.0, 1.0)}
        expected = [-e, e * end, speed * end - (height - radius)]
        if e == 1.0:  # its own default
            del free["restitution"], expected[-1]
        result = carom.identify(weightless_ball, free, [Measured("body.ball.position.y", [end], [at])])
        assert abs(result.residuals[0]) < 1e-9
        numpy.testing.assert_allclose(result.jacobian[0], expected, rtol=1e-6)


def test_five_parameters_of_the_ball_between_tables_from_a_poor_start():
    truth = {"e_n": 0.91, "e_t": 0.7, "lower": 0.5, "upper": 0.3, "speed": 5.4}
    start = {"e_n": (0.8, 0.3, 1.0), "e_t": (0.4, 0.0, 1.0), "lower": (0.4, 0.0, 2.0), "upper": (0.4, 0.0, 2.0),
             "speed": 5.0}
    result = carom.identify(tables, start, flashes(tables(), 1e-3, 1))
    for name, value in truth.items():
        assert abs(result.values[name] - value) < 4.0 * result.standard_errors[name], (name, str(result))
    assert result.success
    assert "e_t" in str(result)


def test_true_values_are_within_two_standard_errors_in_95_of_100():
    truth = {"e_n": 0.91, "e_t": 0.7, "mu": 0.3}
    inside = {name: 0 for name in truth}
    seeds = 100
    for seed in range(seeds):
        free = {
            "e_n": (0.85, 0.3, 1.0),
            "e_t": (0.6, 0.0, 1.0),
            "mu": Free(0.35, 0.05, 1.0, paths=["lower", "upper"]),
        }
        result = carom.identify(
            tables, {**{name: Free(*free[name], paths=[name]) for name in ("e_n", "e_t")}, "mu": free["mu"]},
            flashes(tables(lower=0.3, upper=0.3), 1e-3, seed),
        )
        for name, value in truth.items():
            inside[name] += abs(result.values[name] - value) <= 2.0 * result.standard_errors[name]
    # 95.4 of 100 expected; of 100 draws fewer than 89 come once in 300 times.
    assert all(count >= 89 for count in inside.values()), inside


def test_impacts_that_were_not_heard_are_left_out():
    simulation = Simulation(thrown_ball(restitution=0.83), EventDriven())
    simulation.run_until(3.0)
    times = [event.time for event in simulation.events() if event.kind == carom.EventKind.impact]
    heard = [times[place] for place in (0, 1, 3, 4)]
    result = carom.identify(
        thrown_ball,
        {"restitution": (0.82, 0.1, 1.0)},
        [MeasuredImpacts(heard, 1e-3, of="floor")],
        until=3.0,
    )
    assert abs(result.values["restitution"] - 0.83) < 1e-6


def test_a_pose_at_an_impact():
    simulation = Simulation(thrown_ball(friction=0.012), EventDriven())
    simulation.run_until(1.5)
    second = [event.time for event in simulation.events()][1]
    again = Simulation(thrown_ball(friction=0.012), EventDriven())
    again.run_until(second)
    at = again.positions()[0, 0]
    result = carom.identify(
        thrown_ball, {"friction": (0.006, 0.0, 0.1)}, [AtImpact(1, "body.ball.position.x", at, 1e-3)], until=1.5
    )
    assert abs(result.values["friction"] - 0.012) < 1e-6


def test_a_graze_is_told():
    """A ball that just reaches the ceiling, thrown at the speed that fits: faster it hits, slower it does not."""
    speed = math.sqrt(2.0 * G * (1.0 - 1e-6))
    at = 1e-6 + speed * 0.9 - 0.5 * G * 0.81
    result = carom.identify(low_ceiling, {"speed": Free(speed, scale=0.1)}, [Measured("body.ball.position.y", [0.9], [at])])
    assert any("ceiling" in note and "appears or vanishes within a difference of speed" in note for note in result.notes)
    # Without the impact it is the time since.
    assert abs(result.jacobian[0, 0] - 0.9) < 1e-4


def low_ceiling(speed: float) -> System:
    system = System()
    system.add(Gravity((0.0, -G)))
    surface = Surface(friction=0.0, normal_restitution=0.5)
    system.add(HalfPlane(point=(0.0, 1.0), normal=(0.0, -1.0)), surface, "ceiling")
    system.add(HalfPlane(normal=(0.0, 1.0)), surface, "floor")
    system.add(Particle(mass=1.0, position=(0.0, 1e-6), velocity=(0.0, speed)), "ball")
    return system


def test_what_cannot_be_told_apart_is_said():
    # Of a ball that never slips friction has no effect.
    values = flashes(tables(lower=5.0, upper=5.0), 1e-3, 3)
    free = {"e_t": (0.6, 0.0, 1.0), "lower": Free(4.0, 1.0, 9.0, paths=["lower", "upper"])}
    result = carom.identify(tables, free, values)
    assert math.isinf(result.standard_errors["lower"])
    assert any("do not say what lower is" in note for note in result.notes)
    assert abs(result.values["e_t"] - 0.7) < 4.0 * result.standard_errors["e_t"]


def test_processes_give_the_same_result():
    values = flashes(tables(), 1e-3, 2)
    start = {"e_n": (0.8, 0.3, 1.0), "lower": (0.4, 0.0, 2.0)}
    one, two = (carom.identify(tables, start, values, executor=executor) for executor in (None, 2))
    assert one.values == two.values
    assert (one.jacobian == two.jacobian).all()


def test_processes_of_another_version_are_an_error():
    with concurrent.futures.ProcessPoolExecutor(1, initializer=be_another_version) as pool:
        with pytest.raises(ModelError, match=r"carom 0\.0\.9.*allowed: one version"):
            carom.identify(thrown_ball, {"friction": 0.5}, [Measured("body.ball.angle", [0.1], [0.4])], executor=pool)


def test_a_picture(tmp_path):
    pytest.importorskip("matplotlib")
    carom.identify(tables, {"e_n": (0.8, 0.3, 1.0), "lower": 0.4}, flashes(tables(), 1e-3, 2)).plot(tmp_path / "fit.png")
    assert (tmp_path / "fit.png").stat().st_size > 5000


def test_wrong_calls_are_refused():
    values = flashes(tables(), 1e-3, 2)
    with pytest.raises(ModelError, match="has none of that name"):
        carom.identify(tables, {"e_m": 0.5}, values)
    with pytest.raises(ModelError, match="within its bounds"):
        carom.identify(tables, {"e_n": (0.5, 0.6, 1.0)}, values)
    with pytest.raises(ModelError, match="a step late"):
        carom.identify(tables, {"e_n": 0.5}, values, mode=TimeStepping())
    with pytest.raises(ModelError, match="soft_l1"):
        carom.identify(tables, {"e_n": 0.5}, values, loss="soft")
    with pytest.raises(ModelError, match="no measurements"):
        carom.identify(tables, {"e_n": 0.5}, [])
    with pytest.raises(ModelError, match="as many as times"):
        carom.identify(tables, {"e_n": 0.5}, [Measured("body.ball.angle", [0.1, 0.2], [1.0])])
    with pytest.raises(ModelError, match="allowed: more than 0"):
        carom.identify(tables, {"e_n": 0.5}, [Measured("body.ball.angle", [0.1], [1.0], error=0.0)])
    with pytest.raises(ModelError, match=r"shape \(1,\).*\(1, 2\)"):
        carom.identify(tables, {"e_n": 0.5}, [Measured("body.ball.position", [0.1], [1.0])])
    with pytest.raises(ModelError, match="fails at its start.*1.5"):
        carom.identify(tables, {"e_n": 1.5}, values)
    with pytest.raises(ModelError, match="must increase"):
        carom.identify(tables, {"e_n": 0.5}, [MeasuredImpacts([0.2, 0.1], 1e-3)])
