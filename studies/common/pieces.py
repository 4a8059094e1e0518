"""The mesh of a run on several ranks, from the files of all of them: vertices, cells and fields in the order of one rank."""

import re

import numpy as np


def read(path):
    """What meshio.read() gives of a .vtu: of a .pvtu the pieces that it names, put together by their fields `node` and `cell`,
    which are left out then. Cells of one kind that follow each other are a block."""
    import meshio

    paths = [path.parent / name for name in re.findall(r'<Piece Source="([^"]+)"', path.read_text())]
    pieces = [meshio.read(each) for each in paths if not _is_empty(each)]
    nodes = [np.asarray(piece.point_data["node"]).ravel() for piece in pieces]
    n_nodes = 1 + max(each.max() for each in nodes)
    points, point_data = _scatter([p.points for p in pieces], nodes, n_nodes), {}
    for name in pieces[0].point_data:
        if name != "node":
            point_data[name] = _scatter([p.point_data[name] for p in pieces], nodes, n_nodes)
    cells, cell_data = _cells(pieces, nodes)
    return meshio.Mesh(points, cells, point_data=point_data, cell_data=cell_data)


def _is_empty(path):
    """Of more ranks than cells some have none, which meshio does not read."""
    with open(path) as text:
        return any('NumberOfCells="0"' in line for _, line in zip(range(10), text))


def _scatter(values, numbers, n):
    out = np.zeros((n, *np.shape(values[0])[1:]), dtype=np.asarray(values[0]).dtype)
    for value, number in zip(values, numbers):
        out[number] = value
    return out


def _cells(pieces, nodes):
    names = [name for name in pieces[0].cell_data if name != "cell"]
    rows = []  # number, kind, vertices, fields
    for piece, node in zip(pieces, nodes):
        for b, block in enumerate(piece.cells):
            numbers = np.asarray(piece.cell_data["cell"][b]).ravel()
            for k, number in enumerate(numbers):
                rows.append((number, block.type, node[block.data[k]], [piece.cell_data[name][b][k] for name in names]))
    rows.sort(key=lambda row: row[0])
    cells, data, start = [], {name: [] for name in names}, 0
    for k in range(1, len(rows) + 1):
        if k < len(rows) and rows[k][1] == rows[start][1]:
            continue
        block = rows[start:k]
        cells.append((block[0][1], np.array([row[2] for row in block])))
        for i, name in enumerate(names):
            data[name].append(np.array([row[3][i] for row in block]))
        start = k
    return cells, data
