"""Plugin of pytest: the fixture `stored_trace`. Installed with the package; nothing else needs pytest."""

from __future__ import annotations

import pathlib
from typing import Protocol

import pytest

from . import testing
from ._core import EnergyTrace, TraceTolerances


class StoredTrace(Protocol):
    """Compares a trace with the one stored in a file beside the test (testing.matches_stored_trace())."""

    def __call__(self, trace: EnergyTrace, file: str, tolerances: TraceTolerances) -> None: ...


@pytest.fixture
def stored_trace(request: pytest.FixtureRequest) -> StoredTrace:
    """stored_trace(trace, "hopper.csv", TraceTolerances(relative=1e-10)): the file lies beside the test."""
    folder, name = pathlib.Path(request.path).parent, request.node.nodeid

    def compare(trace: EnergyTrace, file: str, tolerances: TraceTolerances) -> None:
        __tracebackhide__ = True
        testing.matches_stored_trace(trace, folder / file, tolerances, name)

    return compare
