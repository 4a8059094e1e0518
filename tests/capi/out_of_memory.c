/* Memory that runs out at any request of any call: the answer is a status, nothing has changed and nothing is printed,
 * and what comes after gives the bits that it gives without. This program's malloc and its kin serve the library too;
 * armed, they fail at the n-th request alone, or from the n-th on. */
#include <errno.h>

#include "kinds.h"

/* What the C library has under these names. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t n, size_t size);
extern void *__libc_realloc(void *p, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *p);

static int armed, from_then_on;
static long failing, requests, blocks;

static int fails(void) {
  if (!armed) return 0;
  ++requests;
  if (from_then_on ? requests < failing : requests != failing) return 0;
  errno = ENOMEM;
  return 1;
}

static void *counted(void *p) {
  blocks += p != NULL;
  return p;
}

void *malloc(size_t size) { return fails() ? NULL : counted(__libc_malloc(size)); }
void *calloc(size_t n, size_t size) { return fails() ? NULL : counted(__libc_calloc(n, size)); }
void *aligned_alloc(size_t alignment, size_t size) { return fails() ? NULL : counted(__libc_memalign(alignment, size)); }
void *realloc(void *p, size_t size) {
  if (fails()) return NULL;
  void *grown = __libc_realloc(p, size);
  blocks += p == NULL && grown != NULL;
  return grown;
}
int posix_memalign(void **p, size_t alignment, size_t size) {
  if (fails()) return ENOMEM;
  *p = counted(__libc_memalign(alignment, size));
  return *p ? 0 : ENOMEM;
}
void free(void *p) {
  blocks -= p != NULL;
  __libc_free(p);
}

static void arm(long n, int then_on) {
  failing = n;
  from_then_on = then_on;
  requests = 0;
  armed = 1;
}

/* Whether the outputs are the same, of the long ones their beginnings. */
static int outputs_equal(const every *a, const every *b) {
  enum { BEGINNING = 512 * sizeof(double) };
#define LONG(member) (memcmp(a->member, b->member, BEGINNING) == 0)
#define SAME(member) (memcmp(&a->member, &b->member, sizeof a->member) == 0)
  return LONG(h.values) && LONG(h.row_numbers) && LONG(h.columns) && LONG(h.csr) && SAME(h.force1) && SAME(h.force2) &&
         SAME(h.rows) && SAME(h.sums) && SAME(h.count) && SAME(h.state) && SAME(h.normal) && SAME(e.w_out) &&
         SAME(e.gap) && SAME(e.force) && SAME(e.k) && SAME(other) && SAME(split_nodes) && SAME(originals) &&
         SAME(split_count) && SAME(shared_nodes) && SAME(shared_claims) && SAME(shared_count) && SAME(shared_kinds) &&
         SAME(initial) && SAME(history) && SAME(effects) && SAME(report) && SAME(cover) && SAME(layers) &&
         SAME(fraction) && SAME(facets) && SAME(report_text) && SAME(diagnosis) && SAME(diagnosed_state) &&
         SAME(suspect_nodes) && SAME(suspect_directions) && SAME(suspect_ratios) && SAME(suspect_causes) &&
         SAME(diagnosis_text) && SAME(step_limit) && SAME(equilibrium) && SAME(node_equilibrium) &&
         SAME(condensed_lambda) && SAME(condensed_rows) && SAME(condensed_force) && SAME(node_condensed) &&
         SAME(e.normal_derivatives) && SAME(e.turn) && SAME(slopes) && SAME(change1) && SAME(change2) && SAME(change_rows) &&
         SAME(skin.skin) && every_skin_equal(a, b);
#undef LONG
#undef SAME
}

static long refusals;

