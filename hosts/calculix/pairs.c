/* Contact pairs of the library stickslip in CalculiX (pairs.h). Each pair is an interface with unknowns of its own numbering: three
   displacements a node, then three multipliers a slave node. Where CalculiX has them is looked up in each evaluation, through its
   multiple point constraints. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "pairs_pair.h"
#include "pairs_system.h"

/* Of the pair's own scales (docs/host_convergence.md of stickslip). CalculiX' tolerances of forces are the user's, and looser. */
static const double CONTACT_TOLERANCE = 1e-10;
/* iflagact raises CalculiX' own limit without end. */
static const ITG MOST_ITERATIONS = 25;
/* Of the size of the master surface. */
static const double SAME_PLANE = 1e-6;
/* What CalculiX multiplies an increment with that did not go. */
static const double CUT = 0.5;

static Pair *pairs;
static ITG n_pairs, n_multipliers, rejected_commits;
static ITG refused; /* something in this iteration: nothing is evaluated until it is judged */
static ITG values_per_node;
/* What two unknowns stand for. */
static ITG term_equation[2][PAIRS_MOST_TERMS];
static double term_factor[2][PAIRS_MOST_TERMS];

/* What the library refuses within an increment ends the increment: CalculiX takes a smaller one. */
static int accepted(const char *what, int32_t status) {
  if (status == STICKSLIP_OK) return 1;
  printf(" stickslip: %s refused: %s\n", what, stickslip_last_error_message());
  refused = 1;
  return 0;
}

static ITG terms_of(const Pair *p, int64_t unknown, ITG which) {
  const Side *side = p->side;
  const int64_t values = DIM * side[SLAVE].n_nodes;
  if (unknown >= values) unknown -= values, side++;
  return pairs_terms(side->nodes[unknown / DIM], unknown % DIM + 1, term_equation[which], term_factor[which]);
}

/* --- A step ---------------------------------------------------------------------------------------------------------- */

/* Young's modulus of the softer body, by the materials of the surfaces' elements. */
static double modulus(const PairsModel *m, ITG tie) {
  double least = m->tietol[4 * tie + 2];
  if (least > 0) return least;
  for (ITG s = 1; s <= SIDES; s++)
    for (ITG set = 0; set < m->nset; set++) {
      if (strncmp(m->set + 81 * set, m->tieset + 243 * tie + 81 * s, 81)) continue;
      for (ITG i = m->istartset[set] - 1; i < m->iendset[set]; i++) {
        const ITG material = m->ielmat[m->mi[2] * (m->ialset[i] / 10 - 1)] - 1, kind = m->nelcon[2 * material];
        if (kind != 2 && kind != -51) pairs_stop("a material that is not isotropic and elastic", "give MODULUS= in *CONTACT PAIR");
        const double young = m->elcon[(m->ncmat + 1) * m->ntmat * material + 1];
        if (least <= 0 || young < least) least = young;
      }
    }
  return least;
}

static double friction(const PairsModel *m, ITG tie) {
  const ITG interaction = (ITG)m->tietol[4 * tie + 1] - 1;
  return m->ncmat >= 6 && m->nelcon[2 * interaction] > 5 ? m->elcon[(m->ncmat + 1) * m->ntmat * interaction + 6] : 0;
}

/* Where nothing depends on a multiplier it is no unknown: of a component that is prescribed at the node and at all master nodes (plane
   strain), or at all nodes of both sides in the plane across it (symmetry: a rim that is held in more components can bear shear). */
static void find_removed(const Pair *p, char *removed) {
  const Side *slave = &p->side[SLAVE], *master = &p->side[MASTER];
  double size = 0;
  for (ITG k = 0; k < DIM * master->n_nodes; k++) size = fmax(size, fabs(master->reference[k] - master->reference[k % DIM]));
  char everywhere[DIM];
  for (ITG i = 0; i < DIM; i++) {
    everywhere[i] = 1;
    for (ITG b = 0; b < master->n_nodes; b++) everywhere[i] &= master->equations[DIM * b + i] < 0;
  }
  for (ITG k = 0; k < DIM * slave->n_nodes; k++) {
    const ITG i = k % DIM;
    removed[k] = slave->equations[k] < 0 && everywhere[i];
    if (slave->equations[k] >= 0 || everywhere[i]) continue;
    ITG on[SIDES] = {0, 0}, alone = 0, free_nodes = 0;
    for (ITG s = 0; s < SIDES; s++)
      for (ITG n = 0; n < p->side[s].n_nodes; n++) {
        const int64_t *e = p->side[s].equations + DIM * n;
        if (fabs(p->side[s].reference[DIM * n + i] - slave->reference[k]) > SAME_PLANE * size) continue;
        const ITG j = (i + 1) % DIM, l = (i + 2) % DIM;
        on[s]++, free_nodes += e[i] >= 0;
        alone |= s == SLAVE && (e[j] >= 0 || everywhere[j]) && (e[l] >= 0 || everywhere[l]);
      }
    removed[k] = !free_nodes && alone && on[MASTER] && on[SLAVE] < slave->n_nodes && on[MASTER] < master->n_nodes;
  }
}

