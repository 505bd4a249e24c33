"""Scenes of a second kind: motors on feet that leave the beam, devices that end a wave, benches, stress rows."""

from drawn_lines import QUICK_ROWS
from drawn_scenes import MODELS, OF_PARTS, QUANTITIES, Drawn


class Further(Drawn):
    """A scene whose slider may leave the beam, whose drive may end in a device, and that asks for what others do not."""

    def __init__(self, draw):
        self.kind = draw.one("still", "wave", "slider", "motor", "motor", "device")
        super().__init__(draw)
        gates = self.tables.get("gate")
        if isinstance(gates, list):
            self.tables["gate"] = gates[:2]
        if self.kind != "still":
            self.tables["drive"] = draw.value(self._drive())
        if self.kind in ("slider", "motor") or draw.often(30):
            self.tables["slider"] = draw.value(self._slider())
        if self.kind == "slider":
            self.tables["motion"] = draw.value(self._motion())
        for name in {"motor": ("motor",), "device": ("methods",), "wave": ("wave",)}.get(self.kind, ()):
            self.tables[name] = draw.value(getattr(self, f"_{name}")())
        if self.kind == "device":
            self.tables.pop("motion", None)

    def _beam(self):
        """Of what moves in time or carries waves mostly one that all models take."""
        beam, plain = super()._beam(), self.kind != "still" and self.draw.often(75)
        taken = ("mass", "section") if self.kind in ("slider", "motor") else ("loss_factor",)
        names = {"tension", "foundation", "spring", "mass", "section"} - {*taken} if plain else ()
        ends = {"supports": ("pinned", "pinned")} if plain and self.draw.often(70) else {}
        return {name: value for name, value in beam.items() if name not in names} | ends

    def _slider(self):
        draw, slider = self.draw, super()._slider()
        if self.kind == "slider" or draw.often(20):
            return slider
        leaves = draw.table(
            contact=(97, self._contact),
            foot=(60, lambda: draw.several(self._foot, 3)),
            gravity=(50, lambda: draw.one(0.0, 9.81, 1.62)),
            preload=(80, lambda: self.mass * draw.decade(-1, 2)),
            pull=(20, lambda: self.mass * draw.uniform(-1, 1)),
            preload_stiffness=(15, lambda: self.stiffness / self.length**3 * draw.decade(-2, 2)),
            coupling=(60, lambda: draw.one("auto", "one-way", "two-way")),
        )
        kept = ("mass", "mu", "law", "mu_static", "slope", "position", "speed", *(("line",) if draw.often(3) else ()))
        return {name: value for name, value in slider.items() if name in kept} | leaves

    def _contact(self):
        draw, stiff = self.draw, self.stiffness / self.length**3 * self.draw.decade(1, 5)
        if draw.often(15):
            return draw.table(restitution=(70, lambda: draw.one(0.0, 0.5, 1.0, draw.random())))
        if draw.often(20):
            return draw.table(
                layer_stiffness=(97, stiff / self.length),
                layer_tangential_stiffness=(40, stiff / self.length * draw.decade(-1, 1)),
                damping=(50, lambda: draw.decade(-3, 2)),
            )
        return draw.table(
            stiffness=(97, stiff),
            damping=(70, lambda: draw.one(0.0, stiff / self.hertz * draw.decade(-5, -1))),
            tangential_stiffness=(40, lambda: stiff * draw.decade(-1, 1)),
            restitution=(3, 0.4),
        )

    def _foot(self):
        draw = self.draw
        wide = draw.often(60) * 100 + 2  # one of several points
        return draw.table(
            length=(wide, lambda: self.length * draw.decade(-2.5, -0.7)),
            points=(wide, lambda: draw.one(2, 3, 7)),
            offset=(50, lambda: self.length * draw.uniform(-0.2, 0.2)),
            mass=(20, lambda: self.mass * draw.decade(-5, -1)),
            inertia=(0.15 * wide, lambda: self.mass * self.length**2 * draw.decade(-9, -4)),
            pitches=(0.2 * wide, lambda: draw.one(True, False)),
            face=(40, lambda: draw.one("upper", "lower")),
            mirrored=(15, lambda: draw.one(True, False)),
        )

    def _drive(self):
        draw, device = self.draw, self.kind == "device" or self.draw.often(3)
        sides = ("left",) if device else draw.one(("left", "right"), ("left", "right"), ("left",))
        drive = {"frequency_hz": draw.value(self._hertz()), "force": [self._force(side) for side in sides]}
        return drive | ({"device": [self._device()]} if device else {})

    def _force(self, side):
        """Inside, at one distance more often than not."""
        place = self.length * self.draw.one(0.1, 0.1, self.draw.uniform(0.03, 0.3))
        return super()._force(side) | {"position": self.draw.value(place), "measured_from": side}

    def _device(self):
        draw, impedance = self.draw, (self.mass * self.stiffness / self.length**3) ** 0.5 * self.draw.decade(-1, 2)
        return draw.table(
            position=(99, lambda: self.length * draw.one(0.1, draw.random())),
            measured_from=(90, "right"),
            dashpot=(90, impedance),
            stiffness=(50, impedance * self.hertz * draw.decade(-1, 2)),
            mass=(25, self.mass * draw.decade(-3, 0)),
            rotational=(15, self.stiffness / self.length * draw.decade(-1, 2)),
            rotational_dashpot=(15, impedance * self.length**2 * draw.decade(-2, 0)),
            rotary_inertia=(15, self.mass * self.length**2 * draw.decade(-5, -2)),
            amplitude=(15, lambda: draw.decade(-3, 1)),
            phase_deg=(15, lambda: draw.uniform(-400, 400)),
        )

    def _studies(self):
        draw, few = self.draw, super()._studies()
        few = {name: value for name, value in few.items() if draw.often(30)}
        return few | draw.table(
            motor=(2, self._motor),
            methods=(2, self._methods),
            bench=(8, self._bench),
            stress=(5, lambda: {"rows": draw.several(lambda: draw.choice(QUICK_ROWS), 2)}),
            sensitivity=(
                10,
                lambda: {"mode": draw.randint(1, 9), "modulus_spread": draw.random(), "density_spread": 0.1},
            ),
        )

    def _motor(self):
        draw = self.draw
        return draw.table(
            models=(80, lambda: sorted({draw.choice((*MODELS, "chain")) for _ in range(2)})),
            count=(90, lambda: draw.randint(2, 30)),
            speeds=(90, lambda: draw.randint(2, 5)),
            periods=(95, lambda: draw.one(20, 50, 200)),
            start=(30, lambda: draw.one("rest", "steady")),
            soft_start_periods=(20, lambda: draw.one(0.0, 3.0)),
            modal_damping=(20, lambda: draw.one(0.0, 0.01, 0.4)),
            steps_per_period=(30, lambda: draw.one(16, 61, 120)),
            chain=(20, lambda: 3.0 / self.hertz),
            chain_force=(15, lambda: draw.decade(-2, 1)),
            links=(15, lambda: draw.one(["rigid"], ["rigid", "stretching"])),
            places=(20, lambda: draw.randint(2, 4)),
        )

    def _methods(self):
        draw = self.draw
        return draw.table(
            phase_deg=(40, lambda: draw.uniform(-180, 180)),
            span_hz=(60, lambda: self.hertz * draw.decade(-2, 0)),
            steps=(90, lambda: draw.randint(3, 9)),
            factors=(40, lambda: sorted(draw.several(lambda: draw.decade(-1, 1), 3))),
            load_position=(20, self._place),
            load_mass=(30, lambda: draw.several(lambda: self.mass * draw.decade(-4, 0), 2)),
            load_dashpot=(30, lambda: draw.several(lambda: draw.decade(-2, 2), 2)),
            modes=(20, lambda: draw.one([1, 2], [3, 4], [2, 2])),
            count=(90, lambda: draw.randint(2, 40)),
            duration=(60, 1.3 / self.hertz),
        )

    def _bench(self):
        draw = self.draw
        return {"seconds": 0.3, "imports": False, "peers": False, "rounds": 3} | draw.table(
            sets=(95, lambda: draw.several(lambda: draw.one("modes", "harmonic", "transient", "slider", "chain"), 2)),
            counts=(95, lambda: sorted({draw.randint(3, 30) for _ in range(3)})),
            modes=(60, lambda: draw.several(lambda: draw.randint(1, 9), 2)),
            duration=(50, 1.0 / self.hertz),
            x=(40, self._place),
        )

    def _wave(self):
        draw = self.draw
        more = draw.table(
            frequency_hz=(50, lambda: [self.hertz * 3.1, self.hertz * draw.uniform(3.2, 9.0), draw.randint(2, 5)]),
            quantity=(40, lambda: draw.choice([name for name in QUANTITIES if name.startswith("wave.")])),
            operating_loss_factor=(20, lambda: draw.one(1e-3, 0.1)),
        )
        return super()._wave() | more

    def arguments(self, quantity):
        """With a model named, and parts where it has any: what the first kind leaves out is refused before it runs."""
        draw, given = self.draw, super().arguments(quantity)
        kinds = {one["name"]: one["type"] for one in QUANTITIES[quantity]}
        if "model" in kinds:
            given["model"] = draw.value(draw.choice(kinds["model"].split(" | ")))
        if given.get("model") == "analytic":
            given = {name: value for name, value in given.items() if name not in OF_PARTS}
        elif "count" in kinds and "count" not in given:
            given["count"] = draw.value(draw.randint(2, 30))
        return given

    def quantity(self):
        """One that the scene has what it takes for."""
        of = {"still": ("mode.", "beam.", "chain."), "wave": ("wave.",), "device": ("wave.", "mode.")}
        names = of.get(self.kind, ("slider.", "motion.", "contact."))
        known = [name for name in QUANTITIES if name.startswith(names)]
        return super().quantity() if self.draw.often(10) else self.draw.choice(known)

    def _gate(self, i):
        draw, gate = self.draw, super()._gate(i)
        if draw.often(20) and "expect" in gate:
            gate["expect"] = draw.value({"re": self.hertz, "im": -0.5 * self.hertz})
        if not isinstance(gate.get("within"), float) or draw.often(60):
            return gate
        return gate | draw.table(
            reference=(97, lambda: draw.one("closed form", "regression", "promise", "published")),
            uncertainty=(90, lambda: gate["within"] * draw.decade(-3, 0.1)),
            source=(90, "drawn"),
        )
