// Two elastic blocks with meshes that do not match, pressed together and drawn along each other, with friction: how contact
// by the stickslip library enters a deal.II program. Multipliers are unknowns beside the displacements.
//
//   two_blocks friction STEPS FILE   the scene two_blocks of the library, in so many steps
//   two_blocks patch 1 FILE          a constant pressure through blocks of equal width, Poisson's ratio 0
//
// FILE receives a row X Y Z ux uy uz for each node; a line is printed for each step. The blocks are linear, of small strain,
// as in step-8. Prescribed values go into the solution at the start of a step; its increments have none.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <stickslip.hpp>

#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>

using namespace dealii;

constexpr int dim = 3;
// A body's residual over its own forces: docs/host_convergence.md.
constexpr double RTOL = 2e-11;
constexpr double FRICTION = 0.3;
constexpr int MAX_ITERATIONS = 25;
// Boundary ids of a coloured hyper_rectangle.
constexpr types::boundary_id BOTTOM = 4, TOP = 5;

// What the library reads of one side, whose equations are -1 if constrained, and the unknown of each displacement.
struct Side : stickslip::Side {
  std::vector<int64_t> dofs;
};

class Block {
public:
  Block(const Point<dim> &lower, const Point<dim> &upper, const std::vector<unsigned int> &cells, double young, double poisson)
      : fe(FE_Q<dim>(1), dim), dof_handler(triangulation), mu(young / (2 * (1 + poisson))),
        lambda(2 * mu * poisson / (1 - 2 * poisson)), young(young) {
    GridGenerator::subdivided_hyper_rectangle(triangulation, cells, lower, upper, true);
    dof_handler.distribute_dofs(fe);
  }

  types::global_dof_index n_dofs() const { return dof_handler.n_dofs(); }

  // Calls add(element matrix, its unknowns) for each cell.
  template <typename Add> void for_each_cell(const Add &add) const {
    const QGauss<dim> quadrature(2);
    FEValues<dim> values(fe, quadrature, update_gradients | update_JxW_values);
    const unsigned int n = fe.n_dofs_per_cell();
    FullMatrix<double> matrix(n, n);
    std::vector<types::global_dof_index> dofs(n);
    const FEValuesExtractors::Vector displacement(0);
    for (const auto &cell : dof_handler.active_cell_iterators()) {
      values.reinit(cell);
      matrix = 0;
      for (const unsigned int q : values.quadrature_point_indices())
        for (unsigned int i = 0; i < n; i++)
          for (unsigned int j = 0; j < n; j++)
            matrix(i, j) += (2 * mu * values[displacement].symmetric_gradient(i, q) *
                                 values[displacement].symmetric_gradient(j, q) +
                             lambda * values[displacement].divergence(i, q) * values[displacement].divergence(j, q)) *
                            values.JxW(q);
      cell->get_dof_indices(dofs);
      for (auto &dof : dofs) dof += first;
      add(matrix, dofs);
    }
  }

  // The unknowns of one component at the nodes of a face of the box.
  std::vector<types::global_dof_index> dofs_of(const types::boundary_id id, const unsigned int component) const {
    const ComponentMask mask = fe.component_mask(FEValuesExtractors::Scalar(component));
    std::vector<types::global_dof_index> out;
    for (const auto k : DoFTools::extract_boundary_dofs(dof_handler, mask, {id})) out.push_back(first + k);
    return out;
  }

  Side side(const types::boundary_id id, const AffineConstraints<double> &constraints) const {
    Side out;
    std::map<types::global_dof_index, int64_t> number;
    for (const auto &cell : dof_handler.active_cell_iterators())
      for (const auto &face : cell->face_iterators()) {
        if (!face->at_boundary() || face->boundary_id() != id) continue;
        // Vertices of a face are in lexicographic order.
        std::array<unsigned int, 4> order{{0, 1, 3, 2}};
        const Tensor<1, dim> normal =
            cross_product_3d(face->vertex(1) - face->vertex(0), face->vertex(2) - face->vertex(0));
        if (normal * (face->center() - cell->center()) < 0) std::swap(order[1], order[3]);
        for (unsigned int &v : order) {
          const auto [place, is_new] = number.try_emplace(face->vertex_dof_index(v, 0), number.size());
          for (int i = 0; is_new && i < dim; i++) {
            const types::global_dof_index dof = first + face->vertex_dof_index(v, i);
            out.coordinates.push_back(face->vertex(v)[i]);
            out.dofs.push_back(dof);
            out.equations.push_back(constraints.is_constrained(dof) ? -1 : int64_t(dof));
          }
          v = place->second;
        }
        out.add_facet(order);
      }
    return out;
  }

