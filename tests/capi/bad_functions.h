/* Every function of the ABI as a call on any pointers, with good ones, for the rows of bad_input.txt. */
#ifndef BAD_FUNCTIONS_H
#define BAD_FUNCTIONS_H

#include "bad_rows.h"
#include "every_call.h"

/* All that goes in or comes out: first what `every` has, then the rest. */
static struct {
  every every;
  int64_t ld, capacity, length, n_interfaces, n, n_rows, n_integers, n_reals, commits, nodes[3];
  stickslip_surface lines;
  int64_t line_offsets[3], line_nodes[4];
  double line_x[6];
  int64_t offsets1[3], shared1[6], offsets2[3], shared2[4], options_size;
  int32_t n_facet, layout, index_base, piece, which_normals, pairs, entries, side, shape;
  double scale, stiffness, rounding, angle, penetration, tolerance, radius, point[3], direction[3], neighbours[12];
  double raised1[N1], raised2[N2], remembered[N1];
  int64_t n_states, remembered_count;
  stickslip_law law;
  stickslip_layer layer;
  double overclosure[3], layer_pressure[3];
  stickslip_heat heat;
  double jump, pressure, node_gap, area, work;
  int32_t which;
  double mu[N1], r[N1], normals[X1], slip[X1], directions[9], sums[STICKSLIP_SUMS_PER_NODE * N1], dx1[X1], dx2[X2];
  weights previous;
  history imported;
  stickslip_node_response answer;
  stickslip_interface *out;
  rigid_parts rigid;
  int64_t n_bodies, n_entries;
  stickslip_skin *skin_out;
  history skin_imported;
  int64_t first_multiplier, body1, body2;
  double skin_mu;
} b, before;
static double expected[UNKNOWNS];
#define E b.every.e
#define H b.every.h
#define S b.every.h.s

/* An argument: what is good for it, and whether it may be null. */
typedef struct {
  const char *name;
  void *good;
  bad_type type;
} argument;

#define INTERFACE {"interface", &S.interface, NEEDED}
#define AT INTERFACE, {"x1", S.x1, NEEDED}, {"x2", S.x2, NEEDED}
#define POINT AT, {"lambda", S.lambda, NEEDED}, {"sums", NULL, OPTIONAL}
#define SKIN {"skin", &b.every.skin.skin, NEEDED}
#define SKIN_POINT SKIN, {"x", b.every.skin.x, NEEDED}, {"lambda", b.every.skin.lambda, NEEDED}
#define PAIR {"pair", &E.pair, NEEDED}
#define WEIGHTS {"n_ab", E.w.ab, NEEDED}, {"n_ac", E.w.ac, NEEDED}
#define OUT(object) {"out", &(object), NEEDED}

/* name, call, arguments: a function that is called with any pointers. */
#define FUNCTION(name, call, ...)                                            \
  static const argument arguments_##name[] = {__VA_ARGS__};                  \
  static void *a_##name[COUNT(arguments_##name)];                            \
  static int32_t on_##name(void **a) { return stickslip_##name call; }
FUNCTION(pair_weights, (a[0], a[1], a[2], a[3], a[4]), PAIR, {"n_ab", E.w_out.ab, OPTIONAL},
         {"n_ac", E.w_out.ac, OPTIONAL}, {"dn_ab", E.w_out.dab, OPTIONAL},
         {"dn_ac", E.w_out.dac, OPTIONAL})
FUNCTION(pair_gap, (a[0], a[1], a[2], a[3]), PAIR, WEIGHTS, {"gap", E.gap, NEEDED})
FUNCTION(pair_residual, (a[0], a[1], a[2], a[3], a[4]), PAIR, WEIGHTS, {"traction", E.traction, NEEDED},
         {"force", E.force, NEEDED})
FUNCTION(pair_tangent, (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], b.ld), PAIR, WEIGHTS,
         {"dn_ab", E.w.dab, NEEDED}, {"dn_ac", E.w.dac, NEEDED}, {"n_ab_previous", b.previous.ab, NEEDED},
         {"n_ac_previous", b.previous.ac, NEEDED}, {"traction", E.traction, NEEDED}, {"responses", E.responses, NEEDED},
         {"row_scale", E.row_scale, OPTIONAL}, {"k", E.k, NEEDED})
