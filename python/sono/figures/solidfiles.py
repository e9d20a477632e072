"""Files of solids, for slicers and modellers: by trimesh, which reads them back, but for 3MF."""

from pathlib import PurePath
from typing import Any

from sono.figures import threemf
from sono.figures.solids import Solid
from sono.formats import FormatError, unpacked

FORMATS = ("stl", "obj", "ply", "glb", "3mf")
"""A suffix each. Those of .stl and .ply have all components in one body, the others a body for each."""

UNIT = {"glb": 1e-3}
"""A millimetre where that is not 1: glTF has metres."""


def by_suffix(name: str) -> str:
    """Return the format in which a file of this name is written. Raises `FormatError` for another suffix."""
    suffix = PurePath(unpacked(name.lower())).suffix
    if suffix[1:] not in FORMATS:
        known = ", ".join(f".{format}" for format in FORMATS)
        raise FormatError(
            f"{name}: {suffix or 'no suffix'} is no format of solids; the suffixes are: {known}"
        )
    return suffix[1:]


def content(solid: Solid, format: str) -> bytes:
    """Return the bytes of a file. Raises `FormatError` where trimesh is not installed."""
    meshes = {f"component {c}": mesh for c, mesh in enumerate(solid.components)}
    if format == "3mf":
        return threemf.write(meshes)
    trimesh = _trimesh()
    scene = trimesh.Scene()
    for name, mesh in meshes.items():
        vertices = mesh.vertices * UNIT.get(format, 1)
        body = trimesh.Trimesh(vertices, mesh.faces, process=False)
        scene.add_geometry(body, node_name=name, geom_name=name)
    data: bytes | str = scene.export(file_type=format)
    return data.encode() if isinstance(data, str) else data


def _trimesh() -> Any:
    try:
        import trimesh
    except ModuleNotFoundError:
        raise FormatError("solids but .3mf are written by trimesh; pip install 'sono[mesh]'") from None
    return trimesh
