"""Acceptance checks on the example scenes: check.py --build DIR GROUP...

Prints one line per check with the measured figure and its bound, on a terminal each also at once (--progress: always),
writes them to DIR/acceptance/GROUP.json, and exits with 1 if anything failed. A scene that does not run, or does not write
what it should, is a failure too.
"""

import argparse
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "studies" / "common"))
import acceptance  # noqa: E402
from condensed import condensed, condensed_full  # noqa: E402
from conserving import conserving  # noqa: E402
from conserving_free import conserving_free  # noqa: E402
from conserving_turning import conserving_turning  # noqa: E402
from dual import dual, dual_full, dual_iterations  # noqa: E402
from dynamics import dynamics  # noqa: E402
from dynamics_finite import finite  # noqa: E402
from dynamics_mass import mass  # noqa: E402
from effect_checks import effects  # noqa: E402
from exact import exact, exact_friction, exact_gears, exact_rolling  # noqa: E402
from fluid import fluid  # noqa: E402
from friction_checks import friction  # noqa: E402
from general import general  # noqa: E402
from general_cells import general_cells  # noqa: E402
from general_dynamics import general_dynamics  # noqa: E402
from general_scenes import general_scenes  # noqa: E402
from hosts import hosts  # noqa: E402
from iterative import iterative, iterative_scenes  # noqa: E402
from ironing import ironing, ironing_full  # noqa: E402
from material_checks import materials  # noqa: E402
from laid import laid  # noqa: E402
from laws import laws  # noqa: E402
from loads import loads  # noqa: E402
from multigrid import multigrid  # noqa: E402
from normals import normals  # noqa: E402
from normals_full import normals_full, normals_iterations  # noqa: E402
from heat import heat  # noqa: E402
from heat_moving import heat_moving  # noqa: E402
from offsets import offsets  # noqa: E402
from parameters import parameters, parameters_scenes  # noqa: E402
from plane import plane, plane_ball  # noqa: E402
from plane_analytic import plane_analytic  # noqa: E402
from points import points, points_full  # noqa: E402
from quadratic import quadratic  # noqa: E402
from quadratic_contact import quadratic_contact  # noqa: E402
from quadratic_line import quadratic_line  # noqa: E402
from quadratic_sliding import quadratic_sliding  # noqa: E402
from quadratic_tied import quadratic_tied  # noqa: E402
from ranks import ranks, ranks_scenes  # noqa: E402
from ranks_files import ranks_files  # noqa: E402
from ranks_full import ranks_full  # noqa: E402
from ranks_moving import ranks_many, ranks_moving  # noqa: E402
from restart import restart, restart_steps  # noqa: E402
from rigid import rigid  # noqa: E402
from roles import roles  # noqa: E402
from slider import slider, slider_fine  # noqa: E402
from sliding import sliding  # noqa: E402
from scene import Driver, SceneError  # noqa: E402
from sound import sound  # noqa: E402
from split import split, split_fine  # noqa: E402
from springs import springs  # noqa: E402
from stepping import stepping  # noqa: E402
from thrown import thrown  # noqa: E402
from timed import timed  # noqa: E402
from timed_dynamics import timed_dynamics  # noqa: E402
from timed_rigid import timed_rigid  # noqa: E402
from touching import touching_full, touching_quick  # noqa: E402
from turning import turning  # noqa: E402
from verdict import Verdicts  # noqa: E402
from warnings_checks import warnings  # noqa: E402

GROUPS = {
    **acceptance.GROUPS,
    "condensed": condensed,
    "condensed_full": condensed_full,  # minutes; not among the tests
    "conserving": conserving,  # minutes
    "conserving_free": conserving_free,
    "conserving_turning": conserving_turning,  # minutes
    "dual": dual,
    "dual_full": dual_full,  # minutes; not among the tests
    "dual_iterations": dual_iterations,  # a quarter of an hour; not among the tests
    "effects": effects,
    "exact": exact,
    "exact_friction": exact_friction,
    "exact_gears": exact_gears,
    "exact_rolling": exact_rolling,
    "fluid": fluid,
    "friction": friction,
    "general": general,
    "general_cells": general_cells,
    "general_dynamics": general_dynamics,
    "general_scenes": general_scenes,  # some minutes; not among the tests
    "hosts": hosts,
    "iterative": iterative,
    "iterative_scenes": iterative_scenes,
    "multigrid": multigrid,
    "ironing": ironing,
    "ironing_full": ironing_full,  # four minutes; not among the tests
    "dynamics": dynamics,
    "dynamics_finite": finite,
    "dynamics_mass": mass,
    "laid": laid,
    "laws": laws,
    "loads": loads,
    "materials": materials,
    "normals": normals,
    "normals_full": normals_full,  # ten minutes; not among the tests
    "normals_iterations": normals_iterations,  # some minutes; not among the tests
    "heat": heat,
    "heat_moving": heat_moving,
    "offsets": offsets,
    "parameters": parameters,
    "parameters_scenes": parameters_scenes,  # some minutes; not among the tests
    "plane": plane,
    "plane_analytic": plane_analytic,
    "plane_ball": plane_ball,
    "points": points,
    "points_full": points_full,  # some minutes; not among the tests
    "quadratic": quadratic,
    "quadratic_contact": quadratic_contact,
    "quadratic_line": quadratic_line,
    "quadratic_sliding": quadratic_sliding,
    "quadratic_tied": quadratic_tied,
    "ranks": ranks,
    "ranks_files": ranks_files,
    "ranks_full": ranks_full,  # an hour or two; not among the tests
    "ranks_many": ranks_many,
    "ranks_moving": ranks_moving,
    "ranks_scenes": ranks_scenes,
    "restart": restart,
    "restart_steps": restart_steps,
    "rigid": rigid,
    "roles": roles,
    "sliding": sliding,
    "slider": slider,
    "slider_fine": slider_fine,  # minutes; not among the tests
    "sound": sound,
    "split": split,
    "split_fine": split_fine,
    "springs": springs,
    "stepping": stepping,
    "thrown": thrown,
    "timed": timed,
    "timed_dynamics": timed_dynamics,
    "timed_rigid": timed_rigid,
    "touching": touching_quick,
    "touching_full": touching_full,  # some minutes; not among the tests
    "turning": turning,
    "warnings": warnings,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("groups", nargs="+", choices=GROUPS, metavar="GROUP", help=", ".join(GROUPS))
    parser.add_argument("--progress", action="store_true", help="tell each check at once, on stderr; so it is on a terminal")
    arguments = parser.parse_args()
    progress = sys.stderr if arguments.progress or sys.stderr.isatty() else None

    passed = True
    for name in arguments.groups:
        output, verdicts = arguments.build / "acceptance", Verdicts(progress)
        try:
            GROUPS[name](verdicts, Driver(arguments.build, output / name))
        except (SceneError, KeyError, ValueError, OSError) as problem:
            verdicts.failed(f"{name}: stopped", f"{type(problem).__name__}: {problem}")
        verdicts.print()
        verdicts.write(output / f"{name}.json")
        passed = passed and verdicts.passed
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
