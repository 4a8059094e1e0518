/* The rows of bad_input.txt: every function with one argument after the other spoilt, refused by name, nothing written.
 * Here are good values for everything, and where all of it lies. */
#include "bad_functions.h"

#include <stddef.h>

static double skin_expected[SKIN_UNKNOWNS];

static int number_of(const char *name) {
  for (int k = 0; k < COUNT(functions); ++k) {
    if (strcmp(functions[k].name, name) == 0) return k;
  }
  fprintf(stderr, "no function has the name %s\n", name);
  exit(1);
}

/* What a creation that succeeded has left. */
static void end_created(void) {
  stickslip_interface *nothing;
  FILL(nothing);
  if (b.out != nothing) CHECK_OK(stickslip_interface_destroy(&b.out));
  b.out = nothing;
  stickslip_skin *no_skin;
  FILL(no_skin);
  if (b.skin_out != no_skin) CHECK_OK(stickslip_skin_destroy(&b.skin_out));
  b.skin_out = no_skin;
}

static int32_t call(const char *name) {
  const int k = number_of(name);
  end_created();
  if (strcmp(name, "rigid_create") == 0) CHECK_OK(stickslip_rigid_destroy(&b.every.rigid));
  return functions[k].call(functions[k].a);
}

/* Good values for everything, and a pattern in all outputs. */
static void set_up(const char *name, int32_t base) {
  static const int64_t offsets1[] = {0, 3, 6}, shared1[] = {1, 2, 3, 3, 4, 5};
  static const int64_t offsets2[] = {0, 2, 4}, shared2[] = {7, 5, 1, 4};
  const int number = number_of(name);
  memset(&b, 0, sizeof b);
  scene_init_base(&S, base);
  const int carried = strcmp(name, "interface_carriers") == 0;
  if (is_condensed(name) || carried) S.method.multiplier_basis = STICKSLIP_BASIS_DUAL;
  if (carried) scene_slide(&S, 0.9);
  if (strcmp(name, "interface_use_normals") == 0 || strcmp(name, "interface_turn_multipliers") == 0) {
    S.method.normals = STICKSLIP_NORMALS_CURRENT;
  }
  every_init(&b.every);
  memset(&b.every.options, 0x5A, sizeof b.every - offsetof(every, options));
  every_room(&b.every);
  handle_fill(&H);
  scene *s = &S;
  CHECK_OK(stickslip_interface_create(&s->nonmortar, &s->mortar, &s->options, &b.every.other));
  stickslip_states states = {.struct_size = sizeof states, .normal = b.normals};
  CHECK_OK(stickslip_interface_states(s->interface, s->x1, s->x2, s->lambda, NULL, &states));
  CHECK_OK(stickslip_interface_sums(s->interface, s->x1, s->x2, b.sums));
  b.previous = E.w;
  b.imported = b.every.exported;
  b.n_integers = b.imported.n_integers;
  b.n_reals = b.imported.n_reals;
  FILL(b.skin_out);
  if (is_of_skin(name)) {
    skin_scene *skin = &b.every.skin;
    skin_create(skin);
    if (strcmp(name, "skin_initial_multipliers") != 0) {
      CHECK_OK(stickslip_skin_commit(skin->skin, skin->reference, skin->lambda));
    }
    skin_history(skin->skin, &b.skin_imported);
    b.n_integers = b.skin_imported.n_integers;
    b.n_reals = b.skin_imported.n_reals;
    b.pairs = STICKSLIP_PLAN_SKIN;
  }
  b.first_multiplier = b.every.skin.first_multiplier;
  b.body1 = LOWER_BODY;
  b.body2 = UPPER_BODY;
  b.skin_mu = 0.5;
  b.ld = 36;
  b.length = sizeof b.every.last_error;
  b.options_size = sizeof b.every.options;
  b.n_interfaces = 2;
  rigid_parts_init(&b.rigid);
  b.every.turned_motion = b.rigid.motion;
  b.every.rigid = NULL;
  b.n_bodies = 1;
  b.n_entries = 3;
  b.n = 1;
  b.n_rows = UNKNOWNS;
  b.commits = 3;
  b.n_facet = 4;
  b.index_base = base;
  b.which_normals = STICKSLIP_NORMALS_COMMITTED;
  b.angle = 0.5;
  for (int k = 0; k < 3; ++k) b.line_offsets[k] = 2 * k;
  for (int k = 0; k < 4; ++k) b.line_nodes[k] = base + (k + 1) / 2;
  b.line_x[0] = b.line_x[1] = b.line_x[3] = 0; /* two lines at a right angle */
  b.line_x[2] = b.line_x[4] = 1;
  b.line_x[5] = -1;
  b.lines = (stickslip_surface){.struct_size = sizeof b.lines, .n_nodes = 3, .n_facets = 2, .coordinates = b.line_x,
                                .facet_offsets = b.line_offsets, .facet_nodes = b.line_nodes};
  b.scale = b.stiffness = 1.0;
  b.directions[0] = b.directions[4] = b.directions[8] = 1.0;
  b.dx1[0] = 1.0;
  b.tolerance = 0.02;
  b.law = (stickslip_law){.struct_size = sizeof b.law, .kind = STICKSLIP_LAW_COHESION, .cohesion = 1.0};
  for (int k = 0; k < 3; ++k) b.overclosure[k] = 0x1p-10 * k, b.layer_pressure[k] = 1.0 * k;
  b.layer = (stickslip_layer){.struct_size = sizeof b.layer, .n_overclosure = 3, .overclosure = b.overclosure,
                              .pressure = b.layer_pressure, .wear = 0x1p-12, .bond_stiffness = 64.0, .bond_strength = 1.0,
                              .bond_toughness = 1.0, .bond_shear = 1.0};
  b.heat = every_heat_law();
  b.area = 1.0;
  b.shape = STICKSLIP_SHAPE_SPHERE;
  b.radius = 1e4;
  b.point[2] = b.direction[2] = 1e4;
  scene_frame(b.point);
  memcpy(b.offsets1, offsets1, sizeof offsets1);
  memcpy(b.shared1, shared1, sizeof shared1);
  memcpy(b.offsets2, offsets2, sizeof offsets2);
  memcpy(b.shared2, shared2, sizeof shared2);
  for (int a = 0; a < N1; ++a) b.mu[a] = b.r[a] = 1.0;
  for (int k = 0; k < 3; ++k) b.nodes[k] = base + 4;
  FILL(b.answer);
  b.answer.struct_size = sizeof b.answer;
  FILL(b.out);
  for (int k = 0; k < functions[number].n; ++k) {
    const argument *a = functions[number].arguments + k;
    functions[number].a[k] = a->good;
    if (strcmp(a->name, "interface") == 0 && strcmp(name, "interface_destroy") != 0) {
      functions[number].a[k] = *(stickslip_interface **)a->good;
    } else if (strcmp(a->name, "skin") == 0 && strcmp(name, "skin_destroy") != 0) {
      functions[number].a[k] = *(stickslip_skin **)a->good;
    }
  }
  /* As much as is needed, where that can be asked. */
  b.capacity = strcmp(name, "interface_effects") == 0 ? COUNT(b.every.effects) : N1;
  if (strcmp(name, "pair_begin") == 0) {
    b.capacity = stickslip_pair_state_size();
  } else if (strcmp(name, "crosspoints_find") == 0) {
    CHECK_OK(stickslip_crosspoints_find(2, b.offsets1, b.shared1, b.offsets2, b.shared2, 0, NULL, NULL, NULL,
                                        &b.capacity));
  } else if (strcmp(name, "interface_tangent_coo") == 0) {
    CHECK_OK(stickslip_interface_tangent_coo(s->interface, s->x1, s->x2, s->lambda, NULL, 0, NULL, NULL, NULL,
                                             &b.capacity));
  } else if (strcmp(name, "interface_heat_tangent_coo") == 0) {
    CHECK_OK(stickslip_interface_heat_tangent_coo(s->interface, s->x1, s->x2, s->lambda, &b.heat, b.every.heat_t1,
                                                  b.every.heat_t2, b.every.heat_e1, b.every.heat_e2, b.which, 0, NULL, NULL,
                                                  NULL, &b.capacity));
  } else if (strcmp(name, "interface_previous_tangent_coo") == 0) {
    CHECK_OK(stickslip_interface_previous_tangent_coo(s->interface, s->x1, s->x2, s->lambda, 0, NULL, NULL, NULL, &b.capacity));
  } else if (strcmp(name, "interface_pattern_coo") == 0) {
    CHECK_OK(stickslip_interface_pattern_coo(s->interface, s->x1, s->x2, 0, NULL, NULL, &b.capacity));
  } else if (carried) {
    CHECK_OK(stickslip_interface_carriers(s->interface, 0, NULL, NULL, NULL, &b.capacity));
  } else if (strcmp(name, "interface_condensed_coo") == 0) {
    CHECK_OK(stickslip_interface_condensed_coo(s->interface, s->x1, s->x2, s->lambda, b.piece, 0, NULL, NULL, NULL,
                                               &b.capacity));
  } else if (strcmp(name, "interface_condensed_pattern") == 0) {
    CHECK_OK(stickslip_interface_condensed_pattern(s->interface, s->x1, s->x2, UNKNOWNS, H.offsets, H.csr_columns, 0,
                                                   NULL, NULL, &b.capacity));
  }
  if (strcmp(name, "rigid_coo") == 0 || strcmp(name, "rigid_values") == 0) {
    const rigid_parts *r = &b.rigid;
    CHECK_OK(stickslip_rigid_create(1, &r->body, 0, 3, r->rows, r->columns, &b.every.rigid, &b.capacity));
    functions[number].a[0] = b.every.rigid;
  }
  if (strcmp(name, "skin_copies") == 0) b.capacity = SKIN_COPIES;
  if (strncmp(name, "skin_plan_", 10) == 0) {
    CHECK_OK(stickslip_skin_plan(b.every.skin.skin, b.every.skin.x, b.pairs, &b.capacity));
  }
  if (strncmp(name, "interface_plan_", 15) == 0) {
    int64_t rows;
    CHECK_OK(stickslip_interface_plan(s->interface, s->x1, s->x2, STICKSLIP_PLAN_ACTIVE, &rows, &b.capacity));
  } else if (strcmp(name, "interface_condensed_values") == 0) {
    int64_t rows[2], counts[2];
    CHECK_OK(stickslip_interface_condensed_plan(s->interface, s->x1, s->x2, STICKSLIP_PLAN_ACTIVE, rows, counts));
  }
  memcpy(&before, &b, sizeof b);
  scene_residual(s, expected);
  if (b.every.skin.skin) skin_residual(&b.every.skin, skin_expected);
}

