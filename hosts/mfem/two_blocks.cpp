// Two elastic blocks with meshes that do not match, pressed together and drawn along each other, with friction: how contact
// by the stickslip library enters an MFEM program. Multipliers are unknowns beside the displacements.
//
//   two_blocks friction STEPS FILE   the scene two_blocks of the library, in so many steps
//   two_blocks patch 1 FILE          a constant pressure through blocks of equal width, Poisson's ratio 0
//
// FILE receives a row X Y Z ux uy uz for each node; a line is printed for each step. The blocks are linear, of small strain,
// as in ex2. Prescribed values go into the solution at the start of a step; its increments have none.
#include <mfem.hpp>
#include <stickslip.hpp>
#include <umfpack.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using mfem::Array;
using mfem::SparseMatrix;
using mfem::Vector;

constexpr int DIM = 3;
// A body's residual over its own forces: docs/host_convergence.md.
constexpr double RTOL = 2e-11;
constexpr double FRICTION = 0.3;
constexpr int MAX_ITERATIONS = 25;
// Boundary attributes of Mesh::MakeCartesian3D.
constexpr int BOTTOM = 1, TOP = 6;

// The library takes positions, not displacements.
static std::vector<double> positions(const stickslip::Side &side, const Vector &solution) {
  std::vector<double> out = side.coordinates;
  for (size_t k = 0; k < out.size(); k++) out[k] += solution(int(side.equations[k]));
  return out;
}

struct Block {
  double young;
  int first = 0; // its first unknown among those of the whole system
  mfem::Mesh mesh;
  mfem::H1_FECollection collection{1, DIM};
  mfem::FiniteElementSpace space;
  mfem::ConstantCoefficient lambda, mu; // Lame's constants
  mfem::BilinearForm stiffness;

  static mfem::Mesh box(const double (&lower)[DIM], const double (&upper)[DIM], const int (&cells)[DIM]) {
    mfem::Mesh out = mfem::Mesh::MakeCartesian3D(cells[0], cells[1], cells[2], mfem::Element::HEXAHEDRON,
                                                 upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
    for (int v = 0; v < out.GetNV(); v++)
      for (int i = 0; i < DIM; i++) out.GetVertex(v)[i] += lower[i];
    return out;
  }

  Block(const double (&lower)[DIM], const double (&upper)[DIM], const int (&cells)[DIM], double young, double poisson)
      : young(young), mesh(box(lower, upper, cells)), space(&mesh, &collection, DIM, mfem::Ordering::byVDIM),
        lambda(young * poisson / ((1 + poisson) * (1 - 2 * poisson))), mu(young / (2 * (1 + poisson))),
        stiffness(&space) {
    stiffness.AddDomainIntegrator(new mfem::ElasticityIntegrator(lambda, mu));
    stiffness.Assemble();
    stiffness.Finalize();
  }

  int size() const { return space.GetTrueVSize(); }
  // With linear elements the degrees of freedom are those of the vertices.
  int unknown(const int vertex, const int i) const { return first + space.DofToVDof(vertex, i); }

  Array<int> unknowns_of(const int attribute, const int component) {
    Array<int> marker(mesh.bdr_attributes.Max()), out;
    marker = 0;
    marker[attribute - 1] = 1;
    space.GetEssentialTrueDofs(marker, out, component);
    for (int &k : out) k += first;
    return out;
  }

  // outward: where the normal out of the body points along z, 1 or -1.
  stickslip::Side side(const int attribute, const int outward) {
    stickslip::Side out;
    std::vector<int64_t> number(mesh.GetNV(), -1);
    Array<int> v;
    for (int f = 0; f < mesh.GetNBE(); f++) {
      if (mesh.GetBdrAttribute(f) != attribute) continue;
      mesh.GetBdrElementVertices(f, v);
      const double *a = mesh.GetVertex(v[0]), *b = mesh.GetVertex(v[1]), *d = mesh.GetVertex(v[3]);
      if (outward * ((b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0])) < 0) std::swap(v[1], v[3]);
      for (int &vertex : v) {
        if (number[vertex] < 0) {
          number[vertex] = out.n_nodes();
          for (int i = 0; i < DIM; i++) {
            out.coordinates.push_back(mesh.GetVertex(vertex)[i]);
            out.equations.push_back(unknown(vertex, i));
          }
        }
        vertex = number[vertex];
      }
      out.add_facet(v);
    }
    return out;
  }
};

