"""What a run was: its course as arrays, tables of them, and their units."""

from __future__ import annotations

import csv
import os
from pathlib import Path
from typing import Any, Optional, Union

import numpy

from . import _core

StrPath = Union[str, "os.PathLike[str]"]

UNITS = {
    "times": "s",
    "positions": "m, m, rad",
    "velocities": "m/s, m/s, rad/s",
    "orientations": "1",
    "ground": "m, m, rad",
    "ledger": "J",
    "point": "m",
    "normal": "1",
    "impulse": "N s",
    "gap": "m",
    "time": "s",
    "instant": "1",
    "velocity_before": "m/s",
    "velocity_after": "m/s",
    "energy_before": "J",
    "energy_after": "J",
}
_PLANAR = (("x [m]", "y [m]", "angle [rad]"), ("v_x [m/s]", "v_y [m/s]", "spin [rad/s]"))
_SPATIAL = (("x [m]", "y [m]", "z [m]"), ("v_x [m/s]", "v_y [m/s]", "v_z [m/s]"))


def units_of(dimension: int) -> dict[str, str]:
    """SI units of every array of a recording."""
    if dimension == 2:
        return dict(UNITS)
    return {**UNITS, "positions": "m, m, m", "velocities": "m/s, m/s, m/s"}


def ledger_type() -> numpy.dtype:
    """Type of a row of the ledger: a number for each term, by its name."""
    stored = [term.name for term in _core.StoredEnergy]
    terms = [*stored, "total", "initial", *(term.name for term in _core.EnergyFlow), "residual"]
    return numpy.dtype([(term, "f8") for term in terms])


