/* The stateless calls of stickslip on one pair of facets, in the order in which a host uses them:
 *
 *   pair      mortar weights, their derivatives, gap       stickslip_pair_weights, stickslip_pair_gap
 *   node      gap, stick or slip; projected traction       stickslip_node_respond
 *   pair      forces and tangent                           stickslip_pair_residual, stickslip_pair_tangent
 *   node      the multiplier's own row and block           stickslip_node_block
 *
 * A quadrilateral (non-mortar, its body above) was pressed on a larger one and has slid along x since t_n, some nodes
 * more than others. Then the tangent is checked column by column against central differences of the residual.
 *
 * From the top of the checkout:
 *   cargo build --release
 *   cc -std=c99 -Iinclude c_examples/pair_demo.c target/release/libstickslip.a -lpthread -ldl -lm -o pair_demo */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <stickslip.h>

enum { N1 = 4, N2 = 4, NX1 = 3 * N1, NX = 3 * (N1 + N2), N = NX + NX1 }; /* unknowns: x1, x2, lambda */

/* Node orders are right-hand, seen from outside each body. */
static const double x1_previous[NX1] = {0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0};
static const double x2_previous[3 * N2] = {-0.5, -0.4, 0, 1.6, -0.4, 0, 1.6, 1.4, 0, -0.5, 1.4, 0};
static const double friction = 0.4, augmentation = 30.0;

/* Every call returns a status, and on refusal a sentence that names the argument at fault. */
static void must(int32_t status) {
  if (status == STICKSLIP_OK) return;
  fprintf(stderr, "stickslip: %s: %s\n", stickslip_status_string(status), stickslip_last_error_message());
  exit(1);
}

typedef struct {
  double ab[N1 * N1], ac[N1 * N2], dab[N1 * N1 * NX], dac[N1 * N2 * NX];
} weights;

static stickslip_pair pair_at(const double *x1, const double *x2) {
  stickslip_pair pair = {sizeof pair, N1, N2, x1, x2, STICKSLIP_QUADRATURE_DEGREE_10, STICKSLIP_LAYOUT_ROW_MAJOR, 0,
                          NULL, STICKSLIP_SPACE_CORNER, STICKSLIP_MODEL_SOLID, 0.0};
  return pair;
}

static double row_sum(const double *n_ab, int a) {
  return n_ab[N1 * a] + n_ab[N1 * a + 1] + n_ab[N1 * a + 2] + n_ab[N1 * a + 3];
}

/* Residual r and, unless NULL, tangent k at the unknowns u; responses holds each node's state. */
static void evaluate(const double u[N], stickslip_node_response responses[N1], double r[N], double *k) {
  const double *lambda = u + NX;
  weights now, previous;
  double gap_now[NX1], gap_previous[NX1], corner_normals[NX1], areas[N1], scale[N1];

  /* The pair, now and at t_n. A host with many pairs adds coverage and gaps over all pairs of a node before it goes on;
   * it also keeps the weights of t_n instead of integrating them again. */
  const stickslip_pair pair = pair_at(u, u + NX1), pair_previous = pair_at(x1_previous, x2_previous);
  must(stickslip_pair_weights(&pair, now.ab, now.ac, now.dab, now.dac));
  must(stickslip_pair_weights(&pair_previous, previous.ab, previous.ac, NULL, NULL));
  must(stickslip_pair_gap(&pair, now.ab, now.ac, gap_now));
  must(stickslip_pair_gap(&pair, previous.ab, previous.ac, gap_previous));

  /* The nodes. Normals and areas are those of t_n, each summed over the facets around a node. */
  must(stickslip_facet_geometry(N1, x1_previous, corner_normals, areas));
  for (int a = 0; a < N1; ++a) {
    stickslip_node node;
    memset(&node, 0, sizeof node);
    node.struct_size = sizeof node;
    node.slip = STICKSLIP_SLIP_OBJECTIVE;
    node.mu = friction;
    node.augmentation = augmentation / areas[a];
    node.coverage = row_sum(now.ab, a);
    node.coverage_previous = row_sum(previous.ab, a);
    node.coverage_min = 1e-8 * areas[a];
    must(stickslip_node_normal(corner_normals + 3 * a, node.normal));
    memcpy(node.lambda, lambda + 3 * a, sizeof node.lambda);
    memcpy(node.gap_now, gap_now + 3 * a, sizeof node.gap_now);
    memcpy(node.gap_previous, gap_previous + 3 * a, sizeof node.gap_previous);
    responses[a].struct_size = sizeof responses[a];
    must(stickslip_node_respond(&node, &responses[a]));
    scale[a] = node.augmentation * areas[a]; /* makes a force of the multiplier row */
  }

  /* Forces use the multipliers themselves, rows the projected traction: the multiplier form. */
  must(stickslip_pair_residual(&pair, now.ab, now.ac, lambda, r));
  if (k) {
    must(stickslip_pair_tangent(&pair, now.ab, now.ac, now.dab, now.dac, previous.ab, previous.ac, lambda, responses,
                                scale, k, N));
  }
  for (int a = 0; a < N1; ++a) {
    double block[9];
    const int first = NX + 3 * a;
    must(stickslip_node_block(&responses[a], scale[a], STICKSLIP_LAYOUT_ROW_MAJOR, r + first, block));
    for (int i = 0; k && i < 9; ++i) k[(first + i / 3) * N + first + i % 3] += block[i];
  }
}

