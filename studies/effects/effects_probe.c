/* One interface, evaluated with the effects that the command line names, for counting what they cost:
 *
 *   effects_probe LAW SIDE WEIGHTS [offsets | standard | committed | paper]
 *     LAW: none | coulomb | weakening | orthotropic | callback (Coulomb's, as a function of the host's)   SIDE: analytic | rigid | deformable
 *     WEIGHTS: reference | current
 *     offsets: each surface is a layer that is thicker than its mesh, as a shell's
 *     standard: multipliers, not dual ones; committed: normals of the last commit, not of now; paper: both
 *
 * A non-mortar patch of N1 x N1 quadrilaterals (the unit square, bent a little) lies 0.001 deep in a plane: as a mortar patch
 * of N2 x N2 quadrilaterals, or as the analytic plane. It slides a little further before each of the evaluations, which are
 * a residual and a tangent each, so with current weights each of them searches, integrates and linearises once.
 * Prints one JSON line with the interface's counters. No units. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>

enum { N1 = 16, N2 = 19, NODES1 = (N1 + 1) * (N1 + 1), NODES2 = (N2 + 1) * (N2 + 1), EVALUATIONS = 4 };

static const double DEPTH = 0.001, MODULUS = 1000, PRESSURE = 1;

static void stop_on(int32_t status)
{
  if (status == STICKSLIP_OK) return;
  fprintf(stderr, "effects_probe: %s\n", stickslip_last_error_message());
  exit(1);
}

/* n x n quadrilaterals over [low, high]^2 at height 0, looking up (+1) or down (-1) */
static void patch(int n, double low, double high, int look, double *x, int64_t *offsets, int64_t *nodes)
{
  for (int k = 0; k < (n + 1) * (n + 1); k++) {
    x[3 * k]     = low + (high - low) * (k % (n + 1)) / n;
    x[3 * k + 1] = low + (high - low) * (k / (n + 1)) / n;
    x[3 * k + 2] = 0;
  }
  for (int f = 0; f < n * n; f++) {
    const int64_t a       = (f / n) * (n + 1) + f % n;
    const int64_t quad[4] = {a, look > 0 ? a + 1 : a + n + 1, a + n + 2, look > 0 ? a + n + 1 : a + 1};
    memcpy(nodes + 4 * f, quad, sizeof quad);
    offsets[f] = 4 * (int64_t)f;
  }
  offsets[n * n] = 4 * (int64_t)n * n;
}

static int64_t number(int64_t *equations, int64_t n, int64_t first)
{
  for (int64_t k = 0; k < n; k++)
    equations[k] = first < 0 ? -1 : first + k;
  return first < 0 ? 0 : n;
}

/* Coulomb's law, as the host's */
static int32_t coulomb(void *user, const stickslip_law_point *point, const double *states, stickslip_law_answer *answer, double *states_after)
{
  (void)user, (void)states, (void)states_after;
  answer->threshold          = -point->mu * point->normal;
  answer->dthreshold_dnormal = -point->mu;
  return 0;
}

static void choose_law(stickslip_interface *contact, const char *law)
{
  if (!strcmp(law, "callback")) stop_on(stickslip_interface_set_threshold(contact, coulomb, NULL, 0));
  if (!strcmp(law, "weakening"))
    stop_on(stickslip_interface_set_law(contact, &(stickslip_law){.struct_size = sizeof(stickslip_law), .kind = STICKSLIP_LAW_WEAKENING,
                                                     .mu_after = 0.2, .critical_slip = 1}));
  if (!strcmp(law, "orthotropic"))
    stop_on(stickslip_interface_set_law(contact, &(stickslip_law){.struct_size = sizeof(stickslip_law), .kind = STICKSLIP_LAW_ORTHOTROPIC,
                                                     .mu_across = 0.2, .direction = {1, 1, 0}}));
}

static int choose(const char *word, const char *const words[])
{
  for (int k = 0; words[k]; k++) {
    if (!strcmp(words[k], word)) return k;
  }
  fprintf(stderr, "effects_probe: '%s' is none of the words that its head lists\n", word);
  exit(1);
}

