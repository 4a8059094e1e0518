/* `contact_mass: spread`: no mass at the non-mortar nodes (Khenous, Laborde and Renard, Eur. J. Mech. A/Solids 27, 2008). An impact loses the energy
 * of the motion of these nodes, and pressures swing with it.
 *
 * In the energy of motion the velocity of such a node is replaced by an affine continuation of those of some nodes inside, its donors:
 * v = sum_i t_i v_i with sum_i t_i = 1 and sum_i t_i X_i = X. So M' = T^T M T has zero rows at the nodes, is positive on the others, and has the
 * energy of every affine velocity: mass, centre and inertia of each body are kept. Weights of bodies go the same way, so that a body that
 * falls is not strained. */
#include "physics/dynamics.h"

/* What is left of an affine continuation, over one: rounding of the places. */
static const PetscReal CONTINUED = 1e-9;

/* The nodes here and the cells of each; by local offsets of their displacements */
typedef struct {
  PetscInt   n, *dofs, *of_dof, *offsets, *cells;
  PetscReal *X;
  PetscBool *bare;
  PetscInt  *mark; /* by the number of the bare node that asks for it */
} Nodes;

static PetscErrorCode find_bare(const Physics *physics, const Nodes *nodes)
{
  const Mesh     *mesh     = physics->mesh;
  const Unknowns *unknowns = &physics->unknowns;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    for (PetscInt f = 0; f < unknowns->n_fields; f++) {
      PetscInt value, at;
      PetscCall(DMGetLabelValue(mesh->dm, unknowns->fields[f].label, mesh->points[k], &value));
      PetscCall(PetscSectionGetOffset(unknowns->section, mesh->points[k], &at));
      if (value >= 0 && nodes->of_dof[at] >= 0) nodes->bare[nodes->of_dof[at]] = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode nodes_create(const Physics *physics, Nodes *nodes)
{
  const Dynamics *d = physics->dynamics;
  const PetscInt  n_cells = physics->cells.n;
  PetscInt        n_corners = 0;
  PetscFunctionBegin;
  *nodes = (Nodes){0};
  for (PetscInt c = 0; c < n_cells; c++)
    n_corners += d->cells[c].n;
  PetscCall(PetscMalloc1(physics->unknowns.n_local, &nodes->of_dof));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    nodes->of_dof[k] = -1;
  PetscCall(PetscMalloc3(n_corners, &nodes->dofs, 3 * n_corners, &nodes->X, n_corners, &nodes->cells));
  for (PetscInt c = 0; c < n_cells; c++) {
    for (PetscInt a = 0; a < d->cells[c].n; a++) {
      const PetscInt dof = d->cells[c].dofs[a];
      if (nodes->of_dof[dof] >= 0) continue;
      nodes->of_dof[dof]    = nodes->n;
      nodes->dofs[nodes->n] = dof;
      PetscCall(PetscArraycpy(nodes->X + 3 * nodes->n++, d->cells[c].X + 3 * a, 3));
    }
  }
  PetscCall(PetscCalloc3(nodes->n + 2, &nodes->offsets, nodes->n, &nodes->bare, nodes->n, &nodes->mark));
  for (PetscInt c = 0; c < n_cells; c++) {
    for (PetscInt a = 0; a < d->cells[c].n; a++)
      nodes->offsets[nodes->of_dof[d->cells[c].dofs[a]] + 2]++;
  }
  for (PetscInt k = 0; k < nodes->n; k++)
    nodes->offsets[k + 2] += nodes->offsets[k + 1];
  for (PetscInt c = 0; c < n_cells; c++) { /* offsets[k + 1] runs to the end of node k */
    for (PetscInt a = 0; a < d->cells[c].n; a++)
      nodes->cells[nodes->offsets[nodes->of_dof[d->cells[c].dofs[a]] + 1]++] = c;
  }
  for (PetscInt k = 0; k < nodes->n; k++)
    nodes->mark[k] = -1;
  PetscCall(find_bare(physics, nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode nodes_destroy(Nodes *nodes)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(nodes->offsets, nodes->bare, nodes->mark));
  PetscCall(PetscFree3(nodes->dofs, nodes->X, nodes->cells));
  PetscCall(PetscFree(nodes->of_dof));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes of the cells around `around` that are not marked yet, onto the list. */
static void add_ring(const Dynamics *d, const Nodes *nodes, PetscInt node, PetscInt around, PetscInt list[], PetscInt *n)
{
  for (PetscInt k = nodes->offsets[around]; k < nodes->offsets[around + 1]; k++) {
    const CellMass *mass = &d->cells[nodes->cells[k]];
    for (PetscInt a = 0; a < mass->n; a++) {
      const PetscInt other = nodes->of_dof[mass->dofs[a]];
      if (nodes->mark[other] == node) continue;
      nodes->mark[other] = node;
      list[(*n)++]       = other;
    }
  }
}

/* 1 and the place from the node, over a length */
static void affine(const Nodes *nodes, PetscInt node, PetscInt other, PetscReal length, PetscReal row[4])
{
  row[0] = 1;
  for (int i = 0; i < 3; i++)
    row[1 + i] = (nodes->X[3 * other + i] - nodes->X[3 * node + i]) / length;
}

static PetscReal product(const PetscReal a[4], const PetscReal b[4])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* Donors one by one, each the one that is nearest in what is left of (1, 0): the nearest node, then one beyond it, and so on; directions q are
 * made orthonormal. False: it is not continued. */
static PetscBool choose(const Nodes *nodes, PetscInt node, const PetscInt list[], PetscInt n, PetscReal length, Bare *bare)
{
  PetscReal q[DONORS][4], R[DONORS][DONORS], left[4] = {1, 0, 0, 0}, along[DONORS];
  bare->n = 0;
  while (product(left, left) > PetscSqr(CONTINUED)) {
    PetscInt  best = -1;
    PetscReal most = CONTINUED, row[4], norm;
    if (bare->n == DONORS) return PETSC_FALSE;
    for (PetscInt k = 0; k < n; k++) {
      PetscReal score;
      if (nodes->bare[list[k]]) continue;
      affine(nodes, node, list[k], length, row);
      score = PetscAbsReal(product(row, left)) / product(row, row);
      if (score > most * (1 + CONTINUED)) best = list[k], most = score;
    }
    if (best < 0) return PETSC_FALSE;
    affine(nodes, node, best, length, row);
    for (PetscInt j = 0; j < bare->n; j++) {
      R[j][bare->n] = product(q[j], row);
      for (int i = 0; i < 4; i++)
        row[i] -= R[j][bare->n] * q[j][i];
    }
    norm = PetscSqrtReal(product(row, row));
    if (!(norm > CONTINUED)) return PETSC_FALSE;
    R[bare->n][bare->n] = norm;
    for (int i = 0; i < 4; i++)
      q[bare->n][i] = row[i] / norm;
    along[bare->n] = product(q[bare->n], left);
    for (int i = 0; i < 4; i++)
      left[i] -= along[bare->n] * q[bare->n][i];
    bare->donors[bare->n++] = nodes->dofs[best];
  }
  for (PetscInt j = bare->n - 1; j >= 0; j--) {
    bare->weights[j] = along[j];
    for (PetscInt k = j + 1; k < bare->n; k++)
      bare->weights[j] -= R[j][k] * bare->weights[k];
    bare->weights[j] /= R[j][j];
  }
  return PETSC_TRUE;
}

/* Donors of a bare node, among the nodes of two rings of cells around it; `list` has room for all nodes */
static PetscBool find_donors(const Dynamics *d, const Nodes *nodes, PetscInt node, PetscInt list[], Bare *bare)
{
  PetscInt  n = 0, n_first;
  PetscReal nearest = PETSC_MAX_REAL;
  add_ring(d, nodes, node, node, list, &n);
  n_first = n;
  for (PetscInt k = 0; k < n_first; k++)
    add_ring(d, nodes, node, list[k], list, &n);
  for (PetscInt k = 0; k < n; k++) {
    PetscReal row[4];
    affine(nodes, node, list[k], 1, row);
    if (!nodes->bare[list[k]]) nearest = PetscMin(nearest, PetscSqrtReal(product(row, row) - 1));
  }
  bare->dof = nodes->dofs[node];
  return (PetscBool)(nearest < PETSC_MAX_REAL && choose(nodes, node, list, n, nearest, bare));
}

/* M' = T^T M T of a cell, `bare_of`: of each local offset the bare node that is there, -1: none */
static PetscErrorCode spread_cell(const Dynamics *d, const Nodes *nodes, const PetscInt bare_of[], CellMass *mass)
{
  PetscInt   n = 0, dofs[MASS_NODES];
  PetscReal *T, *MT;
  CellMass   spread = {.own = PETSC_TRUE};
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(mass->n * MASS_NODES, &T, mass->n * MASS_NODES, &MT));
  for (PetscInt a = 0; a < mass->n; a++) {
    const Bare     *bare = bare_of[mass->dofs[a]] < 0 ? NULL : &d->bare[bare_of[mass->dofs[a]]];
    for (PetscInt k = 0; k < (bare ? bare->n : 1); k++) {
      const PetscInt dof = bare ? bare->donors[k] : mass->dofs[a];
      PetscInt       b   = 0;
      while (b < n && dofs[b] != dof)
        b++;
      if (b == n) dofs[n++] = dof;
      T[MASS_NODES * a + b] = bare ? bare->weights[k] : 1;
    }
  }
  for (PetscInt k = 0; k < mass->n * n; k++) {
    for (PetscInt b = 0; b < mass->n; b++)
      MT[MASS_NODES * (k / n) + k % n] += mass->m[mass->n * (k / n) + b] * T[MASS_NODES * b + k % n];
  }
  PetscCall(PetscMalloc3(n, &spread.dofs, 3 * n, &spread.X, n * n, &spread.m));
  spread.n = n;
  for (PetscInt k = 0; k < n * n; k++) {
    spread.m[k] = 0;
    for (PetscInt a = 0; a < mass->n; a++)
      spread.m[k] += T[MASS_NODES * a + k / n] * MT[MASS_NODES * a + k % n];
  }
  for (PetscInt b = 0; b < n; b++) {
    spread.dofs[b] = dofs[b];
    PetscCall(PetscArraycpy(spread.X + 3 * b, nodes->X + 3 * nodes->of_dof[dofs[b]], 3));
  }
  *mass = spread;
  PetscCall(PetscFree2(T, MT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Weights of bodies, and forces of their turns, go where their masses go. */
static PetscErrorCode spread_weights(Physics *physics)
{
  const Dynamics *d = physics->dynamics;
  PetscFunctionBegin;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    PetscScalar *f;
    if (!physics->loads[l].bodies || physics->loads[l].remote || physics->loads[l].vertex >= 0) continue;
    PetscCall(VecGetArray(physics->loads[l].forces, &f));
    for (PetscInt k = 0; k < d->n_bare; k++) {
      const Bare *bare = &d->bare[k];
      for (int i = 0; i < 3; i++) {
        for (PetscInt j = 0; j < bare->n; j++)
          f[bare->donors[j] + i] += bare->weights[j] * f[bare->dof + i];
        f[bare->dof + i] = 0;
      }
    }
    PetscCall(VecRestoreArray(physics->loads[l].forces, &f));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mass_spread(Scene *scene, Physics *physics)
{
  Dynamics  *d = physics->dynamics;
  Nodes      nodes;
  PetscInt  *list, *bare_of;
  PetscFunctionBegin;
  PetscCall(nodes_create(physics, &nodes));
  PetscCall(PetscMalloc2(nodes.n, &list, physics->unknowns.n_local, &bare_of));
  PetscCall(PetscMalloc1(nodes.n, &d->bare));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    bare_of[k] = -1;
  for (PetscInt node = 0; node < nodes.n; node++) {
    if (!nodes.bare[node]) continue;
    if (!find_donors(d, &nodes, node, list, &d->bare[d->n_bare]))
      scene_fail(scene, "dynamics", "contact_mass",
                 "`spread` needs two layers of nodes inside, beside those of the non-mortar surface: the node at [%g, %g, %g] of '%s' has not. Make the "
                 "mesh finer there, or the other surface the non-mortar one.",
                 (double)nodes.X[3 * node], (double)nodes.X[3 * node + 1], (double)nodes.X[3 * node + 2],
                 physics->mesh->bodies[physics->cells.body[nodes.cells[nodes.offsets[node]]]].name);
    bare_of[nodes.dofs[node]] = d->n_bare++;
  }
  for (PetscInt c = 0; c < physics->cells.n; c++) {
    PetscBool any = PETSC_FALSE;
    for (PetscInt a = 0; a < d->cells[c].n; a++)
      any = (PetscBool)(any || bare_of[d->cells[c].dofs[a]] >= 0);
    if (any) PetscCall(spread_cell(d, &nodes, bare_of, &d->cells[c]));
  }
  PetscCall(spread_weights(physics));
  PetscCall(PetscFree2(list, bare_of));
  PetscCall(nodes_destroy(&nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mass_pattern(const Physics *physics, Mat matrix)
{
  PetscFunctionBegin;
  if (physics->dynamics && physics->dynamics->spread) PetscCall(mass_insert(physics, 0, matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void mass_follow(const Physics *physics, const PetscScalar *from, PetscScalar *to)
{
  const Dynamics *d = physics->dynamics;
  for (PetscInt k = 0; k < d->n_bare; k++) {
    const Bare *bare = &d->bare[k];
    for (int i = 0; i < 3; i++) {
      if (physics->unknowns.equations[bare->dof + i] < 0) continue;
      to[bare->dof + i] = from[bare->dof + i];
      for (PetscInt j = 0; j < bare->n; j++)
        to[bare->dof + i] += bare->weights[j] * (to[bare->donors[j] + i] - from[bare->donors[j] + i]);
    }
  }
}
