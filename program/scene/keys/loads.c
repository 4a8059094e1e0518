/* Keys of supports, loads and springs. */
#include "scene/keys.h"

static const char PAGE[] = "c_examples/scenes/loads.md";

static const Key SUPPORTS[] = {
  {"surface", KEY_NAME, "name or list of surfaces", ANY, "", "what is held: all vertices of these"},
  {"body", KEY_NAME, "name or list of bodies", ANY, "",
   "or: all vertices of these, those in `within`, or the one at `point`; or one rigid body, at its reference point"},
  {"within", KEY_NUMBERS, "`[x0, y0, z0, x1, y1, z1]` [L]", ANY, "", "of the bodies' vertices those in this box"},
  {"point", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "", "of the body's vertices the nearest one to this point"},
  {"tolerance", KEY_NUMBER, "L", ANY, "1e-6 of the body's size", "how far from `point` it may lie"},
  {"components", KEY_NAME, "list of `x`, `y`, `z`, `rx`, `ry`, `rz`", ANY, REQUIRED,
   "of the displacement; rx, ry and rz are turns about axes through the reference point of a rigid body (in the plane rz)"},
  {"value", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "0", "the displacement at factor 1; those of other components are ignored"},
  {"gradient", KEY_NUMBERS, "9 numbers", ANY, "0", "of a linear field, row by row"},
  {"origin", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "0", "where the linear field vanishes, and the axis of `rotate` goes through"},
  {"file", KEY_FILE, "", ANY, "",
   "a text file with a row `X Y Z ux uy uz` per vertex, six numbers in any order of rows, `#` before remarks: any field, as that of a coarser "
   "model. Every supported vertex needs a row, which may be 1e-6 of the model's size away"},
  {"rotate", KEY_NUMBERS, "`[x, y, z]`, in the plane one number [radians]", ANY, "0",
   "the axis through `origin`, as long as the angle at factor 1. Of a rigid body: each step turns it about the reference point by the rotation "
   "vector that is added in the step, in the components named; the others are free"},
  {"rotate_curve", KEY_CURVE, "", ANY, "as `curve`", "a factor of its own for the angle"},
  {"curve", KEY_CURVE, "", ANY, "from 0 at t = 0 to 1 at the last step", "factor over time, linear between, constant outside"},
};

static const Key TIMED[] = {
  {"from", KEY_NUMBER, "T", FROM(0), "0",
   "it holds after this time, which lies within the run: each node is held where it is then, and moved from there by what the support says from "
   "then on. 0: from the start, where the support says"},
  {"until", KEY_NUMBER, "T", ANY, "",
   "it is let go after this time, the end of the run at the latest. Its reaction of then stays as a dead force and fades linearly"},
  {"fade", KEY_NUMBER, "T", FROM(0), "one step; with `dynamics` 0",
   "how long that takes. One step is up to the next end of a step that `times`, `stages` or `count` ask for, and with `automatic: true` no longer "
   "than `initial`: while it lasts the model has a force that the scene does not name. 0: it is gone at once, a jump that a smaller step does not "
   "soften; with `dynamics` what is let go begins to move"},
};

static const Key EVERY[] = {
  {"curve", KEY_CURVE, "", ANY, "from 0 at t = 0 to 1 at the last step",
   "as of a [support](#a-support); of `centrifugal` a factor on the force, not on the speed"},
};

static const Key ON_SURFACES[] = {
  {"surface", KEY_NAME, "name or list of surfaces", ANY, "", "where it acts"},
  {"traction", KEY_NUMBERS, "`[x, y, z]` [F/L^2]", ANY, "",
   "per reference area: a dead load, whose direction and amount stay as they are while the body moves and strains, whatever its material"},
  {"pressure", KEY_NUMBER, "F/L^2", ANY, "",
   "against the outward normal of the undeformed surface: dead, too. A surface that turns by more than 0.1 radians under it is told, and is in "
   "`summary.json` under `pressures_turned`"},
  {"follower", KEY_SWITCH, "", ANY, "false",
   "`true`: the pressure acts on the surface as it is now, on its area and against its normal of now. The matrix has what this adds"},
  {"into", KEY_NAME, "name or list of interfaces", ANY, "", "between whose sides the pressure gets: [a fluid and its seal](#a-fluid-and-its-seal)"},
  {"outlet", KEY_NAME, "name or list of surfaces", ANY, "",
   "with `into`: where it must not come; when it does, the run tells, and at which pressure"},
};

