"""Scene files with one mistake each, made from a good one. The driver must refuse them and name the key at fault."""

import re
from dataclasses import dataclass

from scene import SCENES

BASE = "block_zone_mu05.yaml"
MESHES = SCENES.parent / "meshes"


@dataclass
class BadScene:
    name: str
    old: str  # text of the good scene ...
    new: str  # ... and what stands there instead
    names: str  # what the message must contain
    options: tuple = ()  # or the mistake is on the command line
    says: str = ""  # and what else
    base: str = BASE


def wall(shape):
    """An analytic body besides."""
    bodies = "bodies: [block, floor]"
    return bodies, f"bodies: [block, floor, wall]\nwall: {{type: analytic, point: [0, 0, 0], shape: {shape}}}"


BOX = "type: box, lower: [0, 0, 0], upper: [4, 1, 2], cells: [20, 1, 10]"


def one_cell(gmsh_type, points):
    """A Gmsh file with one cell."""
    numbers = range(1, len(points) + 1)
    nodes = "\n".join([*map(str, numbers), *(" ".join(map(str, p)) for p in points)])
    return (
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
        '$PhysicalNames\n1\n3 1 "brick"\n$EndPhysicalNames\n'
        "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 1 0\n$EndEntities\n"
        f"$Nodes\n1 {len(points)} 1 {len(points)}\n3 1 0 {len(points)}\n{nodes}\n$EndNodes\n"
        f"$Elements\n1 1 1 1\n3 1 {gmsh_type} 1\n1 {' '.join(map(str, numbers))}\n$EndElements\n"
    )


PRISM = one_cell(6, [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)])
PYRAMID = one_cell(7, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)])

PRISM_2 = one_cell(18, [(k, k * k, k**3) for k in range(15)])
TET_3 = one_cell(29, [(k, k * k, k**3) for k in range(20)])

# As many bodies as PETSc's table of options has no room for.
CROWD = [f"body{k}" for k in range(120)]

