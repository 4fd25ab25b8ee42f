"""carom.testing and the plugin of pytest: the page's example, and that every check can fail."""

import pathlib
import subprocess
import sys

import pytest

import carom
import pages
from carom import EnergyTrace, Simulation, System, TimeStepping, TraceTolerances, planar, testing
from carom.planar import Particle, SpringDamper


def pytest_in(folder: pathlib.Path, **environment: str) -> str:
    """Runs pytest in a folder of its own and returns its output."""
    import os

    kept = {key: value for key, value in os.environ.items() if key != "CAROM_REWRITE_TRACES"}
    ran = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(folder)],
        env={**kept, **environment},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
    )
    return ran.stdout


def test_tests_of_the_page(tmp_path: pathlib.Path) -> None:
    [code] = [text for language, text in pages.blocks("energy_tests_python.md") if language == "python"]
    test = tmp_path / "test_hopper.py"
    test.write_text(code, encoding="utf-8")
    first = pytest_in(tmp_path)
    assert "4 passed" in first and "1 failed" in first
    assert "there is no stored trace" in first
    assert "5 passed" in pytest_in(tmp_path, CAROM_REWRITE_TRACES="1")
    assert (tmp_path / "hopper.csv").exists()
    assert "5 passed" in pytest_in(tmp_path)
    test.write_text(code.replace("stiffness=500.0", "stiffness=501.0"), encoding="utf-8")
    changed = pytest_in(tmp_path)
    assert "1 failed" in changed and "'elastic' departs first" in changed
    assert (tmp_path / "hopper.produced.csv").exists()


def test_functions_of_the_page_are_all_there_are() -> None:
    page = (pages.DOCS / "energy_tests_python.md").read_text(encoding="utf-8")
    for name in testing.__all__:
        assert f"`{name}(" in page or f"({name}(" in page, name


def rising() -> EnergyTrace:
    """A trace whose energy, momenta and penetration change, and whose ledger does not close."""
    trace = EnergyTrace()
    for i in range(3):
        row = {name: 1.0 for name in EnergyTrace.terms() if name.endswith("_scale") or name == "scale"}
        row.update(
            time=0.1 * i, kinetic=1.0 + i, total=1.0 + i, momentum_x=float(i), angular_momentum_z=float(i)
        )
        row.update(penetration=0.1 * i, initial=1.0, residual=float(i))
        trace.add({name: value for name, value in row.items() if name in EnergyTrace.terms()})
    return trace


@pytest.mark.parametrize(
    ("check", "text"),
    [
        (lambda trace: testing.ledger_closes(trace, 1e-12), "the ledger does not close within 1e-12"),
        (lambda trace: testing.energy_never_rises(trace, 0.5), "the energy rises by more than 0.5 J"),
        (lambda trace: testing.momentum_is_conserved(trace, (1.0, 0.0), 1e-3), "momentum changes"),
        (
            lambda trace: testing.angular_momentum_is_conserved(trace, (0.0, 0.0), 1e-3),
            "angular momentum changes",
        ),
        (
            lambda trace: testing.constraints_hold(trace, 0.01),
            "constraints are violated by more than 0.01 m",
        ),
    ],
)
def test_checks_fail_with_an_explanation(check, text: str) -> None:
    with pytest.raises(AssertionError, match=text) as caught:
        check(rising())
    assert str(caught.value).count("\n") > 1  # the table of terms


def test_wrong_input_is_no_failed_check() -> None:
    with pytest.raises(carom.ModelError):
        testing.energy_never_rises(rising(), -1.0)
    with pytest.raises(carom.ModelError):
        testing.ledger_closes(EnergyTrace(), 1e-12)


def swing(step: float) -> EnergyTrace:
    system = System()
    bob = system.add(Particle(mass=1.0, position=(1.2, 0.0), velocity=(0.0, 1.0), contact=False))
    system.add(SpringDamper(from_=carom.ground, to=bob, stiffness=40.0, free_length=1.0))
    return carom.record_at(Simulation(system, TimeStepping(step=step)), [0.5, 1.0])


def test_order_is_seen() -> None:
    reference = swing(1e-5)
    traces = testing.refine([4e-3, 2e-3, 1e-3], swing)
    testing.modes_agree_with_order_at_least(traces, 1.9, reference)  # the trapezoidal rule is of order 2
    with pytest.raises(AssertionError, match="order 3"):
        testing.modes_agree_with_order_at_least(traces, 3.0, reference)


class Lopsided(planar.ForceElement):
    """An element whose potential is not the one of its loads."""

    def __init__(self, body: carom.BodyId, factor: float) -> None:
        super().__init__()
        self.body, self.factor = body, factor

    def bodies(self) -> list[carom.BodyId]:
        return [self.body]

    def loads(self, at: planar.ElementView, out: planar.ElementLoads) -> None:
        out.conservative(self.body, -at.position(self.body))

    def potential(self, at: planar.ElementView) -> float:
        return 0.5 * self.factor * float(at.position(self.body) @ at.position(self.body))


def test_loads_are_those_of_the_potential() -> None:
    for factor, holds in ((1.0, True), (1.1, False)):
        system = System()
        body = system.add(Particle(mass=1.0, position=(1.0, 0.5), contact=False))
        system.add(Lopsided(body, factor))
        if holds:
            testing.conservative_loads_follow_the_potential(
                system, 1e-6
            )  # differences of the potential, step 1e-6
        else:
            with pytest.raises(AssertionError, match="gradient of the potential"):
                testing.conservative_loads_follow_the_potential(system, 1e-6)


def test_ledger_of_a_simulation_closes() -> None:
    system = System()
    system.add(planar.Gravity((0.0, -9.81)))
    system.add(Particle(mass=1.0, position=(0.0, 1.0), contact=False))
    simulation = Simulation(system, TimeStepping(step=0.1))
    simulation.run_until(1.0)
    testing.ledger_closes(simulation.energy(), 1e-12)


def test_tolerances_are_named() -> None:
    with pytest.raises(TypeError, match="TraceTolerances has no argument 'absolute'"):
        TraceTolerances(absolute=1.0)