  void write(const Vector<double> &u, std::ostream &out) const {
    std::map<types::global_dof_index, std::pair<Point<dim>, Tensor<1, dim>>> rows;
    for (const auto &cell : dof_handler.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices()) {
        auto &row = rows[cell->vertex_dof_index(v, 0)];
        row.first = cell->vertex(v);
        for (int i = 0; i < dim; i++) row.second[i] = u[first + cell->vertex_dof_index(v, i)];
      }
    out.precision(17);
    for (const auto &row : rows) out << row.second.first << ' ' << row.second.second << '\n';
  }

private:
  Triangulation<dim> triangulation;
  FESystem<dim> fe;
  DoFHandler<dim> dof_handler;
  double mu, lambda; // Lame's constants

public:
  double young;
  types::global_dof_index first = 0; // its first unknown among those of the whole system
};

class TwoBlocks {
public:
  explicit TwoBlocks(bool patch);
  void solve_step(int step, double fraction);
  void write(const char *file) const;

private:
  void make_pattern();
  void assemble();
  bool converged();
  void positions();

  Block upper, lower;
  Side side1, side2; // the upper block's bottom, non-mortar; the lower block's top
  Tensor<1, dim> grip; // way of the upper block's top
  std::unique_ptr<stickslip::Contact> contact;
  std::vector<double> x1, x2, multipliers; // of the last assembly
  AffineConstraints<double> constraints;
  SparsityPattern pattern;
  SparseMatrix<double> matrix;
  Vector<double> solution, residual, internal; // internal: forces without contact, reactions among them
};

TwoBlocks::TwoBlocks(const bool patch)
    : upper(patch ? Point<dim>(0, 0, 0.8) : Point<dim>(0.1, 0.1, 0.8), patch ? Point<dim>(1, 1, 1.6) : Point<dim>(0.9, 0.9, 1.6),
            {4, 4, 4}, 1000, patch ? 0 : 0.3),
      lower(Point<dim>(0, 0, 0), Point<dim>(1, 1, 0.8), {5, 5, 4}, 2000, patch ? 0 : 0.3) {
  if (patch) grip[2] = -0.005;
  else grip = Point<dim>(0.002, 0.0008, -0.005);
  lower.first = upper.n_dofs();
  const types::global_dof_index first_multiplier = lower.first + lower.n_dofs();
  for (int i = 0; i < dim; i++) {
    for (const auto dof : upper.dofs_of(TOP, i)) constraints.add_line(dof);
    for (const auto dof : lower.dofs_of(BOTTOM, i)) constraints.add_line(dof);
  }
  constraints.close();

  side1 = upper.side(BOTTOM, constraints);
  side2 = lower.side(TOP, constraints);
  multipliers.resize(side1.dofs.size());
  for (size_t k = 0; k < multipliers.size(); k++) side1.multiplier_equations.push_back(first_multiplier + k);
  stickslip_options options = stickslip::default_options();
  options.mu = FRICTION;
  options.modulus = upper.young; // of the softer body: gives the augmentation its unit; the answer does not depend on it
  contact = std::make_unique<stickslip::Contact>(side1, side2, options);
  contact->start(multipliers.data());

  solution.reinit(first_multiplier + multipliers.size());
  residual.reinit(solution), internal.reinit(solution);
  std::copy(multipliers.begin(), multipliers.end(), solution.begin() + first_multiplier);
  positions();
  make_pattern();
}

// The library takes positions, not displacements.
void TwoBlocks::positions() {
  x1 = side1.coordinates, x2 = side2.coordinates;
  for (size_t k = 0; k < x1.size(); k++) x1[k] += solution[side1.dofs[k]];
  for (size_t k = 0; k < x2.size(); k++) x2[k] += solution[side2.dofs[k]];
  std::copy(solution.begin() + (lower.first + lower.n_dofs()), solution.end(), multipliers.begin());
}