BAD_SCENES = [
    BadScene("more_keys_than_there_is_room_for", "bodies: [block, floor]", f"bodies: [block, floor, {', '.join(CROWD)}]\n" + "".join(
        f"{name}: {{type: box, lower: [0, 0, 9], upper: [1, 1, 10], cells: [1, 1, 1], young: 1}}\n" for name in CROWD), ".yaml", says="can be one mesh"),
    BadScene("misspelt_key", "friction: 0.5", "frictoin: 0.5", "base.frictoin"),
    BadScene("missing_key", "young: 1000, poisson: 0.3, small", "poisson: 0.3, small", "block.young"),
    BadScene("misspelt_key_that_must_be", "young: 1000, poisson: 0.3, small", "youngs: 1000, poisson: 0.3, small", "block.young", says="'youngs' (line"),
    BadScene("unknown_key", "friction: 0.5", "friction: 0.5, colour: 3", "base.colour"),
    BadScene("key_of_other_bodies", "poisson: 0.3, small", "poisson: 0.3, radius: 1, small", "block.radius", says='a key of "Analytic bodies"'),
    BadScene("nearly_a_key_of_the_table", "friction: 0.5", "friction: 0.5, criticl_slip: 1", "base.criticl_slip", says="did you mean 'base.critical_slip'"),
    BadScene("out_of_the_tables_range", "steps: {end: 2", "steps: {lever: 0.5, end: 2", "steps.lever", says="0.5 is not allowed; it must be at least 1"),
    BadScene("name_of_a_map", "supports: [", "supports: [heat, ", "supports", says="the name 'heat' is reserved"),
    BadScene("value_for_a_map", "schema: 1", "schema: 1\nheat: 20", "heat", says="a map is expected"),
    BadScene("heat_without_initial", "schema: 1", "schema: 1\nheat: {coupling: two_way}", "heat.initial", says="this key is missing"),
    BadScene("unknown_map", "schema: 1", "schema: 1\nextra: {a: 1}", "extra.a"),
    BadScene("missing_value", "cells: [20, 1, 10], ", "", "block.cells"),
    BadScene("not_a_number", "friction: 0.5", "friction: plenty", "base.friction"),
    BadScene("infinite", "friction: 0.5", "friction: .inf", "base.friction"),
    BadScene("negative_friction", "friction: 0.5", "friction: -0.5", "base.friction"),
    BadScene("incompressible", "poisson: 0.3, small", "poisson: 0.5, small", "block.poisson"),
    BadScene("no_cells", "cells: [20, 1, 10]", "cells: [20, 0, 10]", "block.cells"),
    BadScene("wrong_length", "traction: [60, 0, 0]", "traction: [60, 0]", "push.traction"),
    BadScene("no_field", "rigid: {body: floor,", "rigid: {body: floor, file: nowhere.txt,", "rigid.file"),
    BadScene("field_of_words", "rigid: {body: floor,", "rigid: {body: floor, file: nameless.msh,", "rigid.file", says="line 1 of"),
    BadScene("field_of_few", "rigid: {body: floor,", "rigid: {body: floor, file: one_row.txt,", "rigid.file", says="no row for"),
    BadScene("odd_curve", "curve: [1, 0, 2, 1]", "curve: [1, 0, 2]", "push.curve"),
    BadScene("unknown_surface", "mortar: floor.zmax", "mortar: floor.top", "base.mortar"),
    BadScene("empty_surface", "within: [0.2, 0, 0, 3.8, 1, 0]", "within: [9, 0, 0, 10, 1, 0]", "zone.within"),
    BadScene("unknown_choice", "weights: reference", "weights: heavy", "base.weights"),
    BadScene("no_slide", "friction: 0.5", "friction: 0.5, slide_max: 0", "base.slide_max"),
    BadScene("surfaces_twice", "interfaces: [base]", "interfaces: [base, again]\nagain: {nonmortar: zone, mortar: floor.zmax}", "again.mortar", says="'base'"),
    BadScene("unknown_law", "friction: 0.5", "law: sticky", "base.law"),
    BadScene("tresca_without_friction", "friction: 0.5", "law: tresca, shear_limit: 1", "base.friction"),
    BadScene("tresca_without_limit", "friction: 0.5", "friction: 0.5, law: tresca", "base.shear_limit"),
    BadScene("limit_of_coulomb", "friction: 0.5", "friction: 0.5, shear_limit: 1", "base.shear_limit"),
    BadScene("cohesion_missing", "friction: 0.5", "friction: 0.5, law: cohesion", "base.cohesion"),
    BadScene("cohesion_of_coulomb", "friction: 0.5", "friction: 0.5, cohesion: 1", "base.cohesion"),
    BadScene("weakening_at_once", "friction: 0.5", "friction: 0.5, law: weakening, friction_after: 0.1, critical_slip: 0", "base.critical_slip"),
    BadScene("orthotropic_without_direction", "friction: 0.5", "friction: 0.5, law: orthotropic, friction_across: 0.1", "base.direction"),
    BadScene("orthotropic_along_nothing", "friction: 0.5", "law: orthotropic, friction_across: 0.1, direction: [1, 0, 0]", "base.friction"),
    BadScene("friction_of_tied", "friction: 0.5", "friction: 0.5, law: tied", "base.friction"),
    BadScene(
        "not_rigid",
        "rigid: {body: floor,",
        "rigid: {body: floor, within: [-9, -9, -9, 9, 9, -0.5],",
        "base.mortar_side",
        ("-base_mortar_side", "rigid"),
    ),
    BadScene("analytic_without_support", *wall("plane, direction: [0, 0, 1]"), "wall"),
    BadScene(
        "analytic_the_wrong_way_round",
        "type: box, lower: [-0.5, -0.5, -1], upper: [4.5, 1.5, 0], cells: [13, 3, 1], young: 1000, poisson: 0.3",
        "type: analytic, shape: plane, point: [0, 0, 0], direction: [0, 0, -1]",
        "base.mortar",
        options=("-base_mortar", "floor.surface"),
        says="look the same way",
    ),
    BadScene("analytic_without_radius", *wall("sphere"), "wall.radius"),
    BadScene("analytic_without_direction", *wall("plane, direction: [0, 0, 0]"), "wall.direction"),
    BadScene("ball_and_polar", "cells: [20, 1, 10]", "cells: [20, 1, 10], ball: [0, 0, 0], polar: true", "block.ball"),
    BadScene("axis_of_nothing", "cells: [20, 1, 10]", "cells: [20, 1, 10], axis: y", "block.axis"),
    BadScene("polar_from_zero", "cells: [20, 1, 10]", "cells: [20, 1, 10], polar: true", "block.polar"),
    BadScene(
        "polar_too_far",
        "lower: [0, 0, 0], upper: [4, 1, 2], cells: [20, 1, 10]",
        "lower: [1, 0, 0], upper: [4, 400, 2], cells: [20, 9, 10], polar: true",
        "block.polar",
    ),
    BadScene(
        "polar_too_few",
        "lower: [0, 0, 0], upper: [4, 1, 2], cells: [20, 1, 10]",
        "lower: [1, 0, 0], upper: [4, 360, 2], cells: [20, 2, 10], polar: true",
        "block.polar",
    ),
    BadScene("bad_name", "loads: [press, push]", "loads: [Press, push]", "loads"),
    BadScene("same_name_twice", "bodies: [block, floor]", "bodies: [block, block]", "bodies"),
    BadScene("list_of_maps", "loads: [press, push]", "loads: [{press: 1}, push]", "loads"),
    BadScene(
        "missing_mesh_file",
        "type: box, lower: [0, 0, 0], upper: [4, 1, 2], cells: [20, 1, 10]",
        "type: gmsh, file: nowhere.msh",
        "block.file",
    ),
    BadScene(
        "unknown_volume",
        "type: box, lower: [0, 0, 0], upper: [4, 1, 2], cells: [20, 1, 10]",
        f"type: gmsh, volume: bricks, file: {MESHES / 'brick_tet_upper.msh'}",
        "block.volume",
    ),
    BadScene(
        "mesh_without_names",
        "type: box, lower: [0, 0, 0], upper: [4, 1, 2], cells: [20, 1, 10]",
        "type: gmsh, file: nameless.msh",
        "block.file",
    ),
    BadScene(
        "inside_out",
        "lower: [0, 0, 0], upper: [4, 1, 2], cells: [20, 1, 10]",
        "corners: [0,0,2, 4,0,2, 4,1,2, 0,1,2, 0,0,0, 4,0,0, 4,1,0, 0,1,0], cells: [20, 1, 10]",
        "block",
    ),
    BadScene("short_lever", "steps: {end: 2, count: 20}", "steps: {end: 2, count: 20, lever: 0.5}", "steps.lever"),
    BadScene("stages_in_ones", "steps: {end: 2, count: 20}", "steps: {stages: [1, 10, 2]}", "steps.stages"),
    BadScene("half_a_step", "steps: {end: 2, count: 20}", "steps: {stages: [1, 2.5]}", "steps.stages"),
    BadScene("stage_back", "steps: {end: 2, count: 20}", "steps: {stages: [1, 2, 0.5, 2]}", "steps.stages"),
    BadScene("not_automatic", "steps: {end: 2, count: 20}", "steps: {end: 2, largest: 0.1}", "steps.largest"),
    BadScene("too_large_initial", "", "", "steps.initial", ("-steps_automatic", "true", "-steps_initial", "3")),
    BadScene("no_iterations", "", "", "steps.iterations", ("-steps_automatic", "true", "-steps_iterations", "0")),
    BadScene("misspelt_map", "steps: {end: 2", "stpes: {end: 2", "stpes.end", says="did you mean 'steps'"),
    BadScene("no_schema", "schema: 1", "", "schema", says="`schema: 1`"),
    BadScene("listed_without_map", "supports: [", "supports: [wall, ", "supports", says="'wall' is listed and has no map"),
    BadScene("list_for_a_map", "push: {surface", "push: [x]\nother: {surface", "loads", says="'push' is listed and has"),
    BadScene("map_of_names", "probes: [topleft, topright]", "probes: {topleft: 1}", "probes", says="a list of names"),
    BadScene("broken_yaml", "schema: 1", "schema: [1", "broken_yaml.yaml"),
    BadScene("times_and_end", "steps: {end: 2, count: 20}", "steps: {times: [1, 2], end: 2}", "steps.end", says="`times`"),
    BadScene("times_and_count", "steps: {end: 2, count: 20}", "steps: {times: [1, 2], count: 2}", "steps.count"),
    BadScene("stages_and_end", "steps: {end: 2, count: 20}", "steps: {stages: [2, 2], end: 2}", "steps.end", says="`stages`"),
    BadScene("old_word_for_slip", "", "", "base.slip", ("-base_slip", "seed"), says="'seed' is called 'paper' now"),
    BadScene("misspelt_load", "traction: [60, 0, 0]", "tracton: [60, 0, 0]", "push.tracton", says="'push.traction'"),
    BadScene("unknown_key_of_load", "traction: [60, 0, 0]", "colour: 3", "push.colour", says="traction, pressure"),
    BadScene("no_converted_mesh", BOX, "type: hdf5, file: nowhere.h5", "block.file", says="cannot read"),
    BadScene("not_converted", BOX, "type: hdf5, file: nameless.msh", "block.file", says="HDF5"),
    BadScene("prism", BOX, "type: gmsh, file: prism.msh", "block.file", says="a prism (wedge)"),
    BadScene("pyramid", BOX, "type: gmsh, file: pyramid.msh", "block.file", says="a pyramid"),
    BadScene("prism_of_second_order", BOX, "type: gmsh, file: prism_2.msh", "block.file", says="a prism (wedge)"),
    BadScene("tetrahedron_of_third_order", BOX, "type: gmsh, file: tet_3.msh", "block.file", says="order 2"),
    BadScene("option_of_nobody", "", "", "-stpes_count", ("-stpes_count", "3"), says="nothing reads this option"),
    BadScene("misspelt_option", "", "", "base.frictoin", ("-base_frictoin", "0.3")),
    # their surfaces lie over each other and are no pairs: the bodies would pass through each other without a word
    BadScene("deep_in_each_other", "", "", "base.mortar", ("-floor_upper", "4.5,1.5,0.9")),
    BadScene("same_way", "floor.zmax, friction", "floor.zmin, friction", "base.mortar"),
    BadScene("bad_coverage", "", "", "base.coverage_min", ("-base_coverage_min", "1")),
    BadScene("bad_option", "", "", "steps.count", ("-steps_count", "0")),
    BadScene("results_into_a_file", "", "", "results_into_a_file.yaml", ("-output_dir", "/dev/null"), says="cannot write to the output folder"),
]


