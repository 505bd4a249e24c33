"""Plausibility warnings: values that look like another unit, gates that accept any negative error."""

from collections.abc import Iterator

import numpy as np

from verify.errors import InputError
from verify.fem_beam import HermiteModel
from verify.linear.mesh import cut_pieces
from verify.problem.beam import Beam
from verify.problem.cross_section import Piece
from verify.problem.slider import GRAVITY
from verify.scene.model import Scene

SOUND = (30.0, 30_000.0)  # sqrt(E/rho) of materials, soft rubber to diamond, m/s
MAX_DENSITY = 25_000.0  # above osmium, kg/m^3
MAX_WIDTH = 5.0  # of a strip over its length
MAX_MASS = 1e8  # kg, above any bridge's; a beam in millimetres read as metres has 1e9 times its mass
LONG = 5.0  # m; no beam in millimetres is shorter than this when read as metres
SMALL_DEFLECTION = 0.1  # over the beam's length
ELEMENTS = 50  # of that sag, which is exact at the nodes of any number


def scene_warnings(scene: Scene) -> tuple[str, ...]:
    """A sentence for each value that looks like another unit, and for each gate without a limit of negative errors."""
    beam = scene.beam
    material = dict.fromkeys(text for piece in beam.pieces for text in _material(piece))
    one_sided = (
        f"gate {gate.id}: at_most alone accepts any negative value: give at_least too, or expect and within"
        for gate in scene.gate
        if gate.at_most is not None and gate.at_least is None
        if gate.quantity.endswith("error") and not gate.quantity.endswith(("shape_error", "curvature_error"))  # norms
    )
    return (*material, *_lengths(beam), *one_sided)


def _material(piece: Piece) -> Iterator[str]:
    if piece.youngs_modulus is None or not piece.area:
        return
    density = piece.mass_per_length / piece.area
    speed = (piece.youngs_modulus / density) ** 0.5
    if not SOUND[0] <= speed <= SOUND[1]:
        yield (
            f"beam.youngs_modulus = {piece.youngs_modulus:.6g} Pa and beam.density = {density:.6g} kg/m³ give a speed "
            f"of sound of {speed:.3g} m/s: check the units (206 GPa is 206e9, 7.85 g/cm³ is 7850)"
        )
    elif density > MAX_DENSITY:
        yield f"beam.density = {density:.6g} kg/m³ is above that of any solid: check the unit (7.85 g/cm³ is 7850)"


def _lengths(beam: Beam) -> Iterator[str]:
    """Thicker or much wider than long, too heavy, or bent by its own weight by more than its length."""
    sections = [(2.0 * piece.extreme_fibre, piece.area) for piece in beam.pieces if piece.extreme_fibre and piece.area]
    thickness = max((height for height, _ in sections), default=0.0)
    width = max((area / height for height, area in sections), default=0.0)
    mass = sum(piece.mass_per_length * piece.length for piece in beam.pieces)
    if thickness > beam.length:
        yield f"beam: {thickness:.3g} m thick and {beam.length:.3g} m long, check the units (2 mm is 0.002)"
    elif width > MAX_WIDTH * beam.length:
        yield f"beam: {width:.3g} m wide and {beam.length:.3g} m long, check the units (20 mm is 0.02)"
    if beam.length < LONG:
        return
    if mass > MAX_MASS:
        yield f"beam: a mass of {1e-3 * mass:.3g} t, check the units (137 mm is 0.137)"
    elif (sag := static_sag(beam)) > SMALL_DEFLECTION * beam.length:
        yield f"beam: its own weight bends {beam.length:.3g} m by {sag:.3g} m, check the units (137 mm is 0.137)"


def static_sag(beam: Beam) -> float:
    """Largest deflection of a horizontal beam under its own weight and that of attached masses, m.

    By finite elements with sections, springs, foundation and axial force. 0 for a beam with rigid motions, and for one
    that buckles.
    """
    if beam.rigid_motions:
        return 0.0
    model = HermiteModel(beam, max(ELEMENTS, len(cut_pieces(beam))))
    parts = model.mesh
    middles, halves = 0.5 * (parts.nodes[1:] + parts.nodes[:-1]), 0.5 * parts.lengths
    # two Gauss points integrate the product of a constant load and a cubic
    x = np.concatenate([middles - halves / 3**0.5, middles + halves / 3**0.5]) * model.unit
    weight = GRAVITY * beam.mass_per_length * model.unit * np.tile(halves * parts.masses_per_length, 2)
    x = np.append(x, [attachment.position for attachment in beam.attached])
    weight = np.append(weight, [GRAVITY * attachment.mass for attachment in beam.attached])
    loads = model.load_rows(x).T @ weight[:, None] * (model.unit**3 / beam.bending_stiffness)
    try:
        with np.errstate(all="ignore"):  # sections may differ by more than double precision holds
            unknowns = model.stable_system.harmonic(loads, 0.0)
    except (InputError, np.linalg.LinAlgError):
        return 0.0
    return float(abs(model.line(unknowns)(np.minimum(parts.nodes * model.unit, beam.length), 0)).max())
