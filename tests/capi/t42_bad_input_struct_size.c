/* Sizes of structs: one shorter than the first version had is refused, a longer one only if it sets something that this
 * library does not know. */
#include "calls.h"

/* Sizes of the first version, the shortest that are accepted, of the structs that have grown since. */
enum { OPTIONS_1 = 88, COUNTERS_1 = 88 };

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

int main(void) {
  element_init(&e);
  handle_init(&h);
  const struct {
    const char *name;
    const void *value;
    size_t size, first;
    int32_t (*call)(const void *);
  } inputs[] = {
      {"stickslip_pair", &e.pair, sizeof e.pair, sizeof e.pair, pair_call},
      {"stickslip_node", &e.node, sizeof e.node, sizeof e.node, node_call},
      {"stickslip_node_response", &e.responses[0], sizeof e.responses[0], sizeof e.responses[0], response_call},
      {"stickslip_states", &h.states, sizeof h.states, sizeof h.states, states_call},
      {"stickslip_surface", &h.s.nonmortar, sizeof h.s.nonmortar, sizeof h.s.nonmortar, nonmortar_call},
      {"stickslip_surface", &h.s.mortar, sizeof h.s.mortar, sizeof h.s.mortar, mortar_call},
      {"stickslip_options", &h.s.options, sizeof h.s.options, OPTIONS_1, options_call},
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

  /* Outputs. A longer one is filled as far as it is known; its size and its tail stay. */
  counters.struct_size = COUNTERS_1 - 1;
  CHECK_REFUSED(stickslip_interface_counters(h.s.interface, &counters), STICKSLIP_STRUCT_SIZE, "stickslip_counters");
  struct {
    stickslip_counters known;
    uint64_t tail;
  } newer;
  newer.known.struct_size = sizeof newer;
  newer.tail = 77;
  CHECK_OK(stickslip_interface_counters(h.s.interface, &newer.known));
  CHECK(newer.known.struct_size == sizeof newer && newer.tail == 77 && newer.known.searches > 0);

  stickslip_node_response response;
  FILL(response);
  response.struct_size = sizeof response + 8000;
  CHECK_REFUSED(stickslip_node_respond(&e.node, &response), STICKSLIP_STRUCT_SIZE, "stickslip_node_response");
  check_untouched(&response.state, sizeof response - 8, __FILE__, __LINE__, "response");

  stickslip_options options;
  FILL(options);
  CHECK_REFUSED(stickslip_options_init(&options, OPTIONS_1 - 1), STICKSLIP_STRUCT_SIZE, "struct_size");
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
