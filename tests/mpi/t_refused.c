/* What one part refuses all ranks refuse, in the same words, and nothing has moved: at creation, in an evaluation, at a commit. */
#include "compare.h"

static const scene SCENE = {.name = "refusals", .kind = {QUAD4, QUAD4}, .method = {.multiplier_basis = STICKSLIP_BASIS_STANDARD, .normals = STICKSLIP_NORMALS_COMMITTED},
                            .options = {.mu = 0.3}};

/* The same refusal everywhere, with a word in it. */
static void refused(const char *what, int32_t status, int32_t expected, const char *word) {
  const char *said = stickslip_mpi_last_error_message();
  char        first[1024] = "";
  int         good;
  snprintf(first, sizeof(first), "%s", said);
  MPI_Bcast(first, sizeof(first), MPI_CHAR, 0, MPI_COMM_WORLD);
  good = status == expected && strstr(said, word) && !strcmp(first, said);
  MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_LAND, MPI_COMM_WORLD);
  if (rank == 0) printf("%-6s %-28s %s\n", good ? "ok" : "FAILED", what, said);
  failures += !good;
}

static void equal(run *r, const char *what) {
  differences *found = &r->found;
  int          good;
  *found = (differences){0};
  compare(r, 0);
  good = found->force <= ROUNDING && found->rows <= ROUNDING && found->tangent <= ROUNDING && found->bits == 0;
  MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_LAND, MPI_COMM_WORLD);
  if (rank == 0) printf("%-6s %s\n", good ? "ok" : "FAILED", what);
  failures += !good;
}

static int32_t update(run *r) {
  for (int s = 0; s < 2; s++) {
    free(r->own_x[s]);
    r->own_x[s] = own_values(&r->own[s], r->d, r->x[s]);
  }
  return stickslip_mpi_interface_update(r->all, r->own_x[0], r->own_x[1], r->own_lambda);
}

/* The end of the strip that the last part works on. */
static int last_node(const run *r) { return r->side[0].nx; }

static void evaluations(run *r) {
  double *f1 = room((size_t)(3 * r->side[0].n_nodes), 8), *f2 = room((size_t)(3 * r->side[1].n_nodes), 8), *rows = room((size_t)(3 * r->side[0].n_nodes), 8);
  double *x = r->x[0], values[1];
  const int64_t *facet = r->side[0].nodes + r->side[0].offsets[r->side[0].nx - 1];
  char           word[128];
  place(r, 0.5, 0.1);
  refused("no plan", stickslip_mpi_interface_plan_values(r->all, 1, values), STICKSLIP_MISSING_ENTRY, "plan");
  x[3 * last_node(r)] = NAN;
  refused("not a number", update(r), STICKSLIP_NOT_FINITE, "x1");
  place(r, 0.5, 0.1);
  for (int i = 0; i < 3; i++) x[3 * last_node(r) + i] += x[3 * (last_node(r) - 2) + i] - x[3 * (last_node(r) - 1) + i]; /* the last facet folds over */
  ALL(update(r));
  snprintf(word, sizeof(word), "nonmortar facet (%lld %lld %lld %lld)", (long long)host_number((int)facet[0]), (long long)host_number((int)facet[1]),
           (long long)host_number((int)facet[2]), (long long)host_number((int)facet[3]));
  refused("a facet that is folded", stickslip_mpi_interface_residual(r->all, f1, f2, rows),
          stickslip_interface_residual(r->one, r->x[0], r->x[1], r->lambda, NULL, f1, f2, rows), word);
  place(r, 0.5, 0.1);
  equal(r, "after a refusal all is as before");
  free(f1), free(f2), free(rows);
}

/* The end of the strip bends up: that part turns too far. */
static void bend(run *r) {
  for (int a = 0; a < r->side[0].n_nodes; a++) {
    const double beyond = r->side[0].X[3 * a] - 12;
    if (beyond > 0) r->x[0][3 * a + 2] += 0.6 * beyond;
  }
  ALL(update(r));
}

