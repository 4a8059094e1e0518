//! Surfaces that no body has are refused, naming the facets: reversed, branching, folded.

use crate::support::mesh::*;
use stickslip::error::{Error, Kind};
use stickslip::geometry::Vec3;
use stickslip::interface::Surface;

fn refusal(side: &'static str, mesh: &Mesh) -> Error {
    Surface::new(side, mesh.x.clone(), &mesh.facets, numbered(0, mesh.x.len())).unwrap_err()
}

#[test]
fn a_reversed_facet_is_named_with_its_neighbour() {
    for cells in [Cells::Quads, Cells::Triangles] {
        let good = grid(3, 2, [0.0, 0.0], [1.0, 1.0], 0.0, true, cells);
        for f in 0..good.facets.len() {
            let mut mesh = good.clone();
            mesh.facets[f].reverse();
            let error = refusal("mortar", &mesh);
            assert_eq!(error.kind, Kind::InvalidValue);
            let named = error.message.starts_with("mortar: facets ") && error.message.contains(&format!(" {f} "));
            assert!(named && error.message.contains("same direction"), "{}", error.message);
        }
        let mut all = good.clone();
        all.facets.iter_mut().for_each(|f| f.reverse());
        assert!(Surface::new("mortar", all.x.clone(), &all.facets, numbered(0, all.x.len())).is_ok());
    }
}

#[test]
fn a_branching_surface_is_refused() {
    let mut mesh = grid(2, 1, [0.0, 0.0], [2.0, 1.0], 0.0, true, Cells::Quads);
    let first = mesh.x.len() as i64;
    mesh.x.extend([Vec3::new(1.0, 0.0, 1.0), Vec3::new(1.0, 1.0, 1.0)]);
    mesh.facets.push(vec![1, 4, first + 1, first]);
    let error = refusal("nonmortar", &mesh);
    assert!(error.message.contains("facets") && error.message.contains("branches"), "{}", error.message);
}

/// From an angle on that no blade has; a thin blade is a surface.
#[test]
fn a_folded_surface_is_refused_a_thin_blade_is_not() {
    for (degrees, refused) in [(0.0, true), (0.05, true), (0.1, false), (3.0, false)] {
        let mut mesh = grid(2, 1, [0.0, 0.0], [2.0, 1.0], 0.0, true, Cells::Quads);
        let angle = f64::to_radians(degrees);
        for x in mesh.x.iter_mut().filter(|x| x.x > 1.5) {
            *x = Vec3::new(1.0 - angle.cos(), x.y, angle.sin());
        }
        let result = Surface::new("mortar", mesh.x.clone(), &mesh.facets, numbered(0, mesh.x.len()));
        assert_eq!(result.is_err(), refused, "{degrees} degrees");
        if let Err(error) = result {
            assert_eq!(error.kind, Kind::InvalidValue);
            let text =
                "mortar: facets 0 and 1 lie on each other: the surface is folded along the edge of nodes 1 and 4";
            assert_eq!(error.message, text);
        }
    }
}

/// A facet that is itself folded makes its neighbours lie on it; it is the one to be named.
#[test]
fn a_facet_that_is_folded_itself_is_named_alone() {
    let mut mesh = grid(2, 2, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    mesh.x[4] = Vec3::new(-0.3, -0.3, 0.0);
    let one = Surface::new("nonmortar", mesh.x.clone(), &mesh.facets, numbered(0, 9)).unwrap();
    let table = grid(1, 1, [-1.0, -1.0], [2.0, 2.0], -0.1, true, Cells::Quads);
    let two = Surface::new("mortar", table.x.clone(), &table.facets, numbered(27, 4)).unwrap();
    let error = stickslip::interface::Interface::new(one, two, numbered(39, 9), options()).unwrap_err();
    assert!(error.kind == Kind::DegenerateFacet && error.message.starts_with("nonmortar facet 0"), "{error}");
}
