/* What was set for nodes stays with them when parts are renewed; a history goes on with other shares. */
#include "compare.h"

static const scene OF_HOST = {.name = "the host's owners, friction of nodes", .kind = {QUAD4, QUAD4}, .options = {.mu = 0.3}, .renews = 1,
                              .shares = STICKSLIP_MPI_SHARES_OF_HOST};
static const scene OFFSETS = {.name = "offsets", .kind = {QUAD4, QUAD4}, .options = {.mu = 0.3, .search_distance = 0.4}, .renews = 1};
static const scene PARTLY = {.name = "half covered", .kind = {QUAD4, QUAD4}, .method = {.multiplier_basis = STICKSLIP_BASIS_STANDARD},
                             .options = {.mu = 0.3}, .mortar = 7};
/* The largest share of covered nodes over the mean: a column of the strip's three nodes more or less. */
static const double EVEN = 1.3;
static const scene RESTART = {.name = "a restart", .kind = {TRI3, QUAD4}, .options = {.mu = 0.3}, .renews = 1};

static void step(run *r, double t) {
  place(r, t - 0.5, 0.5);
  compare(r, 1);
  place(r, t, 0.5);
  compare(r, 0);
  ONE(stickslip_interface_commit(r->one, r->x[0], r->x[1], r->lambda, NULL));
  ALL(stickslip_mpi_interface_commit(r->all));
}

/* `of` the random numbers of every node of a side, from 0 on */
static double *some(const surface *s, double of) {
  double *values = room((size_t)s->n_nodes, 8);
  for (int a = 0; a < s->n_nodes; a++) values[a] = of * (1 + random_at((uint64_t)a + 77));
  return values;
}

static void friction(void) {
  run r;
  begin(&r, &OF_HOST, 0);
  double *mu = some(&r.side[0], 0.2), *own = own_values(&r.own[0], 1, mu);
  ONE(stickslip_interface_set_friction(r.one, mu));
  ALL(stickslip_mpi_interface_set_friction(r.all, own));
  for (int t = 1; t <= 3; t++) step(&r, t);
  end(&r);
  free(mu), free(own);
}

/* Set before the first step, and others for each step. */
static void offsets(void) {
  run r;
  begin(&r, &OFFSETS, 1);
  for (int t = 1; t <= 3; t++) {
    double *all[2], *own[2];
    for (int s = 0; s < 2; s++) {
      all[s] = some(&r.side[s], 0.002 * t);
      own[s] = own_values(&r.own[s], 1, all[s]);
    }
    ONE(stickslip_interface_set_offsets(r.one, all[0], all[1]));
    ALL(stickslip_mpi_interface_set_offsets(r.all, own[0], own[1]));
    for (int s = 0; s < 2; s++) free(all[s]), free(own[s]);
    step(&r, t);
  }
  end(&r);
}

/* A rank has as many covered nodes as another one, though half of the strip is covered: it counts its own by whose it is. */
static void balanced(void) {
  run r;
  begin(&r, &PARTLY, 1);
  place(&r, 0.1, 0.5);
  compare(&r, 0);
  double           *coverage = room((size_t)r.side[0].n_nodes, 8), sums[2] = {0, 0};
  stickslip_states  states   = {.struct_size = sizeof(states), .coverage = coverage};
  stickslip_mpi_counts counts = {.struct_size = sizeof(counts)};
  ONE(stickslip_interface_states(r.one, r.x[0], r.x[1], r.lambda, NULL, &states));
  ALL(stickslip_mpi_interface_counts(r.all, &counts));
  stickslip_counters part = {.struct_size = sizeof(part)};
  if (stickslip_mpi_interface_handle(r.all)) ONE(stickslip_interface_counters(stickslip_mpi_interface_handle(r.all), &part));
  for (int a = 0; a < r.side[0].n_nodes; a++) sums[1] += coverage[a] > 0;
  sums[0] = (double)(counts.worked < part.nodes_frictional ? counts.worked : part.nodes_frictional);
  MPI_Allreduce(MPI_IN_PLACE, sums, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  const double most = sums[0] * size / sums[1];
  const int    good = size == 1 || (counts.rebalanced > 0 && most <= EVEN);
  if (rank == 0) printf("%-6s shares of covered nodes: the largest is %.2f of the mean\n", good ? "ok" : "FAILED", most);
  failures += !good;
  free(coverage);
  end(&r);
}

/* Arrays of the whole surface from the own nodes' ones. */
static double *put_together(const own_share *own, const surface *s, const double *values) {
  double *whole = room((size_t)(s->d * s->n_nodes), 8);
  for (int64_t k = 0; k < own->share.n_nodes; k++) memcpy(whole + s->d * own->index[k], values + s->d * k, (size_t)s->d * 8);
  MPI_Allreduce(MPI_IN_PLACE, whole, s->d * s->n_nodes, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return whole;
}

/* Two steps with one partition, then the history by nodes, and a third step with another partition. */
static void restart(void) {
  run    r, again;
  double *whole[3], *own[3];
  begin(&r, &RESTART, 0);
  for (int t = 1; t <= 2; t++) step(&r, t);
  stickslip_mpi_history history = {.struct_size = sizeof(history)};
  for (int k = 0; k < 3; k++) own[k] = room((size_t)(3 * r.own[k == 1].share.n_nodes), 8);
  history.x1 = own[0], history.x2 = own[1], history.slip = own[2];
  ALL(stickslip_mpi_interface_history_export(r.all, &history));
  for (int k = 0; k < 3; k++) {
    whole[k] = put_together(&r.own[k == 1], &r.side[k == 1], own[k]);
    free(own[k]);
  }
  begin(&again, &RESTART, 1);
  for (int k = 0; k < 3; k++) own[k] = own_values(&again.own[k == 1], 3, whole[k]);
  history.x1 = own[0], history.x2 = own[1], history.slip = own[2];
  ALL(stickslip_mpi_interface_history_import(again.all, &history));
  for (int k = 0; k < 3; k++) free(own[k]), free(whole[k]);
  stickslip_interface *fresh = again.one;
  again.one                  = r.one; /* this handle has gone the whole way */
  step(&again, 3);
  step(&again, 4);
  again.one = fresh;
  end(&again);
  end(&r);
}

int main(int argc, char **argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  friction();
  offsets();
  balanced();
  restart();
  MPI_Finalize();
  return failures > 0;
}
