"""Identification through impacts: parameters of a model by least squares from what was measured."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional, Union

import numpy

from ._core import EventDriven, ModelError
from .ensembles.comparison import AtImpact as AtImpact
from .ensembles.comparison import Comparison, Measurement
from .ensembles.comparison import Measured as Measured
from .ensembles.comparison import MeasuredImpacts as MeasuredImpacts
from .ensembles.differences import Differences
from .ensembles.task import Model, Task
from .scene.errors import nearest

_LOSSES = ("linear", "soft_l1", "huber", "cauchy", "arctan")
_TELLS_APART = 0.95  # correlation beyond which two parameters are said to be one


@dataclass
class Free:
    """A parameter that is looked for. start: where. low, high: bounds. paths: of the numbers that it is, if they are
    several or its name is not their path. scale: a change of it that matters; else its start or its bounds say it.
    """

    start: float
    low: float = -numpy.inf
    high: float = numpy.inf
    paths: Sequence[str] = ()
    scale: Optional[float] = None


@dataclass
class Identified:
    """What identify() found. values, standard_errors: by name. correlation: in the order of `names`. residuals: over
    their errors, in the order of the measurements. notes: what is to be known of it, a sentence each. cost: half the
    sum of squares. jacobian: of the residuals by the parameters.
    """

    names: list[str]
    values: dict[str, float]
    standard_errors: dict[str, float]
    correlation: numpy.ndarray
    residuals: numpy.ndarray
    jacobian: numpy.ndarray
    cost: float
    success: bool
    message: str
    evaluations: int
    notes: list[str] = field(default_factory=list)

    def __str__(self) -> str:
        lines = [
            f"  {name:<34} {self.values[name]: .8g} +- {self.standard_errors[name]:.2g}" for name in self.names
        ]
        degrees = max(1, len(self.residuals) - len(self.names))
        lines.append(f"  chi^2 / degrees of freedom         {2.0 * self.cost / degrees: .4g}")
        return "\n".join([*lines, *(f"  note: {note}" for note in self.notes)])

    def plot(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Draws residuals and correlations into a picture. Needs matplotlib."""
        import matplotlib  # type: ignore[import-not-found, unused-ignore]

        matplotlib.use("Agg")
        from matplotlib import pyplot  # type: ignore[import-not-found, unused-ignore]

        figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
        left.axhspan(-1.0, 1.0, color="0.9")
        left.plot(self.residuals, ".", color="#0b62a4")
        left.set(xlabel="measured value", ylabel="residual / standard error")
        shown = right.imshow(self.correlation, vmin=-1.0, vmax=1.0, cmap="RdBu_r")
        places = range(len(self.names))
        right.set_xticks(places, self.names, rotation=30, ha="right")
        right.set_yticks(places, self.names)
        figure.colorbar(shown, label="correlation")
        figure.savefig(Path(path), dpi=120)
        pyplot.close(figure)


def _free(parameters: Any) -> dict[str, Free]:
    """What is looked for, by name. Raises ModelError."""
    if not isinstance(parameters, Mapping) or not parameters:
        raise ModelError("identify: parameters must be a dictionary of starts, (start, low, high), or Free(...)")
    made = {}
    for name, given in parameters.items():
        if isinstance(given, (int, float)) and not isinstance(given, bool):
            given = Free(float(given))
        elif isinstance(given, tuple) and len(given) == 3:
            given = Free(float(given[0]), float(given[1]), float(given[2]))
        if not isinstance(given, Free):
            raise ModelError(f"parameter {name!r}: is {given!r}; allowed: a start, (start, low, high), or Free(...)")
        if not given.low < given.high or not given.low <= given.start <= given.high:
            raise ModelError(
                f"parameter {name!r}: starts at {given.start:g}; allowed: within its bounds, {given.low:g} to {given.high:g}"
            )
        made[name] = given
    return made


def _scale(one: Free) -> float:
    if one.scale is not None:
        return one.scale
    if numpy.isfinite(one.low) and numpy.isfinite(one.high):
        return 0.1 * (one.high - one.low)
    return abs(one.start) or 1.0


