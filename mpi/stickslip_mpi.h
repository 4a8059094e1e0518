/* stickslip_mpi: an interface of stickslip on many processes. MIT OR Apache-2.0.
 *
 * A library of its own, C over MPI and over stickslip.h alone. Each rank hands over its own share of both surfaces, and gets the
 * contact's forces on its own nodes and entries that add up to the host's matrix. The library decides which rank works on which
 * part of the interface, brings values there and back, and renews the parts as the surfaces slide. docs/host_mpi.md is the guide.
 *
 * Collective: a function whose comment begins with "Collective" is called by all ranks of the communicator, in the same order. All
 * others are a rank's own affair, and send nothing.
 *
 * Status: those of stickslip.h. Of a collective function it is the same on all ranks, and so is the sentence that
 * stickslip_mpi_last_error_message() has: where one part refuses, all refuse, and none has moved. Sentences name nodes by the
 * host's numbers and facets by their nodes. Errors of MPI are the communicator's affair; memory that runs out ends the program by
 * MPI_Abort, for the other ranks would wait for ever.
 *
 * Vectors have 3 components, 2 of lines; multipliers as many, 1 without friction. Arrays "of the own nodes" are in the order of
 * `nodes` of the share, node by node. Inputs are read during the call only. One thread at a time, at any level of MPI's threads
 * that allows calls of this thread. */
#ifndef STICKSLIP_MPI_H
#define STICKSLIP_MPI_H

#include <mpi.h>
#include <stickslip.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Nodes with multipliers are shared out so that each rank has about as many covered ones. Default.
#define STICKSLIP_MPI_SHARES_BALANCED 0

/// The rank that owns a node in the host works on it, whether that is balanced or not: with a host whose matrix takes entries of
/// its own rows cheaper than others.
#define STICKSLIP_MPI_SHARES_OF_HOST 1

/// An interface, and this rank's part of it.
typedef struct stickslip_mpi_interface stickslip_mpi_interface;

/// What this rank owns of one surface. Every node of the surface is owned by one rank, every facet is given by one rank. A rank
/// may have nothing: both counts are 0.
typedef struct stickslip_mpi_share {
  /// sizeof(stickslip_mpi_share).
  uint64_t struct_size;
  /// Nodes of this surface that this rank owns.
  int64_t n_nodes;
  /// n_nodes: the host's numbers, whatever they are, as long as a node has the same everywhere and the nodes of a surface differ.
  const int64_t *nodes;
  /// 3 n_nodes coordinates of the first configuration [L].
  const double *coordinates;
  /// 3 n_nodes displacement equations of the whole system, in the index base; -1: none.
  const int64_t *equations;
  /// Non-mortar: 3 n_nodes multiplier equations (n_nodes without friction), likewise; mortar: NULL.
  const int64_t *multiplier_equations;
  /// Facets of this surface that this rank gives. An analytic mortar side has none, and one rank owns the nodes of its frame.
  int64_t n_facets;
  /// n_facets + 1, from 0.
  const int64_t *facet_offsets;
  /// The nodes' numbers, in the order that stickslip.h has them in; other ranks may own them.
  const int64_t *facet_nodes;
} stickslip_mpi_share;

/// How an interface is shared out. Every member's 0 is the library's choice. The same on all ranks.
typedef struct stickslip_mpi_method {
  /// sizeof(stickslip_mpi_method).
  uint64_t struct_size;
  /// STICKSLIP_MPI_SHARES_...
  int32_t shares;
  /// Further rings of non-mortar facets, for bodies that start deep in each other: one for each facet of depth beyond the first.
  int32_t further_rings;
  /// How far the surfaces may slide before parts are renewed, over the longest mortar edge [-]; 0 (default): 2. Parts are the
  /// larger the more it is.
  double margin;
} stickslip_mpi_method;

/// What this rank has of an interface.
typedef struct stickslip_mpi_counts {
  /// sizeof(stickslip_mpi_counts).
  uint64_t struct_size;
  /// Nodes of both whole surfaces.
  int64_t nodes[2];
  /// Facets of both.
  int64_t facets[2];
  /// Non-mortar nodes that this rank works on.
  int64_t worked;
  /// Nodes of its part, of both sides.
  int64_t part_nodes[2];
  /// Facets of its part.
  int64_t part_facets[2];
  /// Bytes that it keeps of the whole surfaces.
  int64_t bytes_whole;
  /// Bytes of its part, the handle's included.
  int64_t bytes_part;
  /// How often parts were renewed because the surfaces have slid.
  int64_t renewed;
  /// How often because the shares were no longer balanced.
  int64_t rebalanced;
} stickslip_mpi_counts;

