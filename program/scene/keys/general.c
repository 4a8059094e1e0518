/* Keys of general contact. */
#include "scene/keys.h"

static const char PAGE[] = "c_examples/scenes/general.md";

static const Key GENERAL[] = {
  {"contact", KEY_WORD, "all", ANY, "", "the outer faces of all bodies, of which nothing has to have a name"},
  {"friction", KEY_NUMBER, "", FROM(0), "0",
   "one coefficient for all, or a map of pairs: `{steel.rubber: 0.8, rubber.rubber: 0.5, default: 0.3}`. A pair may be written either way round"},
  {"except", KEY_NAME, "list of names", ANY, "",
   "what is left out: a body, `[table]`; a surface, `[block.zmin]`; two bodies that do not see each other, `[block.lid]`, or one that does not see "
   "itself, `[spring.spring]`"},
  {"all", KEY_MAP, "", ANY, "",
   "[keys of an interface](interface.md) that say how contact is computed: `law` (`coulomb`, `none`, `rough`, `tresca` with `shear_limit`), "
   "`basis`, `normals`, `weights`, `form`, `modulus`, `augmentation`, `search_distance`, `weak_coverage`, `new_contact`, `lag_max` and others. What "
   "the program is told of sides is refused by name"},
};

static const Key PAIRS[] = {
  {"default", KEY_NUMBER, "", FROM(0), "no friction", "the coefficient of pairs that the map `friction` does not name"},
};

const KeyTable KEYS_GENERAL[] = {
  KEY_TABLE("general", "scene", "General contact", PAGE, GENERAL),
  KEY_TABLE("pairs", "friction", "Friction of pairs of bodies", PAGE, PAIRS),
  KEY_TABLES_END};
