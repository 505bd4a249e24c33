"""Scenes drawn by a number, as plain tables: beams of every kind, what drives them, what slides, what is asked."""

from math import isfinite, pi, sqrt

from drawn import STRANGE_WORDS, toml

from verify.options import (
    ATTACHMENTS,
    JOINTS,
    LOADS,
    READINGS,
    SHAPES,
    SUPPORTS,
    THEORIES,
    TIPS,
    WALLS,
)
from verify.quantities import described

MODELS = ("analytic", "fem", "segment")
QUANTITIES = {one["quantity"]: one["arguments"] for one in described()}
WORDS = {
    "wall": WALLS, "joints": JOINTS, "attachment": ATTACHMENTS, "theory": THEORIES, "load": LOADS, "reading": READINGS,
    "tip": TIPS, "grading": (1.0, 1.4, 0.2), "model": (*MODELS, "mean"),
}  # fmt: skip


OF_PARTS = ("count", "wall", "joints", "attachment", "grading", "load", "reading")
"""Arguments that a model without parts refuses."""


class Drawn:
    """A scene: its tables, and the scales of its beam that commands need for sensible arguments."""

    def __init__(self, draw):
        self.draw = draw
        self._scales()
        self.tables = {"name": draw.value("drawn"), "beam": self._beam()}
        if draw.often(15):
            self.tables |= {draw.one("title", "description"): draw.choice(STRANGE_WORDS)}
        if draw.often(65):
            self.tables["drive"] = self._drive()
        driven = bool(self.tables.get("drive")) or draw.often(5)
        if driven and draw.often(50):
            self.tables["slider"] = self._slider()
        if driven and draw.often(45):
            self.tables["motion"] = self._motion()
        self.tables |= self._studies()
        if draw.often(70):
            self.tables["gate"] = [self._gate(i) for i in range(draw.randint(1, 5))]
        if draw.often(15):
            self.tables["claim"] = [self._claim(i) for i in range(draw.randint(1, 2))]

    @property
    def text(self):
        """As a file holds it."""
        return "".join(f"{name} = {toml(value)}\n" for name, value in self.tables.items())

    def _scales(self):
        """Length, the first frequency and the buckling load of a pinned beam, about."""
        draw, wild = self.draw, self.draw.often(15)
        self.length = draw.decade(-7, 5) if wild else draw.decade(-1.5, 0.7)
        self.thickness = self.length * (draw.decade(-6, 0) if wild else draw.decade(-3, -1.2))
        self.width = self.length * draw.decade(-2, -0.5)
        self.modulus = draw.decade(0, 15) if wild else draw.decade(9.5, 11.5)
        self.density = draw.decade(-2, 7) if wild else draw.decade(3, 4)
        self.mass = self.density * self.width * self.thickness * self.length
        self.stiffness = self.modulus * self.width * self.thickness**3 / 12
        self.hertz = pi / 2 * sqrt(self.stiffness / (self.mass * self.length**3))
        self.hertz = self.hertz if isfinite(self.hertz) and self.hertz > 0 else 50.0
        self.load = pi**2 * self.stiffness / self.length**2

    def _place(self):
        return self.length * self.draw.one(0.0, 1.0, 0.5, 0.23, self.draw.random(), self.draw.random())

    # ------------------------------------------------------------------------------------------------------- the beam

    def _section(self, kind):
        """What its section is told by."""
        draw = self.draw
        stuff = {"youngs_modulus": draw.value(self.modulus), "density": draw.value(self.density)}
        if kind == "plain":
            plain = {"bending_stiffness": draw.value(self.stiffness), "mass_per_length": self.mass / self.length}
            more = draw.table(
                rotary_inertia=(40, self.mass / self.length * self.thickness**2 / 12),
                shear_stiffness=(40, self.stiffness / self.thickness**2),
                extreme_fibre=(40, self.thickness / 2),
            )
            return plain | more
        if kind == "rectangle":
            return stuff | {"width": draw.value(self.width), "thickness": draw.value(self.thickness)}
        wall = {"wall_thickness": draw.value(self.thickness * draw.uniform(0.02, 0.55))} if kind == "tube" else {}
        shape = draw.choice(SHAPES) if draw.often(3) else kind
        return stuff | {"shape": draw.value(shape), "diameter": self.thickness} | wall

    def _steps(self, kind):
        """Sections along the beam, in the words that its own section has."""
        draw = self.draw
        size = {"round": "diameter", "tube": "diameter", "plain": "bending_stiffness"}.get(kind, "thickness")
        usual = self.stiffness if kind == "plain" else self.thickness
        stuff = {} if kind == "plain" else {
            "youngs_modulus": (30, self.modulus * draw.decade(-1, 1)), "density": (30, self.density * draw.decade(-1, 1))
        }  # fmt: skip
        parts = [draw.random() + 0.02 for _ in range(draw.randint(1, 5))]
        return [
            draw.table(
                length=(100, self.length * part / sum(parts)),
                **{size: (50, usual * draw.decade(-0.1, 0.5))},
                **stuff,
            )
            for part in parts
        ]

    def _inside(self):
        """A place that nothing holds; now and then an end."""
        return self._place() if self.draw.often(5) else self.length * self.draw.uniform(0.1, 0.9)

    def _body(self):
        share = self.draw.decade(-2, 1)
        return self.draw.table(
            position=(99, self._inside),
            mass=(97, self.mass * share),
            rotary_inertia=(40, self.mass * share * self.length**2 * 1e-3),
        )

    def _spring(self):
        stiff = self.stiffness / self.length * self.draw.decade(-1, 3)
        return self.draw.table(
            position=(99, self._inside), stiffness=(97, stiff / self.length**2), rotational=(40, stiff)
        )

    def _beam(self):
        draw, kind = self.draw, self.draw.one("rectangle", "rectangle", "rectangle", "round", "tube", "plain")
        ends = draw.one(("pinned", "pinned"), (draw.choice(SUPPORTS), draw.choice(SUPPORTS)))
        more = draw.table(
            supports=(75, ends),
            loss_factor=(25, lambda: draw.one(0.0, 1e-3, 0.1, 2.0)),
            poissons_ratio=(10, lambda: draw.uniform(-0.5, 0.5)),
            section=(20, lambda: self._steps(kind)),
            mass=(20, lambda: draw.several(self._body, 3)),
            spring=(20, lambda: draw.several(self._spring, 3)),
            tension=(20, lambda: self.load * draw.one(draw.decade(-2, 2), -draw.random(), -1.5)),
            foundation=(15, lambda: self.load / self.length**2 * draw.decade(-1, 3)),
        )
        return {"length": draw.value(self.length), **self._section(kind), **more}

    # ---------------------------------------------------------------------------------------------- what happens to it

    def _hertz(self):
        """A frequency about some mode, in the middle of a gap, or on the mode."""
        return self.hertz * self.draw.randint(1, 9) ** 2 * self.draw.one(1.0, 1.13, self.draw.uniform(0.5, 1.9))

    def _force(self, side):
        draw = self.draw
        return draw.table(
            position=(100, 0.1 * self.length if draw.often(50) else self._place()),
            measured_from=(60, side),
            amplitude=(50, lambda: draw.one(1.0, 0.0, -2.0, draw.decade(-9, 9))),
            phase_deg=(60, lambda: draw.one(0.0, 90.0, draw.uniform(-400, 400))),
        )

    def _drive(self):
        draw = self.draw
        sides = draw.one((), ("left",), ("left", "right"), ("left", "right"), ("left", "left", "right"))
        return draw.table(
            frequency_hz=(100, self._hertz),
            force=(100, [self._force(side) for side in sides]),
            kind=(20, lambda: draw.one("force", "displacement")),
        )

    def _forces(self):
        """The forces that were drawn."""
        drive = self.tables.get("drive", {})
        return drive["force"] if isinstance(drive.get("force"), list) else []

    def _slider(self):
        draw = self.draw
        return draw.table(
            mass=(100, self.mass * draw.decade(-6, 0)),
            mu=(100, draw.decade(-2, 0.5)),
            **draw.one(
                {"slope": (60, lambda: draw.decade(-1, 5))},
                {"slope": (60, lambda: draw.decade(-1, 5)), "law": (100, "tanh")},
                {"slope": (5, 310.0), "law": (100, "coulomb"), "mu_static": (30, draw.decade(0.5, 1))},
            ),
            position=(40, self._place),
            speed=(20, lambda: draw.one(0.0, 1e-3, -0.4)),
            preload=(20, lambda: draw.decade(-4, 2)),
            coupling=(40, lambda: draw.one("auto", "one-way", "two-way")),
            line=(20, lambda: draw.one("spline", "raw")),
            kinematics=(40, lambda: draw.one("tangential", "following")),
            normal=(30, lambda: draw.one("held", "massless")),
        )

    def _motion(self):
        draw = self.draw
        return draw.table(
            duration=(100, draw.one(1.5, 4.0) / self.hertz / draw.one(1, 9, 40)),
            count=(100, draw.randint(2, 25)),
            counts=(80, lambda: sorted(draw.several(lambda: draw.randint(3, 25), 3))),
            samples=(70, lambda: draw.one(2, 11, 60)),
            **draw.one(
                {"soft_start_periods": (50, draw.one(0.0, 1.0, 30.0))}, {"start": (90, draw.one("rest", "steady"))}
            ),
            modal_damping=(30, lambda: draw.one(0.0, 0.01, 0.7)),
            steps_per_period=(20 if "slider" in self.tables else 1, lambda: draw.one(2, 16, 64)),
        )

    # ------------------------------------------------------------------------------------------------- what is asked

    def rules(self):
        """Options of the discrete models, several words of each."""
        draw = self.draw
        names = ("wall", "joints", "grading", "attachment", "theory")
        return draw.table(
            **{name: (15, lambda name=name: draw.several(lambda: draw.choice(WORDS[name]), 2)) for name in names}
        )

    def _studies(self):
        draw = self.draw
        sizes = lambda most: sorted(draw.several(lambda: draw.randint(2, most), 3))  # noqa: E731
        mode = lambda: draw.randint(1, 9)  # noqa: E731
        studies = {
            "spectrum": (15, lambda: {"modes": mode(), "count": draw.randint(2, 30)} | self.rules()),
            "convergence": (15, lambda: {"modes": draw.several(mode, 3), "counts": sizes(30)} | self.rules()),
            "sensitivity": (10, lambda: draw.table(mode=(100, mode), published_hz=(40, self.hertz * 4.1))),
            "wave": (25 if len(self._forces()) == 2 else 2, self._wave),
            "readings": (
                15 if self._forces() and "slider" in self.tables else 1,
                lambda: self._readings(draw.randint(3, 12)),
            ),
            "axial_inertia": (
                8 if self._forces() else 1,
                lambda: {"forces": [0.2], "shown": 0.3, "count": 5, "duration": 0.5 / self.hertz},
            ),
        }
        return draw.table(**studies)

    def _wave(self):
        draw = self.draw
        return draw.table(
            count=(90, draw.randint(4, 30)),
            counts=(90, lambda: sorted(draw.several(lambda: draw.randint(4, 40), 3))),
            model=(40, lambda: draw.choice(MODELS)),
            phase_deg=(90, (0.0, 180.0, draw.randint(2, 7))),
            reflection_limit=(20, draw.random),
        )

    def _readings(self, count):
        draw = self.draw
        return draw.table(
            kinematics=(70, ["tangential", "following"]),
            normal=(50, ["massless"]),
            forces=(80, [1.0, 3.3]),
            mu=(50, [0.2]),
            count=(100, count),
            duration=(60, 1.1 / self.hertz),
            chain=(20, True),
            shown=(80, draw.randint(0, 1)),
        )

    def arguments(self, quantity):
        """Of a quantity: those that it requires, and some others."""
        draw, given = self.draw, {}
        for one in QUANTITIES[quantity]:
            if one["required"] or one["name"] == "count" or draw.often(8):
                given[one["name"]] = draw.value(self._argument(one["name"], one["type"]))
        if given.get("model", "analytic") == "analytic" and "model" in {one["name"] for one in QUANTITIES[quantity]}:
            given = {name: value for name, value in given.items() if name not in OF_PARTS or draw.often(2)}
        return given

    def _argument(self, name, kind):
        draw = self.draw
        if name in WORDS and name != "grading":
            return draw.choice(kind.split(" | ")) if " | " in kind else draw.choice(WORDS[name])
        known = {
            "mode": lambda: draw.randint(1, 9),
            "count": lambda: draw.randint(2, 40),
            "counts": lambda: sorted({draw.randint(4, 50) for _ in range(3)}),
            "modes": lambda: draw.randint(1, 9),
            "segments": lambda: draw.randint(2, 12),
            "frequency_hz": self._hertz,
            "position": lambda: 0.3 * self.length * draw.random(),
            "slider_position": self._place,
            "x": self._place,
            "window": lambda: (0.3 * self.length, 0.7 * self.length),
            "time": lambda: 2.0 / self.hertz / draw.randint(1, 9),
            "step": lambda: 0.003 / self.hertz,
            "steps": lambda: [0.01 / self.hertz, 0.005 / self.hertz],
            "error": lambda: draw.decade(-5, -1),
            "mass": lambda: self.mass * draw.decade(-6, 0),
            "phase_deg": lambda: draw.uniform(0, 180),
            "grading": lambda: draw.choice(WORDS["grading"]),
            "node": lambda: draw.randint(1, 3),
        }
        if name in known:
            return known[name]()
        if " | " in kind:
            return draw.choice(kind.split(" | "))
        return draw.randint(1, 5) if "whole" in kind else draw.decade(-3, 1)

    def quantity(self):
        """The name of one."""
        return self.draw.choice(tuple(QUANTITIES))

    def _gate(self, i):
        draw, quantity = self.draw, self.quantity()
        band = draw.one({"at_least": 0.0}, {"at_most": 1.0}, {"expect": self.hertz, "within": 0.1 * self.hertz})
        return {
            "id": draw.value(f"g{i}"),
            "quantity": draw.value(quantity),
            "arguments": draw.value(self.arguments(quantity)),
            "why": draw.value("drawn"),
            **{name: draw.value(value) for name, value in band.items()},
        }

    def _claim(self, i):
        quantity = self.quantity()
        value = self.draw.one(
            {"value": "negative"}, {"value": self.hertz, "tolerance": 0.1 * self.hertz}, {"at_least": 0.0}
        )
        arguments = {} if self.draw.often(40) else {"arguments": self.arguments(quantity)}
        return {"id": f"c{i}", "quantity": quantity, "source": "drawn", "read": "stated"} | value | arguments