/// What a restart needs, of the own nodes: arrays of the caller's, 3 a node.
typedef struct stickslip_mpi_history {
  /// sizeof(stickslip_mpi_history).
  uint64_t struct_size;
  /// How many steps have been committed.
  int64_t commits;
  /// Positions of the last commit, of the non-mortar nodes [L].
  double *x1;
  /// Of the mortar nodes [L].
  double *x2;
  /// Slip of the non-mortar nodes up to then [L].
  double *slip;
} stickslip_mpi_history;

/// Why the last call refused, in one sentence; "" if it did not. Valid until the next call.
const char *stickslip_mpi_last_error_message(void);

/// Collective. Makes an interface of the shares of all ranks of the communicator, which is duplicated.
///
/// options: as of stickslip_interface_create; the same on all ranks. method: NULL for the library's choices. out, output.
///
/// Errors: those of stickslip_interface_create; INVALID_VALUE (a node with two owners or none, a facet given twice, no facet at
/// all), INDEX_OUT_OF_RANGE (more than 2^31 - 1 nodes), UNSUPPORTED (points that decide with friction, on several ranks).
/// Cost: every rank gathers numbers, coordinates and facets of both whole surfaces, and keeps them.
int32_t stickslip_mpi_interface_create(MPI_Comm comm, const stickslip_mpi_share *nonmortar, const stickslip_mpi_share *mortar,
                                       const stickslip_options *options, const stickslip_mpi_method *method,
                                       stickslip_mpi_interface **out);

/// Collective. Ends the interface and sets the pointer to NULL. NULL, or a pointer to NULL, is fine.
int32_t stickslip_mpi_interface_destroy(stickslip_mpi_interface **interface);

/// Collective. Multipliers of the own nodes to start the first step with: see stickslip_interface_initial_multipliers.
int32_t stickslip_mpi_interface_initial_multipliers(stickslip_mpi_interface *interface, double *lambda);

/// Collective. Says where the interface is now; all evaluations that follow are of this place. Parts that the surfaces have slid
/// off are renewed, at t_n: then the tangent has other entries.
///
/// x1, x2: positions, not displacements, of the own nodes [L]; lambda: their multipliers [F/L^2].
///
/// Errors: NULL_POINTER, NOT_FINITE, and where parts are renewed those of stickslip_interface_set_committed. Within Newton's method
/// take a smaller step.
/// Cost: values between neighbours, three reductions.
int32_t stickslip_mpi_interface_update(stickslip_mpi_interface *interface, const double *x1, const double *x2, const double *lambda);

/// Collective. Forces on the own nodes and the own multiplier rows, to add to the host's residual: see
/// stickslip_interface_residual. Sums over all parts, in the order of ranks.
int32_t stickslip_mpi_interface_residual(stickslip_mpi_interface *interface, double *force1, double *force2, double *rows);

/// Collective. This rank's entries of the exact tangent, in the host's equations; those of all ranks add up. Rows may be those of
/// any rank. With all three arrays NULL only count is written: see stickslip_interface_tangent_coo.
int32_t stickslip_mpi_interface_tangent_coo(stickslip_mpi_interface *interface, int64_t capacity, int64_t *rows, int64_t *columns,
                                            double *values, int64_t *count);

/// Collective. Makes the plan of the tangent, once and whenever values are refused with MISSING_ENTRY: see
/// stickslip_interface_plan. count, output: this rank's entries.
int32_t stickslip_mpi_interface_plan(stickslip_mpi_interface *interface, int32_t pairs, int64_t *count);

/// This rank's entries of the plan: see stickslip_interface_plan_coo.
int32_t stickslip_mpi_interface_plan_coo(stickslip_mpi_interface *interface, int64_t capacity, int64_t *rows, int64_t *columns);

/// The same in 32 bits.
int32_t stickslip_mpi_interface_plan_coo32(stickslip_mpi_interface *interface, int64_t capacity, int32_t *rows, int32_t *columns);