static void compare(void) {
  static double residual[UNKNOWNS], state[STATE_SIZE], skin_now[SKIN_UNKNOWNS];
  static history now;
  /* A state has gaps between its members, which hold nothing: of its bytes only what it is known by is compared. */
  memcpy(state, E.state, sizeof state);
  memset(E.state + 1, 0, sizeof state - sizeof *state);
  memset(before.every.e.state + 1, 0, sizeof state - sizeof *state);
  CHECK(memcmp(&b, &before, sizeof b) == 0);
  memcpy(E.state, state, sizeof state);
  memcpy(before.every.e.state, state, sizeof state);
  history_take(S.interface, &now);
  CHECK(history_equal(&b.every.exported, &now));
  scene_residual(&S, residual);
  CHECK(memcmp(residual, expected, sizeof residual) == 0);
  if (!b.every.skin.skin) return;
  skin_history(b.every.skin.skin, &now);
  CHECK(history_equal(&b.skin_imported, &now));
  skin_residual(&b.every.skin, skin_now);
  CHECK(memcmp(skin_now, skin_expected, sizeof skin_now) == 0);
}

static void tear_down(void) {
  end_created();
  CHECK_OK(stickslip_interface_destroy(&b.every.other));
  CHECK_OK(stickslip_rigid_destroy(&b.every.rigid));
  CHECK_OK(stickslip_skin_destroy(&b.every.skin.skin));
  scene_destroy(&S);
}

