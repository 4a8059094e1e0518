//! The two sides of the interface that is tried: a small grid on a larger one, or a line on a longer one.

/// Nodes of the non-mortar side, and of the mortar one.
pub const N1: usize = 9;
pub const N2: usize = 16;

/// How many kinds of meshes there are; the last three are of lines.
pub const KINDS: usize = 6;

/// A side: facets as offsets and nodes.
pub struct Facets {
    pub offsets: Vec<i64>,
    pub nodes: Vec<i64>,
}

/// n x n nodes over `size`, at height z.
pub fn grid(n: usize, from: f64, size: f64, z: f64) -> Vec<f64> {
    let at = |k: usize| from + size * k as f64 / (n - 1) as f64;
    (0..n * n).flat_map(|k| [at(k % n), at(k / n), z]).collect()
}

/// n nodes of a line of this size, at height y.
pub fn row(n: usize, from: f64, size: f64, y: f64) -> Vec<f64> {
    (0..n).flat_map(|k| [from + size * k as f64 / (n - 1) as f64, y]).collect()
}

fn quads(n: usize, up: bool) -> Facets {
    let quad = |k: usize| {
        let a = k / (n - 1) * n + k % (n - 1);
        let q = [a, a + 1, a + 1 + n, a + n];
        if up { q } else { [q[0], q[3], q[2], q[1]] }
    };
    let count = (n - 1) * (n - 1);
    let nodes = (0..count).flat_map(quad).map(|k| k as i64).collect();
    Facets { offsets: (0..=count as i64).map(|k| 4 * k).collect(), nodes }
}

/// Lines between neighbouring nodes of n, the body above or below; of 3 nodes, the ends first, where they are quadratic.
fn lines(n: usize, above: bool, quadratic: bool) -> Facets {
    let step = if quadratic { 2 } else { 1 };
    let line = |k: usize| {
        let (a, b) = (step * k, step * (k + 1));
        let (a, b) = if above { (a, b) } else { (b, a) };
        [a, b].into_iter().chain(quadratic.then_some((a + b) / 2))
    };
    let count = (n - 1) / step;
    let nodes = (0..count).flat_map(line).map(|k| k as i64).collect();
    Facets { offsets: (0..=count as i64).map(|k| k * (step as i64 + 1)).collect(), nodes }
}

/// The non-mortar side, which looks down: 3 x 3 nodes as four quadrilaterals, as one with nine nodes, or as two triangles with
/// six; 9 nodes as lines with two nodes, or with three. Which nodes are ends or corners, too.
pub fn nonmortar(kind: usize) -> (Facets, Vec<usize>) {
    let of = |offsets: &[i64], nodes: &[i64]| Facets { offsets: offsets.to_vec(), nodes: nodes.to_vec() };
    match kind {
        0 => (quads(3, false), (0..N1).collect()),
        1 => (of(&[0, 9], &[0, 6, 8, 2, 3, 7, 5, 1, 4]), vec![0, 2, 6, 8]),
        2 => (of(&[0, 6, 12], &[0, 6, 8, 3, 7, 4, 0, 8, 2, 4, 5, 1]), vec![0, 2, 6, 8]),
        3 => (lines(N1, true, true), (0..N1).step_by(2).collect()),
        _ => (lines(N1, true, false), (0..N1).collect()),
    }
}

/// The mortar side, which looks up.
pub fn mortar(kind: usize) -> Facets {
    if kind < 3 { quads(4, true) } else { lines(N2, false, false) }
}
