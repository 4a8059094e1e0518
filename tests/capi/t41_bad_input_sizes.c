/* Sizes of structs that are accepted; bad_input.txt has those that are refused. An older caller's struct is shorter,
 * but not shorter than in the first version; a newer caller's one is longer, and refused only if it sets something that
 * this library does not know. The sizes of the first version are written out: they never change, whatever the structs
 * grow to. None of this stands in a row, because it needs structs that the header does not have. */
#include "calls.h"

static element e;
static handle h;

static int32_t pair_call(const void *p) { return stickslip_pair_weights(p, e.w_out.ab, e.w_out.ac, NULL, NULL); }
static int32_t facet_call(const void *p) {
  return stickslip_facet_tangent(p, e.w.ab, e.w.ac, NULL, NULL, e.traction, e.responses, NULL, e.facet_k, 36);
}
static int32_t node_call(const void *p) { return stickslip_node_respond(p, &e.responses[3]); }
static int32_t response_call(const void *p) { return stickslip_node_block(p, 1.0, 0, e.row, e.block); }
static int32_t states_call(const void *p) {
  return stickslip_interface_states(h.s.interface, h.s.x1, h.s.x2, h.s.lambda, NULL, p);
}
static int32_t create(const void *one, const void *two, const void *options) {
  stickslip_interface *out = NULL;
  const int32_t status = stickslip_interface_create(one, two, options, &out);
  CHECK((out != NULL) == (status == STICKSLIP_OK));
  if (out) CHECK_OK(stickslip_interface_destroy(&out));
  return status;
}
static int32_t nonmortar_call(const void *p) { return create(p, &h.s.mortar, &h.s.options); }
static int32_t mortar_call(const void *p) { return create(&h.s.nonmortar, p, &h.s.options); }
static int32_t options_call(const void *p) { return create(&h.s.nonmortar, &h.s.mortar, p); }

enum { FIRST_PAIR = 40, FIRST_NODE = 224, FIRST_RESPONSE = 408, FIRST_STATES = 80, FIRST_SURFACE = 72, FIRST_FACET = 72 };
enum { FIRST_OPTIONS = 88, FIRST_COUNTERS = 88 };

/* Structs that go in: of the first version, and longer ones. */
static void inputs(void) {
  const struct {
    const char *name;
    const void *value;
    size_t size, first;
    int32_t (*call)(const void *);
  } all[] = {
      {"stickslip_pair", &e.pair, sizeof e.pair, FIRST_PAIR, pair_call},
      {"stickslip_facet", &e.facet, sizeof e.facet, FIRST_FACET, facet_call},
      {"stickslip_node", &e.node, sizeof e.node, FIRST_NODE, node_call},
      {"stickslip_node_response", &e.responses[0], sizeof e.responses[0], FIRST_RESPONSE, response_call},
      {"stickslip_states", &h.states, sizeof h.states, FIRST_STATES, states_call},
      {"stickslip_surface", &h.s.nonmortar, sizeof h.s.nonmortar, FIRST_SURFACE, nonmortar_call},
      {"stickslip_surface", &h.s.mortar, sizeof h.s.mortar, FIRST_SURFACE, mortar_call},
      {"stickslip_options", &h.s.options, sizeof h.s.options, FIRST_OPTIONS, options_call},
  };
  for (int k = 0; k < COUNT(all); ++k) {
    /* A buffer of the largest size accepted, for the library reads what a struct declares. */
    union {
      uint64_t size;
      unsigned char bytes[4096];
    } longer;
    /* The first version's caller: accepted, and nothing behind its struct is read. */
    FILL(longer);
    memcpy(&longer, all[k].value, all[k].first);
    longer.size = all[k].first;
    CHECK_OK(all[k].call(&longer));
    /* A newer caller's struct, the unknown tail all zero: accepted. With any bit set there, refused. */
    memset(&longer, 0, sizeof longer);
    memcpy(&longer, all[k].value, all[k].size);
    const uint64_t newer[] = {all[k].size + 1, all[k].size + 8, 4096};
    for (int n = 0; n < COUNT(newer); ++n) {
      longer.size = newer[n];
      CHECK_OK(all[k].call(&longer));
      longer.bytes[newer[n] - 1] = 1;
      CHECK_REFUSED(all[k].call(&longer), STICKSLIP_STRUCT_SIZE, all[k].name);
      longer.bytes[newer[n] - 1] = 0;
    }
  }
}

/* Structs that come out. A shorter one is filled as far as it reaches; a longer one as far as it is known, the rest
 * with zeros, so that it may be passed on; its size stays. */
static void outputs(void) {
  struct {
    union {
      uint64_t size;
      unsigned char bytes[FIRST_COUNTERS];
    } first;
    uint64_t behind;
  } older;
  older.first.size = FIRST_COUNTERS;
  older.behind = 77;
  CHECK_OK(stickslip_interface_counters(h.s.interface, (stickslip_counters *)(void *)&older));
  CHECK(older.first.size == FIRST_COUNTERS && older.behind == 77);
  struct {
    stickslip_counters known;
    uint64_t tail;
  } newer;
  newer.known.struct_size = sizeof newer;
  newer.tail = 77;
  CHECK_OK(stickslip_interface_counters(h.s.interface, &newer.known));
  CHECK(newer.known.struct_size == sizeof newer && newer.tail == 0 && newer.known.searches > 0);

  /* A newer caller's responses go from one call into the next as they are. */
  struct {
    stickslip_node_response known;
    double unknown;
  } passed;
  FILL(passed);
  passed.known.struct_size = sizeof passed;
  CHECK_OK(stickslip_node_respond(&e.node, &passed.known));
  CHECK(passed.unknown == 0.0);
  CHECK_OK(stickslip_node_block(&passed.known, 1.0, 0, e.row, e.block));

  /* A newer caller's options: defaults, and zeros in what this library does not know. */
  struct {
    stickslip_options known;
    double unknown[2];
  } grown;
  FILL(grown);
  CHECK_OK(stickslip_options_init(&grown.known, sizeof grown));
  CHECK(grown.known.struct_size == sizeof grown && !grown.known.method);
  CHECK(grown.unknown[0] == 0.0 && grown.unknown[1] == 0.0);
}

int main(void) {
  element_init(&e);
  handle_init(&h);
  inputs();
  outputs();
  scene_destroy(&h.s);
  return 0;
}
