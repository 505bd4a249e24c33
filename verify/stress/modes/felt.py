"""What links feel of bodies, riders and drives, and what drives feel of them: weights, matrices, sizes, names."""

from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.errors import ResonanceError
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import ANY, FORCES, MASSES, PLAIN, SECTIONS
from verify.stress.references.beams import COUPLE, STRIP, held

# --- Bodies -----------------------------------------------------------------------------------------------------------

LINKS = 13
MIRRORED = {"pinned": ((1, 3), (1, 3)), "guided": ((0, 2), (0, 2, 4))}
"""Powers of the distance that go on beyond such an end as deflections and slopes there do."""


def _read(j: Array, at: float, power: int) -> tuple[Array, float, float]:
    """Of w = x^p on links of length 1: what joints have of it, w - w'' / 12, and w and w' at a place."""
    bend = power * (power - 1) * j ** max(power - 2, 0)
    return j**power - bend / 12.0, at**power, power * at ** max(power - 1, 0)


def bodies_error(share: float) -> float:
    """Of deflection and slope read off joints for a body: of powers, and of what a body feels of itself.

    Places are a share of a link from both ends, and inside; powers are told from the nearer end.
    """
    from verify.segments.assembly import build_chain
    from verify.segments.attached import felt_at

    worst, j = 0.0, np.arange(LINKS + 1.0)
    apart = abs(np.subtract.outer(j, j))
    bends = (apart**3 - apart) / 12.0
    for pair in (("pinned", "guided"), ("clamped", "free"), ("guided", "pinned"), ("free", "clamped")):
        chain = build_chain(held(*pair), LINKS)
        for link in (0, 1, 2, 6, LINKS - 2, LINKS - 1):
            at = link + share
            f, h = (one[0] for one in felt_at(chain, [at * chain.unit], "reciprocal"))
            left = at < 0.5 * LINKS
            near = at if left else LINKS - at
            if not near:
                continue
            support, own = pair[0 if left else 1], (f, h) if left else (f[::-1], h[::-1])
            reached = near < 4.0
            values, slopes = MIRRORED.get(support, (range(4), range(5))) if reached else (range(4), range(5))
            for powers, reads, weights in ((values, 1, own[0]), (slopes, 2, own[1])):
                for power in powers:
                    joints, *exact = _read(j, near, power)
                    seen = weights @ (joints if reads == 1 else np.diff(joints))
                    worst = largest(worst, abs(float(seen) - exact[reads - 1]) / max(near, 1.0) ** power)
            if near > 2.0 and (support not in MIRRORED or not reached):
                g = np.append(0.0, h) - np.append(h, 0.0)
                worst = largest(worst, *(abs(float(a @ bends @ b)) for a, b in ((f, f), (g, g), (f, g))))
    return worst


def unlike_error(share: float) -> float:
    """Of a parabola and its slope read off links that are not alike, and off a joint by the lever rule."""
    from verify.segments.assembly import build_chain
    from verify.segments.attached import felt_at

    beam = held("clamped", "free")
    chain = build_chain(beam, LINKS, grading=6.0)
    nodes, worst = chain.nodes, 0.0
    for link in (1, 5, LINKS - 2):
        at = float(nodes[link] + share * (nodes[link + 1] - nodes[link]))
        turned = felt_at(chain, [at], "reciprocal")[1][0]
        tilts = np.diff((nodes - 0.1) ** 2) / np.diff(nodes)
        worst = largest(worst, abs(float(turned @ tilts) / (2.0 * (at - 0.1)) - 1.0))
        (weights,), (turned,) = felt_at(chain, [at], "lever")
        worst = largest(worst, abs(float(weights @ nodes) / at - 1.0), abs(float(turned[link]) - 1.0))
        (weights,), (turned,) = felt_at(chain, [float(nodes[link])], "lever")
        off = float(abs(turned[link - 1 : link + 1] - 0.5).max())
        worst = largest(worst, float(off), abs(float(weights[link]) - 1.0), abs(float(turned.sum()) - 1.0))
    return worst


