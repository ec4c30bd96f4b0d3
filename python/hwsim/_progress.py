"""What is told while a lab works: progress to a bar or a function, notes to the module ``logging``."""

from __future__ import annotations

import logging
from typing import Any, Callable, Union

__all__ = ["ProgressTo"]

#: True: a bar by the package tqdm; a function: it is called with the share that is done, 0 to 1, and what is being done.
ProgressTo = Union[bool, Callable[[float, str], None]]

_LOGGER = logging.getLogger("hwsim")
_LEVELS = {"debug": logging.DEBUG, "info": logging.INFO, "warning": logging.WARNING}


class Listener:
    """Who a lab tells. Called in the thread that asked, about twenty times a second."""

    def __init__(self, progress: ProgressTo) -> None:
        self.to = progress
        self._bar: Any = None

    def log(self, level: str, text: str) -> None:
        _LOGGER.log(_LEVELS[level], "%s", text.rstrip("\n"))

    def progress(self, done_ratio: float, what: str) -> None:
        if callable(self.to):
            self.to(done_ratio, what)
        elif self.to:
            self._show(done_ratio, what)

    def _show(self, done_ratio: float, what: str) -> None:
        if self._bar is None:
            from tqdm import tqdm

            self._bar = tqdm(total=100, bar_format="{l_bar}{bar}| {elapsed} {desc}", leave=False)
        self._bar.n = round(100 * done_ratio)
        self._bar.set_description_str(what)

    def ended(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None
