"""hwsim: a simulator of a GPU's graphics pipeline.

It draws an anti-aliasing technique on a scene once, which gives the picture and every count of work, and predicts from
the counts how long the frame takes on any GPU:

>>> import hwsim
>>> gpu = hwsim.gpu("gtx980")
>>> frame = hwsim.emulate("sponza_hall", "msaa4x", gpu, resolution=(640, 360))
>>> frame.time()
>>> frame.time(gpu.but(dram_bandwidth_gb_s="x2"))
>>> frame.gradient(gpu).strongest()
>>> frame.sweep({"l2_size_kib": [1024, 2048, 4096]})

The functions ask one lab that the package makes at the first call, from the environment; a :class:`Lab` of one's own has
the same methods. ``docs/python.md`` is the tutorial.
"""

from __future__ import annotations

from pathlib import Path as _Path
from typing import Any, Mapping, Sequence

import numpy as _np
import numpy.typing as _npt

from ._core import __version__
from ._errors import Diagnostic, InputError, InternalError
from ._frame import Frame, PassWork
from ._gpu import Gpu, KeyInfo, Origin, Value, gpu_keys
from ._lab import FileLike, GpuLike, Lab, Ranking, Scene, Validation
from ._progress import ProgressTo
from ._sweep import Sweep
from ._tables import Table
from ._timing import Comparison, Explanation, Gradient, PassTiming, Ratio, Timing, compare_timings, ratio
from ._view import SceneLike, View

__all__ = [
    "Comparison",
    "Diagnostic",
    "Explanation",
    "Frame",
    "Gpu",
    "Gradient",
    "InputError",
    "InternalError",
    "KeyInfo",
    "Lab",
    "Origin",
    "PassTiming",
    "PassWork",
    "Ranking",
    "Ratio",
    "Scene",
    "Sweep",
    "Table",
    "Timing",
    "Validation",
    "View",
    "__version__",
    "compare",
    "compare_timings",
    "counters",
    "default_lab",
    "doctor",
    "emulate",
    "gpu",
    "gpu_keys",
    "gpus",
    "overlays",
    "rank",
    "ratio",
    "reference",
    "report",
    "report_of",
    "scene",
    "scenes",
    "show_progress",
    "sweep",
    "techniques",
    "validate",
]

_default: Lab | None = None


def default_lab() -> Lab:
    """The lab that the package's functions ask; made at the first call."""
    global _default
    if _default is None:
        _default = Lab()
    return _default


def show_progress(to: ProgressTo = True) -> None:
    """Who the package's functions tell how far they are: True: a bar by tqdm; a function; False: nobody."""
    default_lab().progress = to


def gpus() -> Table:
    """The GPUs that come with hwsim, a row each. See :meth:`Lab.gpus`."""
    return default_lab().gpus()


def techniques() -> Table:
    """The techniques, a row each; they are combined by ``+``: "wire_aa+msaa4x+fxaa". See :meth:`Lab.techniques`."""
    return default_lab().techniques()


def scenes() -> Table:
    """The generators of scenes, a row each. A scene may also be a glTF file. See :meth:`Lab.scenes`."""
    return default_lab().scenes()


def overlays() -> Table:
    """The what-ifs that come with hwsim, a row each. See :meth:`Lab.overlays`."""
    return default_lab().overlays()


def counters() -> Table:
    """The counters, a row each: what one count is. See :meth:`Lab.counters`."""
    return default_lab().counters()


def gpu(gpu: GpuLike, *, calibrated: bool=True) -> Gpu:
    """A GPU by its id or by the path of its file (.toml); a Gpu is given back as it is. Raises InputError. See :meth:`Lab.gpu`."""
    return default_lab().gpu(gpu, calibrated=calibrated)


def scene(scene: SceneLike) -> Scene:
    """Name, cameras and the loader's notes of a scene. Raises InputError. See :meth:`Lab.scene`."""
    return default_lab().scene(scene)


def doctor() -> Table:
    """Whether hwsim works here: its files, its modules, its cache, a small simulation. See :meth:`Lab.doctor`."""
    return default_lab().doctor()