static void commits(run *r) {
  refused("nothing to undo", stickslip_mpi_interface_rollback(r->all), STICKSLIP_NOTHING_TO_ROLL_BACK, "roll back");
  place(r, 1, 0.1);
  ONE(stickslip_interface_commit(r->one, r->x[0], r->x[1], r->lambda, NULL));
  ALL(stickslip_mpi_interface_commit(r->all));
  place(r, 1.5, 0.1);
  bend(r);
  refused("a part that turns too far", stickslip_mpi_interface_commit(r->all), STICKSLIP_TURNED_TOO_FAR, "turn");
  place(r, 1.5, 0.1);
  equal(r, "after a refused commit all is as before");
  ONE(stickslip_interface_rollback(r->one));
  ALL(stickslip_mpi_interface_rollback(r->all));
  place(r, 0.7, 0.1);
  equal(r, "the commit before it can be undone");
}

/* Shares that are no good, one thing at a time. */
static void creations(run *r) {
  stickslip_mpi_share      a = r->own[0].share, b = r->own[1].share;
  stickslip_mpi_interface *none = NULL;
  stickslip_method         method = {.struct_size = sizeof(method), .decision = STICKSLIP_DECISION_POINTS};
  stickslip_mpi_method     parts  = {.struct_size = sizeof(parts), .shares = 5};
  stickslip_options        options;
  int64_t                 *nodes = room((size_t)a.n_nodes + 1, 8), *facets = room((size_t)(a.n_facets ? a.facet_offsets[a.n_facets] : 1), 8);
  const int                last = size - 1;
  ONE(stickslip_options_init(&options, sizeof(options)));
  options.modulus = 100;
#define CREATE(shares) stickslip_mpi_interface_create(MPI_COMM_WORLD, &a, &b, &options, shares, &none)
  refused("NULL on one rank", stickslip_mpi_interface_create(MPI_COMM_WORLD, rank == last ? NULL : &a, &b, &options, NULL, &none),
          STICKSLIP_NULL_POINTER, "nonmortar");
  b.struct_size = rank == last ? 8 : b.struct_size;
  refused("a struct's size", CREATE(NULL), STICKSLIP_STRUCT_SIZE, "mortar");
  b = r->own[1].share;
  refused("shares", CREATE(&parts), STICKSLIP_INVALID_VALUE, "shares");
  memcpy(nodes, a.nodes, (size_t)a.n_nodes * 8);
  if (rank == last) nodes[0] = nodes[1];
  a.nodes = nodes;
  refused("a node with two owners", CREATE(NULL), STICKSLIP_INVALID_VALUE, "owned by ranks");
  if (rank == last) nodes[0] = 1;
  refused("a node with none", CREATE(NULL), STICKSLIP_INVALID_VALUE, "owned by no rank");
  a = r->own[0].share;
  if (a.n_facets) memcpy(facets, a.facet_nodes, (size_t)a.facet_offsets[a.n_facets] * 8);
  if (rank == last) memcpy(facets, facets + 4, 4 * 8);
  a.facet_nodes = facets;
  refused("a facet given twice", CREATE(NULL), STICKSLIP_INVALID_VALUE, "twice");
  a = r->own[0].share;
  b.n_facets = 0;
  refused("no facet", CREATE(NULL), STICKSLIP_INVALID_VALUE, "mortar has no facet");
  b = r->own[1].share;
  options.modulus = 0;
  refused("what the library refuses", CREATE(NULL), STICKSLIP_MISSING_STIFFNESS, "modulus");
  options.modulus = 100, options.method = &method;
  if (size > 1) refused("points that decide", CREATE(NULL), STICKSLIP_UNSUPPORTED, "POINTS");
  free(nodes), free(facets);
}

int main(int argc, char **argv) {
  run r;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  begin(&r, &SCENE, 0);
  creations(&r);
  evaluations(&r);
  commits(&r);
  r.found = (differences){0};
  end(&r);
  MPI_Finalize();
  return failures > 0;
}
