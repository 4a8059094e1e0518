/* A mortar side without equations, and what the library leaves out by itself: not a bit of the residual changes.
 * Misuse is refused; the interface says in sentences what it computes and why. */
#include "scene.h"

static const int32_t ALL = STICKSLIP_SHORTCUT_FRICTIONLESS | STICKSLIP_SHORTCUT_RIGID | STICKSLIP_SHORTCUT_APART |
                           STICKSLIP_SHORTCUT_UNCOVERED;

static triplets t, u;

static stickslip_counters counters_of(scene *s) {
  stickslip_counters counters;
  counters.struct_size = sizeof counters;
  CHECK_OK(stickslip_interface_counters(s->interface, &counters));
  /* Each node was treated in one way. */
  const int64_t nodes = counters.nodes_frictional + counters.nodes_frictionless + counters.nodes_new +
                        counters.nodes_tied + counters.nodes_uncovered + counters.nodes_left_out;
  CHECK(nodes == N1);
  return counters;
}

static int says(scene *s, const char *words) {
  char text[1000];
  FILL(text);
  CHECK_OK(stickslip_interface_effects(s->interface, text, sizeof text));
  CHECK(memchr(text, 0, sizeof text) != NULL);
  return strstr(text, words) != NULL;
}

static void prescribe(scene *s) {
  for (int i = 0; i < X2; ++i) s->equations2[i] = -1;
}

