/* Interfaces as the scene describes them: surfaces, law, form, and which multiplier components are unknowns at all. */
#include "contact/skin.h"

/* E of the softest body that an interface's nodes belong to; and the modulus where it cannot widen of the softer side, each taken as its stiffest
 * body. What is wholly prescribed is rigid. */
static PetscErrorCode find_young(const Contact *contact, Interface *interface)
{
  PetscReal least[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, stiffest[2] = {0, 0};
  PetscFunctionBegin;
  for (PetscInt k = 0; k < interface->n1 + interface->n2; k++) {
    const PetscInt  body     = mesh_body_of(contact->mesh, interface->nodes[k]);
    const Material *material = &contact->physics->materials[body];
    PetscReal      *side     = &stiffest[k >= interface->n1];
    if (contact->mesh->bodies[body].rigid) *side = PETSC_MAX_REAL;
    if (interface->prescribed[k] == 7 || contact->mesh->bodies[body].rigid) continue;
    least[0] = PetscMin(least[0], material->young);
    least[1] = PetscMin(least[1], material->density);
    *side = PetscMax(*side, material_confined(material));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 2, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, stiffest, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  interface->young   = least[0] == PETSC_MAX_REAL ? contact->physics->materials[0].young : least[0]; /* nothing moves */
  /* of a layer that lies against a rigid body */
  interface->density = PetscMax(stiffest[0], stiffest[1]) < PETSC_MAX_REAL || least[1] == PETSC_MAX_REAL ? 0 : least[1];
  for (int side = 0; side < 2; side++)
    stiffest[side] = stiffest[side] > 0 ? stiffest[side] : PETSC_MAX_REAL;
  interface->confined = PetscMin(stiffest[0], stiffest[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A plane, sphere or cylinder: the options tell the library its shape. */
static void describe_analytic(Scene *scene, Interface *interface)
{
  if (!interface->surface[1]->analytic) return;
  if (scene_has(scene, interface->name, "mortar_side"))
    scene_fail(scene, interface->name, "mortar_side", "the mortar side is an analytic body, and rigid; leave the key out.");
  interface->options.mortar_side = STICKSLIP_MORTAR_ANALYTIC;
  interface->options.shape       = (int32_t)interface->surface[1]->shape;
  interface->options.radius      = interface->surface[1]->radius;
}

/* With multipliers at corners all components of a node that is no corner of a face go, in the middle of edges and faces. */
static PetscErrorCode remove_middles(const Mesh *mesh, Interface *interface)
{
  const PetscInt           space    = interface->method.multiplier_space;
  const Surface           *surface  = interface->surface[0];
  PetscInt                *corner, *marks;
  PetscFunctionBegin;
  if (space == STICKSLIP_SPACE_SUB) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(interface->n1 + interface->n2, &corner, surface->offsets[surface->n_faces], &marks));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const PetscInt first = surface->offsets[f], n = cell_corners(mesh_face_kind(mesh, surface, f));
    for (PetscInt k = 0; k < n; k++)
      marks[first + k] = 1;
  }
  PetscCall(PetscSFReduceBegin(interface->corners[0], MPIU_INT, marks, corner, MPI_MAX));
  PetscCall(PetscSFReduceEnd(interface->corners[0], MPIU_INT, marks, corner, MPI_MAX));
  for (PetscInt a = 0; a < interface->n1; a++) {
    interface->middle[a] = (PetscBool)!corner[a];
    if (interface->middle[a]) interface->removed[a] = 7;
  }
  PetscCall(PetscFree2(corner, marks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One side of the two may be rigid, and what the library does not do with it is told here by name. */
static void check_rigid(Scene *scene, const Contact *contact, const Interface *interface)
{
  const Body *sides[2];
  for (int side = 0; side < 2; side++)
    sides[side] = &contact->mesh->bodies[interface->body[side]];
  if (sides[0]->rigid && (sides[1]->rigid || sides[1]->analytic))
    scene_fail(scene, interface->name, "mortar", "both sides are rigid: nothing would tell how a force between them is spread.");
  if (sides[0]->rigid && contact->condensed)
    scene_fail(scene, interface->name, "nonmortar",
               "'%s' is rigid: with `unknowns: displacements` it can be the mortar side only, for its nodes have no equations "
               "that multipliers could be found from.",
               sides[0]->name);
  if (sides[0]->rigid && interface->offsets.adjust > 0)
    scene_fail(scene, interface->name, "adjust", "the non-mortar side is rigid: its nodes do not move one by one.");
}

/* Default stiffness, removed components; `symmetry`: see symmetry_mask() */
static PetscErrorCode settle_nodes(Scene *scene, Contact *contact, Interface *interface, const PetscInt symmetry[])
{
  const Mesh    *mesh        = contact->mesh;
  const PetscInt n1          = interface->n1, n2 = interface->n2;
  PetscInt       mortar_mask = 7;

  PetscFunctionBegin;
  /* A component is no unknown where it is prescribed on both sides: at the node, and on the mortar side everywhere, or
   * where a plane of symmetry cuts both. */
  for (PetscInt b = 0; b < n2; b++)
    mortar_mask &= interface->prescribed[n1 + b];
  for (PetscInt a = 0; a < n1 && interface->skin; a++) /* any node may lie opposite */
    mortar_mask &= interface->prescribed[a];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mortar_mask, 1, MPIU_INT, MPI_BAND, PETSC_COMM_WORLD));
  if (interface->options.mortar_side == STICKSLIP_MORTAR_RIGID && mortar_mask != 7)
    scene_fail(scene, interface->name, "mortar_side", "'%s' is not rigid: support all of it in %s.", interface->surface[1]->name,
               mesh->dimension == 3 ? "x, y and z" : "x and y");
  describe_analytic(scene, interface);
  if (!interface->skin) check_rigid(scene, contact, interface);
  PetscCall(PetscMalloc2(n1, &interface->removed, n1, &interface->has_been));
  PetscCall(PetscCalloc1(n1, &interface->middle));
  for (PetscInt a = 0; a < n1; a++)
    interface->removed[a] = (interface->prescribed[a] & mortar_mask) | symmetry[a];
  PetscCall(remove_middles(mesh, interface));
  PetscCall(PetscArraycpy(interface->has_been, interface->removed, n1));
  PetscCall(condensed_refuse_supported(scene, contact, interface));

  PetscCall(find_young(contact, interface));
  PetscCall(decision_settle(contact, interface));
  if (interface->method.augmentation == 0 && interface->options.modulus == 0)
    interface->options.modulus = interface->young;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The scene's space, as the library has it. */
static void read_model(const Space *space, Interface *interface)
{
  static const int32_t models[] = {STICKSLIP_MODEL_SOLID, STICKSLIP_MODEL_PLANE, STICKSLIP_MODEL_PLANE,
                                   STICKSLIP_MODEL_AXISYMMETRIC}; /* by SPACE_... */
  interface->dimension         = space_dimension(space);
  interface->options.model     = models[space->kind];
  interface->options.thickness = interface->options.model == STICKSLIP_MODEL_PLANE ? space->thickness : 0;
}

/* `mortar_side`, `shortcuts`: left open, the library chooses. */
static void read_effects(Scene *scene, Interface *interface)
{
  static const char *const sides[]   = {"deformable", "rigid", NULL};
  stickslip_options       *options   = &interface->options;
  stickslip_method        *method    = &interface->method;
  PetscInt                 side      = STICKSLIP_MORTAR_DEFORMABLE;
  PetscBool                shortcuts = PETSC_TRUE;

  scene_choice(scene, interface->name, "mortar_side", sides, &side);
  scene_bool(scene, interface->name, "shortcuts", &shortcuts);
  options->mortar_side = (int32_t)side;
  if (!shortcuts)
    method->no_shortcuts = STICKSLIP_SHORTCUT_FRICTIONLESS | STICKSLIP_SHORTCUT_RIGID | STICKSLIP_SHORTCUT_APART |
                            STICKSLIP_SHORTCUT_UNCOVERED;
  else if (scene_has(scene, interface->name, "mortar_side") && side == STICKSLIP_MORTAR_DEFORMABLE)
    method->no_shortcuts = STICKSLIP_SHORTCUT_RIGID;
}

/* How far weights of the reference may turn before that is told, in radians, unless `turn_max` says: so much of the pressure acts as a
 * shear then. As far off are the forces of the linear material at its limit (range.c). */
static const PetscReal TURN_TOLD = 0.03;

/* `method`: the library's own, or the paper's. */
static PetscBool read_paper(Scene *scene)
{
  static const char *const methods[] = {"default", "paper", NULL};
  PetscInt                 method    = 0;
  scene_choice(scene, NULL, "method", methods, &method);
  return (PetscBool)(method == 1);
}

/* All that the scene does not say is the library's choice, or the paper's. */
static PetscErrorCode begin_options(PetscBool paper, Interface *interface)
{
  stickslip_options *options = &interface->options;
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_options_init(options, sizeof(*options)));
  if (paper) PetscCallStickslip(stickslip_options_paper(options));
  interface->method             = paper ? *options->method : (stickslip_method){0};
  interface->method.struct_size = sizeof(interface->method);
  options->method               = &interface->method;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `basis`, `normals`, `weights`, `multiplier_space`, `slip`, `form`, `new_contact`, the augmentation and the search. */
static void read_method(Scene *scene, Interface *interface)
{
  static const char *const weights[]      = {"auto", "current", "committed", "reference", "conserving", NULL};
  static const char *const slips[]        = {"objective", "increment", "paper", NULL};
  static const char *const forms[]        = {"multiplier", "augmented", NULL};
  static const char *const new_contacts[] = {"frictionless", "friction", NULL};
  static const char *const spaces[]       = {"corner", "sub", NULL};
  static const char *const row_scales[]   = {"force", "none", NULL};
  static const char *const bases[]        = {"auto", "standard", "dual", NULL};
  static const char *const normals[]      = {"auto", "committed", "current", NULL};
  stickslip_options       *options        = &interface->options;
  stickslip_method        *method         = &interface->method;
  const char              *name           = interface->name;
  PetscInt  basis = method->multiplier_basis, normal = method->normals, weight = method->weights,
           slip = STICKSLIP_SLIP_OBJECTIVE, form = STICKSLIP_FORM_MULTIPLIER,
           new_contact = STICKSLIP_NEW_CONTACT_FRICTIONLESS, row_scale = STICKSLIP_ROW_SCALE_FORCE, space = STICKSLIP_SPACE_CORNER;
  PetscReal augmentation = 0, modulus = 0, distance = 0, weak_coverage = method->weak_coverage, turn_max = 0, coverage_min = method->coverage_min;

  char      word[NAME_LENGTH] = "";

  interface->turn.most = TURN_TOLD;
  scene_string(scene, name, "slip", word, sizeof(word));
  if (!strcmp(word, "seed")) scene_fail(scene, name, "slip", "'seed' is called 'paper' now.");
  scene_choice(scene, name, "slip", slips, &slip);
  scene_choice(scene, name, "form", forms, &form);
  scene_choice(scene, name, "basis", bases, &basis);
  scene_choice(scene, name, "normals", normals, &normal);
  scene_choice(scene, name, "weights", weights, &weight);
  scene_choice(scene, name, "new_contact", new_contacts, &new_contact);
  scene_choice(scene, name, "row_scale", row_scales, &row_scale);
  scene_choice(scene, name, "multiplier_space", spaces, &space);
  scene_bool(scene, name, "initial_contact", &interface->initial_contact);
  scene_real(scene, name, "augmentation", &augmentation);
  scene_real(scene, name, "modulus", &modulus);
  scene_real(scene, name, "search_distance", &distance);
  scene_real(scene, name, "weak_coverage", &weak_coverage);
  scene_real(scene, name, "coverage_min", &coverage_min);
  scene_real(scene, name, "turn_max", &turn_max);
  scene_real(scene, name, "slide_max", &interface->slide.most);
  scene_real(scene, name, "lag_max", &interface->lag.most);
  interface->lag_corrects = (PetscBool)(interface->lag.most < 1);
  scene_bool(scene, name, "lag_corrected", &interface->lag_corrects);
  if (weak_coverage != STICKSLIP_WEAK_COVERAGE_NONE && (weak_coverage < 0 || weak_coverage > 1))
    scene_fail(scene, name, "weak_coverage", "it is a fraction of an area: from 0 (the library's choice) to 1, or -1: none.");
  method->multiplier_basis = (int32_t)basis;
  method->normals          = (int32_t)normal;
  method->turn_max         = turn_max;
  if (turn_max > 0) interface->turn.most = turn_max;
  method->weights         = weight > STICKSLIP_WEIGHTS_REFERENCE ? STICKSLIP_WEIGHTS_CONSERVING : (int32_t)weight;
  method->slip            = (int32_t)slip;
  method->form            = (int32_t)form;
  method->new_contact     = (int32_t)new_contact;
  method->row_scale       = (int32_t)row_scale;
  method->multiplier_space = (int32_t)space;
  method->augmentation    = augmentation;
  options->modulus         = modulus;
  options->search_distance = distance;
  method->weak_coverage   = weak_coverage;
  method->coverage_min    = coverage_min;
}

/* What a rule is called in a scene, by STICKSLIP_QUADRATURE_... */
static const char *const RULES[] = {"degree_5", "degree_10", "degree_1", "degree_2", "degree_4", "degree_6", NULL};

/* `quadrature`, `integration`, `points`, `tangent`: what accuracy may cost. */
static void read_accuracy(Scene *scene, Interface *interface)
{
  static const char *const integrations[] = {"segments", "elements", "hybrid", NULL};
  static const char *const tangents[]     = {"exact", "frozen_weights", "frozen_normals", NULL};
  stickslip_method        *method       = &interface->method;
  const char              *name         = interface->name;
  PetscInt rule = STICKSLIP_QUADRATURE_DEGREE_5, integration = STICKSLIP_INTEGRATION_SEGMENTS,
           tangent = STICKSLIP_TANGENT_EXACT, points = 0;

  scene_choice(scene, name, "quadrature", RULES, &rule);
  scene_choice(scene, name, "integration", integrations, &integration);
  scene_int(scene, name, "points", &points);
  scene_choice(scene, name, "tangent", tangents, &tangent);
  if (scene_has(scene, name, "points") && integration == STICKSLIP_INTEGRATION_SEGMENTS)
    scene_fail(scene, name, "points", "it needs 'integration: elements' or 'hybrid'.");
  method->quadrature     = (int32_t)rule;
  method->integration    = (int32_t)integration;
  method->tangent        = (int32_t)tangent;
  method->element_points = points;
}

/* `unknowns`: whether the multipliers are among them. */
static void read_unknowns(Scene *scene, Contact *contact)
{
  static const char *const kinds[]   = {"multipliers", "displacements", NULL};
  PetscInt                 unknowns = 0;
  scene_choice(scene, NULL, "unknowns", kinds, &unknowns);
  contact->condensed = (PetscBool)(unknowns == 1);
}

/* An interface's surfaces, and what their nodes are. */
static PetscErrorCode read_nodes(Scene *scene, Contact *contact, Interface *interface)
{
  PetscInt *symmetry;
  PetscReal scale = 0;
  PetscFunctionBegin;
  PetscCall(surfaces_read(scene, contact, interface));
  PetscCall(PetscCalloc1(interface->n1, &symmetry));
  if (interface->skin) PetscCall(skin_symmetry(interface, symmetry));
  else PetscCall(symmetry_mask(contact->physics, interface, symmetry));
  PetscCall(settle_nodes(scene, contact, interface, symmetry));
  scene_real(scene, interface->name, "augmentation_scale", &scale);
  interface->method.augmentation *= scale;
  interface->options.modulus *= scale;
  if (!interface->skin) {
    PetscCall(offsets_place(scene, interface));
    PetscCall(contact_adjust(scene, contact->mesh, interface));
  }
  if (interface->offsets.adjust > 0) PetscCall(surfaces_move(contact, interface));
  PetscCall(PetscFree(symmetry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the same two surfaces two interfaces would have each multiplier twice: only their sum would be known. */
static PetscErrorCode refuse_twice(Scene *scene, const Contact *contact, PetscInt number)
{
  const Interface *interface = &contact->interfaces[number];
  const PetscInt   n         = interface->n1 + interface->n2;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < number; i++) {
    const Interface *other = &contact->interfaces[i];
    PetscBool        same  = (PetscBool)(other->n1 == interface->n1 && other->n2 == interface->n2);
    for (PetscInt k = 0; k < n && same; k++)
      same = (PetscBool)(other->nodes[k] == interface->nodes[k]);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPIU_BOOL, MPI_LAND, PETSC_COMM_WORLD));
    if (same)
      scene_fail(scene, interface->name, "mortar", "its two surfaces are those of '%s': of their multipliers only the sums would be known.",
                 other->name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_read(Scene *scene, Contact *contact)
{
  const PetscBool paper = read_paper(scene), skin = skin_wanted(scene);
  char          **names;
  PetscInt        n_named;

  PetscFunctionBegin;
  read_unknowns(scene, contact);
  scene_names(scene, "interfaces", &n_named, &names);
  contact->n_interfaces = n_named + skin; /* the skin is the last one */
  PetscCall(PetscCalloc1(contact->n_interfaces, &contact->interfaces));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscCall(begin_options(paper, interface));
    read_model(&contact->mesh->space, interface);
    if (i == n_named) {
      PetscCall(skin_read(scene, contact, interface));
      read_method(scene, interface);
      interface->lag_corrects = PETSC_FALSE;
      PetscCall(conserving_choose(contact, interface));
      read_accuracy(scene, interface);
      continue;
    }
    PetscCall(PetscSNPrintf(interface->name, NAME_LENGTH, "%s", names[i]));
    layer_read(scene, interface);
    law_read(scene, &contact->mesh->space, interface);
    mesh_rotate_vector(contact->mesh, interface->law.direction);
    read_effects(scene, interface);
    decision_read(scene, interface);
    read_method(scene, interface);
    PetscCall(conserving_choose(contact, interface));
    read_accuracy(scene, interface);
    PetscCall(offsets_read(scene, contact->physics, interface));
  }
  strings_destroy(n_named, &names);
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    PetscCall(read_nodes(scene, contact, &contact->interfaces[i]));
    PetscCall(decision_hold(scene, contact, &contact->interfaces[i]));
    PetscCall(conserving_look(contact, &contact->interfaces[i]));
    PetscCall(refuse_twice(scene, contact, i));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What multipliers there are beside the displacements, to be taken over by unknowns_create(). */
PetscErrorCode contact_fields(const Contact *contact, Field **fields)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(contact->n_interfaces, fields));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Field *field      = &(*fields)[i];
    field->components = contact->interfaces[i].components;
    PetscCall(PetscSNPrintf(field->name, sizeof(field->name), "%s", contact->interfaces[i].name));
    PetscCall(PetscSNPrintf(field->label, sizeof(field->label), "multiplier.%s", contact->interfaces[i].name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which multipliers are no unknowns: the removed components; without friction, that of a node which is prescribed wholly. Copies of
 * a vertex have the same ones. */
PetscErrorCode contact_label(Contact *contact)
{
  const Mesh *mesh = contact->mesh;
  char        label[2 * NAME_LENGTH];
  PetscInt   *here, *vertices, *values;
  PetscFunctionBegin;
  PetscCall(PetscMalloc3(mesh->n_vertices, &here, mesh->n_vertices, &vertices, mesh->n_vertices, &values));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    PetscInt        *mask, n = 0;
    PetscCall(PetscMalloc1(interface->n1 + interface->n2, &mask));
    for (PetscInt a = 0; a < interface->n1; a++)
      mask[a] = FIELD_COPY * interface->copies[a] +
                (contact->condensed ? 7 : interface->components > 1 ? interface->removed[a] : interface->removed[a] == 7);
    for (PetscInt b = 0; b < interface->n2; b++)
      mask[interface->n1 + b] = -1;
    for (PetscInt v = 0; v < mesh->n_vertices; v++)
      here[v] = -1;
    PetscCall(PetscSFReduceBegin(interface->pieces, MPIU_INT, mask, here, MPI_MAX)); /* of copies the last one's */
    PetscCall(PetscSFReduceEnd(interface->pieces, MPIU_INT, mask, here, MPI_MAX));
    PetscCall(pieces_unite(mesh, here, MPI_MAX));
    for (PetscInt v = 0; v < mesh->n_vertices; v++) {
      if (here[v] < 0) continue;
      vertices[n] = v;
      values[n++] = here[v];
    }
    PetscCall(PetscSNPrintf(label, sizeof(label), "multiplier.%s", interface->name));
    PetscCall(plex_label_vertices(mesh, label, n, vertices, values, 0));
    PetscCall(PetscFree(mask));
  }
  PetscCall(PetscFree3(here, vertices, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
