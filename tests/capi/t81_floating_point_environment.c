/* The caller's floating-point environment: masks of traps, rounding, treatment of subnormal numbers and raised flags are
 * the same bits before and after each call, also where it is refused; and results do not depend on any of them. */
#define _GNU_SOURCE
#include <fenv.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "every_call.h"

/* An environment to be called in. Nothing is computed between entering and leaving it. */
typedef struct {
  int rounding, raised, trapping, flush;
} environment;

static void enter(environment e) {
  CHECK(fesetround(e.rounding) == 0);
#if defined(__SSE__)
  /* Flags 0 to 5, subnormal inputs as zeros 6, masks 7 to 12, flush to zero 15. */
  unsigned mxcsr = _mm_getcsr();
  if (e.raised) mxcsr |= 0x3Fu;
  if (e.trapping) mxcsr &= ~0x1F80u;
  if (e.flush) mxcsr |= 0x8040u;
  _mm_setcsr(mxcsr);
#else
  if (e.raised) CHECK(feraiseexcept(FE_ALL_EXCEPT) == 0);
#endif
}

/* One call between two looks at the environment. The x87's part of fenv_t shows that nothing has used it. */
static int32_t kept(environment e, int32_t (*call)(every *c), every *c, int refused, const char *name) {
  fenv_t own, before, after;
  CHECK(fegetenv(&own) == 0);
  enter(e);
#if defined(__SSE__)
  const unsigned mxcsr_before = _mm_getcsr();
#endif
  fegetenv(&before);
  const int32_t status = call ? call(c) : every_refusal(refused);
#if defined(__SSE__)
  const unsigned mxcsr_after = _mm_getcsr();
#endif
  fegetenv(&after);
  fesetenv(&own);
#if defined(__SSE__)
  if (mxcsr_before != mxcsr_after) {
    fprintf(stderr, "%s: MXCSR %#x before, %#x after\n", name, mxcsr_before, mxcsr_after);
    exit(1);
  }
#endif
  if (memcmp(&before, &after, sizeof before) != 0) {
    fprintf(stderr, "%s: another floating-point environment after the call\n", name);
    exit(1);
  }
  return status;
}

/* All calls in one environment. */
static void run(environment e, int32_t form, int32_t friction, int32_t basis, every *c) {
  memset(c, 0, sizeof *c);
  scene_init(&c->h.s);
  c->h.s.method.form = form;
  c->h.s.options.friction = friction;
  c->h.s.method.multiplier_basis = basis;
  if (!has_mu(friction)) c->h.s.options.mu = 0.0;
  c->h.s.options.shear_limit = friction == STICKSLIP_FRICTION_TRESCA ? 0.5 : 0.0;
  every_init(c);
  /* Thousandths beside lengths of 1, and subnormal numbers, which flushing would lose. */
  c->h.s.lambda[0] += 1e-310;
  c->e.traction[0] = 3e-310;
  for (int k = 0; k < COUNT(every_call); ++k) {
    const int dual = basis == STICKSLIP_BASIS_DUAL;
    if (every_call[k].call == every_friction && !has_mu(friction)) continue;
    if (dual ? every_call[k].call == every_with_sums : is_condensed(every_call[k].name)) continue;
    const int32_t status = kept(e, every_call[k].call, c, 0, every_call[k].name);
    if (status != STICKSLIP_OK) fprintf(stderr, "%s\n", every_call[k].name);
    CHECK(status == STICKSLIP_OK);
  }
  for (int k = 0; k < REFUSALS; ++k) CHECK(kept(e, NULL, NULL, k, "a refusal") > 0);
  scene_destroy(&c->h.s);
}

int main(void) {
  static every expected, c;
  static const int roundings[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
  static const int32_t scenes[][3] = {{STICKSLIP_FORM_MULTIPLIER, STICKSLIP_FRICTION_COULOMB, STICKSLIP_BASIS_STANDARD},
                                      {STICKSLIP_FORM_AUGMENTED, STICKSLIP_FRICTION_COULOMB, STICKSLIP_BASIS_STANDARD},
                                      {STICKSLIP_FORM_MULTIPLIER, STICKSLIP_FRICTION_TRESCA, STICKSLIP_BASIS_STANDARD},
                                      {STICKSLIP_FORM_MULTIPLIER, STICKSLIP_FRICTION_NONE, STICKSLIP_BASIS_STANDARD},
                                      {STICKSLIP_FORM_MULTIPLIER, STICKSLIP_FRICTION_COULOMB, STICKSLIP_BASIS_DUAL}};
  for (int k = 0; k < COUNT(scenes); ++k) {
    run((environment){FE_TONEAREST, 0, 0, 0}, scenes[k][0], scenes[k][1], scenes[k][2], &expected);
    for (int bits = 0; bits < 4 * 8; ++bits) {
      const environment e = {roundings[bits / 8], bits & 1, bits >> 1 & 1, bits >> 2 & 1};
      run(e, scenes[k][0], scenes[k][1], scenes[k][2], &c);
      CHECK(every_equal(&c, &expected));
    }
  }
  return 0;
}
