"""The same meshes in other programs: a problem as every one of them takes it, and what is run of each. `make compare`.

A Case is a mesh of hexahedra (of 20 nodes, too, for CalculiX) with two bodies, supports, nodal loads and the two faces in contact, read from what the
example driver wrote. A peer gives back nodal displacements; nodal contact forces follow from them, for all programs by
the same elements (eight nodes, 2 x 2 x 2 points, small strain).
"""

import hashlib
import re
import shutil
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

# Faces of a hexahedron, counter-clockwise from inside, by CalculiX' numbers.
FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
CORNERS = np.array([(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
# Penalty over the modulus per length 1: the manual's advice is 5 to 50 times; the largest is the most exact.
PENALTY = 50.0
TIMEOUT = 600
# CalculiX' element by the number of nodes; the one of 20 with reduced integration, its usual choice.
CALCULIX_CELLS = {8: "C3D8", 20: "C3D20R"}


class Missing(Exception):
    """A program that is not installed."""


@dataclass
class Case:
    name: str
    points: np.ndarray
    cells: np.ndarray
    bodies: np.ndarray  # per cell: 0 or 1
    young: float
    poisson: float
    fixed: list  # (nodes, component, value)
    loads: np.ndarray  # nodal forces
    nonmortar: np.ndarray  # (cell, face)
    mortar: np.ndarray
    friction: float = 0.0
    stress: float = 0.0  # the largest that is expected, for the softness that CalculiX' node-to-face contact has


@dataclass
class Answer:
    displacement: np.ndarray
    iterations: int
    seconds: float
    version: str
    reactions: np.ndarray | None = None  # nodal forces of the supports, from a program that tells them


def kept(program, case, folder):
    """The answer of `program` to the case: that of an earlier run in `folder`, if it was to the same case and is newer than this
    file."""
    digest = hashlib.sha256(repr((case.young, case.poisson)).encode())
    arrays = [case.points, case.cells, case.bodies, case.loads, case.nonmortar, case.mortar]
    for array in (*arrays, np.array([case.friction, case.stress]), *(np.append(nodes, (c, value)) for nodes, c, value in case.fixed)):
        digest.update(np.ascontiguousarray(array).tobytes())
    file, digest = folder / "kept.npz", digest.hexdigest()
    if file.is_file() and file.stat().st_mtime > Path(__file__).stat().st_mtime:
        with np.load(file) as old:
            if str(old["digest"]) == digest:
                reactions = old["reactions"] if old["reactions"].size else None
                return Answer(old["displacement"], int(old["iterations"]), float(old["seconds"]), str(old["version"]), reactions)
    answer = program(case, folder)
    folder.mkdir(parents=True, exist_ok=True)
    reactions = [] if answer.reactions is None else answer.reactions
    np.savez(file, digest=digest, displacement=answer.displacement, iterations=answer.iterations, seconds=answer.seconds,
             version=answer.version, reactions=reactions)
    return answer


def faces_on(case_cells, points, bodies, body, on):
    """(cell, face) of a body all of whose nodes are `on`, a mask."""
    found = []
    for face, corners in enumerate(FACES):
        inside = on[case_cells[:, corners]].all(axis=1) & (bodies == body)
        found += [(cell, face) for cell in np.flatnonzero(inside)]
    return np.array(sorted(found))


def corners(case, faces):
    """Nodes of faces, outward."""
    return np.array([case.cells[cell][list(FACES[face])][::-1] for cell, face in faces])


def shape_gradients(x, xi):
    """(B per cell: dN/dX, det J) at a point of the reference cell."""
    gradient = np.empty((8, 3))
    for i in range(3):
        others = [j for j in range(3) if j != i]
        gradient[:, i] = CORNERS[:, i] * np.prod(1 + CORNERS[:, others] * xi[others], axis=1) / 8
    jacobian = np.einsum("cki,kj->cij", x, gradient)
    return np.einsum("kj,cji->cki", gradient, np.linalg.inv(jacobian)), np.linalg.det(jacobian)


def internal_forces(case, displacement):
    """Nodal internal forces of both bodies, linear elasticity."""
    shear = case.young / (2 * (1 + case.poisson))
    lame = case.young * case.poisson / ((1 + case.poisson) * (1 - 2 * case.poisson))
    forces, x = np.zeros_like(case.points), case.points[case.cells]
    for xi in CORNERS / np.sqrt(3):
        gradient, det = shape_gradients(x, xi)
        strain = np.einsum("cki,ckj->cij", displacement[case.cells], gradient)
        strain = (strain + strain.transpose(0, 2, 1)) / 2
        stress = 2 * shear * strain + lame * np.einsum("cii->c", strain)[:, None, None] * np.eye(3)
        np.add.at(forces, case.cells, np.einsum("cij,ckj->cki", stress, gradient) * det[:, None, None])
    return forces


# --- CalculiX ---------------------------------------------------------------------------------------------------------
# Of the expected stress: what is left of a node's pressure far away; the manual's advice.
LEFT = 0.0025


def calculix(case, folder, kind, penalty=None):
    """`kind`: NODE TO SURFACE, SURFACE TO SURFACE (both penalty) or MORTAR (dual multipliers), which ends without a word on the patch test if
    the corner node of the non-mortar side is supported in x and y: such a node gets the first of its supports only. `penalty`: over the
    modulus, in place of PENALTY; mortar contact is `hard` without."""
    soft = kind != "MORTAR" or penalty
    stiffness = (penalty or PENALTY) * case.young
    program = shutil.which("ccx")
    if not program:
        raise Missing("CalculiX (Debian: calculix-ccx)")
    # No more digits: it reads the first twenty characters of a number, and what an exponent loses there is a wrong node.
    lines = ["*NODE, NSET=ALL", *(f"{k + 1}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(case.points))]
    lines += [f"*ELEMENT, TYPE={CALCULIX_CELLS[case.cells.shape[1]]}, ELSET=BODY"]
    for k, cell in enumerate(case.cells):
        entries = [str(n + 1) for n in (k, *cell)]
        lines += [", ".join(entries[:16]) + ("," if entries[16:] else ""), *([", ".join(entries[16:])] if entries[16:] else [])]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{case.young}, {case.poisson}"]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=M"]
    for name, faces in (("SLAVE", case.nonmortar), ("MASTER", case.mortar)):
        lines += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{cell + 1}, S{face + 1}" for cell, face in faces)]
    lines += ["*SURFACE INTERACTION, NAME=SI", f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={'LINEAR' if soft else 'HARD'}"]
    lines += [f"{stiffness:.12g}, {LEFT * case.stress if kind == 'NODE TO SURFACE' else 0:.12g}"] if soft else []
    lines += ["*FRICTION", f"{case.friction}, {stiffness:.12g}"] if case.friction else []
    lines += [f"*CONTACT PAIR, INTERACTION=SI, TYPE={kind}", "SLAVE, MASTER", "*STEP, INC=100", "*STATIC", "1., 1."]
    lines += ["*BOUNDARY"]
    supports, single = {}, set(corners(case, case.nonmortar).flat) if kind == "MORTAR" else ()
    for n, c, value in [(n, c, value) for nodes, c, value in case.fixed for n in nodes]:
        supports.setdefault(n if n in single else (n, c), f"{n + 1}, {c + 1}, {c + 1}, {value:.12g}")
    lines += supports.values()
    if np.any(case.loads):
        lines += ["*CLOAD"]
        lines += [f"{n + 1}, {c + 1}, {case.loads[n, c]:.12g}" for n, c in zip(*np.nonzero(case.loads))]
    lines += ["*NODE PRINT, NSET=ALL, FREQUENCY=1000", "U, RF", "*END STEP", ""]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "job.inp").write_text("\n".join(lines))
    start = time.monotonic()
    done = subprocess.run([program, "job"], cwd=folder, capture_output=True, text=True, errors="replace",
                          timeout=TIMEOUT, env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"})
    seconds = time.monotonic() - start
    (folder / "log.txt").write_text(done.stdout + done.stderr)
    data = folder / "job.dat"
    if done.returncode or not data.is_file():
        said = [line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        errors = [line for line in said if "error" in line.lower()]
        raise RuntimeError(f"exit code {done.returncode} after '{(errors or said[-1:])[0][:80]}'")
    displacement, reactions = (last_table(data.read_text(), name, len(case.points)) for name in ("displacements", "forces"))
    steps = [line.split() for line in (folder / "job.sta").read_text().splitlines() if re.match(r"\s*\d", line)]
    version = re.search(r"Version ([\w.]+)", subprocess.run([program, "-v"], capture_output=True, text=True).stdout)
    iterations = sum(int(words[3]) for words in steps)
    return Answer(displacement, iterations, seconds, version.group(1) if version else "?", reactions)


def last_table(text, name, nodes):
    """CalculiX' last table of three components per node."""
    blocks = re.findall(rf"^ *{name}.*\n((?: *\n| *\d.*\n)*)", text, re.MULTILINE)
    if not blocks:
        raise RuntimeError(f"no {name}: not converged")
    found = np.zeros((nodes, 3))
    for number, *values in (line.split() for line in blocks[-1].splitlines() if line.strip()):
        found[int(number) - 1] = [float(value) for value in values]
    return found


# --- GetFEM -----------------------------------------------------------------------------------------------------------
REGION = 7
# Of the residual, in forces and in what multipliers miss over r, which is small in small facets; and of iterations, after which it says nothing.
RESIDUAL, MOST = 1e-13, 100


def by_nodes(gf, model, case, integrals, meshes):
    """Nodes against faces."""
    model.add_initialized_data("r", [case.young])
    place = (np.array([REGION]), np.array([REGION]))
    sides, names = ("u0", "u1", "pressure"), ("r",)
    if case.friction:
        model.add_initialized_data("mu", [case.friction])
        sides, names = (*sides, "traction"), ("r", "mu")
    model.add_nodal_contact_between_nonmatching_meshes_brick(*integrals, *sides, *names, *place)


def by_integrals(augmentation):
    """Contact is decided at Gauss points; multipliers of the displacements' functions. `augmentation`: over the modulus."""

    def contact(gf, model, case, integrals, meshes):
        multipliers = gf.MeshFem(meshes[0], 3 if case.friction else 1)
        multipliers.set_fem(gf.Fem("FEM_QK(3,1)"))
        fine = gf.MeshIm(meshes[0], gf.Integ("IM_GAUSS_PARALLELEPIPED(3,5)"))
        model.add_filtered_fem_variable("traction", multipliers, REGION)
        model.add_initialized_data("r", [augmentation * case.young])
        if case.friction:
            model.add_initialized_data("mu", [case.friction])
        names = ("u0", "u1", "traction", "r", *(("mu",) if case.friction else ()))
        model.add_integral_contact_between_nonmatching_meshes_brick(fine, *names, REGION, REGION)
        return multipliers, fine  # the model does not keep them

    return contact


def getfem(case, folder, contact=by_nodes):
    """Alart and Curnier's augmented Lagrangian, small displacements. (Its integral contact between
    meshes that do not match gives half the contact width on the cylinders, for a reason that was not found.)"""
    try:
        import getfem as gf
    except ImportError:
        raise Missing("GetFEM (Debian: python3-getfem)") from None
    gf.util("trace level", 0)
    order = [0, 1, 3, 2, 4, 5, 7, 6]
    model, fems, meshes, numbers = gf.Model("real"), [], [], []
    start = time.monotonic()
    for body in (0, 1):
        mesh, cells = gf.Mesh("empty", 3), np.flatnonzero(case.bodies == body)
        for cell in case.cells[cells]:
            mesh.add_convex(gf.GeoTrans("GT_QK(3,1)"), case.points[cell[order]].T)
        fem = gf.MeshFem(mesh, 3)
        fem.set_fem(gf.Fem("FEM_QK(3,1)"))
        meshes.append(mesh)
        fems.append(fem)
        model.add_fem_variable(f"u{body}", fem)
    shear = case.young / (2 * (1 + case.poisson))
    lame = case.young * case.poisson / ((1 + case.poisson) * (1 - 2 * case.poisson))
    model.add_initialized_data("lame", [lame])
    model.add_initialized_data("shear", [shear])
    integrals = [gf.MeshIm(mesh, gf.Integ("IM_GAUSS_PARALLELEPIPED(3,3)")) for mesh in meshes]
    for body, (mesh, fem, integral) in enumerate(zip(meshes, fems, integrals)):
        model.add_isotropic_linearized_elasticity_brick(integral, f"u{body}", "lame", "shear")
        dofs = fem.basic_dof_nodes()[:, ::3].T
        own = np.unique(case.cells[case.bodies == body])
        place = {tuple(np.round(case.points[n], 9)): n for n in own}
        numbers.append(np.array([place[tuple(np.round(x, 9))] for x in dofs]))
        rows = {n: k for k, n in enumerate(numbers[-1])}
        # Supports and loads node by node.
        prescribed = {3 * rows[n] + c: value for nodes, c, value in case.fixed for n in nodes if n in rows}
        constraints = gf.Spmat("empty", len(prescribed), 3 * len(dofs))
        for line, at in enumerate(prescribed):
            constraints.add(line, at, 1.0)
        model.add_variable(f"support{body}", len(prescribed))
        values = np.array(list(prescribed.values()))
        model.add_constraint_with_multipliers(f"u{body}", f"support{body}", constraints, values)
        model.add_explicit_rhs(f"u{body}", case.loads[numbers[-1]].ravel())
    for body, faces, region in ((0, case.nonmortar, REGION), (1, case.mortar, REGION)):
        mesh = meshes[body]
        own = np.flatnonzero(case.bodies == body)
        index = {cell: k for k, cell in enumerate(own)}
        chosen = []
        for cell, face in faces:
            wanted = {tuple(np.round(case.points[n], 9)) for n in case.cells[cell][list(FACES[face])]}
            for local in range(6):
                pids = mesh.pid_in_faces(np.array([[index[cell]], [local]]))
                if {tuple(np.round(x, 9)) for x in mesh.pts(pids).T} == wanted:
                    chosen.append((index[cell], local))
        mesh.set_region(region, np.array(chosen).T)
    _alive = contact(gf, model, case, integrals, meshes)
    iterations, _ = model.solve("max_res", RESIDUAL, "max_iter", MOST)
    if iterations >= MOST:
        raise RuntimeError(f"not converged in {MOST} iterations")
    seconds = time.monotonic() - start
    displacement = np.zeros_like(case.points)
    for body in (0, 1):
        displacement[numbers[body]] = np.reshape(model.variable(f"u{body}"), (-1, 3))
    return Answer(displacement, int(iterations), seconds, getattr(gf, "__version__", "5.4"))


# --- Kratos -----------------------------------------------------------------------------------------------------------
KRATOS = Path(__file__).resolve().parents[2] / "build" / "kratos" / "bin" / "python"


def kratos(case, folder):
    """Mortar, frictionless, augmented Lagrangian, in the environment that .ci/setup made: kratos_job.py."""
    if not KRATOS.exists():
        raise Missing("Kratos (PyPI: KratosContactStructuralMechanicsApplication)")
    folder.mkdir(parents=True, exist_ok=True)
    fixed = np.array([(n, c, value) for nodes, c, value in case.fixed for n in nodes])
    np.savez(folder / "case.npz", points=case.points, cells=case.cells, young=case.young, poisson=case.poisson,
             fixed=fixed, loads=case.loads, friction=case.friction, nonmortar=corners(case, case.nonmortar), mortar=corners(case, case.mortar))
    (folder / "answer.npz").unlink(missing_ok=True)
    start = time.monotonic()
    done = subprocess.run([KRATOS, Path(__file__).with_name("kratos_job.py"), folder], capture_output=True, text=True,
                          errors="replace", timeout=TIMEOUT, env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"})
    seconds = time.monotonic() - start
    (folder / "log.txt").write_text(done.stdout + done.stderr)
    if done.returncode:
        raise RuntimeError(f"exit code {done.returncode}: {done.stderr.strip()[-80:]}")
    answer = np.load(folder / "answer.npz")
    return Answer(answer["displacement"], int(answer["iterations"]), seconds, str(answer["version"]))
