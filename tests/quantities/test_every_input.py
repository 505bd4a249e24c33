"""Every input of every quantity moves its figure, is refused by name, or stands in one table with the reason.

Inputs are generated from the types: every field of the scene's beam, sections, drive, slider and motion, of what it
asks for, and every argument. Each is turned alone, in every case below; nothing may be dropped in silence.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import cache
from typing import Any, Literal, get_args, get_origin

import msgspec
import pytest
from msgspec.structs import replace

from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities.catalogue import QUANTITIES, among_of, arguments_of, evaluate
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type

FORCES = [
    {"position": 0.0411, "measured_from": "left", "amplitude": 1.3, "phase_deg": 17.0},
    {"position": 0.0573, "measured_from": "right", "amplitude": 0.8, "phase_deg": 101.0},
]
BASE: dict[str, Any] = {
    "name": "every-input",
    "beam": {
        "length": 0.73,
        "width": 0.031,
        "thickness": 0.0023,
        "youngs_modulus": 113e9,
        "density": 4470.0,
        "supports": ["pinned", "pinned"],
        "loss_factor": 0.021,
    },
    "drive": {"frequency_hz": 731.0, "kind": "force", "force": FORCES},
    "spectrum": {},
    "convergence": {},
    "sensitivity": {"mode": 3},
    "wave": {},
    "slider": {"mass": 3e-6, "mu": 0.23, "slope": 310.0, "position": 0.271, "speed": 0.004, "preload": 0.003},
    "motion": {"duration": 1.1e-3, "soft_start_periods": 0.3, "modal_damping": 0.013, "steps_per_period": 40},
    "claim": [
        {
            "id": "a",
            "source": "Rossi 1987, page 3",
            "quantity": "slider.displacement",
            "value": "negative",
            "read": "stated",
        },
        {
            "id": "b",
            "source": "Rossi 1987, Figure 7",
            "quantity": "mode.frequency",
            "arguments": {"model": "analytic", "mode": 3},
            "value": 211.0,
            "tolerance": 0.5,
            "read": "figure",
        },
    ],
    "gate": [{"id": "g", "quantity": "mode.frequency", "at_least": 1.0, "why": "it asks"}],
}
READINGS = {
    "kinematics": ["tangential"],
    "normal": ["held"],
    "soft_start_periods": [0.3, 0.0],
    "forces": [1.3, 2.9],
    "mu": [0.23, 0.41],
    "slope": [310.0, 470.0],
    "positions": [0.271, 0.313],
    "saturation": 0.023,
    "count": 11,
    "duration": 9e-4,
}
"""Not in BASE: they want forces that are imposed, and would refuse the other kind for everybody."""
STEP = [{"length": 0.31}, {"length": 0.42, "width": 0.027, "thickness": 0.0019, "youngs_modulus": 97e9, "density": 5e3}]


@dataclass(frozen=True)
class Case:
    """One way to ask for a figure: arguments, and what the scene has other than BASE."""

    arguments: dict[str, Any]
    scene: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Asked:
    """A case of one quantity, whole."""

    quantity: str
    arguments: dict[str, Any]
    scene: dict[str, Any]

    def __str__(self) -> str:
        given = ",".join(f"{k}={v}" for k, v in self.arguments.items())
        return f"{self.quantity}({given})"


def stepped(*supports):
    return {"beam": {"section": STEP, "supports": list(supports)}}


def on(*supports):
    return {"beam": {"supports": list(supports)}}


STANDING = {
    "mass": [
        {"position": 0.213, "mass": 0.047, "rotary_inertia": 3.1e-5},
        {"position": 0.73, "mass": 0.071, "rotary_inertia": 5.3e-5},
    ],
    "spring": [{"position": 0.527, "stiffness": 930.0, "rotational": 2.3}],
}
CARRIED = {"beam": {**STANDING, "supports": ["clamped", "free"], "tension": 7.1, "foundation": 1900.0}}
"""Everything that stands on a beam and pulls at it."""
SPRUNG = {"beam": {**STANDING, "supports": ["clamped", "free"]}}
ELASTIC = {
    "beam": {
        "supports": ["free", "pinned"],
        "mass": [{"position": 0.213, "mass": 0.047, "rotary_inertia": 3.1e-5}],
        "spring": [{"position": 0.0, "stiffness": 4100.0, "rotational": 31.0}],
    }
}
"""In a clamp that gives."""
PLAIN = {
    "beam": {
        "width": None,
        "thickness": None,
        "youngs_modulus": None,
        "density": None,
        "bending_stiffness": 3.7,
        "mass_per_length": 0.31,
        "rotary_inertia": 1.9e-7,
        "shear_stiffness": 2.3e5,
        "supports": ["clamped", "free"],
    }
}
"""A section by its figures alone."""
THICK = {"theory": "timoshenko", "joints": "tensioned"}
STILL = {"beam": {"loss_factor": 0.0}}
ALIKE = {**STILL, "drive": {"force": [FORCES[0], {**FORCES[1], "amplitude": 1.2}]}}
"""Forces that make a wave which travels nearly alone."""
AT_ONCE = {**STILL, "motion": {"soft_start_periods": 0.0, "modal_damping": None}}
SHAKEN = {
    "drive": {"force": [{**force, "amplitude": 90.0 * force["amplitude"]} for force in FORCES]},
    "slider": {"speed": 3e-4, "slope": 2100.0, "mu": 0.003, "preload": 0.03, "mass": 1e-5},
    "motion": {"duration": 2.3e-3},
}
COULOMB = {
    **SHAKEN,
    "slider": {"preload": 0.03, "mass": 1e-5, "law": "coulomb", "mu": 0.0004, "mu_static": 0.0007, "speed": 0.0},
}
RISING = {**SHAKEN, "slider": {**SHAKEN["slider"], "slope": 3.0}, "motion": {"duration": 8.3e-4}}
"""Friction that is far from its limit and has not come to its largest yet."""
COARSE = {"motion": {"steps_per_period": 21, "duration": 6.1e-3}}
"""So that the step shows on a beam that its slider hardly moves."""
HEAVY = {"slider": {"mass": 0.02}}
STEADY = {"motion": {"start": "steady", "soft_start_periods": 0.0}}
RIDDEN = {
    **AT_ONCE,
    "drive": SHAKEN["drive"],
    "slider": {"mass": 1e-6, "mu": 0.003, "preload": 0.003, "speed": 3e-4, "slope": 2100.0},
    "motion": {**AT_ONCE["motion"], "duration": 7e-4, "steps_per_period": 40},
}
"""On a chain that moves enough to draw in, and does not feel the slider."""
DEVICED = {
    **dict.fromkeys(("motion", "spectrum", "convergence", "sensitivity", "wave")),
    "claim": [],
    "drive": {
        "device": [
            {
                "position": 0.083,
                "measured_from": "right",
                "stiffness": 910.0,
                "mass": 0.0071,
                "dashpot": 1.3,
                "rotational": 2.9,
                "rotary_inertia": 1.7e-5,
                "rotational_dashpot": 0.0113,
                "amplitude": 0.37,
                "phase_deg": 71.0,
            }
        ]
    },
}
"""A device with everything, in the steady state alone."""
HELD_BESIDE = {**DEVICED, "drive": {"device": [{**DEVICED["drive"]["device"][0], "position": 0.021}]}}
"""The same device behind another."""
TOUCHING = {
    "mass": 0.003,
    "mu": 0.23,
    "law": "coulomb",
    "position": 0.271,
    "speed": -1.3e-4,
    "preload": 0.31,
    "coupling": "one-way",
    "contact": {"stiffness": 6.1e4, "damping": 13.0},
}
ON_A_POINT = {"slider": TOUCHING}
"""On a spring and a dashpot that leave the beam for a part of every period."""
CLASPING = {
    "slider": {
        **TOUCHING,
        "law": "tanh",
        "slope": 2100.0,
        "preload": 0.71,
        "coupling": "two-way",
        "contact": {"stiffness": 6.1e4, "damping": 13.0},
        "foot": [
            {"length": 0.043, "points": 3, "offset": 0.0031, "mass": 0.0017, "inertia": 3.1e-7},
            {"length": 0.037, "points": 2, "offset": -0.0021, "face": "lower"},
        ],
        "preload_stiffness": 1700.0,
    }
}
"""A clasp of two feet that turn, under springs, on a beam that feels it."""
ON_A_LAYER = {
    "slider": {
        **TOUCHING,
        "mu": 0.017,
        "contact": {"layer_stiffness": 1.7e6, "layer_tangential_stiffness": 5.3e5, "damping": 13.0},
        "foot": [{"length": 0.043, "points": 4, "offset": 0.0031}],
    }
}
BETWEEN = {
    "slider": {
        **TOUCHING,
        "foot": [{"length": 0.043, "points": 3, "mirrored": True}],
        "contact": {"stiffness": 6.1e4, "damping": 13.0, "tangential_stiffness": 2.3e4},
    }
}
"""Between two beams."""
AWAY = {
    **ON_A_POINT,
    "beam": {"loss_factor": 0.31},
    "drive": {"force": [{**FORCES[0], "amplitude": 2.6}, {**FORCES[1], "amplitude": 0.07}]},
}
"""On a wave that runs away from one force and dies out, whatever is turned."""
TOLD = {"preload": 0.11, "stiffness": 6.1e4, "modal_damping": 0.157, "position": 0.047}
"""Given in place of the scene's, and so turned by a little alone."""
SMOOTHLY = {
    "slider": {
        **TOUCHING,
        "law": "tanh",
        "slope": 2100.0,
        "contact": {"stiffness": 6.1e4, "damping": 17.0},
    }
}
"""Friction without jumps, between which a speed would show nothing of what moves it."""
BOUNCING = {"slider": {**TOUCHING, "contact": {"restitution": 0.31}, "foot": [{"mass": 0.0019}]}}
"""A hard point."""
UNDER_WAY = {"slider": {**TOUCHING, "gravity": 0.13, "speed": 0.0, "foot": [{"mass": 0.0021}], "pull": -1.1e-4}}
"""So heavy along the beam that it takes its time."""
STEPPED = {"count": 12, "steps_per_period": 23}
ON_CRESTS = {"contact_half_angle": 1.1, "speed_ratio": 0.71, "steps_per_period": 32, "amplitude": 7.3e-6}
"""So high that the slope of the wave shows beside 1."""
FINELY = {"count": 12, "steps_per_period": 211, "speed": -3.7e-4}
"""So that shares of time, which are counted in steps, show what moves them."""
FEM, SEGMENT = {"model": "fem", "count": 9}, {"model": "segment", "count": 9}
SETTINGS = {"wall": "third-order", "grading": 1.3, "joints": "printed"}
FIELDS = ("standing_wave_ratio", "reflection", "envelope", "travelling_index", "signed_area_spread", "crest_speed")
CASES: dict[str, list[Case]] = {
    "stress.share": [Case({"row": "taut"})],
    "mode.frequency": [
        Case({"model": "analytic", "mode": 3}, on("clamped", "free")),
        Case(
            {"model": "analytic", "mode": 3, "theory": "timoshenko"},
            {**AT_ONCE, "axial_inertia": {}, "readings": READINGS},
        ),
        Case({**FEM, "mode": 3}, stepped("clamped", "free")),
        Case({**SEGMENT, "mode": 3, **SETTINGS}, stepped("clamped", "free")),
        Case({"model": "mean", "count": 9, "mode": 3}),
        Case({"model": "analytic", "mode": 3}, CARRIED),
        Case({**FEM, "mode": 3}, CARRIED),
        Case({**SEGMENT, "count": 14, "mode": 3, "joints": "tensioned"}, CARRIED),
        Case({**SEGMENT, "mode": 2, "wall": "third-order"}, ELASTIC),
        Case({**SEGMENT, "mode": 3, "attachment": "lever", "theory": "rayleigh"}, SPRUNG),
        Case({"model": "analytic", "mode": 3, "theory": "timoshenko"}, PLAIN),
        Case({**FEM, "mode": 3, "theory": "timoshenko"}, PLAIN),
        Case({**SEGMENT, "mode": 3, **THICK}, PLAIN),
        Case({**SEGMENT, "count": 13, "mode": 3, "theory": "timoshenko"}, ELASTIC),
    ],
    "mode.frequency_error": [
        Case({"model": "analytic", "mode": 3, "theory": "timoshenko"}),
        Case({**FEM, "mode": 3}, stepped("clamped", "free")),
        Case({**SEGMENT, "mode": 3, **SETTINGS}, stepped("clamped", "free")),
        Case({**SEGMENT, "mode": 3}, on("clamped", "pinned")),
    ],
    "mode.plate_error": [Case({"mode": 5}), Case({"mode": 3}, on("guided", "pinned"))],
    "mode.dispersion_error": [Case({"model": "segment", "count": 12, "modes": 4})],
    "mode.law_ratio": [Case({**SEGMENT, "mode": 2}, on("clamped", "pinned")), Case({**FEM, "mode": 2})],
    "mode.shape_error": [
        Case({**SEGMENT, "mode": 2, "reading": "raw"}, on("clamped", "pinned")),
        Case({**FEM, "mode": 2}, on("clamped", "pinned")),
    ],
    "mode.curvature_error": [Case({**SEGMENT, "mode": 2}, on("clamped", "pinned"))],
    "mode.deflection": [
        Case({**SEGMENT, "mode": 2, "x": 0.31}, on("clamped", "pinned")),
        Case({**FEM, "mode": 2, "x": 0.31}, stepped("clamped", "free")),
        Case({"model": "analytic", "mode": 3, "x": 0.31}, CARRIED),
    ],
    "mode.slope": [
        Case({"model": "analytic", "mode": 3, "x": 0.31, "theory": "timoshenko"}, PLAIN),
        Case({**SEGMENT, "mode": 2, "x": 0.31}, on("clamped", "free")),
    ],
    "mode.node_position": [
        Case({"model": "analytic", "mode": 4}, on("clamped", "free")),
        Case({**SEGMENT, "mode": 4}, on("clamped", "free")),
        Case({**SEGMENT, "count": 14, "mode": 4}, CARRIED),
        Case({**FEM, "mode": 4, "theory": "timoshenko"}, ELASTIC),
    ],
    "mode.order": [
        Case({"model": "segment", "mode": 5, "counts": [12, 16, 24], "wall": "half"}, on("clamped", "pinned")),
        Case({"model": "fem", "mode": 3, "counts": [8, 16, 32]}, stepped("clamped", "free")),
    ],
    "mode.shape_order": [
        Case({"model": "segment", "mode": 2, "counts": [8, 16, 32], "reading": "raw"}, on("clamped", "pinned"))
    ],
    "mode.bracket": [Case({"mode": 3, "count": 9, "wall": "half"}, on("clamped", "free"))],
    "mode.count_needed": [
        Case({"model": "segment", "mode": 3, "error": 4e-3, "wall": "half"}, on("clamped", "free")),
        Case({"model": "segment", "mode": 3, "error": 1e-6}, on("clamped", "clamped")),
        Case({"model": "fem", "mode": 6, "error": 3e-3}),
    ],
    "mode.stock_difference": [Case({"mode": 3, "count": 17}, on("clamped", "free"))],
    "mode.stiffness_difference": [Case({"count": 17, "grading": 1.7}, stepped("clamped", "free"))],
    "drive.rule_frequency": [Case({"mode": 5}, on("clamped", "free"))],
    "drive.quarter_wavelength": [Case({"frequency_hz": 310.0}), Case({})],
    "wave.deflection": [
        Case({"x": 0.31}),
        Case({"model": "fem", "count": 24, "x": 0.323, "modal_damping": 0.011}, stepped("clamped", "pinned")),
        Case(
            {"model": "segment", "count": 24, "x": 0.323, "joint_dashpot": 0.01, "load": "lever", "reading": "raw"},
            stepped("clamped", "pinned"),
        ),
        Case(
            {
                "x": 0.31,
                "phase_deg": 33.0,
                "position": 0.05,
                "frequency_hz": 700.0,
                "loss_factor": 0.03,
                "drive": "displacement",
            }
        ),
        Case({"model": "segment", "count": 24, "x": 0.323, "joints": "tensioned"}, CARRIED),
        Case({"model": "segment", "count": 24, "x": 0.323, "attachment": "lever", "theory": "timoshenko"}, SPRUNG),
        Case({"x": 0.31}, CARRIED),
        Case({"x": 0.31, "theory": "timoshenko"}, PLAIN),
        Case({"x": 0.31}, DEVICED),
        Case({"model": "segment", "count": 24, "x": 0.323}, DEVICED),
        Case({"model": "fem", "count": 24, "x": 0.323}, DEVICED),
    ],
    "wave.slope": [
        Case({"x": 0.31}),
        Case({"model": "segment", "count": 24, "x": 0.323}, stepped("clamped", "pinned")),
    ],
    "wave.curvature": [Case({"x": 0.31}, CARRIED), Case({"model": "fem", "count": 24, "x": 0.323})],
    "wave.fastest_crests": [
        Case({"limit": 0.13, "position": 0.0411}, ALIKE),
        Case({"model": "segment", "count": 40, "limit": 0.14, "position": 0.0411}, ALIKE),
    ],
    **{f"wave.{name}": [Case({}), Case({"model": "segment", "count": 40, "window": [0.2, 0.5]})] for name in FIELDS},
    "wave.axis_ratio": [Case({"x": 0.33}), Case({"model": "fem", "count": 40, "window": [0.2, 0.5]})],
    "wave.energy_flux": [Case({}), Case({"model": "segment", "count": 40, "window": [0.2, 0.5]})],
    "wave.power_imbalance": [Case({"window": [0.2, 0.5]})],
    "wave.best_frequency": [Case({"frequency_hz": 704.0, "span": 0.13}, STILL)],
    "wave.order": [
        Case({"model": "fem", "counts": [40, 60, 90]}),
        Case({"model": "segment", "counts": [27, 54, 108], "of": "deflection", "window": [0.25, 0.5]}),
    ],
    "wave.receptance": [
        Case({"position": 0.11, "x": 0.37}),
        Case({"model": "segment", "count": 12, "position": 0.11, "x": 0.37}, stepped("clamped", "pinned")),
        Case({"model": "segment", "count": 12, "position": 0.11, "x": 0.37}, CARRIED),
        Case({"model": "fem", "count": 12, "position": 0.11, "x": 0.37, "theory": "timoshenko"}, PLAIN),
    ],
    "wave.lumped_swr": [
        Case({"x": 0.31, "modes": [5, 7], "ratio": 1.3, "phase_deg": 71.0}),
        Case({"x": 0.31, "modes": [1, 3], "ratio": 1.3}, on("clamped", "free")),
    ],
    "wave.absorber_impedance": [Case({"position": 0.0573})],
    "wave.absorber_turning_impedance": [Case({"position": 0.0573}), Case({"position": 0.0573}, on("free", "guided"))],
    "wave.absorber_reflection": [
        Case({"position": 0.0573, "resistance": 3.1, "mass": 0.0037}),
        Case(
            {"position": 0.0573, "resistance": 3.1, "mass": 0.0037, "model": "segment", "count": 24}, on("free", "free")
        ),
        Case({"position": 0.0573, "resistance": 3.1e-3, "mass": 3.7e-6, "stiffness": 0.7, "turning": True}),
        Case({"position": 0.0573, "ratio": 1.7}),
        Case({"position": 0.0573, "resistance": 3.1, "stiffness": 5100.0}),
        Case({"position": 0.0573, "ratio": 1.7, "model": "analytic"}),
        Case({"position": 0.0573, "resistance": 3.1, "stiffness": 5100.0, "model": "segment", "count": 24}),
        Case({"position": 0.0573, "ratio": 1.7, "model": "fem", "count": 14}),
        Case({"position": 0.0573, "ratio": 1.7, "model": "analytic"}, HELD_BESIDE),
    ],
    "slider.winkler_speed_ratio": [
        Case({"contact_half_angle": 1.1}),
        Case({"contact_half_angle": 1.1, "epsilon": 0.13}),
    ],
    "slider.layer_force": [Case({"contact_half_angle": 1.1, "speed_ratio": 0.71, "epsilon": 0.3})],
    "slider.layer_efficiency": [Case({"contact_half_angle": 1.1, "speed_ratio": 0.71})],
    "contact.landing_phase": [Case({"acceleration_ratio": 1.7})],
    "contact.restitution": [
        Case({"damping_ratio": 0.37}),
        Case({"mass": 0.0041, "stiffness": 7.1e4, "damping": 9.3}),
    ],
    "wave.reflection_per_hertz": [Case({}), Case({"model": "segment", "count": 24})],
    "wave.reflection_per_degree": [Case({}), Case({"model": "fem", "count": 14})],
    "friction.free_decay": [Case({"mu": 0.23, "slope": 90.0, "speed": 0.013, "time": 0.004})],
    "friction.creep_speed": [Case({"mu": 0.23, "slope": 900.0, "pull": 1.1})],
    "friction.belt_stick_time": [Case({"mass": 0.7, "stiffness": 310.0, "static": 2.9, "kinetic": 1.7, "speed": 0.11})],
    "friction.belt_slip_time": [Case({"mass": 0.7, "stiffness": 310.0, "static": 2.9, "kinetic": 1.7, "speed": 0.11})],
    "friction.coulomb_decrement": [Case({"mass": 0.7, "stiffness": 310.0, "force": 1.7})],
    "slider.terminal_speed": [Case({"amplitude": 2.3e-6, "slope": 3e4, "mu": 0.02})],
    "slider.displacement": [
        Case({"model": "segment", "count": 12}, SHAKEN),
        Case({"model": "fem", "count": 12, "kinematics": "following"}, COULOMB),
        Case({"model": "analytic", "modes": 9, "mass": 3.1e-5, "coupling": "two-way"}, SHAKEN),
        Case({"model": "analytic", "modes": 9, "mass": 0.3}, SHAKEN),
        Case({"model": "segment", "count": 12}, {**SHAKEN, "motion": {**STEADY["motion"], "duration": 2.3e-3}}),
        Case({"model": "segment", "count": 12}, {**SHAKEN, **stepped("clamped", "pinned")}),
        Case({"model": "fem", "count": 12, "step": 2e-5}, {**SHAKEN, "motion": {"modal_damping": None}}),
    ],
    "slider.mean_speed": [Case({"model": "segment", "count": 12}, SHAKEN)],
    "slider.order": [
        Case({"model": "fem", "counts": [12, 24, 48], "modes": 30}, RISING),
        Case({"model": "segment", "count": 12, "steps": [9e-5, 5e-5, 3e-5]}, SHAKEN),
    ],
    "slider.largest_friction": [Case({"model": "segment", "count": 12}, RISING)],
    "slider.mean_friction": [Case({"model": "fem", "count": 12}, SHAKEN)],
    "slider.mean_surface_speed": [Case({"model": "segment", "count": 12}, SHAKEN)],
    "slider.reversal": [Case({"model": "segment", "count": 12}, {**SHAKEN, "readings": READINGS})],
    "slider.energy": [
        Case({"model": "segment", "count": 12, "of": "rubbed"}, SHAKEN),
        Case({"model": "fem", "count": 12, "of": "normal_on_beam", "mass": 0.02}, COARSE),
    ],
    "slider.imbalance": [Case({"model": "fem", "count": 12, "mass": 2e-4, "step": 2e-5}, SHAKEN)],
    "slider.deflection": [
        Case({"model": "segment", "count": 12, "x": 0.31, "mass": 0.02}, COARSE),
        Case(
            {"model": "analytic", "modes": 9, "x": 0.31}, {**HEAVY, "motion": {**STEADY["motion"], **COARSE["motion"]}}
        ),
        Case(
            {"model": "fem", "count": 12, "x": 0.31, "normal": "massless", "coupling": "two-way", "mass": 0.003},
            {**COARSE, "drive": SHAKEN["drive"]},
        ),
    ],
    "slider.coupling_size": [
        Case({"of": "friction"}),
        Case({"of": "friction", "model": "fem", "count": 12}, stepped("clamped", "pinned")),
        Case({"of": "normal", "model": "segment", "count": 12}),
    ],
    "slider.loaded_deflection": [
        Case({"x": 0.31}, HEAVY),
        Case({"x": 0.31, "model": "segment", "count": 12, "mass": 0.017}, stepped("clamped", "pinned")),
    ],
    "slider.stall_force": [
        Case(STEPPED, ON_A_POINT),
        Case(STEPPED, ON_A_LAYER),
        Case(STEPPED, BOUNCING),
    ],
    "slider.force_speed": [Case({**STEPPED, "model": "fem", "speed": -1.1e-4}, ON_A_POINT)],
    "slider.normal_mean": [Case({**STEPPED, "steps_per_period": 53, "speed": -1.1e-4}, BETWEEN)],
    "slider.contact_share": [Case(FINELY, ON_A_LAYER)],
    "slider.stuck_share": [Case(FINELY, ON_A_LAYER)],
    "slider.power": [Case({**STEPPED, "speed": -1.1e-4}, ON_A_LAYER)],
    "slider.efficiency": [Case({**STEPPED, "speed": 4.3e-5, **TOLD}, AWAY)],
    "slider.wear_power": [Case({**STEPPED, "speed": -1.1e-4}, ON_A_LAYER)],
    "slider.no_load_speed": [Case({**STEPPED, "steps_per_period": 17, "preload": 0.53}, SMOOTHLY)],
    "slider.free_speed": [
        Case({**STEPPED, "periods": 13, "last": 4}, ON_A_POINT),
        Case({**STEPPED, "steps_per_period": 53, "periods": 13, "last": 4}, CLASPING),
        Case({"model": "analytic", "steps_per_period": 53, "periods": 83, "last": 40}, BETWEEN),
    ],
    "slider.start_time": [Case({**STEPPED, "periods": 811, "last": 14, "mass": 0.9}, {**AWAY, **UNDER_WAY})],
    "slider.contact_energy": [
        Case({**STEPPED, "periods": 13, "of": "rubbed"}, ON_A_POINT),
        Case({**STEPPED, "steps_per_period": 53, "periods": 13, "of": "damped"}, CLASPING),
        Case({**STEPPED, "periods": 13, "of": "impacts"}, BOUNCING),
    ],
    "slider.wave_force": [
        Case({**ON_CRESTS, "points": 13}),
        Case({**ON_CRESTS, "points": 13, "epsilon": 0.3}),
    ],
    "slider.wave_force_order": [Case({**ON_CRESTS, "counts": [12, 18, 27], "epsilon": 0.3})],
    "motion.deflection": [
        Case({"model": "segment", "count": 12, "x": 0.31}),
        Case({"model": "fem", "count": 12, "x": 0.31}, stepped("clamped", "pinned")),
        Case({"model": "analytic", "modes": 9, "x": 0.31}),
        Case({"model": "fem", "count": 12, "x": 0.31}, {"motion": {**STEADY["motion"], "modal_damping": None}}),
        Case({"model": "fem", "count": 12, "x": 0.31}, CARRIED),
    ],
    "motion.energy": [
        Case({"model": "segment", "count": 12, "of": "work_in"}),
        Case({"model": "fem", "count": 12, "of": "damped"}, stepped("clamped", "pinned")),
        Case({"model": "analytic", "modes": 9, "of": "kinetic"}),
    ],
    "motion.reflection": [
        Case(
            {"model": "fem", "count": 40, "window": [0.2, 0.5], "points": 23},
            {"motion": {**STEADY["motion"], "duration": 2.1e-3}, "drive": {"frequency_hz": 2911.0}},
        )
    ],
    "motion.released_deflection": [
        Case({"model": "segment", "count": 12, "x": 0.31, "place": 0.47, "height": 0.002, "speed": 0.3, "time": 7e-3}),
        Case(
            {"model": "fem", "count": 12, "x": 0.31, "place": 0.47, "speed": 0.3, "time": 7e-3},
            stepped("clamped", "pinned"),
        ),
    ],
    "motion.released_energy": [
        Case(
            {
                **{"modes": 9, "model": "analytic", "place": 0.47, "height": 0.002},
                **{"time": 0.031, "modal_damping": 0.03, "of": "kinetic"},
            }
        )
    ],
    "beam.buckling_load": [
        Case({"model": "analytic"}, on("clamped", "free")),
        Case({**SEGMENT, "joints": "tensioned", "wall": "half"}, on("clamped", "free")),
        Case({**FEM}, stepped("clamped", "pinned")),
        Case({**SEGMENT, "count": 14}, SPRUNG),
    ],
    "chain.bent_tip": [
        Case({"count": 7, "across": 3.1, "along": -0.7, "moment": 0.2}, {"beam": {"supports": ["clamped", "free"]}}),
        Case(
            {"count": 7, "across": 3.1, "component": "shortening", "wall": "half"},
            {"beam": {"section": STEP, "supports": ["clamped", "free"]}},
        ),
    ],
    "chain.bent_energy": [Case({"count": 7, "moment": 0.2, "across": 0.9}, on("clamped", "free"))],
    "chain.cantilever_tip": [
        Case({"load": 2.3, "segments": 5}),
        Case({"load": 2.3, "segments": 5, "component": "shortening"}),
    ],
    "chain.rollup_gap": [Case({"segments": 7, "wall": "gregory"})],
    "chain.hanging_frequency": [Case({"mode": 2, "segments": 4})],
    "chain.large_amplitude_frequency": [Case({"amplitude": 21.0, "segments": 4}, STILL)],
    "chain.energy_drift": [
        Case({"segments": 3, "step": 2e-4, "periods": 0.3}, STILL),
        Case({"segments": 3, "periods": 0.3}, STILL),
    ],
    "chain.transient_deflection": [
        Case({"time": 9e-4, "x": 0.31, "segments": 5, "force": 300.0}, AT_ONCE),
        Case(
            {"time": 9e-4, "x": 0.31, "segments": 5, "step": 3e-5, "inertia": "transverse"},
            {**AT_ONCE, "drive": SHAKEN["drive"]},
        ),
    ],
    "chain.axial_departure": [Case({"segments": 4, "force": 90.0, "time": 9e-4}, AT_ONCE)],
    "chain.contact_line_error": [
        Case({"segments": 7, "mode": 2, "x": 0.1}, {"beam": {"supports": ["clamped", "pinned"], "loss_factor": 0.0}}),
        Case({"segments": 7, "mode": 3, "x": 0.27, "grading": 1.4}, STILL),
    ],
    "chain.slider_displacement": [
        Case({"segments": 7}, RIDDEN),
        Case({"segments": 5, "links": "stretching", "time": 3e-4, "step": 1.3e-5, "force": 70.0}, RIDDEN),
        Case({"segments": 7, "kinematics": "following", "coupling": "one-way", "mass": 0.003}, RIDDEN),
    ],
    "chain.slider_mean_speed": [Case({"segments": 7}, {**RIDDEN, "slider": {**COULOMB["slider"], "mass": 1e-6}})],
    "chain.slider_largest_friction": [
        Case(
            {"segments": 7},
            {
                **RIDDEN,
                "slider": {**RIDDEN["slider"], "slope": 3.0},
                "motion": {**RIDDEN["motion"], "steps_per_period": 14},
            },
        )
    ],
    "chain.imbalance": [Case({"segments": 4, "tip": "roller", "tolerance": 1e-6})],
    "chain.slider_imbalance": [Case({"segments": 5, "step": 7e-5, "kinematics": "following"}, RIDDEN)],
    "chain.turning_frequency": [Case({"mode": 2, "segments": 4, "speed": 3.7})],
}


