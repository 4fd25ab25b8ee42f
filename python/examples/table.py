"""Tables of comma-separated values with all digits, as the C++ examples write them."""

from __future__ import annotations

import os


class Table:
    """A file with a header and rows of numbers; 17 digits read back to the same number."""

    def __init__(self, path: str | os.PathLike[str], header: str) -> None:
        self._file = open(path, "w", encoding="utf-8")
        self._file.write(header + "\n")

    def row(self, *cells: float | str) -> None:
        """Writes a row of numbers and texts."""
        texts = (cell if isinstance(cell, str) else f"{cell:.17g}" for cell in cells)
        self._file.write(",".join(texts) + "\n")

    def close(self) -> None:
        self._file.close()

    def __enter__(self) -> Table:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
