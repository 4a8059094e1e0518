"""A run through contact and friction as a function of JAX: ``jax.grad``, ``jax.jit`` and optimisers of that world take it as any other."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp

from . import differentiable as _of
from .errors import InvalidValue


def function(run: _of.Run) -> Callable[..., Any]:
    """``function(run)(*parameters)`` are the outputs of the run (:class:`stickslip.differentiable.Run`), with its exact derivative.

    Derivatives are backwards and first ones: ``jax.grad``, ``jax.vjp``, ``jax.jacrev``. The run itself is no JAX: it is called on the processor.
    Raises :class:`stickslip.errors.InvalidValue` where JAX has single precision (``jax.config.update("jax_enable_x64", True)`` at the start of a program), in which no
    step converges.
    """
    outputs, ends = (jax.ShapeDtypeStruct(shape, jnp.float64) for shape in (run.outputs, run.ends))

    def begin(*parameters: Any) -> Any:
        if not jax.config.jax_enable_x64:
            raise InvalidValue('JAX computes in single precision; call jax.config.update("jax_enable_x64", True) at the start of the program')
        doubles = [jnp.asarray(p, dtype=jnp.float64) for p in parameters]
        return jax.pure_callback(lambda *p: _of.forward(run, p), (outputs, ends), *doubles, vmap_method="sequential")

    def first(*parameters: Any) -> Any:
        found, kept = begin(*parameters)
        return found, (parameters, kept)

    def back(kept: Any, weights: Any) -> Any:
        doubles = [jnp.asarray(p, dtype=jnp.float64) for p in kept[0]]
        shapes = [jax.ShapeDtypeStruct(p.shape, jnp.float64) for p in doubles]
        return tuple(jax.pure_callback(lambda e, w, *p: _of.pull(run, p, e, w), shapes, kept[1], weights, *doubles, vmap_method="sequential"))

    made: Any = jax.custom_vjp(lambda *parameters: begin(*parameters)[0])
    made.defvjp(first, back)
    called: Callable[..., Any] = made
    return called
