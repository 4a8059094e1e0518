/* Per step and rigid body a VTU file of its surfaces, rigid_NAME_STEP.vtu (text, for ParaView). Written on rank 0. */
#include "output/output.h"

static void write_faces(FILE *file, PetscInt dimension, const Shell *shell)
{
  vtu_start_array(file, "Int64", "connectivity", 1);
  for (PetscInt k = 0; k < shell->offsets[shell->n_faces]; k++)
    fprintf(file, "%d\n", (int)shell->vertices[k]);
  vtu_end_array(file);
  vtu_start_array(file, "Int64", "offsets", 1);
  for (PetscInt f = 0; f < shell->n_faces; f++)
    fprintf(file, "%d\n", (int)shell->offsets[f + 1]);
  vtu_end_array(file);
  vtu_start_array(file, "UInt8", "types", 1);
  for (PetscInt f = 0; f < shell->n_faces; f++)
    fprintf(file, "%d\n", vtu_type(cell_kind(dimension - 1, shell->offsets[f + 1] - shell->offsets[f])));
  vtu_end_array(file);
}

static PetscErrorCode write_body(const Output *output, const Rigid *rigid, PetscInt step)
{
  const Mesh  *mesh  = output->mesh;
  const Shell *shell = &mesh->bodies[rigid->body].shell;
  char         path[PETSC_MAX_PATH_LEN];
  PetscScalar *u;
  FILE        *file;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * shell->n_vertices, &u));
  PetscCall(rigids_displacements(rigid, shell->n_vertices, shell->coordinates, u));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/rigid_%s_%" PetscInt_FMT ".vtu", output->directory, mesh->bodies[rigid->body].name,
                          step));
  file = fopen(path, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(file, "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
                "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n"
                "</FieldData>\n<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n<Points>\n",
          (double)output->physics->t, (int)shell->n_vertices, (int)shell->n_faces);
  vtu_vectors(file, "X", shell->n_vertices, shell->coordinates);
  fprintf(file, "</Points>\n<Cells>\n");
  write_faces(file, mesh->dimension, shell);
  fprintf(file, "</Cells>\n<PointData Vectors=\"displacement\">\n");
  vtu_vectors(file, "displacement", shell->n_vertices, u);
  fprintf(file, "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  fclose(file);
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode vtu_rigids(const Output *output, PetscInt step)
{
  const Physics *physics = output->physics;
  PetscFunctionBegin;
  for (PetscInt r = 0; r < physics->n_rigids && output->mesh->rank == 0; r++) { /* a surface in closed form has no faces */
    if (output->mesh->bodies[physics->rigids[r].body].shell.n_faces) PetscCall(write_body(output, &physics->rigids[r], step));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
