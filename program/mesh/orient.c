/* Faces that no cell tells inside from outside: neighbours turn alike, and closed surfaces have their body inside. Open ones turn
 * as their first face does. `flip: true` turns all of them round. */
#include "mesh/mesh.h"

enum { SIDES = 4 }; /* of a face, at most */

typedef struct {
  PetscInt  low, high, side; /* side: SIDES times the face plus its number there */
  PetscBool up;              /* from low to high */
} Edge;

typedef struct {
  PetscInt   n;         /* faces of all surfaces */
  PetscInt **nodes;     /* of each */
  PetscInt  *size;      /* corners */
  PetscInt  *neighbour; /* SIDES each; -1: none */
  PetscBool *alike;     /* of each neighbour: does it turn as the face does? */
  PetscInt  *turned;    /* -1: not known yet */
} Faces;

int orient_compare(const void *a, const void *b, void *context)
{
  const PetscInt *one = a, *two = b;
  (void)context;
  if (one[0] != two[0]) return one[0] < two[0] ? -1 : 1;
  return (one[1] > two[1]) - (one[1] < two[1]);
}

static PetscErrorCode find_neighbours(Scene *scene, const char *body, const Mesh *shell, Faces *faces)
{
  Edge    *edges;
  PetscInt n = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(SIDES * faces->n, &edges));
  for (PetscInt f = 0; f < faces->n; f++) {
    for (PetscInt k = 0; k < faces->size[f]; k++) {
      const PetscInt a = faces->nodes[f][k], b = faces->nodes[f][(k + 1) % faces->size[f]];
      edges[n++] = (Edge){.low = PetscMin(a, b), .high = PetscMax(a, b), .side = SIDES * f + k, .up = (PetscBool)(a < b)};
    }
  }
  PetscCall(PetscTimSort(n, edges, sizeof(*edges), orient_compare, NULL));
  for (PetscInt k = 0; k < SIDES * faces->n; k++)
    faces->neighbour[k] = -1;
  for (PetscInt k = 0; k + 1 < n; k++) {
    const Edge *one = &edges[k], *two = &edges[k + 1];
    if (orient_compare(one, two, NULL)) continue;
    if (k + 2 < n && !orient_compare(one, &edges[k + 2], NULL)) {
      const PetscReal *x = shell->coordinates + 3 * one->low;
      scene_fail(scene, body, "file", "more than two faces meet at the edge near [%g, %g, %g].", (double)x[0], (double)x[1],
                 (double)x[2]);
    }
    faces->neighbour[one->side] = two->side / SIDES;
    faces->neighbour[two->side] = one->side / SIDES;
    faces->alike[one->side] = faces->alike[two->side] = (PetscBool)(one->up != two->up);
  }
  PetscCall(PetscFree(edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* six times the volume between the origin and a face */
static PetscReal volume(const Mesh *shell, const Faces *faces, PetscInt f)
{
  PetscReal sum = 0;
  for (PetscInt k = 1; k + 1 < faces->size[f]; k++) {
    const PetscReal *a = shell->coordinates + 3 * faces->nodes[f][0], *b = shell->coordinates + 3 * faces->nodes[f][k],
                    *c = shell->coordinates + 3 * faces->nodes[f][k + 1];
    for (int i = 0; i < 3; i++)
      sum += a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]);
  }
  return sum;
}

/* The piece around a face, whose members go into `piece`. */
static void orient_piece(Scene *scene, const char *body, const Mesh *shell, Faces *faces, PetscInt start, PetscInt piece[])
{
  PetscInt  n       = 1;
  PetscBool closed  = PETSC_TRUE;
  PetscReal inside  = 0;
  piece[0]          = start;
  faces->turned[start] = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt f = piece[k];
    inside += faces->turned[f] ? -volume(shell, faces, f) : volume(shell, faces, f);
    for (PetscInt s = 0; s < faces->size[f]; s++) {
      const PetscInt g = faces->neighbour[SIDES * f + s], turned = faces->turned[f] != !faces->alike[SIDES * f + s];
      if (g < 0) {
        closed = PETSC_FALSE;
      } else if (faces->turned[g] < 0) {
        faces->turned[g] = turned;
        piece[n++]       = g;
      } else if (faces->turned[g] != turned) {
        scene_fail(scene, body, "file", "its surface has one side only: no direction is outward.");
      }
    }
  }
  for (PetscInt k = 0; k < n && closed && inside < 0; k++)
    faces->turned[piece[k]] = !faces->turned[piece[k]];
}

PetscErrorCode orient_outward(Scene *scene, const char *body, const Mesh *shell)
{
  Faces     faces = {0};
  PetscInt *piece, n = 0;
  PetscBool flip = PETSC_FALSE;
  PetscFunctionBegin;
  scene_bool(scene, body, "flip", &flip);
  for (PetscInt s = 0; s < shell->n_surfaces; s++)
    faces.n += shell->surfaces[s].n_faces;
  PetscCall(PetscMalloc5(faces.n, &faces.nodes, faces.n, &faces.size, SIDES * faces.n, &faces.neighbour, SIDES * faces.n,
                         &faces.alike, faces.n, &faces.turned));
  PetscCall(PetscMalloc1(faces.n, &piece));
  for (PetscInt s = 0; s < shell->n_surfaces; s++) {
    const Surface *surface = &shell->surfaces[s];
    for (PetscInt f = 0; f < surface->n_faces; f++, n++) {
      faces.nodes[n]  = surface->vertices + surface->offsets[f];
      faces.size[n]   = surface->offsets[f + 1] - surface->offsets[f];
      faces.turned[n] = -1;
    }
  }
  PetscCall(find_neighbours(scene, body, shell, &faces));
  for (PetscInt f = 0; f < faces.n; f++) {
    if (faces.turned[f] < 0) orient_piece(scene, body, shell, &faces, f, piece);
  }
  for (PetscInt f = 0; f < faces.n; f++) {
    for (PetscInt k = 0; k < faces.size[f] / 2 && faces.turned[f] != (PetscInt)flip; k++) {
      const PetscInt other = faces.size[f] - 1 - k, vertex = faces.nodes[f][k];
      faces.nodes[f][k]     = faces.nodes[f][other];
      faces.nodes[f][other] = vertex;
    }
  }
  PetscCall(PetscFree(piece));
  PetscCall(PetscFree5(faces.nodes, faces.size, faces.neighbour, faces.alike, faces.turned));
  PetscFunctionReturn(PETSC_SUCCESS);
}
