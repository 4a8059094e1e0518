/* A history whose numbers fit the surfaces but cannot be theirs: other facets on as many nodes, another mesh with the same
 * facets, another law or slip measure; and, with a checksum that fits, normals that are not unit, positions at which a facet has no area. Taken in, it would give wrong forces or refuse every evaluation. */
#include "calls.h"

static handle h;
static history spoilt;

static void check_mismatch(const char *word) {
  CHECK_REFUSED(stickslip_interface_history_import(h.s.interface, spoilt.n_integers, spoilt.integers, spoilt.n_reals,
                                                   spoilt.reals),
                STICKSLIP_HISTORY_MISMATCH, word);
}

int main(void) {
  handle_init(&h);

  /* The same nodes, four facets that begin elsewhere. */
  static scene other;
  scene_init(&other);
  for (int f = 0; f < 4; ++f) {
    const int64_t first = other.nodes2[4 * f];
    memmove(other.nodes2 + 4 * f, other.nodes2 + 4 * f + 1, 3 * sizeof first);
    other.nodes2[4 * f + 3] = first;
  }
  scene_create(&other);
  history_take(other.interface, &spoilt);
  check_mismatch("facets");
  scene_destroy(&other);

  /* The same facets on another mesh: one coordinate in its last digit. */
  for (int side = 0; side < 2; ++side) {
    scene_init(&other);
    double *x = side ? other.reference2 : other.reference1;
    x[7] = nextafter(x[7], 1e30);
    scene_create(&other);
    history_take(other.interface, &spoilt);
    check_mismatch("another mesh");
    scene_destroy(&other);
  }

  /* What the numbers mean. */
  scene_init(&other);
  other.method.slip = STICKSLIP_SLIP_INCREMENT;
  scene_create(&other);
  history_take(other.interface, &spoilt);
  check_mismatch("slip increment");
  scene_destroy(&other);
  scene_init(&other);
  other.options.friction = STICKSLIP_FRICTION_ROUGH;
  other.options.mu = 0.0;
  scene_create(&other);
  history_take(other.interface, &spoilt);
  check_mismatch("rough");
  scene_destroy(&other);

  /* Others may go on with it: mu, augmentation, tolerances, the form. */
  scene_init(&other);
  other.options.mu = 0.1;
  other.method.augmentation = 70.0;
  other.method.coverage_min = 1e-3;
  other.method.form = STICKSLIP_FORM_AUGMENTED;
  scene_create(&other);
  CHECK_OK(stickslip_interface_history_import(other.interface, h.before.n_integers, h.before.integers, h.before.n_reals,
                                              h.before.reals));
  scene_destroy(&other);

  /* The reals are x1, x2, normals, ... */
  const int normals = X1 + X2;
  for (int a = 0; a < N1; ++a) {
    spoilt = h.before;
    for (int i = 0; i < 3; ++i) spoilt.reals[normals + 3 * a + i] *= 2.0;
    history_seal(&spoilt);
    check_mismatch("normal");
  }
  spoilt = h.before;
  for (int k = 0; k < X1; ++k) spoilt.reals[k] = 1.0;
  history_seal(&spoilt);
  check_mismatch("facet");
  handle_untouched(&h);
  scene_destroy(&h.s);
  return 0;
}
