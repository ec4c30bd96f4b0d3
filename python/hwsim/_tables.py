"""Rows that notebooks show, and that become a pandas DataFrame when they are asked to."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Sequence, overload

if TYPE_CHECKING:
    import pandas

__all__ = ["Table"]

_ROWS_SHOWN = 40


def _shown(value: Any) -> str:
    if value is None:
        return "\N{EN DASH}"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


class Table(Sequence[Mapping[str, Any]]):
    """A sequence of rows, each a mapping from the table's columns to bool, int, float, str or None."""

    def __init__(
        self,
        columns: Sequence[str],
        rows: Sequence[Sequence[Any]],
        titles: Mapping[str, str] | None = None,
    ) -> None:
        self._columns = tuple(columns)
        self._rows = [dict(zip(self._columns, row)) for row in rows]
        self._titles = dict(titles or {})

    @property
    def columns(self) -> tuple[str, ...]:
        """The keys of each row, in order."""
        return self._columns

    @overload
    def __getitem__(self, index: int) -> dict[str, Any]: ...
    @overload
    def __getitem__(self, index: slice) -> list[dict[str, Any]]: ...
    def __getitem__(self, index: int | slice) -> dict[str, Any] | list[dict[str, Any]]:
        return self._rows[index]

    def __len__(self) -> int:
        return len(self._rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self._rows)

    def column(self, name: str) -> list[Any]:
        """The values of one column. Raises KeyError for a name that is none."""
        if name not in self._columns:
            raise KeyError(name)
        return [row[name] for row in self._rows]

    def to_dataframe(self) -> pandas.DataFrame:
        """The rows as a pandas DataFrame. pandas is imported by this call alone."""
        import pandas

        return pandas.DataFrame(self._rows, columns=list(self._columns))

    def __repr__(self) -> str:
        cells = [[self._titles.get(c, c) for c in self._columns]]
        cells += [[_shown(row[c]) for c in self._columns] for row in self._rows[:_ROWS_SHOWN]]
        widths = [max(len(line[i]) for line in cells) for i in range(len(self._columns))]
        lines = ["  ".join(text.ljust(w) for text, w in zip(line, widths)).rstrip() for line in cells]
        return "\n".join(lines + self._left_out())

    def _left_out(self) -> list[str]:
        left = len(self._rows) - _ROWS_SHOWN
        return [f"... and {left} rows more"] if left > 0 else []

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{escape(self._titles.get(c, c))}</th>" for c in self._columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(_shown(row[c]))}</td>" for c in self._columns) + "</tr>"
            for row in self._rows[:_ROWS_SHOWN]
        )
        note = "".join(f"<p>{text}</p>" for text in self._left_out())
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{note}"


def table_of(data: Mapping[str, Any]) -> Table:
    """A table of the module ``_core``."""
    columns = data["columns"]
    return Table([c for c, _ in columns], data["rows"], dict(columns))