class TwoBlocks {
public:
  explicit TwoBlocks(bool patch);
  void solve_step(int step, double fraction);
  void write(const char *file);

private:
  void evaluate();
  bool converged();
  void solve_and_update();
  double *multipliers() { return solution.GetData() + first_multiplier; }

  Block upper, lower;
  stickslip::Side side1, side2; // the upper block's bottom, non-mortar; the lower block's top
  double grip[DIM];  // way of the upper block's top
  int first_multiplier;
  std::vector<bool> prescribed;
  std::unique_ptr<stickslip::Contact> contact;
  std::vector<double> x1, x2; // of the last evaluation
  Vector solution, residual;
};

TwoBlocks::TwoBlocks(const bool patch)
    : upper({patch ? 0 : 0.1, patch ? 0 : 0.1, 0.8}, {patch ? 1 : 0.9, patch ? 1 : 0.9, 1.6}, {4, 4, 4}, 1000, patch ? 0 : 0.3),
      lower({0, 0, 0}, {1, 1, 0.8}, {5, 5, 4}, 2000, patch ? 0 : 0.3),
      grip{patch ? 0 : 0.002, patch ? 0 : 0.0008, -0.005} {
  lower.first = upper.size();
  first_multiplier = lower.first + lower.size();
  side1 = upper.side(BOTTOM, -1), side2 = lower.side(TOP, 1);
  for (size_t k = 0; k < side1.equations.size(); k++) side1.multiplier_equations.push_back(first_multiplier + k);
  stickslip_options options = stickslip::default_options();
  options.mu = FRICTION;
  options.modulus = upper.young; // of the softer body: gives the augmentation its unit; the answer does not depend on it
  contact.reset(new stickslip::Contact(side1, side2, options));

  solution.SetSize(first_multiplier + side1.multiplier_equations.size()), residual.SetSize(solution.Size());
  solution = 0.0;
  contact->start(multipliers());
  prescribed.assign(solution.Size(), false); // no contact node is among them: else its equation would be -1
  for (int i = 0; i < DIM; i++) {
    for (const int k : upper.unknowns_of(TOP, i)) prescribed[k] = true;
    for (const int k : lower.unknowns_of(BOTTOM, i)) prescribed[k] = true;
  }
}

// Internal forces, reactions among them, plus contact; then the multiplier rows.
void TwoBlocks::evaluate() {
  x1 = positions(side1, solution), x2 = positions(side2, solution);
  contact->evaluate(x1.data(), x2.data(), multipliers());
  residual = 0.0;
  for (Block *block : {&upper, &lower}) {
    Vector u(solution.GetData() + block->first, block->size()), r(residual.GetData() + block->first, block->size());
    block->stiffness.SpMat().Mult(u, r);
  }
  for (size_t k = 0; k < x1.size(); k++) residual(int(side1.equations[k])) += contact->force1()[k];
  for (size_t k = 0; k < x2.size(); k++) residual(int(side2.equations[k])) += contact->force2()[k];
  for (size_t k = 0; k < contact->rows().size(); k++) residual(first_multiplier + int(k)) = contact->rows()[k];
}

// The forces on each block balance, beside its own ones, and the interface is in contact equilibrium.
bool TwoBlocks::converged() {
  for (const Block *block : {&upper, &lower}) {
    double free = 0, reactions = 0, contact_forces = 0;
    for (int k = block->first; k < block->first + block->size(); k++)
      (prescribed[k] ? reactions : free) += residual[k] * residual[k];
    for (const double f : block == &upper ? contact->force1() : contact->force2()) contact_forces += f * f;
    if (std::sqrt(free) > RTOL * (std::sqrt(reactions) + std::sqrt(contact_forces))) return false;
  }
  return stickslip::balanced(contact->equilibrium(x1.data(), x2.data(), multipliers()));
}

