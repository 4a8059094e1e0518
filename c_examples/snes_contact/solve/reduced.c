/* A preconditioner of the condensed matrix J: multigrid on its reduced form (contact/reduction.c),
 *
 *   J^-1 ~ E_R P^-1 E_L,   P = (I - Q) E_L J E_R (I - Q) + s D Q.
 *
 * P is the elasticity of the bodies, tied where contact holds them, with rows of the identity, scaled, for constraints. What it
 * leaves out of E_L J E_R are the constraints' columns in other rows, which GMRES finds in a few iterations, and what
 * weights and normals of now add to the constraints' rows. Multigrid on J itself is fragile: rows of constraints beside
 * rows of stiffness give a coarse operator without meaning. */
#include "solve/reduced.h"
#include "solve/multigrid.h"

/* The multigrid of an earlier matrix serves as long as no node has changed its state: then Q differs by what normals have
 * turned, and by 1 where a state has changed. It serves no more where GMRES takes this much longer than with its own matrix. */
static const PetscReal SAME_STATES = 0.5, SLOWER = 1.5;
enum { A_FEW = 5 };

/* Entries of E_L J E_R that cancel, over the largest: rounding. Left in they would join the bodies across open gaps. */
static const PetscReal CANCELLED = 1e-13;
typedef struct {
  const Contact *contact;
  NodeBlocks     blocks;
  PC             multigrid;
  Mat            rows, columns, constrained; /* E_L - I, E_R - I, Q of the matrix that the multigrid was made for */
  PetscInt       fresh;                      /* GMRES' iterations with that matrix; -1: not known yet */
  Vec            left, right, in, out;       /* two of equations, two of nodes */
} Reduced;

