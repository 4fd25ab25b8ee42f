"""Events of a simulation as a list that notebooks show as a table."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, SupportsIndex, overload

if TYPE_CHECKING:
    from ._core import EventRecord, Simulation


class EventList(list["EventRecord"]):
    """Records of events, in order of time; in notebooks a table. `simulation`: where they happened."""

    def __init__(self, events: Iterable[EventRecord], simulation: Simulation) -> None:
        super().__init__(events)
        self.simulation = simulation

    @overload
    def __getitem__(self, place: SupportsIndex) -> EventRecord: ...

    @overload
    def __getitem__(self, place: slice) -> EventList: ...

    def __getitem__(self, place: Any) -> Any:
        found = super().__getitem__(place)
        return EventList(found, self.simulation) if isinstance(place, slice) else found

    def _repr_html_(self) -> str:
        from .tables import of_event_list

        return of_event_list(self)._repr_html_()