// Entries of the cells, and those of all pairs of facets that may meet while the blocks slide by less than a quarter of one.
void TwoBlocks::make_pattern() {
  contact->plan(x1.data(), x2.data());
  DynamicSparsityPattern dynamic(solution.size());
  for (const Block *block : {&upper, &lower})
    block->for_each_cell([&](const auto &, const auto &dofs) { constraints.add_entries_local_to_global(dofs, dynamic); });
  const stickslip::Entries &entries = contact->planned();
  for (size_t k = 0; k < entries.size(); k++) dynamic.add(entries.rows[k], entries.columns[k]);
  matrix.clear();
  pattern.copy_from(dynamic);
  matrix.reinit(pattern);
}

void TwoBlocks::assemble() {
  positions();
  if (!contact->values(x1.data(), x2.data(), multipliers.data())) { // the blocks have slid on
    make_pattern();
    contact->values(x1.data(), x2.data(), multipliers.data());
  }
  contact->evaluate(x1.data(), x2.data(), multipliers.data());
  matrix = 0, internal = 0;
  for (const Block *block : {&upper, &lower})
    block->for_each_cell([&](const FullMatrix<double> &cell, const std::vector<types::global_dof_index> &dofs) {
      Vector<double> u(dofs.size()), force(dofs.size());
      for (size_t k = 0; k < dofs.size(); k++) u[k] = solution[dofs[k]];
      cell.vmult(force, u);
      internal.add(dofs, force);
      constraints.distribute_local_to_global(cell, dofs, matrix);
    });
  const stickslip::Entries &entries = contact->planned();
  for (size_t k = 0; k < entries.size(); k++) matrix.add(entries.rows[k], entries.columns[k], entries.values[k]);
  residual = internal;
  for (size_t k = 0; k < x1.size(); k++) residual[side1.dofs[k]] += contact->force1()[k];
  for (size_t k = 0; k < x2.size(); k++) residual[side2.dofs[k]] += contact->force2()[k];
  std::copy(contact->rows().begin(), contact->rows().end(), residual.begin() + (lower.first + lower.n_dofs()));
}

// The forces on each block balance, beside its own ones, and the interface is in contact equilibrium.
bool TwoBlocks::converged() {
  for (const Block *block : {&upper, &lower}) {
    double free = 0, reactions = 0, contact_forces = 0;
    for (auto k = block->first; k < block->first + block->n_dofs(); k++)
      (constraints.is_constrained(k) ? reactions : free) += residual[k] * residual[k];
    for (const double f : block == &upper ? contact->force1() : contact->force2()) contact_forces += f * f;
    if (std::sqrt(free) > RTOL * (std::sqrt(reactions) + std::sqrt(contact_forces))) return false;
  }
  return stickslip::balanced(contact->equilibrium(x1.data(), x2.data(), multipliers.data()));
}

void TwoBlocks::solve_step(const int step, const double fraction) {
  for (int i = 0; i < dim; i++)
    for (const auto dof : upper.dofs_of(TOP, i)) solution[dof] = fraction * grip[i];
  int iterations = 0;
  for (assemble(); !converged(); assemble()) {
    if (iterations++ == MAX_ITERATIONS) throw std::runtime_error("Newton's method does not converge");
    constraints.set_zero(residual);
    SparseDirectUMFPACK solver; // multipliers of nodes that stick have no diagonal: it pivots
    Vector<double> increment(solution.size());
    solver.initialize(matrix);
    solver.vmult(increment, residual);
    constraints.set_zero(increment);
    solution -= increment;
  }
  const stickslip::States states = contact->states(x1.data(), x2.data(), multipliers.data());
  contact->commit(x1.data(), x2.data(), multipliers.data());
  double least = 0, most = -1e300;
  for (size_t k = 2; k < multipliers.size(); k += dim)
    least = std::min(least, multipliers[k]), most = std::max(most, multipliers[k]);
  std::cout << "step " << step << " iterations " << iterations << " gap " << states.count(STICKSLIP_STATE_GAP) << " stick "
            << states.count(STICKSLIP_STATE_STICK) << " slip " << states.count(STICKSLIP_STATE_SLIP) << " multipliers along z "
            << least << ' ' << most << std::endl;
}

void TwoBlocks::write(const char *file) const {
  std::ofstream out(file);
  upper.write(solution, out);
  lower.write(solution, out);
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
