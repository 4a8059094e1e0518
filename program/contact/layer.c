/* What lies between the surfaces of an interface, or becomes of them: a layer that yields, wear, a bond. */
#include "contact/contact.h"

static const char *const BOND[] = {"bond_stiffness", "bond_strength", "bond_toughness", "bond_shear"};
enum { N_BOND = 4, WEAR_STATES = 2, BOND_STATES = 4 };

/* Whether the scene asks for what needs slip. */
PetscBool layer_slips(Scene *scene, const char *name)
{
  return (PetscBool)(scene_has(scene, name, "wear") || scene_has(scene, name, BOND[0]));
}

/* `overclosure`, `overclosure_pressure` */
static void read_table(Scene *scene, Interface *interface)
{
  stickslip_layer *layer = &interface->layer;
  PetscReal       *h, *p;
  PetscInt         n, m;
  scene_reals(scene, interface->name, "overclosure", &n, &h);
  scene_reals(scene, interface->name, "overclosure_pressure", &m, &p);
  if (n != m)
    scene_fail(scene, interface->name, n ? "overclosure_pressure" : "overclosure", "%d numbers are expected, one for each of the other list, but there %s %d.",
               (int)(n ? n : m), (n ? m : n) == 1 ? "is" : "are", (int)(n ? m : n));
  layer->n_overclosure = n;
  layer->overclosure   = h;
  layer->pressure      = p;
}

/* All keys of it, before the law. */
void layer_read(Scene *scene, Interface *interface)
{
  stickslip_layer *layer       = &interface->layer;
  const char      *name        = interface->name;
  double *const    bond[N_BOND] = {&layer->bond_stiffness, &layer->bond_strength, &layer->bond_toughness, &layer->bond_shear};
  PetscReal        wear = 0;

  *layer = (stickslip_layer){.struct_size = sizeof(*layer)};
  read_table(scene, interface);
  scene_real(scene, name, "wear", &wear);
  layer->wear = wear;
  for (int k = 0; k < N_BOND; k++) {
    PetscReal value = 0;
    scene_real(scene, name, BOND[k], &value);
    if (k && scene_has(scene, name, BOND[k]) && !scene_has(scene, name, BOND[0]))
      scene_fail(scene, name, BOND[k], "it belongs to a bond: give `bond_stiffness`, too.");
    if (scene_has(scene, name, BOND[0]) && !(value > 0)) scene_fail(scene, name, BOND[k], "this key is missing: a bond needs it.");
    *bond[k] = value;
  }
  if (!scene_has(scene, name, BOND[0])) layer->bond_shear = 0;
  interface->n_states = (layer->wear > 0 ? WEAR_STATES : 0) + (layer->bond_stiffness > 0 ? BOND_STATES : 0);
}

PetscBool layer_is_there(const Interface *interface)
{
  const stickslip_layer *layer = &interface->layer;
  return (PetscBool)(layer->n_overclosure || layer->wear > 0 || layer->bond_stiffness > 0);
}

int32_t layer_set(const Interface *interface, stickslip_interface *handle)
{
  return layer_is_there(interface) ? stickslip_interface_set_layer(handle, &interface->layer) : STICKSLIP_OK;
}
