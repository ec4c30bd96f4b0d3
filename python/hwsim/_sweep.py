"""Times over a grid: arrays with a dimension for everything that varies."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, Any, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from ._tables import Table

if TYPE_CHECKING:
    import pandas

__all__ = ["Sweep"]

_SUPPORT = np.array(["calibrated", "interpolated", "extrapolated", "uncalibrated"])
_POINTS_SHOWN = 20
_NUMBERS = ("time_ms", "low_ms", "high_ms", "dram_mb")

Floats = npt.NDArray[np.float64]


class Sweep:
    """Times over a grid. Each array has the shape ``tuple(len(coords[d]) for d in dims)``."""

    dims: tuple[str, ...]  #: what varies, in the order of the arrays' axes
    coords: dict[str, list[Any]]  #: by dimension: its values
    time_ms: Floats  #: predicted times of the frame
    low_ms: Floats  #: lower ends of the 90 % intervals; NaN where a GPU is not calibrated
    high_ms: Floats  #: upper ends, likewise
    dram_mb: Floats  #: 10^6 bytes that DRAM reads and writes

    def __init__(self, coords: Mapping[str, Sequence[Any]], arrays: Mapping[str, npt.NDArray[Any]]) -> None:
        self.coords = {name: list(values) for name, values in coords.items()}
        self.dims = tuple(self.coords)
        shape = self.shape
        self.time_ms, self.low_ms, self.high_ms, self.dram_mb = (
            np.reshape(arrays[name], shape) for name in _NUMBERS
        )
        self.support_codes = np.reshape(arrays["support"], shape)  #: :attr:`support` as 0 to 3

    @property
    def support(self) -> npt.NDArray[np.str_]:
        """How near the fit was: "calibrated", "interpolated", "extrapolated" or "uncalibrated"."""
        names: npt.NDArray[np.str_] = _SUPPORT[self.support_codes]
        return names

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(len(values) for values in self.coords.values())

    @property
    def size(self) -> int:
        """How many points there are."""
        return int(np.prod(self.shape, dtype=np.int64))

    def __len__(self) -> int:
        return self.size

    def point(self, index: Sequence[int]) -> dict[str, Any]:
        """The coordinates and numbers of a point, by its index in the arrays. Raises IndexError."""
        at = tuple(index)
        row = {name: self.coords[name][i] for name, i in zip(self.dims, at, strict=True)}
        row.update({name: float(getattr(self, name)[at]) for name in _NUMBERS})
        row["support"] = str(self.support[at])
        return row

    def fastest(self) -> dict[str, Any]:
        """The point of the shortest time."""
        return self.point(np.unravel_index(int(np.argmin(self.time_ms)), self.shape))  # type: ignore[arg-type]

    def table(self, first: int | None = None) -> Table:
        """A row a point, the last dimension varying fastest; all of them, or the ``first`` ones."""
        columns = [*self.dims, *_NUMBERS, "support"]
        points = islice(np.ndindex(*self.shape), first)
        return Table(columns, [list(self.point(i).values()) for i in points])

    def to_dataframe(self) -> pandas.DataFrame:
        """A row a point, as a pandas DataFrame. pandas is imported by this call alone."""
        import pandas

        index = np.indices(self.shape).reshape(len(self.dims), -1)
        columns: dict[str, Any] = {
            name: [self.coords[name][i] for i in axis] for name, axis in zip(self.dims, index)
        }
        columns.update({name: getattr(self, name).ravel() for name in (*_NUMBERS, "support")})
        return pandas.DataFrame(columns)

    def __repr__(self) -> str:
        axes = " x ".join(f"{name} ({len(values)})" for name, values in self.coords.items())
        return f"<hwsim.Sweep of {self.size} points: {axes}>"

    def _repr_html_(self) -> str:
        shown = self.table(first=_POINTS_SHOWN)
        note = f", the first {len(shown)} of them" if len(shown) < self.size else ""
        return f"<p>{self.size} points{note}</p>" + shown._repr_html_()
