/* stickslip.hpp: the assembled interface of stickslip.h as a class of C++11. MIT OR Apache-2.0.
 *
 * Refusals become exceptions, and memory cleans up by itself. Nothing is added to what the functions of stickslip.h do: their
 * comments say shapes, units and signs. What the class does not have is called with Contact::get().
 *
 * Arrays of results belong to the object. They are as large as the surfaces ask for from the start, those of entries as large as
 * the most entries so far: an evaluation allocates nothing here once the surfaces meet.
 */
#ifndef STICKSLIP_HPP
#define STICKSLIP_HPP

#include <stickslip.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

namespace stickslip {

/// A refusal of the library, with its message. Within Newton's method: catch it, and take a smaller step.
class Refused : public std::runtime_error {
public:
  explicit Refused(int32_t status) : std::runtime_error(stickslip_last_error_message()), status_(status) {}
  /// STICKSLIP_NOT_FINITE and so on.
  int32_t status() const noexcept { return status_; }

private:
  int32_t status_;
};

/// Throws Refused unless the status is STICKSLIP_OK. For functions of stickslip.h that the class does not have.
inline void must(int32_t status) {
  if (status != STICKSLIP_OK) throw Refused(status);
}

/// A struct of stickslip.h with its size set and all else 0.
template <class Struct> Struct sized() {
  Struct out{};
  out.struct_size = sizeof out;
  return out;
}

/// The options with the library's defaults.
inline stickslip_options default_options() {
  stickslip_options out;
  must(stickslip_options_init(&out, sizeof out));
  return out;
}

/// What the library reads of one side: fill it facet by facet.
struct Side {
  /// Of the first configuration, node by node.
  std::vector<double> coordinates;
  /// Of each displacement; -1: prescribed.
  std::vector<int64_t> equations;
  /// Of each multiplier, on the non-mortar side; empty on the mortar side.
  std::vector<int64_t> multiplier_equations;
  std::vector<int64_t> facet_offsets = std::vector<int64_t>(1, 0);
  std::vector<int64_t> facet_nodes;
  /// Of a position: 3, in plane and axisymmetric models 2.
  std::size_t components = 3;

  std::size_t n_nodes() const { return coordinates.size() / components; }
  std::size_t n_facets() const { return facet_offsets.size() - 1; }

  /// A facet's nodes, a range of numbers of this side, in right-hand order seen from outside the body.
  template <class Nodes> void add_facet(const Nodes &nodes) {
    for (const auto node : nodes) facet_nodes.push_back(static_cast<int64_t>(node));
    facet_offsets.push_back(static_cast<int64_t>(facet_nodes.size()));
  }

  /// For the functions of stickslip.h; it points into this object.
  stickslip_surface surface() const {
    stickslip_surface out = sized<stickslip_surface>();
    out.n_nodes = static_cast<int64_t>(n_nodes());
    out.n_facets = static_cast<int64_t>(n_facets());
    out.coordinates = coordinates.data();
    out.equations = equations.data();
    out.facet_offsets = facet_offsets.data();
    out.facet_nodes = facet_nodes.data();
    out.multiplier_equations = multiplier_equations.empty() ? nullptr : multiplier_equations.data();
    return out;
  }
};

/// Entries of a matrix: row, column and value of each.
struct Entries {
  std::vector<int64_t> rows, columns;
  std::vector<double> values;

  std::size_t size() const { return values.size(); }
};

/// Results of the non-mortar nodes: see stickslip_states.
struct States {
  std::vector<int32_t> state;
  std::vector<double> normal, traction, gap, slip;

  /// How many nodes have a state.
  std::size_t count(int32_t wanted) const {
    std::size_t out = 0;
    for (const int32_t s : state) out += s == wanted;
    return out;
  }
};

/// For a restart, beside the multipliers.
struct History {
  std::vector<int64_t> integers;
  std::vector<double> reals;
};

/// One interface. x1, x2: present positions of the nodes of both sides, not displacements; lambda: the multipliers.
class Contact {
public:
  Contact(const stickslip_surface &nonmortar, const stickslip_surface &mortar, const stickslip_options &options)
      : modulus_(options.modulus), components_(options.model == STICKSLIP_MODEL_SOLID ? 3 : 2) {
    stickslip_interface *handle = nullptr;
    must(stickslip_interface_create(&nonmortar, &mortar, &options, &handle));
    handle_.reset(handle);
    n1_ = static_cast<std::size_t>(nonmortar.n_nodes);
    force1_.resize(components_ * n1_);
    force2_.resize(components_ * static_cast<std::size_t>(mortar.n_nodes));
    rows_.resize(options.friction == STICKSLIP_FRICTION_NONE ? n1_ : components_ * n1_);
  }
  Contact(const Side &nonmortar, const Side &mortar, const stickslip_options &options)
      : Contact(nonmortar.surface(), mortar.surface(), options) {}

  /// Writes the multipliers that the first step starts from: once.
  void start(double *lambda) { must(stickslip_interface_initial_multipliers(get(), lambda)); }

  /// Computes force1, force2 and rows.
  void evaluate(const double *x1, const double *x2, const double *lambda, const double *sums = nullptr) {
    must(stickslip_interface_residual(get(), x1, x2, lambda, sums, force1_.data(), force2_.data(), rows_.data()));
  }
  /// Of the last evaluate(): add them to the internal forces of the nodes of each side.
  const std::vector<double> &force1() const { return force1_; }
  const std::vector<double> &force2() const { return force2_; }
  /// Of the last evaluate(): the equations of the multipliers.
  const std::vector<double> &rows() const { return rows_; }