FUNCTION(pair_begin, (a[0], b.capacity, a[1], a[2], a[3], a[4]), PAIR, {"state", E.state_out, NEEDED},
         {"n_ab", E.w_out.ab, OPTIONAL}, {"n_ac", E.w_out.ac, OPTIONAL}, {"gap", E.gap, OPTIONAL})
FUNCTION(pair_state_gap, (a[0], a[1], a[2], a[3]), {"state", E.state, NEEDED}, {"n_ab_previous", b.previous.ab, NEEDED},
         {"n_ac_previous", b.previous.ac, NEEDED}, {"gap", E.gap, NEEDED})
FUNCTION(pair_state_residual, (a[0], a[1], a[2]), {"state", E.state, NEEDED}, {"traction", E.traction, NEEDED},
         {"force", E.force, NEEDED})
FUNCTION(pair_state_tangent, (a[0], a[1], a[2], a[3], a[4], a[5], a[6], b.ld), {"state", E.state, NEEDED},
         {"n_ab_previous", b.previous.ab, NEEDED}, {"n_ac_previous", b.previous.ac, NEEDED},
         {"traction", E.traction, NEEDED}, {"responses", E.responses, NEEDED}, {"row_scale", E.row_scale, OPTIONAL},
         {"k", E.k, NEEDED})
FUNCTION(facet_dual, (b.n_facet, a[0], a[1], a[2], a[3], a[4]), {"x", E.x1, NEEDED}, {"mass", E.mass, NEEDED},
         {"fade", &E.fade, OPTIONAL}, {"areas", E.dual_areas, OPTIONAL}, {"coefficients", E.coefficients, OPTIONAL})
FUNCTION(pair_dual, (a[0], a[1], a[2], a[3], a[4], a[5]), PAIR, {"mass", E.mass, NEEDED}, WEIGHTS,
         {"dual_ab", E.dual_ab, OPTIONAL}, {"dual_ac", E.dual_ac, OPTIONAL})
FUNCTION(facet_tangent, (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], b.ld), {"facet", &E.facet, NEEDED}, WEIGHTS,
         {"n_ab_previous", b.previous.ab, NEEDED}, {"n_ac_previous", b.previous.ac, NEEDED},
         {"traction", E.traction, NEEDED}, {"responses", E.responses, NEEDED}, {"row_scale", E.row_scale, OPTIONAL},
         {"k", E.facet_k, NEEDED})
FUNCTION(facet_geometry, (b.n_facet, a[0], a[1], a[2]), {"x", E.x1, NEEDED}, {"normals", E.normals, OPTIONAL},
         {"areas", E.areas, OPTIONAL})
FUNCTION(facet_normal, (b.n_facet, a[0], a[1]), {"x", E.x1, NEEDED}, {"normal", b.every.facet_normal, NEEDED})
FUNCTION(node_normal, (a[0], a[1]), {"sum", E.sum, NEEDED}, {"normal", E.normal, NEEDED})
FUNCTION(node_respond, (a[0], a[1]), {"node", &E.node, NEEDED}, {"response", &b.answer, NEEDED})
FUNCTION(node_block, (a[0], b.scale, b.layout, a[1], a[2]), {"response", E.responses, NEEDED}, {"row", E.row, OPTIONAL},
         {"block", E.block, OPTIONAL})
FUNCTION(node_equilibrium, (a[0], b.stiffness, b.rounding, a[1], a[2], a[3]), {"node", &E.node, NEEDED},
         {"gap", b.every.node_equilibrium, OPTIONAL}, {"traction", b.every.node_equilibrium + 1, OPTIONAL},
         {"slip", b.every.node_equilibrium + 2, OPTIONAL})
FUNCTION(options_init, (a[0], (uint64_t)b.options_size), {"options", &b.every.options, NEEDED})
FUNCTION(options_paper, (a[0]), {"options", &S.options, NEEDED})
FUNCTION(options_method, (a[0], a[1]), {"options", &S.options, NEEDED}, {"method", &S.method, NEEDED})
FUNCTION(last_error_padded, (a[0], b.length), {"text", b.every.last_error, LETTERS})
FUNCTION(surface_split_creases, (a[0], b.angle, b.index_base, b.capacity, a[1], a[2], a[3]),
         {"surface", &S.nonmortar, NEEDED}, {"facet_nodes", b.every.split_nodes, NEEDED},
         {"originals", b.every.originals, NEEDED}, {"count", &b.every.split_count, NEEDED})
