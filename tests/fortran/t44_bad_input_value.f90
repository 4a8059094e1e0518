! Numbers and options outside their range: mu < 0, r <= 0, neither stiffness, lengths of normals and directions. The
! messages count nodes from 0: node 5 here is their node 4.
#include "check.inc"
program t44_bad_input_value
  use, intrinsic :: iso_c_binding
  use calls
  use check
  use pairs
  use scenes
  use stickslip
  implicit none
  type(scene), target, save :: s
  type(element), target, save :: e
  type(handle), target, save :: h

  call scene_init(s)
  call check_option(s%options%form, 'form', 2, 2)
  call check_option(s%options%slip, 'slip', 3, 3)
  call check_option(s%options%weights, 'weights', 3, 3)
  call check_option(s%options%friction, 'friction', 5, 5)
  call check_option(s%options%mortar_side, 'mortar_side', 3, 3)
  call check_option(s%options%multiplier_basis, 'multiplier_basis', 1, 2)
  call check_option(s%options%quadrature, 'quadrature', 6, 6)
  call check_option(s%options%row_scale, 'row_scale', 2, 2)
  call check_option(s%options%new_contact, 'new_contact', 2, 2)
  call check_option(s%options%index_base, 'index_base', 2, 2)
  call check_option(s%options%integration, 'integration', 3, 3)
  call check_option(s%options%tangent, 'tangent', 3, 3)
  call check_numbers()
  call nodes()
  call layouts()
  call handles()

