"""What goes wrong: mistakes of the input with their places and remedies, and laws that hwsim itself broke."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Mapping, Sequence

__all__ = ["Diagnostic", "InputError", "InternalError"]


@dataclass(frozen=True)
class Diagnostic:
    """A message about the input: what is wrong, where, what was meant, how to go on."""

    severity: str  #: "note", "warning" or "error"
    code: str  #: stable, such as "C012"; ``hwsim help C012`` explains it
    message: str  #: one sentence
    file: str  #: the file, or what was given; empty where there is no place
    line: int  #: from 1; 0: unknown
    column: int  #: from 1; 0: unknown
    hint: str  #: "did you mean `l2_size_kib`?"
    notes: tuple[str, ...]
    help: str  #: the remedy
    text: str  #: all of it, as the program prints it

    def __str__(self) -> str:
        return self.text.rstrip("\n")


class InputError(ValueError):
    """A mistake in what was asked. Nothing was drawn or written.

    ``diagnostics`` holds every problem found, the first cause first.
    """

    diagnostics: tuple[Diagnostic, ...]

    def __init__(self, diagnostics: Sequence[Diagnostic | Mapping[str, Any]]) -> None:
        self.diagnostics = tuple(
            d if isinstance(d, Diagnostic) else Diagnostic(**d) for d in diagnostics
        )
        super().__init__("\n" + "\n".join(str(d) for d in self.diagnostics))

    @property
    def codes(self) -> tuple[str, ...]:
        """The codes of the diagnostics: ``("C012", "C014")``."""
        return tuple(d.code for d in self.diagnostics)

    def __reduce__(self) -> tuple[Any, ...]:
        return (InputError, (list(self.diagnostics),))


class InternalError(RuntimeError):
    """hwsim broke one of its own laws: please report the message."""
