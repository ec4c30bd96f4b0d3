"""Arguments of the wrong kind: told by the argument's name, before anything is asked of the module ``_core``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import islice
from typing import Any

__all__ = ["factor_of", "resolution_of", "settings_of", "text_of", "texts_of", "values_of"]

_MOST_VALUES = 1_000_000  # points of a sweep; an iterator that never ends is refused, too


def _kind(value: object) -> str:
    return type(value).__name__


def text_of(name: str, value: object) -> str:
    """A text, or a TypeError that names the argument."""
    if isinstance(value, str):
        return value
    raise TypeError(f"`{name}` must be one text (str), not {_kind(value)}")


def _listed(name: str, values: object, what: str) -> list[Any]:
    """The items of anything that gives some; a text or a mapping is none of them. One look: iterators are used up."""
    if isinstance(values, Iterable) and not isinstance(values, (str, bytes, Mapping)):
        try:
            items = list(islice(values, _MOST_VALUES + 1))
        except TypeError as error:  # an array without dimensions; an __iter__ that gives no iterator
            raise TypeError(f"`{name}` must be {what}, not {_kind(values)}: {error}") from None
        if len(items) > _MOST_VALUES:
            raise ValueError(f"`{name}` has more than {_MOST_VALUES} values")
        return items
    raise TypeError(f"`{name}` must be {what}, not {_kind(values)}")


def texts_of(name: str, values: object) -> list[str]:
    """One text or several, as a list; a TypeError that names the argument."""
    if isinstance(values, str):
        return [values]
    return [text_of(f"{name}[{i}]", v) for i, v in enumerate(_listed(name, values, "a text (str) or a list of texts"))]


def values_of(name: str, values: object) -> list[Any]:
    """The values of what varies: at least one. A TypeError or ValueError that names it."""
    items = _listed(name, values, "a list of values")
    if not items:
        raise ValueError(f"`{name}` has no values: the list is empty")
    return items


def settings_of(name: str, settings: object) -> dict[str, Any]:
    """Values by names; a TypeError that names the argument."""
    if settings is None:
        return {}
    if not isinstance(settings, Mapping):
        raise TypeError(f"`{name}` must be a mapping from names to values, not {_kind(settings)}")
    return {text_of(f"a name in {name}", key): value for key, value in settings.items()}


def factor_of(name: str, factor: object) -> float:
    """A number to multiply by; a TypeError that names the key."""
    is_complex = getattr(getattr(factor, "dtype", None), "kind", "") == "c"  # a real to NumPy, with a warning
    if not isinstance(factor, (str, bytes)) and getattr(factor, "ndim", 0) == 0 and not is_complex:
        try:
            return float(factor)  # type: ignore[arg-type]
        except (TypeError, ValueError, OverflowError):
            pass
    raise TypeError(f"the factor of `{name}` must be a number, not {_kind(factor)}")


def _pixels(value: Any) -> int | None:
    """A whole number, whatever its type; None for anything else."""
    try:
        return int(value) if not isinstance(value, (str, bytes)) and int(value) == value else None
    except (TypeError, ValueError, OverflowError):
        return None


def resolution_of(value: object) -> tuple[int, int]:
    """(width, height), also of "640x360"; a TypeError or ValueError that says so."""
    words = f"resolution is (width, height), e.g. (640, 360), not {value!r:.80}"
    sides: list[Any] = []
    if isinstance(value, str):
        sides = [int(side) for side in value.split("x") if side.isascii() and side.isdigit()]
        if len(sides) != 2 or value.count("x") != 1:
            raise ValueError(words)
    elif isinstance(value, Iterable) and not isinstance(value, (bytes, Mapping)):
        try:
            sides = list(islice(value, 3))
        except TypeError:
            raise TypeError(words) from None
    else:
        raise TypeError(words)
    if len(sides) != 2:
        raise ValueError(words)
    width, height = (_pixels(side) for side in sides)
    if width is None or height is None:
        raise TypeError(words)
    return (width, height)
