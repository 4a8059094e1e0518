"""Hertz' line contact on quadratic cells, three to four facets a half-width: the force against the analytic one.

A rigid parabola is pressed into a half-plane. Of it a piece is meshed, whose other sides follow Hertz' own field. So the
exact solution is that of the half-plane, and the force of the parabola is known."""

import numpy as np

import formulas
from scene import write
from second_order import SecondOrder

# Over all indentations: of multipliers at every node with three to four facets a half-width, of those at corners alone with
# six to eight, which are as many. With three to four they miss it: the check can fail.
FORCE_BOUND = 3e-3
KINDS = ("hex20", "hex27", "tet10")
YOUNG, POISSON = 1000.0, 0.3
SHEAR, PLANE = YOUNG / (2 * (1 + POISSON)), YOUNG / (1 - POISSON**2)
# So flat that the theory of small strain is the exact one: strains are a / R.
RADIUS = 400.0
# Half-widths over the size of a facet.
HALF_WIDTHS = np.linspace(3, 4, 8)
# Planes of nodes: facets of size 1, up to beyond the largest half-width, then ever larger ones.
ACROSS = [0, 1, 2, 3, 4, 5, 6, 7.5, 10, 13, 17]
# Of the parabola, whose facets do not match.
FACETS, WIDTH = 7, 5.5
# On the surface the square root of a negative number is to have a positive imaginary part, as inside: +0, not -0.
DIGITS = 15


def force(a):
    """of the parabola, per thickness"""
    return np.pi * PLANE * a * a / (4 * RADIUS)


def hertz_field(X, a):
    """Displacements under a pressure over the half-width a, which leave the parabola's lowest point where it was. With the
    depth d and the harmonic function F, of which F_dd is the pressure on the surface,
    2 G u_x = (1 - 2 nu) F_x + d F_xd,  2 G u_d = -2 (1 - nu) F_d + d F_dd."""
    depth = -X[:, 2]
    zeta = X[:, 0] + 1j * depth
    # The largest pressure over a; F_d = Re h, F_x = Im h.
    h, slope = formulas.elliptic_potential(zeta, a, PLANE / (2 * RADIUS))
    u = np.zeros_like(X)
    u[:, 0] = ((1 - 2 * POISSON) * h.imag + depth * slope.real) / (2 * SHEAR)
    u[:, 2] = (2 * (1 - POISSON) * h.real + depth * slope.imag) / (2 * SHEAR)
    return np.round(u, DIGITS)


def divided(planes, parts):
    """Each cell in so many."""
    return np.interp(np.arange(parts * (len(planes) - 1) + 1) / parts, np.arange(len(planes)), planes)


def follow(file, a, parts):
    """Writes what the nodes of the outer sides are to do, the far one and the lower one."""
    across, thick = divided(ACROSS, 2 * parts), (0, 0.5, 1)
    places = [(x, y, -ACROSS[-1]) for x in across for y in thick] + [(ACROSS[-1], y, -z) for z in across[:-1] for y in thick]
    X = np.array(places)
    np.savetxt(file, np.hstack([X, hertz_field(X, a)]), fmt="%.17g", header="X Y Z ux uy uz")


def parabola(p):
    x = WIDTH * p[0]
    return np.array([x, p[1], p[2] + x * x / (2 * RADIUS)])


def scene(driver, kind, a, parts):
    """Facets of size 1 / parts; the parabola, which is rigid, is quadratic for linear cells, too."""
    mesh = SecondOrder(kind if kind in KINDS else "hex20", (FACETS * parts, 1, 1), parabola)
    mesh = mesh.write_41(driver.output / f"parabola_{mesh.kind}_{parts}.msh")
    far = driver.output / f"far_{a:.3f}_{parts}.txt"
    follow(far, a, parts)
    common = {"young": YOUNG, "poisson": POISSON, "small_strain": True}
    across = divided(ACROSS, parts)
    block = {"type": "box", "x": across.tolist(), "y": [0, 1], "z": (-across[::-1]).tolist(), "cell": kind, **common}
    scene = {
        "schema": 1,
        "bodies": ["block", "parabola"],
        "block": block,
        "parabola": {"type": "gmsh", "file": mesh.name, **common},
        "surfaces": ["foot"],
        "foot": {"of": "block.zmax", "within": [0, 0, 0, WIDTH, 1, 0]},
        "supports": ["far", "middle", "strain", "rigid"],
        "far": {"surface": ["block.zmin", "block.xmax"], "components": ["x", "z"], "file": far.name},
        "middle": {"surface": "block.xmin", "components": ["x"]},
        "strain": {"body": "block", "components": ["y"]},
        "rigid": {"body": "parabola", "components": ["x", "y", "z"]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "foot", "mortar": "parabola.zmin", "weights": "reference"},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }
    return write(scene, driver.output / f"line_{kind}_{a:.3f}_{parts}.yaml")


def errors(driver, kind, space, basis="standard", parts=1):
    """of the force, relative, at each half-width; half of the parabola is there"""
    found = []
    for a in HALF_WIDTHS:
        path = scene(driver, kind, a, parts)
        options = ("-contact_multiplier_space", space, "-contact_basis", basis)
        run = driver.run(path, *options, label=f"{path.stem}_{space}_{basis}")
        found.append(2 * np.abs(run.resultant("contact")[2]) / force(a) - 1)
    return np.abs(found)


def quadratic_line(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    for kind in KINDS:
        for space, parts in (("sub", 1), ("corner", 2)):
            found = errors(driver, kind, space, parts=parts)
            what = f"Hertz' line, {kind}, {space}, {3 * parts} to {4 * parts} facets a half-width"
            verdicts.below(f"{what}: force, mean {found.mean():.1e}, worst", found.max(), FORCE_BOUND, "analytic")
    for basis in ("standard", "dual"):
        found = errors(driver, "hex20", "corner", basis)
        what = f"Hertz' line, hex20, corner, {basis}, 3 to 4 facets a half-width"
        verdicts.at_least(f"{what}: force, mean {found.mean():.1e}, worst", found.max(), FORCE_BOUND, "half as many multipliers")
