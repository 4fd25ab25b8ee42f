"""Tables for notebooks."""

import html.parser

import pytest

import carom
from carom import EventDriven, Simulation, Surface, System, TimeStepping, tables
from carom.planar import Gravity, HalfPlane, Particle


class Cells(html.parser.HTMLParser):
    """Cells of a table, row by row; refuses tags that do not close."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.rows: list[list[str]] = []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


def bounced() -> Simulation:
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.add(HalfPlane(normal=(0.0, 1.0)), Surface(friction=0.5, normal_restitution=0.6), "<floor>")
    system.add(Particle(mass=1.0, position=(0.0, 1.0)), "ball")
    simulation = Simulation(system, EventDriven())
    simulation.run_until(1.0)
    return simulation


def test_events_and_ledger() -> None:
    simulation = bounced()
    rows = Cells(tables.of_events(simulation)._repr_html_()).rows
    assert rows[0][:3] == ["time [s]", "kind", "of"] and len(rows) == 1 + simulation.event_count() == 3
    assert rows[1][:3] == ["0.451524", "impact", "particle 'ball' on half-plane '<floor>'"]
    ledger = {row[0]: row[1] for row in Cells(simulation.energy()._repr_html_()).rows}
    assert ledger["initial"] == "9.81" and "impact_normal" in ledger and "dashpot" not in ledger


def test_systems_simulations_reports_and_records() -> None:
    simulation = bounced()
    parts = Cells(simulation.system()._repr_html_()).rows
    assert parts[1:] == [
        ["element", "Gravity", "#0"],
        ["obstacle", "HalfPlane", "<floor>"],
        ["body", "Particle", "ball"],
    ]
    shown = dict(Cells(simulation._repr_html_()).rows[1:])
    assert shown["mode"] == "EventDriven" and shown["impacts"] == "2"
    event = dict(Cells(simulation.events()[0]._repr_html_()).rows[1:])
    assert event["time [s]"] == "0.451524" and event["kind"] == "impact"
    stepped = Simulation(simulation.system(), TimeStepping(step=0.1))
    report = dict(Cells(stepped.step()._repr_html_()).rows[1:])
    assert report["step [s]"] == "0.1"


def test_columns_are_chosen_and_named_in_errors() -> None:
    events = bounced().events()
    table = tables.of(events, ["time", "kind"])
    assert table.header == ["time [s]", "kind"] and [row[1] for row in table.rows] == ["impact", "impact"]
    with pytest.raises(ValueError, match="EventRecord has no member 'speed'; members: time"):
        tables.of(events, ["speed"])
    with pytest.raises(TypeError, match="a table needs records of carom, not int"):
        tables.of([3])
    assert len(tables.of([])) == 0


def test_long_tables_show_their_ends() -> None:
    table = tables.Table(["i"], [[i] for i in range(1000)])
    text = str(table).split()
    assert len(table) == 1000 and text[1] == "0" and text[-1] == "999" and "970" in text
    assert len(Cells(table._repr_html_()).rows) == 1 + 31


def test_types_are_shown_as_they_print() -> None:
    assert carom.tables is tables
    assert str(tables.Table(["a", "bc"], [[1.5, True]], "title")) == "title\na    bc\n1.5  True"
