/* The entries of a local vector that a support holds. */
#include "physics/timed.h"

/* Of a rigid body: of its two vertices. */
static void visit_rigid(const Rigid *rigid, const Support *support, EntryVisit action, void *context)
{
  const PetscInt mask = support->mask | support->turns << 3;
  for (int k = 0; k < RIGID_UNKNOWNS && rigid->at[0] >= 0; k++) {
    if (mask & (1 << k)) action(support, rigid->at[k / 3] + k % 3, k, rigid->owned, context);
  }
}

PetscErrorCode support_visit(const Physics *physics, const Support *support, EntryVisit action, void *context)
{
  PetscInt n, *points, at;
  PetscFunctionBegin;
  if (support->rigid >= 0) {
    visit_rigid(&physics->rigids[support->rigid], support, action, context);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(plex_labelled(physics->mesh, "support", support->name, &n, &points));
  for (PetscInt k = 0; k < n; k++) {
    const PetscBool owned = (PetscBool)!physics->unknowns.ghost[physics->mesh->here[points[k]]];
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, points[k], &at));
    for (int i = 0; i < 3; i++) {
      if (support->mask & (1 << i)) action(support, at + i, i, owned, context);
    }
  }
  PetscCall(PetscFree(points));
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
