/* What each rank holds, for summary.json: of the mesh, and of memory in all. */
#include "output/output.h"
#include <cjson/cJSON.h>
#include <sys/resource.h>

typedef struct {
  double cells, vertices, bytes_read, bytes, resident;
} Holding;

PetscErrorCode summary_holdings(const Output *output, cJSON *root)
{
  const Mesh   *mesh = output->mesh;
  struct rusage usage;
  Holding       mine, *all = NULL;
  PetscFunctionBegin;
  (void)getrusage(RUSAGE_SELF, &usage);
  mine = (Holding){.cells      = output->physics->cells.n,
                   .vertices   = mesh->n_points,
                   .bytes_read = mesh->bytes.read,
                   .bytes      = mesh->bytes.kept,
                   .resident   = 1024.0 * (double)usage.ru_maxrss}; /* which Linux tells in units of 1024 */
  PetscCall(PetscMalloc1(mesh->size, &all));
  PetscCallMPI(MPI_Gather(&mine, sizeof(mine), MPI_BYTE, all, sizeof(mine), MPI_BYTE, 0, PETSC_COMM_WORLD));
  if (mesh->rank == 0) {
    cJSON *json = cJSON_AddObjectToObject(root, "mesh"), *ranks;
    cJSON_AddNumberToObject(json, "cells", mesh->n_all_cells);
    cJSON_AddNumberToObject(json, "vertices", mesh->n_all_vertices);
    ranks = cJSON_AddArrayToObject(json, "ranks");
    for (PetscMPIInt r = 0; r < mesh->size; r++) {
      cJSON *rank = cJSON_CreateObject();
      cJSON_AddNumberToObject(rank, "cells", all[r].cells);
      cJSON_AddNumberToObject(rank, "vertices", all[r].vertices);
      cJSON_AddNumberToObject(rank, "bytes_read", all[r].bytes_read);
      cJSON_AddNumberToObject(rank, "bytes", all[r].bytes);
      cJSON_AddNumberToObject(rank, "resident_most", all[r].resident);
      cJSON_AddItemToArray(ranks, rank);
    }
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
