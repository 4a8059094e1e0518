/* The reduced form of the condensed matrix, for multigrid: what the library says that takes the constraints apart from the
 * rest. With E_L, E_R and Q of it, E_L J E_R has the constraints on its diagonal, and elasticity beside them. */
#include "contact/contact.h"

static const int32_t PIECES[N_REDUCTION] = {[REDUCTION_ROWS]        = STICKSLIP_CONDENSED_REDUCTION_ROWS,
                                            [REDUCTION_COLUMNS]     = STICKSLIP_CONDENSED_REDUCTION_COLUMNS,
                                            [REDUCTION_CONSTRAINED] = STICKSLIP_CONDENSED_CONSTRAINED,
                                            [REDUCTION_DIAGONAL]    = STICKSLIP_CONDENSED_CONSTRAINT_DIAGONAL};

PetscErrorCode reduction_destroy(Contact *contact)
{
  PetscFunctionBegin;
  for (int k = 0; k < N_REDUCTION; k++)
    PetscCall(MatDestroy(&contact->reduction[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the condensed matrix was made, and like it. */
PetscErrorCode reduction_make(Contact *contact, Mat like, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  if (!contact->reduced) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(reduction_destroy(contact));
  for (int k = 0; k < N_REDUCTION && !*status; k++)
    PetscCall(condensed_piece(contact, PIECES[k], like, &contact->reduction[k], status));
  PetscFunctionReturn(PETSC_SUCCESS);
}
