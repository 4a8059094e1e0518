/* Every function of the ABI that returns a status, as a call on one context, with room for all that it writes: for tests
 * that go through all of them. The order is one in which a host may call them. */
#ifndef EVERY_CALL_H
#define EVERY_CALL_H

#include "calls.h"
#include "skin_scene.h"

/* Entries that two nodes of a rigid body leave: 36 of its own, 6 of a column and 6 of a row. */
enum { RIGID_ENTRIES = 48 };

/* A rigid body of two nodes, its motion and forces, and a nodal matrix with a row, a column and a diagonal entry of it. */
typedef struct {
  double coordinates[6], point[3], forces[6], nodal[3];
  int64_t node_equations[6], equations[6], rows[3], columns[3];
  stickslip_rigid_body body;
  stickslip_rigid_motion motion;
} rigid_parts;

static inline void rigid_parts_init(rigid_parts *r) {
  static const rigid_parts good = {.coordinates = {1, 2, 3, 4, 5, 7}, .point = {1, 1, 1}, .forces = {1, 2, 3, 4, 5, 6},
      .nodal = {2, 3, 5}, .node_equations = {10, 11, 12, 13, 14, 15}, .equations = {1, 2, 3, 4, 5, 6},
      .rows = {10, 13, 20}, .columns = {15, 20, 14}, .motion = {.struct_size = sizeof(stickslip_rigid_motion),
      .displacement = {0.1, 0.2, 0.3}, .rotation = {0.3, -0.2, 0.4}}};
  *r = good;
  r->body = (stickslip_rigid_body){.struct_size = sizeof r->body, .dimension = 3, .n_nodes = 2,
      .coordinates = r->coordinates, .point = r->point, .node_equations = r->node_equations, .equations = r->equations};
}

/* What a residual depends on besides multipliers. */
typedef struct {
  double previous1[X1], previous2[X2], now1[X1], now2[X2], friction[N1], shear_limit[1], offsets1[N1], offsets2[N2];
} dependence;

typedef struct {
  element e;
  handle h;
  history exported; /* what history_import takes */
  /* Inputs of products with derivatives. */
  dependence along;
  stickslip_direction direction;
  double a1[X1], a2[X2], a_rows[X1];
  /* Of a skin, and what its history_import takes. */
  skin_scene skin;
  history skin_exported;
  double skin_dx[SKIN_X];
  /* Outputs. */
  stickslip_options options;
  stickslip_method method;
  stickslip_interface *other;
  int64_t split_nodes[16], originals[2 * N1], split_count;
  int64_t shared_nodes[8], shared_claims[8], shared_count;
  int32_t shared_kinds[8];
  double initial[X1];
  history history;
  stickslip_counters counters;
  char effects[1000], last_error[80];
  stickslip_report report;
  int32_t cover[N1], layers[N1];
  double fraction[N1];
  int64_t facets[N1];
  char report_text[1000];
  stickslip_diagnosis diagnosis;
  int32_t diagnosed_state[N1], suspect_causes[8];
  int64_t suspect_nodes[8];
  double suspect_directions[24], suspect_ratios[8];
  char diagnosis_text[2000];
  double step_limit;
  stickslip_equilibrium equilibrium;
  double node_equilibrium[3], facet_normal[3];
  /* Of systems without multipliers. */
  double condensed_lambda[X1], condensed_rows[X1], condensed_force[X2], node_condensed[13];
  /* For each call with triplets their number, and a number made of their bits: of systems without multipliers, and by positions of t_n. */
  uint64_t triplet_counts[6], triplet_bits[6];
  double turned[X1];
  double adjusted[X1], gaps[N1], shape_offsets[N1], law_states[N1];
  int64_t law_count;
  int32_t moved[N1];
  /* Of heat. */
  double heat_t1[N1], heat_t2[N2], heat1[N1], heat2[N2], heat_flux[N1], heat_sides[2], heat_slopes[2 * STICKSLIP_HEAT_SLOPES];
  double heat_conductance;
  stickslip_heat_nodes heat_nodes;
  int64_t heat_e1[N1], heat_e2[N2], heat_count, heat_columns[UNKNOWNS * UNKNOWNS];
  /* Of derivatives. */
  dependence slopes;
  stickslip_gradient gradient;
  double change1[X1], change2[X2], change_rows[X1];
  /* Of plans, two for those of condensed systems. */
  int64_t plan_rows[2], plan_counts[2], row_list[UNKNOWNS], row_offsets[UNKNOWNS + 1], plan_columns[UNKNOWNS * UNKNOWNS];
  int32_t row_list32[UNKNOWNS], row_offsets32[UNKNOWNS + 1], rows32[UNKNOWNS * UNKNOWNS], columns32[UNKNOWNS * UNKNOWNS];
  double plan_values[2][UNKNOWNS * UNKNOWNS];
  /* Of a rigid body. */
  stickslip_rigid *rigid;
  stickslip_rigid_motion turned_motion;
  double rigid_x[6], resultant[6], rigid_values[RIGID_ENTRIES];
  int64_t rigid_count, rigid_rows[RIGID_ENTRIES], rigid_columns[RIGID_ENTRIES];
  /* Of a skin. */
  int64_t copies[SKIN_COPIES], copy_equations[SKIN_LAMBDA], copy_count, skin_multipliers, skin_count;
  int64_t skin_rows[SKIN_PLAN], skin_columns[SKIN_PLAN];
  int32_t skin_rows32[SKIN_PLAN], skin_columns32[SKIN_PLAN];
  double skin_initial[SKIN_LAMBDA], skin_force[SKIN_X], skin_lines[SKIN_LAMBDA], skin_values[SKIN_PLAN];
  double skin_limit, skin_turned[SKIN_LAMBDA], skin_committed[SKIN_LAMBDA];
  stickslip_states skin_states;
  int32_t copy_state[SKIN_COPIES], facet_side[SKIN_FACETS];
  double copy_normal[SKIN_LAMBDA], copy_gap[SKIN_COPIES], facet_distance[SKIN_FACETS];
  stickslip_equilibrium skin_equilibrium;
  stickslip_skin_sides sides;
  int64_t facet_piece[SKIN_FACETS], facet_partner[SKIN_FACETS], facet_body[SKIN_FACETS];
  stickslip_skin_summary summary;
  history skin_history;
} every;

