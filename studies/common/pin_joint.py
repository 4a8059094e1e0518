"""A lug, a fork and a pin of tetrahedra with clearance, which no guide holds."""

from scene import SCENES

MESHES = SCENES.parent / "meshes"
END = 4.0  # the area of the lug's pulled end
YOUNG = {"lug": 70000, "fork": 70000, "pin": 210000}


def pin_joint(traction, steps, **more):
    """Pulled at the lug's end; `more`: keys of every body."""
    scene = {
        "schema": 1,
        "bodies": list(YOUNG),
        "supports": ["root"],
        "root": {"surface": "fork.root", "components": ["x", "y", "z"]},
        "loads": ["pull"],
        "pull": {"surface": "lug.pull", "traction": list(traction)},
        "interfaces": ["inner", "outer"],
        "inner": {"nonmortar": "lug.hole", "mortar": "pin.side", "friction": 0.2},
        "outer": {"nonmortar": "fork.holes", "mortar": "pin.side", "friction": 0.2},
        "steps": {"count": steps},
    }
    return scene | {name: {"type": "gmsh", "file": str(MESHES / f"joint_{name}.msh"), "young": young, "poisson": 0.3} | more for name, young in YOUNG.items()}