/// Collective. The tangent in the order of the plan's entries. MISSING_ENTRY, on all ranks, where any part lacks an entry or parts
/// were renewed: make the plan again.
int32_t stickslip_mpi_interface_plan_values(stickslip_mpi_interface *interface, int64_t capacity, double *values);

/// Collective. State and results of the own nodes, before the commit: see stickslip_interface_states. Ranks need not want the same
/// members.
int32_t stickslip_mpi_interface_states(stickslip_mpi_interface *interface, const stickslip_states *states);

/// Collective. How far the interface is from contact equilibrium, the same on all ranks; its nodes have the host's numbers. See
/// stickslip_interface_equilibrium.
int32_t stickslip_mpi_interface_equilibrium(stickslip_mpi_interface *interface, stickslip_equilibrium *out);

/// Collective. How much of a step of Newton's method may be taken, from the place of the last update: see
/// stickslip_interface_step_limit. dx1, dx2: of the own nodes [L].
int32_t stickslip_mpi_interface_step_limit(stickslip_mpi_interface *interface, const double *dx1, const double *dx2,
                                           double penetration, double *fraction);

/// Collective. The multipliers of a system without them, in each evaluation after update: those that balance the rows of the own nodes.
/// They take the place of the update's. See stickslip_interface_condensed_multipliers.
///
/// host1: the residual of the host's own forces at the own non-mortar nodes, without contact [F]. lambda, output, of the own nodes.
int32_t stickslip_mpi_interface_condensed_multipliers(stickslip_mpi_interface *interface, const double *host1, double *lambda);

/// Collective. The residual of a system without multipliers: rows1 in place of the host's rows of the own non-mortar nodes, force2 to add to
/// those of the mortar nodes. See stickslip_interface_condensed_residual.
int32_t stickslip_mpi_interface_condensed_residual(stickslip_mpi_interface *interface, const double *host1, double *rows1, double *force2);

/// Collective. This rank's entries of a piece of the matrix of such a system; those of all ranks add up, and the matrix is made of the
/// sums. See stickslip_interface_condensed_coo.
int32_t stickslip_mpi_interface_condensed_coo(stickslip_mpi_interface *interface, int32_t piece, int64_t capacity, int64_t *rows,
                                              int64_t *columns, double *values, int64_t *count);

/// Collective. Accepts the step that converged at the place of the last update. Where one part refuses, no rank has committed.
/// Parts are renewed where their margin is half used up, or shares are no longer balanced.
///
/// Errors: those of stickslip_interface_commit.
int32_t stickslip_mpi_interface_commit(stickslip_mpi_interface *interface);

/// Collective. Undoes the last commit, one step deep, whether parts were renewed since or not.
///
/// Errors: NOTHING_TO_ROLL_BACK.
int32_t stickslip_mpi_interface_rollback(stickslip_mpi_interface *interface);

/// Collective. Coulomb coefficients of the own non-mortar nodes, from the next evaluation on: see stickslip_interface_set_friction.
/// Kept when parts are renewed; not part of the history.
int32_t stickslip_mpi_interface_set_friction(stickslip_mpi_interface *interface, const double *mu);

/// Collective. Offsets of the own nodes of both sides: see stickslip_interface_set_offsets. Kept when parts are renewed; not part of
/// the history.
int32_t stickslip_mpi_interface_set_offsets(stickslip_mpi_interface *interface, const double *offsets1, const double *offsets2);

/// The history of the own nodes. Write it by the nodes' numbers: a run on any number of ranks can go on from it.
int32_t stickslip_mpi_interface_history_export(const stickslip_mpi_interface *interface, stickslip_mpi_history *history);

/// Collective. Goes on from a history, with parts that are made for it. No commit can then be undone. The multipliers are the
/// host's: update before the next evaluation.
///
/// Errors: INVALID_VALUE (commits that are negative or differ between ranks), those of stickslip_interface_set_committed.
int32_t stickslip_mpi_interface_history_import(stickslip_mpi_interface *interface, const stickslip_mpi_history *history);

/// What this rank has.
int32_t stickslip_mpi_interface_counts(const stickslip_mpi_interface *interface, stickslip_mpi_counts *counts);

/// This rank's handle, for what is only asked: counters, effects. NULL where it has no part. It ends when parts are renewed.
stickslip_interface *stickslip_mpi_interface_handle(const stickslip_mpi_interface *interface);

#ifdef __cplusplus
}
#endif
#endif
