"""Meshes that the driver's boxes cannot make, in Gmsh's format 4.1."""

import itertools

import numpy as np

# A cube in six tetrahedra around its diagonal: one for each order in which the axes are walked from corner to corner.
ORDERS = list(itertools.permutations(range(3)))
FACES = {"xmin": (0, 0), "xmax": (0, 1), "ymin": (1, 0), "ymax": (1, 1), "zmin": (2, 0), "zmax": (2, 1)}


def box_tets(path, lower, upper, cells, move=None):
    """A box of tetrahedra with the surfaces xmin to zmax; `move` maps the (n, 3) positions of its nodes. Returns
    path."""
    axes = [np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, cells)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    number = np.arange(grid[..., 0].size).reshape(grid.shape[:3])
    tets = []
    for base in itertools.product(*map(range, cells)):
        for order in ORDERS:
            corner, tet = np.array(base), [number[base]]
            for axis in order:
                corner = corner + np.eye(3, dtype=int)[axis]
                tet.append(number[tuple(corner)])
            # odd permutations are left-handed
            tets.append(tet if np.linalg.det(np.eye(3)[list(order)]) > 0 else [tet[1], tet[0], *tet[2:]])
    surfaces = {}
    for name, (axis, end) in FACES.items():
        on = set(np.take(number, -end, axis=axis).ravel())
        surfaces[name] = [f for tet in tets for f in itertools.combinations(tet, 3) if on.issuperset(f)]
    points = grid.reshape(-1, 3)
    return write(path, move(points.copy()) if move else points, tets, surfaces)


def write(path, points, tets, surfaces):
    """Format 4.1, in which a physical name belongs to an entity: one volume, and one surface for each name."""
    names = list(surfaces)
    box = " ".join(repr(float(v)) for v in (*points.min(axis=0), *points.max(axis=0)))
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names) + 1)]
    lines += [f'2 {k} "{name}"' for k, name in enumerate(names, 1)] + ['3 99 "body"', "$EndPhysicalNames"]
    lines += ["$Entities", f"0 0 {len(names)} 1"]
    lines += [f"{k} {box} 1 {k} 0" for k in range(1, len(names) + 1)] + [f"1 {box} 1 99 0", "$EndEntities"]
    n = len(points)
    lines += ["$Nodes", f"1 {n} 1 {n}", f"3 1 0 {n}", *map(str, range(1, n + 1))]
    lines += [" ".join(repr(float(x)) for x in point) for point in points] + ["$EndNodes"]
    blocks = [(2, k, 2, surfaces[name]) for k, name in enumerate(names, 1)] + [(3, 1, 4, tets)]
    total, tag = sum(len(block[3]) for block in blocks), 0
    lines += ["$Elements", f"{len(blocks)} {total} 1 {total}"]
    for dimension, entity, kind, elements in blocks:
        lines.append(f"{dimension} {entity} {kind} {len(elements)}")
        for element in elements:
            tag += 1
            lines.append(" ".join(map(str, (tag, *(int(node) + 1 for node in element)))))
    lines.append("$EndElements")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n")
    return path
