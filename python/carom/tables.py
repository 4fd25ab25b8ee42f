"""Tables of results for notebooks: HTML where a notebook shows a value, text elsewhere.

tables.of_events(simulation)        its events
tables.of(records)                  any list of records, a row each
simulation.energy()                 shown as a table by itself; so are reports, systems and simulations
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from . import _core
from .event_list import EventList

__all__ = ["Table", "of", "of_energy", "of_event_list", "of_events", "of_parts"]

_MOST_ROWS = 30


class Table:
    """Rows of cells below a header; long tables show their ends only."""

    def __init__(self, header: Sequence[str], rows: Iterable[Sequence[Any]], title: str = "") -> None:
        self.header = list(header)
        self.rows = [[_text(cell) for cell in row] for row in rows]
        self.title = title

    def _shown(self) -> list[list[str]]:
        if len(self.rows) <= _MOST_ROWS:
            return self.rows
        half = _MOST_ROWS // 2
        left_out = f"... {len(self.rows) - 2 * half} more"
        return [*self.rows[:half], [left_out, *[""] * (len(self.header) - 1)], *self.rows[-half:]]

    def _repr_html_(self) -> str:
        import html  # not needed elsewhere, and some milliseconds of every import

        def line(cells: Sequence[str], tag: str) -> str:
            return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

        title = f"<caption>{html.escape(self.title)}</caption>" if self.title else ""
        body = "".join(line(row, "td") for row in self._shown())
        return f"<table>{title}<thead>{line(self.header, 'th')}</thead><tbody>{body}</tbody></table>"

    def __str__(self) -> str:
        lines = [self.header, *self._shown()]
        widths = [max(len(line[i]) for line in lines) for i in range(len(self.header))]
        texts = [
            "  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in lines
        ]
        return "\n".join([self.title, *texts] if self.title else texts)

    __repr__ = __str__

    def __len__(self) -> int:
        return len(self.rows)


def _text(value: Any) -> str:
    """A value in a cell: six digits, names of enumerations."""
    if isinstance(value, bool) or isinstance(value, (int, str)):
        return str(value)
    if isinstance(value, float):
        return f"{value:.6g}"
    if hasattr(value, "tolist"):
        return _text(value.tolist())
    if isinstance(value, (list, tuple)):
        shown = ", ".join(_text(item) for item in value[:4])
        return f"({shown}{', ...' if len(value) > 4 else ''})"
    name = getattr(value, "name", None)
    return name if isinstance(name, str) else repr(value)


def _fields(kind: type) -> list[tuple[str, str]]:
    """Names and units of the members of a record type."""
    for record in _core.described():
        if record["type"] is kind:
            return [(field["python"], field["unit"]) for field in record["fields"]]
    raise TypeError(f"a table needs records of carom, not {kind.__name__}")


def _with_unit(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def of(records: Sequence[Any], columns: Sequence[str] | None = None, title: str = "") -> Table:
    """A table of records of one type, a row each. `columns` names the members shown; all by default."""
    if not records:
        return Table(columns or [], [], title or "no rows")
    fields = _fields(type(records[0]))
    names = [name for name, _ in fields]
    for column in columns or []:
        if column not in names:
            raise ValueError(
                f"{type(records[0]).__name__} has no member '{column}'; members: {', '.join(names)}"
            )
    shown = [(name, unit) for name, unit in fields if columns is None or name in columns]
    rows = [[getattr(record, name) for name, _ in shown] for record in records]
    return Table([_with_unit(name, unit) for name, unit in shown], rows, title)


def of_record(record: Any) -> Table:
    """A table of one record, a row for each member."""
    rows = [[_with_unit(name, unit), getattr(record, name)] for name, unit in _fields(type(record))]
    return Table(["member", "value"], rows, type(record).__name__)


def of_energy(ledger: _core.EnergyLedger) -> Table:
    """The energy ledger; terms that are zero are left out."""
    kept = ("total", "initial", "residual")
    rows = [[name, value] for name, value in ledger.terms().items() if value != 0.0 or name in kept]
    return Table(["term", "energy [J]"], rows, "energy ledger")


def of_events(simulation: _core.Simulation, first: int = 0) -> Table:
    """The events of a simulation from the one numbered `first` on: when, what, where, and velocities."""
    return of_event_list(simulation.events(first))


def of_event_list(events: EventList) -> Table:
    """Events of a simulation, or some of them, likewise."""
    rows, simulation = [], events.simulation
    for event in events:
        before, after = event.velocity_before, event.velocity_after
        rows.append(
            [event.time, event.kind, simulation.name(event), event.mode, before, after, event.impulse]
        )
    header = ["time [s]", "kind", "of", "mode", "before [m/s]", "after [m/s]", "impulse [N s]"]
    return Table(header, rows, "events")


def of_parts(system: _core.System) -> Table:
    """The parts of a system, in the order in which they were added."""
    rows = [
        [added.role, type(added.part).__name__, added.name or f"#{added.id.serial}"]
        for added in system.parts()
    ]
    return Table(["role", "type", "name"], rows, "system")


def _of_simulation(simulation: _core.Simulation) -> Table:
    mode, energy = type(simulation.mode()).__name__, simulation.energy()
    statistics = simulation.statistics()
    rows: list[list[Any]] = [
        ["mode", mode],
        ["time [s]", simulation.time()],
        ["bodies", len(simulation.bodies())],
        ["steps", statistics.steps],
        ["impacts", statistics.impacts],
        ["total energy [J]", energy.total()],
        ["residual of the ledger [J]", energy.residual()],
    ]
    return Table(["quantity", "value"], rows, "simulation")


def _show(kind: type, table: Callable[[Any], Table]) -> None:
    """Lets notebooks show values of a type as a table."""
    setattr(kind, "_repr_html_", lambda value: table(value)._repr_html_())


_show(_core.EnergyLedger, of_energy)
_show(_core.System, of_parts)
_show(_core.Simulation, _of_simulation)
for _record in _core.described():
    _show(_record["type"], of_record)
