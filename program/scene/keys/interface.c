/* Keys of interfaces. */
#include "scene/keys.h"

static const char PAGE[] = "c_examples/scenes/interface.md";

/* In the README: what a user meets first. */
static const Key FIRST[] = {
  {"nonmortar", KEY_NAME, "name or list of surfaces", ANY, REQUIRED,
   "the surface that has the multipliers. Take the one that stays covered: the smaller one, or the one that slides on the other; of two that stay "
   "covered the softer, of equally soft ones the finer"},
  {"mortar", KEY_NAME, "name or list of surfaces", ANY, REQUIRED, "the other surface"},
  {"law", KEY_WORD, "coulomb none tied rough tresca cohesion weakening orthotropic", ANY, "`coulomb` where there is friction, `none` where there is not",
   "what holds the surfaces ([what each means](interface.md#laws-and-their-coefficients))"},
  {"friction", KEY_NUMBER, "", FROM(0), "0", "Coulomb's coefficient"},
  {"offset", KEY_NUMBER, "L", ANY, "0",
   "how far the surfaces that are meant are apart beyond their meshes: a clearance above 0, an interference below ([more](interface.md#offsets))"},
  {"round", KEY_WORD, "cylinder sphere circle", ANY, "",
   "the sides are faceted, and are to count as round; `circle` in the plane ([with their radii](interface.md#round-shapes))"},
  {"adjust", KEY_NUMBER, "L", ABOVE(0), "",
   "a tolerance: nodes of the non-mortar side that are so close to the mortar side, or so deep in it, are put onto it at the start, without strain "
   "([more](interface.md#nodes-that-are-moved))"},
  {"crease_angle", KEY_NUMBER, "degrees", FROM_BELOW(0, 180), "40",
   "an edge across which facets differ by more is sharp, and each side of it has a normal and multipliers of its own. 0: no edge is sharp "
   "([more](interface.md#sharp-edges))"},
  {"search_distance", KEY_NUMBER, "L", FROM(0), "[the library's](interface.md#who-meets-whom)",
   "facets farther apart than this along the normal do not meet. Give it where the bodies start deeper in each other than a facet, or where mortar "
   "surfaces lie in layers"},
  {"weak_coverage", KEY_NUMBER, "", WITHIN(-1, 1), "[the library's](interface.md#who-meets-whom)",
   "0.5 where surfaces slide off an edge, or where nodes become covered as the other body comes, as on a non-mortar side that is the larger one. "
   "Else leave it out"},
};

static const Key LAWS[] = {
  {"shear_limit", KEY_NUMBER, "F/L^2", FROM(0), "", "of `tresca`: the largest shear traction"},
  {"cohesion", KEY_NUMBER, "F/L^2", FROM(0), "", "of `cohesion`: the shear traction that a closed node bears without pressure"},
  {"friction_after", KEY_NUMBER, "", FROM(0), "",
   "of `weakening`: the coefficient from `critical_slip` on. Before it the coefficient falls in proportion"},
  {"critical_slip", KEY_NUMBER, "L", ABOVE(0), "", "of `weakening`: counted as the way since the start"},
  {"friction_across", KEY_NUMBER, "", ABOVE(0), "",
   "of `orthotropic`, in space: the coefficient across `direction`. Both coefficients are above 0. The body slips at a right angle to the ellipse "
   "of both"},
  {"direction", KEY_NUMBERS, "`[x, y, z]`", ANY, "",
   "of `orthotropic`: along it `friction` counts. It is projected on the surface, and stays in space where bodies turn"},
};

static const Key LAYER[] = {
  {"overclosure", KEY_NUMBERS, "list [L]", ANY, "", "a layer that yields: by how much the surfaces overlap, growing"},
  {"overclosure_pressure", KEY_NUMBERS, "list [F/L^2]", ANY, "", "the pressure there, growing from 0"},
  {"wear", KEY_NUMBER, "L^2/F", FROM(0), "0", "depth that is worn off a pressure and a slip"},
  {"bond_stiffness", KEY_NUMBER, "F/L^3", ABOVE(0), "", "a bond: traction an opening before damage"},
  {"bond_strength", KEY_NUMBER, "F/L^2", ABOVE(0), "", "the largest traction in tension"},
  {"bond_toughness", KEY_NUMBER, "F/L", ABOVE(0), "", "the work to part an area"},
  {"bond_shear", KEY_NUMBER, "", ABOVE(0), "1", "the strength in shear over that in tension"},
};