static inline int32_t every_weights(every *c) { return call_weights(&c->e); }
static inline int32_t every_gap(every *c) { return call_gap(&c->e); }
static inline int32_t every_pair_residual(every *c) { return call_residual(&c->e); }
static inline int32_t every_pair_tangent(every *c) { return call_tangent(&c->e); }
/* The state holds addresses, which differ from run to run: only that the call succeeds is looked at. */
static inline int32_t every_begin(every *c) {
  const int32_t status = call_begin(&c->e);
  FILL(c->e.state_out);
  return status;
}
static inline int32_t every_state_gap(every *c) { return call_state_gap(&c->e); }
static inline int32_t every_state_residual(every *c) { return call_state_residual(&c->e); }
static inline int32_t every_state_tangent(every *c) { return call_state_tangent(&c->e); }
static inline int32_t every_respond(every *c) { return call_respond(&c->e); }
static inline int32_t every_block(every *c) { return call_block(&c->e); }
static inline int32_t every_facet(every *c) { return call_facet(&c->e); }
static inline int32_t every_facet_dual(every *c) { return call_facet_dual(&c->e); }
static inline int32_t every_pair_dual(every *c) { return call_pair_dual(&c->e); }
static inline int32_t every_facet_tangent(every *c) { return call_facet_tangent(&c->e); }
static inline int32_t every_normal(every *c) { return call_normal(&c->e); }
static inline int32_t every_options_init(every *c) { return stickslip_options_init(&c->options, sizeof c->options); }
static inline int32_t every_options_paper(every *c) { return stickslip_options_paper(&c->options); }
static inline int32_t every_options_method(every *c) {
  c->method.struct_size = sizeof c->method;
  return stickslip_options_method(&c->h.s.options, &c->method);
}
static inline int32_t every_padded(every *c) { return stickslip_last_error_padded(c->last_error, sizeof c->last_error); }
static inline int32_t every_split(every *c) {
  return stickslip_surface_split_creases(&c->h.s.nonmortar, 0.5, (int32_t)c->h.s.options.index_base, COUNT(c->originals),
                                         c->split_nodes, c->originals, &c->split_count);
}
/* The same of a surface that is bent by a right angle along its middle. */
static inline int32_t every_split_bent(every *c) {
  static double bent[X1];
  if (bent[0] == 0.0 && bent[3] == 0.0) {
    for (int a = 0; a < N1; ++a) {
      const int i = a % 3;
      bent[3 * a] = i < 2 ? 0.5 * i : 0.5;
      bent[3 * a + 1] = 0.5 * (a / 3);
      bent[3 * a + 2] = i < 2 ? 0.0 : 0.5;
    }
  }
  stickslip_surface surface = c->h.s.nonmortar;
  surface.coordinates = bent;
  return stickslip_surface_split_creases(&surface, 0.5, (int32_t)c->h.s.options.index_base, COUNT(c->originals),
                                         c->split_nodes, c->originals, &c->split_count);
}
/* Two lines at a right angle. */
static inline int32_t every_lines_split(every *c) {
  static const double corner[] = {0, 0, 1, 0, 1, -1};
  static const int64_t offsets[] = {0, 2, 4};
  const int64_t base = c->h.s.options.index_base, nodes[] = {base, base + 1, base + 1, base + 2};
  const stickslip_surface surface = {.struct_size = sizeof surface, .n_nodes = 3, .n_facets = 2, .coordinates = corner,
                                     .facet_offsets = offsets, .facet_nodes = nodes};
  return stickslip_lines_split_creases(&surface, 0.5, (int32_t)base, COUNT(c->originals), c->split_nodes, c->originals,
                                       &c->split_count);
}
static inline int32_t every_crosspoints(every *c) {
  static const int64_t offsets1[] = {0, 3, 6}, nodes1[] = {1, 2, 3, 3, 4, 5}, offsets2[] = {0, 2, 4}, nodes2[] = {7, 5, 1, 4};
  return stickslip_crosspoints_find(2, offsets1, nodes1, offsets2, nodes2, COUNT(c->shared_nodes), c->shared_nodes,
                                    c->shared_kinds, c->shared_claims, &c->shared_count);
}
/* Creates a second interface, or ends it where there is one. */
static inline int32_t every_create(every *c) {
  return stickslip_interface_create(&c->h.s.nonmortar, &c->h.s.mortar, &c->h.s.options, &c->other);
}
static inline int32_t every_destroy(every *c) { return stickslip_interface_destroy(&c->other); }
static inline int32_t every_friction(every *c) {
  const double value = has_mu(c->h.s.options.friction) ? 0.6 : 0.0;
  double mu[N1];
  for (int a = 0; a < N1; ++a) mu[a] = value;
  return stickslip_interface_set_friction(c->h.s.interface, mu);
}
static inline int32_t every_augmentation(every *c) {
  double r[N1];
  for (int a = 0; a < N1; ++a) r[a] = 14.0 + a;
  return stickslip_interface_set_augmentation(c->h.s.interface, r);
}
/* Up in the scene's frame. */
static inline void every_up(double *normals, int n) {
  for (int a = 0; a < n; ++a) {
    normals[3 * a] = normals[3 * a + 1] = 0.0;
    normals[3 * a + 2] = 1.0;
    scene_frame(normals + 3 * a);
  }
}
static inline int32_t every_normals(every *c) {
  static double up[X1];
  if (up[0] == 0.0) every_up(up, N1);
  return stickslip_interface_set_normals(c->h.s.interface, up);
}
static inline int32_t every_no_normals(every *c) { return stickslip_interface_set_normals(c->h.s.interface, NULL); }
static inline int32_t every_constraints(every *c) {
  static double across[3];
  if (across[0] == 0.0) {
    across[0] = 1.0;
    scene_frame(across);
  }
  const int64_t node = 4;
  return stickslip_interface_set_constraints(c->h.s.interface, 1, &node, across);
}
/* How the offset of a carried node turns is not in the tangent, and forces of conserving weights know no offsets: refused. */
static inline int every_offsets_unsupported(const scene *s) {
  const stickslip_method *o = &s->method;
  if (o->weights == STICKSLIP_WEIGHTS_CONSERVING) return 1;
  const int carries = o->weak_coverage > 0.0 || (o->weak_coverage == 0.0 && o->multiplier_basis == STICKSLIP_BASIS_DUAL);
  return o->normals == STICKSLIP_NORMALS_CURRENT && s->options.friction != STICKSLIP_FRICTION_NONE && carries;
}
static inline int32_t every_offsets(every *c) {
  const stickslip_options *o = &c->h.s.options;
  double one[N1], two[N2];
  /* Powers of two: exact, for a caller's inexact operations may be trapped. */
  for (int a = 0; a < N1; ++a) one[a] = every_offsets_unsupported(&c->h.s) ? 0.0 : 0x1p-10 * a;
  for (int a = 0; a < N2; ++a) two[a] = every_offsets_unsupported(&c->h.s) ? 0.0 : -0x1p-10 * a;
  return stickslip_interface_set_offsets(c->h.s.interface, one, o->mortar_side == STICKSLIP_MORTAR_ANALYTIC ? NULL : two);
}
static inline int32_t every_no_offsets(every *c) { return stickslip_interface_set_offsets(c->h.s.interface, NULL, NULL); }
static inline int32_t every_adjust(every *c) {
  return stickslip_interface_adjust(c->h.s.interface, 0.02, c->adjusted, c->gaps, c->moved);
}
static inline int32_t every_shape_offsets(every *c) {
  static double centre[3];
  static const double axis[] = {0, 0, 1};
  if (centre[2] == 0.0) {
    centre[2] = 1e4;
    scene_frame(centre);
  }
  return stickslip_interface_shape_offsets(c->h.s.interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_SPHERE, 1e4, centre, axis,
                                           c->shape_offsets);
}
/* Laws in place of Coulomb's, where the interface has that; its numbers are powers of two. */
static inline int every_has_law(const every *c) { return c->h.s.options.friction == STICKSLIP_FRICTION_COULOMB; }
/* Tied surfaces do not give way. */
static inline int every_goes_with_layers(const every *c) {
  const int32_t weights = c->h.s.method.weights;
  return c->h.s.options.friction != STICKSLIP_FRICTION_TIED && weights != STICKSLIP_WEIGHTS_CONSERVING &&
         c->h.s.method.decision != STICKSLIP_DECISION_POINTS;
}
static inline int32_t every_law(every *c) {
  const stickslip_law law = {.struct_size = sizeof law, .kind = STICKSLIP_LAW_WEAKENING, .mu_after = 0.25, .critical_slip = 0x1p-7};
  return every_has_law(c) ? stickslip_interface_set_law(c->h.s.interface, &law) : STICKSLIP_OK;
}
static inline int32_t every_no_law(every *c) {
  return every_has_law(c) ? stickslip_interface_set_law(c->h.s.interface, NULL) : STICKSLIP_OK;
}
static inline int32_t every_half(void *user, const stickslip_law_point *point, const double *states, stickslip_law_answer *answer,
                                 double *states_after) {
  (void)user;
  answer->threshold = -0.5 * point->normal;
  answer->dthreshold_dnormal = -0.5;
  states_after[0] = states[0];
  return 0;
}
static inline int32_t every_threshold(every *c) {
  return every_has_law(c) ? stickslip_interface_set_threshold(c->h.s.interface, every_half, NULL, 1) : STICKSLIP_OK;
}
static inline int32_t every_law_states(every *c) {
  return stickslip_interface_law_states(c->h.s.interface, N1, c->law_states, &c->law_count);
}
static inline int32_t every_set_law_states(every *c) {
  return stickslip_interface_set_law_states(c->h.s.interface, every_has_law(c) ? N1 : 0, c->law_states);
}
/* What lies between the surfaces; wear where there is friction. */
static inline int32_t every_layer(every *c) {
  static const double overclosure[] = {0, 0x1p-10, 0x1p-9}, pressure[] = {0, 1, 4};
  const stickslip_layer layer = {.struct_size = sizeof layer, .n_overclosure = 3, .overclosure = overclosure, .pressure = pressure,
                                 .wear = every_has_law(c) ? 0x1p-12 : 0};
  return every_goes_with_layers(c) ? stickslip_interface_set_layer(c->h.s.interface, &layer) : STICKSLIP_OK;
}
static inline int32_t every_no_layer(every *c) { return stickslip_interface_set_layer(c->h.s.interface, NULL); }
/* Numbers are powers of two: exact, for a caller's inexact operations may be trapped. An analytic mortar side has no temperatures. */
static inline stickslip_heat every_heat_law(void) {
  const stickslip_heat heat = {.struct_size = sizeof heat, .contact = 2.0, .pressure = 0.5, .exponent = 0.5, .constant = 0.25,
                               .gas = 0.125, .gas_gap = 0.5, .reach = 1.0, .share = 0.25, .time = 0.5};
  return heat;
}
static inline int every_has_heat(const every *c) { return c->h.s.options.mortar_side != STICKSLIP_MORTAR_ANALYTIC; }
static inline int32_t every_heat(every *c) {
  const scene *s = &c->h.s;
  const stickslip_heat heat = every_heat_law();
  if (!every_has_heat(c)) return STICKSLIP_OK;
  return stickslip_interface_heat(s->interface, s->x1, s->x2, s->lambda, &heat, c->heat_t1, c->heat_t2, c->heat1, c->heat2,
                                  &c->heat_nodes);
}
static inline int32_t every_heat_coo(every *c) {
  const scene *s = &c->h.s;
  const stickslip_heat heat = every_heat_law();
  const int32_t which =
      s->method.normals == STICKSLIP_NORMALS_CURRENT ? STICKSLIP_HEAT_TEMPERATURES : STICKSLIP_HEAT_ALL;
  if (!every_has_heat(c)) return STICKSLIP_OK;
  return stickslip_interface_heat_tangent_coo(s->interface, s->x1, s->x2, s->lambda, &heat, c->heat_t1, c->heat_t2, c->heat_e1,
                                              c->heat_e2, which, COUNT(c->heat_columns), c->plan_columns, c->heat_columns,
                                              c->plan_values[0], &c->heat_count);
}
static inline int32_t every_node_heat(every *c) {
  const stickslip_heat heat = every_heat_law();
  return stickslip_node_heat(&heat, 0.5, 0.25, 0.125, 0.5, 0.25, c->heat_sides, c->heat_slopes, &c->heat_conductance);
}
static inline int32_t every_committed(every *c) { return call_interface_committed(&c->h); }
static inline int32_t every_previous(every *c) { return call_interface_previous(&c->h); }
/* Before the first step: of the second interface. */
static inline int32_t every_initial(every *c) { return stickslip_interface_initial_multipliers(c->other, c->initial); }
static inline int32_t every_sums(every *c) { return call_interface_sums(&c->h); }
static inline int32_t every_residual(every *c) { return call_interface_residual(&c->h); }
static inline int32_t every_states(every *c) { return call_interface_states(&c->h); }
/* With the sums of `every_sums`; not where nodes are carried. */
static inline int32_t every_with_sums(every *c) {
  scene *s = &c->h.s;
  return stickslip_interface_residual(s->interface, s->x1, s->x2, s->lambda, c->h.sums, c->h.force1, c->h.force2,
                                      c->h.rows);
}
static inline int32_t every_coo(every *c) { return call_interface_coo(&c->h); }
static inline int32_t every_csr(every *c) { return call_interface_csr(&c->h); }
static inline int32_t every_count(every *c) {
  scene *s = &c->h.s;
  return stickslip_interface_tangent_coo(s->interface, s->x1, s->x2, s->lambda, NULL, 0, NULL, NULL, NULL, &c->h.count);
}
static inline int32_t every_pattern(every *c) { return call_interface_pattern(&c->h); }
static inline int32_t every_commit(every *c) { return call_interface_commit(&c->h); }
static inline int32_t every_commit_check(every *c) { return call_interface_commit_check(&c->h); }
static inline int32_t every_rollback(every *c) { return stickslip_interface_rollback(c->h.s.interface); }
static inline int32_t every_history_size(every *c) {
  return stickslip_interface_history_size(c->h.s.interface, &c->history.n_integers, &c->history.n_reals);
}
static inline int32_t every_export(every *c) {
  return stickslip_interface_history_export(c->h.s.interface, COUNT(c->history.integers), c->history.integers,
                                            COUNT(c->history.reals), c->history.reals);
}
static inline int32_t every_import(every *c) {
  return stickslip_interface_history_import(c->h.s.interface, c->exported.n_integers, c->exported.integers,
                                            c->exported.n_reals, c->exported.reals);
}
static inline int32_t every_counters(every *c) { return stickslip_interface_counters(c->h.s.interface, &c->counters); }
static inline int32_t every_effects(every *c) {
  return stickslip_interface_effects(c->h.s.interface, c->effects, COUNT(c->effects));
}
static inline int32_t every_report(every *c) {
  return stickslip_interface_report(c->h.s.interface, c->h.s.x1, c->h.s.x2, &c->report);
}
static inline int32_t every_diagnose(every *c) {
  return stickslip_interface_diagnose(c->h.s.interface, c->h.s.x1, c->h.s.x2, c->h.s.lambda, NULL, &c->diagnosis);
}

