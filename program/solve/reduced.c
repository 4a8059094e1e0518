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

/* The multigrid of an earlier matrix serves as long as E_L, E_R and Q are about what they were: where a node changes its state, begins to
 * slip (then 1 / (1 - beta) in E_L is large) or slides over a facet, they change by as much as they have. Kept beyond such a change it takes
 * half as many iterations again. It serves no more either once all solves since its own have taken more iterations beyond that one's than
 * another set-up costs. */
static const PetscReal SAME = 0.3;
enum { SET_UP_IN_ITERATIONS = 40, N_MADE_FOR = REDUCTION_CONSTRAINED + 1 };

/* From so many iterations on, with its own multigrid, a smoother that takes longer gains time. */
enum { SLOW = 40 };

/* Entries of E_L J E_R that cancel, over the largest of the node: rounding. Left in they would join the bodies across open gaps. */
static const PetscReal CANCELLED = 1e-13;
typedef struct {
  const Contact *contact;
  NodeBlocks     blocks;
  Coarse         coarse;
  PC             multigrid;
  Mat            made_for[N_MADE_FOR]; /* E_L - I, E_R - I, Q of the matrix that the multigrid was made for */
  PetscInt       fresh, more;          /* GMRES' iterations with that matrix, -1: not known yet; what others took beyond these */
  Vec            left, right, in, out; /* two of equations, two of nodes */
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
  Mat rows, columns, half, whole, constraints;
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
  PetscCall(node_blocks_matrix(&reduced->blocks, whole, CANCELLED, P));
  PetscCall(MatDestroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode forget(Reduced *reduced)
{
  PetscFunctionBegin;
  PetscCall(PCDestroy(&reduced->multigrid));
  for (int k = 0; k < N_MADE_FOR; k++)
    PetscCall(MatDestroy(&reduced->made_for[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the multigrid serve the states of now? */
static PetscErrorCode serves(const Reduced *reduced, PetscBool *yes)
{
  PetscFunctionBegin;
  *yes = (PetscBool)(reduced->multigrid != NULL);
  for (int k = 0; k < N_MADE_FOR && *yes; k++) {
    Mat       difference;
    PetscReal whole, largest;
    PetscCall(MatNorm(reduced->made_for[k], NORM_INFINITY, &whole));
    PetscCall(MatDuplicate(reduced->made_for[k], MAT_COPY_VALUES, &difference));
    PetscCall(MatAXPY(difference, -1, reduced->contact->reduction[k], DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatNorm(difference, NORM_INFINITY, &largest));
    PetscCall(MatDestroy(&difference));
    *yes = (PetscBool)(largest <= SAME * whole);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With a non-mortar body that is so many times as stiff as its mortar body ILU without fill gets slow, and is unstable from 3e4 unknowns on. */
static const PetscReal STIFF = 30;

static PetscBool stiff_above(const Contact *contact)
{
  const Mesh     *mesh      = contact->mesh;
  const Material *materials = contact->physics->materials;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const PetscInt *body = contact->interfaces[i].body;
    if (mesh->bodies[body[0]].rigid || mesh->bodies[body[1]].rigid) continue;
    if (materials[body[0]].young > STIFF * materials[body[1]].young) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode create(Reduced *reduced, Mat J)
{
  Physics  *physics = reduced->contact->physics;
  PetscBool more;
  PetscFunctionBegin;
  PetscCall(node_blocks_create(physics, J, &reduced->blocks));
  PetscCall(coarse_create(physics, &reduced->blocks, J, &reduced->coarse));
  if (stiff_above(reduced->contact)) PetscCall(multigrid_fill(&more));
  PetscCall(VecDuplicate(reduced->blocks.coordinates, &reduced->in));
  PetscCall(VecDuplicate(reduced->blocks.coordinates, &reduced->out));
  PetscCall(MatCreateVecs(J, &reduced->right, &reduced->left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* States that change change the pattern of P: then all but the bodies' coarse functions is made anew. */
static PetscErrorCode set_up(PC pc)
{
  Reduced  *reduced;
  Mat       J, P, Q;
  PetscBool enough;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &reduced));
  PetscCall(serves(reduced, &enough));
  if (enough) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(forget(reduced));
  PetscCall(PCGetOperators(pc, &J, NULL));
  if (!reduced->in) PetscCall(create(reduced, J));
  for (int k = 0; k < N_MADE_FOR; k++) {
    reduced->made_for[k] = reduced->contact->reduction[k];
    PetscCall(PetscObjectReference((PetscObject)reduced->made_for[k]));
  }
  reduced->fresh = -1;
  reduced->more  = 0;
  PetscCall(assemble(reduced, J, &P));
  PetscCall(MatPtAP(reduced->contact->reduction[REDUCTION_CONSTRAINED], reduced->blocks.place, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &Q));
  PetscCall(multigrid_create(&reduced->coarse, Q, P, &reduced->multigrid));
  PetscCall(MatDestroy(&Q));
  PetscCall(MatDestroy(&P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode apply(PC pc, Vec r, Vec u)
{
  Reduced   *reduced;
  const Mat *reduction;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &reduced));
  if (!reduced->multigrid) PetscCall(set_up(pc)); /* forgotten since the matrix was set */
  reduction = reduced->contact->reduction;
  PetscCall(MatMultAdd(reduction[REDUCTION_ROWS], r, r, reduced->left));
  PetscCall(MatMultTranspose(reduced->blocks.place, reduced->left, reduced->in));
  PetscCall(PCApply(reduced->multigrid, reduced->in, reduced->out));
  PetscCall(MatMult(reduced->blocks.place, reduced->out, reduced->right));
  PetscCall(MatMultAdd(reduction[REDUCTION_COLUMNS], reduced->right, reduced->right, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy(PC pc)
{
  Reduced *reduced;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &reduced));
  PetscCall(node_blocks_destroy(&reduced->blocks));
  PetscCall(coarse_destroy(&reduced->coarse));
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
  Reduced  *reduced;
  PetscBool more = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &reduced));
  if (reduced->fresh < 0 && (!converged || iterations > SLOW)) PetscCall(multigrid_fill(&more));
  if (reduced->fresh >= 0) reduced->more += iterations - reduced->fresh;
  *stale = (PetscBool)(more || (reduced->fresh >= 0 && (!converged || reduced->more > SET_UP_IN_ITERATIONS)));
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
