/* What holds nodes along the surface: the law of an interface, of the library's options or in the place of Coulomb's. */
#include "contact/contact.h"

/* What a law is called in a scene: by STICKSLIP_FRICTION_..., then by STICKSLIP_LAW_... from COHESION on. */
static const char *const LAWS[] = {"coulomb", "none", "tied", "rough", "tresca", "cohesion", "weakening", "orthotropic", NULL};
enum { FIRST_OWN = 5 };

/* A number of one law: needed there, and refused of all others. */
static PetscReal number_of(Scene *scene, const Interface *interface, const char *key, PetscBool wanted, const char *law)
{
  const char *name  = interface->name;
  PetscReal   value = 0;
  scene_real(scene, name, key, &value);
  if (!wanted && scene_has(scene, name, key)) scene_fail(scene, name, key, "the law '%s' has no such number.", law);
  if (wanted && !scene_has(scene, name, key)) scene_fail(scene, name, key, "this key is missing: the law '%s' needs it.", law);
  return value;
}

/* `cohesion`, `friction_after`, `critical_slip`, `friction_across`, `direction` */
static void read_own(Scene *scene, const Space *space, Interface *interface, PetscInt kind, const char *law)
{
  const char     *name = interface->name;
  const PetscBool cohesive = (PetscBool)(kind == STICKSLIP_LAW_COHESION), weakens = (PetscBool)(kind == STICKSLIP_LAW_WEAKENING);
  const PetscBool across = (PetscBool)(kind == STICKSLIP_LAW_ORTHOTROPIC);
  stickslip_law  *own = &interface->law;

  *own               = (stickslip_law){.struct_size = sizeof(*own), .kind = (int32_t)kind};
  own->cohesion      = number_of(scene, interface, "cohesion", cohesive, law);
  own->mu_after      = number_of(scene, interface, "friction_after", weakens, law);
  own->critical_slip = number_of(scene, interface, "critical_slip", weakens, law);
  own->mu_across     = number_of(scene, interface, "friction_across", across, law);
  if (!across) {
    if (scene_has(scene, name, "direction")) scene_fail(scene, name, "direction", "the law '%s' has none.", law);
    return;
  }
  if (!space_vector(scene, space, name, "direction", own->direction))
    scene_fail(scene, name, "direction", "this key is missing: along it `friction` counts.");
}

/* `law`, `friction`, `shear_limit` and the numbers of other laws. A scene that asks for no friction gets one multiplier a node,
 * unless it names a law. */
void law_read(Scene *scene, const Space *space, Interface *interface)
{
  stickslip_options *options = &interface->options;
  const char        *name    = interface->name;
  PetscInt           law     = STICKSLIP_FRICTION_COULOMB, kind;
  PetscReal          mu = 0, shear_limit = 0;

  scene_real(scene, name, "friction", &mu);
  if (!scene_has(scene, name, "law") && mu == 0 && !layer_slips(scene, name)) law = STICKSLIP_FRICTION_NONE;
  scene_choice(scene, name, "law", LAWS, &law);
  kind = law < FIRST_OWN ? STICKSLIP_LAW_COULOMB : STICKSLIP_LAW_COHESION + law - FIRST_OWN;
  read_own(scene, space, interface, kind, LAWS[law]);
  scene_real(scene, name, "shear_limit", &shear_limit);
  if (law == STICKSLIP_FRICTION_TRESCA && shear_limit <= 0)
    scene_fail(scene, name, "shear_limit", "the law 'tresca' needs its largest shear traction, above 0.");
  if (law == STICKSLIP_FRICTION_TRESCA && mu == 0)
    scene_fail(scene, name, "friction", "the law 'tresca' is friction up to `shear_limit`; without a coefficient above 0 nothing ever comes to it.");
  if (law != STICKSLIP_FRICTION_TRESCA && shear_limit != 0)
    scene_fail(scene, name, "shear_limit", "the law '%s' has no such limit; 'tresca' has.", LAWS[law]);
  if (kind == STICKSLIP_LAW_ORTHOTROPIC && mu == 0)
    scene_fail(scene, name, "friction", "the law 'orthotropic' needs it above 0, along `direction`; without it there is none across, either.");
  if (kind != STICKSLIP_LAW_COULOMB) law = STICKSLIP_FRICTION_COULOMB;
  if (kind == STICKSLIP_LAW_WEAKENING) interface->n_states++;
  if (law != STICKSLIP_FRICTION_COULOMB && law != STICKSLIP_FRICTION_TRESCA && mu != 0)
    scene_fail(scene, name, "friction", "the law '%s' has no Coulomb coefficient.", LAWS[law]);
  options->friction     = (int32_t)law;
  options->mu           = mu;
  options->shear_limit  = shear_limit;
  interface->components = law == STICKSLIP_FRICTION_NONE ? 1 : interface->dimension;
}

/* Of any handle of the interface's part. */
int32_t law_set(const Interface *interface, stickslip_interface *handle)
{
  const int32_t refused = interface->law.kind == STICKSLIP_LAW_COULOMB ? STICKSLIP_OK : stickslip_interface_set_law(handle, &interface->law);
  return refused ? refused : layer_set(interface, handle);
}

int32_t law_keep(const Interface *interface, ContactPart *part)
{
  int64_t count;
  if (!interface->n_states || !part->handle) return STICKSLIP_OK;
  return stickslip_interface_law_states(part->handle, interface->n_states * part->n1, part->way, &count);
}

int32_t law_restore(const Interface *interface, const ContactPart *part)
{
  if (!interface->n_states) return STICKSLIP_OK;
  return stickslip_interface_set_law_states(part->handle, interface->n_states * part->n1, part->way);
}
