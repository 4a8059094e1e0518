//! Every struct of the ABI is laid out in Rust as the C compiler lays out the header's, without padding.

use crate::support::c::*;
use std::fmt::Write;
use std::mem::{offset_of, size_of};
use std::path::Path;
use std::process::Command;
use stickslip::capi::*;

/// A struct's name, its size, and its members with offset and size, in order.
struct Layout {
    name: &'static str,
    size: usize,
    members: Vec<(&'static str, usize, usize)>,
}

/// The size of what a projection of a reference points to.
fn size_of_member<S, M>(_: fn(&S) -> &M) -> usize {
    size_of::<M>()
}

macro_rules! layout {
    ($name:ident { $($member:ident),* }) => {{
        // Every member by name: a new one does not compile until it is listed here.
        let _ = |s: $name| { let $name { $($member: _),* } = s; };
        Layout {
            name: stringify!($name),
            size: size_of::<$name>(),
            members: vec![$((stringify!($member), offset_of!($name, $member), size_of_member(|s: &$name| &s.$member))),*],
        }
    }};
}

fn layouts() -> Vec<Layout> {
    vec![
        layout!(stickslip_surface {
            struct_size,
            n_nodes,
            n_facets,
            coordinates,
            facet_offsets,
            facet_nodes,
            equations,
            multiplier_equations,
            owned
        }),
        layout!(stickslip_options {
            struct_size,
            method,
            friction,
            mortar_side,
            shape,
            model,
            small_displacements,
            index_base,
            mu,
            shear_limit,
            thickness,
            radius,
            modulus,
            search_distance
        }),
        layout!(stickslip_method {
            struct_size,
            form,
            slip,
            weights,
            multiplier_basis,
            normals,
            multiplier_space,
            decision,
            quadrature,
            row_scale,
            new_contact,
            integration,
            tangent,
            no_shortcuts,
            threads,
            element_points,
            augmentation,
            coverage_min,
            weak_coverage,
            turn_max
        }),
        layout!(stickslip_states {
            struct_size,
            state,
            normal,
            traction,
            gap,
            slip,
            coverage,
            area,
            dissipation,
            augmentation,
            share,
            worn,
            worn_volume,
            damage,
            bond_loss
        }),
        layout!(stickslip_counters {
            struct_size,
            pairs_tested,
            pairs_clipped,
            pairs_integrated,
            pairs_linearised,
            searches,
            pairs_active,
            bytes,
            seconds_search,
            seconds_integration,
            seconds_assembly,
            pairs_reused,
            nodes_slipping,
            evaluations_apart,
            commits_apart,
            multipliers,
            nodes_evaluated,
            nodes_frictional,
            nodes_frictionless,
            nodes_new,
            nodes_tied,
            nodes_uncovered,
            nodes_left_out,
            boxes_visited,
            nodes_carried
        }),
        layout!(stickslip_report {
            struct_size,
            cover,
            fraction,
            layers,
            facets,
            text,
            text_capacity,
            nodes_none,
            nodes_part,
            nodes_full,
            nodes_several,
            finding,
            reserved,
            penetration
        }),
        layout!(stickslip_diagnosis {
            struct_size,
            state,
            suspect_nodes,
            suspect_directions,
            suspect_ratios,
            suspect_causes,
            suspect_capacity,
            text,
            text_capacity,
            suspects,
            state_changes,
            nodes_gap,
            nodes_stick,
            nodes_slip,
            covered_node,
            covered_fraction,
            overlap,
            overlap_facets,
            warp,
            warp_facets,
            angle,
            angle_facets,
            error,
            error_facets
        }),
        layout!(stickslip_equilibrium {
            struct_size,
            modulus,
            least_traction,
            gap,
            gap_scale,
            traction,
            traction_scale,
            slip,
            slip_scale,
            gap_node,
            traction_node,
            slip_node,
            slide,
            slide_scale,
            slide_node,
            turn,
            turn_node,
            lag,
            lag_node,
            lag_force,
            lag_force_scale,
            penetration,
            penetration_scale,
            penetration_node,
            apart,
            apart_scale,
            apart_node
        }),
        layout!(stickslip_law {
            struct_size,
            kind,
            reserved,
            cohesion,
            mu_after,
            critical_slip,
            mu_across,
            direction,
            critical_rate,
            time
        }),
        layout!(stickslip_law_point { struct_size, node, normal, slip, slip_before, direction, mu }),
        layout!(stickslip_law_answer { struct_size, threshold, dthreshold_dnormal, dthreshold_dslip }),
        layout!(stickslip_layer {
            struct_size,
            n_overclosure,
            overclosure,
            pressure,
            wear,
            bond_stiffness,
            bond_strength,
            bond_toughness,
            bond_shear
        }),
        layout!(stickslip_heat {
            struct_size,
            contact,
            pressure,
            exponent,
            constant,
            gas,
            gas_gap,
            reach,
            share,
            time
        }),
        layout!(stickslip_heat_nodes { struct_size, conductance, flux, jump, friction, area }),
        layout!(stickslip_gradient {
            struct_size,
            previous1,
            previous2,
            now1,
            now2,
            friction,
            shear_limit,
            offsets1,
            offsets2
        }),
        layout!(stickslip_direction {
            struct_size,
            previous1,
            previous2,
            now1,
            now2,
            friction,
            shear_limit,
            offsets1,
            offsets2
        }),
        layout!(stickslip_skin_sides { struct_size, side, piece, partner, distance, body }),
        layout!(stickslip_skin_summary { struct_size, bodies, pieces, pairs, contradictions, made, exchanged, missed }),
        layout!(stickslip_node {
            struct_size,
            slip,
            n_directions,
            lambda,
            normal,
            augmentation,
            mu,
            coverage,
            coverage_previous,
            coverage_min,
            gap_now,
            gap_previous,
            gap_committed,
            directions,
            friction,
            reserved,
            shear_limit
        }),
        layout!(stickslip_node_response {
            struct_size,
            state,
            reserved,
            traction,
            row,
            gap_normal,
            slip,
            sigma,
            dp_dlambda,
            drow_dlambda,
            drow_dnow,
            drow_dprevious
        }),
        layout!(stickslip_pair {
            struct_size,
            n1,
            n2,
            x1,
            x2,
            quadrature,
            layout,
            element_points,
            neighbour_normals,
            multiplier_space,
            model,
            thickness
        }),
        layout!(stickslip_facet {
            struct_size,
            n1,
            quadrature,
            layout,
            reserved,
            n_pairs,
            x1,
            n2,
            x2,
            element_points,
            neighbour_normals
        }),
    ]
}

/// One line a struct, one a member: name, offset, size.
fn rust_text() -> String {
    let mut text = String::new();
    for s in layouts() {
        writeln!(text, "{} {}", s.name, s.size).unwrap();
        for (member, offset, size) in s.members {
            writeln!(text, "{}.{member} {offset} {size}", s.name).unwrap();
        }
    }
    text
}

/// The same from the C compiler.
fn c_text() -> String {
    let mut code = String::from("#include <stddef.h>\n#include <stdio.h>\n#include <stickslip.h>\nint main(void) {\n");
    for s in layouts() {
        writeln!(code, "printf(\"{0} %d\\n\", (int)sizeof({0}));", s.name).unwrap();
        for (member, ..) in s.members {
            writeln!(
                code,
                "printf(\"{0}.{member} %d %d\\n\", (int)offsetof({0}, {member}), (int)sizeof((({0} *)0)->{member}));",
                s.name
            )
            .unwrap();
        }
    }
    code += "return 0;\n}\n";
    let probe = Path::new(env!("CARGO_TARGET_TMPDIR")).join("layout_probe");
    let source = probe.with_extension("c");
    std::fs::write(&source, code).unwrap();
    run(compiler(false).args(["-std=c99", "-I"]).arg(include()).arg("-o").args([&probe, &source]), "the layout probe");
    run(&mut Command::new(probe), "the layout probe")
}

#[test]
fn rust_and_c_agree() {
    let (rust, c) = (rust_text(), c_text());
    for (rust, c) in rust.lines().zip(c.lines()) {
        assert_eq!(rust, c);
    }
    assert_eq!(rust, c);
}

/// Padding would be uninitialised memory in the host's files and in comparisons.
#[test]
fn no_padding() {
    for s in layouts() {
        let mut end = 0;
        for (member, offset, size) in &s.members {
            assert_eq!(*offset, end, "{}: padding before {member}", s.name);
            end += size;
        }
        assert_eq!(s.size, end, "{}: padding at the end", s.name);
    }
}

#[test]
fn every_struct_begins_with_its_size() {
    for s in layouts() {
        assert_eq!(s.members[0], ("struct_size", 0, 8), "{}", s.name);
    }
}