/* The interface of now; one that has another support than before goes on with its history. */
static void create(Pair *p) {
  stickslip_surface surface[SIDES];
  const Side *slave = &p->side[SLAVE];
  const ITG values = DIM * slave->n_nodes;
  int64_t unknown = 0;
  for (ITG s = 0; s < SIDES; s++) {
    Side *side = &p->side[s];
    for (ITG k = 0; k < DIM * side->n_nodes; k++, unknown++) {
      const ITG n = pairs_terms(side->nodes[k / DIM], k % DIM + 1, term_equation[0], term_factor[0]);
      side->equations[k] = n > 0 ? unknown : -1;
    }
    surface[s] = (stickslip_surface){.struct_size = sizeof surface[s], .n_nodes = side->n_nodes, .n_facets = side->n_facets,
        .coordinates = side->reference, .facet_offsets = side->offsets, .facet_nodes = side->facets, .equations = side->equations};
  }
  char *removed = pairs_zeros(values, 1);
  find_removed(p, removed);
  for (ITG k = 0; k < values; k++) p->multipliers[k] = slave->corner[k / DIM] && !removed[k] ? unknown + k : -1;
  free(removed);
  surface[SLAVE].multiplier_equations = p->multipliers;
  stickslip_interface *old = p->contact;
  pairs_must("a pair", stickslip_interface_create(&surface[SLAVE], &surface[MASTER], &p->options, &p->contact));
  if (old) {
    int64_t n_integers = 0, n_reals = 0;
    pairs_must("history", stickslip_interface_history_size(old, &n_integers, &n_reals));
    int64_t *integers = pairs_zeros(n_integers, sizeof *integers);
    double *reals = pairs_zeros(n_reals, sizeof *reals);
    pairs_must("history", stickslip_interface_history_export(old, n_integers, integers, n_reals, reals));
    pairs_must("history", stickslip_interface_history_import(p->contact, n_integers, integers, n_reals, reals));
    pairs_must("an old pair", stickslip_interface_destroy(&old));
    free(integers), free(reals);
  } else {
    pairs_must("a start", stickslip_interface_initial_multipliers(p->contact, p->lambda));
  }
  for (ITG k = 0; k < values; k++)
    if (p->multipliers[k] < 0) p->lambda[k] = 0;
  memcpy(p->lambda_begin, p->lambda, values * sizeof(double));
}

static void read_pair(const PairsModel *m, ITG tie, Pair *p) {
  for (ITG s = 0; s < SIDES; s++) pairs_read_side(m, m->tieset + 243 * tie + 81 * (s + 1), &p->side[s]);
  const size_t n = p->side[SLAVE].n_nodes, values = DIM * n;
  p->multipliers = pairs_zeros(values, sizeof *p->multipliers), p->state = pairs_zeros(n, sizeof *p->state);
  p->lambda = pairs_zeros(values, sizeof(double)), p->lambda_begin = pairs_zeros(values, sizeof(double));
  p->rows = pairs_zeros(values, sizeof(double)), p->normal = pairs_zeros(values, sizeof(double)), p->gap = pairs_zeros(n, sizeof(double));
  pairs_must("options", stickslip_options_init(&p->options, sizeof p->options));
  p->options.mu = friction(m, tie), p->options.modulus = modulus(m, tie);
  p->options.small_displacements = m->tietol[4 * tie] < 0;
  p->first = n_multipliers, n_multipliers += values;
}

