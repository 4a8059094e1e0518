//! Each effect against the full machinery: what it leaves out changes no answer and leaves no trace, and is left out
//! indeed.

mod apart;
mod counters;
mod frictionless;
mod history;
mod rigid;
mod rough;
mod shortcuts;
mod tied;
mod tresca;
mod uncovered;

use crate::support::mesh::*;
use nalgebra::{Rotation3, SVector};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Extent, Form, Options, Residual, Shortcuts, Weights};

/// Every shortcut off: the full machinery.
const NO_SHORTCUTS: Shortcuts = Shortcuts { frictionless: false, rigid: false, apart: false, uncovered: false };

const FORMS: [Form; 2] = [Form::Multiplier, Form::Augmented];
const WEIGHTS: [Weights; 3] = [Weights::Current, Weights::Committed, Weights::Reference];
const CELLS: [[Cells; 2]; 3] =
    [[Cells::Quads, Cells::Quads], [Cells::Triangles, Cells::Quads], [Cells::Triangles, Cells::Triangles]];
const ROUGH: Roughness = Roughness { warp: 0.05, jitter: 0.08, slide: 0.02 };

/// Both forms with all weights.
fn variants(of: Options) -> impl Iterator<Item = Options> {
    FORMS.into_iter().flat_map(move |form| WEIGHTS.map(|weights| Options { form, weights, ..of }))
}

/// A scene of `moved` once more, with other options and perhaps another number of multipliers.
fn again<const N: usize>(scene: &Moved, prescribed: bool, options: Options) -> Contact<N>
where
    Contact<N>: Create<N>,
{
    let (one, two) = scene.interface.surfaces();
    contact(&mesh_of(one), &mesh_of(two), prescribed, options)
}

/// The direction in which `moved` slides.
fn along() -> Vec3 {
    Rotation3::from_euler_angles(0.4, -0.9, 1.3) * Vec3::new(0.8, 0.6, 0.0)
}

fn shifted(x: &[Vec3], by: Vec3) -> Vec<Vec3> {
    x.iter().map(|x| x + by).collect()
}

/// A tangent's entries, to the bit.
fn entries<const N: usize>(
    c: &mut Contact<N>,
    (x1, x2, lambda): (&[Vec3], &[Vec3], &[SVector<f64, N>]),
) -> Vec<(i64, i64, u64)> {
    let mut entries = Vec::new();
    c.tangent(x1, x2, lambda, None, &mut |i: i64, j: i64, v: f64| entries.push((i, j, v.to_bits()))).unwrap();
    entries
}

/// All numbers of a residual, as bits.
fn bits<const N: usize>(r: &Residual<N>) -> Vec<u64> {
    let forces = r.nonmortar.iter().chain(&r.mortar).flat_map(|v| v.iter());
    forces.chain(r.rows.iter().flat_map(|v| v.iter())).map(|v| v.to_bits()).collect()
}

/// The largest difference over the largest number.
fn difference<const N: usize>(a: &[SVector<f64, N>], b: &[SVector<f64, N>]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = |v: &mut dyn Iterator<Item = f64>| v.fold(0.0, f64::max);
    let scale = largest(&mut a.iter().chain(b).map(|v| v.amax()));
    let error = largest(&mut a.iter().zip(b).map(|(a, b)| (a - b).amax()));
    if scale > 0.0 { error / scale } else { error }
}
