"""The lab: what is asked of hwsim. The functions of the package ask one that the package makes by itself."""

from __future__ import annotations

import itertools
import os
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Iterable, Mapping, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._checks import settings_of, text_of, texts_of, values_of
from ._errors import Diagnostic
from ._frame import Frame
from ._gpu import Gpu, Value
from ._progress import Listener, ProgressTo
from ._sweep import Sweep
from ._tables import Table, table_of
from ._timing import Comparison
from ._view import SceneLike, View, view_of

__all__ = ["FileLike", "GpuLike", "Lab", "Ranking", "Scene", "Validation"]

GpuLike = Union[Gpu, str]
FileLike = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Scene:
    """What is known of a scene."""

    name: str
    content_hash: str  #: of everything that was read
    cameras: tuple[str, ...]
    notes: tuple[Diagnostic, ...]  #: what the loader ignored, made or clamped


class Ranking(Table):
    """Techniques on one scene and GPU, the best first: a table with a row a technique."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        table = data["table"]
        super().__init__([c for c, _ in table["columns"]], table["rows"], dict(table["columns"]))
        self._data = data["json"]

    @property
    def best(self) -> str | None:
        """The technique in front; None where its verdict is not "ok"."""
        return self[0]["technique"] if len(self) and self[0]["verdict"] == "ok" else None

    def to_dict(self) -> dict[str, Any]:
        """Everything, with the keys that ``hwsim rank --format json`` prints."""
        return dict(self._data)


class Validation:
    """Errors of predicted times on published times that a fit did not see."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._data = data

    @property
    def splits(self) -> Table:
        """A row a split, its baselines below it."""
        return table_of(self._data["splits"])

    @property
    def ratios(self) -> Table:
        """A row a split: errors of the ratios of two techniques' times."""
        return table_of(self._data["ratios"])

    @property
    def labels(self) -> Table:
        """A row a paper and a GPU, in sample."""
        return table_of(self._data["labels"])

    def to_dict(self) -> dict[str, Any]:
        """Everything, with the keys that ``hwsim validate --format json`` prints."""
        return dict(self._data["json"])

    def __repr__(self) -> str:
        return repr(self.splits)

    def _repr_html_(self) -> str:
        return self.splits._repr_html_() + self.labels._repr_html_()


def _installed_configs() -> str | None:
    """The configuration below the prefix that this package is installed in; None in a build folder."""
    if "HWSIM_CONFIG_DIR" in os.environ:
        return None
    for prefix in Path(__file__).resolve().parents:
        if (prefix / "share" / "hwsim" / "configs" / "gpus").is_dir():
            return str(prefix / "share" / "hwsim" / "configs")
    return None


def _free_place(file: FileLike, force: bool) -> Path:
    place = Path(file)
    if place.exists() and not force:
        raise FileExistsError(f"{place} is there already: force=True replaces it")
    return place