@dataclass(frozen=True)
class Dead:
    """Inputs without effect on some quantities, and why that is right."""

    quantities: str
    inputs: str
    why: str
    when: Callable[[Asked], bool] = lambda asked: True

    def covers(self, asked, name, value):
        if not matches(asked.quantity, self.quantities):
            return False
        named = matches(name, self.inputs) or ("=" in self.inputs and matches(f"{name}={value}", self.inputs))
        return named and self.when(asked)


@cache
def matches(name, patterns):
    return any(fnmatchcase(name, pattern) for pattern in patterns.split())


def uniform(asked):
    return not asked.scene["beam"]["section"]


def unclamped(asked):
    return "clamped" not in asked.scene["beam"]["supports"]


def given(*names):
    """Whether all of these arguments were given."""
    return lambda asked: all(asked.arguments.get(name) is not None for name in names)


def alone(asked):
    """Whether nothing says how the slider is coupled, so that its size does."""
    return asked.arguments.get("coupling") is None and asked.scene["slider"]["coupling"] == "auto"


def light(asked):
    """Whether its size leaves the beam alone."""
    return alone(asked) and (asked.arguments.get("mass") or asked.scene["slider"]["mass"]) < 1e-4


def heavy(asked):
    """Whether its size says that the beam feels it."""
    return alone(asked) and not light(asked)


