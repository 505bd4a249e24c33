"""Columns of the arrays that the compiled contact engine reads and advances, SI throughout.

A surface is a sum of columns: a shape, on every piece of the beam a polynomial in the local coordinate xi in [0, 1],
times a factor of time. Columns 0..n-1 are the (real parts of the) shapes psi of the modal rows, factor Re z; then the
imaginary parts of the last `COMPLEX` rows, factor -Im z; then the drive's, in pairs (t/T)^d (cos, -sin)(omega s).
"""

ROW = 11
Z_RE, Z_IM, RATE_RE, RATE_IM, HALF_RE, HALF_IM, GAIN_RE, GAIN_IM, END_RE, END_IM, COARSE = range(ROW)
"""Rows (ROW, n): state z, rate lambda, e^{lambda dt/2}, what a unit force that is constant over the step adds to z of a
unit shape by its end, G = c (e^{lambda dt} - 1)/lambda, and to its rate, lambda G; 1 where the step does not resolve
the row, |lambda| dt > 1.5: the mean rate of the step, G/dt of a force, stands for that at its end."""
OMEGA, ORIGIN, UNIT = range(3)
"""Drive (3,): angular frequency, seconds before the stage, T of the powers of time."""

SLIDER = 11
X, V, INVERSE_MASS, MU, MU_STATIC, STEEPNESS, EXTERNAL_FORCE, FREE, DELTA_V, DRIFT, TILT = range(SLIDER)
"""Sliders (n, SLIDER). Filled by the caller: distance travelled and speed (state); 1/mass, 0 at a prescribed speed;
kinetic and static coefficient of friction; K of the tanh law, 0 for Coulomb's; external force along x, N; 0 at a fixed
position, else 1. Then the engine's: speed gained in the step; of kinematics "following" the mean drift along x and the
mean acceleration by the turning tangent and gravity."""
FOOT = 10
(
    HEIGHT, VELOCITY_Z, PITCH, PITCH_RATE, INVERSE_FOOT_MASS, INVERSE_INERTIA, FOOT_LOAD, SPRING_RATE, DELTA_VZ,
    DELTA_PITCH_RATE,
) = range(FOOT)  # fmt: skip
"""Feet (n, FOOT): height, its rate, pitch, its rate (state); 1/mass across, 1/inertia (0: no pitch), force along z, N,
and stiffness of the preload spring, N/m. Then the engine's: what the step adds to the two rates."""
POINT = 12
OFFSET, ARM, STIFF, DASHPOT, TANGENTIAL, FACE, IMAGE, INSET, WEIGHT, LOAD, INERTIA, LEVER = range(POINT)
"""Points, static (n, POINT): place from the first slider's x and from the middle of the foot, m; normal stiffness,
damping and tangential stiffness (0: rigid); +1 on the upper face, -1 on the lower one; +1, or -1 on the mirror image of
the beam; depth in the straight beam at foot height 0, m; 1/2 of a point between two beams, else 1; normal load of a
point without foot, N, and its mass across the beam, kg; half the thickness h/2 times face times image, m."""
CONTACT = 30
(
    NORMAL, FRICTION, STUCK, DEPTH, STRETCH, POINT_VZ, SURFACE, BEFORE, LOSS, AT, ABOVE, SLOPE, LIFT, CLOSING, RAMP,
    START, MEAN, END, SURFACE_DELTA_V, WAS_DEPTH, WAS_STUCK, SLIP, SELF_RESPONSE, TILT_END, DRIFT_END,
    AT_END, ABOVE_END, SPEED_END, WAS_FRICTION, GRIP,
) = range(CONTACT)  # fmt: skip
"""Points, moving (n, CONTACT), zero at first except DEPTH (below zero: gap) and, of bilateral contact, POINT_VZ, the
speed of the point across the beam, m/s. State: the first nine. NORMAL and FRICTION are means over the step, FRICTION
acts on the slider; STRETCH is the elastic tangential displacement; SURFACE is the mean tangential speed of the surface
over the step with all forces; BEFORE extrapolates it; LOSS is the energy that friction of a rigid point has dissipated
so far. The others are of one step: material under the point and the point itself on the piece, slope, mean rate of rise
under it, rate at which the gap closes, share of the rise by slopes; speed of the surface at the start, in the mean and
at the end without contact forces, its gain; last depth and sticking; mean slip v - s; own response; acceleration and
drift of "following" at the end without forces; material under the point, point and its speed along at the end; last
friction; which limit of friction holds, `GRIP` of `point_forces`."""
OF_SLIDER, OF_FOOT, PIECE = range(3)
"""Indices (n_points, 3): slider, foot (0 without feet) and piece of the beam of every point."""

CODES = 6
LAW, TWO_WAY, NORMAL_TWO_WAY, FOLLOWING, COMPLEX, ACCOUNTS = range(CODES)
"""Codes (CODES,), integers: normal law; 1 where the beam responds to friction; 1 where it responds to normal forces;
1 of kinematics "following"; number of rows with a complex shape, the last ones; 1 where the drive's work is summed."""
PRESCRIBED, BILATERAL, SPRING = range(3)
"""Normal laws: N = LOAD; N = LOAD + INERTIA times the acceleration of the surface; springs and dashpots of feet."""

SUMS = 17
(
    NORMAL_WORK, SLOPE_WORK, TANGENTIAL_WORK, EXTERNAL_WORK, LOAD_WORK, FRICTION_LOSS, CONTACT_LOSS, FRICTION_ON_BEAM,
    NORMAL_ON_BEAM, FRICTION_TIME, NORMAL_TIME, TOUCH_TIME, STICK_TIME, SURFACE_TIME, MAX_FRICTION, MAX_FALL, STORED,
) = range(SUMS)  # fmt: skip
"""Sums over all steps of every slider (n, SUMS). Works, J: of the surface across and up its slopes on the feet, along
on the slider, of the external force or a prescribed speed, of preload and weight; friction loss; loss in dashpots and
impacts; work on the beam of friction, of normal forces. Integrals over time: friction (on the slider, N s), normal
force, share of points in contact and sticking, displacement of the surface under the points in contact (mean of
points). The largest friction, N; the largest downward acceleration of the surface, m/s^2; energy of the springs, J."""
BALANCE = 7
DRIVEN, LOST, RESISTED, CREATED, SWEEPS, UNCONVERGED, RESIDUAL = range(BALANCE)
"""Balance (BALANCE,): work of the drive, loss in modes and circuits, of it in circuits, J (with ACCOUNTS); energy that
friction created, the sum of positive contact works of all steps, J; sweeps of all steps; steps whose contact solution
did not converge; largest residual of a step, N."""

OUT = 9
OUT_X, OUT_V, OUT_FRICTION, OUT_NORMAL, OUT_TOUCH, OUT_STUCK, OUT_LOSS, OUT_ALONG, OUT_SURFACE = range(OUT)
"""Samples (n, sliders, OUT): distance, speed; friction, normal force, shares and surface speed (points in contact)
are means over the interval that ends with the sample, friction loss and work of the surface along are its sums. Of
points without feet, friction, surface speed and normal force are of the instant: the law at the sample, the mean of the
last step where it sticks."""
STICKS, SLIPS, TURNS, LANDS, LEAVES = 1.0, 2.0, 3.0, 4.0, 5.0
"""Kinds of events, rows (time, kind, point, distance)."""
STEP, SAMPLES, EVENTS = range(3)
"""Tally (3,): steps of the stage, samples and events so far."""
DONE, OFF_PIECES, NOT_FINITE, CHATTERS = range(4)
"""Why the compiled loop returns."""
