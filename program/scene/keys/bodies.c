/* Keys of bodies, of surfaces and of the space they are in. */
#include "scene/keys.h"

static const char PAGE[] = "c_examples/scenes/bodies.md";

static const Key BODY[] = {
  {"type", KEY_WORD, "box gmsh analytic hdf5 rigid", ANY, REQUIRED,
   "where the body comes from: [boxes](#boxes), [files](#bodies-from-files), [analytic](#analytic-bodies) and [rigid](#rigid-bodies) bodies"},
  {"young", KEY_NUMBER, "F/L^2", ABOVE(0), REQUIRED, "Young's modulus at small strain; not of an analytic or rigid body"},
  {"poisson", KEY_NUMBER, "", BETWEEN(-1, 0.5), REQUIRED, "Poisson's ratio at small strain; not of an analytic or rigid body"},
  {"material", KEY_WORD, "linear st_venant_kirchhoff neo_hooke", ANY, "linear", "the energy of the body: [materials](#materials)"},
  {"dilatation", KEY_WORD, "pointwise mean", ANY, "pointwise", "whether volumes change point by point: [materials](#materials)"},
  {"density", KEY_NUMBER, "F T^2/L^4", ABOVE(0), "", "mass per reference volume, for loads on bodies and `dynamics`"},
  {"velocity", KEY_NUMBERS, "`[x, y, z]` [L/T]", ANY, "0", "with `dynamics`: velocity at t = 0 ([dynamics](../../docs/dynamics.md))"},
  {"spin", KEY_NUMBERS, "`[x, y, z]`, in the plane one number [1/T]", ANY, "0", "with `dynamics`: the rotation vector per time at t = 0"},
  {"about", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "the origin", "the point that `spin` turns the body about"},
  {"small_strain", KEY_SWITCH, "", ANY, "false",
   "`true`: of `material: linear` the theory of small strain is meant, and no warning is wanted where strains or turns are large"},
};

static const Key FILES[] = {
  {"file", KEY_FILE, "", ANY, REQUIRED, "the mesh"},
  {"volume", KEY_NAME, "name", ANY, "", "of `gmsh`: the physical name of the body, if the file holds several"},
};

static const Key BOXES[] = {
  {"lower", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "", "the corner with the lowest coordinates"},
  {"upper", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "", "the corner opposite to it"},
  {"cells", KEY_NUMBERS, "`[nx, ny, nz]`", ANY, "", "number of cells along x, y, z"},
  {"x", KEY_NUMBERS, "list [L]", ANY, "", "instead, per axis: the positions of the planes of nodes, in increasing order"},
  {"y", KEY_NUMBERS, "list [L]", ANY, "", "the same along y"},
  {"z", KEY_NUMBERS, "list [L]", ANY, "", "the same along z"},
  {"corners", KEY_NUMBERS, "24 numbers [L]", ANY, "",
   "instead of all these: the eight corners (lower face counter-clockwise seen from above, then the upper), mapped trilinearly; with `cells`"},
  {"ball", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "",
   "the box is made round about this point: the cube of half-width s around it becomes the sphere of radius s. Planes through the point along two "
   "axes stay, so a box `[0, 0, -1]` to `[1, 1, 0]` becomes an eighth of a ball about `[0, 0, 0]`"},
  {"cylinder", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, "",
   "the box is made round about the axis through this point; the square of half-width s across it becomes the circle of radius s"},
  {"axis", KEY_WORD, "x y z", ANY, "z", "of `cylinder`"},
  {"polar", KEY_SWITCH, "", ANY, "false",
   "`true`: x is a radius and y an angle in degrees about the z axis. From 0 to 360, or any other full turn, is closed, and has no `ymin` and "
   "`ymax`"},
  {"cell", KEY_WORD, "hex tet tet10 hex20 hex27 quad tri tri6 quad8 quad9", ANY, "`hex`, in the plane `quad`",
   "a `tet` is a sixth of a hexahedron, a `tri` half of a quadrilateral; those with a number are quadratic. Nodes in the middle of edges, faces and "
   "cells are bent as the others are, so that curved sides are followed"},
};