def by_a_ratio(asked):
    """Whether a motion's modes have a damping ratio in place of the beam's loss factor."""
    own = (
        None
        if asked.quantity.startswith("motion.released") or rides_on_feet(asked)
        else asked.scene["motion"]["modal_damping"]
    )
    ratios = own, asked.arguments.get("modal_damping")
    return "modal_damping" in asked.arguments and ratios != (None, None)


def rides_on_feet(asked):
    """Whether it is of a motor."""
    return "foot_length" in asked.arguments


def held(asked):
    """Whether a motor's slider is held at a speed."""
    return rides_on_feet(asked) and "pull" not in asked.arguments


def on_points(asked):
    """Whether no foot of a motor can turn."""
    return rides_on_feet(asked) and all(foot["points"] == 1 for foot in asked.scene["slider"]["foot"])


def undeviced(asked):
    return not asked.scene["drive"].get("device")


def half_infinite(asked):
    return asked.arguments.get("model") is None


def euler(asked):
    return asked.arguments.get("theory", "euler-bernoulli") == "euler-bernoulli"


def pulled(asked):
    return bool(asked.scene["beam"]["tension"])


def lone(asked):
    """Whether it is uniform and nothing stands on it, lies below it or pulls at it."""
    return uniform(asked) and bare(asked) and not (pulled(asked) or asked.scene["beam"]["foundation"])