FUNCTION(lines_split_creases, (a[0], b.angle, b.index_base, b.capacity, a[1], a[2], a[3]),
         {"surface", &b.lines, NEEDED}, {"facet_nodes", b.every.split_nodes, NEEDED},
         {"originals", b.every.originals, NEEDED}, {"count", &b.every.split_count, NEEDED})
FUNCTION(crosspoints_find, (b.n_interfaces, a[0], a[1], a[2], a[3], b.capacity, a[4], a[5], a[6], a[7]),
         {"nonmortar_offsets", b.offsets1, NEEDED}, {"nonmortar_nodes", b.shared1, NEEDED},
         {"mortar_offsets", b.offsets2, NEEDED}, {"mortar_nodes", b.shared2, NEEDED},
         {"nodes", b.every.shared_nodes, NEEDED}, {"kinds", b.every.shared_kinds, NEEDED},
         {"claims", b.every.shared_claims, NEEDED}, {"count", &b.every.shared_count, NEEDED})
FUNCTION(interface_create, (a[0], a[1], a[2], a[3]), {"nonmortar", &S.nonmortar, NEEDED}, {"mortar", &S.mortar, NEEDED},
         {"options", &S.options, NEEDED}, {"out", &b.out, NEEDED})
FUNCTION(interface_destroy, (a[0]), {"interface", &b.every.other, OPTIONAL})
FUNCTION(interface_set_friction, (a[0], a[1]), INTERFACE, {"mu", b.mu, NEEDED})
FUNCTION(interface_set_augmentation, (a[0], a[1]), INTERFACE, {"r", b.r, OPTIONAL})
FUNCTION(interface_set_normals, (a[0], a[1]), INTERFACE, {"normals", b.normals, OPTIONAL})
FUNCTION(interface_set_constraints, (a[0], b.n, a[1], a[2]), INTERFACE, {"nodes", b.nodes, NEEDED},
         {"directions", b.directions, NEEDED})
FUNCTION(interface_set_previous, (a[0], a[1], a[2]), AT)
FUNCTION(interface_set_committed, (a[0], a[1], a[2], a[3], b.commits), AT, {"slip", b.slip, OPTIONAL})
FUNCTION(interface_initial_multipliers, (a[0], a[1]), {"interface", &b.every.other, NEEDED},
         {"lambda", b.every.initial, NEEDED})
FUNCTION(interface_sums, (a[0], a[1], a[2], a[3]), AT, {"sums", H.sums, NEEDED})
FUNCTION(interface_states, (a[0], a[1], a[2], a[3], a[4], a[5]), POINT, OUT(H.states))
FUNCTION(interface_residual, (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]), POINT, {"force1", H.force1, NEEDED},
         {"force2", H.force2, NEEDED}, {"rows", H.rows, NEEDED})
FUNCTION(interface_tangent_coo, (a[0], a[1], a[2], a[3], a[4], b.capacity, a[5], a[6], a[7], a[8]), POINT,
         {"rows", H.row_numbers, NEEDED}, {"columns", H.columns, NEEDED}, {"values", H.values, NEEDED},
         {"count", &H.count, NEEDED})
FUNCTION(interface_tangent_csr, (a[0], a[1], a[2], a[3], a[4], b.n_rows, a[5], a[6], a[7]), POINT,
         {"row_offsets", H.offsets, NEEDED}, {"columns", H.csr_columns, NEEDED}, {"values", H.csr, NEEDED})
FUNCTION(interface_pattern_coo, (a[0], a[1], a[2], b.capacity, a[3], a[4], a[5]), AT, {"rows", H.row_numbers, NEEDED},
         {"columns", H.columns, NEEDED}, {"count", &H.count, NEEDED})
FUNCTION(interface_plan, (a[0], a[1], a[2], b.pairs, a[3], a[4]), AT, {"rows", b.every.plan_rows, NEEDED},
         {"count", b.every.plan_counts, NEEDED})
