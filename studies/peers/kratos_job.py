"""One problem in Kratos, by the Python that has it: kratos_job.py FOLDER, where case.npz is; writes answer.npz there.

Small strain, linear elasticity, mortar contact with the augmented Lagrangian multiplier; with friction all of it slips.
"""

import json
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np

import KratosMultiphysics as km
import KratosMultiphysics.ContactStructuralMechanicsApplication
import KratosMultiphysics.LinearSolversApplication
import KratosMultiphysics.StructuralMechanicsApplication as structural
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis

# Pairs are searched at the start of a step: the cylinders' error is 4.4e-2 in one step, 4.3e-2 in three or more.
STEPS, MOST = 4, 50
# Kratos' own: with less than the mortar side's facets take, pairs at the ends of long ones are missing, and nothing is said.
SEARCHED = 3.5
COMPONENTS = (km.DISPLACEMENT_X, km.DISPLACEMENT_Y, km.DISPLACEMENT_Z)


def block(kind, rows):
    return [f"Begin {kind}", *rows, f"End {kind.split()[0]}", ""]


def numbered(start, rows):
    return [f"{start + k} 1 " + " ".join(str(n + 1) for n in row) for k, row in enumerate(rows)]


def part(name, nodes, elements=(), conditions=()):
    inside = []
    for kind, ids in (("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)):
        inside += block(f"SubModelPart{kind}", [str(k + 1) for k in ids])
    return block(f"SubModelPart {name}", inside)


def mesh_file(case, sides, loaded):
    cells, faces = case["cells"], np.concatenate(sides)
    lines = block("Properties 1", [])
    lines += block("Nodes", [f"{k + 1} {x:.17g} {y:.17g} {z:.17g}" for k, (x, y, z) in enumerate(case["points"])])
    lines += block("Elements SmallDisplacementElement3D8N", numbered(1, cells))
    lines += block("Conditions SurfaceCondition3D4N", numbered(1, faces))
    lines += block("Conditions PointLoadCondition3D1N", numbered(1 + len(faces), loaded[:, None]))
    lines += part("Body", np.unique(cells), range(len(cells)))
    lines += part("Contact_Part", np.unique(faces), (), range(len(faces)))
    lines += part("Slave", np.unique(sides[0]), (), range(len(sides[0])))
    lines += part("Load", loaded, (), range(len(faces), len(faces) + len(loaded)))
    return "\n".join(lines)


def reach(case):
    """The radius of the search over a facet of the non-mortar side: the default, or as far as mortar facets reach from their centres."""
    x = lambda side: case["points"][case[side]]
    size = lambda side: np.linalg.norm(np.roll(x(side), 1, axis=1) - x(side), axis=2)
    return max(SEARCHED, 1 + size("mortar").max() / size("nonmortar").min())


class Analysis(StructuralMechanicsAnalysis):
    def __init__(self, model, parameters, case):
        super().__init__(model, parameters)
        self.case, self.iterations = case, 0

    def ApplyBoundaryConditions(self):
        super().ApplyBoundaryConditions()
        part, case = self._GetSolver().GetComputingModelPart(), self.case
        share = min(1.0, self.time)
        for n, component, value in case["fixed"]:
            node = part.GetNode(int(n) + 1)
            node.Fix(COMPONENTS[int(component)])
            node.SetSolutionStepValue(COMPONENTS[int(component)], value * share)
        for condition in part.GetRootModelPart().GetSubModelPart("Load").Conditions:
            force = case["loads"][condition.GetNodes()[0].Id - 1] * share
            condition.SetValue(structural.POINT_LOAD, km.Vector([float(f) for f in force]))

    def FinalizeSolutionStep(self):
        super().FinalizeSolutionStep()
        iterations = self._GetSolver().GetComputingModelPart().ProcessInfo[km.NL_ITERATION_NUMBER]
        if iterations >= MOST:
            raise RuntimeError(f"not converged in {MOST} iterations")
        self.iterations += iterations


def main():
    folder = Path(sys.argv[1])
    case = dict(np.load(folder / "case.npz"))
    loaded = np.flatnonzero(np.any(case["loads"], axis=1))
    (folder / "mesh.mdpa").write_text(mesh_file(case, (case["nonmortar"], case["mortar"]), loaded))
    law = {"constitutive_law": {"name": "LinearElastic3DLaw"}, "Tables": {}, "Variables":
           {"YOUNG_MODULUS": float(case["young"]), "POISSON_RATIO": float(case["poisson"]), "DENSITY": 1.0}}
    (folder / "materials.json").write_text(json.dumps(
        {"properties": [{"model_part_name": "Structure.Body", "properties_id": 1, "Material": law}]}))
    # With friction all slips: with stick among its laws the matrix is singular from the start on.
    kind = "FrictionalPureSlip" if case["friction"] else "Frictionless"
    # Absolute bounds: where rounding is felt.
    forces, gaps = ({f"{prefix}{kind}_{name}_tolerance": value for kind in ("displacement", "residual")
                     for name, value in (("relative", 1e-8), ("absolute", absolute))}
                    for prefix, absolute in (("", 1e-12), ("contact_", 1e-10)))
    solver = {
        "model_part_name": "Structure", "domain_size": 3, "solver_type": "Static", "analysis_type": "non_linear",
        "model_import_settings": {"input_type": "mdpa", "input_filename": str(folder / "mesh")},
        "material_import_settings": {"materials_filename": str(folder / "materials.json")},
        "contact_settings": {"mortar_type": f"ALMContact{kind}", **gaps},
        "time_stepping": {"time_step": 1 / STEPS}, "convergence_criterion": "contact_residual_criterion", **forces,
        "max_iteration": MOST, "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"}}
    # The default search gives the cylinders' error as 3.6e-2 to 1.1e-1, by the number of steps.
    contact = {"python_module": "alm_contact_process", "process_name": "ALMContactProcess",
               "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
               "Parameters": {"model_part_name": "Structure", "contact_type": kind,
                              "friction_coefficients": {"0": float(case["friction"])},
                              "search_parameters": {"type_search": "in_radius", "search_factor": reach(case)},
                              "assume_master_slave": {"0": ["Slave"]}, "contact_model_part": {"0": ["Contact_Part"]}}}
    settings = {"problem_data": {"problem_name": "job", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                                 "end_time": 1.0 - 0.5 / STEPS},
                "solver_settings": solver, "processes": {"contact_process_list": [contact]}}
    analysis = Analysis(km.Model(), km.Parameters(json.dumps(settings)), case)
    analysis.Run()
    part = analysis._GetSolver().GetComputingModelPart().GetRootModelPart()
    found = [list(part.GetNode(k + 1).GetSolutionStepValue(km.DISPLACEMENT)) for k in range(len(case["points"]))]
    np.savez(folder / "answer.npz", displacement=found, iterations=analysis.iterations,
             version=version("KratosMultiphysics"))


if __name__ == "__main__":
    main()
