"""Files of solids, for slicers and modellers: by trimesh, which reads them back, but for 3MF."""

from pathlib import PurePath

from sono.figures import threemf
from sono.figures.plot.sheet import colour
from sono.figures.solids import Solid
from sono.formats import FormatError, save, unpacked

FORMATS = ("stl", "obj", "ply", "glb", "3mf")
"""A suffix each. Those of .stl and .ply have all components in one body, the others a body for each, and
.glb and .3mf their colours."""

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


def write(path: str, solid: Solid, format: str) -> None:
    """Write a file. Raises `FormatError` where it cannot be written, or trimesh is not installed."""
    meshes = {f"component {c}": mesh for c, mesh in enumerate(solid.components)}
    if format == "3mf":
        return save(path, threemf.write(meshes))
    try:
        import trimesh
    except ModuleNotFoundError:
        cure = "pip install 'sono[mesh]', or name a file .3mf"
        raise FormatError(f"{path}: is written by trimesh; {cure}") from None
    scene = trimesh.Scene()
    for c, (name, mesh) in enumerate(meshes.items()):
        vertices = mesh.vertices * UNIT.get(format, 1)
        body = trimesh.Trimesh(vertices, mesh.faces, process=False)
        if format == "glb":
            paint = trimesh.visual.material.PBRMaterial(
                baseColorFactor=_linear(colour(c)), metallicFactor=0.0
            )
            body.visual = trimesh.visual.TextureVisuals(material=paint)
        scene.add_geometry(body, node_name=name, geom_name=name)
    return save(path, scene.export(file_type=format))


def _linear(colour: str) -> list[float]:
    """Return the red, green, blue and opacity of a colour as glTF has them."""
    return [(int(colour[k : k + 2], 16) / 255) ** 2.2 for k in (1, 3, 5)] + [1.0]
