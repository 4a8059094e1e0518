/* Every entry point with arguments that it accepts, to be spoilt one at a time by the tests of bad input. Each output
 * holds a pattern that a refused call must leave alone. */
#ifndef CALLS_H
#define CALLS_H

#include "pair.h"
#include "scene.h"

/* Room for the state of a pair, twice as much as it takes. */
enum { STATE_SIZE = 512 };

/* Stateless calls on two quadrilaterals. */
typedef struct {
  double x1[12], x2[12];
  stickslip_pair pair;
  weights w;
  /* The non-mortar facet with this one pair. */
  int32_t n2[1];
  stickslip_facet facet;
  double mass[16];
  stickslip_node node;
  stickslip_node_response responses[4];
  double traction[12], row_scale[4], sum[3], state[STATE_SIZE];
  /* Outputs. */
  weights w_out;
  double gap[12], force[24], k[36 * 36], normals[12], areas[4], normal[3], row[3], block[9];
  double fade, dual_areas[4], coefficients[16], dual_ab[16], dual_ac[16], facet_k[36 * 36];
  double normal_derivatives[144], turn[27], state_out[STATE_SIZE];
} element;

static inline void element_init(element *e) {
  memset(e, 0, sizeof *e);
  memcpy(e->x1, quad1, sizeof quad1);
  memcpy(e->x2, quad2, sizeof quad2);
  e->pair = make_pair(4, e->x1, 4, e->x2);
  pair_weights(&e->pair, &e->w);
  CHECK_OK(stickslip_pair_begin(&e->pair, STATE_SIZE, e->state, NULL, NULL, NULL));
  e->n2[0] = 4;
  e->facet = (stickslip_facet){.struct_size = sizeof e->facet, .n1 = 4, .n_pairs = 1, .x1 = e->x1, .n2 = e->n2, .x2 = e->x2};
  memcpy(e->mass, e->w.ab, sizeof e->mass);
  e->node.struct_size = sizeof e->node;
  e->node.normal[2] = 1.0;
  e->node.lambda[2] = -1.0;
  e->node.augmentation = 3.0;
  e->node.mu = 0.5;
  e->node.coverage = e->node.coverage_previous = 1.0;
  e->sum[2] = -2.0;
  for (int i = 0; i < 4; ++i) {
    e->responses[i].struct_size = sizeof e->responses[i];
    CHECK_OK(stickslip_node_respond(&e->node, &e->responses[i]));
    e->row_scale[i] = 2.0;
    e->traction[3 * i + 2] = -1.0;
  }
  FILL(e->w_out);
  FILL(e->gap);
  FILL(e->force);
  FILL(e->k);
  FILL(e->normals);
  FILL(e->areas);
  FILL(e->normal);
  FILL(e->row);
  FILL(e->block);
  FILL(e->fade);
  FILL(e->dual_areas);
  FILL(e->coefficients);
  FILL(e->dual_ab);
  FILL(e->dual_ac);
  FILL(e->facet_k);
  FILL(e->normal_derivatives);
  FILL(e->turn);
  FILL(e->state_out);
}

static inline int32_t call_weights(element *e) {
  return stickslip_pair_weights(&e->pair, e->w_out.ab, e->w_out.ac, e->w_out.dab, e->w_out.dac);
}
static inline int32_t call_gap(element *e) { return stickslip_pair_gap(&e->pair, e->w.ab, e->w.ac, e->gap); }
static inline int32_t call_residual(element *e) {
  return stickslip_pair_residual(&e->pair, e->w.ab, e->w.ac, e->traction, e->force);
}
static inline int32_t call_tangent(element *e) {
  return stickslip_pair_tangent(&e->pair, e->w.ab, e->w.ac, e->w.dab, e->w.dac, e->w.ab, e->w.ac, e->traction,
                                e->responses, e->row_scale, e->k, 36);
}
static inline int32_t call_begin(element *e) {
  return stickslip_pair_begin(&e->pair, STATE_SIZE, e->state_out, e->w_out.ab, e->w_out.ac, e->gap);
}
static inline int32_t call_state_gap(element *e) { return stickslip_pair_state_gap(e->state, e->w.ab, e->w.ac, e->gap); }
static inline int32_t call_state_residual(element *e) {
  return stickslip_pair_state_residual(e->state, e->traction, e->force);
}
static inline int32_t call_state_tangent(element *e) {
  return stickslip_pair_state_tangent(e->state, e->w.ab, e->w.ac, e->traction, e->responses, e->row_scale, e->k, 36);
}
static inline int32_t call_respond(element *e) {
  /* Into the last response, of which all but the size is filled with the pattern. */
  FILL(e->responses[3]);
  e->responses[3].struct_size = sizeof e->responses[3];
  return stickslip_node_respond(&e->node, &e->responses[3]);
}
static inline int32_t call_block(element *e) {
  return stickslip_node_block(&e->responses[0], 1.0, STICKSLIP_LAYOUT_ROW_MAJOR, e->row, e->block);
}
static inline int32_t call_facet(element *e) { return stickslip_facet_geometry(4, e->x1, e->normals, e->areas); }
static inline int32_t call_facet_dual(element *e) {
  return stickslip_facet_dual(4, e->x1, e->mass, &e->fade, e->dual_areas, e->coefficients);
}
static inline int32_t call_pair_dual(element *e) {
  return stickslip_pair_dual(&e->pair, e->mass, e->w.ab, e->w.ac, e->dual_ab, e->dual_ac);
}
static inline int32_t call_facet_tangent(element *e) {
  return stickslip_facet_tangent(&e->facet, e->w.ab, e->w.ac, e->w.ab, e->w.ac, e->traction, e->responses, e->row_scale,
                                 e->facet_k, 36);
}
static inline int32_t call_normal_derivatives(element *e) {
  return stickslip_facet_normal_derivatives(4, e->x1, e->normal_derivatives);
}
static inline int32_t call_turn(element *e) {
  return stickslip_node_turn(&e->node, e->sum, STICKSLIP_LAYOUT_ROW_MAJOR, e->turn, e->turn + 9, e->turn + 18);
}
static inline int32_t call_normal(element *e) { return stickslip_node_normal(e->sum, e->normal); }