FUNCTION(interface_plan_coo, (a[0], b.entries, b.capacity, a[1], a[2]), INTERFACE, {"rows", H.row_numbers, NEEDED},
         {"columns", H.columns, NEEDED})
FUNCTION(interface_plan_coo32, (a[0], b.entries, b.capacity, a[1], a[2]), INTERFACE, {"rows", b.every.rows32, NEEDED},
         {"columns", b.every.columns32, NEEDED})
FUNCTION(interface_plan_csr, (a[0], b.entries, b.capacity, a[1], a[2], a[3]), INTERFACE,
         {"rows", b.every.row_list, NEEDED}, {"row_offsets", b.every.row_offsets, NEEDED},
         {"columns", b.every.plan_columns, NEEDED})
FUNCTION(interface_plan_csr32, (a[0], b.entries, b.capacity, a[1], a[2], a[3]), INTERFACE,
         {"rows", b.every.row_list32, NEEDED}, {"row_offsets", b.every.row_offsets32, NEEDED},
         {"columns", b.every.columns32, NEEDED})
FUNCTION(interface_plan_values, (a[0], a[1], a[2], a[3], a[4], b.capacity, a[5]), POINT,
         {"values", b.every.plan_values[0], NEEDED})
FUNCTION(interface_condensed_plan, (a[0], a[1], a[2], b.pairs, a[3], a[4]), AT, {"rows", b.every.plan_rows, NEEDED},
         {"counts", b.every.plan_counts, NEEDED})
FUNCTION(interface_condensed_values, (a[0], a[1], a[2], a[3], a[4], a[5]), AT, {"lambda", S.lambda, NEEDED},
         {"forces", b.every.plan_values[0], NEEDED}, {"constraints", b.every.plan_values[1], NEEDED})
FUNCTION(interface_step_limit, (a[0], a[1], a[2], a[3], a[4], b.penetration, a[5]), AT, {"dx1", b.dx1, NEEDED},
         {"dx2", b.dx2, NEEDED}, {"fraction", &H.fraction, NEEDED})
FUNCTION(interface_commit, (a[0], a[1], a[2], a[3], a[4]), POINT)
FUNCTION(interface_commit_check, (a[0], a[1], a[2], a[3], a[4]), POINT)
FUNCTION(interface_rollback, (a[0]), INTERFACE)
FUNCTION(interface_history_size, (a[0], a[1], a[2]), INTERFACE, {"n_integers", &b.every.history.n_integers, NEEDED},
         {"n_reals", &b.every.history.n_reals, NEEDED})
FUNCTION(interface_history_export, (a[0], b.n_integers, a[1], b.n_reals, a[2]), INTERFACE,
         {"integers", b.every.history.integers, NEEDED}, {"reals", b.every.history.reals, NEEDED})
FUNCTION(interface_history_import, (a[0], b.n_integers, a[1], b.n_reals, a[2]), INTERFACE,
         {"integers", b.imported.integers, NEEDED}, {"reals", b.imported.reals, NEEDED})
FUNCTION(interface_counters, (a[0], a[1]), INTERFACE, OUT(b.every.counters))
FUNCTION(interface_effects, (a[0], a[1], b.capacity), INTERFACE, {"text", b.every.effects, LETTERS})
FUNCTION(interface_report, (a[0], a[1], a[2], a[3]), AT, OUT(b.every.report))
FUNCTION(interface_diagnose, (a[0], a[1], a[2], a[3], a[4], a[5]), POINT, OUT(b.every.diagnosis))
FUNCTION(node_condense, (a[0], a[1], b.layout, a[2], a[3], a[4]), {"node", &E.node, NEEDED},
         {"response", E.responses, NEEDED}, {"w", b.every.node_condensed, OPTIONAL},
         {"row", b.every.node_condensed + 9, OPTIONAL}, {"row_scale", b.every.node_condensed + 12, OPTIONAL})
FUNCTION(interface_carriers, (a[0], b.capacity, a[1], a[2], a[3], a[4]), INTERFACE, {"nodes", H.row_numbers, NEEDED},
         {"carriers", H.columns, NEEDED}, {"weights", H.values, NEEDED}, {"count", &H.count, NEEDED})
