"""A lug, a fork and a pin of tetrahedra with clearance, which no guide holds; and a chain of two such joints."""

from scene import SCENES

MESHES = SCENES.parent / "meshes"
END = 4.0  # the area of the lug's pulled end
YOUNG = {"pin": 210000, "other": 70000}


def pulled(bodies, holes, end, traction, steps, more):
    """`bodies`: name -> its mesh; `holes`: interface -> surface of a hole and the pin in it; `end`: the surface that is pulled."""
    scene = {
        "schema": 1,
        "bodies": list(bodies),
        "supports": ["root"],
        "root": {"surface": "fork.root", "components": ["x", "y", "z"]},
        "loads": ["pull"],
        "pull": {"surface": end, "traction": list(traction)},
        "interfaces": list(holes),
        "steps": {"count": steps},
    }
    for name, (hole, pin) in holes.items():
        scene[name] = {"nonmortar": hole, "mortar": f"{pin}.side", "friction": 0.2}
    for name, mesh in bodies.items():
        young = YOUNG["pin" if mesh.startswith("pin") else "other"]
        scene[name] = {"type": "gmsh", "file": str(MESHES / f"joint_{mesh}.msh"), "young": young, "poisson": 0.3} | more
    return scene


def pin_joint(traction, steps, **more):
    """Pulled at the lug's end; `more`: keys of every body."""
    bodies = {"lug": "lug", "fork": "fork", "pin": "pin"}
    holes = {"inner": ("lug.hole", "pin"), "outer": ("fork.holes", "pin")}
    return pulled(bodies, holes, "lug.pull", traction, steps, more)


def pin_chain(traction, steps, **more):
    """A fork, a link and another fork, with a pin between each two; pulled at the end of the last one."""
    bodies = {"fork": "fork", "link": "link", "end": "end", "first": "pin", "second": "pin_2"}
    holes = {
        "forkholes": ("fork.holes", "first"),
        "linkleft": ("link.left", "first"),
        "linkright": ("link.right", "second"),
        "endholes": ("end.holes", "second"),
    }
    return pulled(bodies, holes, "end.pull", traction, steps, more)
