"""The patch test of the plane: a pressure goes through an interface of meshes that do not match, and its multipliers are uniform."""

import numpy as np

from plane_host import Host


def widening(body):
    """Strain along the interface over pressure / E."""
    return {"strain": body.poisson * (1 + body.poisson), "stress": body.poisson, "ring": body.poisson}[body.model]


def pressed(library, upper, lower, pressure, **options):
    """The largest error of a multiplier over the pressure, the number of iterations, and the host. Both bodies widen alike."""
    host = Host(library, (upper, lower), ("bottom", "top"), **options)
    host.lam[host.contact.has_row, 1] = -pressure
    left, base = lower.x.min(axis=0)
    top = upper.x[:, 1].max()
    fixed = host.on(1, 1, 0.0, lambda x: x[1] == base)
    if upper.model != "ring":  # no rigid motion along x
        fixed |= host.on(1, 0, 0.0, lambda x: x[0] == left and x[1] == base)
        fixed |= host.on(0, 0, 0.0, lambda x: x[0] == left and x[1] == top)
    loads = np.concatenate([upper.pressed("top", pressure).ravel(), np.zeros(lower.x.size)])
    iterations = host.step(fixed, loads)
    # The interface has become wider: forces are those of the pressure on it as it was.
    wider = 1 + widening(upper) * pressure / upper.young
    expected = -pressure / wider ** (2 if upper.model == "ring" else 1)
    error = np.abs(host.lam[host.contact.has_row] - [0, expected]).max() / pressure
    return error, iterations, host
