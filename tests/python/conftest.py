"""A lab with a cache of its own, and a scene of one triangle."""

import base64
import json
import struct
from pathlib import Path

import pytest

import hwsim

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def triangle(tmp_path_factory):
    """A glTF file with one triangle."""
    positions = struct.pack("<9f", -1, -1, 0, 1, -1, 0, 0, 1, 0)
    uri = "data:application/octet-stream;base64," + base64.b64encode(positions).decode()
    accessor = {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}
    gltf = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [accessor],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": uri}],
    }
    path = tmp_path_factory.mktemp("scene") / "triangle.gltf"
    path.write_text(json.dumps(gltf))
    return path


@pytest.fixture(scope="session")
def lab(tmp_path_factory):
    return hwsim.Lab(cache=tmp_path_factory.mktemp("cache"), jobs=2)


@pytest.fixture(scope="session")
def frame(lab, triangle):
    """The triangle with 4x MSAA, and its error."""
    return lab.emulate(triangle, "msaa4x", resolution=(64, 48), reference_samples=16)
