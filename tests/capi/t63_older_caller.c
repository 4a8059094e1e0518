/* A caller that was compiled with the first version of the header: its structs end earlier, and what lies behind them
 * is its own, neither read nor written. */
#include "scene.h"

/* The sizes of the first version. */
enum { OPTIONS_1 = 88, COUNTERS_1 = 88 };

/* A struct as that caller has it, and what lies behind. */
typedef union {
  uint64_t struct_size;
  unsigned char bytes[256];
  stickslip_options options;
  stickslip_counters counters;
} older;

static void check_behind(const older *o, int size) {
  check_untouched(o->bytes + size, sizeof o->bytes - (size_t)size, __FILE__, __LINE__, "what lies behind the struct");
}

int main(void) {
  static scene s;
  older options, counters;
  double r[UNKNOWNS], q[UNKNOWNS];

  FILL(options);
  CHECK_OK(stickslip_options_init(&options.options, OPTIONS_1));
  check_behind(&options, OPTIONS_1);
  CHECK(options.struct_size == OPTIONS_1 && !options.options.method && options.options.mu == 0.0);
  CHECK(options.options.search_distance == 0.0);
  /* Too short even for that caller. */
  older again = options;
  CHECK_REFUSED(stickslip_options_init(&again.options, OPTIONS_1 - 8), STICKSLIP_STRUCT_SIZE, "options");
  CHECK(memcmp(&again, &options, sizeof again) == 0);

  /* An interface made with them answers as one of a caller of today; all shortcuts are taken. */
  scene_init(&s);
  options.options.mu = s.options.mu;
  options.options.method = &s.method;
  scene_create(&s);
  scene_residual(&s, r);
  scene_destroy(&s);
  CHECK_OK(stickslip_interface_create(&s.nonmortar, &s.mortar, &options.options, &s.interface));
  check_behind(&options, OPTIONS_1);
  scene_residual(&s, q);
  CHECK(memcmp(r, q, sizeof r) == 0);

  stickslip_counters now;
  now.struct_size = sizeof now;
  FILL(counters);
  counters.struct_size = COUNTERS_1;
  CHECK_OK(stickslip_interface_counters(s.interface, &now));
  CHECK_OK(stickslip_interface_counters(s.interface, &counters.counters));
  check_behind(&counters, COUNTERS_1);
  CHECK(counters.struct_size == COUNTERS_1);
  CHECK(memcmp(counters.bytes + 8, (unsigned char *)&now + 8, COUNTERS_1 - 8) == 0);
  FILL(counters);
  counters.struct_size = COUNTERS_1 - 8;
  CHECK_REFUSED(stickslip_interface_counters(s.interface, &counters.counters), STICKSLIP_STRUCT_SIZE,
                "stickslip_counters");
  check_behind(&counters, 8);
  scene_destroy(&s);

  /* A refusal names the option at fault, as ever. */
  options.options.mu = -1.0;
  CHECK_REFUSED(stickslip_interface_create(&s.nonmortar, &s.mortar, &options.options, &s.interface),
                STICKSLIP_INVALID_VALUE, "options.mu");
  check_behind(&options, OPTIONS_1);
  return 0;
}