void pairs_begin(const PairsModel *m, PairsNumbers numbers) {
  values_per_node = m->mi[1] + 1;
  pairs_number(numbers, values_per_node);
  if (!pairs) {
    for (ITG tie = 0; tie < m->ntie; tie++) n_pairs += m->tieset[243 * tie + 80] == 'K';
    if (!n_pairs) return;
    pairs = pairs_zeros(n_pairs, sizeof *pairs);
    for (ITG tie = 0, p = 0; tie < m->ntie; tie++)
      if (m->tieset[243 * tie + 80] == 'K') read_pair(m, tie, &pairs[p++]);
    pairs_open(m->jobname);
  }
  if (!n_pairs) return;
  if (m->nmethod == 4 || m->iexpl > 1) pairs_stop("*DYNAMIC", "pairs of TYPE=STICKSLIP are for static steps");
  if (m->ithermal > 1) pairs_stop("temperatures as unknowns", "pairs of TYPE=STICKSLIP have none");
  if (m->ncont) pairs_stop("*CONTACT PAIR of another type beside TYPE=STICKSLIP", "have all pairs of one type");
  if (m->mcs) pairs_stop("cyclic symmetry", "pairs of TYPE=STICKSLIP do not know it");
  for (ITG p = 0; p < n_pairs; p++) create(&pairs[p]);
}

/* --- An increment ---------------------------------------------------------------------------------------------------- */

void pairs_forces(double *b, const double *v, PairsNumbers numbers) {
  pairs_number(numbers, values_per_node);
  for (ITG i = 0; i < n_pairs && !refused; i++) {
    Pair *p = &pairs[i];
    for (ITG s = 0; s < SIDES; s++) pairs_positions(&p->side[s], v);
    const Side *side = p->side;
    if (!accepted("forces", stickslip_interface_residual(p->contact, side[SLAVE].x, side[MASTER].x, p->lambda, NULL,
                                                         side[SLAVE].force, side[MASTER].force, p->rows)))
      return;
    const int64_t slaves = DIM * side[SLAVE].n_nodes, all = slaves + DIM * side[MASTER].n_nodes;
    for (int64_t k = 0; k < all; k++) {
      const double force = k < slaves ? side[SLAVE].force[k] : side[MASTER].force[k - slaves];
      const ITG n = terms_of(p, k, 0);
      for (ITG t = 0; t < n; t++) b[term_equation[0][t]] -= term_factor[0][t] * force;
    }
  }
}

/* The unknowns of the whole system that an unknown of a pair stands for. */
static ITG unknowns(const Pair *p, int64_t unknown, ITG which, ITG neq) {
  const int64_t displacements = DIM * (p->side[SLAVE].n_nodes + p->side[MASTER].n_nodes);
  if (unknown < displacements) return terms_of(p, unknown, which);
  term_equation[which][0] = neq + p->first + unknown - displacements, term_factor[which][0] = 1;
  return 1;
}

static void add_pair(const Pair *p, ITG neq, System *system) {
  const double *x1 = p->side[SLAVE].x, *x2 = p->side[MASTER].x;
  int64_t count = 0;
  if (!accepted("a tangent", stickslip_interface_tangent_coo(p->contact, x1, x2, p->lambda, NULL, 0, NULL, NULL, NULL, &count))) return;
  int64_t *rows = pairs_zeros(count, sizeof *rows), *columns = pairs_zeros(count, sizeof *columns);
  double *values = pairs_zeros(count, sizeof *values);
  if (accepted("a tangent",
               stickslip_interface_tangent_coo(p->contact, x1, x2, p->lambda, NULL, count, rows, columns, values, &count)))
    for (int64_t k = 0; k < count; k++) {
      const ITG n = unknowns(p, rows[k], 0, neq), m = unknowns(p, columns[k], 1, neq);
      for (ITG i = 0; i < n; i++)
        for (ITG j = 0; j < m; j++)
          system_add(system, term_equation[0][i], term_equation[1][j], term_factor[0][i] * term_factor[1][j] * values[k]);
    }
  free(rows), free(columns), free(values);
  /* A mid node's places have no multiplier: their unknown is 0. */
  for (ITG k = 0; k < DIM * p->side[SLAVE].n_nodes; k++)
    if (p->multipliers[k] < 0) system_add(system, neq + p->first + k, neq + p->first + k, 1);
}

