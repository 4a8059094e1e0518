"""Displacements of half-planes and half-spaces under Hertz' pressure and under shear. The last coordinate is the height, 0 on
the surface and negative inside; displacements are 0 in the middle of the surface.

A piece of a body whose other sides follow them is the whole body, so that closed formulas are its exact answer."""

import numpy as np

import formulas

# Radii and angles of the integral over the loaded circle, seen from two of its radii or more.
CIRCLE = 16, 32


def pressed_line(x, half_width, peak, young, poisson):
    """(n, 2) under a pressure peak sqrt(1 - x^2 / a^2). With the depth d and a harmonic function F, of which F_dd is the
    pressure on the surface: 2 G u_x = (1 - 2 nu) F_x + d F_xd,  2 G u_d = -2 (1 - nu) F_d + d F_dd."""
    depth = 0.0 - x[:, 1]
    h, slope = formulas.elliptic_potential(x[:, 0] + 1j * depth, half_width, peak / half_width)
    along = (1 - 2 * poisson) * h.imag + depth * slope.real
    return np.stack([along, 2 * (1 - poisson) * h.real + depth * slope.imag], axis=1) * (1 + poisson) / young


def sheared_line(x, half_width, peak, young, poisson):
    """(n, 2) under a traction peak sqrt(1 - x^2 / a^2) along x. With a harmonic function H, of which H_dd is the traction on
    the surface: 2 G u_x = -2 (1 - nu) H_d - d H_dd,  2 G u_d = -(1 - 2 nu) H_x + d H_xd."""
    depth = 0.0 - x[:, 1]
    h, slope = formulas.elliptic_potential(x[:, 0] + 1j * depth, half_width, peak / half_width)
    along = -2 * (1 - poisson) * h.real + depth * slope.imag
    return np.stack([along, (1 - 2 * poisson) * h.imag - depth * slope.real], axis=1) * (1 + poisson) / young


def pressed_circle(x, radius, peak, young, poisson):
    """(n, 3) of a half-space under a pressure peak sqrt(1 - r^2 / a^2): Boussinesq's point load, integrated."""
    t, weight = np.polynomial.legendre.leggauss(CIRCLE[0])
    t, weight = (t + 1) / 2, weight / 2  # r^2 = a^2 (1 - t^2): the pressure is peak t, r dr = -a^2 t dt
    angle = 2 * np.pi * (np.arange(CIRCLE[1]) + 0.5) / CIRCLE[1]
    u = np.zeros_like(x)
    for s, w in zip(t, weight):
        load = peak * radius**2 * s * s * w * 2 * np.pi / CIRCLE[1]
        for a in angle:
            east, north = (x[:, i] - radius * np.sqrt(1 - s * s) * f for i, f in ((0, np.cos(a)), (1, np.sin(a))))
            depth, r = 0.0 - x[:, 2], np.sqrt(east**2 + north**2 + x[:, 2] ** 2)
            out = depth / r**3 - (1 - 2 * poisson) / (r * (r + depth))
            u += load * np.stack([east * out, north * out, -(depth**2 / r**3 + 2 * (1 - poisson) / r)], axis=1)
    u *= (1 + poisson) / (2 * np.pi * young)
    u[:, 2] += np.pi * peak * radius * (1 - poisson**2) / (2 * young)
    return u


def under_forces(x, places, forces, young, poisson):
    """(n, 2) of a half-plane under forces (m, 2) at `places` of its surface, per unit thickness, up to a translation: Flamant. A
    traction's Gauss points, seen from beyond its ends, are the traction."""
    kappa, u = 3 - 4 * poisson, np.zeros(len(x), complex)
    for place, force in zip(places, forces):
        z, a = x[:, 0] - place + 1j * x[:, 1], -(force[0] + 1j * force[1]) / (2 * np.pi)
        log = np.log(np.abs(z)) + 1j * np.arctan2(z.real, -z.imag)  # the angle from straight below
        u += a * (kappa * log + log.conj()) - np.conj(a) * z / z.conj()
    u *= (1 + poisson) / young
    return np.stack([u.real, u.imag], axis=1)
