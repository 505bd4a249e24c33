"""A chain's file beside a record of its run in MuJoCo: agreement to the last digits, and the cause where there is none."""

import re

import numpy as np
import pytest

from verify import engine_chain
from verify.cli import status_of

mujoco = pytest.importorskip("mujoco")


def recorded(source, target, integrator, step, duration, every=1):
    """Write angles of the first joint and heights of the tip of a small vibration to a file."""
    model = mujoco.MjModel.from_xml_path(str(source))
    model.opt.integrator, model.opt.timestep = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}"), step
    data, rows = mujoco.MjData(model), []
    data.qpos[:3] = 2e-5, 1e-5, -3e-5
    mujoco.mj_forward(model, data)
    for k in range(round(duration / step)):
        if k % every == 0:
            rows.append((1e3 * data.time, data.qpos[0], 1e3 * data.site("tip").xpos[2]))
        mujoco.mj_step(model, data)
    np.savetxt(target, np.float32(rows), header="t_ms,angle,tip_mm", delimiter=",", comments="")


@pytest.fixture
def chain(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    engine_chain("steel-cantilever", 9, mode=2, damping="0.4%", step=1e-4, engine="MuJoCo:Euler", path="my.xml")
    return tmp_path / "my.xml"


def compared(capsys, *options):
    status = status_of(["compare", "my.xml", "ring.csv", "--mode", "2", *options])
    return status, " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(("integrator", "step"), [("Euler", 1e-4), ("implicit", 5e-5), ("RK4", 4e-5)])
def test_a_run_has_the_modes_that_its_file_has_at_its_step(chain, capsys, integrator, step):
    recorded(chain, "ring.csv", integrator, step, 0.3, round(2e-4 / step))
    status, text = compared(capsys, "--engine", f"MuJoCo:{integrator}", "--step", f"{step} s")
    assert status == 0
    off, points = re.search(r"2 modes within (\S+) % in frequency, (\S+) points", text).groups()
    assert float(off) < 0.01
    assert float(points) < 0.01


def test_damping_of_the_integrator_is_counted_in_the_record(chain, capsys):
    recorded(chain, "ring.csv", "discrete", 4e-4, 0.4)
    status, text = compared(capsys, "--engine", "MuJoCo:discrete", "--step", "0.4ms")
    assert status == 1
    zeta, added = map(float, re.search(r"mode 2 rings at (\S+) % damping, (\S+) points of it the int", text).groups())
    # An undamped oscillation has zeta = omega h/2 by implicit Euler, to first order; the file has 0.4 % f/f_1.
    assert zeta == pytest.approx(added + 0.4 * 6.27, abs=0.6)
    assert added == pytest.approx(100.0 * 2.0 * np.pi * 172.9 * 4e-4 / 2.0, rel=0.25)


def test_the_first_sentence_names_the_deviation(chain, capsys):
    text = chain.read_text()
    recorded(chain, "ring.csv", "Euler", 1e-4, 0.4, 3)
    chain.write_text(re.sub(r'stiffness="([\d.]+)"', lambda k: f'stiffness="{1.08 * float(k[1])!r}"', text))
    status, said = compared(capsys)
    assert status == 1
    assert said.startswith("Not to be trusted: the record disagrees with the file as it runs: mode ")
    assert "3.8 % low" in said  # 1/sqrt(1.08) - 1 = -3.77 %
    assert "stiffness over mass is 0.9259 times the file's" in said  # 1/1.08
    chain.write_text(text)
    status, said = compared(capsys, "--engine", "MuJoCo:discrete", "--step", "0.4ms")
    assert status == 1
    assert "The run has the file's damping without the integrator's" in said
    times = np.linspace(0.0, 1.0, 800)
    np.savetxt("ring.csv", np.c_[times, np.cos(41.0 * times)], header="t y", comments="")
    status, said = compared(capsys)
    assert "are none of the file's as it runs" in said
