"""Checks of energy, momentum and constraints for tests, as the matchers of carom::testing.

Each function asserts; the error has the terms concerned, the time, and the nearest event:

    from carom import testing
    testing.ledger_closes(recorder.trace(), 1e-12)

With pytest the fixture `stored_trace` compares with a file beside the tests; see docs/energy_tests_python.md.
Checks that only answer are in carom._core.checks: they give whether it holds, and the explanation.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence

from ._core import EnergyLedger, EnergyTrace, System, TraceTolerances, checks

__all__ = [
    "angular_momentum_is_conserved",
    "conservative_loads_follow_the_potential",
    "constraints_hold",
    "energy_never_rises",
    "ledger_closes",
    "matches_stored_trace",
    "modes_agree_with_order_at_least",
    "momentum_is_conserved",
    "refine",
]


def _demand(verdict: tuple[bool, str], what: str) -> None:
    """Raises AssertionError with the explanation where a check does not hold."""
    __tracebackhide__ = True  # pytest shows the test's own line
    holds, text = verdict
    if not holds:
        raise AssertionError(f"{what}\n{text}")


def ledger_closes(account: EnergyTrace | EnergyLedger, relative: float) -> None:
    """The ledger closes within `relative` times its largest term, in every row of a trace."""
    __tracebackhide__ = True
    if isinstance(account, EnergyLedger):
        verdict = checks.ledger_closes(account, relative)
    else:
        verdict = checks.ledger_closes(account, relative)
    _demand(verdict, f"the ledger does not close within {relative:.3g} of its largest term")


def energy_never_rises(trace: EnergyTrace, tolerance: float) -> None:
    """T + V - W_external - intervention rises by no more than `tolerance` [J] above its least value."""
    __tracebackhide__ = True
    _demand(checks.energy_never_rises(trace, tolerance), f"the energy rises by more than {tolerance:.3g} J")


def momentum_is_conserved(trace: EnergyTrace, direction: Sequence[float], relative: float) -> None:
    """The momentum along a direction stays, within `relative` times its scale."""
    __tracebackhide__ = True
    _demand(
        checks.momentum_in(trace, direction, relative),
        f"momentum changes by more than {relative:.3g} of its scale",
    )


def angular_momentum_is_conserved(trace: EnergyTrace, point: Sequence[float], relative: float) -> None:
    """The angular momentum about a point [m] stays, within `relative` times its scale."""
    __tracebackhide__ = True
    verdict = checks.angular_momentum_about(trace, point, relative)
    _demand(verdict, f"angular momentum changes by more than {relative:.3g} of its scale")


def constraints_hold(trace: EnergyTrace, metres: float) -> None:
    """No contact penetrates and no joint opens by more than `metres` [m]."""
    __tracebackhide__ = True
    _demand(
        checks.constraints_within(trace, metres), f"constraints are violated by more than {metres:.3g} m"
    )


def matches_stored_trace(
    trace: EnergyTrace, path: str | os.PathLike[str], tolerances: TraceTolerances, test: str = ""
) -> None:
    """Every term is as stored at `path`, within the tolerances.

    With CAROM_REWRITE_TRACES=1 in the environment the trace is stored instead. One that does not match is
    written beside the stored one. `test` names the test in the advice.
    """
    __tracebackhide__ = True
    if checks.rewrite_requested():
        holds, text = checks.rewrite_stored(trace, path)
        if holds:
            print(text)
        _demand((holds, text), f"the trace cannot be stored in '{path}'")
        return
    _demand(checks.against_stored(trace, path, tolerances, test), f"the trace is not the one in '{path}'")


def refine(steps: Sequence[float], run: Callable[[float], EnergyTrace]) -> list[tuple[float, EnergyTrace]]:
    """Runs `run` with each of the steps [s]; the result is for modes_agree_with_order_at_least()."""
    return [(step, run(step)) for step in steps]


def modes_agree_with_order_at_least(
    traces: Sequence[tuple[float, EnergyTrace]], order: float, reference: EnergyTrace
) -> None:
    """Traces at decreasing steps approach the reference, e.g. of another mode, with at least that order."""
    __tracebackhide__ = True
    verdict = checks.order_at_least(traces, order, reference)
    _demand(verdict, f"the traces do not approach the reference with order {order:.4g}")


def conservative_loads_follow_the_potential(system: System, tolerance: float) -> None:
    """Conservative loads of all elements are minus the gradient of the potential, within `tolerance`."""
    __tracebackhide__ = True
    verdict = checks.conservative_loads(system, tolerance)
    _demand(
        verdict, f"conservative loads are not minus the gradient of the potential within {tolerance:.3g}"
    )
