/* What a run leaves: summary.json, a line per step, CSV and VTU files. */
#ifndef STICKSLIP_PROGRAM_OUTPUT_H
#define STICKSLIP_PROGRAM_OUTPUT_H
#include "heat/heat.h"
#include <stdio.h>

typedef struct {
  char     name[NAME_LENGTH];
  PetscInt vertex;
} Probe;

typedef enum { WRITE_NONE, WRITE_LAST, WRITE_TIMES, WRITE_ALL } WriteWhen;

typedef struct {
  Mesh        *mesh;
  Physics     *physics;
  Contact     *contact;
  Solve       *solve;
  Heat        *heat;
  const char  *scene, *directory; /* name of the scene's file; where results go */
  PetscBool    quiet;
  WriteWhen    write_vtu, write_csv;
  PetscInt     n_probes;
  Probe       *probes;
  PetscInt     restart_every, restart_keep; /* steps between restart files, 0: there are none; how many are kept, 0: all */
  PetscLogDouble started; /* the run */
} Output;

/* output.c */
PetscErrorCode output_read(Scene *scene, Output *output);
PetscErrorCode output_destroy(Output *output);

/* summary.c */
typedef struct Summary Summary;
PetscErrorCode         summary_create(Output *output, Summary **summary);
PetscErrorCode         summary_step(Output *output, Summary *summary, PetscInt step, PetscBool converged,
                                    PetscBool asked, PetscBool last);
PetscErrorCode         summary_failed_attempt(Output *output, Summary *summary, PetscReal t_last);
PetscErrorCode summary_settle_step(Output *output, Summary *summary, PetscBool accepted); /* the last one */
PetscErrorCode energy_archive(const Output *output, Archive *archive); /* energy.csv, up to here */
PetscErrorCode summary_archive(Summary *summary, Archive *archive); /* of the steps before */
PetscErrorCode summary_write(Output *output, Summary **summary, Vec last, PetscInt cutbacks, const char *message);

/* acting.c: of a step, to its entry */
PetscErrorCode acting_report(Output *output, struct cJSON *step);

/* sensitivity_results.c: likewise, of what the scene wants to know the influence of */
PetscErrorCode sensitivity_report(const Output *output, struct cJSON *step);

/* energy.c: with `dynamics` */
PetscErrorCode energy_begin(const Output *output);
PetscErrorCode energy_report(const Output *output, PetscReal friction, struct cJSON *step);
PetscErrorCode energy_settle(const Output *output);
/* energy_told.c: likewise; of an accepted step, and whether a converged one counts: why not */
PetscErrorCode energy_tell(const Output *output);
PetscErrorCode energy_check(const Output *output, PetscBool *late, char why[], size_t length);
void           energy_summary(const Output *output, struct cJSON *root);

/* uniqueness.c: of a node with friction */
PetscErrorCode uniqueness_check(Output *output, Vec x, struct cJSON *root);
/* redundant_report.c: multipliers that are left out */
PetscErrorCode redundant_report(const Output *output, struct cJSON *root);
/* skin_report.c: of general contact; in words */
PetscErrorCode skin_report(const Output *output, struct cJSON *root);
PetscErrorCode skin_report_tell(const Output *output, const struct cJSON *root);
/* counters.c: what the run and each interface cost */
PetscErrorCode summary_counters(Output *output, struct cJSON *root);
/* holdings.c: what each rank holds */
PetscErrorCode summary_holdings(const Output *output, struct cJSON *root);
/* diagnosis.c: what may be wrong; told and kept */
PetscErrorCode diagnosis_failed(Output *output, struct cJSON *root);
/* tractions.c */
PetscErrorCode nodal_tractions(const Mesh *mesh, const Interface *interface, const ContactStates *states,
                               double tractions[]);
/* heat_results.c: of a step, to its entry; of nothing where the scene has no heat */
PetscErrorCode heat_results(const Output *output, struct cJSON *step);
/* csv.c */
PetscErrorCode csv_adjusted(Output *output, const Interface *interface); /* once */
/* `temperatures`: of the non-mortar nodes, or NULL */
PetscErrorCode csv_write(Output *output, const Interface *interface, const ContactStates *states, const double *temperatures,
                         PetscInt step);
/* vtu_array.c */
int            vtu_type(CellKind kind);
void           vtu_start_array(FILE *file, const char *type, const char *name, int components);
void           vtu_end_array(FILE *file);
void           vtu_vectors(FILE *file, const char *name, PetscInt n, const PetscScalar *values);
void           vtu_declare(FILE *file, const char *type, const char *name, int components); /* in the index of all ranks' files */
/* vtu_piece.c: this rank's vertices and cells, in the order of their numbers */
typedef struct {
  PetscInt     n_points, n_cells;
  PetscInt    *order;        /* n_points: which vertex here */
  PetscInt    *place;        /* per vertex here: in that order */
  PetscInt    *cells;        /* n_cells: which cell here */
  PetscInt    *connectivity; /* of the cells here, at `offsets` of physics->cells, in VTK's order */
  PetscScalar *displacements; /* 3 a point */
  PetscReal   *X;
} Piece;

PetscErrorCode piece_create(const Physics *physics, Piece *piece);
PetscErrorCode piece_destroy(Piece *piece);
/* `width` numbers of each node of an interface (rank 0) at the points of the piece, `none` elsewhere */
PetscErrorCode piece_fetch(const Physics *physics, const Piece *piece, PetscInt n, const PetscInt nodes[], PetscInt width,
                           const double values[], double none, double at_points[]);
/* vtu_stress.c */
void           vtu_declare_stresses(FILE *file);
PetscErrorCode vtu_cell_stresses(FILE *file, const Heat *heat, const Physics *physics, const Piece *piece);
PetscErrorCode vtu_nodal_stresses(FILE *file, const Heat *heat, const Physics *physics, const Piece *piece);
/* vtu_rigid.c */
PetscErrorCode vtu_rigids(const Output *output, PetscInt step);
/* vtu_skin.c: of general contact */
PetscErrorCode vtu_skin(const Output *output, PetscInt step);
/* vtu.c: on every rank */
PetscErrorCode vtu_write(Output *output, PetscInt step);
#endif
