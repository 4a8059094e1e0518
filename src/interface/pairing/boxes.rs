//! Axis-aligned boxes, one by one and four at a time.

use crate::geometry::Vec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    pub low: Vec3,
    pub high: Vec3,
}

impl Aabb {
    /// The box around some points.
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Aabb {
        let empty = Aabb { low: Vec3::repeat(f64::INFINITY), high: Vec3::repeat(f64::NEG_INFINITY) };
        points.into_iter().fold(empty, |b, p| Aabb { low: b.low.inf(&p), high: b.high.sup(&p) })
    }

    /// The box around both.
    pub fn union(&self, other: &Aabb) -> Aabb {
        Aabb { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// Whether all of the other box is in this one.
    pub fn contains(&self, other: &Aabb) -> bool {
        self.union(other) == *self
    }

    /// Its middle.
    pub fn centre(&self) -> Vec3 {
        (self.low + self.high) * 0.5
    }

    /// The largest distance along any axis that lies between the boxes; 0 where they overlap along all.
    pub fn distance(&self, other: &Aabb) -> f64 {
        (self.low - other.high).sup(&(other.low - self.high)).max().max(0.0)
    }

    /// Along which axes more than `distance` lies between the boxes: this one above the other, then below it.
    pub fn sides(&self, other: &Aabb, distance: f64) -> [bool; 6] {
        let (above, below) = (self.low - other.high, other.low - self.high);
        [above.x, above.y, above.z, below.x, below.y, below.z].map(|between| between > distance)
    }

    /// The least and the largest height of any point of the box along `direction`, over `origin`.
    pub fn along(&self, direction: Vec3, origin: Vec3) -> (f64, f64) {
        let (centre, half) = (self.centre() - origin, (self.high - self.low) * 0.5);
        let (c, r) = (direction.dot(&centre), direction.abs().dot(&half));
        (c - r, c + r)
    }

    /// The largest coordinate of any point of the box along each axis, without its sign.
    pub fn farthest(&self) -> Vec3 {
        self.low.abs().sup(&self.high.abs())
    }

    /// Half the surface `[L^2]`: the mean of what the box covers, seen from all sides, is in proportion to it.
    pub fn half_surface(&self) -> f64 {
        let size = self.high - self.low;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// Four boxes, component by component.
#[derive(Debug)]
pub struct Four {
    pub low: [[f64; 4]; 3],
    pub high: [[f64; 4]; 3],
}

impl Four {
    /// Four of them.
    pub fn of(b: [&Aabb; 4]) -> Four {
        Four { low: [0, 1, 2].map(|i| b.map(|b| b.low[i])), high: [0, 1, 2].map(|i| b.map(|b| b.high[i])) }
    }
}
