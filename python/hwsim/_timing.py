"""Times of a frame on a GPU, and what follows from them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Iterator, Mapping

from ._tables import Table, table_of

if TYPE_CHECKING:
    import pandas

    from ._gpu import Gpu

__all__ = ["Comparison", "Explanation", "Gradient", "PassTiming", "Ratio", "Timing", "compare_timings", "ratio"]


@dataclass(frozen=True)
class PassTiming:
    """One pass of a frame on a GPU."""

    name: str
    kind: str  #: "draw", "full_screen", "compute", "clear", "copy" or "resolve"
    time_ms: float
    limiter: str  #: the unit with the largest share of the time
    units: Mapping[str, float]  #: by unit: the busy part of the time, 0 to 1
    bytes: Mapping[str, float]  #: by stream: DRAM bytes, read and written
    counters: Mapping[str, int]  #: by id: the counts of :func:`hwsim.counters`


class Timing:
    """A frame's time on one GPU: :meth:`hwsim.Frame.time` gives it."""

    def __init__(self, data: Mapping[str, Any], gpu: Gpu, work: object) -> None:
        self._data = data
        self._gpu = gpu
        self._work = work  # stands for the counted frame: timings with one differ in hardware alone

    @property
    def time_ms(self) -> float:
        """The frame's time: the sum of its passes."""
        return float(self._data["frame"]["time_ms"])

    @property
    def interval_ms(self) -> tuple[float, float] | None:
        """The 90 % interval of the time; None on a GPU that is not calibrated."""
        interval = self._data["frame"]["interval_ms"]
        return None if interval is None else (float(interval[0]), float(interval[1]))

    @property
    def support(self) -> str:
        """How near the fit was: "calibrated", "interpolated", "extrapolated" or "uncalibrated"."""
        return str(self._data["frame"]["support"])

    @property
    def scene(self) -> str:
        return str(self._data["scene"])

    @property
    def technique(self) -> str:
        return str(self._data["technique"])

    @property
    def gpu(self) -> str:
        """The GPU's id with all that was laid over it."""
        return self._gpu.label

    @property
    def memory_mib(self) -> float:
        """The most that attachments and buffers take at once."""
        return float(self._data["frame"]["memory_mib"])

    @property
    def dram_mb(self) -> float:
        """10^6 bytes that DRAM reads and writes."""
        return float(self._data["frame"]["dram_mb"])

    @property
    def shaded_samples(self) -> int:
        """Evaluations of lighting."""
        return int(self._data["frame"]["shaded_samples"])

    @property
    def passes(self) -> list[PassTiming]:
        """The passes, in order."""
        fields = PassTiming.__dataclass_fields__
        return [PassTiming(**{name: p[name] for name in fields}) for p in self._data["passes"]]

    @property
    def limiter(self) -> str:
        """The unit that bounds the slowest pass; empty for a frame without passes."""
        return max(self.passes, key=lambda p: p.time_ms).limiter if self._data["passes"] else ""

    @property
    def warnings(self) -> list[str]:
        """What a reader of the number should know."""
        return list(self._data.get("warnings", []))

    def to_dict(self) -> dict[str, Any]:
        """Everything, with the keys of ``result.json`` (docs/results.md)."""
        copy: dict[str, Any] = json.loads(json.dumps(self._data))
        return copy

    def table(self) -> Table:
        """A row a pass: time, limiter, DRAM bytes and the busiest units."""
        rows = []
        for p in self.passes:
            busiest = sorted(p.units.items(), key=lambda unit: -unit[1])[:3]
            units = " ".join(f"{name} {100 * share:.0f}%" for name, share in busiest if share > 0)
            rows.append([p.name, p.time_ms, p.limiter, sum(p.bytes.values()) / 1e6, units])
        return Table(["name", "time_ms", "limiter", "dram_mb", "busiest_units"], rows)

    def to_dataframe(self) -> pandas.DataFrame:
        """The passes of :meth:`table` as a pandas DataFrame."""
        return self.table().to_dataframe()

    def _sentence(self) -> str:
        interval = self.interval_ms
        between = f" [{interval[0]:.2f}, {interval[1]:.2f}]" if interval else ""
        return f"{self.technique} on {self.gpu}: {self.time_ms:.3f} ms{between} {self.support}"

    def __repr__(self) -> str:
        return f"<hwsim.Timing {self._sentence()}>"

    def _repr_html_(self) -> str:
        return f"<p>{self._sentence()}</p>" + self.table()._repr_html_()


@dataclass(frozen=True)
class Ratio:
    """How many times as long one frame takes as another."""

    value: float  #: above 1: the first one takes longer
    interval: tuple[float, float] | None  #: 90 %; None unless both GPUs are calibrated

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        between = f" [{self.interval[0]:.3f}, {self.interval[1]:.3f}]" if self.interval else ""
        return f"{self.value:.3f}{between}"


def _timed_words(timings: Mapping[str, Timing]) -> list[tuple[str, str, str, Any, int]]:
    """What the core is told of each: label, what is laid over its GPU, its result, its GPU, and a number of its frame."""
    works: list[object] = []
    words = []
    for label, t in timings.items():
        if not any(work is t._work for work in works):
            works.append(t._work)
        view = next(i for i, work in enumerate(works) if work is t._work)
        words.append((label, t._gpu.variation, json.dumps(t._data), t._gpu._core, view))
    return words