FUNCTION(interface_condensed_multipliers, (a[0], a[1], a[2], a[3], a[4]), AT, {"host1", H.host1, NEEDED},
         {"lambda", b.every.condensed_lambda, NEEDED})
FUNCTION(interface_condensed_residual, (a[0], a[1], a[2], a[3], a[4], a[5], a[6]), AT, {"lambda", S.lambda, NEEDED},
         {"host1", H.host1, NEEDED}, {"rows1", b.every.condensed_rows, NEEDED},
         {"force2", b.every.condensed_force, NEEDED})
FUNCTION(interface_condensed_coo, (a[0], a[1], a[2], a[3], b.piece, b.capacity, a[4], a[5], a[6], a[7]), AT,
         {"lambda", S.lambda, NEEDED}, {"rows", H.row_numbers, NEEDED}, {"columns", H.columns, NEEDED},
         {"values", H.values, NEEDED}, {"count", &H.count, NEEDED})
FUNCTION(interface_condensed_csr, (a[0], a[1], a[2], a[3], b.n_rows, a[4], a[5], a[6]), AT,
         {"lambda", S.lambda, NEEDED}, {"row_offsets", H.offsets, NEEDED}, {"columns", H.csr_columns, NEEDED},
         {"values", H.csr, NEEDED})
FUNCTION(interface_condensed_pattern, (a[0], a[1], a[2], b.n_rows, a[3], a[4], b.capacity, a[5], a[6], a[7]), AT,
         {"row_offsets", H.offsets, NEEDED}, {"columns", H.csr_columns, NEEDED},
         {"entry_rows", H.row_numbers, NEEDED}, {"entry_columns", H.columns, NEEDED}, {"count", &H.count, NEEDED})
FUNCTION(interface_use_normals, (a[0], b.which_normals), INTERFACE)
FUNCTION(interface_turn_multipliers, (a[0], a[1], a[2]), INTERFACE, {"x1", S.x1, NEEDED}, {"lambda", S.lambda, NEEDED})
FUNCTION(facet_normal_derivatives, (b.n_facet, a[0], a[1]), {"x", E.x1, NEEDED},
         {"derivatives", E.normal_derivatives, NEEDED})
FUNCTION(node_turn, (a[0], a[1], b.layout, a[2], a[3], a[4]), {"node", &E.node, NEEDED}, {"sum", E.sum, NEEDED},
         {"dnu_dsum", E.turn, OPTIONAL}, {"dp_dnormal", E.turn + 9, OPTIONAL}, {"drow_dnormal", E.turn + 18, OPTIONAL})
FUNCTION(interface_set_offsets, (a[0], a[1], a[2]), INTERFACE, {"offsets1", b.raised1, OPTIONAL},
         {"offsets2", b.raised2, OPTIONAL})
FUNCTION(interface_adjust, (a[0], b.tolerance, a[1], a[2], a[3]), INTERFACE, {"coordinates", b.every.adjusted, OPTIONAL},
         {"gaps", b.every.gaps, OPTIONAL}, {"moved", b.every.moved, OPTIONAL})
FUNCTION(interface_shape_offsets, (a[0], b.side, b.shape, b.radius, a[1], a[2], a[3]), INTERFACE,
         {"point", b.point, NEEDED}, {"direction", b.direction, NEEDED}, {"offsets", b.every.shape_offsets, NEEDED})
FUNCTION(interface_set_law, (a[0], a[1]), INTERFACE, {"law", &b.law, OPTIONAL})
FUNCTION(interface_set_threshold, (a[0], every_half, a[1], b.n_states), INTERFACE, {"user", NULL, OPTIONAL})
FUNCTION(interface_law_states, (a[0], b.capacity, a[1], a[2]), INTERFACE, {"states", b.remembered, OPTIONAL},
         {"count", &b.remembered_count, NEEDED})
