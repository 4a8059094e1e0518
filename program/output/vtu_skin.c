/* Per step a VTU file of the skin of general contact, skin_STEP.vtu (text, for ParaView): by facet its side, piece, body, whom it may touch
 * and how far that is; by copy of a node its state, pressure and gap. */
#include "contact/skin.h"
#include "output/output.h"

static void write_faces(FILE *file, const ContactPart *part)
{
  const PetscInt n = part->n_facets[0];
  vtu_start_array(file, "Int64", "connectivity", 1);
  for (PetscInt k = 0; k < part->offsets[0][n]; k++)
    fprintf(file, "%d\n", (int)part->facet_nodes[0][k]);
  vtu_end_array(file);
  vtu_start_array(file, "Int64", "offsets", 1);
  for (PetscInt f = 0; f < n; f++)
    fprintf(file, "%d\n", (int)part->offsets[0][f + 1]);
  vtu_end_array(file);
  vtu_start_array(file, "UInt8", "types", 1);
  for (PetscInt f = 0; f < n; f++)
    fprintf(file, "%d\n", vtu_type(cell_kind(part->dimension - 1, part->offsets[0][f + 1] - part->offsets[0][f])));
  vtu_end_array(file);
}

static void whole_numbers(FILE *file, const char *name, PetscInt n, const int64_t values[])
{
  vtu_start_array(file, "Int64", name, 1);
  for (PetscInt f = 0; f < n; f++)
    fprintf(file, "%lld\n", (long long)values[f]);
  vtu_end_array(file);
}

/* side: 0 none, 1 it has the multipliers, 2 opposite of them; pair: number of bodies times the smaller number, and the larger one */
static void write_facets(FILE *file, const Mesh *mesh, PetscInt n, const SkinFacets *facets)
{
  vtu_start_array(file, "Int32", "side", 1);
  for (PetscInt f = 0; f < n; f++)
    fprintf(file, "%d\n", (int)facets->side[f]);
  vtu_end_array(file);
  whole_numbers(file, "piece", n, facets->piece);
  whole_numbers(file, "body", n, facets->body);
  vtu_start_array(file, "Int64", "partner", 1);
  for (PetscInt f = 0; f < n; f++)
    fprintf(file, "%d\n", facets->partner[f] < 0 ? -1 : (int)facets->body[facets->partner[f]]);
  vtu_end_array(file);
  vtu_start_array(file, "Int64", "pair", 1);
  for (PetscInt f = 0; f < n; f++) {
    const int64_t own = facets->body[f], other = facets->partner[f] < 0 ? -1 : facets->body[facets->partner[f]];
    fprintf(file, "%lld\n", other < 0 ? -1 : (long long)(mesh->n_bodies * PetscMin(own, other) + PetscMax(own, other)));
  }
  vtu_end_array(file);
  vtu_start_array(file, "Float64", "distance", 1);
  for (PetscInt f = 0; f < n; f++)
    fprintf(file, "%.17g\n", facets->partner[f] < 0 ? (double)NAN : facets->distance[f]);
  vtu_end_array(file);
}

static void write_nodes(FILE *file, PetscInt n, const SkinNode nodes[])
{
  vtu_start_array(file, "Int32", "state", 1);
  for (PetscInt a = 0; a < n; a++)
    fprintf(file, "%d\n", (int)nodes[a].state);
  vtu_end_array(file);
  vtu_start_array(file, "Float64", "pressure", 1);
  for (PetscInt a = 0; a < n; a++)
    fprintf(file, "%.17g\n", skin_pressure(&nodes[a]));
  vtu_end_array(file);
  vtu_start_array(file, "Float64", "gap", 1); /* of what can touch nothing there is none */
  for (PetscInt a = 0; a < n; a++)
    fprintf(file, "%.17g\n", nodes[a].coverage > 0 ? nodes[a].gap / nodes[a].coverage : (double)NAN);
  vtu_end_array(file);
}

static PetscErrorCode write_skin(const Output *output, const Interface *interface, const SkinNode nodes[], PetscInt step)
{
  const ContactPart *part = &interface->part;
  char               path[PETSC_MAX_PATH_LEN];
  PetscScalar       *X, *u;
  SkinFacets         facets;
  FILE              *file;
  PetscFunctionBegin;
  PetscCall(skin_facets(part, &facets));
  PetscCall(PetscMalloc2(3 * part->n1, &X, 3 * part->n1, &u));
  for (PetscInt a = 0; a < part->n1; a++) {
    contact_vector(part->dimension, part->X, a, X + 3 * a);
    PetscCall(PetscArraycpy(u + 3 * a, nodes[a].displacement, 3));
  }
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/skin_%" PetscInt_FMT ".vtu", output->directory, step));
  file = fopen(path, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  fprintf(file, "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
                "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n"
                "</FieldData>\n<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n<Points>\n",
          (double)output->physics->t, (int)part->n1, (int)part->n_facets[0]);
  vtu_vectors(file, "X", part->n1, X);
  fprintf(file, "</Points>\n<Cells>\n");
  write_faces(file, part);
  fprintf(file, "</Cells>\n<PointData Vectors=\"displacement\">\n");
  vtu_vectors(file, "displacement", part->n1, u);
  write_nodes(file, part->n1, nodes);
  fprintf(file, "</PointData>\n<CellData>\n");
  write_facets(file, output->mesh, part->n_facets[0], &facets);
  fprintf(file, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  fclose(file);
  PetscCall(PetscFree2(X, u));
  PetscCall(skin_facets_destroy(&facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By the rank that has the skin. */
PetscErrorCode vtu_skin(const Output *output, PetscInt step)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++) {
    const Interface *interface = &output->contact->interfaces[i];
    SkinNode        *nodes;
    if (!interface->skin) continue;
    PetscCall(skin_nodes(interface, &nodes));
    if (interface->part.skin) PetscCall(write_skin(output, interface, nodes, step));
    PetscCall(PetscFree(nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
