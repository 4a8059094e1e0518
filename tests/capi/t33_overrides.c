/* What a host may set per node: friction, augmentation, normals, prescribed directions; and which nodes it owns. */
#include "scene.h"

static double r[UNKNOWNS], q[UNKNOWNS];
static int32_t state[N1];
static double normal[X1], augmentation[N1], traction[X1];

static void states(scene *s) {
  stickslip_states out;
  memset(&out, 0, sizeof out);
  out.struct_size = sizeof out;
  out.state = state;
  out.normal = normal;
  out.augmentation = augmentation;
  out.traction = traction;
  CHECK_OK(stickslip_interface_states(s->interface, s->x1, s->x2, s->lambda, NULL, &out));
}

int main(void) {
  static scene s;
  scene_init(&s);
  scene_create(&s);
  scene_residual(&s, r);

  /* The options' own values, given per node, change no bit; others do. */
  double mu[N1], given[N1], normals[X1];
  states(&s);
  for (int a = 0; a < N1; ++a) mu[a] = 0.7;
  memcpy(given, augmentation, sizeof given);
  memcpy(normals, normal, sizeof normals);
  CHECK_OK(stickslip_interface_set_friction(s.interface, mu));
  CHECK_OK(stickslip_interface_set_augmentation(s.interface, given));
  CHECK_OK(stickslip_interface_set_normals(s.interface, normals));
  scene_residual(&s, q);
  CHECK(memcmp(r, q, sizeof r) == 0);

  for (int a = 0; a < N1; ++a) {
    mu[a] = 0.0;
    given[a] *= 4.0;
    /* Turned in the surface's plane and out of it, still unit. */
    const double axis[3] = {1.0, 0.0, 0.0};
    scene_turn(normals + 3 * a, axis, 0.1);
  }
  CHECK_OK(stickslip_interface_set_friction(s.interface, mu));
  states(&s);
  for (int a = 0; a < N1; ++a) CHECK(state[a] != STICKSLIP_STATE_STICK);
  CHECK_OK(stickslip_interface_set_augmentation(s.interface, given));
  CHECK_OK(stickslip_interface_set_normals(s.interface, normals));
  states(&s);
  CHECK(memcmp(augmentation, given, sizeof given) == 0);
  CHECK(memcmp(normal, normals, sizeof normals) == 0);

  /* NULL returns to the library's own. */
  for (int a = 0; a < N1; ++a) mu[a] = 0.7;
  CHECK_OK(stickslip_interface_set_friction(s.interface, mu));
  CHECK_OK(stickslip_interface_set_augmentation(s.interface, NULL));
  CHECK_OK(stickslip_interface_set_normals(s.interface, NULL));
  scene_residual(&s, q);
  CHECK(memcmp(r, q, sizeof r) == 0);

  /* A direction prescribed on both sides: no traction and no normal in it; n = 0 clears. Any length will do. */
  double direction[3] = {0.0, 2.5, 0.0};
  scene_frame(direction);
  const int64_t node = 4;
  CHECK_OK(stickslip_interface_set_constraints(s.interface, 1, &node, direction));
  states(&s);
  double along = 0.0, out_of = 0.0;
  for (int i = 0; i < 3; ++i) {
    along += normal[12 + i] * direction[i];
    out_of += traction[12 + i] * direction[i];
  }
  CHECK_NEAR(along, 0.0, 1e-15);
  CHECK_NEAR(out_of, 0.0, 1e-15);
  CHECK_OK(stickslip_interface_set_constraints(s.interface, 0, NULL, NULL));
  scene_residual(&s, q);
  CHECK(memcmp(r, q, sizeof r) == 0);
  scene_destroy(&s);

  /* Two handles of the same surfaces that own complementary nodes: rows and node blocks add up to one handle's. */
  static scene parts[2];
  static triplets t;
  static double k[UNKNOWNS * UNKNOWNS], sum[UNKNOWNS * UNKNOWNS];
  int32_t owned[2][N1];
  scene_init(&s);
  scene_create(&s);
  scene_tangent(&s, &t);
  triplets_add(&t, 0, k);
  double rows[X1], total[X1];
  memset(total, 0, sizeof total);
  for (int p = 0; p < 2; ++p) {
    scene_init(&parts[p]);
    for (int a = 0; a < N1; ++a) owned[p][a] = (a % 3 == 0) == (p == 0);
    parts[p].nonmortar.owned = owned[p];
    scene_create(&parts[p]);
    CHECK_OK(stickslip_interface_residual(parts[p].interface, s.x1, s.x2, s.lambda, NULL, q, q + X1, rows));
    for (int i = 0; i < X1; ++i) {
      total[i] += rows[i];
      if (!owned[p][i / 3]) CHECK(rows[i] == 0.0);
    }
    scene_tangent(&parts[p], &t);
    triplets_add(&t, 0, sum);
    scene_destroy(&parts[p]);
  }
  CHECK(memcmp(total, r + X1 + X2, sizeof total) == 0);
  /* The diagonal blocks of the multipliers hold nothing but the nodes' own part. */
  for (int i = X1 + X2; i < UNKNOWNS; ++i) {
    for (int j = X1 + X2; j < UNKNOWNS; ++j) CHECK(sum[i * UNKNOWNS + j] == k[i * UNKNOWNS + j]);
  }
  scene_destroy(&s);
  return 0;
}