// Multipliers of nodes that stick have no diagonal: the solver pivots. An MFEM with SuiteSparse has UMFPackSolver for this.
void TwoBlocks::solve_and_update() {
  const stickslip::Entries &entries = contact->tangent(x1.data(), x2.data(), multipliers());
  SparseMatrix matrix(solution.Size());
  for (size_t k = 0; k < entries.size(); k++) matrix.Add(entries.rows[k], entries.columns[k], entries.values[k]);
  for (Block *block : {&upper, &lower}) {
    const SparseMatrix &own = block->stiffness.SpMat();
    for (int row = 0; row < own.Height(); row++)
      for (int k = own.GetI()[row]; k < own.GetI()[row + 1]; k++)
        if (!prescribed[block->first + row] && !prescribed[block->first + own.GetJ()[k]])
          matrix.Add(block->first + row, block->first + own.GetJ()[k], own.GetData()[k]);
  }
  for (int k = 0; k < solution.Size(); k++)
    if (prescribed[k]) matrix.Add(k, k, upper.young), residual[k] = 0;
  matrix.Finalize();
  matrix.SortColumnIndices();

  // The rows of MFEM are the columns of UMFPACK: it solves with the transpose.
  void *symbolic = nullptr, *numeric = nullptr;
  const int n = solution.Size(), *i = matrix.GetI(), *j = matrix.GetJ();
  const double *a = matrix.GetData();
  Vector increment(n);
  if (umfpack_di_symbolic(n, n, i, j, a, &symbolic, nullptr, nullptr) != UMFPACK_OK ||
      umfpack_di_numeric(i, j, a, symbolic, &numeric, nullptr, nullptr) != UMFPACK_OK ||
      umfpack_di_solve(UMFPACK_At, i, j, a, increment.GetData(), residual.GetData(), numeric, nullptr, nullptr) != UMFPACK_OK)
    throw std::runtime_error("UMFPACK finds no solution");
  umfpack_di_free_symbolic(&symbolic), umfpack_di_free_numeric(&numeric);
  solution -= increment;
}

void TwoBlocks::solve_step(const int step, const double fraction) {
  for (int i = 0; i < DIM; i++)
    for (const int k : upper.unknowns_of(TOP, i)) solution[k] = fraction * grip[i];
  int iterations = 0;
  for (evaluate(); !converged(); evaluate()) {
    if (iterations++ == MAX_ITERATIONS) throw std::runtime_error("Newton's method does not converge");
    solve_and_update();
  }
  const stickslip::States states = contact->states(x1.data(), x2.data(), multipliers());
  contact->commit(x1.data(), x2.data(), multipliers());
  double least = solution[first_multiplier + 2], most = least;
  for (int k = first_multiplier + 2; k < solution.Size(); k += DIM)
    least = std::min(least, solution[k]), most = std::max(most, solution[k]);
  std::cout << "step " << step << " iterations " << iterations << " gap " << states.count(STICKSLIP_STATE_GAP) << " stick "
            << states.count(STICKSLIP_STATE_STICK) << " slip " << states.count(STICKSLIP_STATE_SLIP) << " multipliers along z "
            << least << ' ' << most << std::endl;
}

void TwoBlocks::write(const char *file) {
  std::ofstream out(file);
  out.precision(17);
  for (Block *block : {&upper, &lower})
    for (int v = 0; v < block->mesh.GetNV(); v++) {
      for (int i = 0; i < DIM; i++) out << block->mesh.GetVertex(v)[i] << ' ';
      for (int i = 0; i < DIM; i++) out << solution[block->unknown(v, i)] << (i + 1 < DIM ? ' ' : '\n');
    }
}

int main(int argc, char **argv) {
  const std::string kind = argc == 4 ? argv[1] : "";
  const int steps = argc == 4 ? std::atoi(argv[2]) : 0;
  if ((kind != "friction" && kind != "patch") || steps < 1) {
    std::cerr << "usage: two_blocks friction|patch STEPS FILE\n";
    return 1;
  }
  try {
    std::cout.precision(16);
    TwoBlocks problem(kind == "patch");
    for (int step = 1; step <= steps; step++) problem.solve_step(step, double(step) / steps);
    problem.write(argv[3]);
  } catch (const std::exception &e) {
    std::cerr << "two_blocks: " << e.what() << '\n';
    return 1;
  }
  return 0;
}