ITG pairs_solve(const double *ad, const double *au, double *b, const ITG *icol, const ITG *irow, ITG neq, ITG upper, ITG nasym,
                ITG solver) {
  if (!n_pairs) return 0;
  System system = {.size = neq + n_multipliers};
  double *right = pairs_zeros(system.size, sizeof *right);
  memcpy(right, b, neq * sizeof *right);
  system_add_host(&system, ad, au, icol, irow, neq, upper, nasym);
  for (ITG p = 0; p < n_pairs && !refused; p++) {
    add_pair(&pairs[p], neq, &system);
    for (ITG k = 0; k < DIM * pairs[p].side[SLAVE].n_nodes; k++)
      right[neq + pairs[p].first + k] = pairs[p].multipliers[k] < 0 ? 0 : -pairs[p].rows[k];
  }
  if (refused) memset(right, 0, system.size * sizeof *right);
  else if (!system_solve(&system, right, solver)) pairs_stop("this solver", "pairs of TYPE=STICKSLIP need SPOOLES, PARDISO or PaStiX");
  memcpy(b, right, neq * sizeof *right);
  for (ITG p = 0; p < n_pairs; p++)
    for (ITG k = 0; k < DIM * pairs[p].side[SLAVE].n_nodes; k++) pairs[p].lambda[k] += right[neq + pairs[p].first + k];
  system_free(&system), free(right);
  return 1;
}

static int in_equilibrium(Pair *p) {
  stickslip_equilibrium e = {.struct_size = sizeof e, .modulus = p->options.modulus, .least_traction = p->largest_traction};
  return accepted("its equilibrium", stickslip_interface_equilibrium(p->contact, p->side[SLAVE].x, p->side[MASTER].x, p->lambda, NULL, &e)) &&
         e.gap <= CONTACT_TOLERANCE * e.gap_scale && e.traction <= CONTACT_TOLERANCE * e.traction_scale &&
         e.slip <= CONTACT_TOLERANCE * e.slip_scale;
}

void pairs_judge(ITG iteration, ITG *iflagact, double *qa) {
  int balanced = !refused;
  if (iteration == 1) rejected_commits = 0;
  for (ITG i = 0; i < n_pairs && balanced; i++) balanced = in_equilibrium(&pairs[i]);
  for (ITG i = 0; i < n_pairs && balanced; i++) {
    const Pair *p = &pairs[i];
    /* Once may be an iterate that is still on its way. */
    const int32_t status = stickslip_interface_commit_check(p->contact, p->side[SLAVE].x, p->side[MASTER].x, p->lambda, NULL);
    if (status == STICKSLIP_OK) continue;
    balanced = 0;
    if (++rejected_commits > 1) accepted("a commit", status);
  }
  if (n_pairs && !balanced) *iflagact = 1;
  if (refused || (n_pairs && !balanced && iteration >= MOST_ITERATIONS)) qa[2] = CUT;
  refused = 0;
}

/* --- Results --------------------------------------------------------------------------------------------------------- */

void pairs_end(ITG converged, ITG increment, double time) {
  for (ITG i = 0; i < n_pairs; i++) {
    Pair *p = &pairs[i];
    const double *x1 = p->side[SLAVE].x, *x2 = p->side[MASTER].x;
    const size_t bytes = DIM * p->side[SLAVE].n_nodes * sizeof(double);
    if (!converged) {
      memcpy(p->lambda, p->lambda_begin, bytes);
      continue;
    }
    const stickslip_states out = {.struct_size = sizeof out, .state = p->state, .normal = p->normal, .gap = p->gap};
    stickslip_equilibrium e = {.struct_size = sizeof e, .modulus = p->options.modulus};
    pairs_must("states", stickslip_interface_states(p->contact, x1, x2, p->lambda, NULL, &out));
    pairs_must("equilibrium", stickslip_interface_equilibrium(p->contact, x1, x2, p->lambda, NULL, &e));
    pairs_must("a commit", stickslip_interface_commit(p->contact, x1, x2, p->lambda, NULL));
    p->largest_traction = fmax(p->largest_traction, e.traction_scale);
    memcpy(p->lambda_begin, p->lambda, bytes);
    ITG counts[3] = {0, 0, 0};
    for (ITG a = 0; a < p->side[SLAVE].n_nodes; a++)
      if (p->side[SLAVE].corner[a]) counts[p->state[a]]++;
    printf(" stickslip: pair %" ITGFORMAT " gap %" ITGFORMAT " stick %" ITGFORMAT " slip %" ITGFORMAT "\n\n", i + 1,
           counts[STICKSLIP_STATE_GAP], counts[STICKSLIP_STATE_STICK], counts[STICKSLIP_STATE_SLIP]);
  }
  if (n_pairs && converged) pairs_write(pairs, n_pairs, increment, time);
}

void pairs_frd(ITG kode, double time, ITG istep, ITG iinc, ITG nmethod, char *output) {
  if (n_pairs) pairs_write_frd(pairs, n_pairs, kode, time, istep, iinc, nmethod, output);
}
