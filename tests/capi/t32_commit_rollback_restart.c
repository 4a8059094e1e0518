/* History: evaluations leave it alone, a commit moves it, a rollback and a restart bring it back to the bit. */
#include "scene.h"

static history before, after, now;

static triplets t, u;

int main(void) {
  static scene s, restarted;
  double r[UNKNOWNS], q[UNKNOWNS];
  for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_REFERENCE; ++weights) {
    scene_init(&s);
    s.method.weights = weights;
    scene_create(&s);
    CHECK_REFUSED(stickslip_interface_rollback(s.interface), STICKSLIP_NOTHING_TO_ROLL_BACK, "commit");

    history_take(s.interface, &before);
    scene_residual(&s, r);
    scene_tangent(&s, &t);
    history_take(s.interface, &now);
    CHECK(history_equal(&before, &now));

    scene_commit(&s);
    history_take(s.interface, &after);
    CHECK(!history_equal(&before, &after));

    /* One step back: the same bits as before the commit. Only one can be undone. */
    CHECK_OK(stickslip_interface_rollback(s.interface));
    history_take(s.interface, &now);
    CHECK(history_equal(&before, &now));
    memset(&u, 0, sizeof u);
    scene_residual(&s, q);
    scene_tangent(&s, &u);
    CHECK(memcmp(r, q, sizeof r) == 0);
    CHECK(t.n == u.n && memcmp(t.values, u.values, (size_t)t.n * sizeof *t.values) == 0);
    CHECK_REFUSED(stickslip_interface_rollback(s.interface), STICKSLIP_NOTHING_TO_ROLL_BACK, "commit");

    /* Restart: another handle on the same surfaces takes the history and goes on with the same bits. */
    scene_commit(&s);
    scene_slide(&s, 0.1);
    scene_commit(&s);
    history_take(s.interface, &after);
    scene_slide(&s, 0.07);
    scene_residual(&s, r);
    scene_init(&restarted);
    restarted.method.weights = weights;
    scene_create(&restarted);
    CHECK_OK(stickslip_interface_history_import(restarted.interface, after.n_integers, after.integers, after.n_reals,
                                                after.reals));
    history_take(restarted.interface, &now);
    CHECK(history_equal(&after, &now));
    CHECK_REFUSED(stickslip_interface_rollback(restarted.interface), STICKSLIP_NOTHING_TO_ROLL_BACK, "commit");
    memcpy(restarted.x1, s.x1, sizeof s.x1);
    scene_residual(&restarted, q);
    CHECK(memcmp(r, q, sizeof r) == 0);
    scene_commit(&s);
    scene_commit(&restarted);
    history_take(s.interface, &after);
    history_take(restarted.interface, &now);
    CHECK(history_equal(&after, &now));

    /* Larger buffers are fine, and only the needed part is written. */
    now.integers[now.n_integers] = 77;
    CHECK_OK(stickslip_interface_history_export(s.interface, COUNT(now.integers), now.integers, COUNT(now.reals), now.reals));
    CHECK(now.integers[now.n_integers] == 77);
    scene_destroy(&s);
    scene_destroy(&restarted);
  }

  /* A given t_n: as if the interface had been created there. */
  static scene there;
  scene_init(&s);
  scene_init(&there);
  scene_slide(&s, 0.2);
  memcpy(there.reference1, s.x1, sizeof s.x1);
  memcpy(there.reference2, s.x2, sizeof s.x2);
  scene_create(&s);
  scene_create(&there);
  scene_commit(&s);
  CHECK_OK(stickslip_interface_set_previous(s.interface, there.reference1, there.reference2));
  history_take(s.interface, &now);
  history_take(there.interface, &after);
  now.integers[HISTORY_COORDINATES] = after.integers[HISTORY_COORDINATES]; /* but for where they were created */
  history_seal(&now);
  CHECK(history_equal(&now, &after));
  CHECK_REFUSED(stickslip_interface_rollback(s.interface), STICKSLIP_NOTHING_TO_ROLL_BACK, "commit");
  scene_destroy(&s);
  scene_destroy(&there);
  return 0;
}
