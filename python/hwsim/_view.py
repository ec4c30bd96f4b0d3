"""What is drawn: scene, camera, lights."""

from __future__ import annotations

import os
from dataclasses import dataclass, fields, replace
from typing import Any, Mapping, Union

from ._checks import resolution_of

__all__ = ["SceneLike", "View", "view_of"]


@dataclass(frozen=True)
class View:
    """What is drawn, before any technique."""

    scene: str  #: a .gltf or .glb file, a generator with parameters ("grass:seed=3"), or an image
    resolution: tuple[int, int] = (1280, 720)  #: (width, height) in pixels, each 1 to 16384; "1280x720" becomes it
    camera: str | int = 0  #: name or index of a camera of the scene, or "eye=1,2,3 target=0,0,0 fov=60"
    point_lights: int = 0  #: seeded lights that are added, 0 to 1024
    light_range: float = 0.15  #: reach of lights that are added, over the scene's diagonal
    light_strength: float = 1.0  #: factor on their light
    light_range_from: float = 0.0  #: least reach of an added light, in the scene's unit
    light_range_to: float = 0.0  #: greatest reach; 0: all have ``light_range``
    light_box_x: float = 0.0  #: side of the box that added lights lie in; 0: the scene's own
    light_box_y: float = 0.0  #: the same along y
    light_box_z: float = 0.0  #: the same along z
    light_seed: int = 0  #: another number: other places and colors of added lights
    lights: str = "scene"  #: "scene", "simple" (one light), "complex" (16 lights) or "added"
    shadows: bool = True  #: a shadow map for the light that casts shadows
    shadow_map_px: int = 2048  #: side of the shadow map
    metal_ambient: bool = True  #: metals reflect ambient light
    anisotropy: int = 1  #: probes of a texture request at most, 1 to 16
    alpha_test: bool = True  #: alpha-tested surfaces have holes
    reference_shadows: str = "map"  #: the reference's shadows: "map" or "rays"
    exposure: float = 0.0  #: factor of the file's lights; 0: automatic
    memory_mib: int = 2048  #: memory that loading the scene may take

    def __post_init__(self) -> None:
        object.__setattr__(self, "resolution", resolution_of(self.resolution))

    def words(self) -> dict[str, Any]:
        """By the names of ``run.toml``."""
        words = {f.name: getattr(self, f.name) for f in fields(self)}
        words["width_px"], words["height_px"] = words.pop("resolution")
        words["camera"] = str(self.camera)
        words["scene"] = _path(self.scene)
        return words


def _path(scene: object) -> str:
    if isinstance(scene, (str, bytes, os.PathLike)):
        return os.fsdecode(scene)
    raise TypeError(f"`scene` must be a text (str), a path or a View, not {type(scene).__name__}")


SceneLike = Union[View, str, "os.PathLike[str]"]


def view_of(scene: SceneLike, changes: Mapping[str, Any]) -> View:
    given = {name: value for name, value in changes.items() if value is not None}
    view = scene if isinstance(scene, View) else View(_path(scene))
    return replace(view, **given)
