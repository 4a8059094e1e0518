/* What is wrong with a Gmsh file, whoever reads it; `dimension`: of the model. */
#include "mesh/mesh.h"

void gmsh_fail_kind(Scene *scene, const char *body, const char *kind)
{
  scene_fail(scene, body, "file",
             "it holds %s; tetrahedra and hexahedra are supported, in the plane triangles and quadrilaterals: mesh it in "
             "Gmsh without layers or `Recombine` that lead to others, or split them.",
             kind);
}

void gmsh_fail_dimension(Scene *scene, const char *body, const char *path, PetscInt dimension)
{
  if (dimension == 3)
    scene_fail(scene, body, "file",
               "'%s' holds no volume cells; mesh it in 3D and give the volume a physical name, or say `model: plane_strain` "
               "(or plane_stress, axisymmetric).",
               path);
  scene_fail(scene, body, "file", "'%s' is no plane mesh; mesh it in 2D, or leave `model` out.", path);
}

void gmsh_fail_volume(Scene *scene, const char *body, const char *path, const char *volume, const char *names,
                      PetscInt dimension)
{
  scene_fail(scene, body, "volume", "'%s' has no physical %s '%s'; there are: %s.", path,
             dimension == 3 ? "volume" : "surface", volume, names);
}

void gmsh_fail_nameless(Scene *scene, const char *body, const char *path, PetscInt dimension)
{
  scene_fail(scene, body, "file",
             "'%s' has no physical %s, so that nothing can be said of its faces; give those names, as in "
             "`Physical %s(\"contact\") = {...};`.",
             path, dimension == 3 ? "surface" : "curve", dimension == 3 ? "Surface" : "Curve");
}
