"""The words that a scene, a script or a command line may choose among: each list once, plain values."""

from typing import Literal, get_args

Support = Literal["pinned", "clamped", "free", "guided"]
SUPPORTS: tuple[str, ...] = get_args(Support)
"""An end of a beam. pinned: it does not move. clamped: nor turn. free: nothing holds it. guided: it does not turn."""

Shape = Literal["rectangle", "round", "tube"]
SHAPES: tuple[str, ...] = get_args(Shape)
"""A beam's section. rectangle: width and thickness. round: a diameter. tube: a diameter and a wall_thickness."""

Theory = Literal["euler-bernoulli", "rayleigh", "timoshenko"]
THEORIES: tuple[str, ...] = get_args(Theory)
"""What of a beam's thickness counts. euler-bernoulli: nothing. rayleigh: its rotary inertia. timoshenko: shear too."""

Wall = Literal["gregory", "half", "welded", "third-order", "five-joint"]
WALLS: tuple[str, ...] = get_args(Wall)
"""How a chain is held at a clamped end, by the weights of its joints from the wall on (`segments.walls`).

gregory: 3/8, 7/6, 23/24, frequencies of order 4. half: the literature's k = 2EI/l, order 2. welded: half a segment is
part of the wall, order 2. third-order: 5/12, 13/12. five-joint: order 4 and a little more for low modes.
"""

Joints = Literal["series", "printed", "tensioned"]
JOINTS: tuple[str, ...] = get_args(Joints)
"""The spring between two links. series: the paper's Eq. (1), two half links in a row. printed: with its indices as they
stand. tensioned: series less T l/12 under a tension T, and thickness inertia likewise less where joints bend: order 4
under axial force, in Rayleigh's and in Timoshenko's theory."""

Attachment = Literal["reciprocal", "lever"]
ATTACHMENTS: tuple[str, ...] = get_args(Attachment)
"""A point mass or spring on a chain. reciprocal: felt by four joints, order 4. lever: as it sits on its rigid link."""

Load = Literal["reciprocal", "lever"]
LOADS: tuple[str, ...] = get_args(Load)
"""A point force on a chain. reciprocal: shared among four joints, order 4. lever: between a link's two, order 2."""

Reading = Literal["corrected", "raw", "links"]
READINGS: tuple[str, ...] = get_args(Reading)
"""A steady chain between its joints. corrected: the spline through y + delta^2 y / 12. raw: the spline through y.
links: the straight links themselves."""

Line = Literal["spline", "raw"]
LINES: tuple[str, ...] = get_args(Line)
"""A chain's contact line. spline: the paper's C2 spline (Section II.B). raw: the links' own straight edges."""

Links = Literal["rigid", "stretching"]
LINKS: tuple[str, ...] = get_args(Links)
"""What a nonlinear chain is made of. rigid: the paper's links. stretching: bars of the beam's own EA / l."""
OF_THE_CHAIN = ("chain", "chain_force", "links", "places")
"""Keys of [motor] that its runs on the nonlinear chain alone have."""

Inertia = Literal["full", "transverse", "elastic"]
"""Of a chain's links along x. full: rigid links. transverse: rigid links without any. elastic: links that stretch."""

Tip = Literal["free", "roller"]
TIPS: tuple[str, ...] = get_args(Tip)
"""The far end of a nonlinear chain. free: nothing holds it. roller: it keeps y = 0 and moves along x."""

Law = Literal["tanh", "coulomb"]
"""Friction. tanh: the paper's Eq. (3), which never sticks. coulomb: mu N against the motion, with true sticking."""

CouplingChoice = Literal["auto", "one-way", "two-way"]
"""auto: its size decides whether a beam feels its slider. one-way: it does not. two-way: it does."""

Kinematics = Literal["tangential", "following"]
"""tangential: m dv/dt = F and dx/dt = v. following: the path of a point that follows the surface exactly."""

NormalChoice = Literal["held", "massless"]
"""What a slider coupled two-way presses its beam with. held: weight and inertia. massless: nothing, as in the paper."""

Face = Literal["upper", "lower"]
"""Of the beam, on which a foot is pressed. upper: from above, weight and preload together. lower: from below."""

Start = Literal["rest", "steady"]
"""How a beam stands when its motion begins. rest: still, and straight but for the sag under a slider held on it.
steady: in the steady state of its drive."""

DriveKind = Literal["force", "displacement"]
"""What a drive imposes. force: newtons. displacement: metres, by the forces that it takes."""

BenchSet = Literal["modes", "harmonic", "transient", "slider", "chain"]
"""What a bench compares methods in. modes: natural frequencies. harmonic: the steady field under the drive. transient:
the linear beam in time. slider: its displacement on that beam. chain: the nonlinear chain from rest."""

Reference = Literal["closed form", "independent method", "published", "other code", "regression", "promise", "refusal"]
REFERENCES: tuple[str, ...] = get_args(Reference)
"""What stands behind a gate's expectation, or its bound. closed form: a formula. independent method: another derivation
of the figure. published: a publication. other code: another program. regression: this suite itself, once. promise: what
this suite says of its own error or cost, held against the source. refusal: what it says that it refuses."""
Exported = Literal["modes", "field", "motion", "tables"]
EXPORTED: tuple[str, ...] = get_args(Exported)
"""What a scene gives to other tools. modes: shapes and frequencies. field: the steady answer to the drive. motion: the
beam in time, with its slider. tables: those that a run prints."""

FileFormat = Literal["vtu", "pvd", "xdmf", "csv", "json", "npz", "tex"]
FILE_FORMATS: tuple[str, ...] = get_args(FileFormat)
"""How that is written. vtu: one mesh of VTK. pvd: a series of them. xdmf: a series in one file. csv: a table. json: all
of it as text. npz: arrays of numpy. tex: tables for LaTeX."""

Pictured = Literal["modes", "wave", "slider", "chain"]
PICTURED: tuple[str, ...] = get_args(Pictured)
"""What is drawn. modes: one shape, segments above elements. wave: the driven beam over a period. slider: its run with
the force on it. chain: a nonlinear chain rolled up, at true scale."""