def ridden_on_a_step(asked):
    """Whether a slider's lever is that of the first of two sections."""
    levered = asked.quantity == "slider.displacement" or asked.arguments.get("of") == "friction"
    return levered and not uniform(asked)


def plainly(asked):
    """Whether its section is given by its figures."""
    return asked.scene["beam"]["bending_stiffness"] is not None


def bare(asked):
    """Whether nothing stands on the beam."""
    return not (asked.scene["beam"]["mass"] or asked.scene["beam"]["spring"])


RELATIVE = "mode.frequency_error mode.law_ratio mode.shape_error mode.curvature_error mode.*order mode.count_needed"
MATERIAL = "beam.width beam.thickness beam.youngs_modulus beam.density"
DEAD = [
    Dead(
        "*",
        "name title description gate spectrum.* convergence.* sensitivity.* wave.* axial_inertia.*",
        "what a scene asks for beside the figure",
    ),
    Dead("stress.share", "beam.* drive.* slider.* motion.*", "rows stand on beams of their own"),
    Dead("*", "claim readings.*", "a published claim and what is tried of it move no figure"),
    Dead("*", "motion.count motion.counts motion.samples", "sizes and samples of the scene's own study"),
    Dead(
        "mode.* drive.rule_frequency",
        "drive.* slider.* motion.* beam.loss_factor",
        "free vibration without losses: nothing drives, nothing lies on it",
    ),
    Dead(
        "*",
        "beam.poissons_ratio beam.*shear_coefficient beam.*shear_stiffness",
        "of Timoshenko's theory and a plate's alone",
        lambda a: a.arguments.get("theory") != "timoshenko" and a.quantity != "mode.plate_error",
    ),
    Dead(
        "mode.plate_error",
        "beam.thickness beam.youngs_modulus beam.density beam.*shear_*",
        "the width in waves and Poisson's ratio alone",
    ),
    Dead("*", "beam.rotary_inertia beam.section.*.rotary_inertia", "of thick beams alone", euler),
    Dead("mode.* drive.*", "beam.*extreme_fibre", "of a surface's motion alone"),
    Dead(
        "chain.axial_departure chain.contact_line_error chain.energy_drift chain.large_amplitude_frequency "
        "chain.transient_deflection motion.deflection slider.loaded_deflection wave.best_frequency "
        "wave.deflection wave.energy_flux wave.envelope wave.order wave.power_imbalance wave.receptance wave.reflection* "
        "wave.signed_area_spread wave.standing_wave_ratio wave.travelling_index",
        "beam.extreme_fibre",
        "the neutral line moves whatever the surface does",
    ),
    Dead(
        "slider.coupling_size",
        "beam.extreme_fibre",
        "only friction acts on a lever",
        lambda a: a.arguments["of"] != "friction",
    ),
    Dead("*", "beam.section.1.extreme_fibre", "no slider stands and no point is read on the second section"),
    Dead("*", "beam.section.0.extreme_fibre", "nor on the first", lambda a: not ridden_on_a_step(a)),
    Dead("slider.displacement", "beam.extreme_fibre", "the section under the slider has its own", ridden_on_a_step),
    Dead("*", "beam.poissons_ratio", "of a shape and its material", plainly),
    Dead("*", "beam.*shape=rectangle", "a rectangle is what is meant where no shape is given"),
    Dead("mode.frequency mode.node_position mode.bracket drive.*", "beam.width", "EI / rho A has no width", lone),
    Dead(
        RELATIVE,
        f"{MATERIAL} beam.length",
        "a relative error of a uniform beam knows mode, size and supports",
        lambda a: lone(a) and euler(a),
    ),
    Dead(
        "mode.frequency_error",
        "beam.width beam.youngs_modulus beam.density",
        "Timoshenko against Euler-Bernoulli: slenderness and Poisson's ratio alone",
        lambda a: not euler(a),
    ),
    Dead(
        "mode.node_position",
        "beam.thickness beam.youngs_modulus beam.density",
        "a shape is geometry",
        lambda a: lone(a) and euler(a),
    ),
    Dead(
        "beam.buckling_load",
        "beam.density beam.mass.*.mass beam.mass.*.rotary_inertia beam.section.*.density beam.*mass_per_length "
        "beam.loss_factor beam.extreme_fibre drive.* slider.* motion.*",
        "a load at rest: nothing moves, nothing is lost",
    ),
    Dead(
        "beam.buckling_load",
        "beam.mass beam.mass.*.position",
        "the same; but elements end where masses stand",
        lambda a: a.arguments["model"] != "fem",
    ),
    Dead(
        "beam.buckling_load",
        "beam.supports.0=guided",
        "what may move along as a whole bears no less",
        lambda a: a.scene["beam"]["supports"] == ["clamped", "free"] and bare(a),
    ),
    Dead("beam.buckling_load", "beam.tension", "the compression counts, whatever force there is already"),
    Dead(
        "beam.buckling_load",
        "arguments.joints=series arguments.joints=printed",
        "both forms of Eq. (1) are one where E and I do not change",
        lambda a: uniform(a) and a.arguments["joints"] != "tensioned",
    ),
    Dead(
        "chain.bent_*",
        "beam.density beam.*mass_per_length beam.section.*.density beam.loss_factor drive.* slider.* motion.*",
        "an equilibrium without gravity: nothing moves, nothing is lost",
    ),
    Dead("chain.bent_*", "beam.*extreme_fibre", "the neutral line bends whatever the surface does"),
    Dead(
        "chain.bent_*",
        "arguments.joints=series arguments.joints=printed",
        "both forms of Eq. (1) are one where E and I do not change",
        uniform,
    ),
    Dead(
        "motion.reflection",
        "motion.duration arguments.time arguments.periods",
        "a steady motion is the same in every period",
    ),
    Dead("motion.reflection", "beam.width", "a ratio of one motion: EI and rho A share the width"),
    Dead("chain.bent_*", "arguments.joints=tensioned", "dead loads: its joints know no axial force"),
    Dead("motion.released_deflection", "beam.width", "let go, not forced: EI and rho A share the width", lone),
    Dead(
        "wave.fastest_crests",
        "drive.force.*.phase_deg arguments.phase_deg",
        "the best phase is sought, of the sign of the one given",
    ),
    Dead("motion.released_*", "drive.* slider.* motion.*", "let go: nothing drives, nothing lies on it"),
    Dead("motion.energy motion.reflection", "motion.steps_per_period", "closed form in time: no step"),
    Dead("motion.energy motion.reflection", "slider.*", "the beam alone"),
    Dead(
        "motion.energy motion.reflection motion.released_* wave.slope wave.curvature",
        "beam.extreme_fibre",
        "the neutral line moves whatever the surface does",
    ),
    Dead(
        "mode.deflection mode.slope",
        "beam.youngs_modulus",
        "a shape of unit modal mass is geometry and mass",
        lambda a: lone(a) and euler(a),
    ),
    Dead("mode.dispersion_error", "*", "rounding, whatever the beam and the size: that is what it says"),
    Dead("mode.st*_difference", "*", "rounding, whatever the beam and the size: that is what they say"),
    Dead("mode.* wave.*", "arguments.wall", "no clamped end has a joint", lambda a: unclamped(a) and bare(a)),
    Dead(
        "mode.* wave.*",
        "arguments.joints=series arguments.joints=printed",
        "both forms of Eq. (1) are one where E and I do not change",
        lambda a: uniform(a) and a.arguments["joints"] != "tensioned",
    ),
    Dead(
        "mode.* wave.*",
        "arguments.joints=tensioned",
        "nothing pulls and nothing is thick",
        lambda a: (uniform(a) or a.arguments["joints"] == "series") and not pulled(a) and euler(a),
    ),
    Dead(
        "mode.* wave.* beam.buckling_load",
        "arguments.attachment",
        "nothing stands on the beam",
        lambda a: bare(a) and not a.scene["drive"]["device"],
    ),
    Dead(
        "mode.shape* mode.curvature_error mode.node_position mode.deflection mode.slope",
        "beam.foundation",
        "a bed under the whole of a uniform beam lifts all omega^2 by k_f/(rho A) and leaves the shapes",
        lambda a: uniform(a) and bare(a) and euler(a),
    ),
    Dead(
        "drive.quarter_wavelength",
        "beam.length beam.supports.* beam.loss_factor drive.force.* drive.kind slider.* motion.*",
        "of a wave on the beam's section, however long and held it is",
    ),
    Dead("*", "drive.frequency_hz", "given instead", given("frequency_hz")),
    Dead(
        "mode.count_needed",
        "arguments.of=least",
        "no smaller number happens to do",
        lambda a: a.arguments["error"] > 1e-3,
    ),
    Dead(
        "mode.count_needed",
        "arguments.theory",
        "a whole number of few parts, as many by every theory",
        lambda a: a.arguments["error"] > 1e-3,
    ),
    Dead(
        "mode.count_needed",
        "beam.mass beam.spring beam.tension beam.foundation",
        "nine elements whatever the beam carries",
        lambda a: a.arguments["error"] > 1e-3 and a.arguments["model"] == "fem",
    ),
    Dead(
        "mode.shape*",
        "arguments.reading=nodal",
        "nodal is the elements' one reading",
        lambda a: a.arguments["model"] == "fem",
    ),
    Dead("wave.*", "slider.* motion.*", "a steady field with nothing on it"),
    Dead(
        "wave.standing_wave_ratio wave.reflection* wave.envelope wave.travelling_index wave.axis_ratio wave.signed_area_spread "
        "wave.power_imbalance wave.best_frequency wave.order",
        "beam.width",
        "a ratio of one field: EI and rho A share the width",
    ),
    Dead("wave.deflection", "beam.width", "imposed, not forced", lambda a: a.arguments["drive"] == "displacement"),
    Dead(
        "slider.coupling_size",
        "beam.width",
        "full friction and the drive move a beam in one ratio",
        lambda a: uniform(a) and a.arguments["of"] == "friction",
    ),
    Dead("*", "beam.loss_factor", "given instead", given("loss_factor")),
    Dead("*", "drive.kind", "given instead", given("drive")),
    Dead(
        "wave.[!a]* wave.axis_ratio slider.* motion.*",
        "drive.force.*.position drive.force.*.measured_from",
        "given instead",
        given("position"),
    ),
    Dead("wave.* slider.* motion.*", "drive.force.1.phase_deg", "given instead", given("phase_deg")),
    Dead("wave.receptance", "drive.kind drive.force.*", "one newton at `position` instead"),
    Dead("friction.belt_stick_time", "arguments.mass", "2 (F_s - F_k)/(k V): what rides has no inertia to show"),
    Dead("friction.coulomb_decrement", "arguments.mass", "4 F/k"),
    Dead(
        "slider.winkler_speed_ratio slider.layer_*",
        "beam.* drive.* slider.* motion.*",
        "a layer on crests of their own",
    ),
    Dead("contact.landing_phase contact.restitution", "beam.* drive.* slider.* motion.*", "a surface of its own"),
    Dead("wave.absorber_*", "drive.kind drive.force.*", "one wave from the left, whatever makes it", half_infinite),
    Dead("wave.absorber_* wave.lumped_swr", "beam.extreme_fibre", "no surface"),
    Dead(
        "wave.lumped_swr",
        "beam.supports.*",
        "an end shifts both waves alike, but for the lowest modes, whose near fields reach the other end",
        lambda a: a.arguments["modes"] == [5, 7],
    ),
    Dead(
        "wave.lumped_swr",
        "beam.width beam.thickness beam.youngs_modulus beam.density beam.loss_factor drive.* slider.* motion.*",
        "two shapes, which are geometry, and nothing that drives them",
    ),
    Dead("wave.absorber_*", "beam.length beam.supports.0", "half-infinite: the left end is far away", half_infinite),
    Dead(
        "wave.absorber_reflection",
        "drive.force.0.amplitude drive.force.0.phase_deg",
        "one force is left, and a ratio",
        undeviced,
    ),
    Dead(
        "wave.absorber_reflection", "drive.force.1.amplitude drive.force.1.phase_deg", "the device stands in its place"
    ),
    Dead("wave.absorber_reflection", "arguments.alone", "no other device", undeviced),
    Dead(
        "wave.absorber_reflection",
        "beam.width",
        "of beam and device alike, which is matched to it",
        lambda asked: asked.arguments.get("ratio") is not None and undeviced(asked),
    ),
    Dead("friction.*", "beam.* drive.* slider.* motion.*", "a rigid surface of its own"),
    Dead(
        "slider.terminal_speed",
        "beam.length beam.width beam.supports.* beam.loss_factor drive.kind drive.force.* slider.* motion.*",
        "a pure wave on the beam's section under a slider of its own",
    ),
    Dead("slider.* motion.[!r]* motion.released_*", "beam.loss_factor", "a modal ratio is given instead", by_a_ratio),
    Dead(
        "slider.* chain.slider_*",
        "slider.coupling=one-way arguments.coupling=one-way",
        "auto chooses it for a slider so light",
        light,
    ),
    Dead(
        "slider.* chain.slider_*",
        "slider.normal=massless arguments.normal=massless",
        "one way nothing of it presses on the beam",
        light,
    ),
    Dead(
        "slider.*", "slider.coupling=two-way arguments.coupling=two-way", "auto chooses it for a slider so heavy", heavy
    ),
    Dead("slider.* chain.slider_*", "slider.coupling", "given instead", given("coupling")),
    Dead("slider.* chain.slider_*", "slider.normal", "given instead", given("normal")),
    Dead(
        "slider.coupling_size slider.loaded_deflection",
        "motion.* slider.slope slider.law slider.speed slider.coupling slider.line slider.kinematics slider.normal",
        "a steady field: sizes before a run, of a slider that is held still",
    ),
    Dead("slider.loaded_deflection", "slider.mu slider.preload slider.gravity", "of a mass alone"),
    Dead(
        "slider.coupling_size",
        "slider.mu slider.preload slider.gravity drive.force.*",
        "m omega^2 |G|, whatever drives",
        lambda a: a.arguments["of"] == "normal",
    ),
    Dead("slider.* chain.slider_*", "slider.mass", "given instead", given("mass")),
    Dead("slider.* chain.slider_*", "slider.kinematics", "given instead", given("kinematics")),
    Dead(
        "slider.* chain.slider_*",
        "motion.steps_per_period",
        "given instead",
        lambda a: any(a.arguments.get(k) for k in ("step", "steps")),
    ),
    Dead("slider.*", "motion.*", "a motor's beam is steady, its runs have arguments of their own", rides_on_feet),
    Dead("slider.*", "slider.speed slider.pull", "held at another speed, whatever pulls at it", held),
    Dead("slider.*", "arguments.periods", "as many at most: its means have settled before", held),
    Dead("slider.*", "slider.foot.*.pitches", "a foot of one point does not turn", on_points),
    Dead(
        "slider.*",
        "slider.coupling=auto arguments.coupling=auto",
        "auto chooses it for a slider that presses so much",
        lambda a: rides_on_feet(a) and a.scene["slider"]["coupling"] == "two-way",
    ),
    Dead(
        "slider.normal_mean slider.contact_share",
        "slider.mu slider.law slider.contact.*tangential_stiffness arguments.mu arguments.law "
        "arguments.tangential_stiffness",
        "friction acts along: one way it moves nothing across",
        lambda a: a.scene["slider"]["coupling"] == "one-way",
    ),
    Dead(
        "slider.normal_mean",
        "arguments.speed",
        "kept at its place it goes along no slope, and friction acts along",
        lambda a: a.scene["slider"]["coupling"] == "one-way",
    ),
    Dead("slider.*", "slider.preload", "given instead", given("preload")),
    Dead(
        "slider.efficiency",
        "beam.length arguments.damping",
        "turned so far, the slider drives the surface, which is refused",
    ),
    Dead("slider.*", "slider.contact.stiffness", "given instead", given("stiffness")),
    Dead(
        "slider.efficiency",
        "slider.mu arguments.mu",
        "a ratio of two powers of one friction",
        lambda a: a.scene["slider"]["coupling"] == "one-way",
    ),
    Dead(
        "slider.no_load_speed",
        "slider.mu arguments.mu",
        "mu N f(v): where it is nought on the average mu does not count",
        lambda a: a.scene["slider"]["coupling"] == "one-way",
    ),
    Dead(
        "slider.wave_force slider.wave_force_order",
        "beam.length beam.width beam.supports.* beam.loss_factor drive.kind drive.force.* slider.* motion.*",
        "a pure wave on the beam's section under a foot of its own",
    ),
    Dead("slider.wave_force slider.wave_force_order", "arguments.mu", "F/(mu N) at an epsilon that is given"),
    Dead("motion.deflection", "motion.steps_per_period", "closed form in time: no step"),
    Dead("motion.deflection", "slider.*", "the beam alone"),
    Dead(
        "chain.cantilever_tip chain.rollup_gap chain.hanging_frequency chain.turning_frequency chain.imbalance",
        "beam.* drive.*",
        "a chain of unit length of its own",
    ),
    Dead(
        "chain.large_amplitude_frequency",
        "beam.width beam.youngs_modulus beam.density",
        "a ratio of two frequencies",
        uniform,
    ),
    Dead(
        "chain.large_amplitude_frequency chain.energy_drift",
        "beam.supports.* drive.*",
        "between hinges of its own, let go",
    ),
    Dead("chain.[!s]*", "slider.*", "the beam alone"),
    Dead("chain.[!s]*", "motion.duration motion.steps_per_period", "the chain's runs have arguments of their own"),
    Dead(
        "chain.cantilever_tip chain.rollup_gap chain.*_frequency chain.energy_drift chain.imbalance",
        "motion.*",
        "at rest, or let go without a drive that could set in",
    ),
    Dead("chain.transient_deflection chain.slider_*", "drive.force.*.amplitude", "given instead", given("force")),
    Dead("chain.slider_*", "motion.duration", "given instead", given("time")),
    Dead(
        "chain.slider_*",
        "slider.normal arguments.normal",
        "one way nothing of it presses on the chain",
        lambda a: a.arguments["coupling"] == "one-way",
    ),
    Dead(
        "chain.contact_line_error",
        f"{MATERIAL} beam.length drive.* motion.*",
        "a relative error of a mode of a uniform beam, at the place of one of its links",
    ),
    Dead("chain.contact_line_error", "arguments.wall", "no clamped end has a joint", unclamped),
    Dead(
        "chain.transient_deflection",
        "arguments.method=adaptive",
        "so without a step",
        lambda a: a.arguments["step"] is None,
    ),
    Dead("chain.transient_deflection", "arguments.method=rk4", "so with a step", given("step")),
    Dead(
        "wave.best_frequency",
        "arguments.span arguments.frequency_hz",
        "a wider search, or one about another middle, finds the same",
    ),
    Dead("chain.axial_departure", "drive.force.*.amplitude", "given instead"),
]

