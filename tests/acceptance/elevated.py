"""The second-order mesh of a mesh of linear hexahedra: a node in the middle of each edge, and for hex27 of each face and
cell. Surfaces keep their names; the geometry stays that of the linear mesh, or is mapped."""

import itertools

import meshio
import numpy as np

from second_order import HEX_EDGES, HEX_FACES, TYPES

FACE_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]


def elevated(source, path, kind="hex20", move=lambda points: points):
    """Writes Gmsh's format 2.2, in which an element names its group itself; `move` maps the (n, 3) corners. Returns
    path."""
    mesh = meshio.read(source)
    corners_at = move(mesh.points.copy())
    points, numbers = [list(p) for p in corners_at], {}

    def between(corners):
        key = tuple(sorted(corners))
        if key not in numbers:
            numbers[key] = len(points)
            points.append(list(np.mean([corners_at[c] for c in corners], axis=0)))
        return numbers[key]

    def of_second_order(element):
        edges, faces = (HEX_EDGES, HEX_FACES) if len(element) == 8 else (FACE_EDGES, [(0, 1, 2, 3)])
        parts = [*edges] + ([*faces] if kind == "hex27" else [])
        nodes = [*element, *(between([element[k] for k in part]) for part in parts)]
        return nodes + ([between(element)] if kind == "hex27" and len(element) == 8 else [])

    groups = {int(tag): (int(dimension), name) for name, (tag, dimension) in mesh.field_data.items()}
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {tag} "{name}"' for tag, (dimension, name) in groups.items()]
    cell, face = TYPES[kind]
    elements, count = [], itertools.count(1)
    for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        for element, tag in zip(block.data, tags):
            nodes = " ".join(str(n + 1) for n in of_second_order(list(map(int, element))))
            elements.append(f"{next(count)} {cell if len(element) == 8 else face} 2 {tag} {tag} {nodes}")
    lines += ["$EndPhysicalNames", "$Nodes", str(len(points))]
    lines += [f"{k} {' '.join(repr(float(c)) for c in p)}" for k, p in enumerate(points, 1)]
    lines += ["$EndNodes", "$Elements", str(len(elements)), *elements, "$EndElements"]
    path.write_text("\n".join(lines) + "\n")
    return path