def identify(
    model: Model,
    parameters: Mapping[str, Any],
    measurements: Sequence[Measurement],
    *,
    mode: Optional[EventDriven] = None,
    until: Optional[float] = None,
    loss: str = "linear",
    executor: Any = None,
) -> Identified:
    """Finds parameters of a model with which its runs fit measurements: weighted least squares by SciPy's trust
    region, with derivatives by central differences of event-driven runs.

    model: as of ensemble(). parameters: starts by path ("surface.floor.friction"), (start, low, high), or Free(...).
    measurements: Measured, MeasuredImpacts, AtImpact. mode: EventDriven; by default with a relative tolerance of 1e-10.
    until [s]: by default the last time of the measurements. loss: of scipy.optimize.least_squares, for outliers.
    executor: as of ensemble(); None: this process.

    Where an impact appears or vanishes within a difference, that is made shorter, and `notes` say it; so they do of
    parameters that cannot be told apart. Raises ModelError, before any run, for what is wrong with the call, and where
    the model fails at its start; ImportError without SciPy.
    """
    from scipy.optimize import least_squares  # type: ignore[import-untyped, import-not-found, unused-ignore]

    free = _free(parameters)
    if loss not in _LOSSES:
        raise ModelError(f"identify: loss is {loss!r}{nearest(loss, _LOSSES)}")
    if mode is not None and not isinstance(mode, EventDriven):
        raise ModelError(
            f"identify: mode is {type(mode).__name__}, in which an impact is up to a step late; allowed: EventDriven(...)"
        )
    mode = mode or EventDriven(relative_tolerance=1e-10)
    comparison = Comparison(measurements)
    paths = {name: list(one.paths) or [name] for name, one in free.items()}
    names = [path for of in paths.values() for path in of]
    task = Task(model, names, mode, comparison.last if until is None else until, comparison, 0)
    scales = numpy.array([_scale(one) for one in free.values()])
    bounds = numpy.array([[one.low, one.high] for one in free.values()])
    spread = [len(of) for of in paths.values()]
    differences = Differences(task, spread, scales, bounds, mode.relative_tolerance, executor)
    start = numpy.array([one.start for one in free.values()])
    differences.demand_run(start)
    with differences:
        found = least_squares(
            differences.residuals, start, differences.jacobian, bounds.T, x_scale=scales, loss=loss, xtol=1e-12,
            ftol=1e-12, gtol=1e-12,
        )
        jacobian = differences.jacobian(found.x)
        notes = differences.notes
    return _result(list(free), found, differences.residuals(found.x), jacobian, notes)


def _result(
    names: list[str], found: Any, residuals: numpy.ndarray, jacobian: numpy.ndarray, notes: list[str]
) -> Identified:
    """Errors and correlations from the Jacobian."""
    notes = list(notes)
    inverse, unknown = _inverse(jacobian)
    for direction in unknown:
        involved = ", ".join(name for name, part in zip(names, direction) if abs(part) > 0.1)
        notes.append(f"the measurements do not say what {involved} is")
    errors = numpy.sqrt(numpy.diag(inverse))
    with numpy.errstate(invalid="ignore", divide="ignore"):
        correlation = inverse / numpy.outer(errors, errors)
    for direction in unknown:
        errors[abs(direction) > 1e-6] = numpy.inf
    unsaid = ~numpy.isfinite(errors)
    correlation[unsaid] = correlation[:, unsaid] = 0.0
    correlation[~numpy.isfinite(correlation)] = 0.0
    numpy.fill_diagonal(correlation, 1.0)
    for i, one in enumerate(names):
        for j in range(i):
            if abs(correlation[i, j]) > _TELLS_APART:
                notes.append(f"{names[j]} and {one} can hardly be told apart: correlation {correlation[i, j]:.3f}")
    return Identified(
        names,
        dict(zip(names, map(float, found.x))),
        dict(zip(names, map(float, errors))),
        correlation,
        residuals,
        jacobian,
        float(found.cost),
        bool(found.success),
        str(found.message),
        int(found.nfev),
        notes,
    )


def _inverse(jacobian: numpy.ndarray) -> tuple[numpy.ndarray, list[numpy.ndarray]]:
    """Covariance of the parameters, by the singular values of the Jacobian: of the directions that the residuals tell. The
    others are listed, in columns of length 1.
    """
    lengths = numpy.linalg.norm(jacobian, axis=0)
    lengths[lengths == 0.0] = 1.0
    missing = max(0, jacobian.shape[1] - jacobian.shape[0])  # residuals, where there are fewer than parameters
    _, singular, directions = numpy.linalg.svd(
        numpy.vstack([jacobian / lengths, numpy.zeros((missing, len(lengths)))]), full_matrices=False
    )
    told = singular > 1e-8 * singular[0]
    scaled = directions[told] / singular[told, None] / lengths
    return scaled.T @ scaled, list(directions[~told])
