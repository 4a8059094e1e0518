/* Input whose values each are fine and do not fit each other, which is no matter of one value as in bad_input.txt:
 * histories that are damaged, with a checksum that fits, or of another interface; a matrix that lacks an entry; an
 * equation of the largest number. No twin in Fortran: these are values in arrays, which the library reads alike. */
#include "calls.h"

static handle h;
static history spoilt;

static int32_t import(void) {
  return stickslip_interface_history_import(h.s.interface, spoilt.n_integers, spoilt.integers, spoilt.n_reals,
                                            spoilt.reals);
}

#define MISMATCH(word) CHECK_REFUSED(import(), STICKSLIP_HISTORY_MISMATCH, (word))
/* With a checksum that fits. */
#define SEALED_MISMATCH(word) (history_seal(&spoilt), MISMATCH(word))

/* Any bit that has flipped. */
static void flips(void) {
  uint64_t random = 3;
  for (int k = 0; k < 20000; ++k) {
    spoilt = h.before;
    const int64_t words = spoilt.n_integers + spoilt.n_reals;
    const int64_t at = (int64_t)((random_number(&random) + 1.0) / 2.0 * (double)(words - 1));
    const uint64_t bit = (uint64_t)1 << (int)((random_number(&random) + 1.0) / 2.0 * 63.0);
    uint64_t word;
    void *place = at < spoilt.n_integers ? (void *)(spoilt.integers + at)
                                         : (void *)(spoilt.reals + (at - spoilt.n_integers));
    memcpy(&word, place, sizeof word);
    word ^= bit;
    memcpy(place, &word, sizeof word);
    const int32_t status = import();
    CHECK(status == STICKSLIP_HISTORY_MISMATCH || status == STICKSLIP_NOT_FINITE);
  }
}

static void histories(void) {
  handle_init(&h);
  flips();

  /* Integers: layout, checksum, meaning, commits, nodes of both sides, pairs; then the pairs' facets. */
  const int64_t values[] = {INT64_MIN, -1, 1, 1000, INT64_MAX};
  for (int at = 0; at <= HISTORY_PAIRS; ++at) {
    for (int k = 0; k < COUNT(values); ++k) {
      if (at == HISTORY_COMMITS && values[k] >= 0) continue; /* any number of steps may have been committed */
      if (at == HISTORY_CHECKSUM || h.before.integers[at] == values[k]) continue;
      spoilt = h.before;
      spoilt.integers[at] = values[k];
      MISMATCH(at == 0 ? "" : "checksum");
      SEALED_MISMATCH("");
    }
  }
  for (int at = HISTORY_FACETS; at < h.before.n_integers; ++at) {
    for (int k = 0; k < COUNT(values); ++k) {
      if (values[k] == 1) continue; /* a facet that exists */
      spoilt = h.before;
      spoilt.integers[at] = values[k];
      SEALED_MISMATCH("facets");
    }
  }
  spoilt = h.before; /* unsorted */
  const int first = HISTORY_FACETS, second = HISTORY_FACETS + 2;
  memcpy(spoilt.integers + first, h.before.integers + second, 2 * sizeof(int64_t));
  memcpy(spoilt.integers + second, h.before.integers + first, 2 * sizeof(int64_t));
  SEALED_MISMATCH("sorted");
  /* The layouts of older versions, by name. */
  for (int layout = 1; layout <= 5; ++layout) {
    spoilt = h.before;
    spoilt.integers[0] = 0x571C00 + layout;
    SEALED_MISMATCH("older library version");
  }

  /* Lengths: those with an old checksum stand in bad_input.txt. */
  for (int64_t by = -1; by < 2; by += 2) {
    spoilt = h.before;
    spoilt.n_reals += by;
    SEALED_MISMATCH("reals");
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
    SEALED_MISMATCH("area");
  }
  handle_untouched(&h);

  /* The largest number of commits can be continued from. */
  spoilt = h.before;
  spoilt.integers[HISTORY_COMMITS] = INT64_MAX;
  history_seal(&spoilt);
  CHECK_OK(import());
  CHECK_OK(call_interface_commit(&h));
  scene_destroy(&h.s);
}

/* Each entry that the tangent needs, missing once. */
static void entries(void) {
  static triplets t;
  handle_init(&h);
  scene_tangent(&h.s, &t);
  for (int64_t e = 0; e < t.n; e += 1 + t.n / 40) {
    const int64_t row = t.rows[e], at = row * UNKNOWNS + t.columns[e];
    h.csr_columns[at] = row == 0 ? 1 : 0; /* twice in its row: allowed, but another one is gone */
    if (t.columns[e] == h.csr_columns[at]) h.csr_columns[at] = 2;
    CHECK_REFUSED(call_interface_csr(&h), STICKSLIP_MISSING_ENTRY, "pattern");
    h.csr_columns[at] = t.columns[e];
  }
  handle_untouched(&h);
  scene_destroy(&h.s);
}

/* Equations near the end of the integers come back as they are; a matrix without their rows is refused. */
static void last_equation(void) {
  handle_init(&h);
  scene_destroy(&h.s);
  h.s.equations1[4] = INT64_MAX;
  scene_create(&h.s);
  scene_commit(&h.s);
  history_take(h.s.interface, &h.before);
  const int32_t status = call_interface_csr(&h);
  CHECK(status == STICKSLIP_INDEX_OUT_OF_RANGE || status == STICKSLIP_MISSING_ENTRY);
  CHECK(strstr(stickslip_last_error_message(), "9223372036854775807") != NULL);
  handle_untouched(&h);
  CHECK_OK(call_interface_coo(&h));
  int seen = 0;
  for (int64_t e = 0; e < h.count; ++e) seen += h.row_numbers[e] == INT64_MAX;
  CHECK(seen > 0);
  scene_destroy(&h.s);
}

int main(void) {
  histories();
  entries();
  last_equation();
  return 0;
}
