"""Small surfaces for the tests: a square over a larger one in space, a line over a longer one in the plane."""

import numpy as np

import stickslip


def grid(n, lower, upper, height, up):
    """Nodes and quadrilaterals of a square at z = height, that looks up or down."""
    line = np.linspace(lower, upper, n + 1)
    nodes = np.array([(x, y, height) for y in line for x in line])
    facets = [[k, k + 1, k + n + 2, k + n + 1] for j in range(n) for k in range(j * (n + 1), j * (n + 1) + n)]
    return nodes, np.array(facets if up else [facet[::-1] for facet in facets])


class Scene:
    """An interface with equations for all unknowns: u1, u2, lambda in this order."""

    def __init__(self, first, second, **options):
        (x1, f1), (x2, f2) = first, second
        sizes = np.cumsum([0, x1.size, x2.size, x1.size])
        self.slices = [slice(a, b) for a, b in zip(sizes, sizes[1:])]
        numbers = [np.arange(s.start, s.stop, dtype=np.int64) for s in self.slices]
        self.size = int(sizes[-1])
        self.arguments = (
            stickslip.Surface(x1, f1, numbers[0].reshape(x1.shape), numbers[2].reshape(x1.shape)),
            stickslip.Surface(x2, f2, numbers[1].reshape(x2.shape)),
        )
        self.options = {"mu": 0.3, "modulus": 1000.0, **options}
        self.interface = stickslip.Interface(*self.arguments, **self.options)
        self.x1, self.x2 = x1, x2
        self.nu = np.eye(x1.shape[1])[-1]

    def pressed(self, depth=1e-3, seed=1):
        """A point in contact that is not at an edge of any law."""
        random = np.random.default_rng(seed)
        x1 = self.x1 + 1e-4 * random.standard_normal(self.x1.shape) - depth * self.nu
        x2 = self.x2 + 1e-4 * random.standard_normal(self.x2.shape)
        lam = -5.0 * self.nu + 0.1 * random.standard_normal(self.x1.shape)
        return x1, x2, lam

    def unpack(self, u):
        parts = [u[s] for s in self.slices]
        return parts[0].reshape(self.x1.shape), parts[1].reshape(self.x2.shape), parts[2].reshape(self.x1.shape)

    def residual(self, u):
        return np.concatenate([part.ravel() for part in self.interface.residual(*self.unpack(u))])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.interface.close()


class Solid(Scene):
    def __init__(self, **options):
        super().__init__(grid(2, 0.13, 1.0, 0.0, False), grid(3, 0.0, 1.2, 0.0, True), **options)


class Plane(Scene):
    def __init__(self, **options):
        # The body is to the left of the way: above the non-mortar line, below the mortar line.
        x1 = np.column_stack([np.linspace(0.13, 1.0, 5), np.zeros(5)])
        x2 = np.column_stack([np.linspace(0.0, 1.2, 4), np.zeros(4)])
        forth = np.array([(k, k + 1) for k in range(4)])
        back = np.array([(k + 1, k) for k in range(3)])
        super().__init__((x1, forth), (x2, back), model="plane", **options)
