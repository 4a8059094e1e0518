/* How an interface is covered, over all its parts: the sentences are the library's where there is one part. */
#include "contact/contact.h"
#include <stdio.h>
#include <string.h>

/* by STICKSLIP_COVER_..., and those that have no multiplier */
enum { N_COVERS = 4, WITHOUT = N_COVERS };

/* How many of the rank's own nodes have each cover. */
static void count(const ContactPart *part, const int32_t cover[], int64_t counts[])
{
  for (PetscInt a = 0; a < part->n1; a++) {
    if (part->owned[a] == STICKSLIP_NODE_OWN) counts[part->middle[a] ? WITHOUT : cover[a]]++;
  }
}

static PetscBool is_mistake(int32_t finding)
{
  return (PetscBool)(finding == STICKSLIP_FINDING_BEHIND || finding == STICKSLIP_FINDING_SAME_WAY);
}

/* At the part's positions; a refusal leaves the text empty. */
PetscErrorCode contact_cover(const Interface *interface, stickslip_interface *handle, PetscMPIInt rank, ContactCover *cover,
                             int64_t facets[])
{
  const ContactPart *part = &interface->part;
  stickslip_report   report = {.struct_size = sizeof(report), .text = cover->text, .text_capacity = sizeof(cover->text)};
  int64_t            counts[N_COVERS + 1] = {0}, n;
  struct {
    int rating, rank;
  } speaker = {.rating = 3, .rank = rank};

  PetscFunctionBegin;
  *cover = (ContactCover){.finding = STICKSLIP_FINDING_NONE};
  PetscCall(PetscMalloc1(part->n1, &report.cover));
  report.facets = facets;
  if (handle && !stickslip_interface_report(handle, part->x, MORTAR_OF(part, part->x), &report)) {
    cover->finding     = report.finding;
    cover->penetration = report.penetration;
    speaker.rating     = is_mistake(report.finding) ? 0 : report.finding != STICKSLIP_FINDING_NONE ? 1 : 2;
    count(part, report.cover, counts);
  }
  PetscCall(PetscFree(report.cover));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_2INT, MPI_MINLOC, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, counts, N_COVERS + 1, MPI_INT64_T, MPI_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &cover->penetration, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(&cover->finding, 1, MPI_INT32_T, speaker.rank, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(cover->text, sizeof(cover->text), MPI_CHAR, speaker.rank, PETSC_COMM_WORLD));
  if (interface->n_parts > 1 && speaker.rating < 3) {
    const char *rest = strchr(cover->text, '.'); /* behind the sentence that counts */
    char        finding[sizeof(cover->text)] = "";
    n = counts[STICKSLIP_COVER_NONE] + counts[STICKSLIP_COVER_PART] + counts[STICKSLIP_COVER_FULL] + counts[STICKSLIP_COVER_SEVERAL];
    /* What a part without any cover finds is none where others are covered. */
    if (counts[STICKSLIP_COVER_NONE] < n && (is_mistake(cover->finding) || cover->finding == STICKSLIP_FINDING_NO_OVERLAP))
      cover->finding = STICKSLIP_FINDING_NONE;
    if (counts[STICKSLIP_COVER_NONE] == n && rest) snprintf(finding, sizeof(finding), "%s", rest + 1);
    snprintf(cover->text, sizeof(cover->text),
             "Of %d non-mortar nodes %d are covered in full, %d in part, %d not at all, %d by several layers.%s", (int)n,
             (int)counts[STICKSLIP_COVER_FULL], (int)counts[STICKSLIP_COVER_PART], (int)counts[STICKSLIP_COVER_NONE],
             (int)counts[STICKSLIP_COVER_SEVERAL], finding);
  }
  cover->mistaken = is_mistake(cover->finding);
  PetscFunctionReturn(PETSC_SUCCESS);
}