/* A step of the non-mortar side through the other one: many fractions are tried. */
static inline int32_t every_step_limit(every *c) {
  static double down[X1], nothing[X2];
  if (down[2] == 0.0) {
    every_up(down, N1);
    for (int k = 0; k < X1; ++k) down[k] *= -2.0;
  }
  return stickslip_interface_step_limit(c->h.s.interface, c->h.s.x1, c->h.s.x2, down, nothing, 0.0, &c->step_limit);
}

static inline int32_t every_equilibrium(every *c) {
  scene *s = &c->h.s;
  return stickslip_interface_equilibrium(s->interface, s->x1, s->x2, s->lambda, NULL, &c->equilibrium);
}
static inline int32_t every_node_equilibrium(every *c) {
  double *out = c->node_equilibrium;
  return stickslip_node_equilibrium(&c->e.node, 10.0, 0.0, out, out + 1, out + 2);
}
static inline int32_t every_facet_normal(every *c) { return stickslip_facet_normal(4, c->e.x1, c->facet_normal); }

/* Keeps of triplets, which other calls write too, what tells them apart. In integers: it may be called with traps. */
static inline int32_t every_triplets(every *c, int k, int32_t status) {
  if (status != STICKSLIP_OK) return status;
  uint64_t bits = 0, value = 0;
  for (int64_t e = 0; e < c->h.count; ++e) {
    if (k != 4) memcpy(&value, &c->h.values[e], sizeof value);
    bits = 31 * (31 * (31 * bits + value) + (uint64_t)c->h.row_numbers[e]) + (uint64_t)c->h.columns[e];
  }
  c->triplet_counts[k] = (uint64_t)c->h.count;
  c->triplet_bits[k] = bits;
  return status;
}
static inline int32_t every_node_condense(every *c) {
  double *out = c->node_condensed;
  return stickslip_node_condense(&c->e.node, &c->e.responses[0], STICKSLIP_LAYOUT_ROW_MAJOR, out, out + 9, out + 12);
}
static inline int32_t every_carriers(every *c) { return every_triplets(c, 3, call_carriers(&c->h)); }
static inline int32_t every_condensed_multipliers(every *c) {
  handle *h = &c->h;
  return stickslip_interface_condensed_multipliers(h->s.interface, h->s.x1, h->s.x2, h->host1, c->condensed_lambda);
}
static inline int32_t every_condensed_residual(every *c) {
  handle *h = &c->h;
  return stickslip_interface_condensed_residual(h->s.interface, h->s.x1, h->s.x2, c->condensed_lambda, h->host1,
                                                c->condensed_rows, c->condensed_force);
}
static inline int32_t every_condensed_forces(every *c) {
  return every_triplets(c, 0, call_condensed_coo(&c->h, STICKSLIP_CONDENSED_FORCES));
}
static inline int32_t every_condensed_elimination(every *c) {
  return every_triplets(c, 1, call_condensed_coo(&c->h, STICKSLIP_CONDENSED_ELIMINATION));
}
static inline int32_t every_condensed_constraints(every *c) {
  return every_triplets(c, 2, call_condensed_coo(&c->h, STICKSLIP_CONDENSED_CONSTRAINTS));
}
static inline int32_t every_condensed_csr(every *c) { return call_condensed_csr(&c->h); }
static inline int32_t every_condensed_pattern(every *c) { return every_triplets(c, 4, call_condensed_pattern(&c->h)); }