def write_signed_mesh(folder):
    """A mesh whose surface zmin has a negative tag, as `Physical Surface("zmin") = {-1};` gives it."""
    lines = (MESHES / "brick_tet_upper.msh").read_text()
    signed, n = re.subn(r"(?m)^(1 0 0 0 1 1 0 1) 2 (4 1 2 3 4 *)$", r"\1 -2 \2", lines)
    if n != 1:
        raise ValueError("brick_tet_upper.msh no longer has the surface that the test turns round")
    path = folder / "signed.msh"
    path.write_text(signed)
    return path


WEIGHT = "loads: [press, push, weight]\nweight: {body: block, gravity: [0, 0, -1]}"
BAD_SCENES += [
    BadScene("weightless", "loads: [press, push]", WEIGHT, "block.density"),
    BadScene("negative_density", "young: 1000, poisson: 0.3, small", "density: -1, young: 1000, poisson: 0.3, small", "block.density"),
    BadScene("body_load_without_a_kind", "loads: [press, push]", WEIGHT.replace("gravity", "acceleration"), "weight.gravity"),
    BadScene("follower_traction", "traction: [0, 0, -200]", "traction: [0, 0, -200], follower: true", "press.follower"),
    BadScene("gravity_with_an_origin", "loads: [press, push]", WEIGHT.replace("-1]", "-1], origin: [0, 0, 1]"), "weight.origin",
             options=("-block_density", "1")),
    BadScene("gravity_across_the_axis", "interfaces", "loads: [weight]\nweight: {body: hub, gravity: [1, 0]}\ninterfaces",
             "weight.gravity", base="ring_shrink_fit.yaml"),
]
BAD_SCENES += [
    BadScene("solver_with_multipliers", "schema: 1", "schema: 1\nsolver: iterative", "solver", says="`unknowns: displacements`"),
    BadScene("solver_unknown", "schema: 1", "schema: 1\nsolver: magic", "solver", says="iterative"),
]

