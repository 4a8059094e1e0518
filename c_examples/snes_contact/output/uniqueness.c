/* Could friction have led to another answer? A node alone, all others held, has one state of rest for every load if
 *
 *     mu < u_n / |u_t|,   u: its displacement under a unit force along the normal n   (k_tt / |k_nt| in the plane),
 *
 * and may have several beyond: then which one a run ends in depends on its path (Klarbring's example). Nodes together may
 * lose uniqueness a little earlier. */
#include "output/output.h"
#include <cjson/cJSON.h>
#include <petscblaslapack.h>

/* rank 0: the largest friction for which node a has one state of rest; `sorted` are the rows of `stiffness` */
static PetscErrorCode critical_friction(const Interface *interface, PetscInt a, const double normal[3], Mat stiffness,
                                        PetscInt n_rows, const PetscInt sorted[], double *critical)
{
  PetscInt     rows[3], along[3], n = 0;
  PetscScalar  K[9], u[3];
  PetscBLASInt size, one = 1, pivots[3], info;
  double       u_n = 0, u_t = 0;

  PetscFunctionBegin;
  *critical = PETSC_MAX_REAL;
  for (int i = 0; i < interface->dimension; i++) {
    const int64_t equation = interface->equations[interface->dimension * a + i];
    PetscInt      at       = -1;
    if (equation >= 0) PetscCall(PetscFindInt((PetscInt)equation, n_rows, sorted, &at));
    if (at < 0) continue;
    along[n]  = i;
    u[n]      = normal[i];
    rows[n++] = at;
  }
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatGetValues(stiffness, n, rows, n, rows, K)); /* by rows: the transposed matrix to LAPACK */
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&size, &size, K, &size, pivots, &info));
  if (info) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_("T", &size, &one, K, &size, pivots, u, &size, &info));
  for (PetscInt k = 0; k < n; k++)
    u_n += PetscRealPart(u[k]) * normal[along[k]];
  for (int i = 0; i < 3; i++) {
    double component = -u_n * normal[i];
    for (PetscInt k = 0; k < n; k++)
      component += along[k] == i ? PetscRealPart(u[k]) : 0;
    u_t += component * component;
  }
  if (u_n > 0 && u_t > 0) *critical = u_n / PetscSqrtReal(u_t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: the node of least critical friction among those over the other surface */
static PetscErrorCode judge(const Interface *interface, Mat stiffness, PetscInt n_rows, const PetscInt sorted[],
                            cJSON *parent)
{
  static const char *const names[] = {"gap", "stick", "slip"};
  const ContactStates     *states = &interface->states;
  PetscInt                 worst = -1;
  double                   least = PETSC_MAX_REAL;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < interface->n1; a++) {
    double critical;
    if (!(states->coverage[a] > 0)) continue;
    PetscCall(critical_friction(interface, a, states->normal + 3 * a, stiffness, n_rows, sorted, &critical));
    if (critical < least) least = critical, worst = a;
  }
  if (worst >= 0 && interface->options.mu >= least) {
    PetscReal X[3];
    cJSON    *json = cJSON_AddObjectToObject(parent, interface->name);
    contact_vector(interface->dimension, interface->X, worst, X);
    cJSON_AddNumberToObject(json, "critical_friction", least);
    cJSON_AddNumberToObject(json, "node", interface->nodes[worst]);
    cJSON_AddStringToObject(json, "state", names[states->state[worst]]);
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                           "%s: with friction %g, not below %.3g, node %d at (%g, %g, %g) may have several states of "
                           "rest under one load; it ended in %s\n",
                           interface->name, interface->options.mu, least, (int)interface->nodes[worst], (double)X[0],
                           (double)X[1], (double)X[2], names[states->state[worst]]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_interface(Output *output, Interface *interface, Mat stiffness, cJSON *parent)
{
  const Mesh     *mesh = output->mesh;
  const PetscInt *sorted;
  PetscInt        n = 0, *rows = NULL;
  Mat            *part;
  IS              is;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->dimension * interface->n1, &rows));
  for (PetscInt k = 0; k < interface->dimension * interface->n1 && mesh->rank == 0; k++) {
    if (interface->equations[k] >= 0) rows[n++] = (PetscInt)interface->equations[k];
  }
  PetscCall(PetscSortRemoveDupsInt(&n, rows));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, rows, PETSC_OWN_POINTER, &is));
  PetscCall(MatCreateSubMatrices(stiffness, mesh->rank == 0, &is, &is, MAT_INITIAL_MATRIX, &part));
  PetscCall(ISGetIndices(is, &sorted));
  if (mesh->rank == 0) PetscCall(judge(interface, part[0], n, sorted, parent));
  PetscCall(ISRestoreIndices(is, &sorted));
  PetscCall(MatDestroySubMatrices(mesh->rank == 0, &part));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the end of a run, x its last state: interfaces with Coulomb friction that is not below every node's limit. */
PetscErrorCode uniqueness_check(Output *output, Vec x, cJSON *root)
{
  Physics             *physics = output->physics;
  Contact             *contact = output->contact;
  const PetscLogDouble seconds = physics->seconds; /* what is measured is the run */
  cJSON               *json;
  PetscBool            needed = PETSC_FALSE;
  PetscInt             inverted;
  Mat                  stiffness;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    needed = (PetscBool)(needed || contact->interfaces[i].options.mu > 0);
  if (!needed) PetscFunctionReturn(PETSC_SUCCESS);
  json = cJSON_AddObjectToObject(root, "several_states");
  PetscCall(unknowns_to_local(physics, x));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(contact_gather(contact, &contact->interfaces[i], physics->u_local));
  PetscCall(contact_collect(contact));
  PetscCall(MatDuplicate(output->solve->pattern, MAT_DO_NOT_COPY_VALUES, &stiffness));
  PetscCall(bulk_stiffness(physics, stiffness, &inverted));
  PetscCall(MatAssemblyBegin(stiffness, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(stiffness, MAT_FINAL_ASSEMBLY));
  for (PetscInt i = 0; i < contact->n_interfaces && !inverted; i++) {
    if (contact->interfaces[i].options.mu > 0)
      PetscCall(check_interface(output, &contact->interfaces[i], stiffness, json));
  }
  PetscCall(MatDestroy(&stiffness));
  physics->seconds = seconds;
  PetscFunctionReturn(PETSC_SUCCESS);
}
