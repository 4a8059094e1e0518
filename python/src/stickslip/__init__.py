"""stickslip: frictional mortar contact for any finite element code.

The package calls the shared library through its C interface. Arrays are numpy's. What a word means: docs/glossary.md.
"""

from . import errors, gradients
from ._heat import Heat
from ._laws import LawPoint
from ._library import HEADER as header
from ._library import constants, lib, text
from .condensed import Condensed
from .errors import Error, StepRefused, StepWarning
from .interface import Interface
from .meshes import crosspoints, split_creases
from .plan import CondensedPlan, Plan
from .rigid import RigidBody, RigidPlan
from .surface import Surface

#: The version of the library.
__version__ = text(lib.stickslip_version())
#: Version, commit, target, profile, compiler and kernels of the library.
__build__ = text(lib.stickslip_build())

__all__ = ["Condensed", "CondensedPlan", "Error", "Heat", "Interface", "LawPoint", "Plan", "RigidBody", "RigidPlan", "StepRefused", "StepWarning",
            "Surface", "constants", "crosspoints", "errors", "gradients", "header", "split_creases"]
