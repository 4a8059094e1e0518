/* Systems without multipliers: multipliers, rows and pieces of the matrix of all parts are those of one handle. */
#include "compare.h"

static const scene SCENES[] = {
  {.name = "condensed", .kind = {QUAD4, QUAD4}, .options = {.mu = 0.3}, .renews = 1},
  {.name = "condensed, no friction", .kind = {TRI3, QUAD4}, .options = {.friction = STICKSLIP_FRICTION_NONE}, .renews = 1},
};
enum { N_SCENES = sizeof(SCENES) / sizeof(SCENES[0]) };
static const int32_t PIECES[] = {STICKSLIP_CONDENSED_FORCES, STICKSLIP_CONDENSED_ELIMINATION, STICKSLIP_CONDENSED_CONSTRAINTS,
                                 STICKSLIP_CONDENSED_SCALES};
enum { N_PIECES = sizeof(PIECES) / sizeof(PIECES[0]) };

static void compare_piece(run *r, const double *lambda, int32_t piece) {
  int64_t n = r->n, count, m, *i, *j;
  double *a, *y = room((size_t)(VECTORS * n), 8), *z = room((size_t)(VECTORS * n), 8), *sizes = room((size_t)n, 8), *other = room((size_t)n, 8);
  ONE(stickslip_interface_condensed_coo(r->one, r->x[0], r->x[1], lambda, piece, 0, NULL, NULL, NULL, &count));
  i = room((size_t)count, 8), j = room((size_t)count, 8), a = room((size_t)count, 8);
  ONE(stickslip_interface_condensed_coo(r->one, r->x[0], r->x[1], lambda, piece, count, i, j, a, &count));
  multiply(n, 0, count, i, j, a, y, sizes);
  free(i), free(j), free(a);
  ALL(stickslip_mpi_interface_condensed_coo(r->all, piece, 0, NULL, NULL, NULL, &m));
  i = room((size_t)m, 8), j = room((size_t)m, 8), a = room((size_t)m, 8);
  ALL(stickslip_mpi_interface_condensed_coo(r->all, piece, m, i, j, a, &m));
  multiply(n, 0, m, i, j, a, z, other);
  free(i), free(j), free(a);
  MPI_Allreduce(MPI_IN_PLACE, z, (int)(VECTORS * n), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  for (int64_t k = 0; k < VECTORS * n; k++)
    if (sizes[k % n] > 0 || z[k] != 0) worst(&r->found.tangent, sizes[k % n] > 0 ? fabs(z[k] - y[k]) / sizes[k % n] : 1);
  free(y), free(z), free(sizes), free(other);
}

static void compare_condensed(run *r) {
  const int n1 = r->side[0].n_nodes, n2 = r->side[1].n_nodes, c = r->c;
  double   *host = room((size_t)(3 * n1), 8), *lambda = room((size_t)(c * n1), 8), *rows = room((size_t)(3 * n1), 8), *force = room((size_t)(3 * n2), 8);
  double   *own_lambda = room((size_t)(c * n1), 8), *own_rows = room((size_t)(3 * n1), 8), *own_force = room((size_t)(3 * n2), 8), *own;
  for (int k = 0; k < 3 * n1; k++) host[k] = random_at((uint64_t)k);
  own = own_values(&r->own[0], 3, host);
  ONE(stickslip_interface_condensed_multipliers(r->one, r->x[0], r->x[1], host, lambda));
  ONE(stickslip_interface_condensed_residual(r->one, r->x[0], r->x[1], lambda, host, rows, force));
  ALL(stickslip_mpi_interface_condensed_multipliers(r->all, own, own_lambda));
  ALL(stickslip_mpi_interface_condensed_residual(r->all, own, own_rows, own_force));
  worst(&r->found.rows, apart(&r->own[0], c, c * n1, own_lambda, lambda));
  worst(&r->found.force, apart(&r->own[0], 3, 3 * n1, own_rows, rows));
  worst(&r->found.force, apart(&r->own[1], 3, 3 * n2, own_force, force));
  for (int p = 0; p < N_PIECES; p++) compare_piece(r, lambda, PIECES[p]);
  memcpy(r->lambda, lambda, (size_t)(c * n1) * 8); /* the commit is of these */
  free(host), free(lambda), free(rows), free(force), free(own_lambda), free(own_rows), free(own_force), free(own);
}

int main(int argc, char **argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  for (int s = 0; s < N_SCENES; s++) {
    run r;
    begin(&r, &SCENES[s], s % 2);
    for (int t = 1; t <= 3; t++) {
      place(&r, t, 0.5);
      compare_condensed(&r);
      compare_states(&r);
      ONE(stickslip_interface_commit(r.one, r.x[0], r.x[1], r.lambda, NULL));
      ALL(stickslip_mpi_interface_commit(r.all));
    }
    end(&r);
  }
  MPI_Finalize();
  return failures > 0;
}
