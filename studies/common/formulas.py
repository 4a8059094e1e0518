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
