/* Per step one VTU file of the bodies (text, for ParaView). Written on rank 0. */
#include "output/output.h"

/* VTK's number of a kind of cell */
static int vtk_type(CellKind kind)
{
  static const int types[CELL_KINDS] = {
      [LINE2] = 3, [LINE3] = 21, /* VTK_LINE, VTK_QUADRATIC_EDGE */
      [TRI3] = 5,  [TRI6] = 22,  /* VTK_TRIANGLE, VTK_QUADRATIC_TRIANGLE */
      [QUAD4] = 9, [QUAD8] = 23, [QUAD9] = 28, /* VTK_QUAD, VTK_QUADRATIC_QUAD, VTK_BIQUADRATIC_QUAD */
      [TET4] = 10, [TET10] = 24, /* VTK_TETRA, VTK_QUADRATIC_TETRA */
      [HEX8] = 12, [HEX20] = 25, [HEX27] = 29, /* VTK_HEXAHEDRON, VTK_QUADRATIC_, VTK_TRIQUADRATIC_HEXAHEDRON */
  };
  return types[kind];
}

/* Of one interface: multiplier, force of the contact on the node (both sides), that force over the node's area, its part
 * along the normal (non-mortar side), and state (-1 off the non-mortar side). */
static PetscErrorCode interface_fields(FILE *file, const Mesh *mesh, const Interface *interface)
{
  const PetscInt n_both = interface->n1 + interface->n2;
  PetscScalar   *field;
  PetscInt      *state;
  double        *tractions;
  const ContactStates *states = &interface->states;
  char           name[2 * NAME_LENGTH];

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(3 * mesh->n_vertices, &field, mesh->n_vertices, &state));
  for (PetscInt k = 0; k < 3 * interface->n1; k++)
    field[3 * interface->nodes[k / 3] + k % 3] = states->multiplier[k];
  PetscCall(PetscSNPrintf(name, sizeof(name), "multiplier_%s", interface->name));
  vtu_vectors(file, name, mesh->n_vertices, field);

  PetscCall(PetscArrayzero(field, 3 * mesh->n_vertices));
  for (PetscInt a = 0; a < n_both; a++) {
    PetscReal force[3];
    contact_vector(interface->dimension, interface->forces, a, force);
    for (int i = 0; i < 3; i++)
      field[3 * interface->nodes[a] + i] = -force[i];
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "force_%s", interface->name));
  vtu_vectors(file, name, mesh->n_vertices, field);

  PetscCall(PetscArrayzero(field, 3 * mesh->n_vertices));
  PetscCall(PetscMalloc1(3 * interface->n1, &tractions));
  PetscCall(nodal_tractions(mesh, interface, states, tractions));
  for (PetscInt k = 0; k < 3 * interface->n1; k++)
    field[3 * interface->nodes[k / 3] + k % 3] = tractions[k];
  PetscCall(PetscSNPrintf(name, sizeof(name), "traction_%s", interface->name));
  vtu_vectors(file, name, mesh->n_vertices, field);

  PetscCall(PetscArrayzero(field, mesh->n_vertices));
  for (PetscInt k = 0; k < 3 * interface->n1; k++)
    field[interface->nodes[k / 3]] += tractions[k] * states->normal[k];
  PetscCall(PetscFree(tractions));
  PetscCall(PetscSNPrintf(name, sizeof(name), "pressure_%s", interface->name));
  vtu_start_array(file, "Float64", name, 1);
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    fprintf(file, "%.17g\n", PetscRealPart(field[v]));
  vtu_end_array(file);

  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    state[v] = -1;
  for (PetscInt a = 0; a < interface->n1; a++)
    state[interface->nodes[a]] = states->state[a];
  PetscCall(PetscSNPrintf(name, sizeof(name), "state_%s", interface->name));
  vtu_start_array(file, "Int32", name, 1);
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    fprintf(file, "%d\n", (int)state[v]);
  vtu_end_array(file);
  PetscCall(PetscFree2(field, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is drawn: cells of bodies, or faces of the surfaces of rigid ones. */
typedef struct {
  PetscInt        n, *body, *size, *type;
  const PetscInt **nodes;
} Drawing;

static void draw(Drawing *drawing, PetscInt body, CellKind kind, const PetscInt *nodes)
{
  drawing->body[drawing->n]    = body;
  drawing->size[drawing->n]    = cell_nodes(kind);
  drawing->type[drawing->n]    = vtk_type(kind);
  drawing->nodes[drawing->n++] = nodes;
}

static PetscErrorCode create_drawing(const Mesh *mesh, Drawing *drawing)
{
  PetscInt most = mesh->n_cells;
  PetscFunctionBegin;
  for (PetscInt s = 0; s < mesh->n_surfaces; s++)
    most += mesh->surfaces[s].n_faces;
  *drawing = (Drawing){.n = 0};
  PetscCall(PetscMalloc4(most, &drawing->body, most, &drawing->size, most, &drawing->type, most, &drawing->nodes));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (!mesh->bodies[mesh->cell_body[c]].rigid)
      draw(drawing, mesh->cell_body[c], mesh_cell_kind(mesh, c), mesh->cell_vertices + mesh->cell_offsets[c]);
  }
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    for (PetscInt s = mesh->bodies[b].first_surface; s < mesh->bodies[b].end_surface && mesh->bodies[b].rigid; s++) {
      const Surface *surface = &mesh->surfaces[s];
      for (PetscInt f = 0; f < surface->n_faces; f++)
        draw(drawing, b, mesh_face_kind(mesh, surface, f), surface->vertices + surface->offsets[f]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy_drawing(Drawing *drawing)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(drawing->body, drawing->size, drawing->type, drawing->nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode vtu_write(Output *output, const PetscScalar *displacements, PetscInt step)
{
  const Mesh *mesh = output->mesh;
  char        path[PETSC_MAX_PATH_LEN];
  Drawing     drawing;
  PetscInt    end = 0;
  FILE       *file;

  PetscFunctionBegin;
  PetscCall(create_drawing(mesh, &drawing));
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
          (int)drawing.n);
  vtu_vectors(file, "X", mesh->n_vertices, mesh->coordinates);
  fprintf(file, "</Points>\n<Cells>\n");
  vtu_start_array(file, "Int64", "connectivity", 1);
  for (PetscInt c = 0; c < drawing.n; c++) {
    for (PetscInt k = 0; k < drawing.size[c]; k++)
      fprintf(file, "%d ", (int)drawing.nodes[c][k]);
    fprintf(file, "\n");
  }
  vtu_end_array(file);
  vtu_start_array(file, "Int64", "offsets", 1);
  for (PetscInt c = 0; c < drawing.n; c++)
    fprintf(file, "%d\n", (int)(end += drawing.size[c]));
  vtu_end_array(file);
  vtu_start_array(file, "UInt8", "types", 1);
  for (PetscInt c = 0; c < drawing.n; c++)
    fprintf(file, "%d\n", (int)drawing.type[c]);
  vtu_end_array(file);
  fprintf(file, "</Cells>\n<PointData Vectors=\"displacement\">\n");
  vtu_vectors(file, "displacement", mesh->n_vertices, displacements);
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++)
    PetscCall(interface_fields(file, mesh, &output->contact->interfaces[i]));
  PetscCall(vtu_nodal_stresses(file, mesh, output->physics->materials, displacements));
  fprintf(file, "</PointData>\n<CellData>\n");
  vtu_start_array(file, "Int32", "body", 1);
  for (PetscInt c = 0; c < drawing.n; c++)
    fprintf(file, "%d\n", (int)drawing.body[c]);
  vtu_end_array(file);
  PetscCall(vtu_cell_stresses(file, mesh, output->physics->materials, displacements, drawing.n));
  fprintf(file, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  fclose(file);
  PetscCall(destroy_drawing(&drawing));
  PetscFunctionReturn(PETSC_SUCCESS);
}