BLOCK, RINGS, FLAT = "plane_block.yaml", "ring_shrink_fit.yaml", "plane_hertz.yaml"
BAD_SCENES += [
    BadScene(name, "interfaces: [contact]\n", "interfaces: [contact]\n", names, options=options, says=says, base=RINGS)
    for name, names, options, says in [
        ("offset_of_no_node", "contact.offset_at", ("-contact_offset_at", "10,0,0.01,10,0.123,0.01"), "no node of the non-mortar surface"),
        ("offset_without_a_value", "contact.offset_at", ("-contact_offset_at", "10,0"), "3 numbers a node"),
        ("curve_of_no_offset", "contact.offset_curve", ("-contact_offset_curve", "0,0,1,1"), "there is none"),
        ("adjust_of_nothing", "contact.adjust", ("-contact_adjust", "0"), "above 0"),
        ("adjust_beyond_a_facet", "contact.adjust", ("-contact_adjust", "2", "-hub_lower", "11,0"), "shortest edge"),
        ("radius_without_round", "contact.nonmortar_radius", ("-contact_nonmortar_radius", "10"), "round"),
        ("round_without_radius", "contact.round", ("-contact_round", "circle"), "which side"),
        ("radius_of_nothing", "contact.mortar_radius", ("-contact_round", "circle", "-contact_mortar_radius", "0"), "Zero is neither"),
    ]
]
BAD_SCENES += [
    BadScene("model_unknown", "model: plane_strain", "model: plane", "model", base=BLOCK),
    BadScene("numbers_of_space", "lower: [0, 0],", "lower: [0, 0, 0],", "block.lower", says="2 numbers", base=BLOCK),
    BadScene("cells_of_space", "lower: [0, 0],", "cell: hex, lower: [0, 0],", "block.cell", says="quad, tri", base=BLOCK),
    BadScene("component_across", "components: [x, y]", "components: [x, y, z]", "rigid.components", says="x, y.", base=BLOCK),
    BadScene("thickness_of_a_solid", "schema: 1", "schema: 1\nthickness: 2", "thickness"),
    BadScene("thickness_of_a_ring", "schema: 1", "schema: 1\nthickness: 2", "thickness", base=RINGS),
    BadScene("negative_thickness", "schema: 1", "schema: 1\nthickness: -2", "thickness", base=BLOCK),
    BadScene("beyond_the_axis", "lower: [1, 0]", "lower: [-1, 0]", "shaft", says="beyond the axis", base=RINGS),
    BadScene("turned_ring", "components: [y]}", "components: [y], rotate: 1}", "floor.rotate", base=RINGS),
    BadScene("turned_axis", "schema: 1", "schema: 1\nframe: {rotate: 30}", "frame.rotate", base=RINGS),
    BadScene("mean_in_plane_stress", "model: plane_strain", "model: plane_stress\n", "block.dilatation",
             options=("-block_dilatation", "mean"), base=BLOCK),
    BadScene("plane_mesh_in_space", "model: plane_strain\n", "", "upper.file", says="holds no volume cells", base=FLAT),
    BadScene("solid_mesh_in_the_plane", "plane_hertz_upper", "hertz_upper_coarse", "upper.file", says="no plane mesh", base=FLAT),
    BadScene("plane_in_the_plane", "floor: {type: box", "floor: {type: analytic, shape: plane", "floor.shape",
             says="choose from: line, circle", base=BLOCK),
    BadScene("direction_of_a_circle", "floor: {type: box", "floor: {type: analytic, shape: circle, radius: 1, point: [0, 0], direction: [0, 1]",
             "floor.direction", says="a circle has none", base=BLOCK),
    BadScene("line_with_a_radius", "floor: {type: box", "floor: {type: analytic, shape: line, radius: 1, point: [0, 0], direction: [0, 1]",
             "floor.radius", says="a line has none", base=BLOCK),
    BadScene("direction_in_space", "floor: {type: box", "floor: {type: analytic, shape: line, point: [0, 0], direction: [0, 0, 1]",
             "floor.direction", base=BLOCK),
    BadScene("no_cylinder", "lower: [0, 0],", "cylinder: [0, 0], lower: [0, 0],", "block.cylinder", base=BLOCK),
]


