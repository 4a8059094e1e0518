/* Per step a VTU file of the bodies (text, for ParaView), step_STEP.vtu. Of several ranks each writes its cells into
 * step_STEP_RANK.vtu, and step_STEP.pvtu says so. There `node` and `cell` are the numbers that these have on one rank. */
#include "output/output.h"
#include <math.h>

static void scalars(FILE *file, const char *name, PetscInt n, const double values[])
{
  vtu_start_array(file, "Float64", name, 1);
  for (PetscInt k = 0; k < n; k++)
    fprintf(file, "%.17g\n", values[k]);
  vtu_end_array(file);
}

static void integers(FILE *file, const char *name, PetscInt n, const double values[])
{
  vtu_start_array(file, "Int32", name, 1);
  for (PetscInt k = 0; k < n; k++)
    fprintf(file, "%d\n", (int)values[k]);
  vtu_end_array(file);
}

/* what is written of an interface's nodes at home */
enum { MULTIPLIER, FORCE = MULTIPLIER + 3, TRACTION = FORCE + 3, PRESSURE = TRACTION + 3, CLOSED, WORN, DAMAGE, STATE, N_FIELDS };

static PetscErrorCode nodal_fields(const Mesh *mesh, const Interface *interface, double fields[])
{
  const ContactStates *states = &interface->states;
  double              *tractions;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * interface->n1, &tractions));
  PetscCall(nodal_tractions(mesh, interface, states, tractions));
  for (PetscInt a = 0; a < interface->n1 + interface->n2; a++) {
    double   *f = fields + N_FIELDS * a;
    PetscReal force[3];
    contact_vector(interface->dimension, interface->forces, a, force);
    for (int i = 0; i < 3; i++)
      f[FORCE + i] = -force[i];
    f[STATE] = -1;
    if (a >= interface->n1) continue;
    for (int i = 0; i < 3; i++) {
      f[MULTIPLIER + i] = states->multiplier[3 * a + i];
      f[TRACTION + i]   = tractions[3 * a + i];
      f[PRESSURE] += tractions[3 * a + i] * states->normal[3 * a + i];
    }
    f[CLOSED] = states->closed[a];
    f[WORN]   = states->layer[N_LAYER_RESULTS * a + LAYER_WORN];
    f[DAMAGE] = states->layer[N_LAYER_RESULTS * a + LAYER_DAMAGE];
    f[STATE]  = states->state[a];
  }
  PetscCall(PetscFree(tractions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `width` of the fields at the points */
static void take(PetscInt n, const double fields[], int first, int width, double values[])
{
  for (PetscInt k = 0; k < width * n; k++)
    values[k] = fields[N_FIELDS * (k / width) + first + k % width];
}

/* Of one interface: multiplier, force of the contact on the node (both sides), that force over the node's area, its part
 * along the normal, with decisions at points the part of it that is closed (non-mortar side), and state (-1 off the non-mortar
 * side). */
static PetscErrorCode interface_fields(FILE *file, const Physics *physics, const Piece *piece, const Interface *interface)
{
  static const struct {
    const char *name;
    int         first;
  } vectors[] = {{"multiplier", MULTIPLIER}, {"force", FORCE}, {"traction", TRACTION}};
  const PetscInt n = piece->n_points, n_both = interface->n1 + interface->n2;
  double        *nodal, *fields, *values;
  char           name[2 * NAME_LENGTH];

  PetscFunctionBegin;
  PetscCall(PetscCalloc3(N_FIELDS * n_both, &nodal, N_FIELDS * n, &fields, 3 * n, &values));
  PetscCall(nodal_fields(physics->mesh, interface, nodal));
  PetscCall(piece_fetch(physics, piece, n_both, interface->nodes, N_FIELDS, nodal, NAN, fields));
  for (PetscInt k = 0; k < N_FIELDS * n; k++) /* off the interface */
    fields[k] = isnan(fields[N_FIELDS * (k / N_FIELDS) + N_FIELDS - 1]) ? k % N_FIELDS == STATE ? -1 : 0 : fields[k];
  for (int v = 0; v < 3; v++) {
    take(n, fields, vectors[v].first, 3, values);
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_%s", vectors[v].name, interface->name));
    vtu_vectors(file, name, n, values);
  }
  take(n, fields, PRESSURE, 1, values);
  PetscCall(PetscSNPrintf(name, sizeof(name), "pressure_%s", interface->name));
  scalars(file, name, n, values);
  if (decision_is_points(interface)) {
    take(n, fields, CLOSED, 1, values);
    PetscCall(PetscSNPrintf(name, sizeof(name), "closed_%s", interface->name));
    scalars(file, name, n, values);
  }
  for (int k = 0; k < 2 && layer_is_there(interface); k++) {
    take(n, fields, k ? DAMAGE : WORN, 1, values);
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_%s", k ? "damage" : "worn", interface->name));
    scalars(file, name, n, values);
  }
  take(n, fields, STATE, 1, values);
  PetscCall(PetscSNPrintf(name, sizeof(name), "state_%s", interface->name));
  integers(file, name, n, values);
  PetscCall(PetscFree3(nodal, fields, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void write_cells(FILE *file, const Physics *physics, const Piece *piece)
{
  const PetscInt *offsets = physics->cells.offsets;
  PetscInt        end     = 0;
  vtu_start_array(file, "Int64", "connectivity", 1);
  for (PetscInt k = 0; k < piece->n_cells; k++) {
    const PetscInt c = piece->cells[k];
    for (PetscInt a = offsets[c]; a < offsets[c + 1]; a++)
      fprintf(file, "%d ", (int)piece->connectivity[a]);
    fprintf(file, "\n");
  }
  vtu_end_array(file);
  vtu_start_array(file, "Int64", "offsets", 1);
  for (PetscInt k = 0; k < piece->n_cells; k++) {
    end += offsets[piece->cells[k] + 1] - offsets[piece->cells[k]];
    fprintf(file, "%d\n", (int)end);
  }
  vtu_end_array(file);
  vtu_start_array(file, "UInt8", "types", 1);
  for (PetscInt k = 0; k < piece->n_cells; k++) {
    const PetscInt c = piece->cells[k];
    fprintf(file, "%d\n", vtu_type(cell_kind(physics->mesh->dimension, offsets[c + 1] - offsets[c])));
  }
  vtu_end_array(file);
}

/* whole numbers of points or cells, in the piece's order */
static void numbers(FILE *file, const char *name, PetscInt n, const PetscInt order[], const PetscInt values[])
{
  vtu_start_array(file, "Int32", name, 1);
  for (PetscInt k = 0; k < n; k++)
    fprintf(file, "%d\n", (int)values[order[k]]);
  vtu_end_array(file);
}

/* What an earlier run on one rank, or on several, has left under this step's number is not this run's. */
static PetscErrorCode remove_stale(const Output *output, PetscInt step)
{
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/step_%" PetscInt_FMT ".%s", output->directory, step, output->mesh->size > 1 ? "vtu" : "pvtu"));
  (void)remove(path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The files of all ranks, and what is in them. */
static PetscErrorCode write_index(const Output *output, PetscInt step)
{
  char  path[PETSC_MAX_PATH_LEN];
  FILE *file;
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/step_%" PetscInt_FMT ".pvtu", output->directory, step));
  file = fopen(path, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(file, "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
                "<PUnstructuredGrid GhostLevel=\"0\">\n<PPoints>\n");
  vtu_declare(file, "Float64", "X", 3);
  fprintf(file, "</PPoints>\n<PPointData Vectors=\"displacement\">\n");
  vtu_declare(file, "Float64", "displacement", 3);
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++) {
    static const char *const names[]   = {"multiplier", "force", "traction", "pressure", "closed", "state"};
    const Interface         *interface = &output->contact->interfaces[i];
    for (int k = 0; k < 6; k++) {
      char name[2 * NAME_LENGTH];
      if (k == 4 && !decision_is_points(interface)) continue;
      PetscCall(PetscSNPrintf(name, sizeof(name), "%s_%s", names[k], interface->name));
      vtu_declare(file, k < 5 ? "Float64" : "Int32", name, k < 3 ? 3 : 1);
    }
  }
  if (output->heat->on) vtu_declare(file, "Float64", "temperature", 1);
  vtu_declare_stresses(file);
  vtu_declare(file, "Int32", "node", 1);
  fprintf(file, "</PPointData>\n<PCellData>\n");
  vtu_declare(file, "Int32", "body", 1);
  vtu_declare_stresses(file);
  vtu_declare(file, "Int32", "cell", 1);
  fprintf(file, "</PCellData>\n");
  for (PetscMPIInt r = 0; r < output->mesh->size; r++)
    fprintf(file, "<Piece Source=\"step_%d_%d.vtu\"/>\n", (int)step, (int)r);
  fprintf(file, "</PUnstructuredGrid>\n</VTKFile>\n");
  fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode vtu_write(Output *output, PetscInt step)
{
  const Mesh     *mesh    = output->mesh;
  const Physics  *physics = output->physics;
  const PetscBool several = (PetscBool)(mesh->size > 1);
  char            path[PETSC_MAX_PATH_LEN], rank[16] = "";
  Piece           piece;
  FILE           *file;

  PetscFunctionBegin;
  PetscCall(piece_create(physics, &piece));
  if (several) PetscCall(PetscSNPrintf(rank, sizeof(rank), "_%d", (int)mesh->rank));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/step_%" PetscInt_FMT "%s.vtu", output->directory, step, rank));
  file = fopen(path, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(file,
          "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n");
  fprintf(file,
          "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
          "format=\"ascii\">%.17g</DataArray>\n</FieldData>\n",
          (double)physics->t);
  fprintf(file, "<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n<Points>\n", (int)piece.n_points, (int)piece.n_cells);
  vtu_vectors(file, "X", piece.n_points, piece.X);
  fprintf(file, "</Points>\n<Cells>\n");
  write_cells(file, physics, &piece);
  fprintf(file, "</Cells>\n<PointData Vectors=\"displacement\">\n");
  vtu_vectors(file, "displacement", piece.n_points, piece.displacements);
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++)
    PetscCall(interface_fields(file, physics, &piece, &output->contact->interfaces[i]));
  if (output->heat->on) {
    PetscReal *here, *ordered;
    PetscCall(PetscMalloc2(piece.n_points, &here, piece.n_points, &ordered));
    PetscCall(heat_of_vertices(output->heat, here));
    for (PetscInt k = 0; k < piece.n_points; k++)
      ordered[k] = here[piece.order[k]];
    scalars(file, "temperature", piece.n_points, ordered);
    PetscCall(PetscFree2(here, ordered));
  }
  PetscCall(vtu_nodal_stresses(file, output->heat, physics, &piece));
  if (several) numbers(file, "node", piece.n_points, piece.order, mesh->original);
  fprintf(file, "</PointData>\n<CellData>\n");
  numbers(file, "body", piece.n_cells, piece.cells, physics->cells.body);
  PetscCall(vtu_cell_stresses(file, output->heat, physics, &piece));
  if (several) numbers(file, "cell", piece.n_cells, piece.cells, mesh->original_cell);
  fprintf(file, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  fclose(file);
  PetscCall(piece_destroy(&piece));
  if (mesh->rank == 0) PetscCall(remove_stale(output, step));
  if (several && mesh->rank == 0) PetscCall(write_index(output, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}
