/* The entries of a local vector that a support holds. */
#include "physics/timed.h"

PetscErrorCode support_visit(const Physics *physics, const Support *support, EntryVisit action, void *context)
{
  const Mesh     *mesh = physics->mesh;
  char            label[2 * NAME_LENGTH];
  const PetscInt *points;
  PetscInt        n, at;
  IS              is;
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(label, sizeof(label), "support.%s", support->name));
  PetscCall(DMGetStratumIS(mesh->dm, label, 1, &is));
  if (!is) PetscFunctionReturn(PETSC_SUCCESS); /* no such vertex on this rank */
  PetscCall(ISGetLocalSize(is, &n));
  PetscCall(ISGetIndices(is, &points));
  for (PetscInt k = 0; k < n; k++) {
    const PetscBool owned = (PetscBool)!physics->unknowns.ghost[mesh->here[points[k]]];
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, points[k], &at));
    for (int i = 0; i < 3; i++) {
      if (support->mask & (1 << i)) action(support, at + i, i, owned, context);
    }
  }
  PetscCall(ISRestoreIndices(is, &points));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  const PetscInt *equations;
  EntryVisit      action;
  void           *context;
} UnknownEntries;

static void visit_unknown(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  const UnknownEntries *of = context;
  if (of->equations[entry] >= 0) of->action(support, entry, component, owned, of->context);
}

PetscErrorCode timed_visit(const Physics *physics, const Support *support, EntryVisit action, void *context)
{
  UnknownEntries of = {.equations = physics->unknowns.equations, .action = action, .context = context};
  PetscFunctionBegin;
  PetscCall(support_visit(physics, support, visit_unknown, &of));
  PetscFunctionReturn(PETSC_SUCCESS);
}
