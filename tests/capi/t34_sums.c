/* A parallel host: two handles hold the whole non-mortar surface and disjoint halves of the mortar facets. With their
 * sums exchanged, residuals and tangents add up to those of one handle. */
#include "scene.h"

/* The mortar facets [first, end) with the nodes that they use, renumbered. */
static void keep_facets(scene *s, int first, int end) {
  int64_t number[N2], n = 0;
  for (int c = 0; c < N2; ++c) number[c] = -1;
  for (int f = first; f < end; ++f) {
    for (int k = 0; k < 4; ++k) number[s->nodes2[4 * f + k]] = 0;
  }
  for (int c = 0; c < N2; ++c) {
    if (number[c] < 0) continue;
    for (int i = 0; i < 3; ++i) {
      s->reference2[3 * n + i] = s->reference2[3 * c + i];
      s->x2[3 * n + i] = s->x2[3 * c + i];
      s->equations2[3 * n + i] = s->equations2[3 * c + i];
    }
    number[c] = n++;
  }
  for (int k = 0; k < 4 * (end - first); ++k) s->nodes2[k] = number[s->nodes2[4 * first + k]];
  s->mortar.n_nodes = n;
  s->mortar.n_facets = end - first;
}

int main(void) {
  static scene whole, halves[2];
  static double k[UNKNOWNS * UNKNOWNS], k_sum[UNKNOWNS * UNKNOWNS];
  static triplets t;
  double r[UNKNOWNS], r_sum[UNKNOWNS], part[UNKNOWNS];
  double sums[STICKSLIP_SUMS_PER_NODE * N1], total[STICKSLIP_SUMS_PER_NODE * N1], own[STICKSLIP_SUMS_PER_NODE * N1];
  int32_t nobody[N1] = {0};

  scene_init(&whole);
  scene_create(&whole);
  for (int p = 0; p < 2; ++p) {
    scene_init(&halves[p]);
    keep_facets(&halves[p], p == 0 ? 0 : 5, p == 0 ? 5 : 9);
    if (p == 1) halves[p].nonmortar.owned = nobody; /* the first one adds the nodes' own blocks */
    scene_create(&halves[p]);
  }

  for (int step = 0; step < 3; ++step) {
    /* Stage 1, summed over the handles. */
    memset(total, 0, sizeof total);
    for (int p = 0; p < 2; ++p) {
      memcpy(halves[p].x1, whole.x1, sizeof whole.x1);
      CHECK_OK(stickslip_interface_sums(halves[p].interface, halves[p].x1, halves[p].x2, sums));
      for (int i = 0; i < COUNT(sums); ++i) total[i] += sums[i];
    }
    CHECK_OK(stickslip_interface_sums(whole.interface, whole.x1, whole.x2, own));
    for (int i = 0; i < COUNT(own); ++i) CHECK_NEAR(total[i], own[i], 1e-15);

    /* The other stages with the total. */
    scene_residual(&whole, r);
    memset(k, 0, sizeof k);
    memset(k_sum, 0, sizeof k_sum);
    memset(r_sum, 0, sizeof r_sum);
    scene_tangent(&whole, &t);
    triplets_add(&t, 0, k);
    for (int p = 0; p < 2; ++p) {
      scene *h = &halves[p];
      CHECK_OK(stickslip_interface_residual(h->interface, h->x1, h->x2, h->lambda, total, part, part + X1,
                                            part + X1 + X2));
      for (int i = 0; i < X1; ++i) r_sum[i] += part[i];
      for (int i = 0; i < 3 * h->mortar.n_nodes; ++i) r_sum[h->equations2[i]] += part[X1 + i];
      for (int i = X1 + X2; i < UNKNOWNS; ++i) r_sum[i] += part[i];
      CHECK_OK(stickslip_interface_tangent_coo(h->interface, h->x1, h->x2, h->lambda, total, MOST_ENTRIES, t.rows,
                                               t.columns, t.values, &t.n));
      triplets_add(&t, 0, k_sum);
    }
    for (int i = 0; i < UNKNOWNS; ++i) CHECK_NEAR(r_sum[i], r[i], 1e-14 * max_abs(r, UNKNOWNS));
    CHECK(block_difference(k_sum, k, 1e-3) < 1e-12);

    /* One handle with its own sums does what it does without. */
    double given[UNKNOWNS];
    CHECK_OK(stickslip_interface_residual(whole.interface, whole.x1, whole.x2, whole.lambda, own, given, given + X1,
                                          given + X1 + X2));
    CHECK(memcmp(given, r, sizeof r) == 0);

    /* The history moves on together too. */
    scene_commit(&whole);
    for (int p = 0; p < 2; ++p) {
      scene *h = &halves[p];
      CHECK_OK(stickslip_interface_commit(h->interface, h->x1, h->x2, h->lambda, total));
    }
    scene_slide(&whole, 0.11);
  }
  for (int p = 0; p < 2; ++p) scene_destroy(&halves[p]);
  scene_destroy(&whole);

  /* Sums may cover nodes that nothing here can, whoever made them: a tangent with them has what the count says. */
  scene_init(&whole);
  for (int f = 0; f < COUNT(whole.nodes2); f += 4) { /* looks away */
    const int64_t second = whole.nodes2[f + 1];
    whole.nodes2[f + 1] = whole.nodes2[f + 3];
    whole.nodes2[f + 3] = second;
  }
  scene_create(&whole);
  int64_t count;
  memset(total, 0, sizeof total);
  CHECK_OK(stickslip_interface_tangent_coo(whole.interface, whole.x1, whole.x2, whole.lambda, total, 0, NULL, NULL, NULL,
                                           &count));
  CHECK_OK(stickslip_interface_tangent_coo(whole.interface, whole.x1, whole.x2, whole.lambda, total, MOST_ENTRIES,
                                           t.rows, t.columns, t.values, &t.n));
  CHECK(count == 9 * N1 && t.n == count);
  scene_destroy(&whole);
  return 0;
}
