"""Closed formulas that the friction scenes are compared with. Forces and pressures are positive in compression.

Sources: K. L. Johnson, Contact Mechanics (Hertz 4, Cattaneo and Mindlin 7.2, torsion 7.5); Mindlin and Deresiewicz 1953
(unloading); Lame's cylinders and Euler's belt from any textbook. Half-spaces, small displacements, Coulomb's law.
"""

from dataclasses import dataclass

import numpy as np


def plane_modulus(young, poisson):
    return young / (1 - poisson**2)


def together(first, second):
    """1 / (1 / first + 1 / second): moduli or radii of two bodies."""
    return first * second / (first + second)


@dataclass
class LineContact:
    """Two cylinders, per unit thickness: Hertz, then a pull below mu times the force (Cattaneo, Mindlin)."""

    force: float
    modulus: float  # of both bodies together
    radius: float  # of both bodies together
    mu: float = 0.0
    pull: float = 0.0

    @property
    def half_width(self):
        return np.sqrt(4 * self.force * self.radius / (np.pi * self.modulus))

    @property
    def peak(self):
        return 2 * self.force / (np.pi * self.half_width)

    @property
    def stick(self):
        """Half-width of the zone that sticks."""
        return self.half_width * np.sqrt(1 - abs(self.pull) / (self.mu * self.force))

    def pressure(self, x):
        return self.peak * ellipse(x, self.half_width)

    def shear(self, x):
        a, c = self.half_width, self.stick
        return self.mu * self.peak * (ellipse(x, a) - c / a * ellipse(x, c))


@dataclass
class PointContact:
    """A ball: Hertz, then a pull or a torque below what makes it slide."""

    force: float
    modulus: float  # of both bodies together
    radius: float  # of both bodies together
    mu: float = 0.0

    @property
    def contact_radius(self):
        return np.cbrt(0.75 * self.force * self.radius / self.modulus)

    @property
    def peak(self):
        return 1.5 * self.force / (np.pi * self.contact_radius**2)

    def pressure(self, r):
        return self.peak * ellipse(r, self.contact_radius)

    def stick(self, pull):
        """Radius of the circle that sticks."""
        return self.contact_radius * np.cbrt(1 - abs(pull) / (self.mu * self.force))

    def travel(self, pull, compliance):
        """Tangential displacement under a growing pull. `compliance`: of both bodies when nothing slips, the sum of their
        (2 - nu) / (8 G a)."""
        limit = self.mu * self.force
        return 1.5 * limit * compliance * (1 - np.power(1 - abs(pull) / limit, 2 / 3))

    def travel_back(self, pull, largest, compliance):
        """The same on the way back from the pull `largest`."""
        return self.travel(largest, compliance) - 2 * self.travel((largest - pull) / 2, compliance)

    @property
    def torque(self):
        """When all of the contact slips."""
        return 3 * np.pi / 16 * self.mu * self.force * self.contact_radius

    def turning_stiffness(self, shear_modulus):
        """Torque per angle of one elastic body that sticks."""
        return 16 / 3 * shear_modulus * self.contact_radius**3


@dataclass
class Wave:
    """Westergaard: a surface height (1 - cos 2 pi x / length) pressed onto a flat one; x = 0 touches first."""

    length: float
    height: float
    modulus: float  # of both bodies together

    @property
    def closing(self):
        """The mean pressure that closes the last gap."""
        return np.pi * self.modulus * self.height / self.length

    def gap(self, x):
        return self.height * (1 - np.cos(2 * np.pi * x / self.length))

    def mean_pressure(self, half_width):
        return self.closing * np.sin(np.pi * half_width / self.length) ** 2

    def half_width(self, mean_pressure):
        return self.length / np.pi * np.arcsin(np.sqrt(np.minimum(1, mean_pressure / self.closing)))

    def pressure(self, x, half_width):
        sine, border = np.sin(np.pi * x / self.length), np.sin(np.pi * half_width / self.length)
        return 2 * self.closing * np.cos(np.pi * x / self.length) * np.sqrt(np.maximum(0, border**2 - sine**2))


@dataclass
class SlidingPunch:
    """A flat rigid punch of half-width 1 that slides along -x over a half-plane, friction everywhere (Johnson 2.8): most
    pressure is behind."""

    force: float
    mu: float
    poisson: float

    @property
    def power(self):
        return np.arctan(self.mu * (1 - 2 * self.poisson) / (2 * (1 - self.poisson))) / np.pi

    def pressure(self, x):
        g = self.power
        return self.force * np.cos(np.pi * g) / np.pi * (1 + x) ** (g - 0.5) * (1 - x) ** (-g - 0.5)

    def nodal_force(self, x, quadratic=False):
        """Its integrals with the nodes' functions. Powers are infinite at both ends: with s = (1 + x)^(g + 1/2), or as much from the
        other end, they are smooth."""
        nodes, weights = np.polynomial.legendre.leggauss(60)
        t, step = (nodes + 1) / 2, 2 if quadratic else 1
        found = np.zeros(len(x))
        for first in range(0, len(x) - 1, step):
            left, right = x[first], x[first + step]
            end = 1 if left < 0 else -1  # the nearer one is at -end
            power = self.power * end + 0.5
            low, high = sorted((1 + end * np.array([left, right])) ** power)
            s = low + (high - low) * t
            far = s ** (1 / power)  # from the nearer end
            at = end * (far - 1)
            smooth = (2 - far) ** (-self.power * end - 0.5) / power * weights * (high - low) / 2
            p = self.force * np.cos(np.pi * self.power) / np.pi * smooth
            r = (at - left) / (right - left)
            shapes = [(1 - r) * (1 - 2 * r), 4 * r * (1 - r), r * (2 * r - 1)] if quadratic else [1 - r, r]
            for k, shape in enumerate(shapes):
                found[first + k] += shape @ p
        return found