static inline int32_t every_use_normals(every *c) {
  return stickslip_interface_use_normals(c->h.s.interface, c->h.s.method.normals);
}
static inline int32_t every_use_committed(every *c) {
  return stickslip_interface_use_normals(c->h.s.interface, STICKSLIP_NORMALS_COMMITTED);
}
static inline int32_t every_turn_multipliers(every *c) {
  scene *s = &c->h.s;
  memcpy(c->turned, s->lambda, sizeof c->turned);
  return stickslip_interface_turn_multipliers(s->interface, s->x1, c->turned);
}
/* By plans: two kinds, each filled with values; the entries of the last one in all four ways. */
static inline int32_t every_plan(every *c) {
  scene *s = &c->h.s;
  return stickslip_interface_plan(s->interface, s->x1, s->x2, STICKSLIP_PLAN_ACTIVE, c->plan_rows, c->plan_counts);
}
static inline int32_t every_skin(every *c) {
  scene *s = &c->h.s;
  return stickslip_interface_plan(s->interface, s->x1, s->x2, STICKSLIP_PLAN_SKIN, c->plan_rows, c->plan_counts);
}
static inline int32_t every_plan_coo(every *c) {
  return stickslip_interface_plan_coo(c->h.s.interface, STICKSLIP_ENTRIES_TANGENT, MOST_ENTRIES, c->h.row_numbers,
                                      c->h.columns);
}
static inline int32_t every_plan_coo32(every *c) {
  return stickslip_interface_plan_coo32(c->h.s.interface, STICKSLIP_ENTRIES_TANGENT, COUNT(c->rows32), c->rows32,
                                        c->columns32);
}
static inline int32_t every_plan_csr(every *c) {
  return stickslip_interface_plan_csr(c->h.s.interface, STICKSLIP_ENTRIES_TANGENT, COUNT(c->plan_columns), c->row_list,
                                      c->row_offsets, c->plan_columns);
}
static inline int32_t every_plan_csr32(every *c) {
  return stickslip_interface_plan_csr32(c->h.s.interface, STICKSLIP_ENTRIES_TANGENT, COUNT(c->columns32), c->row_list32,
                                        c->row_offsets32, c->columns32);
}
static inline int32_t every_plan_values(every *c) {
  scene *s = &c->h.s;
  return stickslip_interface_plan_values(s->interface, s->x1, s->x2, s->lambda, NULL, COUNT(c->plan_values[0]),
                                         c->plan_values[0]);
}
static inline int32_t every_condensed_plan(every *c) {
  scene *s = &c->h.s;
  return stickslip_interface_condensed_plan(s->interface, s->x1, s->x2, STICKSLIP_PLAN_ACTIVE, c->plan_rows,
                                            c->plan_counts);
}
static inline int32_t every_condensed_values(every *c) {
  scene *s = &c->h.s;
  return stickslip_interface_condensed_values(s->interface, s->x1, s->x2, c->condensed_lambda, c->plan_values[0],
                                              c->plan_values[1]);
}

/* What derivatives by positions of t_n and by parameters go with. */
static inline int every_has_derivatives(const every *c) {
  const stickslip_method *o = &c->h.s.method;
  return o->form == STICKSLIP_FORM_MULTIPLIER && o->weights != STICKSLIP_WEIGHTS_COMMITTED &&
         o->weights != STICKSLIP_WEIGHTS_CONSERVING && o->decision != STICKSLIP_DECISION_POINTS;
}
static inline int32_t every_previous_tangent(every *c) {
  const scene *s = &c->h.s;
  if (!every_has_derivatives(c)) return STICKSLIP_OK;
  return every_triplets(c, 5, stickslip_interface_previous_tangent_coo(s->interface, s->x1, s->x2, s->lambda, MOST_ENTRIES,
                                                                       c->h.row_numbers, c->h.columns, c->h.values, &c->h.count));
}
static inline int32_t every_adjoint(every *c) {
  const scene *s = &c->h.s;
  if (!every_has_derivatives(c)) return STICKSLIP_OK;
  return stickslip_interface_adjoint(s->interface, s->x1, s->x2, s->lambda, c->a1, c->a2, c->a_rows, &c->gradient);
}
static inline int32_t every_sensitivity(every *c) {
  const scene *s = &c->h.s;
  if (!every_has_derivatives(c)) return STICKSLIP_OK;
  return stickslip_interface_sensitivity(s->interface, s->x1, s->x2, s->lambda, &c->direction, c->change1, c->change2,
                                         c->change_rows);
}

static inline int32_t every_normal_derivatives(every *c) { return call_normal_derivatives(&c->e); }
static inline int32_t every_turn(every *c) { return call_turn(&c->e); }

static inline rigid_parts *every_rigid(void) {
  static rigid_parts r;
  rigid_parts_init(&r);
  return &r;
}
static inline int32_t every_rigid_positions(every *c) {
  const rigid_parts *r = every_rigid();
  return stickslip_rigid_positions(&r->body, &r->motion, c->rigid_x);
}
static inline int32_t every_rigid_resultant(every *c) {
  const rigid_parts *r = every_rigid();
  return stickslip_rigid_resultant(&r->body, &r->motion, r->forces, c->resultant);
}
static inline int32_t every_rigid_turn(every *c) {
  c->turned_motion = every_rigid()->motion;
  return stickslip_rigid_turn(&c->turned_motion);
}
/* The calls after it need what it makes; the last one ends it. */
static inline int32_t every_rigid_create(every *c) {
  const rigid_parts *r = every_rigid();
  return stickslip_rigid_create(1, &r->body, 0, 3, r->rows, r->columns, &c->rigid, &c->rigid_count);
}
static inline int32_t every_rigid_coo(every *c) {
  return stickslip_rigid_coo(c->rigid, RIGID_ENTRIES, c->rigid_rows, c->rigid_columns);
}
static inline int32_t every_rigid_values(every *c) {
  const rigid_parts *r = every_rigid();
  return stickslip_rigid_values(c->rigid, &r->motion, r->forces, r->nodal, c->rigid_values);
}
static inline int32_t every_rigid_destroy(every *c) { return stickslip_rigid_destroy(&c->rigid); }