static const Key SPREAD[] = {
  {"surface", KEY_NAME, "name or list of surfaces", ANY, "",
   "what it is spread over, which may strain as it likes, so that force and moment do work on its mean displacement and mean turn (weights: the "
   "areas of its nodes)"},
  {"force", KEY_NUMBERS, "`[x, y, z]` [F]", ANY, "", "a dead force on the arms of the undeformed body"},
  {"moment", KEY_NUMBERS, "`[x, y, z]`, in the plane one number [F L]", ANY, "",
   "dead, too: a step after which a surface with a moment has turned by more than 0.02 radians is refused"},
  {"point", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "the middle of the surface", "where the force acts"},
};

static const Key ON_A_NODE[] = {
  {"body", KEY_NAME, "name", ANY, "", "the body of the node"},
  {"point", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "", "where the node is"},
  {"tolerance", KEY_NUMBER, "L", ANY, "1e-6 of the body's size", "how far from `point` it may lie"},
  {"force", KEY_NUMBERS, "`[x, y, z]` [F]", ANY, "", "on it. A node does not turn: a moment is refused"},
};

static const Key ON_BODIES[] = {
  {"body", KEY_NAME, "name or list of bodies", ANY, "", "they need a `density`; rigid ones need a `mass`, and take `gravity` alone"},
  {"gravity", KEY_NUMBERS, "`[x, y, z]` [L/T^2]", ANY, "", "an acceleration; in an axisymmetric model along the axis"},
  {"centrifugal", KEY_NUMBERS, "`[x, y, z]` [1/T]", ANY, "",
   "an axis through `origin` about which the body turns, as long as its radians per unit of time; one number in the plane (about z) and in an "
   "axisymmetric model (about its axis). Distances are those of the undeformed body"},
  {"origin", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "0", "a point of that axis"},
};

static const Key ON_RIGID[] = {
  {"body", KEY_NAME, "name or list of rigid bodies", ANY, "", "what it acts on"},
  {"force", KEY_NUMBERS, "`[x, y, z]` [F]", ANY, "", "at the reference point"},
  {"moment", KEY_NUMBERS, "`[x, y, z]`, in the plane one number [F L]", ANY, "", "force and moment keep their directions while the body turns"},
};

static const Key SPRINGS[] = {
  {"surface", KEY_NAME, "name or list of surfaces", ANY, "",
   "without `to`: each point of these is held by the ground: `stiffness` per reference area (of the thickness, or of the whole ring). With `to`: "
   "one surface, whose mean displacement is the end's (weights: the areas of its nodes)"},
  {"body", KEY_NAME, "name", ANY, "", "or: its node at `point`; or one rigid body, at its reference point. Springs hold no turns"},
  {"point", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "", "where the node is"},
  {"tolerance", KEY_NUMBER, "L", ANY, "1e-6 of the body's size", "how far from `point` it may lie"},
  {"to", KEY_NAME, "name", ANY, "the ground", "the other end: a surface, or a rigid body, or with `to_point` another body"},
  {"to_point", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "",
   "the node of the body `to`; without `to` a place that does not move, as the end of an axial spring"},
  {"stiffness", KEY_NUMBERS, "`[x, y, z]`, of an axial spring one number [F/L], per area [F/L^3]", FROM(0), REQUIRED,
   "the force along each axis is so many times the displacement of the first end from the second one along it: linear, whatever the bodies do. In "
   "an axisymmetric model the radial one is for surfaces on the ground"},
  {"axial", KEY_SWITCH, "", ANY, "false",
   "`true`: the force acts along the line between the ends as it is now: k (l - L). Ends may turn about each other as far as they like. The matrix "
   "has what the turn adds"},
  {"length", KEY_NUMBER, "L", FROM(0), "as long as in the undeformed model", "of an axial spring without force, L"},
};

const KeyTable KEYS_LOADS[] = {
  KEY_TABLE("support", "supports", "A support", PAGE, SUPPORTS),
  KEY_TABLE("timed", "supports", "A support for a part of the run", PAGE, TIMED),
  KEY_TABLE("load", "loads", "A load", PAGE, EVERY),
  KEY_TABLE("on-surfaces", "loads", "Traction or pressure on a surface", PAGE, ON_SURFACES),
  KEY_TABLE("spread", "loads", "Force and moment spread over a surface", PAGE, SPREAD),
  KEY_TABLE("on-a-node", "loads", "A force on a node", PAGE, ON_A_NODE),
  KEY_TABLE("on-bodies", "loads", "Weight and rotation of bodies", PAGE, ON_BODIES),
  KEY_TABLE("on-rigid-bodies", "loads", "Force and moment on rigid bodies", PAGE, ON_RIGID),
  KEY_TABLE("spring", "springs", "A spring", PAGE, SPRINGS),
  KEY_TABLES_END};
