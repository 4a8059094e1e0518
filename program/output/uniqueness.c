/* Could friction have led to another answer? A node alone, all others held, has one state of rest for every load if
 *
 *     mu < u_n / |u_t|,   u: its displacement under a unit force along the normal n   (k_tt / |k_nt| in the plane),
 *
 * and may have several beyond: then which one a run ends in depends on its path (Klarbring's example). Nodes together may
 * lose uniqueness a little earlier. */
#include "output/output.h"
#include <cjson/cJSON.h>
#include <petscblaslapack.h>

/* the largest friction for which node a has one state of rest; `sorted` are the rows of `stiffness` */
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

/* The node of least critical friction, as it is told. */
typedef struct {
  double   critical, X[3];
  PetscInt node, state;
} Worst;

/* Among those at home here that are over the other surface. */
static PetscErrorCode find_worst(const Interface *interface, Mat stiffness, PetscInt n_rows, const PetscInt sorted[], Worst *worst)
{
  const ContactStates *states = &interface->states;
  PetscFunctionBegin;
  *worst = (Worst){.critical = PETSC_MAX_REAL, .node = -1};
  for (PetscInt a = 0; a < interface->n1; a++) {
    double critical;
    if (!(states->coverage[a] > 0)) continue;
    PetscCall(critical_friction(interface, a, states->normal + 3 * a, stiffness, n_rows, sorted, &critical));
    if (!(critical < worst->critical)) continue;
    *worst = (Worst){.critical = critical, .node = interface->nodes[a], .state = states->state[a]};
    contact_vector(interface->dimension, interface->X, a, worst->X);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of all ranks, of equal ones the first one's. */
static PetscErrorCode agree(const Mesh *mesh, Worst *worst)
{
  struct {
    double critical;
    int    rank;
  } least = {.critical = worst->critical, .rank = mesh->rank};
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(worst, sizeof(*worst), MPI_BYTE, least.rank, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode tell(const Interface *interface, const Worst *worst, cJSON *parent)
{
  static const char *const names[] = {"gap", "stick", "slip"};
  cJSON                   *json    = cJSON_AddObjectToObject(parent, interface->name);
  PetscFunctionBegin;
  cJSON_AddNumberToObject(json, "critical_friction", worst->critical);
  cJSON_AddNumberToObject(json, "node", worst->node);
  cJSON_AddStringToObject(json, "state", names[worst->state]);
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "%s: with friction %g, not below %.3g, node %d at (%g, %g, %g) may have several states of "
                         "rest under one load; it ended in %s\n",
                         interface->name, interface->options.mu, worst->critical, (int)worst->node, worst->X[0], worst->X[1],
                         worst->X[2], names[worst->state]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_interface(Output *output, Interface *interface, Mat stiffness, cJSON *parent)
{
  const PetscInt *sorted;
  PetscInt        n = 0, *rows = NULL;
  Mat            *part;
  Worst           worst;
  IS              is;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->dimension * interface->n1, &rows));
  for (PetscInt k = 0; k < interface->dimension * interface->n1; k++) {
    if (interface->equations[k] >= 0) rows[n++] = (PetscInt)interface->equations[k];
  }
  PetscCall(PetscSortRemoveDupsInt(&n, rows));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, rows, PETSC_OWN_POINTER, &is));
  PetscCall(MatCreateSubMatrices(stiffness, 1, &is, &is, MAT_INITIAL_MATRIX, &part));
  PetscCall(ISGetIndices(is, &sorted));
  PetscCall(find_worst(interface, part[0], n, sorted, &worst));
  PetscCall(ISRestoreIndices(is, &sorted));
  PetscCall(MatDestroySubMatrices(1, &part));
  PetscCall(ISDestroy(&is));
  PetscCall(agree(output->mesh, &worst));
  if (worst.node >= 0 && interface->options.mu >= worst.critical) PetscCall(tell(interface, &worst, parent));
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
  if (!needed || physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS); /* states of rest */
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
