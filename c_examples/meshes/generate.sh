#!/bin/sh
# Makes every committed mesh again from its .geo file: ./generate.sh [gmsh]
# Two runs of one Gmsh version give equal files; another version may number nodes differently.
set -eu
cd "$(dirname "$0")"
gmsh=${1:-gmsh}

# mesh OUTPUT GEOMETRY NAME VALUE [NAME VALUE]...
mesh() {
    output=$1 geometry=$2
    shift 2
    settings=""
    while [ $# -gt 0 ]; do
        settings="$settings -setnumber $1 $2"
        shift 2
    done
    # shellcheck disable=SC2086  # settings is a list of words
    "$gmsh" -3 -v 2 -format msh41 $settings "$geometry" -o "$output"
    echo "$output  $(wc -c < "$output") bytes"
}

# A pin joint, and a chain of two.
mesh joint_lug.msh  joint.geo part 1
mesh joint_fork.msh joint.geo part 2
mesh joint_pin.msh  joint.geo part 3
mesh joint_link.msh joint.geo part 4
mesh joint_end.msh  joint.geo part 5
mesh joint_pin_2.msh joint.geo part 3 at 6

# Upper body: non-mortar side. Lower body: mortar side, wider and coarser, so that no facet matches.
mesh hertz_upper_coarse.msh hertz_cylinder.geo side  1 contact_facets 44 half_width 1.4
mesh hertz_lower_coarse.msh hertz_cylinder.geo side -1 contact_facets 42 half_width 1.6
mesh hertz_upper_fine.msh   hertz_cylinder.geo side  1 contact_facets 66 half_width 1.4 far_cells 18 grow_far 1.18
mesh hertz_lower_fine.msh   hertz_cylinder.geo side -1 contact_facets 58 half_width 1.6 far_cells 18 grow_far 1.18

# The coarse two as plane meshes.
for side in upper lower; do
    python3 plane.py "hertz_${side}_coarse.msh" "plane_hertz_$side.msh"
done

mesh brick_tet_upper.msh brick_tet.geo side  1 cells 4
mesh brick_tet_lower.msh brick_tet.geo side -1 cells 3

mesh ironing_die_coarse.msh ironing_die.geo along 6 up 3
mesh ironing_die.msh        ironing_die.geo along 12 up 6

mesh ironing_tube_coarse.msh ironing_tube.geo quarter 6 across 3
mesh ironing_tube.msh        ironing_tube.geo

# The channel for a slider whose facets are 25 long, or 12.5; with a rounded end; carrying the multipliers itself, and
# the same for facets of 12.5; half of a wide one for 3D.
mesh press_fit_coarse.msh  press_fit_channel.geo before  2 ramp 1 after  2 down 3
mesh press_fit_rounded.msh press_fit_channel.geo before  2 ramp 1 after  2 down 3 radius 25 bend 8
mesh press_fit_fine.msh    press_fit_channel.geo before 22 ramp 6 after 25 down 6
mesh press_fit_swapped.msh press_fit_channel.geo before 22 ramp 6 after 25 down 1
mesh press_fit_swapped_fine.msh press_fit_channel.geo before 44 ramp 12 after 50 down 2
mesh press_fit_wide.msh    press_fit_channel.geo before  6 ramp 2 after  7 down 3 width 200 across 3