static const Key OFFSETS[] = {
  {"offset_at", KEY_NUMBERS, "`[x, y, z, h, ...]`, in the plane `[x, y, h, ...]` [L]", ANY, "",
   "offsets of single nodes of the non-mortar side, in place of `offset` there"},
  {"offset_curve", KEY_CURVE, "", ANY, "1",
   "a factor on both over time, as a load's `curve`. `[0, 0, 1, 1]` presses an interference in over the first unit of time"},
};

static const Key ROUND[] = {
  {"nonmortar_radius", KEY_NUMBER, "L", ANY, "",
   "of the round non-mortar side: above 0 of a shaft or a ball, below 0 of a bore. A side without is not round. The facets show on which side the "
   "body is: a wrong sign is refused"},
  {"mortar_radius", KEY_NUMBER, "L", ANY, "", "the same of the mortar side"},
  {"centre", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "0", "of the shapes"},
  {"axis", KEY_NUMBERS, "`[x, y, z]`", ANY, "", "of a cylinder, which needs it"},
};

static const Key MEETING[] = {
  {"coverage_min", KEY_NUMBER, "", FROM_BELOW(0, 1), "the library's, 1e-8",
   "the part of a node's area at and below which it counts as uncovered. 1e-3 where a body hangs over an edge and `weak_coverage` is not wanted"},
  {"new_contact", KEY_WORD, "frictionless friction", ANY, "frictionless",
   "of a node that had no facet opposite at the end of the last step, and that no neighbour carries. `frictionless`: for one step, which is cut "
   "back where such nodes carry more than 2 % of the pressure. `friction`: it has friction, which nothing determines where it sticks"},
  {"initial_contact", KEY_SWITCH, "", ANY, "true",
   "nodes that touch at the start are slightly compressed there, so that a body held by contact alone has a support in the first iteration. "
   "`false`: lambda = 0"},
  {"mortar_side", KEY_WORD, "deformable rigid", ANY, "what the library sees",
   "`rigid`: every displacement of the mortar side is prescribed, and the tangent has no columns for it"},
};

static const Key LIMITS[] = {
  {"turn_max", KEY_NUMBER, "radians", WITHIN(0, 3.14159265358979324), "the library's, pi / 9 (20 degrees)",
   "how far a surface may turn in one step. More where a soft body springs off an edge: it turns at once, in however small a step. With friction a "
   "step is cut back, too, in which both sides spin by more against each other about their normal"},
  /* A block drawn over a plate by 3 facets a step of committed weights was pressed 7 per cent too hard, by 0.3 of a facet 0.02 per cent. */
  {"slide_max", KEY_NUMBER, "", ABOVE(0), "0.5",
   "with frozen weights, how far the surfaces may slide, in sizes of the facets around a node, however many these are. Contact is sought, and "
   "forces act on the mortar side, where the surfaces were when the weights were made. With `weights: committed` that is within one step, and a "
   "longer step is cut back. With `reference` it is since the start, and the run warns once"},
  /* What a mesh shows of a contact's force. */
  {"lag_max", KEY_NUMBER, "", ABOVE(0), "0.1",
   "with normals of the step's start, the part of the interface's force that may be wrong because surfaces have turned since; of what slips, of "
   "friction's. A step that turns farther is cut back, and so is one in which a node's traction is wrong by as much of the largest. The run warns "
   "once from a node's 0.01 on. `normals: current` has none"},
  {"lag_corrected", KEY_SWITCH, "", ANY, "where `lag_max` is below 1",
   "whether a converged step is solved again with the normals that it has reached, until these stay to 0.002. It is done where the step's force is "
   "wrong by more than 0.02, or a node is beyond `lag_max`. Not with `dynamics`, `weights: reference`, and points that decide with friction: there "
   "the step is cut back"},
};

static const Key METHOD[] = {
  {"method", KEY_WORD, "default paper", ANY, "default",
   "`default`: dual multipliers, weights and normals of now, as far as they go with what else an interface says. `paper`: the element of the paper: "
   "standard multipliers, weights of now, normals of the last step"},
};

