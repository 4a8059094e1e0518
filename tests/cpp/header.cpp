// The class of stickslip.hpp: the same numbers as the functions of stickslip.h, refusals as exceptions, memory that is freed once, and
// no allocations where it promises none.
#include <stickslip.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <new>
#include <string>
#include <utility>

static long allocations = 0;
void *operator new(std::size_t size) {
  allocations++;
  if (void *p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
void operator delete(void *p) noexcept { std::free(p); }
void operator delete(void *p, std::size_t) noexcept { std::free(p); }

static int failures = 0;
static void check(bool holds, const char *what) {
  if (holds) return;
  failures++;
  std::printf("%s\n", what);
}

// Steps of differences, and how well these agree with derivatives, over the largest entry: 7e-11 is measured.
static const double DIFFERENCE = 1e-6, DIFFERENCES_AGREE = 1e-9;

struct Problem {
  stickslip::Side upper, lower;
  stickslip_options options = stickslip::default_options();
  std::vector<double> x1, x2, lambda;

  // Two facets over four, 0.001 deep, drawn along x. Unknowns: displacements of both sides, then multipliers.
  Problem() {
    grid(3, 2, 0.25, 0.25, 0.5, -1e-3, upper);
    grid(3, 3, -0.1, -0.1, 1, 0, lower);
    const int64_t second = 3 * static_cast<int64_t>(upper.n_nodes()), third = second + 3 * static_cast<int64_t>(lower.n_nodes());
    for (int64_t k = 0; k < second; k++) upper.equations.push_back(k), upper.multiplier_equations.push_back(third + k);
    for (int64_t k = second; k < third; k++) lower.equations.push_back(k);
    options.mu = 0.3;
    options.modulus = 1000;
    x1 = upper.coordinates, x2 = lower.coordinates;
    lambda.resize(upper.multiplier_equations.size());
  }

  // The upper side faces down, the lower one up.
  static void grid(int n, int m, double x, double y, double h, double z, stickslip::Side &side) {
    for (int j = 0; j < m; j++)
      for (int i = 0; i < n; i++)
        for (const double c : {x + h * i, y + h * j, z}) side.coordinates.push_back(c);
    for (int j = 0; j + 1 < m; j++)
      for (int i = 0; i + 1 < n; i++) {
        const int a = n * j + i;
        const std::vector<int> up{a, a + 1, a + n + 1, a + n}, down{a, a + n, a + n + 1, a + 1};
        side.add_facet(z < 0 ? down : up);
      }
  }
};

static double at(const stickslip::Entries &entries, int64_t row, int64_t column) {
  double out = 0;
  for (std::size_t k = 0; k < entries.size(); k++)
    if (entries.rows[k] == row && entries.columns[k] == column) out += entries.values[k];
  return out;
}

static void same_numbers() {
  Problem p;
  stickslip::Contact contact(p.upper, p.lower, p.options);
  contact.start(p.lambda.data());
  contact.evaluate(p.x1.data(), p.x2.data(), p.lambda.data());
  std::vector<double> force1(p.x1.size()), force2(p.x2.size()), rows(p.lambda.size());
  stickslip::must(stickslip_interface_residual(contact.get(), p.x1.data(), p.x2.data(), p.lambda.data(), nullptr, force1.data(),
                                               force2.data(), rows.data()));
  check(force1 == contact.force1() && force2 == contact.force2() && rows == contact.rows(), "other forces than the functions'");

  const stickslip::Entries entries = contact.tangent(p.x1.data(), p.x2.data(), p.lambda.data());
  check(entries.size() > 0 && entries.rows.size() == entries.size() && entries.columns.size() == entries.size(), "no tangent");
  const std::size_t moved = 2; // the height of the first node
  std::vector<double> shifted = p.x1, below(rows.size());
  double largest = 0;
  for (const double v : entries.values) largest = std::fmax(largest, std::fabs(v));
  shifted[moved] -= DIFFERENCE;
  contact.evaluate(shifted.data(), p.x2.data(), p.lambda.data());
  below = contact.rows();
  shifted[moved] += 2 * DIFFERENCE;
  contact.evaluate(shifted.data(), p.x2.data(), p.lambda.data());
  for (std::size_t k = 0; k < rows.size(); k++) {
    const double difference = (contact.rows()[k] - below[k]) / (2 * DIFFERENCE);
    const double entry = at(entries, p.upper.multiplier_equations[k], static_cast<int64_t>(moved));
    check(std::fabs(difference - entry) <= DIFFERENCES_AGREE * largest, "the tangent is not the derivative");
  }

  contact.plan(p.x1.data(), p.x2.data(), STICKSLIP_PLAN_ACTIVE);
  check(contact.values(p.x1.data(), p.x2.data(), p.lambda.data()), "a plan that lacks entries");
  std::map<std::pair<int64_t, int64_t>, int> once;
  for (std::size_t k = 0; k < contact.planned().size(); k++) {
    const int64_t row = contact.planned().rows[k], column = contact.planned().columns[k];
    check(once[std::make_pair(row, column)]++ == 0, "an entry of a plan stands twice");
    check(std::fabs(contact.planned().values[k] - at(entries, row, column)) <= 1e-14 * largest, "another tangent by the plan");
  }
  std::vector<double> away = p.x1;
  for (std::size_t k = 1; k < away.size(); k += 3) away[k] += 0.5; // over other facets
  check(!contact.values(away.data(), p.x2.data(), p.lambda.data()), "a plan that has what lies elsewhere");
}

static void a_step() {
  Problem p;
  stickslip::Contact contact(p.upper, p.lower, p.options);
  for (std::size_t k = 2; k < p.lambda.size(); k += 3) p.lambda[k] = -1;
  const stickslip::States states = contact.states(p.x1.data(), p.x2.data(), p.lambda.data());
  check(states.state.size() == p.upper.n_nodes() && states.count(STICKSLIP_STATE_GAP) == 0, "pressed nodes in gap");
  check(states.normal[2] == 1 && states.gap[0] < 0, "normals or gaps");
  const stickslip_equilibrium e = contact.equilibrium(p.x1.data(), p.x2.data(), p.lambda.data());
  check(!stickslip::balanced(e) && stickslip::balanced(e, 1e9), "a penetration that is in equilibrium");

  const stickslip::History before = contact.history();
  contact.check_commit(p.x1.data(), p.x2.data(), p.lambda.data());
  contact.commit(p.x1.data(), p.x2.data(), p.lambda.data());
  for (std::size_t k = 0; k < p.x1.size(); k += 3) p.x1[k] += 0.01;
  contact.evaluate(p.x1.data(), p.x2.data(), p.lambda.data());
  const std::vector<double> rows = contact.rows();
  const stickslip::History after = contact.history();
  contact.rollback();
  check(contact.history().reals == before.reals, "a rollback that is not one");
  stickslip::Contact other(p.upper, p.lower, p.options);
  other.restore(after);
  other.evaluate(p.x1.data(), p.x2.data(), p.lambda.data());
  check(other.rows() == rows, "a restart that goes on otherwise");
}

static void refusals() {
  Problem p;
  p.options.modulus = 0;
  try {
    stickslip::Contact contact(p.upper, p.lower, p.options);
    check(false, "no refusal");
  } catch (const stickslip::Refused &refused) {
    check(refused.status() == STICKSLIP_MISSING_STIFFNESS, "another status");
    check(std::strstr(refused.what(), "modulus"), "a message without its word");
  }
  p.options.modulus = 1000;
  stickslip::Contact contact(p.upper, p.lower, p.options);
  p.x1[0] = std::nan("");
  for (int call = 0; call < 2; call++) try { // without entries so far, and with
      if (call == 1) contact.tangent(p.upper.coordinates.data(), p.x2.data(), p.lambda.data());
      contact.tangent(p.x1.data(), p.x2.data(), p.lambda.data());
      check(false, "no refusal of NaN");
    } catch (const std::runtime_error &) {
    }
  try {
    contact.rollback();
    check(false, "a rollback of nothing");
  } catch (const stickslip::Refused &refused) {
    check(refused.status() == STICKSLIP_NOTHING_TO_ROLL_BACK, "another status of a rollback");
  }
}

static void moves_and_memory() {
  Problem p;
  std::vector<stickslip::Contact> interfaces;
  for (int k = 0; k < 3; k++) interfaces.push_back(stickslip::Contact(p.upper, p.lower, p.options));
  stickslip::Contact contact = std::move(interfaces[1]);
  check(!interfaces[1].get() && contact.get(), "a move that leaves two owners");
  contact.start(p.lambda.data());
  contact.plan(p.x1.data(), p.x2.data());
  contact.tangent(p.x1.data(), p.x2.data(), p.lambda.data());
  const long before = allocations;
  for (int k = 0; k < 3; k++) {
    p.x1[0] += 1e-4;
    contact.evaluate(p.x1.data(), p.x2.data(), p.lambda.data());
    contact.tangent(p.x1.data(), p.x2.data(), p.lambda.data());
    contact.values(p.x1.data(), p.x2.data(), p.lambda.data());
    contact.equilibrium(p.x1.data(), p.x2.data(), p.lambda.data());
  }
  check(allocations == before, "an evaluation that allocates");
}

// One multiplier a node without friction, two components in the plane.
static void sizes() {
  Problem p;
  p.options.friction = STICKSLIP_FRICTION_NONE;
  p.options.mu = 0;
  p.upper.multiplier_equations.resize(p.upper.n_nodes());
  for (std::size_t k = 0; k < p.upper.n_nodes(); k++) p.upper.multiplier_equations[k] = 100 + static_cast<int64_t>(k);
  stickslip::Contact contact(p.upper, p.lower, p.options);
  check(contact.rows().size() == p.upper.n_nodes() && contact.force1().size() == 3 * p.upper.n_nodes(), "sizes without friction");
  contact.evaluate(p.x1.data(), p.x2.data(), p.lambda.data());

  stickslip::Side line, ground;
  line.components = ground.components = 2;
  line.coordinates = {0.25, -1e-3, 0.75, -1e-3}, ground.coordinates = {0, 0, 1, 0};
  line.equations = {0, 1, 2, 3}, ground.equations = {4, 5, 6, 7}, line.multiplier_equations = {8, 9, 10, 11};
  line.add_facet(std::vector<int>{0, 1}), ground.add_facet(std::vector<int>{1, 0});
  stickslip_options options = stickslip::default_options();
  options.model = STICKSLIP_MODEL_PLANE;
  options.modulus = 1000;
  stickslip::Contact plane(line, ground, options);
  const std::vector<double> lambda(4);
  plane.evaluate(line.coordinates.data(), ground.coordinates.data(), lambda.data());
  check(plane.force1().size() == 4 && plane.rows().size() == 4 && plane.rows()[1] < 0, "lines");
}

int main() {
  same_numbers();
  a_step();
  refusals();
  moves_and_memory();
  sizes();
  return failures != 0;
}