/* A skin likewise: the first one makes it, the last one ends it. */
static inline int32_t every_skin_create(every *c) {
  skin_scene *s = &c->skin;
  return stickslip_skin_create(&s->surface, s->bodies, s->first_multiplier, &s->options, &s->skin);
}
static inline int32_t every_skin_copies(every *c) {
  return stickslip_skin_copies(c->skin.skin, SKIN_COPIES, c->copies, c->copy_equations, &c->copy_count, &c->skin_multipliers);
}
static inline int32_t every_skin_set_pair(every *c) {
  return stickslip_skin_set_pair(c->skin.skin, UPPER_BODY, LOWER_BODY, 0.25);
}
static inline int32_t every_skin_apart(every *c) {
  return stickslip_skin_set_pair(c->skin.skin, UPPER_BODY, LOWER_BODY, STICKSLIP_SKIN_APART);
}
static inline int32_t every_skin_constraints(every *c) {
  static double across[3];
  if (across[0] == 0.0) {
    across[0] = 1.0;
    scene_frame(across);
  }
  const int64_t node = c->skin.options.index_base + 5;
  return stickslip_skin_set_constraints(c->skin.skin, 1, &node, across);
}
static inline int32_t every_skin_initial(every *c) {
  return stickslip_skin_initial_multipliers(c->skin.skin, c->skin_initial);
}
static inline int32_t every_skin_residual(every *c) {
  return stickslip_skin_residual(c->skin.skin, c->skin.x, c->skin.lambda, c->skin_force, c->skin_lines);
}
static inline int32_t every_skin_plan(every *c) {
  return stickslip_skin_plan(c->skin.skin, c->skin.x, STICKSLIP_PLAN_ACTIVE, &c->skin_count);
}
static inline int32_t every_skin_plan_skin(every *c) {
  return stickslip_skin_plan(c->skin.skin, c->skin.x, STICKSLIP_PLAN_SKIN, &c->skin_count);
}
static inline int32_t every_skin_plan_coo(every *c) {
  return stickslip_skin_plan_coo(c->skin.skin, SKIN_PLAN, c->skin_rows, c->skin_columns);
}
static inline int32_t every_skin_plan_coo32(every *c) {
  return stickslip_skin_plan_coo32(c->skin.skin, SKIN_PLAN, c->skin_rows32, c->skin_columns32);
}
static inline int32_t every_skin_plan_values(every *c) {
  return stickslip_skin_plan_values(c->skin.skin, c->skin.x, c->skin.lambda, SKIN_PLAN, c->skin_values);
}
static inline int32_t every_skin_states(every *c) {
  return stickslip_skin_states(c->skin.skin, c->skin.x, c->skin.lambda, &c->skin_states);
}
static inline int32_t every_skin_equilibrium(every *c) {
  return stickslip_skin_equilibrium(c->skin.skin, c->skin.x, c->skin.lambda, &c->skin_equilibrium);
}
static inline int32_t every_skin_step_limit(every *c) {
  return stickslip_skin_step_limit(c->skin.skin, c->skin.x, c->skin_dx, 0.0, &c->skin_limit);
}
static inline int32_t every_skin_use_committed(every *c) {
  return stickslip_skin_use_normals(c->skin.skin, STICKSLIP_NORMALS_COMMITTED);
}
static inline int32_t every_skin_use_current(every *c) {
  return stickslip_skin_use_normals(c->skin.skin, STICKSLIP_NORMALS_CURRENT);
}
static inline int32_t every_skin_turn(every *c) {
  memcpy(c->skin_turned, c->skin.lambda, sizeof c->skin_turned);
  return stickslip_skin_turn_multipliers(c->skin.skin, c->skin.x, c->skin_turned);
}
static inline int32_t every_skin_commit(every *c) {
  memcpy(c->skin_committed, c->skin.lambda, sizeof c->skin_committed);
  return stickslip_skin_commit(c->skin.skin, c->skin.x, c->skin_committed);
}
static inline int32_t every_skin_exchange(every *c) {
  memcpy(c->skin_committed, c->skin.lambda, sizeof c->skin_committed);
  return stickslip_skin_exchange(c->skin.skin, c->skin_committed);
}
static inline int32_t every_skin_rollback(every *c) { return stickslip_skin_rollback(c->skin.skin); }
static inline int32_t every_skin_history_size(every *c) {
  return stickslip_skin_history_size(c->skin.skin, &c->skin_history.n_integers, &c->skin_history.n_reals);
}
static inline int32_t every_skin_export(every *c) {
  return stickslip_skin_history_export(c->skin.skin, COUNT(c->skin_history.integers), c->skin_history.integers,
                                       COUNT(c->skin_history.reals), c->skin_history.reals);
}
static inline int32_t every_skin_import(every *c) {
  return stickslip_skin_history_import(c->skin.skin, c->skin_exported.n_integers, c->skin_exported.integers,
                                       c->skin_exported.n_reals, c->skin_exported.reals);
}
static inline int32_t every_skin_facets(every *c) { return stickslip_skin_facets(c->skin.skin, &c->sides); }
static inline int32_t every_skin_report(every *c) { return stickslip_skin_report(c->skin.skin, &c->summary); }
static inline int32_t every_skin_destroy(every *c) { return stickslip_skin_destroy(&c->skin.skin); }

typedef struct {
  const char *name;
  int32_t (*call)(every *c);
} entry_point;

static inline int is_of_skin(const char *name) { return strncmp(name, "skin_", 5) == 0; }

/* What asks for dual multipliers in the multiplier form. */
static inline int is_condensed(const char *name) { return strncmp(name, "interface_condensed_", 20) == 0; }