#define REALS(name, array) bad_place(name, REAL, array, COUNT(array))
#define INTEGERS(name, array) bad_place(name, INT64, array, COUNT(array))
#define NUMBER(type, name) bad_place(#name, type, &b.name, 0)

/* Tells where all lies, under the header's names and those at the head of the rows. */
static void tell(void) {
  for (int f = 0; f < COUNT(functions); ++f) {
    for (int k = 0; k < functions[f].n; ++k) {
      char name[64];
      snprintf(name, sizeof name, "%s:%s", functions[f].name, functions[f].arguments[k].name);
      bad_place(name, functions[f].arguments[k].type, functions[f].a + k, 0);
    }
  }
  bad_struct("pair", "pair", &E.pair);
  bad_struct("facet", "facet", &E.facet);
  bad_struct("node", "node", &E.node);
  bad_struct("answer", "answer", &b.answer);
  bad_struct("response", "response", E.responses);
  bad_struct("responses", "responses[0]", E.responses);
  bad_struct("responses", "responses[1]", E.responses + 1);
  bad_struct("responses", "responses[2]", E.responses + 2);
  bad_struct("responses", "responses[3]", E.responses + 3);
  bad_struct("options", "options", &S.options);
  bad_struct("method", "method", &S.method);
  bad_struct("surface", "nonmortar", &S.nonmortar);
  bad_struct("surface", "mortar", &S.mortar);
  bad_struct("states", "states", &H.states);
  bad_struct("counters", "counters", &b.every.counters);
  bad_struct("report", "report", &b.every.report);
  bad_struct("diagnosis", "diagnosis", &b.every.diagnosis);
  bad_struct("equilibrium", "equilibrium", &b.every.equilibrium);
  bad_struct("law", "law", &b.law);
  bad_struct("layer", "layer", &b.layer);
  REALS("layer.overclosure", b.overclosure), REALS("layer.pressure", b.layer_pressure);
  bad_struct("heat", "heat", &b.heat);
  bad_struct("heat_nodes", "heat_nodes", &b.every.heat_nodes);
  REALS("temperatures1", b.every.heat_t1), REALS("temperatures2", b.every.heat_t2);
  INTEGERS("equations1", b.every.heat_e1), INTEGERS("equations2", b.every.heat_e2), NUMBER(INT32, which);
  NUMBER(REAL, jump), NUMBER(REAL, pressure), NUMBER(REAL, node_gap), NUMBER(REAL, area), NUMBER(REAL, work);
  bad_struct("gradient", "gradient", &b.every.gradient);
  bad_struct("direction", "direction", &b.every.direction);
  REALS("direction.previous1", b.every.along.previous1), REALS("direction.previous2", b.every.along.previous2);
  REALS("direction.now1", b.every.along.now1), REALS("direction.now2", b.every.along.now2);
  REALS("direction.friction", b.every.along.friction), REALS("direction.shear_limit", b.every.along.shear_limit);
  REALS("direction.offsets1", b.every.along.offsets1), REALS("direction.offsets2", b.every.along.offsets2);
  REALS("a1", b.every.a1), REALS("a2", b.every.a2), REALS("a_rows", b.every.a_rows);
  bad_struct("rigid_body", "body", &b.rigid.body);
  bad_struct("rigid_motion", "motion", &b.rigid.motion);
  bad_struct("rigid_motion", "turned_motion", &b.every.turned_motion);
  REALS("body.coordinates", b.rigid.coordinates), REALS("body.point", b.rigid.point), REALS("forces", b.rigid.forces);
  REALS("nodal", b.rigid.nodal), INTEGERS("body.node_equations", b.rigid.node_equations);
  INTEGERS("body.equations", b.rigid.equations), INTEGERS("rigid_rows", b.rigid.rows);
  INTEGERS("rigid_columns", b.rigid.columns), NUMBER(INT64, n_bodies), NUMBER(INT64, n_entries);
  bad_struct("surface", "surface", &b.every.skin.surface);
  bad_struct("states", "skin_states", &b.every.skin_states);
  bad_struct("skin_sides", "sides", &b.every.sides);
  bad_struct("skin_summary", "summary", &b.every.summary);
  REALS("surface.coordinates", b.every.skin.reference), INTEGERS("surface.facet_offsets", b.every.skin.offsets);
  INTEGERS("surface.facet_nodes", b.every.skin.nodes), INTEGERS("surface.equations", b.every.skin.equations);
  INTEGERS("bodies", b.every.skin.bodies), NUMBER(INT64, first_multiplier), NUMBER(INT64, body1), NUMBER(INT64, body2);
  REALS("x", b.every.skin.x), REALS("dx", b.every.skin_dx);
  static const char *const of_point[] = {"skin_residual:lambda",  "skin_plan_values:lambda",      "skin_states:lambda",
                                         "skin_equilibrium:lambda", "skin_turn_multipliers:lambda", "skin_commit:lambda"};
  for (int k = 0; k < COUNT(of_point); ++k) REALS(of_point[k], b.every.skin.lambda);
  bad_place("skin_set_pair:mu", REAL, &b.skin_mu, 0);
  bad_place("skin_use_normals:normals", INT32, &b.which_normals, 0);
  bad_place("skin_destroy:handle", INT64, &b.every.skin.skin, 0);
  REALS("pair.x1", E.x1), REALS("pair.x2", E.x2), REALS("pair.neighbour_normals", b.neighbours);
  REALS("facet.neighbour_normals", b.neighbours);
  bad_place("facet.n2", INT32, E.n2, COUNT(E.n2)), REALS("mass", E.mass), REALS("state", E.state);
  REALS("n_ab", E.w.ab), REALS("n_ac", E.w.ac), REALS("dn_ab", E.w.dab), REALS("dn_ac", E.w.dac);
  REALS("n_ab_previous", b.previous.ab), REALS("n_ac_previous", b.previous.ac);
  REALS("traction", E.traction), REALS("row_scale", E.row_scale), REALS("sum", E.sum);
  REALS("nonmortar.coordinates", S.reference1), REALS("mortar.coordinates", S.reference2);
  INTEGERS("nonmortar.facet_offsets", S.offsets1), INTEGERS("mortar.facet_offsets", S.offsets2);
  INTEGERS("nonmortar.facet_nodes", S.nodes1), INTEGERS("mortar.facet_nodes", S.nodes2);
  INTEGERS("nonmortar.equations", S.equations1), INTEGERS("mortar.equations", S.equations2);
  INTEGERS("nonmortar.multiplier_equations", S.multipliers);
  REALS("host1", H.host1), NUMBER(INT32, piece);
  REALS("x1", S.x1), REALS("x2", S.x2), REALS("lambda", S.lambda), REALS("dx1", b.dx1), REALS("dx2", b.dx2);
  REALS("sums", b.sums), REALS("mu", b.mu), REALS("r", b.r), REALS("normals", b.normals);
  REALS("slip", b.slip), NUMBER(INT64, commits);
  REALS("offsets1", b.raised1), REALS("offsets2", b.raised2), REALS("point", b.point), REALS("direction", b.direction);
  NUMBER(INT64, n_states);
  NUMBER(REAL, tolerance), NUMBER(REAL, radius), NUMBER(INT32, side), NUMBER(INT32, shape);
  REALS("directions", b.directions), INTEGERS("nodes", b.nodes), INTEGERS("row_offsets", H.offsets);
  INTEGERS("nonmortar_offsets", b.offsets1), INTEGERS("mortar_offsets", b.offsets2);
  bad_place("imported_integers", INT64, b.imported.integers, (int32_t)b.n_integers);
  bad_place("imported_reals", REAL, b.imported.reals, (int32_t)b.n_reals);
  const history *of_skin = &b.every.skin_exported;
  bad_place("skin_history_import:imported_integers", INT64, b.skin_imported.integers, (int32_t)of_skin->n_integers);
  bad_place("skin_history_import:imported_reals", REAL, b.skin_imported.reals, (int32_t)of_skin->n_reals);
  bad_place("diagnosis.state", INT32, b.every.diagnosed_state, N1);
  bad_place("struct_size", INT64, &b.options_size, 0);
  bad_place("handle", INT64, &b.every.other, 0);
  NUMBER(INT64, ld), NUMBER(INT64, capacity), NUMBER(INT64, length), NUMBER(INT64, n_interfaces), NUMBER(INT64, n);
  NUMBER(INT64, n_rows), NUMBER(INT64, n_integers), NUMBER(INT64, n_reals), NUMBER(INT32, n_facet);
  NUMBER(INT32, pairs), NUMBER(INT32, entries);
  NUMBER(INT32, layout), NUMBER(INT32, index_base), NUMBER(REAL, scale), NUMBER(REAL, stiffness);
  NUMBER(REAL, rounding), NUMBER(REAL, angle), NUMBER(REAL, penetration);
  bad_place("interface_use_normals:normals", INT32, &b.which_normals, 0);
}

int main(void) {
  const bad_host host = {call, set_up, compare, tear_down};
  set_up("pair_gap", 0);
  tell();
  tear_down();
  bad_rows("C", 0, &host);
  return 0;
}
