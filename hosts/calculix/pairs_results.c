/* What pairs write: job.stickslip with all digits, and a block of results in the .frd (pairs_pair.h). */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "pairs_pair.h"

static FILE *table;
static char name[400];

void pairs_open(const char *jobname) {
  snprintf(name, sizeof name, "%.*s", (int)strcspn(jobname, " "), jobname);
  char path[sizeof name + 16];
  snprintf(path, sizeof path, "%s.stickslip", name);
  if (!(table = fopen(path, "w"))) pairs_stop("cannot be written", path);
}

/* A row for each node: pair, side, node, position of the undeformed body, displacement; of a slave node lambda, gap, state; of a master
   node the contact's force on it. */
void pairs_write(const Pair *pairs, ITG n_pairs, ITG increment, double time) {
  fprintf(table, "increment %" ITGFORMAT " time %.17g\n", increment, time);
  for (ITG i = 0; i < n_pairs; i++)
    for (ITG s = 0; s < SIDES; s++) {
      const Side *side = &pairs[i].side[s];
      for (ITG a = 0; a < side->n_nodes; a++) {
        fprintf(table, "%" ITGFORMAT " %" ITGFORMAT " %" ITGFORMAT, i + 1, s + 1, side->nodes[a]);
        for (ITG k = DIM * a; k < DIM * (a + 1); k++) fprintf(table, " %.17g", side->reference[k]);
        for (ITG k = DIM * a; k < DIM * (a + 1); k++) fprintf(table, " %.17g", side->x[k] - side->reference[k]);
        for (ITG k = DIM * a; k < DIM * (a + 1); k++) fprintf(table, " %.17g", -side->force[k]);
        if (s == SLAVE && side->corner[a]) {
          for (ITG k = DIM * a; k < DIM * (a + 1); k++) fprintf(table, " %.17g", pairs[i].lambda[k]);
          fprintf(table, " %.17g %d", pairs[i].gap[a], (int)pairs[i].state[a]);
        }
        fprintf(table, "\n");
      }
    }
  fflush(table);
}

/* A block of five components, as cgx reads it: the state (0 gap, 1 stick, 2 slip), the pressure, the traction on the slave surface. */
void pairs_write_frd(const Pair *pairs, ITG n_pairs, ITG kode, double time, ITG istep, ITG iinc, ITG nmethod, const char *output) {
  static const char *const COMPONENTS[] = {"STATE", "CPRESS", "T1", "T2", "T3"};
  enum { N = sizeof COMPONENTS / sizeof *COMPONENTS };
  static ITG steps;
  ITG nodes = 0, none = 0, mode = -1, noddiam = -1;
  double one = 1, pi = 4 * atan(1.);
  char description[13] = "            ", path[sizeof name + 8], ascii[4] = "asc";
  if (!strncmp(output, "bin", 3)) return; /* cgx does not take blocks of both kinds in one file */
  snprintf(path, sizeof path, "%s.frd", name);
  FILE *file = fopen(path, "ab");
  if (!file) pairs_stop("cannot be written", path);
  for (ITG i = 0; i < n_pairs; i++)
    for (ITG a = 0; a < pairs[i].side[SLAVE].n_nodes; a++) nodes += pairs[i].side[SLAVE].corner[a];
  frdheader(&steps, &one, &time, &pi, &noddiam, NULL, &none, &mode, &nodes, description, &kode, &nmethod, file, ascii, &istep, &iinc);
  fprintf(file, " -4  STICKSLI%5d    1\n", N);
  for (ITG k = 0; k < N; k++) fprintf(file, " -5  %-8s%5d%5d%5d%5d\n", COMPONENTS[k], 1, 1, (int)k + 1, 0);
  for (ITG i = 0; i < n_pairs; i++)
    for (ITG a = 0; a < pairs[i].side[SLAVE].n_nodes; a++) {
      const Pair *p = &pairs[i];
      if (!p->side[SLAVE].corner[a]) continue;
      const double *t = p->lambda + DIM * a, *nu = p->normal + DIM * a;
      fprintf(file, " -1%10" ITGFORMAT "%12.5E%12.5E%12.5E%12.5E%12.5E\n", p->side[SLAVE].nodes[a], (double)p->state[a],
              -(t[0] * nu[0] + t[1] * nu[1] + t[2] * nu[2]), -t[0], -t[1], -t[2]);
    }
  fprintf(file, " -3\n");
  fclose(file);
}
