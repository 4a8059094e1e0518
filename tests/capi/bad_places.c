/* The places that the rows of bad_input.txt can spoil, by their names. */
#include "bad_rows.h"
#include "check.h"

#include <stddef.h>

static bad_at places[1000];
static int n_places;

void bad_place(const char *name, bad_type type, void *at, int32_t n) {
  CHECK(n_places < COUNT(places) && strlen(name) < sizeof places->name);
  bad_at *p = places + n_places++;
  strcpy(p->name, name);
  p->type = type;
  p->at = at;
  p->n = n;
}

/* Of the structs: numbers, pointers that must be there or may be, real numbers and arrays of them. */
#define MEMBER(kind, of, member, type, n) {#kind, #member, offsetof(stickslip_##of, member), type, n}
#define I32(of, member) MEMBER(of, of, member, INT32, 0)
#define I64(of, member) MEMBER(of, of, member, INT64, 0)
#define NEED(of, member) MEMBER(of, of, member, NEEDED, 0)
#define MAY(of, member) MEMBER(of, of, member, OPTIONAL, 0)
#define ONE(of, member) MEMBER(of, of, member, REAL, 0)
#define ARRAY(of, member, n) MEMBER(of, of, member, REAL, n)
#define RESPONSE(kind, member, type, n) MEMBER(kind, node_response, member, type, n)
static const struct {
  const char *kind, *name;
  size_t offset;
  bad_type type;
  int n;
} members[] = {
    I64(pair, struct_size), I32(pair, n1), I32(pair, n2), NEED(pair, x1), NEED(pair, x2), I32(pair, quadrature),
    I32(pair, layout), I64(pair, element_points), MAY(pair, neighbour_normals),
    I32(pair, multiplier_space), I32(pair, model), ONE(pair, thickness),
    I64(facet, struct_size), I32(facet, n1), I32(facet, quadrature), I32(facet, layout), I32(facet, reserved),
    I64(facet, n_pairs), NEED(facet, x1), NEED(facet, n2), NEED(facet, x2), I64(facet, element_points),
    MAY(facet, neighbour_normals),
    I64(node, struct_size), I32(node, slip), I32(node, n_directions), I32(node, friction), I32(node, reserved),
    ONE(node, shear_limit), ONE(node, augmentation), ONE(node, mu), ONE(node, coverage), ONE(node, coverage_previous),
    ONE(node, coverage_min), ARRAY(node, lambda, 3), ARRAY(node, normal, 3), ARRAY(node, gap_now, 3),
    ARRAY(node, gap_previous, 3), ARRAY(node, gap_committed, 3), ARRAY(node, directions, 6),
    I64(options, struct_size), MAY(options, method), I32(options, friction), I32(options, mortar_side), I32(options, shape),
    I32(options, model), I32(options, small_displacements), I32(options, index_base), ONE(options, mu), ONE(options, shear_limit),
    ONE(options, thickness), ONE(options, radius), ONE(options, modulus), ONE(options, search_distance),
    I64(method, struct_size), I32(method, form), I32(method, slip), I32(method, weights), I32(method, multiplier_basis),
    I32(method, normals), I32(method, multiplier_space), I32(method, decision), I32(method, quadrature), I32(method, row_scale),
    I32(method, new_contact), I32(method, integration), I32(method, tangent), I32(method, no_shortcuts), I32(method, threads),
    I64(method, element_points), ONE(method, augmentation), ONE(method, coverage_min), ONE(method, weak_coverage),
    ONE(method, turn_max),
    I64(surface, struct_size), I64(surface, n_nodes), I64(surface, n_facets), NEED(surface, coordinates),
    NEED(surface, facet_offsets), NEED(surface, facet_nodes), NEED(surface, equations),
    MAY(surface, multiplier_equations), MAY(surface, owned),
    I64(states, struct_size), MAY(states, state), MAY(states, normal), MAY(states, traction), MAY(states, gap),
    MAY(states, slip), MAY(states, coverage), MAY(states, area), MAY(states, dissipation), MAY(states, augmentation), MAY(states, share),
    MAY(states, worn), MAY(states, worn_volume), MAY(states, damage), MAY(states, bond_loss),
    I64(counters, struct_size),
    I64(report, struct_size), MAY(report, cover), MAY(report, fraction), MAY(report, layers), MAY(report, facets),
    I64(report, text_capacity),
    I64(diagnosis, struct_size), MAY(diagnosis, state), MAY(diagnosis, suspect_nodes),
    MAY(diagnosis, suspect_directions), MAY(diagnosis, suspect_ratios), MAY(diagnosis, suspect_causes),
    I64(diagnosis, suspect_capacity), I64(diagnosis, text_capacity), I64(equilibrium, struct_size),
    ONE(equilibrium, modulus), ONE(equilibrium, least_traction),
    I64(rigid_body, struct_size), I32(rigid_body, dimension), I32(rigid_body, reserved), I64(rigid_body, n_nodes),
    NEED(rigid_body, coordinates), NEED(rigid_body, point), NEED(rigid_body, node_equations), NEED(rigid_body, equations),
    I64(rigid_motion, struct_size), ARRAY(rigid_motion, displacement, 3), ARRAY(rigid_motion, rotation, 3),
    ARRAY(rigid_motion, turned, 9), I32(rigid_motion, arms), I32(rigid_motion, reserved),
    I64(law, struct_size), I32(law, kind), I32(law, reserved), ONE(law, cohesion), ONE(law, mu_after), ONE(law, critical_slip),
    ONE(law, mu_across), ARRAY(law, direction, 3), ONE(law, critical_rate), ONE(law, time),
    I64(layer, struct_size), I64(layer, n_overclosure), NEED(layer, overclosure), NEED(layer, pressure), ONE(layer, wear),
    ONE(layer, bond_stiffness), ONE(layer, bond_strength), ONE(layer, bond_toughness), ONE(layer, bond_shear),
    I64(heat, struct_size), ONE(heat, contact), ONE(heat, pressure), ONE(heat, exponent), ONE(heat, constant), ONE(heat, gas),
    ONE(heat, gas_gap), ONE(heat, reach), ONE(heat, share), ONE(heat, time),
    I64(heat_nodes, struct_size), MAY(heat_nodes, conductance), MAY(heat_nodes, flux), MAY(heat_nodes, jump),
    MAY(heat_nodes, friction), MAY(heat_nodes, area),
    I64(gradient, struct_size), MAY(gradient, previous1), MAY(gradient, previous2), MAY(gradient, now1), MAY(gradient, now2),
    MAY(gradient, friction), MAY(gradient, shear_limit), MAY(gradient, offsets1), MAY(gradient, offsets2),
    I64(direction, struct_size), MAY(direction, previous1), MAY(direction, previous2), MAY(direction, now1),
    MAY(direction, now2), MAY(direction, friction), MAY(direction, shear_limit), MAY(direction, offsets1),
    MAY(direction, offsets2),
    I64(skin_sides, struct_size), MAY(skin_sides, side), MAY(skin_sides, piece), MAY(skin_sides, partner),
    MAY(skin_sides, distance), MAY(skin_sides, body), I64(skin_summary, struct_size),
    /* Of a response: what node_respond, node_block and pair_tangent read. */
    RESPONSE(answer, struct_size, INT64, 0), RESPONSE(response, struct_size, INT64, 0),
    RESPONSE(response, row, REAL, 3), RESPONSE(response, drow_dlambda, REAL, 9),
    RESPONSE(responses, struct_size, INT64, 0),
    RESPONSE(responses, drow_dnow, REAL, 9), RESPONSE(responses, drow_dprevious, REAL, 9),
};

void bad_struct(const char *kind, const char *name, void *at) {
  int known = 0;
  for (int k = 0; k < COUNT(members); ++k) {
    if (strcmp(members[k].kind, kind) != 0) continue;
    char full[64];
    snprintf(full, sizeof full, "%s.%s", name, members[k].name);
    bad_place(full, members[k].type, (char *)at + members[k].offset, members[k].n);
    known = 1;
  }
  CHECK(known);
}

bad_at *bad_find(const char *name, int is_array) {
  for (int k = 0; k < n_places; ++k) {
    if (strcmp(places[k].name, name) == 0 && (places[k].n > 0) == is_array) return places + k;
  }
  return NULL;
}

const char *bad_unspoilt(void) {
  static const unsigned needed[] = {SPOILT_NULL | SPOILT, SPOILT, SPOILT_NULL, SPOILT_NAN, SPOILT, SPOILT};
  for (int k = 0; k < n_places; ++k) {
    if ((~places[k].spoilt & needed[places[k].type]) != 0) return places[k].name;
  }
  return NULL;
}
