/* Parts on several ranks are what one handle is: forces, rows, tangent, states, equilibrium, commits, as the strip slides across all
 * borders between parts. Prints what differs most; a line begins with FAILED where that is more than rounding.
 *
 *   mpiexec -n 4 t_equal [SCENE] */
#include "compare.h"

enum { STEPS = 4 };

#define DUAL {.multiplier_basis = STICKSLIP_BASIS_DUAL}
#define POINTS {.decision = STICKSLIP_DECISION_POINTS}
#define STANDARD {.multiplier_basis = STICKSLIP_BASIS_STANDARD}
static const scene SCENES[] = {
  {"dual", {QUAD4, QUAD4}, {0}, {.mu = 0.3}, 1},
  {"slivers, which neighbours carry", {QUAD4, QUAD4}, {0}, {.mu = 0.3}, 1, .width = 0.55},
  {"standard", {QUAD4, QUAD4}, STANDARD, {.mu = 0.3}, 1},
  {"standard, a search distance", {QUAD4, TRI3}, STANDARD, {.mu = 0.3, .search_distance = 0.4}, 1},
  {"dual triangles, a search distance", {TRI3, QUAD4}, DUAL, {.mu = 0.3, .search_distance = 0.4}, 1},
  {"no friction", {QUAD4, QUAD4}, {0}, {.friction = STICKSLIP_FRICTION_NONE}, 1},
  {"weights of t_n", {QUAD4, QUAD4}, {.weights = STICKSLIP_WEIGHTS_COMMITTED}, {.mu = 0.3}, 1},
  {"small displacements", {QUAD4, QUAD4}, {0}, {.mu = 0.3, .small_displacements = 1}, 0},
  {"tied", {TRI3, QUAD4}, {0}, {.friction = STICKSLIP_FRICTION_TIED}, 0},
  {"counted from 1", {QUAD4, QUAD4}, STANDARD, {.mu = 0.3, .index_base = 1}, 1},
  {"triangles with mid nodes", {TRI6, TRI6}, {0}, {.mu = 0.3}, 1},
  {"eight nodes on nine", {QUAD8, QUAD9}, {0}, {.mu = 0.3}, 1},
  {"points that decide", {QUAD4, TRI3}, POINTS, {.friction = STICKSLIP_FRICTION_NONE}, 1},
  {"points, mid nodes", {TRI6, QUAD8}, POINTS, {.friction = STICKSLIP_FRICTION_NONE}, 1},
  {"lines", {LINE2, LINE2}, {0}, {.mu = 0.3, .model = STICKSLIP_MODEL_PLANE}, 1},
  {"lines with mid nodes", {LINE3, LINE3}, {0}, {.mu = 0.3, .model = STICKSLIP_MODEL_PLANE}, 1},
};
enum { N_SCENES = sizeof(SCENES) / sizeof(SCENES[0]) };

/* Steps with an iterate each that is not the last one; one is undone and done again. */
static void go(const scene *s, int spread) {
  const double slide = s->renews ? 0.5 : 0.001;
  run          r;
  begin(&r, s, spread);
  compare_first(&r);
  for (int step = 1; step <= STEPS; step++) {
    place(&r, step - 0.4, slide);
    compare(&r, 0);
    place(&r, step, slide);
    compare(&r, 1);
    ONE(stickslip_interface_commit(r.one, r.x[0], r.x[1], r.lambda, NULL));
    ALL(stickslip_mpi_interface_commit(r.all));
    if (step != 2) continue;
    place(&r, step + 0.3, slide);
    compare(&r, 0);
    ONE(stickslip_interface_rollback(r.one));
    ALL(stickslip_mpi_interface_rollback(r.all));
    place(&r, step - 0.1, slide);
    compare(&r, 1);
    ONE(stickslip_interface_commit(r.one, r.x[0], r.x[1], r.lambda, NULL));
    ALL(stickslip_mpi_interface_commit(r.all));
  }
  end(&r);
}

int main(int argc, char **argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  for (int s = 0; s < N_SCENES; s++)
    if (argc < 2 || !strcmp(argv[1], SCENES[s].name)) go(&SCENES[s], s % 2);
  MPI_Finalize();
  return failures > 0;
}
