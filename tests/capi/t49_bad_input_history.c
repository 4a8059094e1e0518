/* A history that is corrupt or belongs to another interface is refused as a whole. */
#include "calls.h"

static handle h;
static history spoilt;

static int32_t import(void) {
  return stickslip_interface_history_import(h.s.interface, spoilt.n_integers, spoilt.integers, spoilt.n_reals,
                                            spoilt.reals);
}

#define MISMATCH(word) CHECK_REFUSED(import(), STICKSLIP_HISTORY_MISMATCH, (word))

int main(void) {
  handle_init(&h);

  /* Integers: layout, commits, nodes of both sides, pairs; then the pairs' facets. */
  const int64_t values[] = {INT64_MIN, -1, 1, 1000, INT64_MAX};
  for (int at = 0; at < 5; ++at) {
    for (int k = 0; k < COUNT(values); ++k) {
      if (at == 1 && values[k] >= 0) continue; /* any number of steps may have been committed */
      spoilt = h.before;
      spoilt.integers[at] = values[k];
      MISMATCH("");
    }
  }
  for (int at = 5; at < h.before.n_integers; ++at) {
    for (int k = 0; k < COUNT(values); ++k) {
      if (values[k] == 1) continue; /* a facet that exists */
      spoilt = h.before;
      spoilt.integers[at] = values[k];
      MISMATCH("facets");
    }
  }
  spoilt = h.before; /* unsorted */
  memcpy(spoilt.integers + 6, h.before.integers + 8, 2 * sizeof(int64_t));
  memcpy(spoilt.integers + 8, h.before.integers + 6, 2 * sizeof(int64_t));
  MISMATCH("sorted");

  /* Lengths. */
  const int64_t lengths[] = {0, 1, 4, 5, h.before.n_integers - 1, h.before.n_integers + 1};
  for (int k = 0; k < COUNT(lengths); ++k) {
    spoilt = h.before;
    spoilt.n_integers = lengths[k];
    MISMATCH("integers");
  }
  for (int64_t by = -1; by < 2; by += 2) {
    spoilt = h.before;
    spoilt.n_reals += by;
    MISMATCH("reals");
  }

  /* Of an interface with other surfaces. */
  static scene other;
  scene_init(&other);
  other.mortar.n_facets = 6;
  other.mortar.n_nodes = 12;
  scene_create(&other);
  history_take(other.interface, &spoilt);
  MISMATCH("nodes");
  scene_destroy(&other);

  handle_untouched(&h);

  /* Numbers that cannot be: areas that are not positive. The reals are x1, x2, normals, gaps, slip (3 each),
   * areas, coverage, weights. */
  const int areas = X1 + X2 + 3 * X1;
  for (int a = 0; a < N1; ++a) {
    spoilt = h.before;
    spoilt.reals[areas + a] = a % 2 ? 0.0 : -1.0;
    MISMATCH("area");
  }
  handle_untouched(&h);

  /* The largest number of commits can be continued from. */
  spoilt = h.before;
  spoilt.integers[1] = INT64_MAX;
  CHECK_OK(import());
  CHECK_OK(call_interface_commit(&h));
  scene_destroy(&h.s);
  return 0;
}