OFF: dict[str, Any] = {
    "epsilon": 0.13,
    "alone": True,
    "periods": 3,
    "resistance": 3.7,
    "damping_ratio": 0.43,
    "damping": 7.7,
    "ratio": 1.3,
    "loss_factor": 0.017,
    "modal_damping": 0.019,
    "joint_dashpot": 0.013,
    "preload": 0.0041,
    "speed": 0.0037,
    "height": 0.0017,
    "along": -0.31,
    "across": 1.7,
    "moment": 0.13,
    "phase_deg": 61.0,
    "soft_start_periods": 0.37,
    "position": 0.083,
    "frequency_hz": 761.0,
    "x": 0.283,
    "mu_static": 0.31,
    "window": [0.21, 0.51],
    "count": 7,
    "published_hz": 1e3,
    "time": 9e-4,
    "step": 1.7e-5,
    "mu": 0.31,
    "slope": 270.0,
    "mass": 0.0019,
    "slider_position": 0.313,
    "slider_speed": 0.0061,
    "force": 2.3,
    "counts": [9, 13, 19],
    "steps": [3e-5, 2e-5, 1e-5],
    "section": STEP,
    "width": 0.028,
    "thickness": 0.0021,
    "youngs_modulus": 99e9,
    "density": 4800.0,
    "gate": [],
    "modes": 7,
    "title": "t",
    "description": "d",
    "claim": [],
    "chain": True,
    "tolerance": 1e-6,
    "diameter": 0.019,
    "wall_thickness": 0.0012,
    "bending_stiffness": 2.9,
    "mass_per_length": 0.27,
    "extreme_fibre": 0.0017,
    "shear_stiffness": 1.9e6,
    "shear_coefficient": 0.81,
    "rotary_inertia": 1.3e-7,
    "beam.mass": [{"position": 0.211, "mass": 0.053}],
    "beam.spring": [{"position": 0.503, "stiffness": 3.7e4}],
    "tension": 31.0,
    "foundation": 2.1e4,
    "stiffness": 170.0,
    "rotational": 1.3,
    "device": [{"position": 0.31, "dashpot": 1.3}],
    "turning": True,
    "contact": {"stiffness": 6.1e4},
    "foot": [{"length": 0.043, "points": 5}],
    "pull": -1.7e-3,
    "preload_stiffness": 1300.0,
    "tangential_stiffness": 2.7e4,
    "layer_stiffness": 1.3e6,
    "layer_tangential_stiffness": 4.1e5,
    "restitution": 0.37,
    "points": 7,
    "foot_length": 0.041,
    "length": 0.039,
    "offset": 0.0043,
    "inertia": 3.7e-7,
    "mirrored": True,
    "slider.gravity": 7.3,
}
"""What an input is turned to that is nothing or not given."""
WHOLE = ("gate", "claim")
"""Tables that judge figures and make none: turned as a whole."""
FACTORS = {"error": 2.0, "grading": 2.0}
"""Where a seventh more is too little to show."""
WORDS = {
    "reading": ["raw", "nodal", "corrected"],
    "name": ["another"],
    "title": ["t"],
    "description": ["d"],
    "quantity": ["wave.crest_speed"],
    "row": ["foundation"],
}
"""What words without a list of their own are turned to."""


