! The impacting motion of
!     x'' + c x' + x + s max(x - 1, 0) = f cos(w t)
! as a boundary value problem of two segments, for AUTO-07p (IPS = 4).
!
! One drive cycle begins when the mass enters the stop, at drive phase PHI. Contact lasts TC, flight the rest of the
! period, TF = 2 pi / w - TC; both are scaled to 0 <= s <= 1. In contact the displacement is measured as
! y = (x - 1) / TC, so that the problem stays regular through grazing, where TC = 0.
!     U(1) = y, U(2) = x' in contact;  U(3) = x, U(4) = x' in flight;  U(5) = s, for the drive's phase
!     PAR(1) = w, PAR(2) = PHI, PAR(3) = TC;  PAR(4): speed at entry, for the record only

MODULE soft_impact
  IMPLICIT NONE
  DOUBLE PRECISION, PARAMETER :: c = 0.02D0, s = 29.0D0, f = 0.152380952381D0
  DOUBLE PRECISION, PARAMETER :: two_pi = 6.283185307179586477D0
  ! The motion to begin with.
  DOUBLE PRECISION, PARAMETER :: start_w = 1.1D0, start_phase = 6.175472868575382D0
  DOUBLE PRECISION, PARAMETER :: start_contact = 0.502656691299782D0, start_speed = 0.791101768373217D0
END MODULE soft_impact

