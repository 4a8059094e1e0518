"""Two elastic blocks in contact with friction, small strain: bodies by SfePy. Arguments: two_blocks.py."""

import numpy as np
import two_blocks
from sfepy.base.base import output
from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
from sfepy.discrete.fem import FEDomain, Field
from sfepy.mechanics.matcoefs import stiffness_from_youngpoisson
from sfepy.mesh.mesh_generators import gen_block_mesh
from sfepy.terms import Term

output.set_output(quiet=True)


def block(lower, upper, cells, young, poisson):
    """A box of hexahedra: nodes, cells, forces and stiffness numbered node by node."""
    low, high = np.array(lower), np.array(upper)
    mesh = gen_block_mesh(high - low, np.array(cells) + 1, (low + high) / 2, verbose=False)
    region = FEDomain("block", mesh).create_region("Omega", "all")
    field = Field.from_args("displacement", np.float64, "vector", region, approx_order=1)
    u, v = FieldVariable("u", "unknown", field), FieldVariable("v", "test", field, primary_var_name="u")
    material = Material("m", D=stiffness_from_youngpoisson(3, young, poisson))
    term = Term.new("dw_lin_elastic(m.D, v, u)", Integral("i", order=2), region, m=material, v=v, u=u)
    problem = Problem("block", equations=Equations([Equation("balance", term)]))
    problem.time_update()
    problem.update_materials()
    stiffness = problem.equations.evaluate(mode="weak", dw_mode="matrix", asm_obj=problem.mtx_a)
    return mesh.coors.copy(), mesh.get_conn("3_8"), lambda u: ((stiffness @ u.ravel()).reshape(u.shape), stiffness)


two_blocks.main("SfePy", block)