@dataclass
class RoundedPunch:
    """A rigid punch, flat as far as `flat`, then rounded with `radius`, that touches a half-plane as far as `half_width` (Ciavarella,
    Hills and Monno 1998)."""

    flat: float
    half_width: float
    radius: float
    modulus: float

    @property
    def angle(self):
        return np.arcsin(self.flat / self.half_width)

    @property
    def force(self):
        f = self.angle
        shape = (np.pi - 2 * f) / (2 * np.sin(f) ** 2) - 1 / np.tan(f)
        return self.flat**2 * self.modulus / (2 * self.radius) * shape

    def rise(self, x):
        return np.maximum(0, np.abs(x) - self.flat) ** 2 / (2 * self.radius)

    def pressure(self, x):
        a, f = self.half_width, self.angle
        inside = np.minimum(np.abs(x) / a, 1)
        angle = np.arcsin(inside)
        far, near = np.abs(np.sin(angle + f)), np.maximum(np.abs(np.sin(angle - f)), 1e-300)
        tangents = np.maximum(np.abs(np.tan((angle + f) / 2) * np.tan((angle - f) / 2)), 1e-300)
        shape = (np.pi - 2 * f) * np.cos(angle) + inside * np.log(far / near) + np.sin(f) * np.log(tangents)
        scale = 2 * self.force / (np.pi * a * (np.pi - 2 * f - np.sin(2 * f)))
        return np.where(np.abs(x) < a, scale * shape, 0.0)


def elliptic_potential(zeta, a, slope):
    """(h, h') at zeta = x + i depth in a half-plane: a harmonic function F with F_d = Re h, F_x = Im h, h = 0 at zeta = 0, whose
    F_dd on the surface is `slope` sqrt(a^2 - x^2), and 0 beyond a. On the surface within a only x > 0 is right, and a
    depth of +0, not -0."""
    root = zeta * np.sqrt(1 - (a / zeta) ** 2)
    return slope * (zeta * (zeta - root) / 2 + a * a / 2 * np.log((zeta + root) / (1j * a))), slope * (zeta - root)


def ellipse(x, a):
    return np.sqrt(np.maximum(0.0, 1 - (np.asarray(x) / a) ** 2))


def nodal_mean(function, x):
    """Mean of a function over each node's hat: what a nodal force over a tributary length is to be compared with, for
    the profiles here end with infinite slope."""
    points, weights = np.polynomial.legendre.leggauss(20)
    share, total = (points + 1) / 2, np.zeros(len(x))
    for i, (left, right) in enumerate(zip(x, x[1:])):
        values = function(left + (right - left) * share) * weights * (right - left) / 2
        total[i] += values @ (1 - share)
        total[i + 1] += values @ share
    length = np.append(np.diff(x) / 2, 0) + np.append(0, np.diff(x) / 2)
    return total / length


def nodal_shares(x, quadratic=False, points=200):
    """Points over all facets of a line, and each node's function times the weights there; every other node of quadratic facets
    is in the middle of one. A pressure that ends in a root within a facet takes many points."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    t, step = (nodes + 1) / 2, 2 if quadratic else 1
    shapes = [(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)] if quadratic else [1 - t, t]
    at, share = [], np.zeros((len(x), (len(x) - 1) // step * points))
    for facet, first in enumerate(range(0, len(x) - 1, step)):
        left, right = x[first], x[first + step]
        at.append(left + (right - left) * t)
        for k, shape in enumerate(shapes):
            share[first + k, facet * points : (facet + 1) * points] = shape * weights * (right - left) / 2
    return np.concatenate(at), share


def shrink_fit_free(interference, b, bore, outer, young):
    """Lame: pressure between a shaft with a bore and a hub of its material, plane stress; bore and outside free."""
    hub = (outer**2 + b**2) / (outer**2 - b**2)
    shaft = (b**2 + bore**2) / (b**2 - bore**2)
    return young * interference / (b * (hub + shaft))


def shrink_fit_held(interference, b, bore, outer, young):
    """The same, Poisson's ratio zero, with bore and outside held: u = A r + B / r vanishes there."""
    hub = (outer**2 - b**2) / (outer**2 + b**2)
    shaft = (b**2 - bore**2) / (b**2 + bore**2)
    return young * interference / (b * (hub + shaft))


def belt_tension(angle, mu, tension=1.0):
    """Euler: tension of a belt that slips, at this angle from its held end."""
    return tension * np.exp(mu * angle)
