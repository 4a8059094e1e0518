/* The few names that changed between PETSc 3.18 and later versions. */
#ifndef STICKSLIP_PROGRAM_PETSC_COMPAT_H
#define STICKSLIP_PROGRAM_PETSC_COMPAT_H
#include <petscsys.h>

#if defined(PETSC_USE_COMPLEX) || !defined(PETSC_USE_REAL_DOUBLE)
  #error "stickslip needs a PETSc of real double numbers"
#endif
#if PETSC_VERSION_LT(3, 19, 0) && !defined(PETSC_SUCCESS)
#  define PETSC_SUCCESS 0
#endif
#if PETSC_VERSION_GE(3, 24, 0) /* a PetscBool is a bool, and no more as large as an enum */
#  undef MPIU_BOOL
#  define MPIU_BOOL MPI_C_BOOL
#endif
#if PETSC_VERSION_LT(3, 25, 0)
#  define SNES_DIVERGED_FUNCTION_NANORINF SNES_DIVERGED_FNORM_NAN
#endif
#endif