static const Key ANALYTIC[] = {
  {"shape", KEY_WORD, "plane sphere cylinder line circle", ANY, REQUIRED,
   "cylinder and line are endless; `line` and `circle` are of models in the plane and of rings"},
  {"point", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, REQUIRED,
   "a point of the plane or line, the centre of a sphere or circle, a point of the cylinder's axis"},
  {"direction", KEY_NUMBERS, "`[x, y, z]`", ANY, "", "the normal of a plane or line out of the body, the cylinder's axis; any length"},
  {"radius", KEY_NUMBER, "L", ANY, "", "of sphere, cylinder and circle; negative: a cavity, the body is outside"},
};

static const Key RIGID[] = {
  {"reference", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, REQUIRED,
   "the point that its forces act at and that it turns about; at most 1000 times the body's size away from it, for rounding"},
  {"from", KEY_WORD, "box gmsh stl analytic", ANY, REQUIRED,
   "where its surface comes from: `box` or `gmsh`, whose keys it then has (the cells are dropped, only the surfaces stay); `stl`; `analytic`, with "
   "`shape`, `point`, `direction`, `radius` (mortar side only, `form: multiplier`, in space)"},
  {"file", KEY_FILE, "", ANY, REQUIRED,
   "of `stl`: text or binary; its surface is called `body.surface`. Of `gmsh`: a mesh of volumes, or of surface elements alone: each physical "
   "surface is one of the body's, and all of them are `body.surface` where none has a name"},
  {"flip", KEY_SWITCH, "", ANY, "false",
   "of `stl`, and of Gmsh's surface elements: `true` turns the faces round. Neighbours are made to turn alike, and a closed surface has its body "
   "inside; an open one turns as its first face does"},
  {"mass", KEY_NUMBER, "F T^2/L", FROM(0), "0", "for `gravity`, which acts at the reference point, and with `dynamics`"},
  {"density", KEY_NUMBER, "F T^2/L^4", ABOVE(0), "",
   "in place of it: of what a closed surface of flat faces encloses; the reference point must be the centre of mass. With `dynamics` it gives the "
   "inertia"},
  {"inertia", KEY_NUMBERS, "`[xx, yy, zz]` or `[xx, yy, zz, yz, zx, xy]`, in the plane one number [F L T^2]", ANY, "",
   "beside `mass`, asked for by `dynamics` where the body may turn, and looked at wherever it stands: moments of inertia about the reference point"},
};

static const Key SURFACES[] = {
  {"of", KEY_NAME, "name or list of surfaces", ANY, REQUIRED, "what it is cut out of: surfaces of one body, such as the three faces around a corner"},
  {"within", KEY_NUMBERS, "`[x0, y0, z0, x1, y1, z1]` [L]", ANY, "all of it", "it holds the faces whose centre lies in this box"},
};

static const Key SPACE[] = {
  {"model", KEY_WORD, "solid plane_strain plane_stress axisymmetric", ANY, "solid", "the space of the whole scene"},
  {"thickness", KEY_NUMBER, "L", ABOVE(0), "1", "of `plane_strain` and `plane_stress`"},
};

static const Key FRAME[] = {
  {"rotate", KEY_NUMBERS, "`[a, b, c]`, in the plane one number [degrees]", ANY, "0",
   "turns everything about x, then y, then z: geometry, tractions, prescribed displacements. Positions in the scene stay as written. Supports must "
   "then prescribe all of x, y, z"},
};

const KeyTable KEYS_BODIES[] = {
  KEY_TABLE("body", "bodies", "A body", PAGE, BODY),
  KEY_TABLE("files", "bodies", "Bodies from files", PAGE, FILES),
  KEY_TABLE("boxes", "bodies", "Boxes", PAGE, BOXES),
  KEY_TABLE("analytic", "bodies", "Analytic bodies", PAGE, ANALYTIC),
  KEY_TABLE("rigid", "bodies", "Rigid bodies", PAGE, RIGID),
  KEY_TABLE("surface", "surfaces", "A surface cut out of another", PAGE, SURFACES),
  KEY_TABLE("space", "scene", "In the plane", PAGE, SPACE),
  KEY_TABLE("frame", "frame", "The whole scene turned", PAGE, FRAME),
  KEY_TABLES_END};
