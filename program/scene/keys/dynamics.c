/* Keys of the step in time. */
#include "scene/keys.h"

static const Key DYNAMICS[] = {
  {"rho_inf", KEY_NUMBER, "", WITHIN(0, 1), REQUIRED, "what is left of the fastest oscillation after a step. 1 keeps the energy, see below"},
  {"mass_damping", KEY_NUMBER, "1/T", FROM(0), "0", "a of C = a M + b K. It brakes rigid motion, too"},
  {"stiffness_damping", KEY_NUMBER, "T", FROM(0), "0",
   "b. K is the stiffness of linear bodies. Of finite strain it is that of the undeformed body and brakes strains alone, see below"},
  {"contact_mass", KEY_WORD, "consistent spread", ANY, "consistent", "`spread`: non-mortar nodes have no mass, see below"},
};

const KeyTable KEYS_DYNAMICS[] = {KEY_TABLE("dynamics", "dynamics", "Dynamics", "docs/dynamics.md", DYNAMICS), KEY_TABLES_END};