FUNCTION(interface_set_law_states, (a[0], b.n_states, a[1]), INTERFACE, {"states", b.remembered, NEEDED})
FUNCTION(interface_set_layer, (a[0], a[1]), INTERFACE, {"layer", &b.layer, OPTIONAL})
FUNCTION(interface_heat, (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9]), AT, {"lambda", S.lambda, NEEDED},
         {"heat", &b.heat, NEEDED}, {"temperatures1", b.every.heat_t1, NEEDED}, {"temperatures2", b.every.heat_t2, NEEDED},
         {"heat1", b.every.heat1, NEEDED}, {"heat2", b.every.heat2, NEEDED}, {"heat_nodes", &b.every.heat_nodes, OPTIONAL})
FUNCTION(interface_heat_tangent_coo, (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], b.which, b.capacity, a[9], a[10], a[11], a[12]),
         AT, {"lambda", S.lambda, NEEDED}, {"heat", &b.heat, NEEDED}, {"temperatures1", b.every.heat_t1, NEEDED},
         {"temperatures2", b.every.heat_t2, NEEDED}, {"equations1", b.every.heat_e1, NEEDED},
         {"equations2", b.every.heat_e2, NEEDED}, {"rows", b.every.plan_columns, NEEDED},
         {"columns", b.every.heat_columns, NEEDED}, {"values", b.every.plan_values[0], NEEDED}, {"count", &b.every.heat_count, NEEDED})
FUNCTION(node_heat, (a[0], b.jump, b.pressure, b.node_gap, b.area, b.work, a[1], a[2], a[3]), {"heat", &b.heat, NEEDED},
         {"sides", b.every.heat_sides, NEEDED}, {"slopes", b.every.heat_slopes, OPTIONAL},
         {"conductance", &b.every.heat_conductance, OPTIONAL})
FUNCTION(interface_previous_tangent_coo, (a[0], a[1], a[2], a[3], b.capacity, a[4], a[5], a[6], a[7]), AT,
         {"lambda", S.lambda, NEEDED}, {"rows", H.row_numbers, NEEDED}, {"columns", H.columns, NEEDED},
         {"values", H.values, NEEDED}, {"count", &H.count, NEEDED})
FUNCTION(interface_adjoint, (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]), AT, {"lambda", S.lambda, NEEDED},
         {"a1", b.every.a1, NEEDED}, {"a2", b.every.a2, NEEDED}, {"a_rows", b.every.a_rows, NEEDED},
         {"gradient", &b.every.gradient, NEEDED})
FUNCTION(interface_sensitivity, (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]), AT, {"lambda", S.lambda, NEEDED},
         {"direction", &b.every.direction, NEEDED}, {"force1", b.every.change1, NEEDED}, {"force2", b.every.change2, NEEDED},
         {"rows", b.every.change_rows, NEEDED})
FUNCTION(interface_equilibrium, (a[0], a[1], a[2], a[3], a[4], a[5]), POINT, OUT(b.every.equilibrium))

FUNCTION(rigid_positions, (a[0], a[1], a[2]), {"body", &b.rigid.body, NEEDED}, {"motion", &b.rigid.motion, NEEDED},
         {"x", b.every.rigid_x, NEEDED})
FUNCTION(rigid_resultant, (a[0], a[1], a[2], a[3]), {"body", &b.rigid.body, NEEDED}, {"motion", &b.rigid.motion, NEEDED},
         {"forces", b.rigid.forces, NEEDED}, {"resultant", b.every.resultant, NEEDED})
FUNCTION(rigid_turn, (a[0]), {"motion", &b.every.turned_motion, NEEDED})
FUNCTION(rigid_create, (b.n_bodies, a[0], b.index_base, b.n_entries, a[1], a[2], a[3], a[4]),
         {"bodies", &b.rigid.body, NEEDED}, {"rows", b.rigid.rows, NEEDED}, {"columns", b.rigid.columns, NEEDED},
         {"out", &b.every.rigid, NEEDED}, {"count", &b.every.rigid_count, NEEDED})
FUNCTION(rigid_coo, (a[0], b.capacity, a[1], a[2]), {"rigid", NULL, NEEDED}, {"rows", b.every.rigid_rows, NEEDED},
         {"columns", b.every.rigid_columns, NEEDED})
FUNCTION(rigid_values, (a[0], a[1], a[2], a[3], a[4]), {"rigid", NULL, NEEDED}, {"motions", &b.rigid.motion, NEEDED},
         {"forces", b.rigid.forces, NEEDED}, {"nodal", b.rigid.nodal, NEEDED}, {"values", b.every.rigid_values, NEEDED})

