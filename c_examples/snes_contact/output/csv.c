/* Per step one CSV file for each interface, a row per non-mortar node. Written on rank 0. */
#include "output/output.h"
#include <stdio.h>

static const char *const STATE_NAMES[] = {"gap", "stick", "slip"}; /* by STICKSLIP_STATE_* */

PetscErrorCode csv_write(Output *output, const Interface *interface, const ContactStates *states, PetscInt step)
{
  char    path[PETSC_MAX_PATH_LEN];
  double *tractions;
  FILE   *file;
  const PetscBool by_points = decision_is_points(interface);

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * interface->n1, &tractions));
  PetscCall(nodal_tractions(output->mesh, interface, states, tractions));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/interface_%s_%" PetscInt_FMT ".csv", output->directory,
                          interface->name, step));
  file = fopen(path, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(file, "node,X,Y,Z,ux,uy,uz,nx,ny,nz,lambda_n,lambda_tx,lambda_ty,lambda_tz,gap_weighted,slip_x,slip_y,slip_z,"
                "area_covered,area_full,fx,fy,fz,p_lumped,state,t_lumped_x,t_lumped_y,t_lumped_z%s\n",
          by_points ? ",closed" : "");
  for (PetscInt a = 0; a < interface->n1; a++) {
    const double *n = states->normal + 3 * a, *lambda = states->multiplier + 3 * a, *slip = states->slip + 3 * a;
    const double *traction = tractions + 3 * a;
    double        lambda_n = 0, pressure = 0, values[23], X[3], u[3], force[3], *v = values;
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
    fprintf(file, "%d", (int)interface->nodes[a]);
    for (const double *w = values; w < v; w++)
      fprintf(file, ",%.17g", *w);
    fprintf(file, ",%s", interface->middle[a] ? "none" : STATE_NAMES[states->state[a]]);
    for (int i = 0; i < 3; i++)
      fprintf(file, ",%.17g", traction[i] - pressure * n[i]);
    if (by_points) fprintf(file, ",%.17g", states->closed[a]);
    fprintf(file, "\n");
  }
  fclose(file);
  PetscCall(PetscFree(tractions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What `adjust` has done, a row per non-mortar node with the place that it has now; nothing where it was not asked for. */
PetscErrorCode csv_adjusted(Output *output, const Interface *interface)
{
  static const char *const done[] = {"alone", "left", "moved"}; /* by STICKSLIP_ADJUST_... */
  const Offsets           *offsets = &interface->offsets;
  char                     path[PETSC_MAX_PATH_LEN];
  PetscInt                 count[3] = {0, 0, 0};
  double                   largest  = 0;
  FILE                    *file;

  PetscFunctionBegin;
  if (!offsets->gaps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/adjust_%s.csv", output->directory, interface->name));
  file = fopen(path, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(file, "node,X,Y,Z,gap,adjusted\n");
  for (PetscInt a = 0; a < interface->n1; a++) {
    double X[3];
    contact_vector(interface->dimension, interface->X, a, X);
    fprintf(file, "%d,%.17g,%.17g,%.17g,%.17g,%s\n", (int)interface->nodes[a], X[0], X[1], X[2], offsets->gaps[a],
            done[offsets->moved[a]]);
    count[offsets->moved[a]]++;
    if (offsets->moved[a] == STICKSLIP_ADJUST_MOVED) largest = PetscMax(largest, PetscAbsReal(offsets->gaps[a]));
  }
  fclose(file);
  if (!output->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "%s: adjust moved %d of %d nodes, by %g at most; %d are beyond the tolerance\n",
                          interface->name, (int)count[STICKSLIP_ADJUST_MOVED], (int)interface->n1, largest,
                          (int)count[STICKSLIP_ADJUST_LEFT]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
