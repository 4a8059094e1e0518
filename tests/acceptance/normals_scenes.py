"""Scenes of the groups `normals` and `normals_full` that are none of the examples: a ball dragged over a slab along an arc,
and a ring of few facets pressed deep into a slab and dragged."""

STIFF, SOFT = 100, 1  # Young's moduli


def box(young, **keys):
    return {"type": "box", "young": young, "poisson": 0.3, "material": "neo_hooke"} | keys


def dragged_ball(steps, friction, normals="auto", depth=0.2, angle=1.0, arm=1.5):
    """Half a ball of radius 1, stiff, is pressed into a soft slab by `depth` in four steps, then dragged along an arc of
    radius `arm` through `angle`."""
    return {
        "schema": 1,
        "bodies": ["slab", "ball"],
        "slab": box(SOFT, lower=[-1.2, -1.2, -1.2], upper=[2.4, 2.4, 0], cells=[12, 12, 3]),
        "ball": box(STIFF, ball=[0, 0, 1], lower=[-1, -1, 0], upper=[1, 1, 1], cells=[10, 10, 4]),
        "supports": ["ground", "path"],
        "ground": {"surface": "slab.zmin", "components": ["x", "y", "z"]},
        "path": {
            "surface": "ball.zmax",
            "components": ["x", "y", "z"],
            "value": [0, 0, -depth],
            "curve": [0, 0, 1, 1],
            "rotate": [0, 0, angle],
            "origin": [0, arm, 0],
            "rotate_curve": [1, 0, 2, 1],
        },
        "interfaces": ["contact"],
        "contact": {"nonmortar": "slab.zmax", "mortar": "ball.zmin", "friction": friction, "normals": normals},
        "steps": {"stages": [1, 4, 2, steps]},
        "output": {"vtu": "none", "csv": "none"},
    }


def ring(facets, depth, step, friction, normals, travel=2.0):
    """Half a ring of radius 1 of so many facets all round, stiff, in plane strain, is pressed into a soft slab by `depth`
    in four steps, then dragged along it in steps of `step`."""
    return {
        "schema": 1,
        "bodies": ["slab", "ring"],
        "slab": box(SOFT, lower=[-2, -2.5, 0], upper=[4, -1, 0.2], cells=[30, 8, 1]),
        "ring": box(STIFF, polar=True, lower=[0.4, 180, 0], upper=[1, 360, 0.2], cells=[2, facets // 2, 1]),
        "supports": ["flat", "ground", "down", "along"],
        "flat": {"body": ["slab", "ring"], "components": ["z"]},
        "ground": {"surface": "slab.ymin", "components": ["x", "y"]},
        "down": {"surface": "ring.xmin", "components": ["y"], "value": [0, -depth, 0], "curve": [0, 0, 1, 1]},
        "along": {"surface": "ring.xmin", "components": ["x"], "value": [travel, 0, 0], "curve": [1, 0, 2, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "slab.ymax", "mortar": "ring.xmax", "friction": friction, "normals": normals},
        "steps": {"stages": [1, 4, 2, round(travel / step)]},
        "output": {"vtu": "none", "csv": "none"},
    }