/* Lets the call fail at every request in turn. The last time, with no request left to fail, it has succeeded. */
static void fail_everywhere(const kind *k, const entry_point *entry, every *c, int then_on) {
  static every before;
  static history old, now, old_skin, now_skin;
  before = *c;
  if (!k->unseen) history_take(c->h.s.interface, &old);
  if (c->skin.skin) skin_history(c->skin.skin, &old_skin);
  for (long n = 1;; ++n) {
    const long held = blocks;
    arm(n, then_on);
    const int32_t status = entry->call(c);
    armed = 0;
    if (requests < n) {
      if (status != STICKSLIP_OK) fprintf(stderr, "%s, %s, request %ld:\n", k->name, entry->name, n);
      CHECK(status == STICKSLIP_OK);
      return;
    }
    if (status != STICKSLIP_OUT_OF_MEMORY) fprintf(stderr, "%s, %s, request %ld: %d\n", k->name, entry->name, n, status);
    CHECK(status == STICKSLIP_OUT_OF_MEMORY);
    CHECK(strstr(stickslip_last_error_message(), "memory") != NULL);
    /* What a call was to fill may be half filled. */
    if (entry->call == every_coo) memcpy(before.h.values, c->h.values, sizeof before.h.values);
    CHECK(outputs_equal(c, &before));
    /* What was taken for a new interface has been given back; others may keep what saves them work. */
    if (entry->call == every_create || entry->call == every_skin_create) CHECK(blocks == held);
    if (c->skin.skin) {
      skin_history(c->skin.skin, &now_skin);
      CHECK(history_equal(&old_skin, &now_skin));
    }
    if (!k->unseen) {
      history_take(c->h.s.interface, &now);
      CHECK(history_equal(&old, &now));
    }
    ++refusals;
  }
}

static void try_kind(const kind *k) {
  static every expected, c;
  set_up(k, &expected);
  for (int i = 0; i < COUNT(every_call); ++i) {
    if (belongs(k, &every_call[i])) CHECK_OK(every_call[i].call(&expected));
  }
  CHECK((expected.counters.nodes_carried > 0) == (k->weak_coverage > 0.0));
  CHECK((expected.counters.evaluations_apart > 0) == (k->slide > 10.0));
  for (int then_on = 0; then_on < 2; ++then_on) {
    set_up(k, &c);
    for (int i = 0; i < COUNT(every_call); ++i) {
      if (belongs(k, &every_call[i])) fail_everywhere(k, &every_call[i], &c, then_on);
    }
    /* What was done to get there differs. */
    c.counters = expected.counters;
    CHECK(every_equal(&c, &expected));
    end(&c);
  }
  end(&expected);
}

/* Where friction is remembered at points, t_n may get more of them than there have been: they are counted before anything is put in place.
 * They were counted afterwards, and a refusal left a new history that remembered the old points. */
static void set_previous_with_more_points(void) {
  static const kind k = {.name = "more points", .basis = STICKSLIP_BASIS_DUAL, .weights = STICKSLIP_WEIGHTS_COMMITTED, .points = 1};
  static const entry_point previous = {"interface_set_previous", every_previous};
  const double way = 1.0;
  for (int then_on = 0; then_on < 2; ++then_on) {
    static every c;
    set_up(&k, &c);
    scene *s = &c.h.s;
    CHECK_OK(stickslip_interface_destroy(&s->interface));
    scene_slide(s, way);
    memcpy(s->reference1, s->x1, sizeof s->reference1);
    CHECK_OK(stickslip_interface_create(&s->nonmortar, &s->mortar, &s->options, &s->interface));
    scene_slide(s, -way);
    fail_everywhere(&k, &previous, &c, then_on);
    end(&c);
  }
}

/* A refusal whose message finds no memory is the same refusal, be it the first call of all. */
static void refuse_without_memory(void) {
  arm(1, 1);
  const int32_t first = stickslip_node_normal(NULL, NULL);
  armed = 0;
  CHECK(first == STICKSLIP_NULL_POINTER);
  for (int k = 0; k < REFUSALS; ++k) {
    const int32_t expected = every_refusal(k);
    CHECK(expected > 0 && expected != STICKSLIP_OUT_OF_MEMORY);
    arm(1, 1);
    const int32_t found = every_refusal(k);
    armed = 0;
    CHECK(found == expected);
    CHECK(stickslip_last_error_message()[0] != '\0');
  }
}

int main(void) {
  refuse_without_memory();
  /* The failures come from here and not from nowhere. */
  arm(1, 0);
  void *volatile p = malloc(1);
  armed = 0;
  CHECK(p == NULL);
  const long held = blocks;
  for (int k = 0; k < COUNT(kinds); ++k) try_kind(&kinds[k]);
  set_previous_with_more_points();
  CHECK(blocks == held);
  CHECK(refusals > 1000);
  return 0;
}