def ratio(timing: Timing, base: Timing) -> Ratio:
    """``timing.time_ms / base.time_ms``, with its 90 % interval.

    It is known better than either time, as most errors of a time are in both. Raises ZeroDivisionError where
    the base takes no time.
    """
    value = timing.time_ms / base.time_ms
    words = _timed_words({"before": base, "after": timing})
    change = timing._gpu._lab._core.change_interval(*words)
    return Ratio(value, None if change is None else (1 + change[0], 1 + change[1]))


class Gradient(Mapping[str, float]):
    """How a frame's time follows each number of the GPU: a mapping from keys to d ln(time) / d ln(value).

    -0.5 at ``dram_bandwidth_gb_s``: a percent of bandwidth more makes the frame half a percent shorter. Exact
    (dual numbers through the timing engine), at this GPU; where two units are equally late, of one side.
    """

    def __init__(self, rows: list[tuple[str, float, float, float]]) -> None:
        self._rows = {key: (value, slope_ms, elasticity) for key, value, slope_ms, elasticity in rows}

    def __getitem__(self, key: str) -> float:
        return self._rows[key][2]

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    def slope_ms(self, key: str) -> float:
        """d(time in ms) / d(value), in ms for one of the key's unit. Raises KeyError."""
        return self._rows[key][1]

    def strongest(self, count: int = 10) -> list[tuple[str, float]]:
        """The keys that matter most, with their elasticities; those without influence are left out."""
        moving = [(key, e) for key, e in self.items() if e != 0.0]
        return sorted(moving, key=lambda item: -abs(item[1]))[:count]

    def table(self) -> Table:
        """Every key: value, slope and elasticity, the strongest first."""
        rows = [[key, *self._rows[key]] for key in sorted(self, key=lambda k: -abs(self[k]))]
        return Table(["key", "value", "slope_ms", "elasticity"], rows)

    def to_dataframe(self) -> pandas.DataFrame:
        """The rows of :meth:`table` as a pandas DataFrame."""
        return self.table().to_dataframe()

    def __repr__(self) -> str:
        words = ", ".join(f"{key} {e:+.2f}" for key, e in self.strongest(4))
        return f"<hwsim.Gradient {words}>"

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()


class Explanation:
    """Why a frame takes its time: :meth:`hwsim.Frame.explain` gives it."""

    def __init__(self, data: Mapping[str, Any], gpu: Gpu, work: object) -> None:
        self._data = data
        self.timing = Timing(data, gpu, work)  #: the time that is explained

    @property
    def headroom(self) -> Table:
        """By unit, the largest gain first: the frame's time in ms if the unit took none."""
        rows = [[unit, entry["time_ms"]] for unit, entry in self._data["headroom"].items()]
        return Table(["unit", "time_ms"], rows)

    @property
    def sensitivities(self) -> Table:
        """By key: value, slope, elasticity, and the frame's time in ms with twice the value (None: out of range)."""
        columns = ["parameter", "value", "slope_ms", "elasticity", "doubled_ms"]
        return Table(columns, [[s[c] for c in columns] for s in self._data["sensitivity"]])

    @property
    def stack_ms(self) -> list[dict[str, float]]:
        """For each pass, by unit: its exclusive share of the pass's time in ms."""
        return [dict(p["stack_ms"]) for p in self._data["passes"]]

    def __repr__(self) -> str:
        best = self.headroom[0]["unit"] if len(self.headroom) else "nothing"
        return f"<hwsim.Explanation {self.timing._sentence()}; held back most by {best}>"

    def _repr_html_(self) -> str:
        return self.timing._repr_html_() + self.headroom._repr_html_()


class Comparison:
    """Results beside a baseline."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._data = data

    @property
    def frames(self) -> Table:
        """A row a result, the baseline first: time, change with its interval, limiter, bytes, memory, shaded samples."""
        return table_of(self._data["frames"])

    @property
    def matrix(self) -> Table:
        """Techniques by variations: what each variation does to the time, "+73 % [+66, +81]"."""
        return table_of(self._data["matrix"])

    @property
    def passes(self) -> Table:
        """A row a difference and pass that changed."""
        return table_of(self._data["passes"])

    @property
    def counters(self) -> Table:
        """A row a difference, pass and counter that changed."""
        return table_of(self._data["counters"])

    def to_dict(self) -> dict[str, Any]:
        """Everything, with the keys that ``hwsim compare --format json`` prints."""
        copy: dict[str, Any] = json.loads(json.dumps(self._data["json"]))
        return copy

    def to_dataframe(self) -> pandas.DataFrame:
        """:attr:`frames` as a pandas DataFrame."""
        return self.frames.to_dataframe()

    def __repr__(self) -> str:
        return repr(self.frames)

    def _repr_html_(self) -> str:
        return self.frames._repr_html_()


def compare_timings(timings: Mapping[str, Timing]) -> Comparison:
    """Timings by label: each against the first one of its technique and GPU, and those against the first of all.

    >>> hwsim.compare_timings({"gtx980": frame.time(gpu), "twice the ROPs": frame.time(gpu.over("rops-x2"))})
    """
    if not timings:
        raise ValueError("there is nothing to compare")
    lab = next(iter(timings.values()))._gpu._lab
    return Comparison(lab._core.compare_results(_timed_words(timings)))