FUNCTION(skin_create, (a[0], a[1], b.first_multiplier, a[2], a[3]), {"surface", &b.every.skin.surface, NEEDED},
         {"bodies", b.every.skin.bodies, OPTIONAL}, {"options", &S.options, NEEDED}, OUT(b.skin_out))
FUNCTION(skin_destroy, (a[0]), {"skin", &b.every.skin.skin, OPTIONAL})
FUNCTION(skin_copies, (a[0], b.capacity, a[1], a[2], a[3], a[4]), SKIN, {"originals", b.every.copies, NEEDED},
         {"equations", b.every.copy_equations, NEEDED}, {"count", &b.every.copy_count, NEEDED},
         {"multipliers", &b.every.skin_multipliers, NEEDED})
FUNCTION(skin_set_pair, (a[0], b.body1, b.body2, b.skin_mu), SKIN)
FUNCTION(skin_set_constraints, (a[0], b.n, a[1], a[2]), SKIN, {"nodes", b.nodes, NEEDED}, {"directions", b.directions, NEEDED})
FUNCTION(skin_initial_multipliers, (a[0], a[1]), SKIN, {"lambda", b.every.skin_initial, NEEDED})
FUNCTION(skin_residual, (a[0], a[1], a[2], a[3], a[4]), SKIN_POINT, {"force", b.every.skin_force, NEEDED},
         {"rows", b.every.skin_lines, NEEDED})
FUNCTION(skin_plan, (a[0], a[1], b.pairs, a[2]), SKIN, {"x", b.every.skin.x, NEEDED}, {"count", &b.every.skin_count, NEEDED})
FUNCTION(skin_plan_coo, (a[0], b.capacity, a[1], a[2]), SKIN, {"rows", b.every.skin_rows, NEEDED},
         {"columns", b.every.skin_columns, NEEDED})
FUNCTION(skin_plan_coo32, (a[0], b.capacity, a[1], a[2]), SKIN, {"rows", b.every.skin_rows32, NEEDED},
         {"columns", b.every.skin_columns32, NEEDED})
FUNCTION(skin_plan_values, (a[0], a[1], a[2], b.capacity, a[3]), SKIN_POINT, {"values", b.every.skin_values, NEEDED})
FUNCTION(skin_states, (a[0], a[1], a[2], a[3]), SKIN_POINT, OUT(b.every.skin_states))
FUNCTION(skin_equilibrium, (a[0], a[1], a[2], a[3]), SKIN_POINT, OUT(b.every.equilibrium))
FUNCTION(skin_step_limit, (a[0], a[1], a[2], b.penetration, a[3]), SKIN, {"x", b.every.skin.x, NEEDED},
         {"dx", b.every.skin_dx, NEEDED}, {"fraction", &b.every.skin_limit, NEEDED})
FUNCTION(skin_use_normals, (a[0], b.which_normals), SKIN)
FUNCTION(skin_turn_multipliers, (a[0], a[1], a[2]), SKIN_POINT)
FUNCTION(skin_commit, (a[0], a[1], a[2]), SKIN_POINT)
FUNCTION(skin_exchange, (a[0], a[1]), SKIN, {"lambda", b.every.skin_committed, NEEDED})
FUNCTION(skin_rollback, (a[0]), SKIN)
FUNCTION(skin_history_size, (a[0], a[1], a[2]), SKIN, {"n_integers", &b.every.skin_history.n_integers, NEEDED},
         {"n_reals", &b.every.skin_history.n_reals, NEEDED})
FUNCTION(skin_history_export, (a[0], b.n_integers, a[1], b.n_reals, a[2]), SKIN,
         {"integers", b.every.skin_history.integers, NEEDED}, {"reals", b.every.skin_history.reals, NEEDED})
FUNCTION(skin_history_import, (a[0], b.n_integers, a[1], b.n_reals, a[2]), SKIN, {"integers", b.skin_imported.integers, NEEDED},
         {"reals", b.skin_imported.reals, NEEDED})
