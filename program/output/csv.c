/* Per step one CSV file for each interface, a row per non-mortar node. Each rank has those of its own nodes, whose numbers follow each
 * other; rank 0 writes them one after the other, as they come. */
#include "output/output.h"
#include <stdio.h>
#include <string.h>

static const char *const STATE_NAMES[] = {"gap", "stick", "slip"}; /* by STICKSLIP_STATE_* */

/* A row is at most so long. */
enum { ROW = 1024 };

/* the file, on rank 0 */
static PetscErrorCode open_file(const Output *output, const char *path, const char *head, const char *further, FILE **file)
{
  PetscFunctionBegin;
  *file = NULL;
  if (output->mesh->rank) PetscFunctionReturn(PETSC_SUCCESS);
  *file = fopen(path, "w");
  PetscCheck(*file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(*file, "%s%s\n", head, further);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode close_file(FILE *file)
{
  PetscFunctionBegin;
  PetscCall(PetscSynchronizedFlush(PETSC_COMM_WORLD, file));
  if (file) fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The row of node a, by its traction. */
static void format_row(const Interface *interface, const ContactStates *states, PetscInt a, const double traction[3], char row[ROW])
{
  const double *n = states->normal + 3 * a, *lambda = states->multiplier + 3 * a, *slip = states->slip + 3 * a;
  double        lambda_n = 0, pressure = 0, values[23], X[3], u[3], force[3], *v = values;
  int           used;
  contact_vector(interface->dimension, interface->X, a, X);
  contact_vector(interface->dimension, interface->displacements, a, u);
  contact_vector(interface->dimension, interface->forces, a, force);
  for (int i = 0; i < 3; i++) {
    lambda_n += lambda[i] * n[i];
    pressure += traction[i] * n[i];
  }
  for (int i = 0; i < 3; i++)
    *v++ = X[i];
  for (int i = 0; i < 3; i++)
    *v++ = u[i];
  for (int i = 0; i < 3; i++)
    *v++ = n[i];
  *v++ = lambda_n;
  for (int i = 0; i < 3; i++)
    *v++ = lambda[i] - lambda_n * n[i];
  *v++ = states->gap[a];
  for (int i = 0; i < 3; i++)
    *v++ = slip[i];
  *v++ = states->coverage[a];
  *v++ = states->area[a];
  for (int i = 0; i < 3; i++)
    *v++ = -force[i];
  *v++ = pressure;
  used = snprintf(row, ROW, "%d", (int)interface->nodes[a]);
  for (const double *w = values; w < v; w++)
    used += snprintf(row + used, (size_t)(ROW - used), ",%.17g", *w);
  used += snprintf(row + used, (size_t)(ROW - used), ",%s", interface->middle[a] ? "none" : STATE_NAMES[states->state[a]]);
  for (int i = 0; i < 3; i++)
    used += snprintf(row + used, (size_t)(ROW - used), ",%.17g", traction[i] - pressure * n[i]);
  if (decision_is_points(interface)) snprintf(row + used, (size_t)(ROW - used), ",%.17g", states->closed[a]);
  if (layer_is_there(interface)) {
    const double *layer = states->layer + N_LAYER_RESULTS * a;
    snprintf(row + used, (size_t)(ROW - used), ",%.17g,%.17g", layer[LAYER_WORN], layer[LAYER_DAMAGE]);
  }
}

PetscErrorCode csv_write(Output *output, const Interface *interface, const ContactStates *states, const double *temperatures,
                         PetscInt step)
{
  static const char *const further[3][2] = {
      {"", ",temperature"}, {",closed", ",closed,temperature"}, {",worn,damage", ",worn,damage,temperature"}};
  const int has = decision_is_points(interface) ? 1 : layer_is_there(interface) ? 2 : 0;
  char    path[PETSC_MAX_PATH_LEN], row[ROW];
  double *tractions;
  FILE   *file;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * interface->n1, &tractions));
  PetscCall(nodal_tractions(output->mesh, interface, states, tractions));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/interface_%s_%" PetscInt_FMT ".csv", output->directory,
                          interface->name, step));
  PetscCall(open_file(output, path,
                      "node,X,Y,Z,ux,uy,uz,nx,ny,nz,lambda_n,lambda_tx,lambda_ty,lambda_tz,gap_weighted,slip_x,slip_y,slip_z,"
                      "area_covered,area_full,fx,fy,fz,p_lumped,state,t_lumped_x,t_lumped_y,t_lumped_z",
                      further[has][temperatures != NULL], &file));
  for (PetscInt a = 0; a < interface->n1; a++) {
    format_row(interface, states, a, tractions + 3 * a, row);
    if (temperatures) snprintf(row + strlen(row), ROW - strlen(row), ",%.17g", temperatures[a]);
    PetscCall(PetscSynchronizedFPrintf(PETSC_COMM_WORLD, file, "%s\n", row));
  }
  PetscCall(close_file(file));
  PetscCall(PetscFree(tractions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What `adjust` has done, a row per non-mortar node with the place that it has now; nothing where it was not asked for. */
PetscErrorCode csv_adjusted(Output *output, const Interface *interface)
{
  static const char *const done[] = {"alone", "left", "moved"}; /* by STICKSLIP_ADJUST_... */
  const Offsets           *offsets = &interface->offsets;
  char                     path[PETSC_MAX_PATH_LEN], row[ROW];
  PetscInt                 count[3] = {0, 0, 0};
  double                   largest  = 0;
  FILE                    *file;

  PetscFunctionBegin;
  if (!(offsets->adjust > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/adjust_%s.csv", output->directory, interface->name));
  PetscCall(open_file(output, path, "node,X,Y,Z,gap,adjusted", "", &file));
  for (PetscInt a = 0; a < interface->n1; a++) {
    double X[3];
    contact_vector(interface->dimension, interface->X, a, X);
    snprintf(row, sizeof(row), "%d,%.17g,%.17g,%.17g,%.17g,%s", (int)interface->nodes[a], X[0], X[1], X[2], offsets->gaps[a],
             done[offsets->moved[a]]);
    PetscCall(PetscSynchronizedFPrintf(PETSC_COMM_WORLD, file, "%s\n", row));
    count[offsets->moved[a]]++;
    if (offsets->moved[a] == STICKSLIP_ADJUST_MOVED) largest = PetscMax(largest, PetscAbsReal(offsets->gaps[a]));
  }
  PetscCall(close_file(file));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 3, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  if (!output->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: adjust moved %d of %d nodes, by %g at most; %d are beyond the tolerance; %d meet nothing along their normals, and "
                          "stay\n",
                          interface->name, (int)count[STICKSLIP_ADJUST_MOVED], (int)interface->all[0], largest, (int)count[STICKSLIP_ADJUST_LEFT],
                          (int)count[STICKSLIP_ADJUST_ALONE]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