static void print_weights(const double u[N]) {
  double n_ab[N1 * N1], n_ac[N1 * N2];
  const stickslip_pair pair = pair_at(u, u + NX1);
  must(stickslip_pair_weights(&pair, n_ab, n_ac, NULL, NULL));
  printf("mortar weights n_AB | n_AC [L^2]\n");
  for (int a = 0; a < N1; ++a) {
    for (int b = 0; b < N1; ++b) printf(" %9.6f", n_ab[N1 * a + b]);
    printf("  |");
    for (int c = 0; c < N2; ++c) printf(" %9.6f", n_ac[N2 * a + c]);
    printf("\n");
  }
}

static void print_nodes(const stickslip_node_response responses[N1]) {
  static const char *const words[] = {"gap", "stick", "slip"};
  printf("\nnode  state  weighted gap      slip x    traction p\n");
  for (int a = 0; a < N1; ++a) {
    const stickslip_node_response *n = &responses[a];
    printf("%4d  %-5s  %12.4e  %10.2e  %9.5f %9.5f %9.5f\n", a, words[n->state], n->gap_normal, n->slip[0],
           n->traction[0], n->traction[1], n->traction[2]);
  }
}

static void print_residual(const double r[N]) {
  static const char *const names[] = {"force, non-mortar", "force, mortar", "multiplier row"};
  printf("\nresidual (internal forces)\n");
  for (int node = 0; node < N / 3; ++node) {
    printf("  %-17s %d  %12.8f %12.8f %12.8f\n", names[node / N1], node % N1, r[3 * node], r[3 * node + 1],
           r[3 * node + 2]);
  }
}

/* The tangent's worst error over all columns, relative to its largest entry. */
static double tangent_error(double u[N], const double k[N * N]) {
  const double step = 1e-6;
  stickslip_node_response responses[N1];
  double plus[N], minus[N], error = 0.0, scale = 0.0;
  for (int j = 0; j < N; ++j) {
    const double at = u[j];
    u[j] = at + step;
    evaluate(u, responses, plus, NULL);
    u[j] = at - step;
    evaluate(u, responses, minus, NULL);
    u[j] = at;
    for (int i = 0; i < N; ++i) {
      error = fmax(error, fabs(k[N * i + j] - (plus[i] - minus[i]) / (2.0 * step)));
      scale = fmax(scale, fabs(k[N * i + j]));
    }
  }
  return error / scale;
}

int main(void) {
  static double k[N * N];
  double u[N], r[N];
  stickslip_node_response responses[N1];

  memcpy(u, x1_previous, sizeof x1_previous);
  memcpy(u + NX1, x2_previous, sizeof x2_previous);
  for (int a = 0; a < N1; ++a) {
    u[3 * a] += 0.002 * a;                 /* slid along x */
    u[3 * a + 2] += a == 3 ? 0.12 : -0.01; /* the last node is lifted: the facet is warped */
    u[NX + 3 * a + 2] = -1.0;              /* pressed down: lambda . nu < 0, nu points up into the body */
    u[NX + 3 * a] = 0.1 * a;
  }

  printf("stickslip %s: one pair of facets\n\n", stickslip_version());
  evaluate(u, responses, r, k);
  print_weights(u);
  print_nodes(responses);
  print_residual(r);

  const double error = tangent_error(u, k);
  printf("\ntangent %d x %d against central differences: worst relative error %.1e\n", N, N, error);
  return error <= 1e-7 ? 0 : 1;
}