class Recording:
    """The course of a run. All arrays have one row for each sample, or are tables of rows.

    times        (samples,) [s]
    positions    (samples, bodies, 3): x, y, angle (0 of particles); in space x, y, z [m, rad]
    velocities   likewise [m/s, rad/s]
    orientations (samples, bodies, 4): unit quaternions w, x, y, z [1]
    ground       (samples, moved shapes, 3): place of the point about which each turns, and its angle [m, rad]
    moved        serial numbers of the moved shapes on ground
    ledger       (samples,), a field for each term of the energy ledger [J]
    events       table: time, instant, kind, mode, name, point, normal, impulse, velocities, energies
    contacts     table of all contacts of all samples, see contacts_at(): name, mode, point, impulse, ...
    names        names of contacts, elements and joints; `name` of a row is a place in it
    model        every part with its fields (carom.model_data)
    units        SI units by array

    The impulse of a contact is that of the step that ended at the sample. In the event-driven mode impacts
    within the step have theirs (`impact` is 1), and contacts that last at the sample have their force then
    times the length of the step, and their mode: stick or slip.
    """

    def __init__(
        self, dimension: int, model: dict[str, Any], moved: list[int], arrays: dict[str, Any]
    ) -> None:
        self.dimension = dimension
        self.model = model
        self.moved = moved
        self.times: numpy.ndarray = arrays["times"]
        self.positions: numpy.ndarray = arrays["positions"]
        self.velocities: numpy.ndarray = arrays["velocities"]
        self._orientations: Optional[numpy.ndarray] = arrays.get("orientations")
        self.ground: numpy.ndarray = arrays["ground"]
        self.ledger: numpy.ndarray = arrays["ledger"]
        self.contacts: numpy.ndarray = arrays["contacts"]
        self.contact_ends: numpy.ndarray = arrays["contact_ends"]
        self.events: numpy.ndarray = arrays["events"]
        self.event_ends: numpy.ndarray = arrays["event_ends"]
        self.names: list[str] = arrays["names"]
        self.units = units_of(dimension)

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        span = f"{self.times[0]:g} s to {self.times[-1]:g} s" if len(self) else "empty"
        return (
            f"Recording({len(self)} samples, {span}, {self.positions.shape[1]} bodies, "
            f"{len(self.events)} events, {len(self.contacts)} contacts)"
        )

    @property
    def orientations(self) -> numpy.ndarray:
        """Unit quaternions (samples, bodies, 4), w, x, y, z: in the plane of turns about z, of particles 1."""
        if self._orientations is not None:
            return self._orientations
        made = numpy.zeros((*self.positions.shape[:2], 4))
        half = 0.5 * self.positions[:, :, 2] if self.dimension == 2 else 0.0
        made[:, :, 0], made[:, :, 3] = numpy.cos(half), numpy.sin(half)
        return made

    def contacts_at(self, sample: int) -> numpy.ndarray:
        """Rows of `contacts` of one sample. Raises IndexError."""
        ends = self.contact_ends
        if not -len(ends) <= sample < len(ends):
            raise IndexError(f"sample {sample} of a recording of {len(ends)}")
        sample %= len(ends)
        return self.contacts[ends[sample - 1] if sample > 0 else 0 : ends[sample]]

    def body_names(self) -> list[str]:
        """Names of the bodies, in the order of `positions`."""
        return [body["name"] for body in self.model["bodies"]]

    def columns(self, table: str) -> dict[str, numpy.ndarray]:
        """A table by columns: "states" (a row for each body of each sample), "ledger", "events", "contacts".

        Headers have the units. Raises ValueError for another name.
        """
        if table == "states":
            return self._state_columns()
        if table == "ledger":
            columns = {"time [s]": self.times}
            for term in self.ledger.dtype.names or ():
                columns[f"{term} [J]"] = self.ledger[term]
            return columns
        if table == "contacts":
            counts = numpy.diff(self.contact_ends, prepend=0)
            return {"time [s]": numpy.repeat(self.times, counts), **self._row_columns(self.contacts)}
        if table == "events":
            return self._row_columns(self.events)
        raise ValueError(f"table is {table!r}; allowed: 'states', 'ledger', 'events', 'contacts'")

    def frame(self, table: str) -> Any:
        """A table, as columns(), as a pandas.DataFrame. Needs pandas."""
        import pandas  # type: ignore[import-untyped, unused-ignore]

        return pandas.DataFrame(self.columns(table))

    def to_csv(self, folder: StrPath) -> None:
        """Writes states.csv, ledger.csv, events.csv and contacts.csv, with all digits. Makes the folder."""
        path = Path(folder)
        path.mkdir(parents=True, exist_ok=True)
        for table in ("states", "ledger", "events", "contacts"):
            columns = self.columns(table)
            with open(path / f"{table}.csv", "w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file)
                writer.writerow(columns)
                writer.writerows(zip(*(column.tolist() for column in columns.values())))

    def to_vtk(self, path: StrPath, every: int = 1) -> None:
        """Writes the run for ParaView: path is a file .pvd, beside which a folder is made. See carom.vtk."""
        from .vtk import write_vtk

        write_vtk(self, path, every)

    def view(self, every: int = 1) -> Any:
        """The run as a page to look at; shown inline in notebooks. See carom.viewer.View."""
        from .viewer import View

        return View(self, every)

    def _state_columns(self) -> dict[str, numpy.ndarray]:
        samples, bodies = self.positions.shape[:2]
        names = numpy.array(self.body_names(), dtype=object)
        columns = {"time [s]": numpy.repeat(self.times, bodies), "body": numpy.tile(names, samples)}
        headers = _SPATIAL if self.dimension == 3 else _PLANAR
        for array, labels in zip((self.positions, self.velocities), headers):
            for i, label in enumerate(labels):
                columns[label] = array[:, :, i].reshape(-1)
        if self._orientations is not None:
            for i, letter in enumerate("wxyz"):
                columns[f"orientation_{letter} [1]"] = self._orientations[:, :, i].reshape(-1)
        return columns

    def _row_columns(self, rows: numpy.ndarray) -> dict[str, numpy.ndarray]:
        enumerations = {"mode": _core.ContactMode, "kind": _core.EventKind}
        directions = "xyz"[: self.dimension]
        along = ("n", "t", "s")[: self.dimension]
        columns: dict[str, numpy.ndarray] = {}
        for field in rows.dtype.names or ():
            values = rows[field]
            unit = f" [{self.units[field]}]" if field in self.units else ""
            if field == "name":
                columns[field] = numpy.array([self.names[i] for i in values], dtype=object)
            elif field in enumerations:
                labels = {int(item.value): item.name for item in enumerations[field]}
                columns[field] = numpy.array([labels[int(i)] for i in values], dtype=object)
            elif values.ndim == 2:
                for i, letter in enumerate(directions if field in ("point", "normal") else along):
                    columns[f"{field}_{letter}{unit}"] = values[:, i]
            else:
                columns[field + unit] = values
        return columns
