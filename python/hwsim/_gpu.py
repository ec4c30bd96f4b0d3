"""GPUs as mappings from keys to values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Iterator, Mapping, Union

from . import _core
from ._checks import factor_of, settings_of, text_of
from ._tables import Table

if TYPE_CHECKING:
    from ._lab import Lab

__all__ = ["Gpu", "KeyInfo", "Origin", "Value", "gpu_keys"]

#: The value of a key. As a setting, ``"x2"`` stands for twice what is there.
Value = Union[bool, int, float, str]


@dataclass(frozen=True)
class KeyInfo:
    """What a key of a GPU is."""

    name: str  #: with its unit: "core_clock_mhz"
    low: float  #: the smallest value, inclusive; unused for switches
    high: float  #: the largest value, inclusive
    description: str


@dataclass(frozen=True)
class Origin:
    """Where a value came from."""

    layer: str  #: "built-in default", "file", "parent file", "overlay" or "setting"
    provenance: str | None  #: "published", "measured", "fitted", "derived" or "assumed"
    source: str  #: a key of docs/hardware_sources.md, or words
    interval: tuple[float, float] | None  #: bounds of the value, or 90 % of a fit
    file: str
    line: int
    text: str

    def __str__(self) -> str:
        return self.text


def gpu_keys() -> dict[str, KeyInfo]:
    """Every key that a GPU has, by name, in the order of its file."""
    return {key["name"]: KeyInfo(**key) for key in _core.gpu_keys()}


_KEYS = tuple(key["name"] for key in _core.gpu_keys())


class Gpu(Mapping[str, Value]):
    """A GPU with every value decided: a mapping from its keys to bool, int, float or str.

    Immutable: :meth:`but`, :meth:`scaled` and :meth:`over` give another one, of the same file. Equal where all
    numbers are equal.
    """

    def __init__(self, core: _core.Gpu, lab: Lab) -> None:
        self._core = core
        self._lab = lab

    def __getitem__(self, key: str) -> Value:
        return self._core.value(key)

    def __iter__(self) -> Iterator[str]:
        return iter(_KEYS)

    def __len__(self) -> int:
        return len(_KEYS)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Gpu):
            return NotImplemented
        return self.id == other.id and self._core.content_hash() == other._core.content_hash()

    def __hash__(self) -> int:
        return hash((self.id, self._core.content_hash()))

    @property
    def id(self) -> str:
        """The file's id: "gtx980"."""
        return self._core.id

    @property
    def title(self) -> str:
        """The name in the shops: "GeForce GTX 980"."""
        return self._core.title

    @property
    def vendor(self) -> str:
        return self._core.vendor

    @property
    def architecture(self) -> str:
        return self._core.architecture

    @property
    def label(self) -> str:
        """The id with all that was laid over it: "gtx980 rops-x2 l2_size_kib=4096"."""
        return f"{self.id} {self.variation}".rstrip()

    @property
    def variation(self) -> str:
        """What was laid over the file: "rops-x2 l2_size_kib=4096"; empty for the file as it is."""
        settings = [f"{path[len('gpu.'):]}={value}" for path, value in self._core.sets]
        return " ".join([*self._core.overlays, *settings])

    def but(self, settings: Mapping[str, Value] | None = None, /, **keys: Value) -> Gpu:
        """The same GPU with other values; ``"x2"`` stands for twice what is there.

        >>> gpu.but(l2_size_kib=8192, core_clock_mhz="x1.1")

        Keys with a dot go into the mapping: ``gpu.but({"features.native_msaa_max": 4})``. Raises InputError for
        keys, types and ranges that are none, and for values that contradict each other.
        """
        sets = {**settings_of("settings", settings), **keys}
        more = [(f"gpu.{key}", value) for key, value in sets.items()]
        return self._made(self._core.overlays, [*self._core.sets, *more])

    def scaled(self, factors: Mapping[str, float] | None = None, /, **keys: float) -> Gpu:
        """The same GPU with values times factors: ``gpu.scaled(dram_bandwidth_gb_s=2)``. Raises InputError."""
        both = {**settings_of("factors", factors), **keys}
        return self.but({key: f"x{factor_of(key, factor)!r}" for key, factor in both.items()})

    def over(self, *overlays: str) -> Gpu:
        """The same GPU below overlays: names of :func:`hwsim.overlays`, or files that end in .toml.

        Settings of :meth:`but` still act last. Raises InputError.
        """
        names = [text_of("overlay", overlay) for overlay in overlays]
        return self._made([*self._core.overlays, *names], self._core.sets)

    def _made(self, overlays: list[str], sets: list[tuple[str, Value]]) -> Gpu:
        core = self._lab._core.gpu(self._core.name, overlays, sets, self._core.calibrated)
        return Gpu(core, self._lab)

    def origin(self, key: str) -> Origin:
        """Where the value of a key came from. Raises KeyError for a key that is none."""
        return Origin(**self._core.origin(key))

    def difference(self, other: Gpu) -> dict[str, tuple[Value, Value]]:
        """The keys in which two GPUs differ, with both values."""
        return {key: (self[key], other[key]) for key in self if self[key] != other[key]}

    def to_toml(self, origins: bool = False) -> str:
        """A complete GPU file that gives the same numbers; with ``origins``, a comment at each key."""
        return self._core.toml(origins)

    def table(self) -> Table:
        """Key, value and origin of each value."""
        return Table(
            ["key", "value", "origin"],
            [[key, self[key], str(self.origin(key))] for key in self],
        )

    def __repr__(self) -> str:
        return f"<hwsim.Gpu {self.label}>"

    def _repr_html_(self) -> str:
        return f"<p><b>{self.title}</b> ({self.label})</p>" + self.table()._repr_html_()
