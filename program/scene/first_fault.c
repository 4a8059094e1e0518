/* A fault that any rank may find in its piece of the mesh. */
#include "scene/scene_private.h"

PetscErrorCode scene_fail_first(Scene *scene, PetscInt number, const char *map, const char *key, const char *text)
{
  char        words[3][1024] = {"", "", ""};
  PetscInt    least          = number < 0 ? PETSC_MAX_INT : number, mine = least;
  PetscMPIInt size, rank, speaker;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_INT, MPI_MIN, PETSC_COMM_WORLD));
  if (least == PETSC_MAX_INT) PetscFunctionReturn(PETSC_SUCCESS);
  speaker = mine == least ? rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  if (rank == speaker) {
    PetscCall(PetscSNPrintf(words[0], sizeof(words[0]), "%s", map));
    PetscCall(PetscSNPrintf(words[1], sizeof(words[1]), "%s", key ? key : ""));
    PetscCall(PetscSNPrintf(words[2], sizeof(words[2]), "%s", text));
  }
  PetscCallMPI(MPI_Bcast(words, sizeof(words), MPI_CHAR, speaker, PETSC_COMM_WORLD));
  scene_fail(scene, words[0], words[1][0] ? words[1] : NULL, "%s", words[2]);
}
