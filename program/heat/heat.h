/* Heat: temperatures of the bodies, which pass through interfaces by the library's weights, and what the bodies expand by. Solved
 * in turns with the mechanics: at fixed displacements and tractions the temperatures of a step are a linear system. Without `heat`
 * in the scene nothing of this room does anything. */
#ifndef STICKSLIP_PROGRAM_HEAT_H
#define STICKSLIP_PROGRAM_HEAT_H
#include "solve/solve.h"

/* What a body is for heat; without conductivity it keeps the temperature that it starts with. */
typedef struct {
  PetscReal conductivity, capacity, expansion; /* [F/(T K)], of a volume [F/(L^2 K)], [1/K] */
} Conductor;

/* A temperature that is prescribed, or a heat that flows in per area, on surfaces. */
typedef struct {
  char           name[NAME_LENGTH];
  PetscBool      flows;
  PetscReal      value;
  Curve          curve;
  PetscInt       n_surfaces;
  const Surface **surfaces; /* of the piece, until the mesh is distributed */
  PetscInt       n_faces, *faces; /* of a flow: this rank's */
  PetscReal      heat;      /* what came in through it in the last step [F L/T] */
} HeatSupport;

/* One interface. */
typedef struct {
  PetscBool     passes;  /* else it is adiabatic */
  stickslip_heat law;
  PetscReal     across, friction; /* what passed in the last step from the non-mortar to the mortar body, what friction made [F L/T] */
  double        *temperatures;     /* rank 0: of the non-mortar nodes, as last collected */
} HeatInterface;

/* A rigid body, or a surface in closed form: it has one temperature */
typedef struct {
  PetscInt  body, equation, leader; /* -1: it has none, and keeps what it is given; in local vectors its last vertex, -1: another rank owns it */
  PetscInt  n, *entries;            /* in local vectors: all its vertices */
  PetscReal temperature, taken;     /* of the last step; what it took from its interfaces [F L/T] */
} HeatTool;

/* Entries of the matrix, in an order that PETSc takes them in */
typedef struct {
  PetscCount   n, room;
  PetscInt    *rows, *columns;
  PetscScalar *values;
} HeatEntries;

typedef struct {
  Mesh          *mesh;
  Physics       *physics;
  Contact       *contact;
  PetscBool      on, two_way;
  PetscReal      initial, tolerance;
  PetscInt       most;          /* turns in a step */
  Conductor     *bodies;
  PetscInt       n_supports;
  HeatSupport   *supports;
  HeatInterface *interfaces;
  PetscInt       n_tools;
  HeatTool      *tools;
  DM             dm;            /* one temperature a vertex */
  PetscSection   section;
  const PetscInt *equations;    /* of each local entry, -1: prescribed */
  PetscInt       *support_of;   /* per vertex here: which temperature prescribes it; -1: none */
  Vec            now, before;   /* local: temperatures, and those of t_n */
  Vec            wide;          /* local, of the mechanics: a number a vertex in place of the first displacement */
  PetscInt       turns;         /* of the last step */
  PetscReal      residual;      /* of its last solution, over the largest heat */
  char           refusal[1100]; /* why the temperatures of this attempt are not found; with the library's words, if it refused them */
} Heat;

/* heat_scene.c */
PetscErrorCode heat_read(Scene *scene, Heat *heat);
/* labels before the mesh is distributed */
PetscErrorCode heat_label(Heat *heat);
/* heat.c */
PetscErrorCode heat_create(Heat *heat);
PetscErrorCode heat_destroy(Heat *heat);
/* at the start of an attempt: temperatures of t_n, prescribed ones of t, and what the bodies expand by */
PetscErrorCode heat_begin(Heat *heat, PetscReal t);
/* the temperatures at the mechanics of now; by how much the largest has changed, over their range. `status` > 0: refused, for the
 * reason in heat->refusal; if it was the library, that is in contact->refusal */
PetscErrorCode heat_solve(Heat *heat, PetscReal dt, PetscReal *change, PetscInt *status);
PetscErrorCode heat_accept(Heat *heat);
/* conduction.c: adds what bodies and supports of heat have to what leaves the vertices, and to the entries */
PetscErrorCode conduction_add(Heat *heat, PetscReal dt, PetscScalar *leaves, HeatEntries *entries);
PetscErrorCode conduction_faces(Heat *heat);
/* gradients at a Gauss point of a cell, N, and the volume that it stands for */
PetscReal      conduction_point(CellKind kind, const Space *space, const PetscReal X[], PetscInt q, PetscReal N[], PetscReal dN[][3], PetscReal *radius);
/* of this rank's cell: its kind, and where its temperatures lie in a local vector */
PetscErrorCode conduction_cell(const Heat *heat, PetscInt c, CellKind *kind, PetscInt *n, PetscInt at[]);
/* expansion.c: by the temperatures of now: of linear bodies into physics->f_thermal, of finite strain into physics->cells.swell */
PetscErrorCode expansion_create(Heat *heat);
PetscErrorCode expansion_apply(Heat *heat);
/* of the nodes of this rank's cell: what its stress is less by for its temperature; 0 of finite strain, whose stress has it */
PetscErrorCode expansion_pressures(const Heat *heat, PetscInt cell, PetscReal pressures[]);
/* tools.c: rigid bodies and surfaces in closed form; does this vertex have the equation of one that stores heat? */
PetscBool      tool_is(const Mesh *mesh, PetscInt body);
PetscBool      tool_leads(const Heat *heat, PetscInt vertex);
PetscErrorCode tools_create(Heat *heat);
PetscErrorCode tools_destroy(Heat *heat);
void           tools_number(const Heat *heat, PetscScalar numbers[]); /* of their vertices: the equation that they share */
PetscErrorCode tools_balance(Heat *heat, PetscReal dt, PetscScalar *leaves, HeatEntries *entries); /* after the interfaces */
PetscErrorCode tools_spread(Heat *heat);                              /* after a change of the temperatures */
/* across.c: the same of the interfaces */
PetscErrorCode across_add(Heat *heat, PetscReal dt, PetscScalar *leaves, HeatEntries *entries, PetscInt *status);
PetscErrorCode heat_collect(Heat *heat);
PetscErrorCode heat_widen(const Heat *heat, const PetscScalar *from); /* of a local vector of temperatures, into heat->wide */
/* restart.c: the temperatures of t_n */
PetscErrorCode heat_archive(Heat *heat, Archive *archive);
/* entries.c */
PetscErrorCode entries_add(HeatEntries *entries, PetscInt row, PetscInt column, PetscScalar value);
PetscErrorCode entries_destroy(HeatEntries *entries);
/* probe.c: on every rank, of a vertex by its number; of this rank's vertices */
PetscErrorCode heat_temperature(const Heat *heat, PetscInt number, PetscReal *temperature);
PetscErrorCode heat_of_vertices(const Heat *heat, PetscReal temperatures[]);
#endif
