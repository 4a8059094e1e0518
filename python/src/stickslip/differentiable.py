"""What a run is to programs that differentiate: numbers in, numbers out, and the products of its derivative with weights of what came out.
``stickslip.jax`` and ``stickslip.torch`` make a function of it (docs/gradients.md)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from .errors import InvalidSize
from .skin import Reals


class Run(Protocol):
    """A run whose derivative is known. Parameters and outputs are arrays of numbers, in an order of the run's own."""

    #: Shape of what :meth:`forward` gives, and of all ends of its steps together: the same in every run.
    outputs: tuple[int, ...]
    ends: tuple[int, ...]

    def forward(self, *parameters: Reals) -> tuple[Any, Any]:
        """The outputs, and what :meth:`pull` needs of the run: its ends (:func:`stickslip.gradients.backward`)."""

    def pull(self, parameters: Sequence[Reals], ends: Reals, weights: Reals) -> Sequence[Any]:
        """sum of weights x d outputs / d parameter, for each parameter, in its shape. Other runs may have been since: what the interfaces have of
        the parameters has to be set again."""


def forward(run: Run, parameters: Sequence[Any]) -> tuple[Reals, Reals]:
    """The outputs and the ends of a run, checked."""
    outputs, ends = run.forward(*(np.array(p, dtype=float) for p in parameters))
    outputs, ends = np.asarray(outputs, dtype=float), np.asarray(ends, dtype=float)
    for name, found, said in (("outputs", outputs.shape, run.outputs), ("ends", ends.shape, run.ends)):
        if found != tuple(said):
            raise InvalidSize(f"run.forward gave {name} of shape {found}; run.{name} says {tuple(said)}")
    return outputs, ends


def pull(run: Run, parameters: Sequence[Any], ends: Any, weights: Any) -> list[Reals]:
    """The products of a run's derivative with these weights, checked."""
    values = [np.array(p, dtype=float) for p in parameters]
    products = [np.asarray(d, dtype=float) for d in run.pull(values, np.asarray(ends, dtype=float), np.asarray(weights, dtype=float))]
    if [d.shape for d in products] != [p.shape for p in values]:
        raise InvalidSize(f"run.pull gave shapes {[d.shape for d in products]}; the parameters have {[p.shape for p in values]}")
    return products
