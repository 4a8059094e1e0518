/* Supports that change (timed.c) as the scene describes them, and where they cannot be. */
#include "physics/physics.h"

PetscErrorCode timed_read(Scene *scene, Physics *physics, Support *support)
{
  const char     *name  = support->name;
  const PetscBool until = scene_has(scene, name, "until"), from = scene_has(scene, name, "from");
  PetscFunctionBegin;
  support->active = PETSC_TRUE;
  support->until  = PETSC_MAX_REAL;
  support->fade   = -1;
  scene_real(scene, name, "from", &support->from);
  scene_real(scene, name, "until", &support->until);
  scene_real(scene, name, "fade", &support->fade);
  support->timed = (PetscBool)(support->from > 0 || until);
  if (from && support->from >= physics->end)
    scene_fail(scene, name, "from", "the run ends at t = %g: from %g on it would never hold.", (double)physics->end, (double)support->from);
  if (until && support->until > physics->end)
    scene_fail(scene, name, "until", "the run ends at t = %g, before %g: leave it out, and the support holds to the end.", (double)physics->end,
               (double)support->until);
  if (support->until <= support->from) scene_fail(scene, name, "until", "it must be after `from`, %g.", (double)support->from);
  if (scene_has(scene, name, "fade") && !until) scene_fail(scene, name, "fade", "only with `until`: how long the reaction takes to fade.");
  if (!support->timed) PetscFunctionReturn(PETSC_SUCCESS);
  if (support->from > 0 && support->rigid < 0 && (support->rotate[0] != 0 || support->rotate[1] != 0 || support->rotate[2] != 0))
    scene_fail(scene, name, "rotate", "a support that is activated moves nodes from where they are: it cannot turn them.");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two that hold the same component of a vertex must not do it at one time. */
static PetscErrorCode check_pair(Scene *scene, const Physics *physics, const Support *a, const Support *b)
{
  char       text[256];
  PetscInt   bad = -1;
  PetscBool *of_a;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(physics->mesh->n_vertices, &of_a));
  for (PetscInt k = 0; k < a->n_vertices; k++)
    of_a[a->vertices[k]] = PETSC_TRUE;
  for (PetscInt k = 0; k < b->n_vertices && bad < 0; k++) {
    if (of_a[b->vertices[k]]) bad = physics->mesh->numbers[b->vertices[k]];
  }
  PetscCall(PetscFree(of_a));
  PetscCall(PetscSNPrintf(text, sizeof(text), "'%s' holds one of its vertices, too, at the same time: supports that change hold vertices of their own, or "
                                              "one after the other.", a->name));
  PetscCall(scene_fail_first(scene, bad, b->name, "components", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode timed_check(Scene *scene, const Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt a = 0; a < physics->n_supports; a++) {
    for (PetscInt b = a + 1; b < physics->n_supports; b++) {
      const Support *one = &physics->supports[a], *two = &physics->supports[b];
      if (one->timed && two->timed && one->mask & two->mask && PetscMax(one->from, two->from) < PetscMin(one->until, two->until))
        PetscCall(check_pair(scene, physics, one, two));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Support *timed_first(const Physics *physics)
{
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    if (physics->supports[s].timed) return &physics->supports[s];
  }
  return NULL;
}

/* Components in which supports hold all vertices of a surface from start to end. */
static PetscErrorCode held_everywhere(const Physics *physics, const Surface *surface, PetscInt *mask)
{
  PetscFunctionBegin;
  *mask = 7;
  for (PetscInt k = 0; k < surface->offsets[surface->n_faces]; k++)
    *mask &= physics->prescribed[surface->vertices[k]];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mask, 1, MPIU_INT, MPI_BAND, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why a support may not hold nodes with multipliers for a while; NULL: it may. While it holds, their rows are its own, and what a multiplier is
 * only the other side's say. */
static const char *no_multiplier(const Support *support, const TimedSides *sides, PetscInt fixed, PetscInt all)
{
  if (sides->condensed)
    return "with `unknowns: displacements` a multiplier is found from its node's row, which is the support's while it holds. Take `unknowns: multipliers`";
  if (sides->normal_only ? fixed == all && support->mask == all : fixed & support->mask & all)
    return "and the mortar side is held as well, from start to end, so that nothing says what the multipliers are meanwhile";
  return NULL;
}

PetscErrorCode timed_refuse(Scene *scene, const Physics *physics, const TimedSides *sides)
{
  const PetscInt all = physics->mesh->dimension == 3 ? 7 : 3;
  const Surface *nonmortar = sides->surface[0];
  PetscInt       fixed;
  PetscFunctionBegin;
  if (!timed_first(physics)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(held_everywhere(physics, sides->surface[1], &fixed));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    const char    *why     = no_multiplier(support, sides, fixed, all);
    char           text[512];
    PetscInt       bad = -1;
    PetscBool     *on;
    if (!support->timed || !why) continue;
    PetscCall(PetscCalloc1(physics->mesh->n_vertices, &on));
    for (PetscInt k = 0; k < nonmortar->offsets[nonmortar->n_faces]; k++)
      on[nonmortar->vertices[k]] = PETSC_TRUE;
    for (PetscInt k = 0; k < support->n_vertices && bad < 0; k++) {
      if (on[support->vertices[k]]) bad = physics->mesh->numbers[support->vertices[k]];
    }
    PetscCall(PetscFree(on));
    PetscCall(PetscSNPrintf(text, sizeof(text),
                            "it holds nodes of '%s', the non-mortar side of '%s', for a part of the run only: %s. Hold other nodes of the body, or make it the "
                            "mortar side.", nonmortar->name, sides->interface, why));
    PetscCall(scene_fail_first(scene, bad, support->name, support->from > 0 ? "from" : "until", text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
