//! Laws that hold exactly (docs/formulation 7) and the rows W, S, K, I of the hard tests (docs/formulation 9) that random
//! input can try; and where each is tried. Numbers are sections of that document. P: `pairs`, N: `nodes`, I: `interfaces`, G: `singular`, C: `normals`; in the
//! last column other files, with chosen or golden cases.
//!
//! | law | on random input | elsewhere |
//! |---|---|---|
//! | 7.1, W3, W5 sums, bounds, symmetry of weights | P `laws_of_any_pair` | `mortar/golden.rs` |
//! | 7.2, I5 forces balance | I `laws_of_any_interface` | `interface/identities.rs` |
//! | 7.2, I5 moments are those of the gaps | I `laws_of_any_interface` | `interface/identities.rs` |
//! | 7.4, I1 rigid motion: weights | P `rigid_motion_keeps_the_weights` | |
//! | 7.4, I1 rigid motion: residual | I `rigid_motion_turns_the_residual` | `interface/identities.rs` |
//! | 7.4, I1 rigid motion: projection | N `projection_is_homogeneous_and_turns_with_the_frame` | |
//! | 8.3, I2 exact offsets | P `exact_offsets_change_no_bit` | `interface/identities.rs` |
//! | 7.5, I4 units: weights, at sizes over 120 decades | P `powers_of_two_change_no_bit` | |
//! | 7.5, I4 units: residual | I `units_change_no_bit` | `interface/identities.rs` |
//! | 4.4, S4 Coulomb's conditions, any r | N `row_vanishes_at_the_solution_whatever_r` | check `invariance` |
//! | 4.4, S2 the cone; 4.6 no friction | N `projection_lies_on_the_cone` | `interface/identities.rs` |
//! | 7.6 patch test | | checks `patch` |
//! | W1, W2, W8 golden weights and derivatives | | `mortar/golden.rs`, `capi/golden.rs` |
//! | W4 slivers, touching, no overlap | P `coincident_pairs_share_the_exact_area` | `mortar/golden.rs` |
//! | W6 parts add up | P `parts_of_a_mortar_facet_add_up` | |
//! | W7 translation, rotation, Euler | P `laws_of_any_pair` | `mortar/golden.rs` |
//! | W9 differences of weights | P `derivatives_equal_differences` | |
//! | S1, S2, K1, K6 golden residuals, states, tangents | | `interface/golden.rs`, `capi/golden.rs` |
//! | S3 continuity across the borders | N `projection_is_continuous_and_differentiated` | |
//! | S5, A-B-A: a step taken back, a restart | I `laws_of_any_interface` | `interface/history.rs` |
//! | K2 differences of the residual | I `tangent_equals_differences` | `interface/tangent.rs` |
//! | K3 dual numbers | | `src/law`, `src/mortar/oracle.rs` |
//! | K4 sums of rows and columns | I `laws_of_any_interface` | |
//! | K5 symmetry | | `interface/tangent.rs` |
//! | I3 numbering, begin, orientation | P `numbering_does_not_matter` | `interface/identities.rs` |
//! | I6 rigid motion within a step | | `interface/identities.rs` |
//! | 11.1 derivative of the normal: translation, stretching, rotation | C `derivatives_of_a_normal_keep_its_identities` | |
//! | 11.1 derivative of the normal: differences | C `derivatives_of_a_normal_equal_differences` | `interface/normals.rs` |
//! | 11.2 laws under a turn of the normal | C `answers_turn_with_the_normal_as_differences_say` | `capi/normals.rs` |
//! | 5.6 parts of an interface add up to the whole | | `interface/parts.rs` |
//! | I7 threads | | `tests/capi/t50_threads.c` |
//! | no law: maps that are all but singular are refused, or all is finite | G `facets_with_nearly_singular_maps_are_refused_or_finite` | `mortar/golden.rs` |
//!
//! `cargo test` tries 1e4 pairs in all, the same in every run; `make random SEED=n` ten times as many others, with
//! `CASES=150000` more than 1e6.

#[path = "../support/mod.rs"]
mod support;

mod exact;
mod geometry;
mod interfaces;
mod nodes;
mod normals;
mod pairs;
mod singular;

use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;

/// Pairs that each law of pairs is tried on; `PROPTEST_CASES` asks for more.
const CASES: u32 = 1500;

/// Cases of a test that costs as much as `cost` pairs. What fails is kept beside the source and tried first ever after.
fn config(source: &'static str, cost: u32) -> ProptestConfig {
    let mut config = ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("regressions"))),
        source_file: Some(source),
        max_shrink_iters: 20_000,
        ..support::random::cases(CASES)
    };
    if std::env::var_os("PROPTEST_CASES").is_some() {
        config.cases = ProptestConfig::default().cases;
    }
    config.cases = (config.cases / cost).max(1);
    config.max_global_rejects = 20 * config.cases;
    config
}

/// Euler angles of any rotation.
fn angles() -> impl Strategy<Value = [f64; 3]> {
    [-3.0..3.0f64, -3.0..3.0, -3.0..3.0]
}
