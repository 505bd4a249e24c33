"""Named choices of scenes, scripts and commands."""

from typing import Literal, get_args

Support = Literal["pinned", "clamped", "free", "guided"]
SUPPORTS: tuple[str, ...] = get_args(Support)
"""Support of an end of a beam. pinned: w = 0. clamped: w = w' = 0. free: no constraint. guided: w' = 0."""

Shape = Literal["rectangle", "round", "tube"]
"""Cross-section. rectangle: width and thickness. round: diameter. tube: diameter and wall_thickness."""

Theory = Literal["euler-bernoulli", "rayleigh", "timoshenko"]
THEORIES: tuple[str, ...] = get_args(Theory)
"""Beam theory. rayleigh: euler-bernoulli with rotary inertia. timoshenko: rayleigh with shear."""

Wall = Literal["gregory", "half", "full", "welded", "third-order", "five-joint"]
WALLS: tuple[str, ...] = get_args(Wall)
"""Compliances, in l/EI, of the joints of a chain next to a clamped end (`segments.walls`).

gregory: 3/8, 7/6, 23/24, frequencies of order 4. half: the literature's k = 2EI/l, order 2. full: EI/l, the spring of
an inner joint, a frequent mistake, order 1. welded: half a segment is part of the wall, order 2. third-order: 5/12,
13/12. five-joint: order 4, a smaller error at low modes.
"""

Joints = Literal["series", "printed", "tensioned"]
JOINTS: tuple[str, ...] = get_args(Joints)
"""Stiffness of a joint. series: the paper's Eq. (1) corrected, two half links in series. printed: Eq. (1) with its
indices as printed. tensioned: series with corrections of axial force (less T l/12) and rotary inertia: order 4 under
axial force and in Rayleigh and Timoshenko theory."""

Attachment = Literal["reciprocal", "lever"]
ATTACHMENTS: tuple[str, ...] = get_args(Attachment)
"""Distribution of a point mass or spring on a chain. reciprocal: over four joints, order 4. lever: to its rigid link,
order 1 or 2."""

Load = Literal["reciprocal", "lever"]
LOADS: tuple[str, ...] = get_args(Load)
"""Distribution of a point force on a chain. reciprocal: over four joints, order 4. lever: over the two joints of its
link, order 2."""

Reading = Literal["corrected", "raw", "links"]
READINGS: tuple[str, ...] = get_args(Reading)
"""Interpolation between joints. corrected: spline through y + delta^2 y / 12. raw: spline through y. links: straight
links."""

ChainReading = Literal["corrected", "links"]
"""Interpolation between the joints of a nonlinear chain, as of `Reading`."""

Line = Literal["spline", "raw"]
"""Contact line of a chain. spline: the paper's C2 spline (Section II.B). raw: the straight edges of the links."""

Links = Literal["rigid", "stretching"]
LINKS: tuple[str, ...] = get_args(Links)
"""Links of a nonlinear chain. rigid: as in the paper. stretching: axial stiffness EA / l."""

Inertia = Literal["full", "transverse", "elastic"]
"""Axial inertia of links. full: rigid links. transverse: rigid links, none along x. elastic: stretching links."""

Tip = Literal["free", "roller"]
"""Far end of a nonlinear chain. free: no constraint. roller: y = 0, free along x."""

Law = Literal["tanh", "coulomb"]
"""Friction law. tanh: the paper's Eq. (3), without stiction. coulomb: Coulomb's law with stiction."""

CouplingChoice = Literal["two-way", "one-way"]
"""Coupling of slider and beam. two-way: contact forces act on both. one-way: on the slider alone."""

Kinematics = Literal["tangential", "following"]
"""Slider kinematics. tangential: m dv/dt = F, dx/dt = v. following: exact motion on the moving surface."""

NormalChoice = Literal["bilateral", "massless"]
"""Normal force of a two-way coupled slider on the beam. bilateral: weight and inertia. massless: none, as in the
paper."""

Face = Literal["upper", "lower"]
"""Face of the beam on which a foot rests."""

Start = Literal["rest", "steady"]
"""Initial state of a motion. rest: at rest, with the static deflection under a slider. steady: steady state under the
drive."""

DriveKind = Literal["force", "moment", "displacement", "voltage", "current"]
DRIVE_UNITS = {"force": "N", "moment": "N m", "displacement": "m", "voltage": "V", "current": "A"}
"""Kind of a drive. force, moment: imposed forces, N, and moments, N m. displacement: imposed displacements, m.
voltage, current: of actuators, V and A."""

Reference = Literal["closed form", "independent method", "published", "other code", "regression"]
"""Reference of a gate's expected value. closed form: a formula. independent method: another derivation. published: a
publication. other code: another program. regression: an earlier value of this package."""
