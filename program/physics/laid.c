/* Bodies that a step began with laying down (solve/settle.c). They are moved as a whole, and turned, before anything strains them. The
 * linear material tells no turn from a strain, and loads act for it where they did at first; so such a body's strain counts from the place
 * where it was laid: X are its nodes' places there, and displacements from there are the ones that strain it. Other laws know turns. */
#include "physics/physics.h"

static void apply(const PetscReal motion[LAID_NUMBERS], const PetscReal x[3], PetscReal moved[3])
{
  for (int i = 0; i < 3; i++) {
    moved[i] = motion[9 + i];
    for (int j = 0; j < 3; j++)
      moved[i] += motion[3 * i + j] * x[j];
  }
}

/* x -> second(first(x)) */
void laid_compose(const PetscReal first[LAID_NUMBERS], const PetscReal second[LAID_NUMBERS], PetscReal both[LAID_NUMBERS])
{
  PetscReal result[LAID_NUMBERS] = {0};
  apply(second, first + 9, result + 9);
  for (int k = 0; k < 27; k++)
    result[k / 3] += second[3 * (k / 9) + k % 3] * first[3 * (k % 3) + k / 3 % 3];
  for (int k = 0; k < LAID_NUMBERS; k++)
    both[k] = result[k];
}

PetscErrorCode laid_move(Physics *physics, PetscInt part, const PetscReal motion[LAID_NUMBERS])
{
  static const PetscReal none[LAID_NUMBERS] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Cells                 *cells = &physics->cells;
  PetscFunctionBegin;
  if (!physics->laid) {
    PetscCall(PetscMalloc1(LAID_NUMBERS * physics->parts.n, &physics->laid));
    for (PetscInt k = 0; k < LAID_NUMBERS * physics->parts.n; k++)
      physics->laid[k] = none[k % LAID_NUMBERS];
    PetscCall(PetscCalloc1(3 * cells->offsets[cells->n], &cells->laid));
  }
  laid_compose(physics->laid + LAID_NUMBERS * part, motion, physics->laid + LAID_NUMBERS * part);
  for (PetscInt c = 0; c < cells->n; c++) {
    if (cells->part[c] != part || physics->materials[cells->body[c]].law->finite) continue;
    for (PetscInt k = 3 * cells->offsets[c]; k < 3 * cells->offsets[c + 1]; k += 3) {
      PetscReal moved[3];
      apply(motion, cells->X + k, moved);
      for (int i = 0; i < 3; i++) {
        cells->laid[k + i] += moved[i] - cells->X[k + i];
        cells->X[k + i] = moved[i];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void laid_take(const Physics *physics, PetscInt cell, PetscReal u[])
{
  const Cells   *cells = &physics->cells;
  const PetscInt first = 3 * cells->offsets[cell];
  for (PetscInt k = first; k < 3 * cells->offsets[cell + 1] && cells->laid; k++)
    u[k - first] -= cells->laid[k];
}

PetscReal laid_first(const Cells *cells, PetscInt number)
{
  return cells->X[number] - (cells->laid ? cells->laid[number] : 0);
}

PetscErrorCode laid_archive(Physics *physics, Archive *archive)
{
  PetscBool any = (PetscBool)(physics->laid != NULL);
  PetscFunctionBegin;
  PetscCall(archive_bools(archive, "laid", 1, &any));
  for (PetscInt p = 0; p < physics->parts.n && any; p++) {
    PetscReal motion[LAID_NUMBERS];
    if (!archive->reading) PetscCall(PetscArraycpy(motion, physics->laid + LAID_NUMBERS * p, LAID_NUMBERS));
    PetscCall(archive_reals(archive, "part.laid", LAID_NUMBERS, motion));
    if (archive->reading && !archive->bad) PetscCall(laid_move(physics, p, motion));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
