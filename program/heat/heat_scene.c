/* Heat as the scene describes it: of bodies, of surfaces, of interfaces. */
#include "heat/heat.h"
#include <string.h>

static PetscErrorCode read_bodies(Scene *scene, Heat *heat)
{
  const Mesh *mesh = heat->mesh;
  PetscBool   any  = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->n_bodies, &heat->bodies));
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    const Body *body = &mesh->bodies[b];
    Conductor  *of   = &heat->bodies[b];
    if (tool_is(mesh, b)) {
      scene_real(scene, body->name, "heat_capacity", &of->capacity);
      continue;
    }
    scene_real(scene, body->name, "conductivity", &of->conductivity);
    scene_real(scene, body->name, "heat_capacity", &of->capacity);
    scene_real(scene, body->name, "expansion", &of->expansion);
    if (of->conductivity > 0) any = PETSC_TRUE;
    if (of->expansion != 0 && !heat->two_way)
      scene_fail(scene, body->name, "expansion", "it needs `heat: {coupling: two_way}`.");
    if (of->expansion != 0 && heat->physics->dynamics && heat->physics->materials[b].law->finite)
      scene_fail(scene, body->name, "expansion", "not with `dynamics` and a material of finite strain: take `material: linear`.");
    if (of->capacity > 0 && !(of->conductivity > 0))
      scene_fail(scene, body->name, "heat_capacity", "it needs a conductivity: without one a body keeps its temperature.");
  }
  if (!any) scene_fail(scene, NULL, "heat", "no body has a `conductivity`.");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices here that a temperature of a surface is of: of one in closed form those that it moves with. `vertices` has room for the latter. */
enum { FRAME = 4 };
static const PetscInt *vertices_of(const Mesh *mesh, const Surface *surface, PetscInt *n, PetscInt frame[FRAME])
{
  *n = surface->n_faces ? surface->offsets[surface->n_faces] : 0;
  if (!surface->analytic) return surface->vertices;
  for (PetscInt k = 0; k < mesh->dimension + 1; k++) {
    const PetscInt here = mesh_vertex_here(mesh, surface->frame + k);
    if (here >= 0) frame[(*n)++] = here;
  }
  return frame;
}

