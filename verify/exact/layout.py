"""The layout of a beam, dimensionless: spans of one section, and stations between them.

Every span obeys, for the state deflection w, rotation psi, moment M and transverse force V,

    w' = psi - V / (kappa G A),  psi' = M / EI,  M' = V + p psi,  V' = q w,
    p = T - rho I omega^2,  q = rho A omega^2 - k_f,

with tension T and foundation k_f: Euler-Bernoulli theory for 1 / (kappa G A) = rho I = 0, Rayleigh theory for
1 / (kappa G A) = 0, else Timoshenko theory. V = EI w''' - T w' balances the attachments: across a point mass or spring
V decreases by (k - m omega^2) w and M increases by (k_r - J omega^2) psi.
"""

from collections.abc import Sequence
from functools import lru_cache
from itertools import accumulate, pairwise
from typing import NamedTuple

import msgspec

from verify.problem.beam import Beam
from verify.problem.device import Device
from verify.problem.point_attachments import Attachment

SAME_PLACE = 1e-12  # Distance, relative to the beam's length, below which two positions are one station
HELD = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
"""Indices of w, psi, M, V that a support sets to zero."""


class UniformSpan(NamedTuple):
    """A span of one section, relative to the beam's own L, EI and rho A."""

    length: float
    stiffness: float  # EI
    mass: float  # rho A
    compliance: float  # 1 / (kappa G A), times EI / L^2 of the beam; 0 without shear
    rotary: float  # rho I, over rho A L^2 of the beam; 0 without rotary inertia


class Station(NamedTuple):
    """Attachments at one position, relative to the beam's own L, EI and rho A."""

    stiffness: float = 0.0
    rotational: float = 0.0
    mass: float = 0.0
    inertia: float = 0.0
    dashpot: float = 0.0  # Relative to EI / L^3 per dimensionless frequency; `rotational_dashpot` relative to EI / L
    rotational_dashpot: float = 0.0
    support: str = "free"
    """Support at the station: "pinned" prevents the deflection, "guided" the rotation, "clamped" both."""


class BeamLayout(msgspec.Struct, frozen=True, kw_only=True):
    """Spans and stations of a beam."""

    supports: Sequence[str]
    spans: tuple[UniformSpan, ...]  # n spans from the left
    stations: tuple[Station, ...]  # (n + 1): at the left end, between spans, at the right end
    tension: float  # T L^2 / EI
    foundation: float  # k_f L^4 / EI

    @property
    def positions(self) -> tuple[float, ...]:
        """Positions of the stations, x / L."""
        return tuple(accumulate((span.length for span in self.spans), initial=0.0))

    @property
    def plain(self) -> bool:
        """Whether it is a uniform Euler-Bernoulli beam without attachments and axial force."""
        bare = set(self.stations) == {Station()} and not (self.tension or self.foundation)
        return bare and all(span[1:] == (1.0, 1.0, 0.0, 0.0) for span in self.spans)

    def station_at(self, xi: float) -> int:
        """Index of the station nearest to x / L."""
        positions = self.positions
        return min(range(len(positions)), key=lambda i: abs(positions[i] - xi))


@lru_cache(maxsize=256)
def layout_of(
    beam: Beam, theory: str = "euler-bernoulli", also: tuple[float, ...] = (), devices: tuple[Device, ...] = ()
) -> BeamLayout:
    """The layout of a beam with devices by a theory; `also`: additional stations, m."""
    attached: tuple[Attachment | Device, ...] = (*beam.attached, *devices)
    cuts = [*(part.position for part in attached), *also]
    length, stiffness, mass = beam.length, beam.bending_stiffness, beam.mass_per_length
    spans, start = list[UniformSpan](), 0.0
    for piece in beam.pieces:
        ends, room = [0.0], SAME_PLACE * length  # a cut closer to its neighbour, or to an end, is the same station
        for cut in sorted(cut - start for cut in cuts):
            if ends[-1] + room < cut < piece.length - room:
                ends.append(cut)
        compliance = 1.0 / piece.shear_stiffness if theory == "timoshenko" and piece.shear_stiffness else 0.0
        rotary = (piece.rotary_inertia or 0.0) if theory != "euler-bernoulli" else 0.0
        properties = (
            piece.bending_stiffness / stiffness,
            piece.mass_per_length / mass,
            compliance * stiffness / length**2,
            rotary / mass / length**2,
        )
        spans += [UniformSpan((end - begin) / length, *properties) for begin, end in pairwise([*ends, piece.length])]
        start += piece.length
    layout = BeamLayout(
        supports=beam.supports,
        spans=tuple(spans),
        stations=(Station(),) * (len(spans) + 1),
        tension=beam.tension * length**2 / stiffness,
        foundation=beam.foundation * length**4 / stiffness,
    )
    across, around, rate = length**3 / stiffness, length / stiffness, beam.wave_constant / length**2
    scales = (
        ("stiffness", across),
        ("rotational", around),
        ("mass", 1.0 / (mass * length)),
        ("rotary_inertia", 1.0 / (mass * length**3)),
        ("dashpot", across * rate),
        ("rotational_dashpot", around * rate),
    )
    stations = [Station._make((*(getattr(part, n, 0.0) * scale for n, scale in scales), "free")) for part in attached]
    return with_stations(layout, [(part.position / length, at) for part, at in zip(attached, stations, strict=True)])


def with_stations(layout: BeamLayout, added: Sequence[tuple[float, Station]]) -> BeamLayout:
    """The layout with attachments (x / L, station) added to its stations; supports at an end are combined."""
    stations, supports = list(layout.stations), list(layout.supports)
    for xi, more in added:
        at = layout.station_at(xi)
        here = stations[at]
        sums = {name: getattr(here, name) + getattr(more, name) for name in Station._fields[:-1]}
        stations[at] = Station(**sums, support=_both(here.support, more.support))
    for end in (0, -1):
        supports[end] = _both(supports[end], stations[end].support)
        stations[end] = stations[end]._replace(support="free")
    return msgspec.structs.replace(layout, supports=tuple(supports), stations=tuple(stations))


def _both(first: str, second: str) -> str:
    """The support that prevents the motions of both supports."""
    deflection, rotation = ({first, second} & {prevents, "clamped"} for prevents in ("pinned", "guided"))
    return "clamped" if deflection and rotation else "pinned" if deflection else "guided" if rotation else "free"