FUNCTION(skin_facets, (a[0], a[1]), SKIN, OUT(b.every.sides))
FUNCTION(skin_report, (a[0], a[1]), SKIN, OUT(b.every.summary))

#define NAMED(name) {#name, on_##name, arguments_##name, a_##name, COUNT(arguments_##name)}
static const struct {
  const char *name;
  int32_t (*call)(void **a);
  const argument *arguments;
  void **a;
  int n;
} functions[] = {
    NAMED(pair_weights), NAMED(pair_gap), NAMED(pair_residual), NAMED(pair_tangent), NAMED(facet_geometry),
    NAMED(pair_begin), NAMED(pair_state_gap), NAMED(pair_state_residual), NAMED(pair_state_tangent),
    NAMED(facet_dual), NAMED(pair_dual), NAMED(facet_tangent),
    NAMED(facet_normal), NAMED(node_normal), NAMED(node_respond), NAMED(node_block), NAMED(node_equilibrium),
    NAMED(options_init), NAMED(options_paper), NAMED(options_method), NAMED(last_error_padded), NAMED(surface_split_creases), NAMED(lines_split_creases), NAMED(crosspoints_find),
    NAMED(interface_create), NAMED(interface_destroy), NAMED(interface_set_friction), NAMED(interface_set_augmentation),
    NAMED(interface_set_normals), NAMED(interface_set_constraints), NAMED(interface_set_previous),
    NAMED(interface_set_committed),
    NAMED(interface_initial_multipliers), NAMED(interface_sums), NAMED(interface_states), NAMED(interface_residual),
    NAMED(interface_tangent_coo), NAMED(interface_tangent_csr), NAMED(interface_pattern_coo),
    NAMED(interface_step_limit), NAMED(interface_commit), NAMED(interface_commit_check), NAMED(interface_rollback), NAMED(interface_history_size),
    NAMED(interface_history_export), NAMED(interface_history_import), NAMED(interface_counters),
    NAMED(interface_effects), NAMED(interface_report), NAMED(interface_diagnose), NAMED(interface_equilibrium),
    NAMED(interface_set_offsets), NAMED(interface_adjust), NAMED(interface_shape_offsets),
    NAMED(interface_heat), NAMED(interface_heat_tangent_coo), NAMED(node_heat),
    NAMED(interface_previous_tangent_coo), NAMED(interface_adjoint), NAMED(interface_sensitivity), NAMED(interface_set_law), NAMED(interface_set_threshold), NAMED(interface_law_states), NAMED(interface_set_law_states), NAMED(interface_set_layer),
    NAMED(node_condense), NAMED(interface_carriers), NAMED(interface_condensed_multipliers), NAMED(interface_condensed_residual),
    NAMED(interface_condensed_coo), NAMED(interface_condensed_csr), NAMED(interface_condensed_pattern),
    NAMED(interface_use_normals), NAMED(interface_turn_multipliers), NAMED(facet_normal_derivatives), NAMED(node_turn),
    NAMED(rigid_positions), NAMED(rigid_resultant), NAMED(rigid_turn), NAMED(rigid_create), NAMED(rigid_coo),
    NAMED(rigid_values),
    NAMED(skin_create), NAMED(skin_destroy), NAMED(skin_copies), NAMED(skin_set_pair), NAMED(skin_set_constraints),
    NAMED(skin_initial_multipliers), NAMED(skin_residual), NAMED(skin_plan), NAMED(skin_plan_coo), NAMED(skin_plan_coo32),
    NAMED(skin_plan_values), NAMED(skin_states), NAMED(skin_equilibrium), NAMED(skin_step_limit), NAMED(skin_use_normals),
    NAMED(skin_turn_multipliers), NAMED(skin_commit), NAMED(skin_exchange), NAMED(skin_rollback), NAMED(skin_history_size),
    NAMED(skin_history_export), NAMED(skin_history_import), NAMED(skin_facets), NAMED(skin_report),
    NAMED(interface_plan), NAMED(interface_plan_coo), NAMED(interface_plan_coo32), NAMED(interface_plan_csr),
    NAMED(interface_plan_csr32), NAMED(interface_plan_values), NAMED(interface_condensed_plan),
    NAMED(interface_condensed_values),
};

#endif
