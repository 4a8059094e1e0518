"""A run through contact and friction as a function of PyTorch: ``backward()`` and optimisers of that world take it as any other."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import torch

from . import differentiable as _of


def function(run: _of.Run) -> Callable[..., Any]:
    """``function(run)(*parameters)`` are the outputs of the run (:class:`stickslip.differentiable.Run`) in double precision, with its exact
    first derivative. The run itself is no PyTorch: it is called on the processor."""

    class Made(torch.autograd.Function):
        @staticmethod
        def forward(context: Any, *parameters: Any) -> Any:
            outputs, ends = _of.forward(run, [p.detach().cpu().numpy() for p in parameters])
            context.save_for_backward(torch.from_numpy(ends.copy()), *parameters)
            return torch.from_numpy(outputs.copy())

        @staticmethod
        @torch.autograd.function.once_differentiable
        def backward(context: Any, weights: Any) -> Any:
            ends, *parameters = context.saved_tensors
            values = [p.detach().cpu().numpy() for p in parameters]
            products = _of.pull(run, values, ends.numpy(), weights.detach().cpu().numpy())
            return tuple(torch.from_numpy(d.copy()).to(p) for d, p in zip(products, parameters))

    return lambda *parameters: Made.apply(*(torch.as_tensor(p) for p in parameters))
