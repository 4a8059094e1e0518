//! What a distance from equilibrium is measured by, and the node where it is largest.

/// What the host knows of its problem.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scales {
    /// Young's modulus of the softer body [F/L^2]; 0: not known.
    pub modulus: f64,
    /// A traction that counts where those of now are smaller, as the largest of earlier steps [F/L^2]; 0: none.
    pub traction: f64,
}

/// The worst node: the violation that is largest over its scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Largest {
    /// The violation, what rounding makes of it taken off.
    pub value: f64,
    /// What it should be compared with.
    pub scale: f64,
    /// The node; none where all is zero. The scale is then the least of all nodes.
    pub node: Option<usize>,
}

impl Largest {
    #[inline(never)] // once, not at each of its calls
    pub(super) fn offer(&mut self, value: f64, scale: f64, node: usize) {
        // value / scale > self.value / self.scale, where a scale may be zero, too
        if value * self.scale > self.value * scale || (value > 0.0 && self.node.is_none()) {
            *self = Largest { value, scale, node: Some(node) };
        }
    }

    /// Takes that of another part where it is worse; `node`: the number that its nodes have here.
    pub fn take_worse(&mut self, other: &Largest, node: &dyn Fn(usize) -> usize) {
        match other.node {
            Some(of_other) => self.offer(other.value, other.scale, node(of_other)),
            None if self.node.is_none() => {
                self.scale = if self.scale > 0.0 { self.scale.min(other.scale) } else { other.scale }
            }
            None => (),
        }
    }
}