THICK = replace(
    PLAIN,
    section=SECTIONS,
    mass=(PointMass(position=0.0, mass=0.02, rotary_inertia=1e-5), *MASSES),
    spring=(PointSpring(position=0.12, stiffness=150.0, rotational=2.1), PointSpring(position=0.61, rotational=1.3)),
    foundation=900.0,
    supports=("free", "free"),
)
LOADED: tuple[tuple[Beam, dict[str, Any]], ...] = (
    (THICK, {"theory": "timoshenko", "joints": "tensioned"}),
    (ANY[0][0], {"joints": "tensioned"}),
    (replace(THICK, tension=3.0, supports=("pinned", "free"), mass=MASSES), {}),
)


def matrices_error(number: float) -> float:
    """Of the large sparse matrices of a loaded chain, against what its strains and masses say of one motion."""
    from verify.segments.assembly import build_chain, chain_pencil

    beam, settings = LOADED[int(number)]
    pencil = chain_pencil(build_chain(beam, 260, **settings))
    motion = np.sin(np.arange(1.0, pencil.n + 1.0) * 0.37)[:, None] + 0.3
    strains = pencil.strain(motion)
    off = abs(pencil.strain_matrix() @ motion - strains).max() / abs(strains).max()
    assert pencil.masses is not None
    carried = (motion.T @ (pencil.mass_matrix() @ motion)).item()
    return largest(float(off), float(abs(carried / pencil.masses(motion)[0] - 1.0)))


def rider_error(hertz: float) -> float:
    """Of both sizes by which a damped chain under three loads out of phase feels a slider, by dense matrices."""
    from dataclasses import replace as changed

    from verify.chain.ride import coupling_on_chain
    from verify.chain.system import LinkLoad, build_system
    from verify.slider import Slider
    from verify.stress.references.dense import Reciprocal

    dashpot, worst = 0.013, 0.0
    for pair in (("clamped", "free"), ("pinned", "pinned")):
        beam = replace(STRIP, supports=pair)
        own, link = Reciprocal(beam, np.linspace(0.0, beam.length, LINKS + 1)), beam.length / LINKS
        system = build_system(beam, LINKS, FORCES, hertz, load="reciprocal", joint_dashpot=dashpot)
        more = LinkLoad(link=5, at=0.3 * link, force=(0.2, 1.9), moment=0.07, frequency_hz=hertz, phase_deg=131.0)
        slider = Slider(mass=0.004, mu=0.3, position=0.37, coupling="one-way")
        found: Any = coupling_on_chain(changed(system, loads=(*system.loads, more)), beam, slider)
        turned, lever = np.exp(1j * np.deg2rad(131.0)), np.zeros(LINKS + 1)
        lever[4:6] = np.array([0.7, 0.3]) * 1.9 + np.array([-1.0, 1.0]) * 0.07 / link
        dashpots = dashpot * own.bend.T @ own.bend
        driven = own.under(own.load(FORCES) + turned * lever, hertz, 0.0, dashpots)
        slope = own.read(driven, np.array([0.37]), 1)[0]
        alone = own.read(own.under(own.load((PointForce(position=0.37),)), hertz, 0.0, dashpots), np.array([0.37]), 0)
        omega, half = 2.0 * pi * hertz, 0.5 * float(STRIP.thickness or 0.0)
        step = 0.04 * link  # all on one link
        couple = [PointForce(position=0.37 + at * step, amplitude=weight / step) for at, weight in COUPLE]
        turns = own.read(own.under(own.load(couple), hertz, 0.0, dashpots), np.array([0.37]), 1)[0]
        given = 0.3 * slider.normal_force * half**2 * omega * abs(turns)
        sizes = (given / (half * omega * abs(slope)), 0.004 * omega**2 * abs(alone[0]))
        pairs = zip((found.friction_size, found.normal_size), sizes, strict=True)
        worst = largest(worst, *(abs(one / exact - 1.0) for one, exact in pairs))
    return worst