def emulate(
    scene: SceneLike,
    technique: str = "none",
    gpu: GpuLike = "gtx980",
    *,
    resolution: tuple[int, int] | None = None,
    camera: str | int | None = None,
    reference_samples: int = 0,
    images: bool = True,
    engine: str = "queue",
    settings: Mapping[str, Value] | None = None,
) -> Frame:
    """Draws a technique on a scene, once; the frame is then timed on any GPU. Raises InputError. See :meth:`Lab.emulate`."""
    return default_lab().emulate(
        scene,
        technique,
        gpu,
        resolution=resolution,
        camera=camera,
        reference_samples=reference_samples,
        images=images,
        engine=engine,
        settings=settings,
    )


def reference(scene: SceneLike, samples: int=64) -> _npt.NDArray[_np.float32]:
    """The ray-traced truth of a view: float32, (height, width, 4), linear RGBA. Raises InputError. See :meth:`Lab.reference`."""
    return default_lab().reference(scene, samples)


def rank(
    scene: SceneLike,
    techniques: str | Sequence[str],
    gpu: GpuLike = "gtx980",
    *,
    budget: str = "",
    reference_samples: int = 64,
    resolution: tuple[int, int] | None = None,
    camera: str | int | None = None,
    settings: Mapping[str, Value] | None = None,
) -> Ranking:
    """Which technique is best: time, memory and error of each, under a budget. Raises InputError. See :meth:`Lab.rank`."""
    return default_lab().rank(
        scene,
        techniques,
        gpu,
        budget=budget,
        reference_samples=reference_samples,
        resolution=resolution,
        camera=camera,
        settings=settings,
    )


def compare(
    scene: SceneLike,
    techniques: str | Sequence[str] = "none",
    gpus: str | Sequence[str] = "gtx980",
    *,
    what_if: str | Sequence[str] = (),
    resolution: tuple[int, int] | None = None,
    camera: str | int | None = None,
    settings: Mapping[str, Value] | None = None,
) -> Comparison:
    """Each technique on each GPU, as it is and below each what-if. Raises InputError. See :meth:`Lab.compare`."""
    return default_lab().compare(
        scene,
        techniques,
        gpus,
        what_if=what_if,
        resolution=resolution,
        camera=camera,
        settings=settings,
    )


def sweep(
    scene: SceneLike,
    techniques: str | Sequence[str] = "none",
    gpus: GpuLike | Sequence[GpuLike] = "gtx980",
    vary: Mapping[str, Sequence[Any]] | None = None,
    *,
    engine: str = "queue",
) -> Sweep:
    """Times over a grid of techniques, GPUs and whatever else varies. Raises InputError. See :meth:`Lab.sweep`."""
    return default_lab().sweep(scene, techniques, gpus, vary, engine=engine)


def report(
    file: FileLike,
    scene: SceneLike,
    techniques: str | Sequence[str] = "none",
    gpus: str | Sequence[str] = "gtx980",
    *,
    what_if: str | Sequence[str] = (),
    reference_samples: int = 16,
    resolution: tuple[int, int] | None = None,
    camera: str | int | None = None,
    settings: Mapping[str, Value] | None = None,
    force: bool = False,
) -> _Path:
    """One HTML page of techniques on GPUs, in which the hardware can be moved; returns its path. See :meth:`Lab.report`."""
    return default_lab().report(
        file,
        scene,
        techniques,
        gpus,
        what_if=what_if,
        reference_samples=reference_samples,
        resolution=resolution,
        camera=camera,
        settings=settings,
        force=force,
    )


def report_of(
    file: FileLike,
    results: FileLike | Sequence[FileLike],
    *,
    force: bool = False,
) -> _Path:
    """The page of what the program ``hwsim`` wrote: folders, a sweep's database, JSON. See :meth:`Lab.report_of`."""
    return default_lab().report_of(file, results, force=force)


def validate(papers: str | Sequence[str]=()) -> Validation:
    """Fits to published times, and tells the errors on those that a fit did not see. Takes minutes for all papers. See :meth:`Lab.validate`."""
    return default_lab().validate(papers)
