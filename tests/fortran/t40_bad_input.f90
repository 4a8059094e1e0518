! The rows of tests/capi/bad_input.txt that Fortran can write: pointer arguments and members, handles, numbers; an array or
! a type is never null. tests/capi/bad_rows.c reads them and spoils what is named here. The rows count entries from 0, in
! the order of memory.
#include "check.inc"
program t40_bad_input
  use, intrinsic :: iso_c_binding
  use bad_input
  use calls
  use check
  use scenes
  use stickslip
  implicit none
  character(len=9, kind=c_char), target :: first = 'pair_gap' // c_null_char
  call set_up(c_loc(first), 1)
  call tell()
  call tear_down()
  call bad_rows('CF' // c_null_char, 1, bad_host(c_funloc(perform), c_funloc(set_up), c_funloc(compare), c_funloc(tear_down)))

contains

  ! Tells where all lies: structs, arrays with their lengths, single numbers with 0.
  subroutine tell()
    integer :: k
    character(12) :: name
    call places(OPTIONAL_, NAMES, [(c_loc(p(k)), k = 1, POINTERS)], [(0, k = 1, POINTERS)])
    call places(NEEDED, ['interface'], [c_loc(interface_)], [0])
    call structs('pair', 'pair', c_loc(e%pair))
    call structs('facet', 'facet', c_loc(e%facet))
    call structs('node', 'node', c_loc(e%node))
    call structs('answer', 'answer', c_loc(o%answer))
    call structs('response', 'response', c_loc(e%responses))
    call structs('options', 'options', c_loc(h%s%options))
    call structs('method', 'method', c_loc(h%s%method))
    call structs('surface', 'nonmortar', c_loc(h%s%nonmortar))
    call structs('surface', 'mortar', c_loc(h%s%mortar))
    call structs('states', 'states', c_loc(h%states))
    call structs('counters', 'counters', c_loc(o%counters))
    call structs('report', 'report', c_loc(o%report))
    call structs('diagnosis', 'diagnosis', c_loc(o%diagnosis))
    call structs('equilibrium', 'equilibrium', c_loc(o%equilibrium))
    do k = 1, 4
      write (name, '(a, i0, a)') 'responses[', k - 1, ']'
      call structs('responses', trim(name), c_loc(e%responses(k)))
    end do
    call places(REAL_, [character(30) :: &
        'pair.x1', 'pair.x2', 'pair.neighbour_normals', 'n_ab', 'n_ac', 'dn_ab', 'dn_ac', 'n_ab_previous', 'n_ac_previous', &
        'traction', 'row_scale', 'sum', 'nonmortar.coordinates', 'mortar.coordinates', 'x1', 'x2', 'lambda', 'dx1', 'dx2', &
        'sums', 'mu', 'r', 'normals', 'directions', 'imported_reals', 'scale', 'stiffness', 'rounding', 'angle', &
        'penetration', 'facet.neighbour_normals', 'mass', 'host1', 'state', 'slip', 'offsets1', 'offsets2', 'point', &
        'direction', 'tolerance', 'radius'], [ &
        c_loc(e%x1), c_loc(e%x2), c_loc(neighbours), c_loc(e%w%ab), c_loc(e%w%ac), c_loc(e%w%dab), c_loc(e%w%dac), &
        c_loc(previous%ab), c_loc(previous%ac), c_loc(e%traction), c_loc(e%row_scale), c_loc(e%sum), c_loc(h%s%reference1), &
        c_loc(h%s%reference2), c_loc(h%s%x1), c_loc(h%s%x2), c_loc(h%s%lambda), c_loc(dx1), c_loc(dx2), c_loc(sums), &
        c_loc(mu), c_loc(r), c_loc(normals), c_loc(directions), c_loc(imported%reals), c_loc(scale), c_loc(stiffness), &
        c_loc(rounding), c_loc(angle), c_loc(penetration), c_loc(neighbours), c_loc(e%mass), c_loc(h%host1), &
        c_loc(e%state), c_loc(slip), c_loc(raised1), c_loc(raised2), c_loc(point), c_loc(direction), c_loc(tolerance), &
        c_loc(radius)], [ &
        12, 12, 12, 16, 16, size(e%w%dab), size(e%w%dac), 16, 16, 12, 4, 3, SIZE1, SIZE2, SIZE1, SIZE2, SIZE1, SIZE1, &
        SIZE2, size(sums), NA, NA, SIZE1, 9, int(n_reals), 0, 0, 0, 0, 0, 12, 16, SIZE1, STATE_SIZE, SIZE1, NA, NC, &
        3, 3, 0, 0])
    call places(INT64, [character(30) :: &
        'imported_integers', 'nonmortar.facet_offsets', 'mortar.facet_offsets', 'nonmortar.facet_nodes', &
        'mortar.facet_nodes', 'nonmortar.equations', 'mortar.equations', 'nonmortar.multiplier_equations', 'nodes', &
        'row_offsets', 'nonmortar_offsets', 'mortar_offsets', 'handle', 'struct_size', 'ld', 'capacity', 'length', &
        'n_interfaces', 'n', 'n_rows', 'n_integers', 'n_reals', 'commits'], [ &
        c_loc(imported%integers), c_loc(h%s%offsets1), c_loc(h%s%offsets2), c_loc(h%s%nodes1), c_loc(h%s%nodes2), &
        c_loc(h%s%equations1), c_loc(h%s%equations2), c_loc(h%s%multipliers), c_loc(nodes), c_loc(h%offsets), &
        c_loc(offsets1), c_loc(offsets2), c_loc(other), c_loc(struct_size), c_loc(ld), c_loc(capacity), c_loc(length), &
        c_loc(n_interfaces), c_loc(n), c_loc(n_rows), c_loc(n_integers), c_loc(n_reals), c_loc(commits)], [ &
        int(n_integers), 5, 10, 16, 36, SIZE1, SIZE2, SIZE1, 3, size(h%offsets), 3, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0])
    call places(INT32, [character(30) :: &
        'n_facet', 'layout', 'index_base', 'diagnosis.state', 'facet.n2', 'piece', 'interface_use_normals:normals', &
        'pairs', 'entries', 'side', 'shape'], [ &
        c_loc(n_facet), c_loc(layout), c_loc(index_base), c_loc(o%state), c_loc(e%n2), c_loc(piece), &
        c_loc(which_normals), c_loc(which_pairs), c_loc(entries), c_loc(side), c_loc(shape_)], [0, 0, 0, NA, 1, 0, 0, 0, 0, 0, 0])
  end subroutine

  subroutine structs(kind, name, there)
    character(*), intent(in) :: kind, name
    type(c_ptr), intent(in) :: there
    call bad_struct(kind // c_null_char, name // c_null_char, there)
  end subroutine

  subroutine places(type, names_, there, lengths)
    integer(c_int), intent(in) :: type
    character(*), intent(in) :: names_(:)
    type(c_ptr), intent(in) :: there(:)
    integer, intent(in) :: lengths(:)
    integer :: k
    CHECK(size(names_) == size(there) .and. size(there) == size(lengths))
    do k = 1, size(there)
      call bad_place(trim(names_(k)) // c_null_char, type, there(k), lengths(k))
    end do
  end subroutine
end program