OF_SCENE = {
    "drive": ("drive", "kind"),
    "start": ("motion", "start"),
    "law": ("slider", "law"),
    "coupling": ("slider", "coupling"),
    "line": ("slider", "line"),
    "kinematics": ("slider", "kinematics"),
    "normal": ("slider", "normal"),
}
"""Whose word counts where an argument is left out: it is not turned to that."""


def words_of(kind):
    """The words a type allows, or none."""
    if get_origin(kind) is Literal:
        return list(get_args(kind))
    if among := among_of(kind):
        return [name for name in among.names() if name in ("analytic", "fem", "segment", "mean")]
    return next((found for arm in get_args(kind) if (found := words_of(arm))), [])


def turned(name, kind, value, dotted=""):
    """Other values of an input, each well away from its own."""
    if words := words_of(kind):
        return [word for word in words if word != value]
    if name in WORDS:
        return [word for word in WORDS[name] if word != value]
    if not value or name in WHOLE:
        assert {dotted, name} & set(OFF), f"{name} is off in a case: say in OFF what it is to be turned to"
        return [OFF.get(dotted, OFF.get(name))]
    if isinstance(value, list):
        assert isinstance(value[0], int | float), f"{name} = {value!r}: say in turned() how to turn it"
        return [[*value[:i], turned(name, kind, one)[0], *value[i + 1 :]] for i, one in enumerate(value)]
    if isinstance(value, int):
        return [value is not True and value + max(value // 5, 1)]
    assert isinstance(value, float), f"{name} = {value!r}: say in turned() how to turn it"
    return [FACTORS.get(name, 1.137) * value]


def inner_type(kind):
    """A type without None and annotations."""
    if hasattr(kind, "__metadata__"):
        return inner_type(get_args(kind)[0])
    arms = [arm for arm in get_args(kind) if arm is not type(None)]
    return inner_type(arms[0]) if type(None) in get_args(kind) else kind


def inputs_of(kind, data, where=()):
    """(path, name, type) of every leaf of a struct's plain data."""
    for one in msgspec.structs.fields(kind):
        path, inner, value = (*where, one.name), inner_type(one.type), data[one.name]
        element = inner_type(get_args(inner)[0]) if get_origin(inner) is tuple else None
        if isinstance(inner, type) and issubclass(inner, msgspec.Struct):
            if value is not None:
                yield from inputs_of(inner, value, path)
            elif one.name in OFF:
                yield path, one.name, one.type
        elif isinstance(element, type) and issubclass(element, msgspec.Struct) and value and one.name not in WHOLE:
            for i, part in enumerate(value):
                yield from inputs_of(element, part, (*path, i))
        elif element is not None and words_of(element):
            yield from (((*path, i), one.name, element) for i in range(len(value)))
        else:
            yield path, one.name, one.type


def plain(value):
    """Tables, lists and numbers, a copy."""
    return msgspec.json.decode(msgspec.json.encode(value))


def put(data, path, value):
    """`data` with one value changed; a section that grows takes its length from its neighbour."""
    whole = plain(data)
    here = whole
    for step in path[:-1]:
        here = here[step]
    if path[1:2] == ("section",) and path[-1] == "length":
        other = whole["beam"]["section"][path[2] - 1]
        other["length"] -= value - here["length"]
    here[path[-1]] = value
    return lawful(whole) if path == ("slider", "law") else whole


def lawful(scene):
    """Without the slope of Eq. (3) where Coulomb's law takes its place."""
    slider = scene.get("slider") or {}
    return {**scene, "slider": {**slider, "slope": None}} if slider.get("law") == "coulomb" else scene


def joined(base, change):
    return {**base, **{k: {**base.get(k, {}), **v} if isinstance(v, dict) else v for k, v in change.items()}}


def asked_of(name, case):
    """A case with everything stated, defaults and all."""
    scene = plain(checked(lawful(joined(BASE, case.scene)), scene_type()))
    return Asked(name, plain(arguments_of(QUANTITIES[name], case.arguments)), scene)


def figure(asked, scene=None, arguments=None):
    """The figure, everything solved afresh, as a tuple of numbers."""
    found = QUANTITIES[asked.quantity]
    given = checked(scene or asked.scene, scene_type())
    stated = {k: v for k, v in (arguments or asked.arguments).items() if v is not None}
    value = evaluate(found, arguments_of(found, stated), given, Workbench(given.beam))
    return (value.lower, value.upper) if hasattr(value, "lower") else (value,)


def all_inputs(asked):
    """{dotted name: (whether of the scene, path, values to turn it to)}."""
    found = {}
    for scene, kind, data in (
        (True, scene_type(), asked.scene),
        (False, QUANTITIES[asked.quantity].arguments, asked.arguments),
    ):
        for path, name, type_ in inputs_of(kind, data):
            here = data
            for step in path:
                here = here[step]
            values = turned(name, type_, here, ".".join(map(str, path)))
            if here is None and name in OF_SCENE:
                own = asked.scene
                for step in OF_SCENE[name]:
                    own = own[step]
                values = [value for value in values if value != own]
            found[".".join(map(str, path if scene else ("arguments", *path)))] = (scene, path, values)
    return found


STILL_BELOW, MOVED_ABOVE = 1e-10, 1e-9
"""Relative changes of a figure: rounding, and anything else. Between them a case is too weak to tell."""
SCALE = {
    "mode.dispersion_error": 1e-3,
    "mode.stiffness_difference": 1e-3,
    "mode.stock_difference": 1.0,
    "wave.best_frequency": 1e6,
}
"""What a change is held against where a figure is rounding itself, or is searched for to 1e-5 Hz."""


def change(asked, base, turns):
    """The relative change of a figure under turned inputs, or the InputError that refuses them."""
    scene, arguments = asked.scene, asked.arguments
    for of_scene, path, value in turns:
        if of_scene:
            scene = put(scene, path, value)
        else:
            arguments = put(arguments, path, value)
    try:
        found = figure(asked, scene, arguments)
    except InputError as refusal:
        return refusal
    scale = max(*map(abs, base), SCALE.get(asked.quantity, 0.0))
    return max(abs(a - b) for a, b in zip(found, base, strict=True)) / scale


def dead_ones_that_live(asked, base, turns):
    """Which of the inputs declared without effect have one; all at once, and by halves where something shows.

    Two that are refused together only are tried apart. One that is refused alone is no worse for being declared.
    """
    if not turns:
        return []
    found = change(asked, base, [turn for _, turn in turns])
    if isinstance(found, float) and found <= STILL_BELOW:
        return []
    if len(turns) == 1:
        name, turn = turns[0]
        if isinstance(found, InputError):
            return []
        return [f"{name} turned to {turn[2]!r} is declared without effect and moves {found:.1e}"]
    half = len(turns) // 2
    return dead_ones_that_live(asked, base, turns[:half]) + dead_ones_that_live(asked, base, turns[half:])


def stands(asked, turn):
    """Whether one turned input leaves a scene that is one: what none can have needs no trying, whatever the figure."""
    of_scene, path, value = turn
    try:
        return not of_scene or checked(put(asked.scene, path, value), scene_type()) is not None
    except InputError:
        return False


NO_ORDER = re.compile("the error (changes sign|falls at no settled order) between them")
"""An order that was one and is none any more: its errors have moved."""


def live_ones_that_do_not(asked, base, name, turn):
    """What is wrong with one input that is not declared without effect; nothing where it moves or is refused."""
    found = change(asked, base, [turn])
    said = f"{name} turned to {turn[2]!r}"
    leaf = next(step for step in reversed(turn[1]) if isinstance(step, str))
    if isinstance(found, InputError):
        by_name = leaf in str(found) or not isinstance(turn[2], int | float) or NO_ORDER.search(str(found))
        return [] if by_name else [f"{said} is refused for another reason, {str(found)[:160]!r}: choose another case"]
    if found <= STILL_BELOW:
        return [f"{said} is dropped in silence: use it, refuse it, or declare it in DEAD with the reason"]
    return [] if found > MOVED_ABOVE else [f"{said} moves {found:.1e} only: choose a case in which it shows"]


def every_case():
    return [asked_of(name, case) for name in QUANTITIES for case in CASES.get(name, [])]


def problems_of(quantity):
    """What is wrong with any input of any case of a quantity, a sentence each."""
    problems = []
    for case in CASES[quantity]:
        asked = asked_of(quantity, case)
        base = figure(asked)
        dead, wrong = [], []
        for name, (of_scene, path, values) in all_inputs(asked).items():
            for value in values:
                turn = of_scene, path, value
                if any(entry.covers(asked, name, value) for entry in DEAD):
                    dead += [(name, turn)] * stands(asked, turn)
                else:
                    wrong += live_ones_that_do_not(asked, base, name, turn)
        for together in rounds(dead):
            wrong += dead_ones_that_live(asked, base, together)
        problems += [f"{asked}: {text}" for text in wrong]
    return problems


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_every_input_moves_its_figure_or_is_refused_or_declared(quantity):
    assert CASES.get(quantity), f"{quantity} has no base case: give CASES one, with values that are not symmetric"
    problems = problems_of(quantity)
    assert not problems, "\n".join(problems)


def test_an_input_dropped_in_silence_is_found(monkeypatch):
    """Of the scene and of the arguments."""
    friction, wave = QUANTITIES["friction.creep_speed"], QUANTITIES["wave.receptance"]
    deaf = replace(friction, evaluate=lambda a, *given: friction.evaluate(replace(a, slope=900.0), *given))
    monkeypatch.setitem(QUANTITIES, friction.name, deaf)
    (found,) = problems_of("friction.creep_speed")
    assert "arguments.slope turned to 1023" in found
    assert "is dropped in silence" in found
    lossless = replace(
        wave,
        evaluate=lambda a, scene, bench: wave.evaluate(replace(a, loss_factor=a.loss_factor or 0.021), scene, bench),
    )
    monkeypatch.setitem(QUANTITIES, wave.name, lossless)
    assert all("beam.loss_factor turned to" in text for text in problems_of("wave.receptance"))
    assert len(problems_of("wave.receptance")) == len(CASES["wave.receptance"])


def test_a_declaration_that_is_not_true_is_found(monkeypatch):
    monkeypatch.setattr(
        f"{__name__}.DEAD", [*DEAD, Dead("friction.creep_speed", "arguments.mu beam.*", "so it is said")]
    )
    (found,) = problems_of("friction.creep_speed")
    assert "arguments.mu turned to" in found
    assert "is declared without effect and moves" in found


def rounds(turns):
    """The turns shared out so that no round turns one input twice."""
    left = list(turns)
    while left:
        here = dict(reversed(left))
        yield list(here.items())
        left = [(name, turn) for name, turn in left if here[name] is not turn]


def test_every_entry_of_the_table_speaks_of_some_input_of_some_case():
    """A reason that nothing needs any more goes."""
    cases = [(asked, all_inputs(asked)) for asked in every_case()]
    for entry in DEAD:
        assert any(
            entry.covers(asked, name, value)
            for asked, inputs in cases
            for name, (_, _, values) in inputs.items()
            for value in values
        ), f"{entry.quantities}: {entry.inputs} ({entry.why})"


def test_the_base_has_every_part_that_a_scene_can_have():
    """A new part of scenes is turned as well, or this says so."""
    assert set(BASE) | {"title", "description", "axial_inertia", "readings", "methods", "bench", "stress", "motor"} == {
        f.name for f in msgspec.structs.fields(scene_type())
    }


@pytest.mark.parametrize("wrong", [float("nan"), float("inf"), float("-inf")])
def test_a_number_that_is_none_is_refused_by_its_name(wrong):
    """Of every argument that takes a number: a slider held at a speed that is none was told to have diverged."""
    asked = 0
    for name, found in QUANTITIES.items():
        for case in CASES.get(name, [])[:1]:
            for argument, value in case.arguments.items():
                if isinstance(value, float):
                    asked += 1
                    with pytest.raises(InputError, match=rf"^{argument} = .*: give a "):
                        arguments_of(found, {**case.arguments, argument: wrong})
    assert asked > 60
    with pytest.raises(InputError, match=r"^speed = nan: give a finite number$"):
        arguments_of(QUANTITIES["slider.force_speed"], {"model": "analytic", "speed": float("nan")})
