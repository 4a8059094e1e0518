//! Shares of the mortar side, whose sums a host adds up: they are one handle, or refused by name.

use crate::support::mesh::*;
use stickslip::error::{Kind, Result};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Interface, NodeSums, Options, Scheme, Surface, Weights};
use stickslip::quadrature::cell;

/// Sums in another order, relative to the largest.
const SAME: f64 = 1e-12;

/// Facets of both sides, and how the mortar side bends once it is there.
struct Scene {
    one: Mesh,
    two: Mesh,
    bent: Vec<Vec3>,
}

fn quads(boxes: &[[f64; 4]], up: bool) -> Mesh {
    let corners = |[x0, y0, x1, y1]: [f64; 4]| {
        let c = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| Vec3::new(x, y, 0.0));
        if up { c } else { [c[0], c[3], c[2], c[1]] }
    };
    let x = boxes.iter().copied().flat_map(corners).collect();
    Mesh { x, facets: (0..boxes.len() as i64).map(|f| (4 * f..4 * f + 4).collect()).collect() }
}

/// Facets of the mortar side with no node in common; they bend where they meet at 0.45.
fn scene(nonmortar: &[[f64; 4]], mortar: &[[f64; 4]]) -> Scene {
    let (one, two) = (quads(nonmortar, false), quads(mortar, true));
    let bend = |x: &Vec3| x + Vec3::z() * (0.02 - 0.05 * (x.x - 0.45).abs().min(0.4));
    Scene { bent: two.x.iter().map(bend).collect(), one, two }
}

impl Scene {
    fn handle(&self, facets: &[usize], options: Options) -> (Interface, Vec<Vec3>) {
        let (n, all) = (self.one.x.len(), facets.iter().flat_map(|f| 4 * f..4 * f + 4).collect::<Vec<_>>());
        let nonmortar = Surface::new("nonmortar", self.one.x.clone(), &self.one.facets, numbered(0, n)).unwrap();
        let x = all.iter().map(|&k| self.two.x[k]).collect();
        let of: Vec<Vec<i64>> = (0..facets.len() as i64).map(|f| (4 * f..4 * f + 4).collect()).collect();
        let mortar = Surface::new("mortar", x, &of, numbered(6 * n, all.len())).unwrap();
        let mut made = Contact::<3>::new(nonmortar, mortar, numbered(3 * n, n), options).unwrap();
        let bent: Vec<_> = all.iter().map(|&k| self.bent[k]).collect();
        made.set_previous(&self.one.x, &bent).unwrap();
        (made, bent)
    }

    /// The largest difference of rows and of forces of one handle from those of two shares, over the largest.
    fn difference(&self, shares: [&[usize]; 2], options: Options) -> Result<f64> {
        let lambda = vec![Vec3::new(0.0, 0.0, -5.0); self.one.x.len()];
        let x1: Vec<_> = self.one.x.iter().map(|x| x - Vec3::z() * 1e-2).collect();
        let all: Vec<_> = (0..self.two.facets.len()).collect();
        let (mut whole, bent) = self.handle(&all, options);
        let expected = whole.residual(&x1, &bent, &lambda, None).unwrap();
        let mut parts = shares.map(|share| self.handle(share, options));
        let mut sums = vec![NodeSums::default(); x1.len()];
        for (part, x2) in &mut parts {
            for (sum, share) in sums.iter_mut().zip(part.share_of_sums(&x1, x2)?) {
                sum.coverage += share.coverage;
                sum.gap_now += share.gap_now;
                sum.coverage_previous += share.coverage_previous;
                sum.gap_previous += share.gap_previous;
                sum.gap_committed += share.gap_committed;
            }
        }
        let mut off = expected.rows.clone();
        let mut forces = expected.nonmortar.clone();
        for (k, (part, x2)) in parts.iter_mut().enumerate() {
            let r = part.residual(&x1, x2, &lambda, Some(&sums))?;
            // Either has all rows.
            if k == 0 {
                off.iter_mut().zip(&r.rows).for_each(|(off, row)| *off -= row);
            }
            forces.iter_mut().zip(&r.nonmortar).for_each(|(off, force)| *off -= force);
        }
        let over = |off: &[Vec3], all: &[Vec3]| {
            let largest = |v: &[Vec3]| v.iter().map(|v| v.amax()).fold(0.0, f64::max);
            largest(off) / largest(all)
        };
        Ok(over(&off, &expected.rows).max(over(&forces, &expected.nonmortar)))
    }
}

fn schemes() -> [Scheme; 3] {
    let line = cell::line_of(4).unwrap();
    [Scheme::Segments, Scheme::Elements(line), Scheme::Hybrid(line)]
}

#[test]
fn shares_are_one_handle_or_refused() {
    // One facet, each half over another share; a facet over one share alone, one of which a share covers a part and nobody the rest.
    let split = scene(&[[0.0, 0.0, 1.0, 1.0]], &[[-0.2, -0.2, 0.45, 1.2], [0.45, -0.2, 1.2, 1.2]]);
    let apart = scene(&[[0.0, 0.0, 1.0, 1.0], [3.0, 0.0, 4.0, 1.0]], &[[-0.2, -0.2, 1.2, 1.2], [2.8, -0.2, 3.6, 1.2]]);
    for (weights, scheme) in [Weights::Current, Weights::Committed].into_iter().flat_map(|w| schemes().map(|s| (w, s)))
    {
        let options = Options { scheme, weights, ..options() };
        let what = format!("{weights:?} {scheme:?}");
        let off = apart.difference([&[0], &[1]], options).unwrap();
        assert!(off <= SAME, "{what}: {off:e}");
        match split.difference([&[0], &[1]], options) {
            Ok(off) => assert!(off <= SAME && !matches!(scheme, Scheme::Hybrid(_)), "{what}: {off:e}"),
            Err(error) => {
                assert!(matches!(scheme, Scheme::Hybrid(_)), "{what}: {error}");
                assert_eq!(error.kind, Kind::Unsupported, "{error}");
                assert!(error.to_string().contains("facet 0"), "{error}");
            }
        }
    }
}
