/* Keys of what a run writes. */
#include "scene/keys.h"

static const char PAGE[] = "c_examples/scenes/output.md";

static const Key OUTPUT[] = {
  {"vtu", KEY_WORD, "none last times all", ANY, "all",
   "after which steps there is a file of the bodies: the last, those at times that the scene names, all"},
  {"csv", KEY_WORD, "none last times all", ANY, "all", "the same of the interfaces' nodes"},
  {"restart_every", KEY_WHOLE, "", FROM(0), "0",
   "so many steps between restart files, `restart_STEP.bin` in the output folder; the last step has one, too. 0: there are none"},
  {"restart_keep", KEY_WHOLE, "", FROM(0), "1", "how many of them are kept, the newest. 0: all"},
  {"quiet", KEY_SWITCH, "", ANY, "false", "no progress lines"},
};

static const Key PROBES[] = {
  {"body", KEY_NAME, "name", ANY, REQUIRED, "the body of the vertex, whose displacement goes into summary.json"},
  {"point", KEY_NUMBERS, "`[x, y, z]` [L]", ANY, REQUIRED, "where it is"},
  {"tolerance", KEY_NUMBER, "L", ANY, "1e-6 of the body's size", "how far from `point` it may lie"},
};

static const Key PARAMETERS[] = {
  {"friction", KEY_NAME, "name of an interface", ANY, "", "its coefficient of friction"},
  {"shear_limit", KEY_NAME, "name of an interface", ANY, "", "its largest shear traction"},
  {"offset", KEY_NAME, "name of an interface", ANY, "", "an offset of all its non-mortar nodes [L]"},
  {"young", KEY_NAME, "name of a body", ANY, "", "its modulus"},
  {"load", KEY_NAME, "name of a load", ANY, "", "a factor on it: 1 as it is"},
  {"support", KEY_NAME, "name of a support", ANY, "", "a factor on all that it prescribes: 1 as it is"},
  {"deviation", KEY_NUMBER, "of the parameter", FROM(0), "0",
   "the parameter's standard deviation: with it come those of the results, as of parameters that do not depend on each other"},
};

const KeyTable KEYS_OUTPUT[] = {
  KEY_TABLE("output", "output", "Output", PAGE, OUTPUT),
  KEY_TABLE("probe", "probes", "A probe", PAGE, PROBES),
  KEY_TABLE("parameter", "parameters", "A parameter", PAGE, PARAMETERS),
  KEY_TABLES_END};
