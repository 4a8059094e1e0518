/* A preconditioner of a matrix with multipliers,
 *
 *   J = [A B; C D],   J^-1 ~ [1 -A'B; 0 1] [A' 0; 0 S'] [1 0; -C A' 1],   S = D - C diag(A)^-1 B,
 *
 * A' a cycle of multigrid on the bodies, with prescribed components as rows of the identity, S' by LU: there are as many rows as
 * multipliers. A must not be singular: supports hold every body by themselves, or the form is `augmented`, whose A has what
 * contact holds. */
#include "solve/saddle.h"
#include "solve/multigrid.h"
#include "solve/direct.h"

typedef struct {
  const Contact *contact;
  NodeBlocks     blocks;
  Coarse         coarse;
  IS             bodies, multipliers;
  Mat            B, C, S;
  PC             multigrid;
  KSP            schur;
  Vec            in, out;                  /* of nodes */
  Vec            f, u, work, g, lambda;    /* of the bodies' equations, three; of multipliers */
  Mat            place;                    /* the bodies' equations in terms of nodes' components */
} Saddle;

/* The rank's equations of displacements and of multipliers; those of rigid bodies are neither (bordered.c). */
static PetscErrorCode split(const Physics *physics, Mat J, IS *bodies, IS *multipliers)
{
  const Unknowns *unknowns = &physics->unknowns;
  const Mesh     *mesh     = physics->mesh;
  PetscInt        first, end, n[2] = {0, 0}, *rows[2];
  PetscInt       *kind; /* 0 of multipliers, 1 of displacements, 2 of rigid bodies */
  PetscFunctionBegin;
  PetscCall(MatGetOwnershipRange(J, &first, &end));
  PetscCall(PetscCalloc1(end - first, &kind));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt at;
    if (unknowns->ghost[k]) continue;
    PetscCall(PetscSectionGetOffset(unknowns->section, mesh->points[k], &at));
    for (int i = 0; i < 3; i++) {
      if (unknowns->equations[at + i] >= 0)
        kind[unknowns->equations[at + i] - first] = rigids_of_vertex(physics, mesh->original[k]) < 0 ? 1 : 2;
    }
  }
  for (int field = 0; field < 2; field++) {
    PetscCall(PetscMalloc1(end - first, &rows[field]));
    for (PetscInt row = first; row < end; row++) {
      if (kind[row - first] == !field) rows[field][n[field]++] = row;
    }
  }
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, n[0], rows[0], PETSC_OWN_POINTER, bodies));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, n[1], rows[1], PETSC_OWN_POINTER, multipliers));
  PetscCall(PetscFree(kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode create(Saddle *saddle, Mat J)
{
  IS nodes;
  PetscInt n, first;
  PetscFunctionBegin;
  PetscCall(node_blocks_create(saddle->contact->physics, J, &saddle->blocks));
  PetscCall(coarse_create(saddle->contact->physics, &saddle->blocks, J, &saddle->coarse));
  PetscCall(split(saddle->contact->physics, J, &saddle->bodies, &saddle->multipliers));
  PetscCall(VecGetLocalSize(saddle->blocks.coordinates, &n));
  PetscCall(VecGetOwnershipRange(saddle->blocks.coordinates, &first, NULL));
  PetscCall(ISCreateStride(PETSC_COMM_WORLD, n, first, 1, &nodes));
  PetscCall(MatCreateSubMatrix(saddle->blocks.place, saddle->bodies, nodes, MAT_INITIAL_MATRIX, &saddle->place));
  PetscCall(ISDestroy(&nodes));
  PetscCall(MatCreateVecs(saddle->place, &saddle->in, &saddle->f));
  PetscCall(VecDuplicate(saddle->in, &saddle->out));
  PetscCall(VecDuplicate(saddle->f, &saddle->u));
  PetscCall(VecDuplicate(saddle->f, &saddle->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode forget(Saddle *saddle)
{
  PetscFunctionBegin;
  PetscCall(PCDestroy(&saddle->multigrid));
  PetscCall(KSPDestroy(&saddle->schur));
  PetscCall(MatDestroy(&saddle->B));
  PetscCall(MatDestroy(&saddle->C));
  PetscCall(MatDestroy(&saddle->S));
  PetscCall(VecDestroy(&saddle->g));
  PetscCall(VecDestroy(&saddle->lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S = D - C diag(A)^-1 B, and its factors */
static PetscErrorCode make_schur(Saddle *saddle, Mat J, Mat A)
{
  Vec diagonal;
  Mat scaled, product;
  PetscFunctionBegin;
  PetscCall(MatCreateSubMatrix(J, saddle->multipliers, saddle->multipliers, MAT_INITIAL_MATRIX, &saddle->S));
  PetscCall(VecDuplicate(saddle->f, &diagonal));
  PetscCall(MatGetDiagonal(A, diagonal));
  PetscCall(VecReciprocal(diagonal));
  PetscCall(MatDuplicate(saddle->B, MAT_COPY_VALUES, &scaled));
  PetscCall(MatDiagonalScale(scaled, diagonal, NULL));
  PetscCall(MatMatMult(saddle->C, scaled, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
  PetscCall(MatAXPY(saddle->S, -1, product, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatDestroy(&product));
  PetscCall(MatDestroy(&scaled));
  PetscCall(VecDestroy(&diagonal));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &saddle->schur));
  PetscCall(KSPSetOptionsPrefix(saddle->schur, "multipliers_"));
  PetscCall(direct_set(saddle->schur));
  PetscCall(KSPSetOperators(saddle->schur, saddle->S, saddle->S));
  PetscCall(KSPSetFromOptions(saddle->schur));
  PetscCall(MatCreateVecs(saddle->S, &saddle->lambda, &saddle->g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multigrid on A, in whole nodes. */
static PetscErrorCode make_multigrid(Saddle *saddle, Mat A)
{
  const PetscReal nothing_left_out = 0;
  Mat             whole, P;
  PetscFunctionBegin;
  PetscCall(MatPtAP(A, saddle->place, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &whole));
  PetscCall(node_blocks_matrix(&saddle->blocks, whole, nothing_left_out, &P));
  PetscCall(MatDestroy(&whole));
  PetscCall(multigrid_create(&saddle->coarse, NULL, P, &saddle->multigrid));
  PetscCall(MatDestroy(&P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode set_up(PC pc)
{
  Saddle *saddle;
  Mat     J, A;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &saddle));
  PetscCall(PCGetOperators(pc, &J, NULL));
  PetscCall(forget(saddle));
  if (!saddle->place) PetscCall(create(saddle, J));
  PetscCall(MatCreateSubMatrix(J, saddle->bodies, saddle->bodies, MAT_INITIAL_MATRIX, &A));
  PetscCall(MatCreateSubMatrix(J, saddle->bodies, saddle->multipliers, MAT_INITIAL_MATRIX, &saddle->B));
  PetscCall(MatCreateSubMatrix(J, saddle->multipliers, saddle->bodies, MAT_INITIAL_MATRIX, &saddle->C));
  PetscCall(make_schur(saddle, J, A));
  PetscCall(make_multigrid(saddle, A));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u = A' f */
static PetscErrorCode solve_bodies(Saddle *saddle, Vec f, Vec u)
{
  PetscFunctionBegin;
  PetscCall(MatMultTranspose(saddle->place, f, saddle->in));
  PetscCall(PCApply(saddle->multigrid, saddle->in, saddle->out));
  PetscCall(MatMult(saddle->place, saddle->out, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode apply(PC pc, Vec r, Vec x)
{
  Saddle *saddle;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &saddle));
  PetscCall(VecISCopy(r, saddle->bodies, SCATTER_REVERSE, saddle->f));
  PetscCall(VecISCopy(r, saddle->multipliers, SCATTER_REVERSE, saddle->g));
  PetscCall(solve_bodies(saddle, saddle->f, saddle->u));
  PetscCall(VecScale(saddle->g, -1));
  PetscCall(MatMultAdd(saddle->C, saddle->u, saddle->g, saddle->g));
  PetscCall(VecScale(saddle->g, -1));
  PetscCall(KSPSolve(saddle->schur, saddle->g, saddle->lambda));
  PetscCall(MatMult(saddle->B, saddle->lambda, saddle->f));
  PetscCall(solve_bodies(saddle, saddle->f, saddle->work));
  PetscCall(VecAXPY(saddle->u, -1, saddle->work));
  PetscCall(VecISCopy(x, saddle->bodies, SCATTER_FORWARD, saddle->u));
  PetscCall(VecISCopy(x, saddle->multipliers, SCATTER_FORWARD, saddle->lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy(PC pc)
{
  Saddle *saddle;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &saddle));
  PetscCall(forget(saddle));
  PetscCall(node_blocks_destroy(&saddle->blocks));
  PetscCall(coarse_destroy(&saddle->coarse));
  PetscCall(ISDestroy(&saddle->bodies));
  PetscCall(ISDestroy(&saddle->multipliers));
  PetscCall(MatDestroy(&saddle->place));
  PetscCall(VecDestroy(&saddle->in));
  PetscCall(VecDestroy(&saddle->out));
  PetscCall(VecDestroy(&saddle->f));
  PetscCall(VecDestroy(&saddle->u));
  PetscCall(VecDestroy(&saddle->work));
  PetscCall(PetscFree(saddle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode saddle_set(PC pc, const Contact *contact)
{
  Saddle *saddle;
  PetscFunctionBegin;
  PetscCall(PetscNew(&saddle));
  saddle->contact = contact;
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetName(pc, "multigrid on the bodies, LU for the multipliers"));
  PetscCall(PCShellSetContext(pc, saddle));
  PetscCall(PCShellSetSetUp(pc, set_up));
  PetscCall(PCShellSetApply(pc, apply));
  PetscCall(PCShellSetDestroy(pc, destroy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