CUBE = "from: box, lower: [5, 0, 0], upper: [6, 1, 1], cells: [1, 1, 1]"


def tool(keys, more=""):
    """A rigid body besides, and what else."""
    bodies = "bodies: [block, floor]"
    return bodies, f"bodies: [block, floor, tool]\ntool: {{type: rigid, {keys}}}\n{more}"


BAD_SCENES += [
    BadScene("rigid_without_reference", *tool(CUBE), "tool.reference", says="the point that moves with the body"),
    BadScene("rigid_far_from_its_point", *tool(f"reference: [5, 20000, 0], {CUBE}"), "tool.reference", says="at most 1000"),
    BadScene("rigid_beyond_numbers", *tool(f"reference: [1.0e+200, 0, 0], {CUBE}"), "tool.reference", says="at most 1000"),
    BadScene("rigid_from_nowhere", *tool("reference: [5, 0, 0]"), "tool.from", says="box, gmsh, stl, analytic"),
    BadScene("rigid_of_unknown_shape", *tool("from: analytic, shape: cone, point: [5, 0, 0], reference: [5, 0, 0]"), "tool.shape",
             says="plane, sphere, cylinder"),
    BadScene("rigid_without_file", *tool("from: stl, file: nowhere.stl, reference: [5, 0, 0]"), "tool.file", says="cannot be read"),
    BadScene("rigid_that_is_no_stl", *tool("from: stl, file: nameless.msh, reference: [5, 0, 0]"), "tool.file", says="STL"),
    BadScene("rigid_from_folder", *tool("from: stl, file: ., reference: [5, 0, 0]"), "tool.file", says="STL"),
    BadScene("rigid_of_lines", *tool("from: stl, file: lines.stl, reference: [5, 0, 0]"), "tool.file", says="no triangle"),
    BadScene("rigid_with_stiffness", *tool(f"reference: [5, 0, 0], {CUBE}, young: 1"), "tool.young"),
    BadScene("rigid_of_negative_mass", *tool(f"reference: [5, 0, 0], {CUBE}, mass: -1"), "tool.mass"),
    BadScene("moment_on_a_node", "push: {surface: block.xmin, traction: [60, 0, 0],", "push: {body: block, point: [0, 0, 0], moment: [0, 0, 1],",
             "push.moment", says="a moment on a node"),
    BadScene("moment_on_a_body", "push: {surface: block.xmin, traction: [60, 0, 0],", "push: {body: block, moment: [0, 0, 1],",
             "push.moment", says="'block' is not rigid"),
    BadScene("moment_on_nothing", "push: {surface: block.xmin, traction: [60, 0, 0],", "push: {moment: [0, 0, 1],", "push.moment",
             says="a moment on a node is none"),
    BadScene("force_and_traction", "traction: [60, 0, 0]", "traction: [60, 0, 0], force: [1, 0, 0]", "push.force", says="not both in one load"),
    BadScene("force_that_follows", "traction: [60, 0, 0]", "force: [1, 0, 0], follower: true", "push.follower", says="keeps its direction"),
    BadScene("point_without_force", "push: {surface: block.xmin, traction: [60, 0, 0],", "push: {body: block, point: [0, 0, 0],", "push.force",
             says="goes with `point`"),
    BadScene("force_off_the_nodes", "push: {surface: block.xmin, traction: [60, 0, 0],", "push: {body: block, point: [0.1, 0, 0], force: [1, 0, 0],",
             "push.point", says="no vertex of 'block'"),
    BadScene("force_on_a_block", "push: {surface: block.xmin, traction:", "push: {body: block, force:", "push.force", says="is not rigid"),
    BadScene("turn_of_a_block", "rigid: {body: floor, components: [x, y, z]}", "rigid: {body: floor, components: [x, y, z, rx]}",
             "rigid.components", says="x, y, z."),
    BadScene("rigid_held_twice", *tool(f"reference: [5, 0, 0], {CUBE}"), "drag.components", says="'hold' prescribes x"),
    BadScene("rigid_by_its_surface", *tool(f"reference: [5, 0, 0], {CUBE}"), "rigid.surface", says="at its reference point"),
    BadScene("rigid_with_a_gradient", *tool(f"reference: [5, 0, 0], {CUBE}"), "rigid.gradient", says="by `rotate`"),
    BadScene("turn_that_is_free", *tool(f"reference: [5, 0, 0], {CUBE}"), "rigid.rotate", says="rx is not among"),
    BadScene("rigid_under_traction", *tool(f"reference: [5, 0, 0], {CUBE}", "more: {surface: tool.xmin, pressure: 1}"), "more.surface",
             says="give its body a `force`"),
    BadScene("rigid_without_mass", *tool(f"reference: [5, 0, 0], {CUBE}", "more: {body: tool, gravity: [0, 0, -1]}"), "tool.mass"),
    BadScene("rigid_that_spins", *tool(f"reference: [5, 0, 0], {CUBE}", "more: {body: tool, centrifugal: [0, 0, 1]}"), "more.centrifugal"),
    BadScene("both_rigid", *tool(f"reference: [5, 0, 0], {CUBE}", "other: {type: rigid, reference: [0, 0, 0], from: analytic, shape: "
             "plane, point: [0, 0, 0], direction: [0, 0, 1]}\nbetween: {nonmortar: tool.zmin, mortar: other.surface}"), "between.mortar",
             says="both sides are rigid"),
    BadScene("rigid_and_condensed", *tool("reference: [5, 0, 0], from: box, lower: [5, 0, 0], upper: [6, 1, 1], cells: [1, 1, 1]",
             "between: {nonmortar: tool.zmin, mortar: floor.zmax}"), "between.nonmortar", says="the mortar side only",
             options=("-unknowns", "displacements")),
]
# What the lists must name besides.
LISTS = {
    "rigid_held_twice": (("supports: [planestrain, rigid]", "supports: [planestrain, rigid, hold, drag]\n"
                          "hold: {body: tool, components: [x, y, z]}\ndrag: {body: tool, components: [x, rz]}"),),
    "rigid_by_its_surface": (("rigid: {body: floor,", "rigid: {surface: tool.xmin,"),),
    "rigid_with_a_gradient": (("rigid: {body: floor,", "rigid: {body: tool, gradient: [0, 0, 0, 0, 0, 0, 0, 0, 1],"),),
    "turn_that_is_free": (("rigid: {body: floor,", "rigid: {body: tool, rotate: [1, 0, 0],"),),
    "both_rigid": (("floor, tool]", "floor, tool, other]"), ("interfaces: [base]", "interfaces: [base, between]")),
    "rigid_and_condensed": (("interfaces: [base]", "interfaces: [base, between]"),),
}
for name in ("rigid_under_traction", "rigid_without_mass", "rigid_that_spins"):
    LISTS[name] = (("loads: [press, push]", "loads: [press, push, more]"),)


