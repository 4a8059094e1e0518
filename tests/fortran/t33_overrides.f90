! What a host may set per node: friction, augmentation, normals, prescribed directions; and which nodes it owns.
#include "check.inc"
program t33_overrides
  use, intrinsic :: iso_c_binding
  use check
  use scenes
  use stickslip
  implicit none
  ! Products of numbers of size 1.
  real(c_double), parameter :: ROUNDING = 1d-15
  integer(c_int64_t), parameter :: NODE = 5
  type(scene), target, save :: s, parts(2)
  type(triplets), target, save :: t
  real(c_double), save :: k(UNKNOWNS, UNKNOWNS), total_k(UNKNOWNS, UNKNOWNS)
  real(c_double) :: r(UNKNOWNS), q(UNKNOWNS), mu(NA), total(SIZE1), direction(3)
  real(c_double), target :: normal(3, NA), augmentation(NA), traction(3, NA), given(NA), normals(3, NA)
  integer(c_int32_t), target :: state(NA), owned(NA, 2)
  logical :: others(3, NA)
  integer :: a, p

  call scene_init(s)
  call scene_create(s)
  call scene_residual(s, r)

  ! The options' own values, given per node, change no bit; others do.
  call states()
  mu = 0.7d0
  given = augmentation
  normals = normal
  call override(mu, c_loc(given), c_loc(normals))
  call scene_residual(s, q)
  CHECK(all(same(r, q)))

  mu = 0
  given = 4 * given
  do a = 1, NA
    ! Turned in the surface's plane and out of it, still unit.
    call scene_turn(normals(:, a), [1d0, 0d0, 0d0], 0.1d0)
  end do
  CHECK_OK(stickslip_interface_set_friction(s%contact, mu))
  call states()
  CHECK(all(state /= STICKSLIP_STATE_STICK))
  call override(mu, c_loc(given), c_loc(normals))
  call states()
  CHECK(all(same(augmentation, given)))
  CHECK(all(same(normal, normals)))

  ! Null returns to the library's own.
  mu = 0.7d0
  call override(mu, c_null_ptr, c_null_ptr)
  call scene_residual(s, q)
  CHECK(all(same(r, q)))

  ! A direction prescribed on both sides: no traction and no normal in it; n = 0 clears. Any length will do.
  direction = [0d0, 2.5d0, 0d0]
  call scene_frame(direction)
  CHECK_OK(stickslip_interface_set_constraints(s%contact, 1_c_int64_t, [NODE], direction))
  call states()
  CHECK_NEAR(dot_product(normal(:, NODE), direction), 0d0, ROUNDING)
  CHECK_NEAR(dot_product(traction(:, NODE), direction), 0d0, ROUNDING)
  CHECK_OK(stickslip_interface_set_constraints(s%contact, 0_c_int64_t, [NODE], direction))
  call scene_residual(s, q)
  CHECK(all(same(r, q)))
  call scene_destroy(s)

  ! Two handles of the same surfaces that own complementary nodes: rows and node blocks add up to one handle's.
  call scene_init(s)
  call scene_create(s)
  call scene_dense(s, t, k)
  total = 0
  total_k = 0
  do p = 1, 2
    call scene_init(parts(p))
    parts(p)%x1 = s%x1
    owned(:, p) = [(merge(1, 0, mod(a, 3) == 1 .eqv. p == 1), a = 1, NA)]
    parts(p)%nonmortar%owned = c_loc(owned(1, p))
    call scene_create(parts(p))
    call scene_residual(parts(p), q)
    total = total + q(POSITIONS + 1:)
    others = spread(owned(:, p) == 0, 1, 3)
    CHECK(all(pack(reshape(q(POSITIONS + 1:), [3, NA]), others) == 0))
    call scene_tangent(parts(p), t)
    call triplets_add(t, 1, total_k)
    call scene_destroy(parts(p))
  end do
  CHECK(all(same(total, r(POSITIONS + 1:))))
  ! The diagonal blocks of the multipliers hold nothing but the nodes' own part.
  CHECK(all(total_k(POSITIONS + 1:, POSITIONS + 1:) == k(POSITIONS + 1:, POSITIONS + 1:)))
  call scene_destroy(s)

contains

  subroutine override(mu, r, normals)
    real(c_double), intent(in) :: mu(NA)
    type(c_ptr), intent(in) :: r, normals
    CHECK_OK(stickslip_interface_set_friction(s%contact, mu))
    CHECK_OK(stickslip_interface_set_augmentation(s%contact, r))
    CHECK_OK(stickslip_interface_set_normals(s%contact, normals))
  end subroutine

  subroutine states()
    type(stickslip_states) :: out
    out = stickslip_states(state=c_loc(state), normal=c_loc(normal), augmentation=c_loc(augmentation), &
        traction=c_loc(traction))
    CHECK_OK(stickslip_interface_states(s%contact, s%x1, s%x2, s%lambda, c_null_ptr, out))
  end subroutine
end program