class Lab:
    """Answers questions, and keeps the scenes, traces and references that it has loaded.

    Methods work without the interpreter's lock, in ``jobs`` threads; those of several Python threads wait for each
    other. Ctrl-C raises KeyboardInterrupt at the next step of the work (a pass of a frame, a few points of a grid), and
    leaves nothing half done. Mistakes of a question raise InputError before anything is drawn.
    """

    def __init__(
        self,
        *,
        configs: str | os.PathLike[str] | None = None,
        cache: str | os.PathLike[str] | None = None,
        jobs: int | None = None,
        use_cache: bool = True,
        progress: ProgressTo = False,
    ) -> None:
        """Makes a lab.

        :param configs: folder of GPU files; default: HWSIM_CONFIG_DIR, else those that came with hwsim
        :param cache: folder for what can be made anew; default: HWSIM_CACHE, else ~/.cache/hwsim; "": none
        :param jobs: threads; default: one a processor. The results are the same for any number
        :param use_cache: False: work traces are neither read from the disk nor kept there
        :param progress: True: a bar by tqdm; a function of the share that is done and of what is being done
        """
        self._listener = Listener(progress)
        self._core = _core.Lab(
            _installed_configs() if configs is None else os.fspath(configs),
            None if cache is None else os.fspath(cache),
            jobs or os.cpu_count() or 1,
            use_cache,
            self._listener,
        )

    @property
    def progress(self) -> ProgressTo:
        """Who is told how far the work is; may be set."""
        return self._listener.to

    @progress.setter
    def progress(self, to: ProgressTo) -> None:
        self._listener.to = to

    # What there is

    def gpus(self) -> Table:
        """The GPUs that come with hwsim, a row each."""
        return table_of(self._core.table("gpus"))

    def techniques(self) -> Table:
        """The techniques, a row each; they are combined by ``+``: "wire_aa+msaa4x+fxaa"."""
        return table_of(self._core.table("techniques"))

    def scenes(self) -> Table:
        """The generators of scenes, a row each. A scene may also be a glTF file."""
        return table_of(self._core.table("scenes"))

    def overlays(self) -> Table:
        """The what-ifs that come with hwsim, a row each."""
        return table_of(self._core.table("overlays"))

    def counters(self) -> Table:
        """The counters, a row each: what one count is."""
        return table_of(self._core.table("counters"))

    def gpu(self, gpu: GpuLike, *, calibrated: bool = True) -> Gpu:
        """A GPU by its id or by the path of its file (.toml); a Gpu is given back as it is. Raises InputError.

        :param calibrated: with the fitted numbers, where there are; False: those of the documents
        """
        if isinstance(gpu, Gpu):
            return gpu
        return Gpu(self._core.gpu(text_of("gpu", gpu), [], [], calibrated), self)

    def scene(self, scene: SceneLike) -> Scene:
        """Name, cameras and the loader's notes of a scene. Raises InputError."""
        data = self._core.scene(self._words(view_of(scene, {}), []))
        notes = tuple(Diagnostic(**note) for note in data["notes"])
        return Scene(data["name"], data["content_hash"], tuple(data["cameras"]), notes)

    def doctor(self) -> Table:
        """Whether hwsim works here: its files, its modules, its cache, a small simulation."""
        return Table(["name", "ok", "wall_ms", "detail"], self._core.doctor())

    # What is asked

    def emulate(
        self,
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
        """Draws a technique on a scene, once; the frame is then timed on any GPU. Raises InputError.

        :param scene: a glTF file, a generator with its parameters, an image, or a View
        :param technique: one of :meth:`techniques`, with parameters ("agaa:c=3") and filters ("msaa4x+fxaa")
        :param gpu: whose features and limits the technique may use
        :param resolution: (width, height) in pixels, in place of the view's
        :param camera: name or index, in place of the view's
        :param reference_samples: rays a pixel of the reference that the picture is compared with; 0: none
        :param images: False: no picture and no heat map; a frame of the cache is then read faster
        :param engine: "queue", "roofline" or "detailed"
        :param settings: what ``--set`` takes: {"scene.lights": "complex", "emulator.skip": "none"}
        """
        view = view_of(scene, {"resolution": resolution, "camera": camera})
        how = {"reference_samples": reference_samples, "images": images, "engine": engine}
        on = self.gpu(gpu)
        words = self._words(view, [text_of("technique", technique)], how, settings)
        return Frame(self._core.emulate(words, on._core), on, self)

    def reference(self, scene: SceneLike, samples: int = 64) -> npt.NDArray[np.float32]:
        """The ray-traced truth of a view: float32, (height, width, 4), linear RGBA. Raises InputError."""
        picture: npt.NDArray[np.float32] = self._core.reference(self._words(view_of(scene, {}), []), samples)
        return picture

    def rank(
        self,
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
        """Which technique is best: time, memory and error of each, under a budget. Raises InputError.

        :param budget: "aa_ms<=1.5, extra_mib<=192"; empty: none
        """
        view = view_of(scene, {"resolution": resolution, "camera": camera})
        how = {"reference_samples": reference_samples, "images": False}
        words = self._words(view, texts_of("techniques", techniques), how, settings)
        return Ranking(self._core.rank(words, self.gpu(gpu)._core, text_of("budget", budget)))

    def compare(
        self,
        scene: SceneLike,
        techniques: str | Sequence[str] = "none",
        gpus: str | Sequence[str] = "gtx980",
        *,
        what_if: str | Sequence[str] = (),
        resolution: tuple[int, int] | None = None,
        camera: str | int | None = None,
        settings: Mapping[str, Value] | None = None,
    ) -> Comparison:
        """Each technique on each GPU, as it is and below each what-if. Raises InputError.

        GPUs with settings of their own are compared by :func:`hwsim.compare_timings`.

        :param what_if: names of :meth:`overlays`, each tried alone; "a+b" lays both
        """
        view = view_of(scene, {"resolution": resolution, "camera": camera})
        words = self._words(view, texts_of("techniques", techniques), {"images": False}, settings)
        return Comparison(self._core.compare(words, texts_of("gpus", gpus), texts_of("what_if", what_if)))

    def sweep(
        self,
        scene: SceneLike,
        techniques: str | Sequence[str] = "none",
        gpus: GpuLike | Sequence[GpuLike] = "gtx980",
        vary: Mapping[str, Sequence[Any]] | None = None,
        *,
        engine: str = "queue",
    ) -> Sweep:
        """Times over a grid of techniques, GPUs and whatever else varies. Raises InputError.

        Dimensions are "technique", "gpu", and the keys of ``vary``: "gpu.KEY", "technique.KEY", "scene.KEY" with
        values as ``--set`` takes them ("x2" for twice a number of the GPU), and the fields of a View, such as
        "resolution" and "camera". All points are checked before the first one is drawn, and each frame is drawn once.
        """
        grid = _Grid(self, view_of(scene, {}), texts_of("techniques", techniques), gpus, settings_of("vary", vary), engine)
        return grid.run()

    def report(
        self,
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
    ) -> Path:
        """One HTML page of techniques on GPUs, in which the hardware can be moved; returns its path.

        Raises InputError, and FileExistsError for a file that is there already.

        :param what_if: names of :meth:`overlays`, each tried alone: their changes are shown
        :param reference_samples: rays a pixel of the reference that the images are compared with; 0: none
        :param force: replace the file
        """
        place = _free_place(file, force)
        view = view_of(scene, {"resolution": resolution, "camera": camera})
        words = self._words(view, texts_of("techniques", techniques), {"reference_samples": reference_samples}, settings)
        again = f"hwsim.report({str(file)!r}, {view!r}, {techniques!r}, {gpus!r}, what_if={what_if!r})"
        self._core.report(words, texts_of("gpus", gpus), texts_of("what_if", what_if), str(place), again)
        return place

    def report_of(
        self,
        file: FileLike,
        results: FileLike | Sequence[FileLike],
        *,
        force: bool = False,
    ) -> Path:
        """The page of what the program ``hwsim`` wrote: folders of runs and rankings, a sweep's database, JSON.

        Returns its path. Raises InputError, and FileExistsError for a file that is there already.

        :param force: replace the file
        """
        place = _free_place(file, force)
        given = [results] if isinstance(results, (str, os.PathLike)) else list(results)
        inputs = [os.fspath(result) for result in given]
        self._core.report_of(inputs, str(place), f"hwsim.report_of({str(file)!r}, {inputs!r})")
        return place

    def validate(self, papers: str | Sequence[str] = ()) -> Validation:
        """Fits to published times, and tells the errors on those that a fit did not see. Takes minutes for all papers.

        :param papers: as their tables are called: "sbaa"; empty: all. Raises InputError
        """
        return Validation(self._core.validate(texts_of("papers", papers)))

    @staticmethod
    def _words(
        view: View,
        techniques: Sequence[str],
        how: Mapping[str, Any] | None = None,
        sets: Mapping[str, Value] | None = None,
    ) -> dict[str, Any]:
        return {
            "view": view.words(),
            "settings": dict(how or {}),
            "techniques": list(techniques),
            "sets": list(settings_of("settings", sets).items()),
        }


_VIEW_FIELDS = {f.name for f in fields(View)} - {"scene"}


class _Grid:
    """The points of a sweep: what must be drawn anew in the outer loops, numbers of GPUs in one call."""

    def __init__(
        self,
        lab: Lab,
        view: View,
        techniques: list[str],
        gpus: GpuLike | Sequence[GpuLike],
        vary: Mapping[str, Sequence[Any]],
        engine: str,
    ) -> None:
        self.lab, self.view, self.engine = lab, view, engine
        given = [gpus] if isinstance(gpus, (str, Gpu)) else values_of("gpus", gpus)
        self.gpus = [lab.gpu(gpu) for gpu in given]
        self.coords: dict[str, list[Any]] = {
            "technique": values_of("techniques", techniques),
            "gpu": [gpu.label for gpu in self.gpus],
            **{path: values_of(path, values) for path, values in vary.items()},
        }
        self.numbers = [path for path in vary if _is_number_of_gpu(path)]
        self.outer = [path for path in self.coords if path not in self.numbers]

    def run(self) -> Sweep:
        points = list(itertools.product(*(range(len(self.coords[path])) for path in self.outer)))
        for point in points:
            gpu, words = self._words(point)
            self.lab._core.check(words, [gpu._core])
        inner = {path[len("gpu.") :]: self.coords[path] for path in self.numbers}
        parts = [self._frame(point).sweep(inner) for point in points]
        arrays = {}
        for name in ("time_ms", "low_ms", "high_ms", "dram_mb"):
            arrays[name] = self._ordered([getattr(part, name) for part in parts])
        arrays["support"] = self._ordered([part.support_codes for part in parts])
        return Sweep(self.coords, arrays)

    def _words(self, point: Sequence[int]) -> tuple[Gpu, dict[str, Any]]:
        at = {path: self.coords[path][i] for path, i in zip(self.outer, point)}
        gpu = self.gpus[point[self.outer.index("gpu")]]
        gpu = gpu.but({path[len("gpu.") :]: v for path, v in at.items() if path.startswith("gpu.")})
        view = replace(self.view, **{path: v for path, v in at.items() if path in _VIEW_FIELDS})
        sets = {path: v for path, v in at.items() if "." in path and not path.startswith("gpu.")}
        how = {"images": False, "engine": self.engine}
        return gpu, self.lab._words(view, [at["technique"]], how, sets)

    def _frame(self, point: Sequence[int]) -> Frame:
        gpu, words = self._words(point)
        return Frame(self.lab._core.emulate(words, gpu._core), gpu, self.lab)

    def _ordered(self, parts: Iterable[npt.NDArray[Any]]) -> npt.NDArray[Any]:
        """One array with the dimensions in the order of the coordinates."""
        names = [*self.outer, *self.numbers]
        shape = [len(self.coords[name]) for name in names]
        array = np.array([part.ravel() for part in parts]).reshape(shape)
        return array.transpose([names.index(name) for name in self.coords])


def _is_number_of_gpu(path: str) -> bool:
    """Whether an axis changes times alone, not the work."""
    return path.startswith("gpu.") and not path.startswith(("gpu.features.", "gpu.functional."))
