/* Do the equations say what every multiplier is? Where supports hold nodes of both surfaces, as of two tied bodies at one wall, a
 * row of multipliers may push on nothing that can move. Newton's method converges all the same, displacements are right, and the
 * tractions there are whatever the linear solver left.
 *
 * The last factors J ~ LU of a run find it: b = J z with multipliers z of our choice, and J y = b gives back y = z, but for what
 * is not determined. */
#include "output/output.h"
#include <cjson/cJSON.h>
#include <math.h>

/* z has entries of about 1. What is determined comes back to rounding times the condition of J, some 1e-16 times 1e10 at most. */
static const PetscReal NOT_GIVEN_BACK = 1e-3;

typedef struct {
  PetscInt  multipliers; /* that do not come back */
  PetscReal worst, X[3]; /* how far from it, and at which node */
} Undetermined;

/* May supports leave multipliers of this interface alone? */
static PetscErrorCode is_supported(const Interface *interface, PetscBool *supported)
{
  PetscFunctionBegin;
  *supported = PETSC_FALSE;
  for (PetscInt a = 0; a < interface->n1 && !*supported; a++)
    *supported = (PetscBool)(interface->prescribed[a] != 0 && interface->removed[a] != 7);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, supported, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the same on every rank and in every run, and different from node to node */
static PetscReal chosen(int64_t equation)
{
  return 1 + 0.5 * sin((double)equation);
}

static PetscInt n_multipliers(const ContactPart *part)
{
  return part->handle ? part->components * part->n1 : 0;
}

static PetscErrorCode choose(const Contact *contact, Vec z)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(z));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const ContactPart *part = &contact->interfaces[i].part;
    for (PetscInt k = 0; k < n_multipliers(part); k++) {
      const int64_t equation = MULTIPLIERS_OF(part, part->equations)[k];
      if (equation >= 0 && part->owned[k / part->components] == STICKSLIP_NODE_OWN)
        PetscCall(VecSetValue(z, (PetscInt)equation, chosen(equation), INSERT_VALUES));
    }
  }
  PetscCall(VecAssemblyBegin(z));
  PetscCall(VecAssemblyEnd(z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y at the multipliers of an interface: those that did not come back, of all ranks */
static PetscErrorCode compare(const Mesh *mesh, const Interface *interface, Vec y, Undetermined *found)
{
  const ContactPart *part = &interface->part;
  const PetscInt     n    = n_multipliers(part);
  PetscInt          *all;
  PetscScalar       *values;
  IS                 is;
  VecScatter         scatter;
  Vec                here;

  PetscFunctionBegin;
  *found = (Undetermined){0};
  PetscCall(PetscMalloc1(n, &all));
  for (PetscInt k = 0; k < n; k++) {
    const int64_t equation = MULTIPLIERS_OF(part, part->equations)[k];
    all[k]                 = equation >= 0 ? (PetscInt)equation : 0;
  }
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, all, PETSC_OWN_POINTER, &is));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, &here));
  PetscCall(VecScatterCreate(y, is, here, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, y, here, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, y, here, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArray(here, &values));
  for (PetscInt k = 0; k < n; k++) {
    const int64_t   equation = MULTIPLIERS_OF(part, part->equations)[k];
    const PetscReal off      = equation >= 0 ? PetscAbsReal(PetscRealPart(values[k]) - chosen(equation)) : 0;
    if (!(off > NOT_GIVEN_BACK) || part->owned[k / part->components] != STICKSLIP_NODE_OWN) continue;
    found->multipliers++;
    if (off <= found->worst) continue;
    found->worst = off;
    contact_vector(part->dimension, part->X, k / part->components, found->X);
  }
  PetscCall(VecRestoreArray(here, &values));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&here));
  PetscCall(ISDestroy(&is));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found->multipliers, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(contact_largest(mesh, &found->worst, sizeof(found->X), found->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode tell(const Interface *interface, const Undetermined *found, cJSON *parent)
{
  cJSON *json = cJSON_AddObjectToObject(parent, interface->name);
  PetscFunctionBegin;
  cJSON_AddNumberToObject(json, "multipliers", (double)found->multipliers);
  cJSON_AddItemToObject(json, "position", cJSON_CreateDoubleArray(found->X, 3));
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "snes_contact: warning: %" PetscInt_FMT " multipliers of %s, most at (%g, %g, %g), are not determined by the "
                         "equations: supports hold nodes of both its surfaces, and some tractions near there push on nothing that can "
                         "move. Displacements are right, tractions there are not. Let the side with fewer nodes along the supports be `nonmortar`, "
                         "with `basis: standard`, or take its nodes there out of the supports: the interface holds them.\n",
                         found->multipliers, interface->name, (double)found->X[0], (double)found->X[1], (double)found->X[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After the last step of a run, while the factors of its last matrix are there: direct solver, multipliers among the unknowns. */
PetscErrorCode undetermined_check(const Output *output, cJSON *root)
{
  const Contact       *contact = output->contact;
  Solve               *solve   = output->solve;
  const PetscLogDouble seconds = solve->seconds; /* what is measured is the run */
  PetscBool            needed = PETSC_FALSE, direct;
  KSPConvergedReason   reason;
  KSP                  ksp;
  Mat                  J;
  Vec                  z, b, y;
  cJSON               *json;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(solve->snes, &ksp));
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, &direct));
  for (PetscInt i = 0; i < contact->n_interfaces && direct && !contact->condensed && !needed; i++)
    PetscCall(is_supported(&contact->interfaces[i], &needed));
  if (!needed || !solve->iterations) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetOperators(ksp, &J, NULL));
  PetscCall(MatCreateVecs(J, &z, &b));
  PetscCall(VecDuplicate(z, &y));
  PetscCall(choose(contact, z));
  PetscCall(MatMult(J, z, b));
  PetscCall(KSPSolve(ksp, b, y));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  json = cJSON_CreateObject();
  for (PetscInt i = 0; i < contact->n_interfaces && reason >= 0; i++) {
    Undetermined found;
    PetscCall(compare(output->mesh, &contact->interfaces[i], y, &found));
    if (found.multipliers) PetscCall(tell(&contact->interfaces[i], &found, json));
  }
  if (json->child)
    cJSON_AddItemToObject(root, "undetermined", json);
  else
    cJSON_Delete(json);
  PetscCall(VecDestroy(&z));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&y));
  solve->seconds = seconds;
  PetscFunctionReturn(PETSC_SUCCESS);
}