static inline void element_untouched(element *e) {
  CHECK_UNTOUCHED(e->w_out);
  CHECK_UNTOUCHED(e->gap);
  CHECK_UNTOUCHED(e->force);
  CHECK_UNTOUCHED(e->k);
  CHECK_UNTOUCHED(e->normals);
  CHECK_UNTOUCHED(e->areas);
  CHECK_UNTOUCHED(e->normal);
  CHECK_UNTOUCHED(e->row);
  CHECK_UNTOUCHED(e->block);
  CHECK_UNTOUCHED(e->fade);
  CHECK_UNTOUCHED(e->dual_areas);
  CHECK_UNTOUCHED(e->coefficients);
  CHECK_UNTOUCHED(e->dual_ab);
  CHECK_UNTOUCHED(e->dual_ac);
  CHECK_UNTOUCHED(e->facet_k);
  CHECK_UNTOUCHED(e->normal_derivatives);
  CHECK_UNTOUCHED(e->turn);
  CHECK_UNTOUCHED(e->state_out);
}

static inline void response_untouched(element *e) {
  check_untouched(&e->responses[3].state, sizeof e->responses[3] - 8, __FILE__, __LINE__, "response");
}

/* Calls on an interface handle. */
typedef struct {
  scene s;
  history before;
  /* Outputs. */
  double force1[X1], force2[X2], rows[X1], sums[STICKSLIP_SUMS_PER_NODE * N1], values[MOST_ENTRIES];
  int64_t row_numbers[MOST_ENTRIES], columns[MOST_ENTRIES], count;
  int32_t state[N1];
  double normal[X1], fraction;
  stickslip_states states;
  double host1[X1]; /* input: what a host's own forces leave at the non-mortar nodes */
  /* A CSR matrix with every entry. */
  int64_t offsets[UNKNOWNS + 1], csr_columns[UNKNOWNS * UNKNOWNS];
  double csr[UNKNOWNS * UNKNOWNS];
} handle;

static inline void handle_fill(handle *h) {
  FILL(h->force1);
  FILL(h->force2);
  FILL(h->rows);
  FILL(h->sums);
  FILL(h->values);
  FILL(h->row_numbers);
  FILL(h->columns);
  FILL(h->count);
  FILL(h->state);
  FILL(h->normal);
  FILL(h->fraction);
  FILL(h->csr);
}

/* A CSR matrix with every entry, in the scene's index base. */
static inline void handle_matrix(handle *h) {
  const int64_t base = h->s.options.index_base;
  for (int i = 0; i <= UNKNOWNS; ++i) h->offsets[i] = base + (int64_t)i * UNKNOWNS;
  for (int i = 0; i < UNKNOWNS * UNKNOWNS; ++i) h->csr_columns[i] = base + i % UNKNOWNS;
}

static inline void handle_host(handle *h) {
  for (int k = 0; k < X1; ++k) h->host1[k] = 0.01 * (k % 7) - 0.02;
}

/* A scene with one committed step. */
static inline void handle_init(handle *h) {
  memset(h, 0, sizeof *h);
  scene_init(&h->s);
  scene_create(&h->s);
  scene_commit(&h->s);
  history_take(h->s.interface, &h->before);
  h->states.struct_size = sizeof h->states;
  h->states.state = h->state;
  h->states.normal = h->normal;
  handle_matrix(h);
  handle_fill(h);
}

