/* Per step: one CSV file per interface, and one VTU file of the bodies (ASCII, for ParaView). Written on rank 0. */
#include "output/output.h"
#include <stdio.h>

static const char *const STATE_NAMES[] = {"gap", "stick", "slip"}; /* by STICKSLIP_STATE_* */

PetscErrorCode csv_write(Output *output, const Interface *interface, const ContactStates *states, PetscInt step)
{
  char    path[PETSC_MAX_PATH_LEN];
  double *tractions;
  FILE   *file;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * interface->n1, &tractions));
  PetscCall(nodal_tractions(output->mesh, interface, states, tractions));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/interface_%s_%" PetscInt_FMT ".csv", output->directory,
                          interface->name, step));
  file = fopen(path, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(file, "node,X,Y,Z,ux,uy,uz,nx,ny,nz,lambda_n,lambda_tx,lambda_ty,lambda_tz,gap_weighted,slip_x,slip_y,slip_z,"
                "area_covered,area_full,fx,fy,fz,p_lumped,state,t_lumped_x,t_lumped_y,t_lumped_z\n");
  for (PetscInt a = 0; a < interface->n1; a++) {
    const double *n = states->normal + 3 * a, *lambda = states->multiplier + 3 * a, *slip = states->slip + 3 * a;
    const double *traction = tractions + 3 * a;
    double        lambda_n = 0, pressure = 0, values[23], X[3], u[3], force[3], *v = values;
    contact_vector(interface, interface->X, a, X);
    contact_vector(interface, interface->gathered, a, u);
    contact_vector(interface, interface->forces, a, force);
    for (int i = 0; i < 3; i++) {
      lambda_n += lambda[i] * n[i];
      pressure += traction[i] * n[i];
    }
    for (int i = 0; i < 3; i++)
      *v++ = X[i];
    for (int i = 0; i < 3; i++)
      *v++ = u[i];
    for (int i = 0; i < 3; i++)
      *v++ = n[i];
    *v++ = lambda_n;
    for (int i = 0; i < 3; i++)
      *v++ = lambda[i] - lambda_n * n[i];
    *v++ = states->gap[a];
    for (int i = 0; i < 3; i++)
      *v++ = slip[i];
    *v++ = states->coverage[a];
    *v++ = states->area[a];
    for (int i = 0; i < 3; i++)
      *v++ = -force[i];
    *v++ = pressure;
    fprintf(file, "%d", (int)interface->nodes[a]);
    for (const double *w = values; w < v; w++)
      fprintf(file, ",%.17g", *w);
    fprintf(file, ",%s", interface->middle[a] ? "none" : STATE_NAMES[states->state[a]]);
    for (int i = 0; i < 3; i++)
      fprintf(file, ",%.17g", traction[i] - pressure * n[i]);
    fprintf(file, "\n");
  }
  fclose(file);
  PetscCall(PetscFree(tractions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void start_array(FILE *file, const char *type, const char *name, int components)
{
  fprintf(file, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"ascii\">\n", type, name,
          components);
}

static void end_array(FILE *file)
{
  fprintf(file, "</DataArray>\n");
}

/* One per node, with all digits: 17 give the same number back. */
static void vectors(FILE *file, const char *name, PetscInt n, const PetscScalar *values)
{
  start_array(file, "Float64", name, 3);
  for (PetscInt k = 0; k < n; k++)
    fprintf(file, "%.17g %.17g %.17g\n", PetscRealPart(values[3 * k]), PetscRealPart(values[3 * k + 1]),
            PetscRealPart(values[3 * k + 2]));
  end_array(file);
}

static void cell_stresses(FILE *file, const Mesh *mesh, const Material *materials, const PetscScalar *displacements)
{
  for (int pass = 0; pass < 2; pass++) {
    start_array(file, "Float64", pass ? "von_mises" : "stress_xx_yy_zz_xy_yz_xz", pass ? 1 : 6);
    for (PetscInt c = 0; c < mesh->n_cells; c++) {
      const PetscInt *cell = mesh->cell_vertices + mesh->cell_offsets[c];
      const CellKind  kind = mesh_cell_kind(mesh, c);
      PetscReal X[3 * CELL_NODES], u[3 * CELL_NODES], s[9]; /* s: Cauchy's stress */
      for (PetscInt k = 0; k < 3 * cell_nodes(kind); k++) {
        X[k] = mesh->coordinates[3 * cell[k / 3] + k % 3];
        u[k] = PetscRealPart(displacements[3 * cell[k / 3] + k % 3]);
      }
      cell_centre_stress(kind, &mesh->space, &materials[mesh->cell_body[c]], X, u, s);
      if (pass)
        fprintf(file, "%.6g\n",
                (double)PetscSqrtReal(0.5 * (PetscSqr(s[0] - s[4]) + PetscSqr(s[4] - s[8]) + PetscSqr(s[8] - s[0])) +
                                      3 * (PetscSqr(s[1]) + PetscSqr(s[5]) + PetscSqr(s[2]))));
      else
        fprintf(file, "%.6g %.6g %.6g %.6g %.6g %.6g\n", (double)s[0], (double)s[4], (double)s[8], (double)s[1],
                (double)s[5], (double)s[2]);
    }
    end_array(file);
  }
}

/* VTK's number of a kind of cell */
static int vtk_type(CellKind kind)
{
  static const int types[CELL_KINDS] = {
      [TRI3] = 5,  [TRI6] = 22,  /* VTK_TRIANGLE, VTK_QUADRATIC_TRIANGLE */
      [QUAD4] = 9, [QUAD8] = 23, [QUAD9] = 28, /* VTK_QUAD, VTK_QUADRATIC_QUAD, VTK_BIQUADRATIC_QUAD */
      [TET4] = 10, [TET10] = 24, /* VTK_TETRA, VTK_QUADRATIC_TETRA */
      [HEX8] = 12, [HEX20] = 25, [HEX27] = 29, /* VTK_HEXAHEDRON, VTK_QUADRATIC_, VTK_TRIQUADRATIC_HEXAHEDRON */
  };
  return types[kind];
}

/* Of one interface: multiplier, force of the contact on the node (both sides), that force over the node's area
 * (non-mortar side), and state (-1 off the non-mortar side). */
static PetscErrorCode interface_fields(FILE *file, const Mesh *mesh, const Interface *interface)
{
  const PetscInt n_both = interface->n1 + interface->n2;
  PetscScalar   *field;
  PetscInt      *state;
  double        *tractions;
  ContactStates  states;
  char           name[2 * NAME_LENGTH];

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(3 * mesh->n_vertices, &field, mesh->n_vertices, &state));
  PetscCall(contact_states_create(interface, &states));
  for (PetscInt k = 0; k < 3 * interface->n1; k++)
    field[3 * interface->nodes[k / 3] + k % 3] = states.multiplier[k];
  PetscCall(PetscSNPrintf(name, sizeof(name), "multiplier_%s", interface->name));
  vectors(file, name, mesh->n_vertices, field);

  PetscCall(PetscArrayzero(field, 3 * mesh->n_vertices));
  for (PetscInt a = 0; a < n_both; a++) {
    PetscReal force[3];
    contact_vector(interface, interface->forces, a, force);
    for (int i = 0; i < 3; i++)
      field[3 * interface->nodes[a] + i] = -force[i];
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "force_%s", interface->name));
  vectors(file, name, mesh->n_vertices, field);

  PetscCall(PetscArrayzero(field, 3 * mesh->n_vertices));
  PetscCall(PetscMalloc1(3 * interface->n1, &tractions));
  PetscCall(nodal_tractions(mesh, interface, &states, tractions));
  for (PetscInt k = 0; k < 3 * interface->n1; k++)
    field[3 * interface->nodes[k / 3] + k % 3] = tractions[k];
  PetscCall(PetscFree(tractions));
  PetscCall(PetscSNPrintf(name, sizeof(name), "traction_%s", interface->name));
  vectors(file, name, mesh->n_vertices, field);

  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    state[v] = -1;
  for (PetscInt a = 0; a < interface->n1; a++)
    state[interface->nodes[a]] = states.state[a];
  PetscCall(contact_states_destroy(&states));
  PetscCall(PetscSNPrintf(name, sizeof(name), "state_%s", interface->name));
  start_array(file, "Int32", name, 1);
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    fprintf(file, "%d\n", (int)state[v]);
  end_array(file);
  PetscCall(PetscFree2(field, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode vtu_write(Output *output, const PetscScalar *displacements, PetscInt step)
{
  const Mesh *mesh = output->mesh;
  char        path[PETSC_MAX_PATH_LEN];
  FILE       *file;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/step_%" PetscInt_FMT ".vtu", output->directory, step));
  file = fopen(path, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(file,
          "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n");
  fprintf(file,
          "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
          "format=\"ascii\">%.17g</DataArray>\n</FieldData>\n",
          (double)output->physics->t);
  fprintf(file, "<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n<Points>\n", (int)mesh->n_vertices,
          (int)mesh->n_cells);
  vectors(file, "X", mesh->n_vertices, mesh->coordinates);
  fprintf(file, "</Points>\n<Cells>\n");
  start_array(file, "Int64", "connectivity", 1);
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (PetscInt k = mesh->cell_offsets[c]; k < mesh->cell_offsets[c + 1]; k++)
      fprintf(file, "%d ", (int)mesh->cell_vertices[k]);
    fprintf(file, "\n");
  }
  end_array(file);
  start_array(file, "Int64", "offsets", 1);
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    fprintf(file, "%d\n", (int)mesh->cell_offsets[c + 1]);
  end_array(file);
  start_array(file, "UInt8", "types", 1);
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    fprintf(file, "%d\n", vtk_type(mesh_cell_kind(mesh, c)));
  end_array(file);
  fprintf(file, "</Cells>\n<PointData Vectors=\"displacement\">\n");
  vectors(file, "displacement", mesh->n_vertices, displacements);
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++)
    PetscCall(interface_fields(file, mesh, &output->contact->interfaces[i]));
  fprintf(file, "</PointData>\n<CellData>\n");
  start_array(file, "Int32", "body", 1);
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    fprintf(file, "%d\n", (int)mesh->cell_body[c]);
  end_array(file);
  cell_stresses(file, mesh, output->physics->materials, displacements);
  fprintf(file, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}
