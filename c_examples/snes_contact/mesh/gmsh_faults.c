/* What is wrong with a Gmsh file, whoever reads it. */
#include "mesh/mesh.h"

void gmsh_fail_kind(Scene *scene, const char *body, const char *kind)
{
  scene_fail(scene, body, "file",
             "it holds %s; tetrahedra and hexahedra are supported: mesh it in Gmsh without layers or `Recombine` that "
             "lead to others, or split them.",
             kind);
}

void gmsh_fail_volume(Scene *scene, const char *body, const char *path, const char *volume, const char *names)
{
  scene_fail(scene, body, "volume", "'%s' has no physical volume '%s'; there are: %s.", path, volume, names);
}

void gmsh_fail_nameless(Scene *scene, const char *body, const char *path)
{
  scene_fail(scene, body, "file",
             "'%s' has no physical surface, so that nothing can be said of its faces; give those names, as in "
             "`Physical Surface(\"contact\") = {...};`.",
             path);
}
