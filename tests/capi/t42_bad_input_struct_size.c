/* Sizes of structs. An older caller's one is shorter, but not shorter than in the first version; a newer caller's one is
 * longer, and refused only if it sets something that this library does not know. The sizes of the first version are
 * written out: they never change, whatever the structs grow to. */
#include "calls.h"

static element e;
static handle h;
static stickslip_counters counters;

static int32_t pair_call(const void *p) { return stickslip_pair_weights(p, e.w_out.ab, e.w_out.ac, NULL, NULL); }
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

enum { FIRST_PAIR = 40, FIRST_NODE = 224, FIRST_RESPONSE = 408, FIRST_STATES = 80, FIRST_SURFACE = 72 };
enum { FIRST_OPTIONS = 88, FIRST_COUNTERS = 88 };

int main(void) {
  element_init(&e);
  handle_init(&h);
  const struct {
    const char *name;
    const void *value;
    size_t size, first;
    int32_t (*call)(const void *);
  } inputs[] = {
      {"stickslip_pair", &e.pair, sizeof e.pair, FIRST_PAIR, pair_call},
      {"stickslip_node", &e.node, sizeof e.node, FIRST_NODE, node_call},
      {"stickslip_node_response", &e.responses[0], sizeof e.responses[0], FIRST_RESPONSE, response_call},
      {"stickslip_states", &h.states, sizeof h.states, FIRST_STATES, states_call},
      {"stickslip_surface", &h.s.nonmortar, sizeof h.s.nonmortar, FIRST_SURFACE, nonmortar_call},
      {"stickslip_surface", &h.s.mortar, sizeof h.s.mortar, FIRST_SURFACE, mortar_call},
      {"stickslip_options", &h.s.options, sizeof h.s.options, FIRST_OPTIONS, options_call},
  };
  for (int k = 0; k < COUNT(inputs); ++k) {
    /* A buffer of the largest size accepted, for the library reads what a struct declares. */
    union {
      uint64_t size;
      unsigned char bytes[4096];
    } longer;
    memset(&longer, 0, sizeof longer);
    memcpy(&longer, inputs[k].value, inputs[k].size);
    const uint64_t wrong[] = {0, 1, 8, inputs[k].first - 1, 4097, UINT64_MAX, (uint64_t)INT64_MAX + 1};
    for (int w = 0; w < COUNT(wrong); ++w) {
      longer.size = wrong[w];
      CHECK_REFUSED(inputs[k].call(&longer), STICKSLIP_STRUCT_SIZE, inputs[k].name);
    }
    /* The first version's caller: accepted, and nothing behind its struct is read. */
    longer.size = inputs[k].first;
    memset(longer.bytes + inputs[k].first, 0x5A, sizeof longer - inputs[k].first);
    if (inputs[k].call != response_call && inputs[k].call != states_call) element_init(&e);
    CHECK_OK(inputs[k].call(&longer));
    memset(&longer, 0, sizeof longer);
    memcpy(&longer, inputs[k].value, inputs[k].size);
    /* A newer caller's struct, the unknown tail all zero: accepted. */
    const uint64_t newer[] = {inputs[k].size + 1, inputs[k].size + 8, 4096};
    for (int n = 0; n < COUNT(newer); ++n) {
      longer.size = newer[n];
      if (inputs[k].call != response_call && inputs[k].call != states_call) element_init(&e);
      CHECK_OK(inputs[k].call(&longer));
      /* With any bit set there, refused. */
      longer.bytes[newer[n] - 1] = 1;
      CHECK_REFUSED(inputs[k].call(&longer), STICKSLIP_STRUCT_SIZE, inputs[k].name);
      longer.bytes[newer[n] - 1] = 0;
    }
  }

  /* Outputs. A shorter one is filled as far as it reaches; a longer one as far as it is known, the rest with zeros, so
   * that it may be passed on; its size stays. */
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
  counters.struct_size = FIRST_COUNTERS - 1;
  CHECK_REFUSED(stickslip_interface_counters(h.s.interface, &counters), STICKSLIP_STRUCT_SIZE, "stickslip_counters");
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

  stickslip_node_response response;
  FILL(response);
  response.struct_size = sizeof response + 8000;
  CHECK_REFUSED(stickslip_node_respond(&e.node, &response), STICKSLIP_STRUCT_SIZE, "stickslip_node_response");
  check_untouched(&response.state, sizeof response - 8, __FILE__, __LINE__, "response");

  stickslip_options options;
  FILL(options);
  CHECK_REFUSED(stickslip_options_init(&options, FIRST_OPTIONS - 8), STICKSLIP_STRUCT_SIZE, "struct_size");
  CHECK_REFUSED(stickslip_options_init(&options, 0), STICKSLIP_STRUCT_SIZE, "struct_size");
  CHECK_UNTOUCHED(options);

  /* A newer caller's longer struct: defaults, and zeros in what this library does not know. */
  struct {
    stickslip_options known;
    double unknown[2];
  } grown;
  FILL(grown);
  CHECK(stickslip_options_init(&grown.known, sizeof grown) == STICKSLIP_OK);
  CHECK(grown.known.struct_size == sizeof grown && grown.known.coverage_min == 1e-8);
  CHECK(grown.unknown[0] == 0.0 && grown.unknown[1] == 0.0);

  /* Responses of different size in one array: each says its own, the first one sets the distance. */
  element_init(&e);
  e.responses[2].struct_size = 8;
  CHECK_REFUSED(call_tangent(&e), STICKSLIP_STRUCT_SIZE, "stickslip_node_response");
  element_untouched(&e);
  scene_destroy(&h.s);
  return 0;
}