def flutter_error(gyration: float) -> float:
    """Of squares of two masses on springs that push, held up by turning, and whether they flutter where they do.

    With s = omega^2: s^2 - (a + b + g^2) s + a b = 0, and flutter between |sqrt(-a) - sqrt(-b)| and their sum.
    """
    from verify.chain.small_motion import Linearisation
    from verify.errors import InputError

    a, b, worst = -2.3, -0.7, 0.0
    edge = sqrt(2.3) + sqrt(0.7)
    for scale in (1.0, 3e4):
        for g, stands in ((edge * (1.0 + gyration), True), (edge * (1.0 - gyration), False)):
            skew = g * scale * np.array([[0.0, 1.0], [-1.0, 0.0]])
            springs = np.diag([a, b]) * scale**2
            one = Linearisation(np.eye(2), np.zeros((2, 2)), springs, np.zeros((0, 2)), skew)
            try:
                found = one.squares() / scale**2
            except InputError as error:
                worst = largest(worst, float(stands or "flutters at" not in str(error)))
                continue
            total = a + b + g**2
            root = sqrt(max(total**2 - 4.0 * a * b, 0.0))
            exact = 0.5 * np.array([total - root, total + root])
            worst = largest(worst, float(not stands), float(abs(found / exact - 1.0).max()))
    return worst


# --- Drives -----------------------------------------------------------------------------------------------------------


def named_error(count: float) -> float:
    """How many resonances of small models are driven, alone or in a sweep, without the name of their mode."""
    from verify.models.catalogue import MODELS

    n, wrong = int(count), 0
    for model in ("segment", "fem"):
        for pair in (("free", "free"), ("pinned", "free"), ("clamped", "free"), ("guided", "pinned")):
            beam = held(*pair)
            for mode in (1, n - 1):
                hertz = float(MODELS[model].solve_modes(beam, n - 1, n).frequencies_hz[mode - 1]) * (1.0 + 3e-10)
                wrong += not _names(mode, "frequency_hz", MODELS[model].solve_harmonic, beam, hertz, n)
                swept = np.array([0.3 * hertz, hertz])
                wrong += not _names(mode, "frequencies_hz[1]", MODELS[model].sweep_harmonic, beam, swept, n)
    return float(wrong)


def _names(mode: int, field: str, solve: Any, beam: Beam, hertz: Any, n: int) -> bool:
    """Whether a field is refused in a sentence on that mode, and on how far it lies, 3e-10 of it."""
    try:
        solve(beam, (PointForce(position=0.11), PointForce(position=0.37, phase_deg=50.0)), hertz, n)
    except ResonanceError as error:
        said = f" lies 3.0e-10 (relative) from the undamped resonance of mode {mode} of"
        return str(error).startswith(f"{field} = ") and said in str(error)
    return False


def wavenumber_error(hertz: float) -> float:
    """Of wavenumbers by every theory, with loss, tension and ground, against rates of states; of a unit answer.

    And of waves that travel, of which there are none below what a foundation lets by.
    """
    from verify.models.fields import travelling_wavenumber, unit_response, wavenumber
    from verify.stress.modes.any_beam import States

    worst, bare = 0.0, replace(PLAIN, supports=("pinned", "pinned"))
    cases = [(bare, theory) for theory in ("euler-bernoulli", "rayleigh", "timoshenko")]
    cases += [(replace(bare, tension=70.0, foundation=0.2), "euler-bernoulli")]
    cases += [(replace(bare, foundation=0.2), "timoshenko"), (replace(bare, foundation=1e9), "euler-bernoulli")]
    for beam, theory in cases:
        for loss in (0.0, 0.037):
            lossy = replace(beam, loss_factor=loss)
            k = wavenumber(lossy, hertz, theory)
            rates = np.linalg.eigvals(States(lossy, theory, (2.0 * pi * hertz) ** 2).rates[0]) / lossy.length
            worst = largest(
                worst,
                float(abs(rates + 1j * k).min() / abs(k)),
                float(k.imag > 0.0 or k.real < 0.0 or not (k.real or beam.foundation > 1.0)),
            )
            own, told = wavenumber(beam, hertz), travelling_wavenumber(lossy, hertz)
            travels = beam.mass_per_length * (2.0 * pi * hertz) ** 2 > beam.foundation
            worst = largest(worst, float(told is not None) if not travels else abs((told or 0.0) / own - 1.0))
    reach = min(sqrt(bare.wave_constant / (2.0 * pi * hertz)), bare.length)
    return largest(worst, abs(unit_response(bare, hertz) / (reach**3 / bare.bending_stiffness) - 1.0))


