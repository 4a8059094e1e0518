"""stickslip: frictional mortar contact for any finite element code.

The package calls the shared library through its C interface. Arrays are numpy's. What a word means: docs/glossary.md.
"""

from . import errors, gradients
from ._heat import Heat
from ._laws import LawPoint
from ._library import HEADER as header
from ._library import constants, lib, text
from .condensed import Condensed
from .contact import Contact
from .errors import Error, StepRefused, StepWarning
from .general import Skin
from .interface import Interface
from .meshes import crosspoints, split_creases
from .newton import newton
from .options import Options
from .plan import CondensedPlan, Plan, SkinPlan
from .results import Counters, Crosspoints, Diagnosis, Equilibrium, Gradient, Report, SkinFacets, SkinReport, State, States
from .rigid import RigidBody, RigidPlan
from .skin import skin
from .steps import Step, steps
from .surface import Surface

#: The version of the library.
__version__ = text(lib.stickslip_version())
#: Version, commit, target, profile, compiler and kernels of the library.
__build__ = text(lib.stickslip_build())

__all__ = ["Condensed", "CondensedPlan", "Contact", "Counters", "Crosspoints", "Diagnosis", "Equilibrium", "Error", "Gradient", "Heat", "Interface",
           "LawPoint", "Options", "Plan", "Report", "RigidBody", "RigidPlan", "Skin", "SkinFacets", "SkinPlan",
           "SkinReport", "State", "States", "Step", "StepRefused", "StepWarning", "Surface",
           "constants", "crosspoints", "errors", "gradients", "header", "newton", "skin", "split_creases", "steps"]


def __dir__() -> list[str]:
    """What there is for users, without the modules that it is in."""
    return [*__all__, "__build__", "__doc__", "__version__"]
