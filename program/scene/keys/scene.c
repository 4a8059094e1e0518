/* Keys at the top level of a scene, and the lists that declare names. The other pages have more at the top level. */
#include "scene/keys.h"

static const Key LISTS[] = {
  {"bodies", KEY_LIST, "", ANY, REQUIRED, "meshes, boxes, planes and balls, rigid tools, with their materials: [bodies](bodies.md)"},
  {"surfaces", KEY_LIST, "", ANY, "", "parts of surfaces: [bodies](bodies.md#a-surface-cut-out-of-another)"},
  {"supports", KEY_LIST, "", ANY, "", "what moves and holds bodies: [supports and loads](loads.md#a-support)"},
  {"loads", KEY_LIST, "", ANY, "", "what presses them: [supports and loads](loads.md#a-load)"},
  {"springs", KEY_LIST, "", ANY, "", "springs to the ground or between bodies: [supports and loads](loads.md#a-spring)"},
  {"interfaces", KEY_LIST, "", ANY, "", "pairs of surfaces that touch: [below](#an-interface); all else in [interface](interface.md)"},
  {"temperatures", KEY_LIST, "", ANY, "", "of scenes with [heat](heat.md)"},
  {"flows", KEY_LIST, "", ANY, "", "of scenes with [heat](heat.md)"},
  {"probes", KEY_LIST, "", ANY, "", "vertices whose displacements are written: [output](output.md)"},
  {"parameters", KEY_LIST, "", ANY, "", "what reactions and probes are to be differentiated by: [output](output.md#what-follows-what)"},
};

static const Key SCENE[] = {
  {"schema", KEY_NUMBER, "", ANY, REQUIRED, "1: the version of the format"},
  {"frame", KEY_MAP, "", ANY, "", "turns the whole scene: [bodies](bodies.md#the-whole-scene-turned)"},
  {"steps", KEY_MAP, "", ANY, "one step to t = 1", "the times: [steps](steps.md)"},
  {"output", KEY_MAP, "", ANY, "all files", "which files are written: [output](output.md)"},
  {"heat", KEY_MAP, "", ANY, "", "temperatures: [heat](heat.md)"},
  {"dynamics", KEY_MAP, "", ANY, "", "inertia: [dynamics](../../docs/dynamics.md)"},
};

const KeyTable KEYS_SCENE[] = {
  KEY_TABLE("lists", "scene", "Lists of names", "c_examples/scenes/README.md", LISTS),
  KEY_TABLE("scene", "scene", "At the top level", "c_examples/scenes/README.md", SCENE),
  KEY_TABLES_END};