SUBROUTINE FUNC(NDIM, U, ICP, PAR, IJAC, FU, DFDU, DFDP)
  USE soft_impact
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM, ICP(*), IJAC
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(OUT) :: FU(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: DFDU(NDIM, *), DFDP(NDIM, *)
  DOUBLE PRECISION :: w, phase, tc, tf, theta, eta, contact, flight, push_in, push_out, tf_w

  w = PAR(1)
  phase = PAR(2)
  tc = PAR(3)
  tf = two_pi / w - tc
  theta = phase + w * tc * U(5)
  eta = phase + w * (tc + tf * U(5))
  contact = f * COS(theta) - c * U(2) - 1.0D0 - (1.0D0 + s) * tc * U(1)
  flight = f * COS(eta) - c * U(4) - U(3)

  FU(1) = U(2)
  FU(2) = tc * contact
  FU(3) = tf * U(4)
  FU(4) = tf * flight
  FU(5) = 1.0D0
  IF (IJAC == 0) RETURN

  push_in = -f * SIN(theta)
  push_out = -f * SIN(eta)
  DFDU(1:5, 1:5) = 0.0D0
  DFDU(1, 2) = 1.0D0
  DFDU(2, 1) = -(1.0D0 + s) * tc**2
  DFDU(2, 2) = -c * tc
  DFDU(2, 5) = tc * push_in * w * tc
  DFDU(3, 4) = tf
  DFDU(4, 3) = -tf
  DFDU(4, 4) = -c * tf
  DFDU(4, 5) = tf * push_out * w * tf
  IF (IJAC == 1) RETURN

  tf_w = -two_pi / w**2
  DFDP(1:5, 1:3) = 0.0D0
  DFDP(2, 1) = tc * push_in * tc * U(5)
  DFDP(3, 1) = tf_w * U(4)
  DFDP(4, 1) = tf_w * flight + tf * push_out * tc * (1.0D0 - U(5))
  DFDP(2, 2) = tc * push_in
  DFDP(4, 2) = tf * push_out
  DFDP(2, 3) = contact + tc * (push_in * w * U(5) - (1.0D0 + s) * U(1))
  DFDP(3, 3) = -U(4)
  DFDP(4, 3) = -flight + tf * push_out * w * (1.0D0 - U(5))
END SUBROUTINE FUNC

! Entry and release at the stop's surface, one motion, periodic.
SUBROUTINE BCND(NDIM, PAR, ICP, NBC, U0, U1, FB, IJAC, DBC)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM, ICP(*), NBC, IJAC
  DOUBLE PRECISION, INTENT(IN) :: PAR(*), U0(NDIM), U1(NDIM)
  DOUBLE PRECISION, INTENT(OUT) :: FB(NBC)
  DOUBLE PRECISION, INTENT(INOUT) :: DBC(NBC, *)

  FB(1) = U0(1)
  FB(2) = U1(1)
  FB(3) = U0(3) - 1.0D0
  FB(4) = U0(4) - U1(2)
  FB(5) = U1(3) - 1.0D0
  FB(6) = U1(4) - U0(2)
  FB(7) = U0(5)
  IF (IJAC == 0) RETURN

  DBC(1:7, 1:2*NDIM) = 0.0D0
  DBC(1, 1) = 1.0D0
  DBC(2, NDIM + 1) = 1.0D0
  DBC(3, 3) = 1.0D0
  DBC(4, 4) = 1.0D0
  DBC(4, NDIM + 2) = -1.0D0
  DBC(5, NDIM + 3) = 1.0D0
  DBC(6, NDIM + 4) = 1.0D0
  DBC(6, 2) = -1.0D0
  DBC(7, 5) = 1.0D0
  IF (IJAC == 1) RETURN

  DBC(1:7, 2*NDIM+1:2*NDIM+3) = 0.0D0
END SUBROUTINE BCND

! The motion to begin with, in closed form.
SUBROUTINE STPNT(NDIM, U, PAR, T)
  USE soft_impact
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(INOUT) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(IN) :: T
  DOUBLE PRECISION :: x, v, x_release, v_release

  PAR(1) = start_w
  PAR(2) = start_phase
  PAR(3) = start_contact
  CALL swing(1.0D0 + s, s / (1.0D0 + s), start_phase, 1.0D0, start_speed, T * start_contact, x, v)
  U(1) = (x - 1.0D0) / start_contact
  U(2) = v
  CALL swing(1.0D0 + s, s / (1.0D0 + s), start_phase, 1.0D0, start_speed, start_contact, x_release, v_release)
  CALL swing(1.0D0, 0.0D0, start_phase + start_w * start_contact, x_release, v_release, &
             T * (two_pi / start_w - start_contact), x, v)
  U(3) = x
  U(4) = v
  U(5) = T

CONTAINS

  ! x'' + c x' + k (x - centre) = f cos(phase + w t) from x0, v0 over the time t.
  SUBROUTINE swing(k, centre, phase, x0, v0, time, x_end, v_end)
    DOUBLE PRECISION, INTENT(IN) :: k, centre, phase, x0, v0, time
    DOUBLE PRECISION, INTENT(OUT) :: x_end, v_end
    DOUBLE PRECISION :: detuning, loss, scale, rate, own, a, b, fade, co, si
    detuning = k - start_w**2
    loss = c * start_w
    scale = f / (detuning**2 + loss**2)
    rate = 0.5D0 * c
    own = SQRT(k - rate**2)
    a = x0 - centre - scale * (detuning * COS(phase) + loss * SIN(phase))
    b = (v0 - start_w * scale * (loss * COS(phase) - detuning * SIN(phase)) + rate * a) / own
    fade = EXP(-rate * time)
    co = COS(own * time)
    si = SIN(own * time)
    x_end = centre + scale * (detuning * COS(phase + start_w * time) + loss * SIN(phase + start_w * time)) &
            + fade * (a * co + b * si)
    v_end = start_w * scale * (loss * COS(phase + start_w * time) - detuning * SIN(phase + start_w * time)) &
            + fade * (own * (b * co - a * si) - rate * (a * co + b * si))
  END SUBROUTINE swing
END SUBROUTINE STPNT

SUBROUTINE ICND
END SUBROUTINE ICND

SUBROUTINE FOPT
END SUBROUTINE FOPT

SUBROUTINE PVLS(NDIM, U, PAR)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: PAR(*)
  DOUBLE PRECISION, EXTERNAL :: GETP

  PAR(4) = GETP('BV0', 2, U)
END SUBROUTINE PVLS
