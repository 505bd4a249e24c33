"""Options of scenes, scripts and commands whose values are words."""

from typing import Literal, get_args

Support = Literal["pinned", "clamped", "free", "guided"]
SUPPORTS: tuple[str, ...] = get_args(Support)
"""An end of a beam. pinned: w = 0. clamped: w = w' = 0. free: no constraint. guided: w' = 0."""

Shape = Literal["rectangle", "round", "tube"]
"""A beam's section. rectangle: width and thickness. round: a diameter. tube: a diameter and a wall_thickness."""

Theory = Literal["euler-bernoulli", "rayleigh", "timoshenko"]
THEORIES: tuple[str, ...] = get_args(Theory)
"""Beam theory. rayleigh adds rotary inertia to euler-bernoulli, timoshenko shear as well."""

Wall = Literal["gregory", "half", "welded", "third-order", "five-joint"]
WALLS: tuple[str, ...] = get_args(Wall)
"""Joints of a chain at a clamped end, by their weights from the wall on (`segments.walls`).

gregory: 3/8, 7/6, 23/24, frequencies of order 4. half: the literature's k = 2EI/l, order 2. welded: half a segment is
part of the wall, order 2. third-order: 5/12, 13/12. five-joint: order 4, a smaller constant at low modes.
"""

Joints = Literal["series", "printed", "tensioned"]
JOINTS: tuple[str, ...] = get_args(Joints)
"""The spring between two links. series: the paper's Eq. (1), two half links in series. printed: its indices as printed.
tensioned: series less T l/12 under a tension T, and rotary inertia corrected likewise: order 4 under axial force, in
Rayleigh theory and in Timoshenko theory."""

Attachment = Literal["reciprocal", "lever"]
ATTACHMENTS: tuple[str, ...] = get_args(Attachment)
"""A point mass or spring on a chain. reciprocal: on four joints, order 4. lever: on its rigid link, order 1 or 2."""

Load = Literal["reciprocal", "lever"]
LOADS: tuple[str, ...] = get_args(Load)
"""A point force on a chain. reciprocal: on four joints, order 4. lever: on the two joints of its link, order 2."""

Reading = Literal["corrected", "raw", "links"]
READINGS: tuple[str, ...] = get_args(Reading)
"""Deflection between joints. corrected: the spline through y + delta^2 y / 12. raw: the spline through y. links: the
straight links."""

Line = Literal["spline", "raw"]
LINES: tuple[str, ...] = get_args(Line)
"""Contact line on a chain. spline: the paper's C2 spline (Section II.B). raw: the links' straight edges."""

Links = Literal["rigid", "stretching"]
LINKS: tuple[str, ...] = get_args(Links)
"""Links of a nonlinear chain. rigid: the paper's. stretching: with the beam's EA / l."""

Inertia = Literal["full", "transverse", "elastic"]
"""Axial inertia of links. full: rigid links. transverse: rigid links without it. elastic: stretching links."""

Tip = Literal["free", "roller"]
TIPS: tuple[str, ...] = get_args(Tip)
"""Far end of a nonlinear chain. free: no constraint. roller: y = 0, free along x."""

Law = Literal["tanh", "coulomb"]
"""Friction law. tanh: the paper's Eq. (3), which never sticks. coulomb: mu N against the motion, with stiction."""

CouplingChoice = Literal["two-way", "one-way"]
"""Coupling of slider and beam. one-way: the slider does not act on the beam."""

Kinematics = Literal["tangential", "following"]
"""Slider kinematics. tangential: m dv/dt = F, dx/dt = v. following: a point that follows the surface exactly."""

NormalChoice = Literal["held", "massless"]
"""Normal force of a two-way coupled slider. held: weight and inertia. massless: none, as in the paper."""

Face = Literal["upper", "lower"]
"""Face of the beam that a foot is on."""

Start = Literal["rest", "steady"]
"""Initial state of a motion. rest: at rest, with the static sag under a slider. steady: the drive's steady state."""

DriveKind = Literal["force", "displacement"]
"""Kind of a drive. force: N. displacement: imposed, m."""

Reference = Literal["closed form", "independent method", "published", "other code", "regression"]
"""Reference of a gate's expected value. closed form: a formula. independent method: another derivation. published: a
publication. other code: another program. regression: an earlier value of this package."""