static const entry_point every_call[] = {
    {"pair_weights", every_weights},
    {"pair_gap", every_gap},
    {"pair_residual", every_pair_residual},
    {"pair_tangent", every_pair_tangent},
    {"pair_begin", every_begin},
    {"pair_state_gap", every_state_gap},
    {"pair_state_residual", every_state_residual},
    {"pair_state_tangent", every_state_tangent},
    {"facet_dual", every_facet_dual},
    {"pair_dual", every_pair_dual},
    {"facet_tangent", every_facet_tangent},
    {"node_respond", every_respond},
    {"node_block", every_block},
    {"facet_geometry", every_facet},
    {"node_normal", every_normal},
    {"options_init", every_options_init}, {"options_paper", every_options_paper}, {"options_method", every_options_method},
    {"last_error_padded", every_padded},
    {"surface_split_creases", every_split},
    {"surface_split_creases, bent", every_split_bent},
    {"lines_split_creases", every_lines_split},
    {"crosspoints_find", every_crosspoints},
    {"interface_create", every_create},
    {"interface_initial_multipliers", every_initial},
    {"interface_destroy", every_destroy},
    {"interface_residual", every_residual},
    {"interface_tangent_coo", every_coo},
    {"interface_set_friction", every_friction},
    {"interface_set_augmentation", every_augmentation},
    {"interface_set_normals", every_normals},
    {"interface_sums", every_sums},
    {"interface_residual, sums", every_with_sums},
    {"interface_set_normals, NULL", every_no_normals},
    {"interface_set_offsets", every_offsets},
    {"interface_residual, offsets", every_residual},
    {"interface_tangent_coo, offsets", every_coo},
    {"interface_set_offsets, NULL", every_no_offsets},
    {"interface_set_law", every_law},
    {"interface_residual, law", every_residual},
    {"interface_tangent_coo, law", every_coo},
    {"interface_equilibrium, law", every_equilibrium},
    {"interface_set_threshold", every_threshold},
    {"interface_residual, threshold", every_residual},
    {"interface_law_states", every_law_states},
    {"interface_set_law_states", every_set_law_states},
    {"interface_set_law, NULL", every_no_law},
    {"interface_set_layer", every_layer},
    {"interface_residual, layer", every_residual},
    {"interface_tangent_coo, layer", every_coo},
    {"interface_equilibrium, layer", every_equilibrium},
    {"interface_set_layer, NULL", every_no_layer},
    {"interface_heat", every_heat},
    {"interface_heat_tangent_coo", every_heat_coo},
    {"node_heat", every_node_heat},
    {"interface_previous_tangent_coo", every_previous_tangent},
    {"interface_adjoint", every_adjoint},
    {"interface_sensitivity", every_sensitivity},
    {"interface_adjust", every_adjust},
    {"interface_shape_offsets", every_shape_offsets},
    {"interface_set_constraints", every_constraints},
    {"interface_states", every_states},
    {"interface_tangent_csr", every_csr},
    {"interface_tangent_coo, count", every_count},
    {"interface_pattern_coo", every_pattern},
    {"interface_plan", every_plan},
    {"interface_plan_values", every_plan_values},
    {"interface_plan, skin", every_skin},
    {"interface_plan_coo", every_plan_coo},
    {"interface_plan_coo32", every_plan_coo32},
    {"interface_plan_csr", every_plan_csr},
    {"interface_plan_csr32", every_plan_csr32},
    {"interface_plan_values, skin", every_plan_values},
    {"interface_report", every_report},
    {"interface_diagnose", every_diagnose},
    {"interface_effects", every_effects},
    {"interface_step_limit", every_step_limit},
    {"interface_equilibrium", every_equilibrium},
    {"node_equilibrium", every_node_equilibrium},
    {"facet_normal", every_facet_normal},
    {"node_condense", every_node_condense},
    {"interface_carriers", every_carriers},
    {"interface_condensed_multipliers", every_condensed_multipliers},
    {"interface_condensed_residual", every_condensed_residual},
    {"interface_condensed_coo, forces", every_condensed_forces},
    {"interface_condensed_coo, elimination", every_condensed_elimination},
    {"interface_condensed_coo, constraints", every_condensed_constraints},
    {"interface_condensed_csr", every_condensed_csr},
    {"interface_condensed_pattern", every_condensed_pattern},
    {"interface_condensed_plan", every_condensed_plan},
    {"interface_condensed_values", every_condensed_values},
    {"facet_normal_derivatives", every_normal_derivatives},
    {"node_turn", every_turn},
    {"interface_use_normals", every_use_committed},
    {"interface_residual, normals of t_n", every_residual},
    {"interface_use_normals, as created", every_use_normals},
    {"interface_turn_multipliers", every_turn_multipliers},
    {"interface_commit_check", every_commit_check},
    {"interface_commit", every_commit},
    {"interface_residual, committed", every_residual},
    {"interface_history_size", every_history_size},
    {"interface_history_export", every_export},
    {"interface_rollback", every_rollback},
    {"interface_set_previous", every_previous},
    {"interface_set_committed", every_committed},
    {"interface_history_import", every_import},
    {"interface_tangent_coo, imported", every_coo},
    {"interface_counters", every_counters},
    {"rigid_positions", every_rigid_positions},
    {"rigid_resultant", every_rigid_resultant},
    {"rigid_turn", every_rigid_turn},
    {"rigid_create", every_rigid_create},
    {"rigid_coo", every_rigid_coo},
    {"rigid_values", every_rigid_values},
    {"rigid_destroy", every_rigid_destroy},
    {"skin_create", every_skin_create},
    {"skin_copies", every_skin_copies},
    {"skin_initial_multipliers", every_skin_initial},
    {"skin_facets", every_skin_facets},
    {"skin_set_pair", every_skin_set_pair},
    {"skin_set_constraints", every_skin_constraints},
    {"skin_step_limit", every_skin_step_limit},
    {"skin_commit, first", every_skin_commit},
    {"skin_residual", every_skin_residual},
    {"skin_plan", every_skin_plan},
    {"skin_plan_values", every_skin_plan_values},
    {"skin_plan, skin", every_skin_plan_skin},
    {"skin_plan_coo", every_skin_plan_coo},
    {"skin_plan_coo32", every_skin_plan_coo32},
    {"skin_plan_values, skin", every_skin_plan_values},
    {"skin_states", every_skin_states},
    {"skin_equilibrium", every_skin_equilibrium},
    {"skin_use_normals", every_skin_use_committed},
    {"skin_residual, normals of t_n", every_skin_residual},
    {"skin_use_normals, as created", every_skin_use_current},
    {"skin_turn_multipliers", every_skin_turn},
    {"skin_commit", every_skin_commit},
    {"skin_rollback", every_skin_rollback},
    {"skin_commit, again", every_skin_commit},
    {"skin_exchange", every_skin_exchange},
    {"skin_exchange, back", every_skin_exchange},
    {"skin_history_size", every_skin_history_size},
    {"skin_history_export", every_skin_export},
    {"skin_set_pair, apart", every_skin_apart},
    {"skin_commit, apart", every_skin_commit},
    {"skin_set_pair, together", every_skin_set_pair},
    {"skin_history_import", every_skin_import},
    {"skin_residual, imported", every_skin_residual},
    {"skin_report", every_skin_report},
    {"skin_destroy", every_skin_destroy},
};

