"""What a plan says that a bench or a stress table leaves out is not done by its run, whatever else it does."""

import pytest
from counted import counted

BEAM = """
name = "mine"
title = "mine"
[beam]
length = 0.43
width = 0.021
thickness = 0.0013
youngs_modulus = 68e9
density = 2650.0
"""
DRIVEN = BEAM + "[drive]\nfrequency_hz = 317.0\nforce = [{ position = 0.11, amplitude = 0.2 }]\n"
RIDDEN = DRIVEN + "[slider]\nmass = 0.01\nmu = 0.3\n\n[motion]\nduration = 4e-3\ncounts = [7, 9]\ncount = 7\n"
BENCH = "[bench]\ncounts = [7, 9]\nmodes = [1]\nimports = false\npeers = false\nseconds = 2.0\nrounds = 3\nsets = "
SCENES = {
    "modes": BEAM + BENCH + '["modes"]',
    "fields": DRIVEN + BENCH + '["harmonic"]',
    "beams in time": DRIVEN + BENCH + '["transient"]',
    "sliders": RIDDEN + BENCH + '["slider"]',
    "chains": DRIVEN + BENCH + '["chain"]',
    "all but modes": DRIVEN + BENCH + '["transient", "chain", "harmonic"]',
    "promises": BEAM + '[stress]\nrows = ["friction-slope", "rolled-up", "segments-parts"]',
    "a promise as a gate": BEAM
    + '[[gate]]\nid = "a"\nquantity = "stress.share"\nwhy = "w"\nat_most = 1\narguments = { row = "friction-slope" }',
}
LEFT_OUT = {
    "harmonic response": "fields",
    "time stepping": "simulations",
    "contact search": "contact",
    "slider": "contact",
    "numba": "compilations",
}
"""By what a plan says is skipped, what a run then does not."""
LOADED = {"numpy, scipy, scikit-fem": {"numpy", "scipy", "skfem"}, "scikit-fem": {"skfem"}, "numba": {"numba"}}
LISTED = {"fields": ("harmonic", "promises", "stepped"), "simulations": ("stepped", "promises")}
"""By what is done, where a plan may have said so."""


@pytest.mark.parametrize("kind", SCENES)
def test_a_table_does_nothing_that_its_plan_calls_skipped(kind, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENES[kind])
    plan = counted(tmp_path, "plan", "mine.toml", "--json").told
    run = counted(tmp_path, "run", "mine.toml", "--no-report", "--json")
    for skipped, why in ((one["what"], one["why"]) for one in plan["skipped"]):
        assert not run.work.get(LEFT_OUT.get(skipped)) or "fields are solved for" in why, skipped
        assert not LOADED.get(skipped, set()) & run.libraries, skipped
    for work, fields in LISTED.items():
        assert not run.work.get(work) or any(plan[name] for name in fields), work