/* Two factors of P: B = (I - Q) S, S the place of equations among nodes, and (I + E_R) B, or B^T (I + E_L). */
static PetscErrorCode factors(const Reduced *reduced, Mat *rows, Mat *columns)
{
  const Contact *contact = reduced->contact;
  Mat            free, transposed;
  PetscFunctionBegin;
  PetscCall(MatMatMult(contact->reduction[REDUCTION_CONSTRAINED], reduced->blocks.place, MAT_INITIAL_MATRIX,
                       PETSC_DEFAULT, &free));
  PetscCall(MatAYPX(free, -1, reduced->blocks.place, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatTranspose(free, MAT_INITIAL_MATRIX, &transposed));
  PetscCall(MatMatMult(contact->reduction[REDUCTION_COLUMNS], free, MAT_INITIAL_MATRIX, PETSC_DEFAULT, columns));
  PetscCall(MatAXPY(*columns, 1, free, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatMatMult(transposed, contact->reduction[REDUCTION_ROWS], MAT_INITIAL_MATRIX, PETSC_DEFAULT, rows));
  PetscCall(MatAXPY(*rows, 1, transposed, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatDestroy(&free));
  PetscCall(MatDestroy(&transposed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode assemble(const Reduced *reduced, Mat J, Mat *P)
{
  Mat       rows, columns, half, whole, constraints;
  Vec       prescribed;
  PetscReal typical;
  PetscFunctionBegin;
  PetscCall(factors(reduced, &rows, &columns));
  PetscCall(MatMatMult(J, columns, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &half));
  PetscCall(MatMatMult(rows, half, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &whole));
  PetscCall(MatDestroy(&half));
  PetscCall(MatDestroy(&rows));
  PetscCall(MatDestroy(&columns));
  PetscCall(MatPtAP(reduced->contact->reduction[REDUCTION_DIAGONAL], reduced->blocks.place, MAT_INITIAL_MATRIX,
                    PETSC_DEFAULT, &constraints));
  PetscCall(MatAXPY(whole, 1, constraints, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatDestroy(&constraints));
  PetscCall(multigrid_typical(whole, &typical));
  PetscCall(VecDuplicate(reduced->blocks.prescribed, &prescribed));
  PetscCall(VecCopy(reduced->blocks.prescribed, prescribed));
  PetscCall(VecScale(prescribed, typical));
  PetscCall(node_blocks_squeeze(whole, CANCELLED, P));
  PetscCall(MatDestroy(&whole));
  PetscCall(MatDiagonalSet(*P, prescribed, ADD_VALUES));
  PetscCall(VecDestroy(&prescribed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode forget(Reduced *reduced)
{
  PetscFunctionBegin;
  PetscCall(PCDestroy(&reduced->multigrid));
  PetscCall(MatDestroy(&reduced->rows));
  PetscCall(MatDestroy(&reduced->columns));
  PetscCall(MatDestroy(&reduced->constrained));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the multigrid serve the states of now? */
static PetscErrorCode serves(const Reduced *reduced, PetscBool *yes)
{
  Mat       difference;
  PetscReal largest;
  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  if (!reduced->multigrid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDuplicate(reduced->constrained, MAT_COPY_VALUES, &difference));
  PetscCall(MatAXPY(difference, -1, reduced->contact->reduction[REDUCTION_CONSTRAINED], DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatNorm(difference, NORM_INFINITY, &largest));
  PetscCall(MatDestroy(&difference));
  *yes = (PetscBool)(largest < SAME_STATES);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode keep(Mat matrix, Mat *kept)
{
  PetscFunctionBegin;
  *kept = matrix;
  PetscCall(PetscObjectReference((PetscObject)matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* States that change change the pattern of P: then everything is made anew. */
static PetscErrorCode set_up(PC pc)
{
  Reduced   *reduced;
  Mat        J, P;
  PetscBool  enough;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &reduced));
  PetscCall(serves(reduced, &enough));
  if (enough) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(forget(reduced));
  PetscCall(PCGetOperators(pc, &J, NULL));
  PetscCall(keep(reduced->contact->reduction[REDUCTION_ROWS], &reduced->rows));
  PetscCall(keep(reduced->contact->reduction[REDUCTION_COLUMNS], &reduced->columns));
  PetscCall(keep(reduced->contact->reduction[REDUCTION_CONSTRAINED], &reduced->constrained));
  reduced->fresh = -1;
  if (!reduced->in) {
    PetscCall(node_blocks_create(reduced->contact->physics, J, &reduced->blocks));
    PetscCall(VecDuplicate(reduced->blocks.coordinates, &reduced->in));
    PetscCall(VecDuplicate(reduced->blocks.coordinates, &reduced->out));
    PetscCall(MatCreateVecs(J, &reduced->right, &reduced->left));
  }
  PetscCall(assemble(reduced, J, &P));
  PetscCall(node_blocks_modes(&reduced->blocks, reduced->constrained, P));
  PetscCall(multigrid_create(reduced->contact->physics, P, &reduced->multigrid));
  PetscCall(MatDestroy(&P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode apply(PC pc, Vec r, Vec u)
{
  Reduced *reduced;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &reduced));
  if (!reduced->multigrid) PetscCall(set_up(pc)); /* forgotten since the matrix was set */
  PetscCall(MatMultAdd(reduced->rows, r, r, reduced->left));
  PetscCall(MatMultTranspose(reduced->blocks.place, reduced->left, reduced->in));
  PetscCall(PCApply(reduced->multigrid, reduced->in, reduced->out));
  PetscCall(MatMult(reduced->blocks.place, reduced->out, reduced->right));
  PetscCall(MatMultAdd(reduced->columns, reduced->right, reduced->right, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy(PC pc)
{
  Reduced *reduced;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &reduced));
  PetscCall(node_blocks_destroy(&reduced->blocks));
  PetscCall(forget(reduced));
  PetscCall(VecDestroy(&reduced->left));
  PetscCall(VecDestroy(&reduced->right));
  PetscCall(VecDestroy(&reduced->in));
  PetscCall(VecDestroy(&reduced->out));
  PetscCall(PetscFree(reduced));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode reduced_judge(PC pc, PetscInt iterations, PetscBool converged, PetscBool *stale)
{
  Reduced *reduced;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &reduced));
  *stale = (PetscBool)(reduced->fresh >= 0 && (!converged || iterations > SLOWER * reduced->fresh + A_FEW));
  if (*stale) PetscCall(forget(reduced));
  else if (reduced->fresh < 0) reduced->fresh = iterations;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode reduced_set(PC pc, const Contact *contact)
{
  Reduced *reduced;
  PetscFunctionBegin;
  PetscCall(PetscNew(&reduced));
  reduced->contact = contact;
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetName(pc, "multigrid on the reduced form"));
  PetscCall(PCShellSetContext(pc, reduced));
  PetscCall(PCShellSetSetUp(pc, set_up));
  PetscCall(PCShellSetApply(pc, apply));
  PetscCall(PCShellSetDestroy(pc, destroy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