/* A refusal of every function: no pointer at all. */
static inline int32_t every_refusal(int k) {
  switch (k) {
    case 0: return stickslip_pair_weights(NULL, NULL, NULL, NULL, NULL);
    case 1: return stickslip_pair_gap(NULL, NULL, NULL, NULL);
    case 2: return stickslip_pair_residual(NULL, NULL, NULL, NULL, NULL);
    case 3: return stickslip_pair_tangent(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0);
    case 4: return stickslip_node_respond(NULL, NULL);
    case 5: return stickslip_node_block(NULL, 1.0, 0, NULL, NULL);
    case 6: return stickslip_facet_geometry(3, NULL, NULL, NULL);
    case 7: return stickslip_node_normal(NULL, NULL);
    case 8: return stickslip_options_init(NULL, 0);
    case 9: return stickslip_last_error_padded(NULL, 0);
    case 10: return stickslip_surface_split_creases(NULL, 1.0, 0, 0, NULL, NULL, NULL);
    case 11: return stickslip_crosspoints_find(1, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL);
    case 12: return stickslip_interface_create(NULL, NULL, NULL, NULL);
    case 13: return stickslip_interface_destroy((stickslip_interface **)(uintptr_t)1);
    case 14: return stickslip_interface_set_friction(NULL, NULL);
    case 15: return stickslip_interface_set_augmentation(NULL, NULL);
    case 16: return stickslip_interface_set_normals(NULL, NULL);
    case 17: return stickslip_interface_set_constraints(NULL, 0, NULL, NULL);
    case 18: return stickslip_interface_set_previous(NULL, NULL, NULL);
    case 19: return stickslip_interface_initial_multipliers(NULL, NULL);
    case 20: return stickslip_interface_sums(NULL, NULL, NULL, NULL);
    case 21: return stickslip_interface_states(NULL, NULL, NULL, NULL, NULL, NULL);
    case 22: return stickslip_interface_residual(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL);
    case 23: return stickslip_interface_tangent_coo(NULL, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL);
    case 24: return stickslip_interface_tangent_csr(NULL, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL);
    case 25: return stickslip_interface_pattern_coo(NULL, NULL, NULL, 0, NULL, NULL, NULL);
    case 26: return stickslip_interface_commit(NULL, NULL, NULL, NULL, NULL);
    case 27: return stickslip_interface_rollback(NULL);
    case 28: return stickslip_interface_history_size(NULL, NULL, NULL);
    case 29: return stickslip_interface_history_export(NULL, 0, NULL, 0, NULL);
    case 30: return stickslip_interface_history_import(NULL, 0, NULL, 0, NULL);
    case 31: return stickslip_interface_counters(NULL, NULL);
    case 32: return stickslip_interface_effects(NULL, NULL, 0);
    case 33: return stickslip_interface_report(NULL, NULL, NULL, NULL);
    case 34: return stickslip_interface_step_limit(NULL, NULL, NULL, NULL, NULL, 0.0, NULL);
    case 35: return stickslip_interface_equilibrium(NULL, NULL, NULL, NULL, NULL, NULL);
    case 36: return stickslip_node_equilibrium(NULL, 0.0, 0.0, NULL, NULL, NULL);
    case 37: return stickslip_facet_normal(4, NULL, NULL);
    case 38: return stickslip_pair_dual(NULL, NULL, NULL, NULL, NULL, NULL);
    case 39: return stickslip_facet_tangent(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0);
    case 40: return stickslip_facet_dual(4, NULL, NULL, NULL, NULL, NULL);
    case 41: return stickslip_interface_carriers(NULL, 0, NULL, NULL, NULL, NULL);
    case 42: return stickslip_interface_condensed_multipliers(NULL, NULL, NULL, NULL, NULL);
    case 43: return stickslip_interface_condensed_residual(NULL, NULL, NULL, NULL, NULL, NULL, NULL);
    case 44: return stickslip_interface_condensed_coo(NULL, NULL, NULL, NULL, 0, 0, NULL, NULL, NULL, NULL);
    case 45: return stickslip_interface_condensed_csr(NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL);
    case 46: return stickslip_interface_condensed_pattern(NULL, NULL, NULL, 0, NULL, NULL, 0, NULL, NULL, NULL);
    case 47: return stickslip_node_condense(NULL, NULL, 0, NULL, NULL, NULL);
    case 48: return stickslip_interface_use_normals(NULL, 0);
    case 49: return stickslip_interface_turn_multipliers(NULL, NULL, NULL);
    case 50: return stickslip_facet_normal_derivatives(4, NULL, NULL);
    case 51: return stickslip_node_turn(NULL, NULL, 0, NULL, NULL, NULL);
    case 52: return stickslip_pair_begin(NULL, 0, NULL, NULL, NULL, NULL);
    case 53: return stickslip_pair_state_gap(NULL, NULL, NULL, NULL);
    case 54: return stickslip_pair_state_residual(NULL, NULL, NULL);
    case 55: return stickslip_pair_state_tangent(NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0);
    case 56: return stickslip_interface_plan(NULL, NULL, NULL, 0, NULL, NULL);
    case 57: return stickslip_interface_plan_coo(NULL, 0, 0, NULL, NULL);
    case 58: return stickslip_interface_plan_coo32(NULL, 0, 0, NULL, NULL);
    case 59: return stickslip_interface_plan_csr(NULL, 0, 0, NULL, NULL, NULL);
    case 60: return stickslip_interface_plan_csr32(NULL, 0, 0, NULL, NULL, NULL);
    case 61: return stickslip_interface_plan_values(NULL, NULL, NULL, NULL, NULL, 0, NULL);
    case 62: return stickslip_interface_condensed_plan(NULL, NULL, NULL, 0, NULL, NULL);
    case 63: return stickslip_interface_condensed_values(NULL, NULL, NULL, NULL, NULL, NULL);
    case 64: return stickslip_interface_set_committed(NULL, NULL, NULL, NULL, 0);
    case 65: return stickslip_rigid_positions(NULL, NULL, NULL);
    case 66: return stickslip_rigid_resultant(NULL, NULL, NULL, NULL);
    case 67: return stickslip_rigid_turn(NULL);
    case 68: return stickslip_rigid_create(1, NULL, 0, 0, NULL, NULL, NULL, NULL);
    case 69: return stickslip_rigid_coo(NULL, 0, NULL, NULL);
    case 70: return stickslip_rigid_values(NULL, NULL, NULL, NULL, NULL);
    case 71: return stickslip_rigid_destroy((stickslip_rigid **)(uintptr_t)1);
    case 72: return stickslip_interface_set_offsets(NULL, NULL, NULL);
    case 73: return stickslip_interface_adjust(NULL, 1.0, NULL, NULL, NULL);
    case 74: return stickslip_interface_shape_offsets(NULL, 0, 1, 1.0, NULL, NULL, NULL);
    case 75: return stickslip_interface_set_law(NULL, NULL);
    case 76: return stickslip_interface_set_threshold(NULL, NULL, NULL, 0);
    case 77: return stickslip_interface_law_states(NULL, 0, NULL, NULL);
    case 78: return stickslip_interface_set_law_states(NULL, 0, NULL);
    case 79: return stickslip_interface_heat(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL);
    case 80:
      return stickslip_interface_heat_tangent_coo(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0, 0, NULL, NULL, NULL, NULL);
    case 81: return stickslip_node_heat(NULL, 0.0, 0.0, 0.0, 1.0, 0.0, NULL, NULL, NULL);
    case 82: return stickslip_interface_commit_check(NULL, NULL, NULL, NULL, NULL);
    case 83: return stickslip_lines_split_creases(NULL, 1.0, 0, 0, NULL, NULL, NULL);
    case 84: return stickslip_options_paper(NULL);
    case 85: return stickslip_options_method(NULL, NULL);
    case 86: return stickslip_interface_previous_tangent_coo(NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL);
    case 87: return stickslip_interface_adjoint(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL);
    case 88: return stickslip_interface_sensitivity(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL);
    case 89: return stickslip_skin_create(NULL, NULL, 0, NULL, NULL);
    case 90: return stickslip_skin_destroy((stickslip_skin **)(uintptr_t)1);
    case 91: return stickslip_skin_copies(NULL, 0, NULL, NULL, NULL, NULL);
    case 92: return stickslip_skin_set_pair(NULL, 0, 0, 0.0);
    case 93: return stickslip_skin_set_constraints(NULL, 0, NULL, NULL);
    case 94: return stickslip_skin_initial_multipliers(NULL, NULL);
    case 95: return stickslip_skin_residual(NULL, NULL, NULL, NULL, NULL);
    case 96: return stickslip_skin_plan(NULL, NULL, 0, NULL);
    case 97: return stickslip_skin_plan_coo(NULL, 0, NULL, NULL);
    case 98: return stickslip_skin_plan_coo32(NULL, 0, NULL, NULL);
    case 99: return stickslip_skin_plan_values(NULL, NULL, NULL, 0, NULL);
    case 100: return stickslip_skin_states(NULL, NULL, NULL, NULL);
    case 101: return stickslip_skin_equilibrium(NULL, NULL, NULL, NULL);
    case 102: return stickslip_skin_step_limit(NULL, NULL, NULL, 0.0, NULL);
    case 103: return stickslip_skin_use_normals(NULL, 0);
    case 104: return stickslip_skin_turn_multipliers(NULL, NULL, NULL);
    case 105: return stickslip_skin_commit(NULL, NULL, NULL);
    case 106: return stickslip_skin_exchange(NULL, NULL);
    case 107: return stickslip_skin_rollback(NULL);
    case 108: return stickslip_skin_history_size(NULL, NULL, NULL);
    case 109: return stickslip_skin_history_export(NULL, 0, NULL, 0, NULL);
    case 110: return stickslip_skin_history_import(NULL, 0, NULL, 0, NULL);
    case 111: return stickslip_skin_facets(NULL, NULL);
    case 112: return stickslip_skin_report(NULL, NULL);
    case 113: return stickslip_interface_set_layer(NULL, NULL);
    default: return stickslip_interface_diagnose(NULL, NULL, NULL, NULL, NULL, NULL);
  }
}
enum { REFUSALS = 114 };

