/* Supports on nodes that have multipliers, where these are no unknowns (`unknowns: displacements`): a multiplier is found from the rows
 * of its node, and a prescribed displacement has none. The library refuses that, too, but knows no supports. */
#include "contact/contact.h"

/* The first component that a support prescribes of a node at home and that has a multiplier; -1: none. With a multiplier along the
 * normal alone that goes with the normal, which the library judges. */
static int supported_component(const Interface *interface, PetscInt node)
{
  const PetscInt both = interface->components > 1 ? interface->prescribed[node] & ~interface->removed[node] : 0;
  for (int i = 0; i < interface->dimension; i++) {
    if (both & (1 << i)) return i;
  }
  return -1;
}

/* The name of a support that prescribes a component of a vertex of the piece */
static const char *support_of(const Physics *physics, PetscInt vertex, int component)
{
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    if (support->timed || !(support->mask & (1 << component))) continue;
    for (PetscInt k = 0; k < support->n_vertices; k++) {
      if (support->vertices[k] == vertex) return support->name;
    }
  }
  return "a support";
}

PetscErrorCode condensed_refuse_supported(Scene *scene, const Contact *contact, const Interface *interface)
{
  const Mesh *mesh      = contact->mesh;
  PetscInt    number    = PETSC_MAX_INT, vertex;
  int         component = -1;
  char        text[512] = "";
  PetscFunctionBegin;
  if (!contact->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt a = 0; a < interface->n1; a++) {
    if (supported_component(interface, a) >= 0) number = PetscMin(number, interface->nodes[a]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPIU_INT, MPI_MIN, PETSC_COMM_WORLD));
  if (number == PETSC_MAX_INT) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt a = 0; a < interface->n1; a++) {
    if (interface->nodes[a] == number) component = supported_component(interface, a);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &component, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  vertex = mesh_vertex_here(mesh, number);
  if (vertex >= 0) {
    const PetscReal *X = mesh->coordinates + 3 * vertex;
    PetscCall(PetscSNPrintf(text, sizeof(text),
                            "'%s' prescribes u_%c of its node at [%g, %g, %g]: with `unknowns: displacements` no row is left there to "
                            "find the multiplier from. Take `unknowns: multipliers`, hold other nodes, or let the other side be "
                            "`nonmortar`.",
                            support_of(contact->physics, vertex, component), 'x' + component, (double)X[0], (double)X[1], (double)X[2]));
  }
  PetscCall(scene_fail_first(scene, vertex >= 0 ? number : -1, interface->name, "nonmortar", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
