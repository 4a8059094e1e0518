"""A lug, a fork and a pin of tetrahedra with clearance, which no guide holds; and a chain of two such joints."""

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


def pin_chain(traction, steps, **more):
    """A fork, a link and another fork, with a pin between each two; pulled at the end of the last one."""
    scene = pin_joint(traction, steps, **more)
    bodies = {"fork": "fork", "link": "link", "end": "end", "first": "pin", "second": "pin_2"}
    pins = (("fork.holes", "first"), ("link.left", "first"), ("link.right", "second"), ("end.holes", "second"))
    for old in YOUNG | dict.fromkeys(("inner", "outer")):
        del scene[old]
    for name, file in bodies.items():
        young = YOUNG["pin" if file.startswith("pin") else "fork"]
        scene[name] = {"type": "gmsh", "file": str(MESHES / f"joint_{file}.msh"), "young": young, "poisson": 0.3} | more
    names = [hole.replace(".", "") for hole, _ in pins]
    for name, (hole, pin) in zip(names, pins):
        scene[name] = {"nonmortar": hole, "mortar": f"{pin}.side", "friction": 0.2}
    scene["pull"] = scene["pull"] | {"surface": "end.pull"}
    return scene | {"bodies": list(bodies), "interfaces": names}