/* Room and sizes for the structs that come out. */
static inline void every_room(every *c) {
  handle *h = &c->h;
  memset(&h->states, 0, sizeof h->states);
  h->states.struct_size = sizeof h->states;
  h->states.state = h->state;
  h->states.normal = h->normal;
  memset(&c->heat_nodes, 0, sizeof c->heat_nodes);
  c->heat_nodes.struct_size = sizeof c->heat_nodes;
  c->heat_nodes.flux = c->heat_flux;
  /* A mortar side that does not move has no derivatives by its positions of now. */
  const int moves = h->s.options.mortar_side == STICKSLIP_MORTAR_DEFORMABLE;
  dependence *to = &c->slopes, *along = &c->along;
  c->gradient = (stickslip_gradient){.struct_size = sizeof c->gradient, .previous1 = to->previous1, .previous2 = to->previous2,
      .now1 = to->now1, .now2 = moves ? to->now2 : NULL, .friction = to->friction, .shear_limit = to->shear_limit,
      .offsets1 = to->offsets1, .offsets2 = to->offsets2};
  c->direction = (stickslip_direction){.struct_size = sizeof c->direction, .previous1 = along->previous1,
      .previous2 = along->previous2, .now1 = along->now1, .now2 = moves ? along->now2 : NULL, .friction = along->friction,
      .shear_limit = along->shear_limit, .offsets1 = along->offsets1, .offsets2 = along->offsets2};
  c->counters.struct_size = sizeof c->counters;
  memset(&c->equilibrium, 0, sizeof c->equilibrium);
  c->equilibrium.struct_size = sizeof c->equilibrium;
  c->report.struct_size = sizeof c->report;
  c->report.cover = c->cover;
  c->report.fraction = c->fraction;
  c->report.layers = c->layers;
  c->report.facets = c->facets;
  c->report.text = c->report_text;
  c->report.text_capacity = sizeof c->report_text;
  c->diagnosis.struct_size = sizeof c->diagnosis;
  c->diagnosis.state = c->diagnosed_state;
  c->diagnosis.suspect_nodes = c->suspect_nodes;
  c->diagnosis.suspect_directions = c->suspect_directions;
  c->diagnosis.suspect_ratios = c->suspect_ratios;
  c->diagnosis.suspect_causes = c->suspect_causes;
  c->diagnosis.suspect_capacity = COUNT(c->suspect_nodes);
  c->diagnosis.text = c->diagnosis_text;
  c->diagnosis.text_capacity = sizeof c->diagnosis_text;
  memset(c->diagnosed_state, 0, sizeof c->diagnosed_state);
  c->skin_states = (stickslip_states){.struct_size = sizeof c->skin_states, .state = c->copy_state, .normal = c->copy_normal,
                                      .gap = c->copy_gap};
  c->skin_equilibrium = c->equilibrium;
  c->sides = (stickslip_skin_sides){.struct_size = sizeof c->sides, .side = c->facet_side, .piece = c->facet_piece,
                                    .partner = c->facet_partner, .distance = c->facet_distance, .body = c->facet_body};
  c->summary.struct_size = sizeof c->summary;
}

/* Room and sizes; outputs hold zeros. `s` is set up by the test (scene_init and options) and not created yet. */
static inline void every_init(every *c) {
  static every empty;
  const scene s = c->h.s;
  *c = empty;
  c->h.s = s;
  element_init(&c->e);
  scene_create(&c->h.s);
  scene_commit(&c->h.s);
  history_take(c->h.s.interface, &c->exported);
  handle_matrix(&c->h);
  handle_host(&c->h);
  for (int a = 0; a < N1; ++a) {
    c->heat_t1[a] = 0.25 * a;
    c->heat_e1[a] = c->h.s.options.index_base + UNKNOWNS + a;
  }
  for (int a = 0; a < N2; ++a) {
    c->heat_t2[a] = -0.5 * a;
    c->heat_e2[a] = c->h.s.options.index_base + UNKNOWNS + N1 + a;
  }
  double *along = (double *)&c->along;
  for (int k = 0; k < (int)(sizeof c->along / sizeof *along); ++k) along[k] = 0.25 * (k % 7) - 0.5;
  for (int k = 0; k < X1; ++k) c->a1[k] = c->a_rows[k] = 0.125 * (k % 11) - 0.5;
  for (int k = 0; k < X2; ++k) c->a2[k] = 0.5 * (k % 5) - 1.0;
  skin_init_base(&c->skin, c->h.s.options.index_base);
  skin_create(&c->skin);
  memcpy(c->skin_committed, c->skin.lambda, sizeof c->skin_committed);
  CHECK_OK(stickslip_skin_commit(c->skin.skin, c->skin.reference, c->skin_committed));
  memset(c->skin_committed, 0, sizeof c->skin_committed);
  skin_history(c->skin.skin, &c->skin_exported);
  skin_destroy(&c->skin);
  skin_move(c->skin_dx, 0.0, 0.0, -0.5);
  every_room(c);
}

/* Whether two contexts have got the same of a skin to the bit, but for what goes in and comes out. */
static inline int every_skin_equal(const every *a, const every *b) {
#define SAME(member) (memcmp(&a->member, &b->member, sizeof a->member) == 0)
  return SAME(copies) && SAME(copy_equations) && SAME(copy_count) && SAME(skin_multipliers) && SAME(skin_count) &&
         SAME(skin_rows) && SAME(skin_columns) && SAME(skin_rows32) && SAME(skin_columns32) && SAME(skin_initial) &&
         SAME(skin_force) && SAME(skin_lines) && SAME(skin_limit) && SAME(copy_state) && SAME(copy_normal) && SAME(copy_gap) &&
         SAME(skin_equilibrium) && SAME(facet_side) && SAME(facet_piece) && SAME(facet_partner) && SAME(facet_distance) &&
         SAME(facet_body) && SAME(summary) && SAME(skin_history);
#undef SAME
}

/* Whether two contexts have got the same outputs to the bit, times apart. */
static inline int every_equal(every *a, every *b) {
  a->counters.seconds_search = b->counters.seconds_search = 0.0;
  a->counters.seconds_integration = b->counters.seconds_integration = 0.0;
  a->counters.seconds_assembly = b->counters.seconds_assembly = 0.0;
#define SAME(member) (memcmp(&a->member, &b->member, sizeof a->member) == 0)
  return SAME(e.w_out) && SAME(e.gap) && SAME(e.force) && SAME(e.k) && SAME(e.normals) && SAME(e.areas) &&
         SAME(e.normal) && SAME(e.row) && SAME(e.block) && SAME(e.responses) && SAME(e.fade) && SAME(e.dual_areas) &&
         SAME(e.coefficients) && SAME(e.dual_ab) && SAME(e.dual_ac) && SAME(e.facet_k) && SAME(h.force1) && SAME(h.force2) &&
         SAME(h.rows) && SAME(h.sums) && SAME(h.values) && SAME(h.row_numbers) && SAME(h.columns) && SAME(h.count) &&
         SAME(h.state) && SAME(h.normal) && SAME(h.csr) && SAME(options) && SAME(split_nodes) && SAME(originals) &&
         SAME(split_count) && SAME(shared_nodes) && SAME(shared_claims) && SAME(shared_count) && SAME(shared_kinds) &&
         SAME(initial) && SAME(history) && SAME(counters) && SAME(effects) && SAME(last_error) && SAME(cover) &&
         SAME(layers) && SAME(fraction) && SAME(facets) && SAME(report_text) && SAME(report.penetration) &&
         SAME(report.finding) && SAME(diagnosed_state) && SAME(suspect_nodes) && SAME(suspect_directions) &&
         SAME(suspect_ratios) && SAME(suspect_causes) && SAME(diagnosis_text) && SAME(diagnosis.overlap) &&
         SAME(diagnosis.error) && SAME(step_limit) && SAME(equilibrium) &&
         SAME(node_equilibrium) && SAME(facet_normal) && SAME(condensed_lambda) && SAME(condensed_rows) &&
         SAME(condensed_force) && SAME(node_condensed) && SAME(triplet_bits) && SAME(triplet_counts) &&
         SAME(e.normal_derivatives) && SAME(e.turn) && SAME(turned) && SAME(plan_rows) && SAME(plan_counts) &&
         SAME(row_list) && SAME(row_offsets) && SAME(plan_columns) && SAME(row_list32) && SAME(row_offsets32) &&
         SAME(rows32) && SAME(columns32) && SAME(plan_values) && SAME(rigid_x) && SAME(resultant) && SAME(turned_motion) &&
         SAME(rigid_count) && SAME(rigid_rows) && SAME(rigid_columns) && SAME(rigid_values) && SAME(law_states) &&
         SAME(law_count) && SAME(heat1) && SAME(heat2) && SAME(heat_flux) && SAME(heat_sides) && SAME(heat_slopes) &&
         SAME(heat_conductance) && SAME(heat_count) && SAME(heat_columns) && SAME(slopes) &&
         SAME(change1) && SAME(change2) && SAME(change_rows) && SAME(skin_values) && SAME(skin_turned) && SAME(skin_committed) &&
         every_skin_equal(a, b);
#undef SAME
}

#endif