def write_bad_scene(bad, folder):
    """Path of the scene file with the mistake."""
    text = (SCENES / bad.base).read_text()
    if bad.old not in text:
        raise ValueError(f"{bad.base} no longer contains '{bad.old}': bad scene {bad.name} must be rewritten")
    path = folder / f"{bad.name}.yaml"
    named = (MESHES / "brick_tet_upper.msh").read_text()
    nameless = re.sub(r"\$PhysicalNames.*\$EndPhysicalNames\n", "", named, flags=re.DOTALL)
    (folder / "nameless.msh").write_text(nameless)
    (folder / "lines.stl").write_text("solid lines\n" + "vertex 5 0 0\nvertex 6 0 0\nvertex 6 0 0\n" + "endsolid\n")
    (folder / "one_row.txt").write_text("# X Y Z ux uy uz\n0 0 0 0 0 0\n")
    (folder / "prism.msh").write_text(PRISM)
    (folder / "pyramid.msh").write_text(PYRAMID)
    (folder / "prism_2.msh").write_text(PRISM_2)
    (folder / "tet_3.msh").write_text(TET_3)
    text = text.replace(bad.old, bad.new, 1).replace("../meshes", str(MESHES))
    for old, new in LISTS.get(bad.name, ()):
        if old not in text:
            raise ValueError(f"{bad.base} no longer contains '{old}': bad scene {bad.name} must be rewritten")
        text = text.replace(old, new, 1)
    path.write_text(text)
    return path
