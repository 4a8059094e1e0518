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
    traction = scene_vector(scene, load->name, "traction", 3, load->traction);
    if (!scene_has(scene, load->name, "pressure") && !traction) {
      (void)scene_has(scene, load->name, "surface"); /* known keys, one of which may be misspelt */
      (void)scene_has(scene, load->name, "curve");
      scene_check_unread_of(scene, load->name);
      scene_fail(scene, load->name, "traction",
                 "say how it loads: traction [x, y, z], or pressure (against the outward normal).");
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
    if (!physics->loads[l].n_surfaces) PetscCall(plex_label_faces(physics->mesh->dm, label, NULL));
    for (PetscInt k = 0; k < physics->loads[l].n_surfaces; k++)
      PetscCall(plex_label_faces(physics->mesh->dm, label, physics->loads[l].surfaces[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_face(Physics *physics, const Load *load, PetscInt face, PetscScalar *forces)
{
  const Mesh        *mesh    = physics->mesh;
  PetscInt          *closure = NULL, size, n = 0, offsets[4], at;
  PetscReal          X[12], f[12];
  PetscSection       section;
  Vec                vector;
  const PetscScalar *coordinates;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinateSection(mesh->dm, &section));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  PetscCall(DMPlexGetTransitiveClosure(mesh->dm, face, PETSC_TRUE, &size, &closure));
  for (PetscInt k = 0; k < size; k++) {
    const PetscInt v = closure[2 * k];
    if (v < mesh->vStart || v >= mesh->vEnd) continue;
    PetscCall(PetscSectionGetOffset(section, v, &at));
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, v, &offsets[n]));
    for (int i = 0; i < 3; i++)
      X[3 * n + i] = PetscRealPart(coordinates[at + i]);
    n++;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(mesh->dm, face, PETSC_TRUE, &size, &closure));
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  { /* DMPlex may see the face from inside: the pressure must act against the outward normal */
    const PetscInt *support, *cells;
    PetscReal       volume, cell_centre[3], face_centre[3], normal[3], outward = 0;
    PetscCall(DMPlexGetSupport(mesh->dm, face, &support));
    cells = support;
    PetscCall(DMPlexComputeCellGeometryFVM(mesh->dm, cells[0], &volume, cell_centre, NULL));
    PetscCall(DMPlexComputeCellGeometryFVM(mesh->dm, face, &volume, face_centre, NULL));
    for (int i = 0; i < 3; i++) { /* of the triangle 0, 1, 2 */
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      normal[i] = (X[3 + j] - X[j]) * (X[6 + k] - X[k]) - (X[3 + k] - X[k]) * (X[6 + j] - X[j]);
      outward += normal[i] * (face_centre[i] - cell_centre[i]);
    }
    face_forces(n, X, load->traction, outward > 0 ? load->pressure : -load->pressure, f);
  }
  for (PetscInt a = 0; a < n; a++) {
    for (int i = 0; i < 3; i++)
      forces[offsets[a] + i] += f[3 * a + i];
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
