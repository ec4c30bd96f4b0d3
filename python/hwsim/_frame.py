"""A frame that was emulated once: pictures, counts, and its time on any GPU."""

from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _core
from ._checks import settings_of, values_of
from ._gpu import Gpu, Value
from ._sweep import Sweep
from ._tables import Table
from ._timing import Explanation, Gradient, Timing

if TYPE_CHECKING:
    from ._lab import Lab

__all__ = ["Frame", "PassWork"]


class PassWork:
    """The counted work of one pass, whatever the GPU."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self.name: str = data["name"]
        self.kind: str = data["kind"]  #: "draw", "full_screen", "compute", "clear", "copy" or "resolve"
        self.counters: dict[str, int] = data["counters"]  #: by id: the counts of :func:`hwsim.counters`

    def __repr__(self) -> str:
        return f"<hwsim.PassWork {self.name} ({self.kind})>"


class Frame:
    """A technique on a scene, emulated once by :func:`hwsim.emulate`.

    Its work does not depend on clocks, unit counts, caches or DRAM, so it is timed on any GPU in less than a
    millisecond. A GPU with other features or limits (``features.*``, ``functional.*``) would do other work: for
    such a one the methods emulate once more, and keep what they got. Pictures are those of the GPU that the frame was
    emulated for.
    """

    def __init__(self, core: _core.Frame, gpu: Gpu, lab: Lab) -> None:
        self._core = core
        self._drawn = [core]
        self._works: dict[int, object] = {}
        self._lab = lab
        self._facts = core.facts()
        self.gpu = gpu  #: the GPU that it was emulated for

    # Pictures

    @property
    def image(self) -> npt.NDArray[np.float32]:
        """The picture: float32, (height, width, 4), linear RGBA, row 0 on top.

        Read-only, and no copy: it shows the emulator's own memory, which lives as long as the array.
        """
        return self._picture(self._core.image)

    @property
    def image_srgb(self) -> npt.NDArray[np.uint8]:
        """The picture as a file holds it: uint8, (height, width, 3), sRGB, row 0 on top. A copy."""
        return self._picture(self._core.srgb())

    @property
    def shading_heat(self) -> npt.NDArray[np.float32]:
        """Fragment shader invocations of each pixel over all passes, without helpers: float32, (height, width).

        Read-only, no copy.
        """
        return self._picture(self._core.shading_heat)

    @property
    def flip_map(self) -> npt.NDArray[np.float32] | None:
        """The FLIP error of each pixel, 0 to 1: float32, (height, width). Read-only, no copy.

        None unless the frame was emulated with ``reference_samples``. Raises ValueError without pictures
        (``images=False``), as the others do.
        """
        if self._core.image is None:
            self._picture(None)
        picture: npt.NDArray[np.float32] | None = self._core.flip_map
        return picture

    @property
    def error(self) -> dict[str, float] | None:
        """The error against the ray-traced reference: flip_mean, flip_median, flip_p99, psnr_db, rmse, ssim.

        None unless the frame was emulated with ``reference_samples``.
        """
        return self._core.error()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture: .png (sRGB, 8 bit) or .exr (linear half floats). Raises InputError."""
        self._picture(self._core.image)
        self._core.save(os.fspath(path))

    @staticmethod
    def _picture(array: npt.NDArray[Any] | None) -> npt.NDArray[Any]:
        if array is None:
            raise ValueError("the frame was emulated without pictures (images=False)")
        return array

    # Work

    @property
    def scene(self) -> str:
        """The scene's name."""
        return str(self._facts["scene"])

    @property
    def technique(self) -> str:
        """As :func:`hwsim.emulate` took it, without defaults: "msaa4x", "agaa:c=3"."""
        return str(self._facts["technique"])

    @property
    def resolution(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        width, height = self._facts["resolution"]
        return (width, height)

    @property
    def memory_bytes(self) -> int:
        """The most bytes that attachments and buffers take at once."""
        return int(self._facts["memory_bytes"])

    @property
    def from_cache(self) -> bool:
        """Whether the work was counted before, by this process or an earlier one."""
        return bool(self._facts["from_cache"])

    @property
    def passes(self) -> list[PassWork]:
        """The passes in order, each with its counters."""
        return [PassWork(data) for data in self._core.passes()]

    @property
    def counters(self) -> dict[str, int]:
        """Each counter's sum over all passes, by id; :func:`hwsim.counters` says what one count is."""
        total: dict[str, int] = {}
        for work in self.passes:
            for name, count in work.counters.items():
                total[name] = total.get(name, 0) + count
        return total

    def counter_table(self) -> Table:
        """A row a counter that counted anything, a column a pass."""
        passes = self.passes
        names = [name for name, count in self.counters.items() if count]
        rows = [[name, *(work.counters[name] for work in passes)] for name in names]
        return Table(["counter", *(f"{i}: {work.name}" for i, work in enumerate(passes))], rows)

    # Times

    def _for(self, gpu: Gpu) -> _core.Frame:
        for core in self._drawn:
            if core.is_work_of(gpu._core):
                return core
        self._drawn.append(self._lab._core.frame_for(self._core, gpu._core))
        return self._drawn[-1]

    def _work_of(self, core: _core.Frame) -> object:
        """What stands for one of the drawn frames in timings, which must not keep its images."""
        return self._works.setdefault(id(core), object())

    def _gpu(self, gpu: Gpu | str | None) -> Gpu:
        return self.gpu if gpu is None else self._lab.gpu(gpu)

    def time(self, gpu: Gpu | str | None = None) -> Timing:
        """The time on a GPU; without one, on the GPU that the frame was emulated for. Raises InputError."""
        on = self._gpu(gpu)
        core = self._for(on)
        return Timing(core.time(on._core), on, self._work_of(core))

    def times(self, gpus: Iterable[Gpu | str]) -> list[Timing]:
        """The time on each GPU."""
        return [self.time(gpu) for gpu in gpus]

    def gradient(self, gpu: Gpu | str | None = None) -> Gradient:
        """d ln(time) / d ln(value) for every real number of the GPU that enters times: exact, in one replay."""
        on = self._gpu(gpu)
        return Gradient(self._for(on).gradient(on._core))

    def explain(self, gpu: Gpu | str | None = None) -> Explanation:
        """Why the frame takes its time: stacks, headroom by unit, sensitivities with doubled values."""
        on = self._gpu(gpu)
        core = self._for(on)
        return Explanation(core.explain(on._core), on, self._work_of(core))

    def sweep(self, vary: Mapping[str, Sequence[Value]], gpu: Gpu | str | None = None) -> Sweep:
        """The times over a grid of a GPU's keys, in the lab's threads: below half a millisecond a point.

        >>> frame.sweep({"crop_units": ["x0.5", "x1", "x2"], "dram_bandwidth_gb_s": np.linspace(100, 400, 50)})

        ``"x2"`` stands for twice what the GPU has. Dimensions are the keys, in order. Raises InputError for points
        that are no GPU, and for keys of features and limits, which :meth:`hwsim.Lab.sweep` takes.
        """
        on = self._gpu(gpu)
        given = {key: values_of(key, values) for key, values in settings_of("vary", vary).items()}
        axes = [(f"gpu.{key}", values) for key, values in given.items()]
        return Sweep(given, self._lab._core.time_variants(self._for(on), on._core, axes))

    # Shown

    def __repr__(self) -> str:
        width, height = self.resolution
        return f"<hwsim.Frame {self.technique} of {self.scene}, {width}x{height}, for {self.gpu.label}>"

    def _repr_png_(self) -> bytes | None:
        if self._core.image is None:
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "frame.png")
            self._core.save(path)
            with open(path, "rb") as file:
                return file.read()