int main(int argc, char **argv)
{
  static const char *const laws[] = {"coulomb", "none", "weakening", "orthotropic", "callback", NULL}, *const sides[] = {"deformable", "rigid", "analytic", NULL},
                           *const weights[] = {"auto", "current", "committed", "reference", NULL};
  static double  x1[3 * NODES1], x2[3 * NODES2], lambda[3 * NODES1], force1[3 * NODES1], force2[3 * NODES2], rows[3 * NODES1];
  static int64_t offsets1[N1 * N1 + 1], nodes1[4 * N1 * N1], offsets2[N2 * N2 + 1], nodes2[4 * N2 * N2];
  static int64_t equations1[3 * NODES1], equations2[3 * NODES2], multipliers[3 * NODES1];
  stickslip_surface    upper = {.struct_size = sizeof upper}, lower = {.struct_size = sizeof lower};
  stickslip_options    options;
  stickslip_method     method = {.struct_size = sizeof method};
  stickslip_interface *contact  = NULL;
  stickslip_counters   counters = {.struct_size = sizeof counters};
  int64_t              capacity = 0, count, n_equations;

  if (argc != 4 && argc != 5) return fprintf(stderr, "usage: effects_probe LAW SIDE WEIGHTS [offsets | standard | committed | paper]\n"), 1;
  static const char *const mores[] = {"none", "offsets", "standard", "committed", "paper", NULL};
  const int more = argc == 5 ? choose(argv[4], mores) : 0, with_offsets = more == 1;
  stop_on(stickslip_options_init(&options, sizeof options));
  options.friction    = choose(argv[1], laws);
  if (options.friction > STICKSLIP_FRICTION_NONE) options.friction = STICKSLIP_FRICTION_COULOMB; /* its place is another law's */
  options.mortar_side = choose(argv[2], sides);
  method.weights      = choose(argv[3], weights);
  if (more == 2 || more == 4) method.multiplier_basis = STICKSLIP_BASIS_STANDARD;
  if (more == 3 || more == 4) method.normals = STICKSLIP_NORMALS_COMMITTED;
  options.method      = &method;
  options.modulus     = MODULUS;
  options.mu          = options.friction == STICKSLIP_FRICTION_COULOMB ? 0.3 : 0;
  const int components = options.friction == STICKSLIP_FRICTION_NONE ? 1 : 3;

  patch(N1, 0, 1, -1, x1, offsets1, nodes1);
  for (int a = 0; a < NODES1; a++) { /* bent across the sliding, so that the normals differ */
    x1[3 * a + 2] = -DEPTH * (1 + 0.5 * sin(3 * x1[3 * a + 1]));
    lambda[components * a + components - 1] = -PRESSURE; /* along the normal, which points up */
  }
  n_equations = number(equations1, 3 * NODES1, 0);
  n_equations += number(multipliers, (int64_t)components * NODES1, n_equations);
  upper = (stickslip_surface){.struct_size = sizeof upper, .n_nodes = NODES1, .n_facets = N1 * N1, .coordinates = x1,
      .facet_offsets = offsets1, .facet_nodes = nodes1, .equations = equations1, .multiplier_equations = multipliers};
  patch(N2, -0.3, 1.3, 1, x2, offsets2, nodes2);
  if (options.mortar_side == STICKSLIP_MORTAR_ANALYTIC) options.shape = STICKSLIP_SHAPE_PLANE;
  number(equations2, 3 * NODES2, options.mortar_side == STICKSLIP_MORTAR_DEFORMABLE ? n_equations : -1);
  lower = (stickslip_surface){.struct_size = sizeof lower, .n_nodes = NODES2, .n_facets = N2 * N2, .coordinates = x2,
      .facet_offsets = offsets2, .facet_nodes = nodes2, .equations = equations2};
  if (options.mortar_side == STICKSLIP_MORTAR_ANALYTIC) { /* the plane's frame: a point, its normal, two more directions */
    static const double frame[] = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0};
    memcpy(x2, frame, sizeof frame);
    lower = (stickslip_surface){.struct_size = sizeof lower, .n_nodes = 4, .coordinates = x2};
  }

  stop_on(stickslip_interface_create(&upper, &lower, &options, &contact));
  choose_law(contact, argv[1]);
  if (with_offsets) {
    static double thickness1[NODES1], thickness2[NODES2];
    for (int a = 0; a < NODES1; a++) {
      thickness1[a] = -DEPTH;
      x1[3 * a + 2] += 2 * DEPTH; /* the layers touch where without them the meshes would */
    }
    for (int c = 0; c < NODES2; c++)
      thickness2[c] = -DEPTH; /* in front of the mesh */
    stop_on(stickslip_interface_set_offsets(contact, thickness1, thickness2));
  }
  stop_on(stickslip_interface_pattern_coo(contact, x1, x2, 0, NULL, NULL, &capacity)); /* no tangent has more entries */
  int64_t *entry_rows = malloc(2 * (size_t)capacity * sizeof(int64_t));
  double  *values     = malloc((size_t)capacity * sizeof(double));
  if (!entry_rows || !values) return 1;
  for (int k = 0; k < EVALUATIONS; k++) {
    for (int a = 0; a < NODES1; a++)
      x1[3 * a] += 0.003;
    stop_on(stickslip_interface_residual(contact, x1, x2, lambda, NULL, force1, force2, rows));
    stop_on(stickslip_interface_tangent_coo(contact, x1, x2, lambda, NULL, capacity, entry_rows, entry_rows + capacity,
                                            values, &count));
  }
  stop_on(stickslip_interface_counters(contact, &counters));
  printf("{\"evaluations\": %d, \"multipliers\": %lld, \"bytes\": %lld, \"pairs_active\": %lld, \"pairs_integrated\": %lld, "
         "\"pairs_linearised\": %lld, \"entries\": %lld}\n",
         EVALUATIONS, (long long)counters.multipliers, (long long)counters.bytes, (long long)counters.pairs_active,
         (long long)counters.pairs_integrated, (long long)counters.pairs_linearised, (long long)count);
  free(entry_rows);
  free(values);
  return stickslip_interface_destroy(&contact);
}