def reciprocal_error(hertz: float) -> float:
    """Of what a force at a place feels of a beam that is driven in time, against what is read there.

    Of exact modes with those that are cut off, and of elements; a steady field, alone and with free modes.
    """
    from verify.exact.harmonic import solve_harmonic
    from verify.models.catalogue import MODELS
    from verify.motion.surface import Growth, cut, stages_from_rest, steady_stage

    beam, worst = replace(PLAIN, supports=("clamped", "free")), 0.0
    bases = [MODELS["analytic"].time_basis(beam, None, 5, "spline"), MODELS["fem"].time_basis(beam, LINKS, 5, "spline")]
    pieces = [Growth(cut(0.01, 1e-3, 2), np.array([0.0, 0.3, 0.7]))]
    stages = [stages_from_rest(basis, FORCES, 2.0 * pi * hertz, 0.02, pieces, 0.003)[0] for basis in bases]
    field = solve_harmonic(replace(beam, loss_factor=0.04), FORCES, hertz)
    stages += [steady_stage(field, pieces[0].steps, 0.0, basis, 0.02) for basis in (None, bases[0])]
    for stage in stages:
        for at in (0.05, 0.29, 0.57):
            read = stage.rows(np.array([at]))[:, 0]
            worst = largest(worst, float(abs(stage.load_rows(at) - read).max() / abs(read).max()))
    return worst


ROWS: tuple[Row, ...] = (
    Floor(
        id="bodies-on-joints",
        title="Deflection and slope read off joints for a body: powers, mirrored at ends, and what it feels of itself",
        why="segments/attached.py: right for powers to the third and the fourth, no force on itself, to rounding.",
        along="link",
        at=(0.0, 0.31, 0.77),
        promise=1e-11,
        error=bodies_error,
    ),
    Floor(
        id="bodies-on-unlike-links",
        title="Slope of a parabola read off links that are not alike, and the lever rule on and beside a joint",
        why="segments/attached.py: straight between middles of links, to rounding.",
        along="link",
        at=(0.2, 0.6),
        promise=1e-13,
        error=unlike_error,
    ),
    Floor(
        id="matrices-of-loaded-chains",
        title="Sparse matrices of three loaded chains, slipping ones too, against the strains and mass of one motion",
        why="segments/loaded.py: two ways of saying the same, to rounding.",
        along="chain",
        at=(0, 1, 2),
        promise=1e-13,
        error=matrices_error,
    ),
    Floor(
        id="riders-felt",
        title="Both sizes by which a damped chain under loads out of phase feels a slider, by dense matrices",
        why="chain/ride.py: the chain at rest, straight and steady; a base that is nearly free loses four digits.",
        along="Hz",
        at=(3.1, 67.0, 431.0),
        promise=1e-10,
        error=rider_error,
    ),
    Floor(
        id="flutter-where-it-is",
        title="Two masses on springs that push, held up by turning: squares, and flutter below a rate and not above",
        why="chain/small_motion.py: roots of a quadratic; flutter between two rates in closed form.",
        along="of the rate",
        at=(1e-3, 1e-2, 0.3),
        promise=1e-12,
        error=flutter_error,
    ),
    Floor(
        id="resonances-by-name",
        title="Resonances of small models, free ones too, driven alone and in a sweep without their mode's name",
        why="models/driven_pencil.py: refused closer than 1e-9, with the nearest mode.",
        along="parts",
        at=(5,),
        promise=0.5,
        error=named_error,
    ),
    Floor(
        id="wavenumbers-by-states",
        title="Wavenumbers by three theories, with loss, tension and ground, and which travel; a unit answer",
        why="models/fields.py: roots of a quadratic, to rounding, against rates of states.",
        along="Hz",
        at=(0.3, 3.1, 67.0, 431.0),
        promise=1e-13,
        error=wavenumber_error,
    ),
    Floor(
        id="felt-as-read",
        title="What a force feels of a driven beam in time, modes that are cut off too, against what is read there",
        why="motion/surface.py: reciprocal; loads and shapes are the same numbers.",
        along="Hz",
        at=(31.0, 431.0),
        promise=1e-13,
        error=reciprocal_error,
    ),
)