int main(void) {
  static scene s, full;
  static double k[UNKNOWNS * UNKNOWNS], expected[UNKNOWNS * UNKNOWNS];
  double r[UNKNOWNS], q[UNKNOWNS];

  /* Rigid, asked for or chosen, against a deformable side without equations. */
  for (int asked = 0; asked < 2; ++asked) {
    scene_init(&s);
    scene_init(&full);
    prescribe(&s);
    prescribe(&full);
    s.options.mortar_side = asked ? STICKSLIP_MORTAR_RIGID : STICKSLIP_MORTAR_DEFORMABLE;
    full.method.no_shortcuts = ALL;
    scene_create(&s);
    scene_create(&full);
    scene_residual(&s, r);
    scene_residual(&full, q);
    CHECK(memcmp(r, q, sizeof r) == 0);
    scene_tangent(&s, &t);
    scene_tangent(&full, &u);
    memset(k, 0, sizeof k);
    memset(expected, 0, sizeof expected);
    triplets_add(&t, 0, k);
    triplets_add(&u, 0, expected);
    CHECK(block_difference(k, expected, 1e-3) <= 1e-12);
    CHECK(says(&s, asked ? "rigid (asked for)" : "rigid (chosen: no mortar node has an equation)"));
    CHECK(says(&full, "as deformable"));
    scene_destroy(&s);
    scene_destroy(&full);
  }

  /* mu = 0 at every node: no slip is computed, until there is friction. */
  double mu[N1] = {0};
  scene_init(&s);
  scene_init(&full);
  s.options.mu = full.options.mu = 0.0;
  full.method.no_shortcuts = ALL;
  scene_create(&s);
  scene_create(&full);
  CHECK(says(&s, "chosen: mu is 0 at every node") && says(&full, "Coulomb's law with mu 0"));
  scene_residual(&s, r);
  scene_residual(&full, q);
  CHECK(memcmp(r, q, sizeof r) == 0);
  CHECK(counters_of(&s).nodes_slipping == 0 && counters_of(&full).nodes_slipping == N1);
  scene_commit(&s);
  scene_commit(&full);
  mu[4] = 0.4;
  CHECK_OK(stickslip_interface_set_friction(s.interface, mu));
  CHECK_OK(stickslip_interface_set_friction(full.interface, mu));
  CHECK(says(&s, "mu from 0 to 0.4"));
  scene_slide(&s, 0.05);
  scene_slide(&full, 0.05);
  scene_residual(&s, r);
  scene_residual(&full, q);
  CHECK(memcmp(r, q, sizeof r) == 0 && counters_of(&s).nodes_slipping == N1);
  scene_destroy(&s);
  scene_destroy(&full);

  /* Far apart: a comparison. The history is made up for when it is asked for. */
  static history made_up, searched;
  scene_init(&s);
  scene_init(&full);
  full.method.no_shortcuts = STICKSLIP_SHORTCUT_APART;
  double up[3] = {0.0, 0.0, 30.0};
  scene_frame(up);
  for (int i = 0; i < X1; ++i) {
    s.reference1[i] += up[i % 3];
    full.reference1[i] += up[i % 3];
    s.x1[i] += up[i % 3];
    full.x1[i] += up[i % 3];
    s.lambda[i] = full.lambda[i] = 0.0;
  }
  scene_create(&s);
  scene_create(&full);
  scene_residual(&s, r);
  scene_residual(&full, q);
  for (int i = 0; i < UNKNOWNS; ++i) CHECK(r[i] == q[i]);
  scene_commit(&s);
  scene_commit(&full);
  const stickslip_counters cheap = counters_of(&s), dear = counters_of(&full);
  CHECK(cheap.pairs_tested == 0 && cheap.searches == 0 && cheap.evaluations_apart == 1 && cheap.commits_apart == 2);
  CHECK(dear.pairs_tested > 0 && dear.searches > 0 && dear.evaluations_apart == 0 && dear.commits_apart == 0);
  CHECK(cheap.nodes_left_out == N1 && cheap.nodes_evaluated == 0);
  CHECK(dear.nodes_left_out == 0 && dear.nodes_evaluated == N1 && dear.nodes_frictional == N1);
  history_take(s.interface, &made_up);
  history_take(full.interface, &searched);
  CHECK(history_equal(&made_up, &searched));
  for (int i = 0; i < X1; ++i) {
    s.x1[i] -= up[i % 3];
    full.x1[i] -= up[i % 3];
    s.lambda[i] = full.lambda[i] = i % 3 == 2 ? -0.5 : 0.1;
  }
  scene_residual(&s, r);
  scene_residual(&full, q);
  CHECK(memcmp(r, q, sizeof r) == 0);
  scene_destroy(&s);
  scene_destroy(&full);

  /* A mortar side that looks away covers no node before the next commit: no law is asked about any. */
  scene_init(&s);
  scene_init(&full);
  full.method.no_shortcuts = STICKSLIP_SHORTCUT_UNCOVERED;
  for (scene *each = &s;; each = &full) {
    for (int f = 0; f < COUNT(each->nodes2); f += 4) {
      const int64_t second = each->nodes2[f + 1];
      each->nodes2[f + 1] = each->nodes2[f + 3];
      each->nodes2[f + 3] = second;
    }
    scene_create(each);
    scene_residual(each, each == &s ? r : q);
    scene_tangent(each, each == &s ? &t : &u);
    if (each == &full) break;
  }
  CHECK(memcmp(r, q, sizeof r) == 0);
  CHECK(counters_of(&s).nodes_left_out == N1 && counters_of(&s).nodes_evaluated == 0);
  CHECK(counters_of(&full).nodes_uncovered == N1 && counters_of(&full).nodes_evaluated == N1);
  CHECK(t.n == 3 * N1 && u.n == 9 * N1); /* the diagonal; the blocks, which have no more in them */
  memset(k, 0, sizeof k);
  memset(expected, 0, sizeof expected);
  triplets_add(&t, 0, k);
  triplets_add(&u, 0, expected);
  for (int i = 0; i < UNKNOWNS * UNKNOWNS; ++i) CHECK(k[i] == expected[i]);
  scene_destroy(&s);
  scene_destroy(&full);

  /* Two mortar facets on each other, 50 away: found when it comes near, or when the history of t_n is asked for. */
  {
    double upper[12] = {0, 0, 50, 0, 1, 50, 1, 1, 50, 1, 0, 50}, lower[24] = {0}, zero[12] = {0}, sums[4 * 11], f[36];
    int64_t offsets[3] = {0, 4, 8}, quads[8] = {0, 1, 2, 3, 4, 5, 6, 7}, integer, real, equations[24];
    int32_t state[4];
    for (int k = 0; k < 8; ++k) {
      lower[3 * k] = k % 4 == 1 || k % 4 == 2 ? 2.0 : -1.0;
      lower[3 * k + 1] = k % 4 > 1 ? 2.0 : -1.0;
      lower[3 * k + 2] = -0.1;
    }
    for (int i = 0; i < 24; ++i) equations[i] = -1;
    scene_init(&s);
    stickslip_surface one = s.nonmortar, two = s.mortar;
    one.n_nodes = 4;
    one.n_facets = 1;
    one.coordinates = upper;
    two.n_nodes = 8;
    two.n_facets = 2;
    two.coordinates = lower;
    one.facet_offsets = two.facet_offsets = offsets;
    one.facet_nodes = two.facet_nodes = quads;
    two.equations = equations;
    stickslip_interface *layers = NULL;
    CHECK_OK(stickslip_interface_create(&one, &two, &s.options, &layers));
    double near[12];
    for (int i = 0; i < 12; ++i) near[i] = i % 3 == 2 ? 0.0 : upper[i];
    stickslip_states out;
    memset(&out, 0, sizeof out);
    out.struct_size = sizeof out;
    out.state = state;
    FILL(f);
    FILL(sums);
    FILL(state);
    for (int again = 0; again < 2; ++again) {
      CHECK_REFUSED(stickslip_interface_residual(layers, near, lower, zero, NULL, f, f + 12, f + 24),
                    STICKSLIP_INVALID_VALUE, "lie on each other");
      CHECK_REFUSED(stickslip_interface_states(layers, near, lower, zero, NULL, &out), STICKSLIP_INVALID_VALUE,
                    "lie on each other");
      CHECK_REFUSED(stickslip_interface_sums(layers, near, lower, sums), STICKSLIP_INVALID_VALUE, "lie on each other");
      CHECK_REFUSED(stickslip_interface_history_size(layers, &integer, &real), STICKSLIP_INVALID_VALUE,
                    "lie on each other");
    }
    CHECK_UNTOUCHED(f);
    CHECK_UNTOUCHED(sums);
    CHECK_UNTOUCHED(state);
    CHECK_OK(stickslip_interface_destroy(&layers));
  }

  /* A rigid side has no equation; a shortcut has a name. */
  scene_init(&s);
  s.options.mortar_side = STICKSLIP_MORTAR_RIGID;
  CHECK_REFUSED(stickslip_interface_create(&s.nonmortar, &s.mortar, &s.options, &s.interface), STICKSLIP_INVALID_VALUE,
                "mortar");
  s.options.mortar_side = STICKSLIP_MORTAR_DEFORMABLE;
  const int32_t unknown[] = {16, -1, INT32_MIN, INT32_MAX};
  for (int n = 0; n < COUNT(unknown); ++n) {
    s.method.no_shortcuts = unknown[n];
    CHECK_REFUSED(stickslip_interface_create(&s.nonmortar, &s.mortar, &s.options, &s.interface),
                  STICKSLIP_INVALID_VALUE, "no_shortcuts");
  }
  CHECK(s.interface == NULL);

  /* The sentences: cut where they are longer, always ended; refused without room for the end. */
  s.method.no_shortcuts = 0;
  scene_create(&s);
  char text[1000], cut[20];
  CHECK_OK(stickslip_interface_effects(s.interface, text, sizeof text));
  CHECK(strncmp(text, "Friction: ", 10) == 0 && text[strlen(text) - 1] == '.');
  FILL(cut);
  CHECK_OK(stickslip_interface_effects(s.interface, cut, 11));
  CHECK(strcmp(cut, "Friction: ") == 0 && cut[11] == 0x5A);
  CHECK_OK(stickslip_interface_effects(s.interface, cut, 1));
  CHECK(cut[0] == '\0' && cut[1] == 'r');
  FILL(cut);
  CHECK_REFUSED(stickslip_interface_effects(s.interface, cut, 0), STICKSLIP_INVALID_SIZE, "capacity");
  CHECK_REFUSED(stickslip_interface_effects(s.interface, cut, -1), STICKSLIP_INVALID_SIZE, "capacity");
  CHECK_REFUSED(stickslip_interface_effects(s.interface, NULL, 20), STICKSLIP_NULL_POINTER, "text");
  CHECK_REFUSED(stickslip_interface_effects(NULL, cut, 20), STICKSLIP_NULL_POINTER, "interface");
  CHECK_UNTOUCHED(cut);
  scene_destroy(&s);
  return 0;
}
