"""What each effect costs: `make effects`. effects.py --build DIR [--renew-figures]; results go to DIR/effects.

One scene (scenes/effects.yaml) with effects added one by one, from the leanest on: unknowns, memory, pairs, times, Newton
iterations, as the driver reports them in summary.json. Then one interface alone (effects_probe.c) under valgrind: the
instructions of its residual and tangent, which do not depend on the machine's load. Table: printed, effects.json,
effects.md; bars relative to the leanest: effects.png.
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import figures  # noqa: E402
from documents import put_between  # noqa: E402
from scene import Driver, SceneError  # noqa: E402

COMMITTED = folders.FIGURES / "effects.png"
INTERFACE = "contact"
RUNS = 3  # of each scene; the shortest times count, as least disturbed by what else the machine does

FACETS = ("-contact_mortar", "floor.zmax")
FRICTION = ("-contact_friction", "0.2")
LARGE = ("-contact_weights", "current")
DEFORMABLE = ("-hold_within", "-1,-1,-1,2,2,-0.39")  # the floor is held at its bottom only


@dataclass
class Rung:
    """One more effect than the rung before."""

    name: str
    options: tuple  # of the driver, on scenes/effects.yaml
    probe: tuple  # law, mortar side, weights of effects_probe, which has the library's default otherwise


RUNGS = [
    Rung("analytic plane, no friction, small sliding", (), ("none", "analytic", "reference")),
    Rung("+ facets, rigid", FACETS, ("none", "rigid", "reference")),
    Rung("+ large sliding", (*FACETS, *LARGE), ("none", "rigid", "current")),
    Rung("+ Coulomb friction", (*FACETS, *LARGE, *FRICTION), ("coulomb", "rigid", "current")),
    Rung("+ deformable", (*FACETS, *LARGE, *FRICTION, *DEFORMABLE), ("coulomb", "deformable", "current")),
]
# What is counted: the calls as a host makes them; of these, search and integration, derivatives and the assembly of
# their entries, without what no mortar side changes: the law, forces, copies of the caller's arrays.
CALLS, KERNELS = "residual and tangent", "of which integration and tangent"
FUNCTIONS = ("stickslip_interface_residual", "stickslip_interface_tangent_coo")
INTEGRATION, TANGENT = "stages::integrate::integrate", "linear::Here<_>::linearise"
# One effect against another; the largest ratio that was aimed at, and of what.
FULL = ("coulomb", "deformable", "current")
RATIOS = [
    ("no friction / Coulomb", ("none", "deformable", "current"), FULL, 0.9, CALLS),
    ("no friction / Coulomb, normals of the last step", ("none", "deformable", "current", "committed"), (*FULL, "committed"), 0.9, CALLS),
    ("rigid / deformable mortar side", ("coulomb", "rigid", "current"), FULL, 0.5, KERNELS),
    ("analytic / deformable mortar side", ("coulomb", "analytic", "current"), FULL, 0.1, KERNELS),
    ("with offsets / without", (*FULL, "offsets"), FULL, None, CALLS),
    ("normals of the last step / of now", (*FULL, "committed"), FULL, None, CALLS),
    ("standard multipliers / dual", (*FULL, "standard"), FULL, None, CALLS),
    ("the paper's element / the default", (*FULL, "paper"), FULL, None, CALLS),
    ("Coulomb's law as a callback / built in", ("callback", *FULL[1:]), FULL, 1.05, CALLS),
    ("slip-weakening / Coulomb", ("weakening", *FULL[1:]), FULL, None, CALLS),
    ("orthotropic / Coulomb", ("orthotropic", *FULL[1:]), FULL, None, CALLS),
]

# Effects of the driver, each on a scene without it and with it: what it adds. Unnamed, it leaves every figure as it is.
SLIDING = (*FACETS, *LARGE, *FRICTION, *DEFORMABLE)
AT_NODES = (*FACETS, *DEFORMABLE, "-contact_weights", "committed")
TOOL = ("-bodies", "block,floor,plane,tool", "-tool_type", "rigid", "-tool_from", "box", "-tool_lower", "3,0,0", "-tool_upper", "4,1,1", "-tool_cells",
        "1,1,1", "-tool_reference", "3,0,0", "-supports", "grip,hold,still,fix", "-fix_body", "tool")
WARM = ("-heat_initial", "20", "-block_conductivity", "1", "-floor_conductivity", "1", "-contact_conductance_constant", "10", "-contact_conductance_reach", "0.01",
        "-temperatures", "warm", "-warm_surface", "block.zmax", "-warm_value", "50")
TURNED = ("-bodies", "block,floor,plane,tool", *TOOL[2:-4])  # without what holds it
MASS = ("-dynamics_rho_inf", "1", "-block_density", "1e-3", "-floor_density", "1e-3")
FROZEN = (*AT_NODES, *FRICTION)
POINTS = ("-contact_decision", "points")

# Half of the cells along the surfaces: what is added shows on any mesh, and there are many rows.
HALF = ("-block_cells", "7,7,4", "-floor_cells", "9,8,3")
# A mesh on which all rows together take seconds; it has the node that forces and springs of one node are at.
COARSE = ("-block_cells", "2,2,4", "-floor_cells", "3,3,2", "-steps_count", "2")


def law(name, *numbers):
    return ("-contact_law", name, *numbers)


def load(*about):
    return ("-loads", "load", *about)


# Rows that begin with + are the row above that has none, with what they name; normals, multipliers and weights in place of its own.
DRIVER = [
    ("Coulomb friction, large sliding, both sides deform", SLIDING),
    ("+ normals of the last step", (*SLIDING, "-contact_normals", "committed")),
    ("+ standard multipliers", (*SLIDING, "-contact_basis", "standard")),
    ("+ both, the paper's element", (*SLIDING, "-method", "paper")),
    ("+ weights and normals of the last step", (*SLIDING, "-contact_weights", "committed")),
    ("+ springs per area", (*SLIDING, "-springs", "bed", "-bed_surface", "block.xmin", "-bed_stiffness", "1,1,1")),
    ("+ an axial spring", (*SLIDING, "-springs", "link", "-link_body", "block", "-link_point", "0,0,0.25", "-link_to_point", "-1,0,0.25", "-link_axial", "true",
                           "-link_stiffness", "1")),
    ("+ a support that holds for a time", (*SLIDING, "-hold_until", "1")),
    ("+ weight", (*SLIDING, "-block_density", "1e-3", *load("-load_body", "block", "-load_gravity", "0,0,-1"))),
    ("+ a follower pressure", (*SLIDING, *load("-load_surface", "block.xmin", "-load_pressure", "0.01", "-load_follower", "true"))),
    ("+ force and moment spread over a surface", (*SLIDING, *load("-load_surface", "block.xmax", "-load_force", "0,0,0.01", "-load_moment", "0,0.001,0"))),
    ("+ a force on a node", (*SLIDING, *load("-load_body", "block", "-load_point", "0,0,0.25", "-load_force", "0.01,0,0"))),
    ("+ a rigid body, moved", (*SLIDING, *TOOL, "-fix_components", "x,y,z,rx,ry,rz")),
    ("+ a rigid body, free along its axes, on a spring", (*SLIDING, *TOOL, "-fix_components", "rx,ry,rz", "-springs", "hang", "-hang_body", "tool",
                                                         "-hang_stiffness", "1,1,1")),
    ("+ an offset", (*SLIDING, "-contact_offset", "0.001")),
    ("+ nodes put onto the other side at the start", (*SLIDING, "-contact_adjust", "1e-3")),
    ("+ heat across the interface", (*SLIDING, *WARM)),
    ("+ heat, also of friction, that bodies expand by", (*SLIDING, *WARM, "-contact_friction_heat", "0.5", "-heat_coupling", "two_way", "-block_expansion", "1e-6")),
    ("+ restart files", (*SLIDING, "-output_restart_every", "1")),
    ("+ dynamics", (*SLIDING, *MASS)),
    ("+ dynamics, weights of now", (*SLIDING, *MASS, "-contact_weights", "current")),
    ("+ dynamics, a rigid body that turns freely", (*SLIDING, *MASS, *TURNED, "-tool_mass", "1", "-tool_inertia", "1,2,3", "-tool_spin", "0,0,0.1")),
    ("law: cohesion", (*SLIDING, *law("cohesion", "-contact_cohesion", "0.01"))),
    ("law: Tresca's", (*SLIDING, *law("tresca", "-contact_shear_limit", "0.2"))),
    ("law: weakening", (*SLIDING, *law("weakening", "-contact_friction_after", "0.1", "-contact_critical_slip", "0.01"))),
    ("law: orthotropic", (*SLIDING, *law("orthotropic", "-contact_friction_across", "0.1", "-contact_direction", "1,1,0"))),
    ("law: rough", (*FACETS, *LARGE, *DEFORMABLE, *law("rough", "-contact_basis", "standard"))),  # dual: a node that pulls has no state of rest
    ("law: tied", (*FACETS, *DEFORMABLE, *law("tied"))),
    ("no friction, frozen in a step", AT_NODES),
    ("+ decided at points", (*AT_NODES, *POINTS)),
    ("+ multipliers condensed", (*AT_NODES, "-unknowns", "displacements")),
    ("no friction, weights of now", (*AT_NODES, *LARGE)),
    ("+ decided at points", (*AT_NODES, *LARGE, *POINTS)),
    ("Coulomb friction, frozen in a step", FROZEN),
    ("+ decided at points", (*FROZEN, *POINTS)),
]
GALLERY, MARKS = folders.ROOT / "docs" / "site" / "gallery.md", ("<!-- effects -->\n", "<!-- /effects -->\n")

# Columns: key, heading, format.
COLUMNS = [
    ("unknowns", "unknowns", "d"),
    ("multipliers", "multipliers", "d"),
    ("bytes", "library's memory [kB]", ".0f"),
    ("pairs_integrated", "pairs integrated", "d"),
    ("pairs_linearised", "linearised", "d"),
    ("pairs_reused", "reused", "d"),
    ("integration", "search, integration [ms]", ".1f"),
    ("tangent", "tangent [ms]", ".1f"),
    ("newton_iterations", "Newton iterations", "d"),
    ("instructions", "instructions, residual + tangent [10^6]", ".1f"),
]


def measure(driver, rung):
    """The figures of one rung."""
    label = re.sub(r"\W+", "_", rung.name).strip("_")
    runs = [driver.run("effects", *rung.options, label=f"{label}_{k}") for k in range(RUNS)]
    run, shortest = runs[0], lambda *keys: 1e3 * min(sum(r.summary["seconds"][key] for key in keys) for r in runs)
    interface = run.summary["interfaces"][INTERFACE]
    return {
        "name": rung.name,
        "effects": interface["effects"],
        "unknowns": run.summary["unknowns"],
        "newton_iterations": run.newton_iterations,
        **{key: interface[key] for key in ("multipliers", "pairs_integrated", "pairs_linearised", "pairs_reused")},
        "bytes": interface["bytes"] / 1e3,
        "integration": shortest("search", "integration"),
        "tangent": shortest("contact_assembly"),
    }


def instructions_of_calls(profile):
    """Instructions below every call in a callgrind profile, by names of caller and called function."""
    names, counts, caller, called, is_call = {}, Counter(), None, None, False
    for line in profile.splitlines():
        key, _, value = line.partition("=")
        if key in ("fn", "cfn"):
            number, _, name = value.partition(" ")
            name = names.setdefault(number, name)  # said where it occurs first
            caller, called = (name, None) if key == "fn" else (caller, name)
        elif key == "calls":
            is_call = True
        elif is_call:
            counts[caller, called] += int(line.split()[-1])
            is_call = False
    return counts


class Probe:
    """Counts the instructions of a residual and a tangent of one interface; None where there is no valgrind."""

    def __init__(self, driver):
        self.program, self.known = driver.build / "c_examples" / "effects_probe", {}
        self.valgrind = shutil.which("valgrind")

    def millions(self, effects, of=CALLS):
        if not self.valgrind:
            return None
        if effects not in self.known:
            self.known[effects] = self._count(effects)
        return self.known[effects][of]

    def _count(self, effects):
        with tempfile.NamedTemporaryFile("r", suffix=".callgrind") as profile:
            command = [self.valgrind, "--tool=callgrind", f"--callgrind-out-file={profile.name}"]
            command += [f"--toggle-collect={function}" for function in FUNCTIONS]
            done = subprocess.run([*command, str(self.program), *effects], capture_output=True, text=True)
            counts = instructions_of_calls(profile.read())
        below = lambda name, by="": sum(n for (a, b), n in counts.items() if name in b and by in a)
        calls = sum(below(function) for function in FUNCTIONS)
        integration, tangent = below(INTEGRATION), below(TANGENT)
        kernels = integration + tangent
        if done.returncode:
            raise SceneError(f"effects_probe {' '.join(effects)}: exit code {done.returncode}\n{done.stderr[-800:]}")
        # Each by itself: a function that has another name by now counts for nothing, and the other one would hide it.
        integrates = integration > 0 or "reference" in effects  # frozen weights: at creation alone
        if not (integrates and 0 < tangent and kernels < calls):
            told = f"{INTEGRATION} {integration}, {TANGENT} {tangent} of {calls} instructions"
            raise SceneError(f"effects_probe {' '.join(effects)}: {told}: have these functions other names by now?")
        per_evaluation = 1e-6 / json.loads(done.stdout)["evaluations"]
        return {CALLS: per_evaluation * calls, KERNELS: per_evaluation * kernels}


def markdown(rows, ratios):
    cell = lambda row, key, form: "" if row[key] is None else format(row[key], form)
    lines = [
        "| effects | " + " | ".join(heading for _, heading, _ in COLUMNS) + " |",
        "|---|" + "---:|" * len(COLUMNS),
        *(f"| {row['name']} | " + " | ".join(cell(row, key, form) for key, _, form in COLUMNS) + " |" for row in rows),
    ]
    if ratios:
        lines += ["", f"| instructions | {CALLS} | {KERNELS} | aim |", "|---|---:|---:|---|"]
        for r in ratios:
            aim = f"at most {r['aim']:.0%} of {r['of'].removeprefix('of which ')}" if r["aim"] else "none"
            lines.append(f"| {r['name']} | {r[CALLS]:.1%} | {r[KERNELS]:.1%} | {aim} |")
    return "\n".join(lines) + "\n"


def of_the_driver(driver):
    """What each effect adds, by counters alone."""
    keys = ("unknowns", "multipliers", "bytes", "pairs_integrated", "pairs_linearised", "pairs_reused", "newton_iterations")
    columns = [column for column in COLUMNS if column[0] in keys]
    rows = ["| effects | " + " | ".join(heading for _, heading, _ in columns) + " |", "|---|" + "---:|" * len(columns)]
    for name, options in DRIVER:
        run = driver.run("effects", *options, *HALF, label=re.sub(r"\W+", "_", f"driver_{name}"))
        found = {**run.summary["interfaces"][INTERFACE], "unknowns": run.summary["unknowns"], "newton_iterations": run.newton_iterations}
        found["bytes"] /= 1e3
        rows.append(f"| {name} | " + " | ".join(format(found[key], form) for key, _, form in columns) + " |")
    return "\n".join(rows) + "\n"


def check(build):
    """Whether the scene with each effect of the driver is solved, and whether the functions that are counted still have the names by
    which they are: two of the cheaper counts."""
    driver = Driver(build, build / "effects_check")
    for number, (_, options) in enumerate(DRIVER):
        driver.run("effects", *options, *COARSE, label=f"row_{number}")
    print(f"{len(DRIVER)} effects of the driver, each solved on a coarse mesh")
    probe = Probe(driver)
    if not probe.valgrind:
        print("valgrind is not there: nothing to count")
        return
    analytic, rigid = (probe.millions(("none", side, "current"), KERNELS) for side in ("analytic", "rigid"))
    print(f"integration and tangent, 10^6 instructions: analytic {analytic:.2f}, rigid {rigid:.2f}")
    if not 0 < analytic < rigid:
        raise SceneError("facets cost no more than a plane")


def report(build, renew):
    driver = Driver(build, build / "effects")
    probe, rows = Probe(driver), []
    for rung in RUNGS:
        rows.append(measure(driver, rung))
        rows[-1]["instructions"] = probe.millions(rung.probe)
    ratios = []
    if probe.valgrind:
        for name, one, other, aim, of in RATIOS:
            found = {what: probe.millions(one, what) / probe.millions(other, what) for what in (CALLS, KERNELS)}
            ratios.append({"name": name, **found, "aim": aim, "of": of})
    else:
        print("valgrind is not there: no instruction counts")

    added = of_the_driver(driver)
    text = markdown(rows, ratios) + "\n" + added
    print(text)
    driver.output.mkdir(parents=True, exist_ok=True)
    (driver.output / "effects.md").write_text(text)
    (driver.output / "effects.json").write_text(json.dumps({"rungs": rows, "ratios": ratios}, indent=1) + "\n")
    drawn = [figures.effects(rows, driver.output / "effects.png")]
    if renew:
        shutil.copy(drawn[0], COMMITTED)
        drawn.append(COMMITTED)
        put_between(GALLERY, MARKS, added)
    for path in drawn:
        print(path.resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--renew-figures", action="store_true", help="renew the committed figure too")
    parser.add_argument("--check", action="store_true", help="only whether all runs, and it can count: for the tests")
    arguments = parser.parse_args()
    try:
        check(arguments.build) if arguments.check else report(arguments.build, arguments.renew_figures)
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
