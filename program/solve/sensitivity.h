/* How what a run gives follows parameters of its scene: `parameters` (parameters_scene.c, sensitivity.c, sensitivity_outputs.c).
 *
 * Step n ends where R(y_n, u_{n-1}, theta) = 0 with unknowns y: displacements u and multipliers. So along one parameter
 *
 *   K_n dy_n = - (dR/du_{n-1} du_{n-1} + dR/dtheta)
 *
 * with the tangent K_n at the end of the step (docs/formulation, 18): one factorisation a step, and a solve a parameter. */
#ifndef STICKSLIP_PROGRAM_SENSITIVITY_H
#define STICKSLIP_PROGRAM_SENSITIVITY_H
#include "solve/solve.h"

typedef enum {
  PARAMETER_FRICTION,    /* an interface's coefficient of friction */
  PARAMETER_SHEAR_LIMIT, /* its largest shear traction */
  PARAMETER_OFFSET,      /* what all non-mortar nodes are offset by */
  PARAMETER_YOUNG,       /* a body's E */
  PARAMETER_LOAD,        /* a factor on a load, 1 as it is */
  PARAMETER_SUPPORT,     /* a factor on what a support prescribes, 1 as it is */
  N_PARAMETER_KINDS
} ParameterKind;

typedef struct {
  char          name[NAME_LENGTH];
  ParameterKind kind;
  PetscInt      number;      /* of the interface, body, load or support */
  PetscReal     deviation;   /* its standard deviation; 0: it is known */
  Vec           last, now;   /* local: derivatives of displacements and multipliers at t_n, at the end of the step */
  PetscReal    *reactions;   /* of each support, 3 numbers: derivatives at the end of the step */
} Parameter;

struct Sensitivity {
  PetscInt   n;
  Parameter *parameters;
  Vec        forces;    /* local: work space */
  PetscReal  imbalance; /* of derivatives of forces where nothing is prescribed, over their parts: what rounding leaves, of the last step */
};

/* parameters_scene.c; NULL: the scene asks for none */
PetscErrorCode sensitivity_read(Scene *scene, Solve *solve);
void           sensitivity_refuse(Scene *scene, const Solve *solve, PetscBool wrong, const char *what);
PetscErrorCode sensitivity_destroy(Solve *solve);

/* sensitivity.c: where the step has converged, at x; once it is accepted; `status` > 0: the library refused */
PetscErrorCode sensitivity_create(Scene *scene, Solve *solve);
PetscErrorCode sensitivity_solve(Solve *solve, Vec x, PetscInt *status);
PetscErrorCode sensitivity_accept(Solve *solve);
PetscErrorCode sensitivity_archive(Solve *solve, Archive *archive);
#endif
