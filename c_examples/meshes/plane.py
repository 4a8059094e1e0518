"""The plane mesh of a body of one layer of hexahedra: plane.py BODY.msh PLANE.msh

It is the body's face `ymin`: x stays, z becomes y. Every other physical surface becomes the physical curve of its name.
"""

import sys

import meshio
import numpy as np

LAYER = "ymin"
SIDES = {LAYER, "ymax"}


def main(body, plane):
    mesh = meshio.read(body)
    groups = [
        (name, mesh.cells_dict["quad"][mesh.cell_sets_dict[name]["quad"]])
        for name in mesh.cell_sets_dict
        if "quad" in mesh.cell_sets_dict[name] and not name.startswith("gmsh:")
    ]
    cells = next(quads for name, quads in groups if name == LAYER)
    used = np.unique(cells)
    number = {node: k for k, node in enumerate(used, 1)}
    curves = [
        (name, [[number[n] for n in quad if n in number] for quad in quads]) for name, quads in groups if name not in SIDES
    ]
    names = [f'1 {tag} "{name}"' for tag, (name, _) in enumerate(curves, 1)] + [f'2 {len(curves) + 1} "body"']
    elements = [(1, tag, edge) for tag, (_, edges) in enumerate(curves, 1) for edge in edges]
    elements += [(3, len(curves) + 1, [number[n] for n in cell]) for cell in cells]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(used))]
    lines += [f"{number[n]} {mesh.points[n][0]:.17g} {mesh.points[n][2]:.17g} 0" for n in used]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{k} {kind} 2 {tag} {tag} {' '.join(map(str, nodes))}" for k, (kind, tag, nodes) in enumerate(elements, 1)]
    with open(plane, "w", encoding="ascii") as file:
        file.write("\n".join([*lines, "$EndElements", ""]))


if __name__ == "__main__":
    main(*sys.argv[1:])
