"""3MF files: a zip of XML, in millimetres, one object, whose parts are the components, each in its colour.

Slicers ask whether several objects are one, and else drop each to the bed by itself. Written here, since
others put the time and random numbers in. Source: 3MF Core Specification 1.3, chapter 4.
"""

import io
import zipfile
from collections.abc import Mapping

from sono.figures.plot.sheet import colour
from sono.figures.tube import Mesh

_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'

_TYPES = f"""{_HEAD}<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"""

_RELATIONS = f"""{_HEAD}<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Id="model" Target="/3D/3dmodel.model"
 Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"""


def write(meshes: Mapping[str, Mesh]) -> bytes:
    """Return the file of these meshes, by their names; the same ones give the same bytes."""
    parts = {"[Content_Types].xml": _TYPES, "_rels/.rels": _RELATIONS, "3D/3dmodel.model": _model(meshes)}
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name, text in parts.items():
            archive.writestr(zipfile.ZipInfo(name), text, zipfile.ZIP_DEFLATED)
    return file.getvalue()


def _model(meshes: Mapping[str, Mesh]) -> str:
    paints = "".join(f'<base name="{name}" displaycolor="{colour(k)}"/>\n' for k, name in enumerate(meshes))
    objects = "".join(_object(k, name, mesh) for k, (name, mesh) in enumerate(meshes.items()))
    parts = "".join(f'<component objectid="{k + 2}"/>\n' for k in range(len(meshes)))
    last = len(meshes) + 1
    if len(meshes) > 1:
        last += 1
        objects += f'<object id="{last}" type="model">\n<components>\n{parts}</components>\n</object>\n'
    core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    return (
        f'{_HEAD}<model unit="millimeter" xml:lang="en" xmlns="{core}">\n'
        f'<resources>\n<basematerials id="1">\n{paints}</basematerials>\n{objects}</resources>\n'
        f'<build>\n<item objectid="{last}"/>\n</build>\n</model>\n'
    )


def _object(k: int, name: str, mesh: Mesh) -> str:
    vertices = "".join(f'<vertex x="{x:.6f}" y="{y:.6f}" z="{z:.6f}"/>\n' for x, y, z in mesh.vertices)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>\n' for a, b, c in mesh.faces)
    return (
        f'<object id="{k + 2}" name="{name}" type="model" pid="1" pindex="{k}">\n'
        f"<mesh>\n<vertices>\n{vertices}</vertices>\n"
        f"<triangles>\n{triangles}</triangles>\n</mesh>\n</object>\n"
    )