static inline int32_t call_interface_residual(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_residual(s->interface, s->x1, s->x2, s->lambda, NULL, h->force1, h->force2, h->rows);
}
static inline int32_t call_interface_states(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_states(s->interface, s->x1, s->x2, s->lambda, NULL, &h->states);
}
static inline int32_t call_interface_sums(handle *h) {
  return stickslip_interface_sums(h->s.interface, h->s.x1, h->s.x2, h->sums);
}
static inline int32_t call_interface_coo(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_tangent_coo(s->interface, s->x1, s->x2, s->lambda, NULL, MOST_ENTRIES, h->row_numbers,
                                         h->columns, h->values, &h->count);
}
static inline int32_t call_interface_csr(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_tangent_csr(s->interface, s->x1, s->x2, s->lambda, NULL, UNKNOWNS, h->offsets,
                                         h->csr_columns, h->csr);
}
static inline int32_t call_interface_pattern(handle *h) {
  return stickslip_interface_pattern_coo(h->s.interface, h->s.x1, h->s.x2, MOST_ENTRIES, h->row_numbers, h->columns,
                                         &h->count);
}
static inline int32_t call_interface_commit(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_commit(s->interface, s->x1, s->x2, s->lambda, NULL);
}
static inline int32_t call_interface_commit_check(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_commit_check(s->interface, s->x1, s->x2, s->lambda, NULL);
}
static inline int32_t call_interface_limit(handle *h) {
  static double dx1[X1], dx2[X2];
  dx1[0] = 1.0;
  return stickslip_interface_step_limit(h->s.interface, h->s.x1, h->s.x2, dx1, dx2, 0.0, &h->fraction);
}
static inline int32_t call_interface_committed(handle *h) {
  static double slip[X1];
  slip[0] = 0.125;
  return stickslip_interface_set_committed(h->s.interface, h->s.x1, h->s.x2, slip, 3);
}
static inline int32_t call_interface_previous(handle *h) {
  return stickslip_interface_set_previous(h->s.interface, h->s.x1, h->s.x2);
}

static inline int32_t call_carriers(handle *h) {
  return stickslip_interface_carriers(h->s.interface, MOST_ENTRIES, h->row_numbers, h->columns, h->values, &h->count);
}

/* The multipliers turn in the output, which holds its pattern again where the call is refused. */
static inline int32_t call_turn_multipliers(handle *h) {
  memcpy(h->rows, h->s.lambda, sizeof h->rows);
  const int32_t status = stickslip_interface_turn_multipliers(h->s.interface, h->s.x1, h->rows);
  if (status == STICKSLIP_OK) return status;
  CHECK(memcmp(h->rows, h->s.lambda, sizeof h->rows) == 0);
  FILL(h->rows);
  return status;
}

/* Calls for systems without multipliers, which interfaces with dual ones accept in the multiplier form. */
static inline int32_t call_condensed_multipliers(handle *h) {
  return stickslip_interface_condensed_multipliers(h->s.interface, h->s.x1, h->s.x2, h->host1, h->rows);
}
static inline int32_t call_condensed_residual(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_condensed_residual(s->interface, s->x1, s->x2, s->lambda, h->host1, h->force1, h->force2);
}
static inline int32_t call_condensed_coo(handle *h, int32_t piece) {
  scene *s = &h->s;
  return stickslip_interface_condensed_coo(s->interface, s->x1, s->x2, s->lambda, piece, MOST_ENTRIES, h->row_numbers,
                                           h->columns, h->values, &h->count);
}
static inline int32_t call_condensed_csr(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_condensed_csr(s->interface, s->x1, s->x2, s->lambda, UNKNOWNS, h->offsets, h->csr_columns,
                                           h->csr);
}
static inline int32_t call_condensed_pattern(handle *h) {
  return stickslip_interface_condensed_pattern(h->s.interface, h->s.x1, h->s.x2, UNKNOWNS, h->offsets, h->csr_columns,
                                               MOST_ENTRIES, h->row_numbers, h->columns, &h->count);
}

/* The calls that take positions; the first `LAMBDA_CALLS` take multipliers too. */
typedef int32_t (*interface_call)(handle *h);
enum { LAMBDA_CALLS = 5 };
static const interface_call evaluations[] = {call_interface_residual, call_interface_states,  call_interface_coo,
                                             call_interface_csr,      call_interface_commit,  call_interface_sums,
                                             call_interface_pattern,  call_interface_limit,   call_interface_previous};

/* Neither outputs nor history have changed, and the handle goes on working. */
static inline void handle_untouched(handle *h) {
  static history now;
  CHECK_UNTOUCHED(h->force1);
  CHECK_UNTOUCHED(h->force2);
  CHECK_UNTOUCHED(h->rows);
  CHECK_UNTOUCHED(h->sums);
  CHECK_UNTOUCHED(h->values);
  CHECK_UNTOUCHED(h->row_numbers);
  CHECK_UNTOUCHED(h->columns);
  CHECK_UNTOUCHED(h->count);
  CHECK_UNTOUCHED(h->state);
  CHECK_UNTOUCHED(h->normal);
  CHECK_UNTOUCHED(h->fraction);
  CHECK_UNTOUCHED(h->csr);
  history_take(h->s.interface, &now);
  CHECK(history_equal(&h->before, &now));
}

/* Creation alone; an interface that is refused must leave the pointer as it was. */
static inline int32_t call_create(scene *s) {
  stickslip_interface *out;
  FILL(out);
  const int32_t status = stickslip_interface_create(&s->nonmortar, &s->mortar, &s->options, &out);
  CHECK_UNTOUCHED(out);
  return status;
}

#endif