  /// The tangent's entries, which may come more than once. The next call overwrites them.
  const Entries &tangent(const double *x1, const double *x2, const double *lambda, const double *sums = nullptr) {
    int64_t count = 0;
    resize(tangent_.values.capacity(), tangent_);
    int32_t status = STICKSLIP_BUFFER_TOO_SMALL;
    if (tangent_.size()) status = tangent_coo(x1, x2, lambda, sums, &count);
    if (status == STICKSLIP_BUFFER_TOO_SMALL) {
      must(stickslip_interface_tangent_coo(get(), x1, x2, lambda, sums, 0, nullptr, nullptr, nullptr, &count));
      resize(static_cast<std::size_t>(count), tangent_);
      status = tangent_coo(x1, x2, lambda, sums, &count);
    }
    must(status);
    resize(static_cast<std::size_t>(count), tangent_);
    return tangent_;
  }

  /// Where the entries of the tangent are, each once, for values() to fill: rows and columns of planned(). pairs:
  /// STICKSLIP_PLAN_...
  void plan(const double *x1, const double *x2, int32_t pairs = STICKSLIP_PLAN_SKIN) {
    int64_t n_rows = 0, count = 0;
    must(stickslip_interface_plan(get(), x1, x2, pairs, &n_rows, &count));
    resize(static_cast<std::size_t>(count), planned_);
    must(stickslip_interface_plan_coo(get(), STICKSLIP_ENTRIES_TANGENT, count, planned_.rows.data(), planned_.columns.data()));
  }
  /// Fills the values of planned(). False: the plan lacks an entry, since the surfaces have slid on. Plan again, and renew the matrix'
  /// pattern.
  bool values(const double *x1, const double *x2, const double *lambda, const double *sums = nullptr) {
    const int32_t status = stickslip_interface_plan_values(get(), x1, x2, lambda, sums, static_cast<int64_t>(planned_.size()),
                                                           planned_.values.data());
    if (status == STICKSLIP_MISSING_ENTRY) return false;
    must(status);
    return true;
  }
  const Entries &planned() const { return planned_; }

  /// How far the contact is from equilibrium; modulus is that of the options. least_traction: the largest of earlier steps, or 0.
  stickslip_equilibrium equilibrium(const double *x1, const double *x2, const double *lambda, double least_traction = 0,
                                    const double *sums = nullptr) {
    stickslip_equilibrium out = sized<stickslip_equilibrium>();
    out.modulus = modulus_;
    out.least_traction = least_traction;
    must(stickslip_interface_equilibrium(get(), x1, x2, lambda, sums, &out));
    return out;
  }

  States states(const double *x1, const double *x2, const double *lambda, const double *sums = nullptr) {
    States out;
    out.state.resize(n1_);
    out.gap.resize(n1_);
    for (std::vector<double> *values : {&out.normal, &out.traction, &out.slip}) values->resize(components_ * n1_);
    stickslip_states wanted = sized<stickslip_states>();
    wanted.state = out.state.data();
    wanted.normal = out.normal.data();
    wanted.traction = out.traction.data();
    wanted.gap = out.gap.data();
    wanted.slip = out.slip.data();
    must(stickslip_interface_states(get(), x1, x2, lambda, sums, &wanted));
    return out;
  }

  /// Whether commit() would accept the step; throws its refusal. For several interfaces: ask all, then commit.
  void check_commit(const double *x1, const double *x2, const double *lambda, const double *sums = nullptr) {
    must(stickslip_interface_commit_check(get(), x1, x2, lambda, sums));
  }
  /// Once after each converged step.
  void commit(const double *x1, const double *x2, const double *lambda, const double *sums = nullptr) {
    must(stickslip_interface_commit(get(), x1, x2, lambda, sums));
  }
  /// Undoes the last commit.
  void rollback() { must(stickslip_interface_rollback(get())); }

  History history() const {
    int64_t integers = 0, reals = 0;
    must(stickslip_interface_history_size(get(), &integers, &reals));
    History out;
    out.integers.resize(static_cast<std::size_t>(integers));
    out.reals.resize(static_cast<std::size_t>(reals));
    must(stickslip_interface_history_export(get(), integers, out.integers.data(), reals, out.reals.data()));
    return out;
  }
  void restore(const History &history) {
    must(stickslip_interface_history_import(get(), static_cast<int64_t>(history.integers.size()), history.integers.data(),
                                            static_cast<int64_t>(history.reals.size()), history.reals.data()));
  }

  /// For all other functions of stickslip.h. The object keeps it.
  stickslip_interface *get() const noexcept { return handle_.get(); }

private:
  struct Destroy {
    void operator()(stickslip_interface *handle) const noexcept { stickslip_interface_destroy(&handle); }
  };

  static void resize(std::size_t count, Entries &entries) {
    entries.rows.resize(count);
    entries.columns.resize(count);
    entries.values.resize(count);
  }
  int32_t tangent_coo(const double *x1, const double *x2, const double *lambda, const double *sums, int64_t *count) {
    return stickslip_interface_tangent_coo(get(), x1, x2, lambda, sums, static_cast<int64_t>(tangent_.size()), tangent_.rows.data(),
                                           tangent_.columns.data(), tangent_.values.data(), count);
  }

  std::unique_ptr<stickslip_interface, Destroy> handle_;
  double modulus_;
  std::size_t components_, n1_ = 0;
  std::vector<double> force1_, force2_, rows_;
  Entries tangent_, planned_;
};

/// Whether contact is in equilibrium. 1e-10 is what docs/host_convergence.md takes.
inline bool balanced(const stickslip_equilibrium &e, double tolerance = 1e-10) {
  return e.gap <= tolerance * e.gap_scale && e.traction <= tolerance * e.traction_scale && e.slip <= tolerance * e.slip_scale;
}

} // namespace stickslip

#endif