/* `flows`: a flow of heat, else a temperature */
static PetscErrorCode read_supports(Scene *scene, Heat *heat, const char *list, PetscBool flows)
{
  char   **names;
  PetscInt n;
  PetscFunctionBegin;
  scene_names(scene, list, &n, &names);
  PetscCall(PetscRealloc(sizeof(HeatSupport) * (size_t)(heat->n_supports + n), &heat->supports));
  for (PetscInt k = 0; k < n; k++) {
    HeatSupport *support = &heat->supports[heat->n_supports + k];
    char       **surfaces;
    *support = (HeatSupport){.flows = flows};
    PetscCall(PetscSNPrintf(support->name, NAME_LENGTH, "%s", names[k]));
    scene_real_required(scene, names[k], flows ? "flow" : "value", &support->value);
    PetscCall(curve_read(scene, names[k], "curve", heat->physics->end, &support->curve));
    scene_strings(scene, names[k], "surface", &support->n_surfaces, &surfaces);
    if (!support->n_surfaces) scene_fail(scene, names[k], "surface", "this key is missing.");
    PetscCall(PetscCalloc1(support->n_surfaces, &support->surfaces));
    for (PetscInt s = 0; s < support->n_surfaces; s++) {
      support->surfaces[s] = mesh_surface(scene, heat->mesh, names[k], "surface", surfaces[s]);
      if (flows && support->surfaces[s]->analytic)
        scene_fail(scene, names[k], "surface", "'%s' is without faces, and a flow is per area: give a temperature, or mesh it.", surfaces[s]);
    }
    strings_destroy(support->n_surfaces, &surfaces);
  }
  heat->n_supports += n;
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do both say the same at all times? Between the times of their curves both move evenly. */
static PetscBool agree(const Heat *heat, const HeatSupport *a, const HeatSupport *b)
{
  const PetscReal same = 1e-12; /* of the larger one: two factors that are written in different ways */
  const Curve *const curves[] = {&a->curve, &b->curve};
  for (int c = 0; c < 2; c++) {
    for (PetscInt k = 0; k < curves[c]->n; k++) {
      const PetscReal t = curves[c]->points[2 * k];
      const PetscReal of_a = (a->value - heat->initial) * curve_value(&a->curve, t), of_b = (b->value - heat->initial) * curve_value(&b->curve, t);
      if (PetscAbsReal(of_a - of_b) > same * PetscMax(PetscAbsReal(of_a), PetscAbsReal(of_b))) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

/* Two temperatures may share a vertex only if they say the same. `first`: of each vertex here the first that prescribes it, -1: none. */
static PetscErrorCode check_overlap(Scene *scene, const Heat *heat, PetscInt number, PetscInt first[])
{
  const Mesh        *mesh      = heat->mesh;
  const HeatSupport *support   = &heat->supports[number];
  char               text[512] = "";
  PetscInt          *chosen, bad = -1;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->n_vertices, &chosen));
  for (PetscInt s = 0; s < support->n_surfaces; s++) {
    PetscInt        frame[FRAME], n;
    const PetscInt *vertices = vertices_of(mesh, support->surfaces[s], &n, frame);
    for (PetscInt k = 0; k < n; k++)
      chosen[vertices[k]] = PETSC_TRUE;
  }
  PetscCall(pieces_unite(mesh, chosen, MPI_MAX)); /* a vertex here may be on a face of another piece */
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    const PetscReal *X = mesh->coordinates + 3 * v;
    if (!chosen[v]) continue;
    if (first[v] < 0) first[v] = number;
    if (bad < 0 && tool_is(mesh, mesh_body_of(mesh, mesh->numbers[v])) && heat->bodies[mesh_body_of(mesh, mesh->numbers[v])].capacity > 0) {
      bad = mesh->numbers[v];
      PetscCall(PetscSNPrintf(text, sizeof(text), "'%s' has a `heat_capacity`, by which its temperature follows from what it is given: leave one of them out.",
                              mesh->bodies[mesh_body_of(mesh, bad)].name));
    }
    if (bad >= 0 || first[v] == number || agree(heat, support, &heat->supports[first[v]])) continue;
    bad = mesh->numbers[v];
    PetscCall(PetscSNPrintf(text, sizeof(text), "the temperature of the vertex at [%g, %g, %g] is prescribed differently by '%s'.", (double)X[0],
                            (double)X[1], (double)X[2], heat->supports[first[v]].name));
  }
  PetscCall(PetscFree(chosen));
  PetscCall(scene_fail_first(scene, bad, support->name, "surface", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_overlaps(Scene *scene, const Heat *heat)
{
  PetscInt *first;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(heat->mesh->n_vertices, &first));
  for (PetscInt v = 0; v < heat->mesh->n_vertices; v++)
    first[v] = -1;
  for (PetscInt k = 0; k < heat->n_supports; k++) {
    if (!heat->supports[k].flows) PetscCall(check_overlap(scene, heat, k, first));
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_interfaces(Scene *scene, Heat *heat)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(heat->contact->n_interfaces, &heat->interfaces));
  for (PetscInt i = 0; i < heat->contact->n_interfaces; i++) {
    const char     *name = heat->contact->interfaces[i].name;
    HeatInterface  *of   = &heat->interfaces[i];
    const PetscBool rubs = scene_has(scene, name, "friction_heat");
    PetscReal       share = 0, contact = 0, pressure = 0, exponent = 0, constant = 0, gas = 0, distance = 0, reach = 0;
    scene_real(scene, name, "conductance", &contact);
    scene_real(scene, name, "conductance_pressure", &pressure);
    scene_real(scene, name, "conductance_exponent", &exponent);
    scene_real(scene, name, "conductance_constant", &constant);
    scene_real(scene, name, "gap_conductivity", &gas);
    scene_real(scene, name, "gap_distance", &distance);
    scene_real(scene, name, "conductance_reach", &reach);
    scene_real(scene, name, "friction_heat", &share);
    if (contact > 0 && !(pressure > 0))
      scene_fail(scene, name, "conductance_pressure", "this key is missing: the pressure that `conductance` is at.");
    if (gas > 0 && !(distance > 0))
      scene_fail(scene, name, "gap_distance", "this key is missing: the gap that touching surfaces count as.");
    if ((gas > 0 || constant > 0) && !(reach > 0))
      scene_fail(scene, name, "conductance_reach", "this key is missing: the gap from which on nothing passes.");
    /* time: below, in each step; 1 says that friction heats */
    of->law = (stickslip_heat){.struct_size = sizeof(of->law), .contact = contact, .pressure = pressure,
                               .exponent = contact > 0 ? exponent : 0, .constant = constant, .gas = gas, .gas_gap = distance,
                               .reach = reach, .share = share, .time = rubs ? 1 : 0};
    of->passes = (PetscBool)(contact > 0 || constant > 0 || gas > 0 || rubs);
    if (of->passes && heat->contact->interfaces[i].skin)
      scene_fail(scene, name, NULL, "no heat passes in general contact: name these surfaces in `interfaces`, beside `contact: all`.");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode heat_read(Scene *scene, Heat *heat)
{
  static const char *const couplings[] = {"one_way", "two_way", NULL};
  PetscInt                 coupling    = 0;
  PetscFunctionBegin;
  if (!scene_has_map("heat")) PetscFunctionReturn(PETSC_SUCCESS);
  heat->on = PETSC_TRUE;
  scene_real_required(scene, "heat", "initial", &heat->initial);
  scene_choice(scene, "heat", "coupling", couplings, &coupling);
  scene_real(scene, "heat", "tolerance", &heat->tolerance);
  scene_int(scene, "heat", "turns", &heat->most);
  heat->two_way = (PetscBool)coupling;
  PetscCall(read_bodies(scene, heat));
  PetscCall(read_supports(scene, heat, "temperatures", PETSC_FALSE));
  PetscCall(read_supports(scene, heat, "flows", PETSC_TRUE));
  PetscCall(check_overlaps(scene, heat));
  PetscCall(read_interfaces(scene, heat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void label_of(const HeatSupport *support, char label[2 * NAME_LENGTH])
{
  PetscCallAbort(PETSC_COMM_WORLD, PetscSNPrintf(label, 2 * NAME_LENGTH, "heat.%s", support->name));
}

PetscErrorCode heat_label(Heat *heat)
{
  char label[2 * NAME_LENGTH];
  PetscFunctionBegin;
  for (PetscInt k = 0; k < heat->n_supports; k++) {
    HeatSupport *support = &heat->supports[k];
    label_of(support, label);
    for (PetscInt s = 0; s < support->n_surfaces; s++) {
      PetscInt        frame[FRAME], n;
      const PetscInt *vertices = vertices_of(heat->mesh, support->surfaces[s], &n, frame);
      if (support->flows)
        PetscCall(plex_label_faces(heat->mesh, label, support->surfaces[s]));
      else
        PetscCall(plex_label_vertices(heat->mesh, label, n, vertices, NULL, 1));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
