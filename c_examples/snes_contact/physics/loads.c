/* Dead surface loads: a traction vector and/or a pressure per reference area, as consistent nodal forces, times a curve. */
#include "physics/physics.h"

PetscErrorCode loads_read(Scene *scene, Physics *physics)
{
  const Mesh *mesh = physics->mesh;
  char      **names;

  PetscFunctionBegin;
  scene_names(scene, "loads", &physics->n_loads, &names);
  PetscCall(PetscCalloc1(physics->n_loads, &physics->loads));
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    Load     *load = &physics->loads[l];
    PetscBool traction;
    PetscCall(PetscSNPrintf(load->name, NAME_LENGTH, "%s", names[l]));
    traction = space_vector(scene, &mesh->space, load->name, "traction", load->traction);
    if (!scene_has(scene, load->name, "pressure") && !traction) {
      (void)scene_has(scene, load->name, "surface"); /* known keys, one of which may be misspelt */
      (void)scene_has(scene, load->name, "curve");
      scene_check_unread_of(scene, load->name);
      scene_fail(scene, load->name, "traction",
                 "say how it loads: traction [x, y%s], or pressure (against the outward normal).",
                 mesh->dimension == 3 ? ", z" : "");
    }
    scene_real(scene, load->name, "pressure", &load->pressure);
    mesh_rotate_vector(mesh, load->traction);
    PetscCall(curve_read(scene, load->name, "curve", physics->end, &load->curve));
  }
  strings_destroy(physics->n_loads, &names);
  scene_root_begin(scene);
  for (PetscInt l = 0; l < physics->n_loads && mesh->rank == 0; l++) {
    Load  *load = &physics->loads[l];
    char **list;
    scene_strings(scene, load->name, "surface", &load->n_surfaces, &list);
    if (!load->n_surfaces) scene_fail(scene, load->name, "surface", "this key is missing.");
    PetscCall(PetscMalloc1(load->n_surfaces, &load->surfaces));
    for (PetscInt k = 0; k < load->n_surfaces; k++) {
      load->surfaces[k] = mesh_surface(scene, mesh, load->name, "surface", list[k]);
      if (load->surfaces[k]->inner)
        scene_fail(scene, load->name, "surface", "'%s' lies inside a body and cannot be loaded.", list[k]);
      if (load->surfaces[k]->analytic)
        scene_fail(scene, load->name, "surface", "'%s' is rigid and without faces: it cannot be loaded.", list[k]);
    }
    strings_destroy(load->n_surfaces, &list);
  }
  PetscCall(scene_root_end(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode loads_label(Physics *physics)
{
  char label[2 * NAME_LENGTH];
  PetscFunctionBegin;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    PetscCall(PetscSNPrintf(label, sizeof(label), "load.%s", physics->loads[l].name));
    if (!physics->loads[l].n_surfaces) PetscCall(plex_label_faces(physics->mesh, label, NULL));
    for (PetscInt k = 0; k < physics->loads[l].n_surfaces; k++)
      PetscCall(plex_label_faces(physics->mesh, label, physics->loads[l].surfaces[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the mean of a point's vertices */
static PetscErrorCode middle(const Mesh *mesh, PetscInt point, PetscSection section, const PetscScalar *coordinates,
                             PetscReal mean[3])
{
  PetscInt *closure = NULL, size, vStart, vEnd, n = 0, at;
  PetscFunctionBegin;
  mean[0] = mean[1] = mean[2] = 0;
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, &vEnd));
  PetscCall(DMPlexGetTransitiveClosure(mesh->dm, point, PETSC_TRUE, &size, &closure));
  for (PetscInt k = 0; k < size; k++) {
    if (closure[2 * k] < vStart || closure[2 * k] >= vEnd) continue;
    PetscCall(PetscSectionGetOffset(section, closure[2 * k], &at));
    for (int i = 0; i < 3; i++)
      mean[i] += PetscRealPart(coordinates[at + i]);
    n++;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(mesh->dm, point, PETSC_TRUE, &size, &closure));
  for (int i = 0; i < 3; i++)
    mean[i] /= (PetscReal)n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_face(Physics *physics, const Load *load, PetscInt face, PetscScalar *forces)
{
  const Mesh        *mesh = physics->mesh;
  PetscInt           n, nodes[FACE_NODES], at;
  const PetscInt    *cells;
  PetscReal          X[3 * FACE_NODES], f[3 * FACE_NODES], cell_middle[3], face_middle[3], outward = 0, e1[3], e2[3];
  PetscSection       section;
  Vec                vector;
  const PetscScalar *coordinates;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinateSection(mesh->dm, &section));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  PetscCall(plex_face_nodes(mesh, face, &n, nodes));
  for (PetscInt a = 0; a < n; a++) {
    PetscCall(PetscSectionGetOffset(section, nodes[a], &at));
    for (int i = 0; i < 3; i++)
      X[3 * a + i] = PetscRealPart(coordinates[at + i]);
  }
  PetscCall(DMPlexGetSupport(mesh->dm, face, &cells));
  PetscCall(middle(mesh, cells[0], section, coordinates, cell_middle));
  PetscCall(middle(mesh, face, section, coordinates, face_middle));
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  for (int i = 0; i < 3; i++) { /* two edges of the triangle 0, 1, 2; or a line, and one across the plane */
    e1[i] = X[3 + i] - X[i];
    e2[i] = mesh->dimension == 3 ? X[6 + i] - X[i] : i == 2;
  }
  for (int i = 0; i < 3; i++) { /* DMPlex may see the face from inside: the pressure acts against the outward normal */
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    outward += (e1[j] * e2[k] - e1[k] * e2[j]) * (face_middle[i] - cell_middle[i]);
  }
  face_forces(cell_kind(mesh->dimension - 1, n), &mesh->space, X, load->traction,
              outward > 0 ? load->pressure : -load->pressure, f);
  for (PetscInt a = 0; a < n; a++) {
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, nodes[a], &at));
    for (int i = 0; i < 3; i++)
      forces[at + i] += f[3 * a + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode loads_assemble(Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    Load           *load = &physics->loads[l];
    char            label[2 * NAME_LENGTH];
    PetscScalar    *forces;
    PetscInt        n = 0;
    const PetscInt *faces;
    IS              is;
    PetscCall(VecDuplicate(physics->u_local, &load->forces));
    PetscCall(VecZeroEntries(load->forces));
    PetscCall(PetscSNPrintf(label, sizeof(label), "load.%s", load->name));
    PetscCall(DMGetStratumIS(physics->mesh->dm, label, 1, &is));
    if (!is) continue; /* no such face on this rank */
    PetscCall(VecGetArray(load->forces, &forces));
    PetscCall(ISGetLocalSize(is, &n));
    PetscCall(ISGetIndices(is, &faces));
    for (PetscInt k = 0; k < n; k++)
      PetscCall(add_face(physics, load, faces[k], forces));
    PetscCall(ISRestoreIndices(is, &faces));
    PetscCall(ISDestroy(&is));
    PetscCall(VecRestoreArray(load->forces, &forces));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode loads_values(Physics *physics, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(physics->f_external));
  for (PetscInt l = 0; l < physics->n_loads; l++)
    PetscCall(VecAXPY(physics->f_external, curve_value(&physics->loads[l].curve, t), physics->loads[l].forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