static const Key ELEMENT[] = {
  {"weights", KEY_WORD, "auto current committed reference conserving", ANY, "`auto`, or as `method` says",
   "mortar weights, by which surfaces slide: the next table"},
  {"normals", KEY_WORD, "auto committed current", ANY, "`auto`, or as `method` says",
   "`auto`: `current`, but with frozen weights or normals of the host `committed`. `current`: of now, so that forces do not depend on how a motion "
   "is split into steps. `committed`: of the last step, as in the paper; where curved surfaces slide or turn forces lag behind by half a step"},
  {"basis", KEY_WORD, "auto standard dual", ANY, "`auto`, or as `method` says",
   "of the multipliers. `auto`: `dual`, but with `multiplier_space: sub` or `weights: conserving` `standard`. `dual`: tractions that do not "
   "oscillate beside edges and on curved surfaces. `standard`: the paper's"},
  {"multiplier_space", KEY_WORD, "corner sub", ANY, "corner",
   "of quadratic faces: multipliers at corners alone, or with `sub` at every node, where `basis` is `standard` by default. To tie quadratic cells "
   "take `basis: standard`: with it the error of strains falls with the square of a facet, with `dual` by its power of 1.5 (`ctest -R "
   "accept_quadratic_tied`)"},
  {"decision", KEY_WORD, "nodes points", ANY, "nodes",
   "what is open or closed. With `points` of the facets the border of the contact lies inside facets. [What goes with it](#points-that-decide)"},
  {"form", KEY_WORD, "multiplier augmented", ANY, "multiplier", "of the equations; `multiplier` is sparser, and the answer is the same"},
  {"slip", KEY_WORD, "objective increment paper", ANY, "objective", "slip increment; `paper`: as printed there"},
  {"quadrature", KEY_WORD, "degree_5 degree_10 degree_1 degree_2 degree_4 degree_6", ANY, "degree_5",
   "rule on the triangles of an overlap: `degree_1` has 1 point, `degree_2` 3, `degree_4` 6, `degree_5` 7, `degree_6` 12, `degree_10` 36. What each "
   "costs and gives: [accuracy](../../docs/accuracy.md)"},
  {"integration", KEY_WORD, "segments elements hybrid", ANY, "segments",
   "`segments`: over overlaps of facets, exact on flat ones. `elements`: over points of each non-mortar facet, wherever they fall: no patch test is "
   "met, and with dual multipliers every facet must be covered by enough of its points, or it is refused. `hybrid`: `elements`, with overlaps where "
   "a facet is partly covered"},
  {"points", KEY_WHOLE, "", WITHIN(2, 10), "the library's, 4", "of `elements` and `hybrid` along a side"},
  {"tangent", KEY_WORD, "exact frozen_weights frozen_normals", ANY, "exact",
   "Newton's matrix, or it without the weights' derivatives, or without the tilt of facets; the answer is the same"},
  {"row_scale", KEY_WORD, "force none", ANY, "force",
   "unit of the multiplier rows: `force`, with which line searches compare them with forces; `none`: as in the paper, force-free. Whether a step "
   "has converged does not depend on it"},
  {"augmentation", KEY_NUMBER, "F/L^3", ABOVE(0), "0.1 E / sqrt(nodal area)",
   "r. The answer does not depend on it, only the path of Newton's method; with `decision: points` it does, and the default is 0.9 E* over the "
   "facets' size"},
  {"modulus", KEY_NUMBER, "F/L^2", ABOVE(0), "that of the softer body",
   "the E to use in that default. With `decision: points` the modulus E* of both bodies together"},
  {"augmentation_scale", KEY_NUMBER, "", ABOVE(0), "1", "a factor on either, for trying that out; not with `decision: points`"},
  {"shortcuts", KEY_SWITCH, "", ANY, "true", "`false`: the library leaves out nothing on its own account; the answer is the same"},
};

const KeyTable KEYS_INTERFACE[] = {
  KEY_TABLE("interface", "interfaces", "An interface", "c_examples/scenes/README.md", FIRST),
  KEY_TABLE("laws", "interfaces", "Coefficients of laws", PAGE, LAWS),
  KEY_TABLE("layer", "interfaces", "What lies between the surfaces", PAGE, LAYER),
  KEY_TABLE("offsets", "interfaces", "Offsets", PAGE, OFFSETS),
  KEY_TABLE("round", "interfaces", "Round shapes", PAGE, ROUND),
  KEY_TABLE("meeting", "interfaces", "Who meets whom", PAGE, MEETING),
  KEY_TABLE("limits", "interfaces", "Limits that cut steps back", PAGE, LIMITS),
  KEY_TABLE("method", "scene", "How contact is computed, for comparisons", PAGE, METHOD),
  KEY_TABLE("element", "interfaces", "How it is computed, for comparisons", PAGE, ELEMENT),
  KEY_TABLES_END};