contains

  ! Every number that is not an option, and those that are named but not there yet.
  subroutine check_option(option, name, available, named)
    integer(c_int32_t), target, intent(inout) :: option
    character(*), intent(in) :: name
    integer, intent(in) :: available, named
    integer(c_int32_t) :: kept, wrong(4)
    integer :: k
    kept = option
    do k = available, named - 1
      option = k
      CHECK_REFUSED(call_create(s), STICKSLIP_UNSUPPORTED, 'options.' // name)
    end do
    wrong = [-1, named, INT32_MAX, INT32_MIN]
    do k = 1, 4
      option = wrong(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.' // name)
    end do
    option = kept
  end subroutine

  subroutine check_numbers()
    real(c_double), parameter :: COVERAGE(3) = [-1d-12, 1d0, 2d0]
    integer(c_int64_t), parameter :: POINTS(5) = [-1_c_int64_t, 1_c_int64_t, 11_c_int64_t, huge(0_c_int64_t), &
                                                  -huge(0_c_int64_t)]
    integer :: i, k
    s%options%mu = -1d-300
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.mu')
    s%options%mu = 0.3d0
    s%options%augmentation = -1
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.augmentation')
    s%options%augmentation = 0
    CHECK_REFUSED(call_create(s), STICKSLIP_MISSING_STIFFNESS, 'modulus')
    s%options%modulus = -5
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.modulus')
    s%options%modulus = 5
    s%options%search_distance = -1
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.search_distance')
    s%options%search_distance = 0
    do k = 1, 3
      s%options%coverage_min = COVERAGE(k)
      CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.coverage_min')
    end do
    s%options%coverage_min = 0
    ! Points along a side: none with cells, 2 to 10 else.
    do k = 1, 5
      do i = 0, 2
        s%options%integration = i
        s%options%element_points = POINTS(k)
        CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.element_points')
      end do
    end do
    s%options%integration = STICKSLIP_INTEGRATION_SEGMENTS
    s%options%element_points = 4
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.element_points')
    s%options%element_points = 0
    ! The other stiffness is wrong too, if it is not needed.
    s%options%augmentation = 1
    s%options%modulus = -5
    CHECK_REFUSED(call_create(s), STICKSLIP_INVALID_VALUE, 'options.modulus')
  end subroutine

  subroutine nodes()
    real(c_double), parameter :: R(3) = [0d0, -0d0, -1d0], LENGTHS(5) = [0d0, 1d-3, 0.999d0, 1.001d0, 1d100]
    integer(c_int32_t), parameter :: WRONG(4) = [-1, 3, INT32_MAX, INT32_MIN]
    ! Not unit, twice the same, not orthogonal to the normal, not orthogonal to each other.
    real(c_double), parameter :: DIRECTIONS(3, 2, 5) = reshape([2d0, 0d0, 0d0, 0d0, 1d0, 0d0, &
                                                                1d0, 0d0, 0d0, 1d0, 0d0, 0d0, &
                                                                1d0, 0d0, 0d0, 0d0, 0d0, 1d0, &
                                                                0.8d0, 0d0, 0.6d0, 0d0, 1d0, 0d0, &
                                                                1d0, 0d0, 0d0, 0.5d0, 1d0, 0d0], [3, 2, 5])
    type(stickslip_node) :: good
    integer :: k
    call element_init(e)
    good = e%node
    e%node%mu = -1d-9
    CHECK_REFUSED(call_respond(e), STICKSLIP_INVALID_VALUE, 'node.mu')
    e%node = good
    do k = 1, 3
      e%node%augmentation = R(k)
      CHECK_REFUSED(call_respond(e), STICKSLIP_INVALID_VALUE, 'node.augmentation')
    end do
    e%node = good
    do k = 1, 5
      e%node%normal(3) = LENGTHS(k)
      CHECK_REFUSED(call_respond(e), STICKSLIP_INVALID_VALUE, 'node.normal')
    end do
    do k = 1, 4
      e%node = good
      e%node%n_directions = WRONG(k)
      CHECK_REFUSED(call_respond(e), STICKSLIP_INVALID_VALUE, 'node.n_directions')
      e%node = good
      e%node%slip = WRONG(k)
      CHECK_REFUSED(call_respond(e), STICKSLIP_INVALID_VALUE, 'node.slip')
    end do
    do k = 1, 5
      e%node = good
      e%node%n_directions = 2
      e%node%directions = DIRECTIONS(:, :, k)
      CHECK_REFUSED(call_respond(e), STICKSLIP_INVALID_VALUE, 'node.directions')
    end do
    e%node = good
    e%node%coverage_min = -1
    CHECK_REFUSED(call_respond(e), STICKSLIP_INVALID_VALUE, 'node.coverage_min')
    call response_untouched(e%responses(4))
  end subroutine

  subroutine layouts()
    integer(c_int32_t), parameter :: WRONG(3) = [-1, 2, INT32_MAX], RULES(3) = [-1, 6, INT32_MAX]
    integer(c_int64_t), parameter :: POINTS(3) = [-1, 1, 11]
    integer :: k
    do k = 1, 3
      call element_init(e)
      e%pair%layout = WRONG(k)
      CHECK_REFUSED(call_tangent(e), STICKSLIP_INVALID_VALUE, 'pair.layout')
      e%pair%layout = STICKSLIP_LAYOUT_COLUMN_MAJOR
      e%pair%quadrature = RULES(k)
      CHECK_REFUSED(call_weights(e), STICKSLIP_INVALID_VALUE, 'pair.quadrature')
      e%pair%quadrature = 0
      e%pair%element_points = POINTS(k)
      CHECK_REFUSED(call_weights(e), STICKSLIP_INVALID_VALUE, 'pair.element_points')
      call element_untouched(e)
    end do
  end subroutine

  subroutine handles()
    integer(c_int64_t), parameter :: SAME_NODE(3) = 5
    real(c_double), target :: values(3, NA), normal(3, NA)
    real(c_double) :: directions(3, 3), expected(3, NA)
    type(stickslip_states) :: out
    call handle_init(h)
    CHECK_OK(call_interface_residual(h))
    expected = h%rows

    values = 1
    values(3, 2) = -1d-9
    CHECK_REFUSED(stickslip_interface_set_friction(h%s%contact, values), STICKSLIP_INVALID_VALUE, 'mu')
    CHECK_REFUSED(set_augmentation(c_loc(values)), STICKSLIP_INVALID_VALUE, 'augmentation')
    values(3, 2) = 0
    CHECK_REFUSED(set_augmentation(c_loc(values)), STICKSLIP_INVALID_VALUE, 'augmentation')
    CHECK_REFUSED(stickslip_interface_set_normals(h%s%contact, c_loc(values)), STICKSLIP_INVALID_VALUE, 'normal')

    ! Zero length; a direction given twice; a third direction; the normal left without a free part.
    directions = reshape([0, 0, 0, 0, 2, 0, 0, 0, 1], [3, 3])
    CHECK_REFUSED(set_constraints(1, SAME_NODE, directions), STICKSLIP_INVALID_VALUE, 'constraint')
    CHECK_REFUSED(set_constraints(3, SAME_NODE, directions), STICKSLIP_INVALID_VALUE, 'constraint')
    directions(:, 1) = [0, 1, 0]
    CHECK_REFUSED(set_constraints(2, SAME_NODE, directions), STICKSLIP_INVALID_VALUE, 'constraint')
    directions(:, 1) = [1, 0, 0]
    CHECK_REFUSED(set_constraints(3, SAME_NODE, directions), STICKSLIP_UNDEFINED_NORMAL, 'node 4')
    out%normal = c_loc(normal)
    CHECK_OK(stickslip_interface_states(h%s%contact, h%s%x1, h%s%x2, h%s%lambda, c_null_ptr, out))
    CHECK_REFUSED(set_constraints(1, SAME_NODE, normal(:, 5)), STICKSLIP_UNDEFINED_NORMAL, 'node 4')

    ! None of the refused overrides has acted.
    CHECK_OK(call_interface_residual(h))
    CHECK(all(same(h%rows, expected)))
    call handle_fill(h)
    call handle_untouched(h)
    call scene_destroy(h%s)
  end subroutine

  integer(c_int32_t) function set_augmentation(r) result(status)
    type(c_ptr), intent(in) :: r
    status = stickslip_interface_set_augmentation(h%s%contact, r)
  end function

  integer(c_int32_t) function set_constraints(n, nodes, directions) result(status)
    integer, intent(in) :: n
    integer(c_int64_t), intent(in) :: nodes(*)
    real(c_double), intent(in) :: directions(3, *)
    status = stickslip_interface_set_constraints(h%s%contact, int(n, c_int64_t), nodes, directions)
  end function
end program
