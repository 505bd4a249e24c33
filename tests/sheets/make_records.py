"""Make the records of `records/`: known defects of chains and contacts, small, in MuJoCo. Not run by pytest.

python tests/sheets/make_records.py. The steel cantilever of the sheet ring-down in a plane without gravity, 12 links;
the other records are of the recording scripts of the sheets.
"""

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import mujoco
import numpy as np

from verify.sheets.write import write

HERE = Path(__file__).parent
LENGTH, WIDTH, THICKNESS, YOUNG, DENSITY = 0.3, 0.025, 0.003, 206e9, 7850.0
STIFFNESS, LINE = YOUNG * WIDTH * THICKNESS**3 / 12.0, DENSITY * WIDTH * THICKNESS  # N m^2, kg/m
COUNT, FORCE, ZETA = 12, 0.12, 0.002  # -, N, of mode 1
OMEGA = 1.8751040687119611**2 / LENGTH**2 * np.sqrt(STIFFNESS / LINE)
PERIOD, ROWS = 0.0005, 1001  # s between samples


def cantilever(step, integrator="Euler", first_fixed=False, points=False):
    """MJCF of the chain: joints EI/l, 2EI/l at the wall."""
    link = LENGTH / COUNT
    mass, bodies = LINE * link, ""
    middle, inertia = (link, 1e-12) if points else (0.5 * link, mass * link**2 / 12.0)
    for i in range(COUNT):
        stiffness = STIFFNESS / link * (2.0 if i == 0 else 1.0)
        each = f'stiffness="{stiffness}" damping="{2.0 * ZETA / OMEGA * stiffness}"'
        joint = "" if first_fixed and i == 0 else f'<joint type="hinge" axis="0 -1 0" {each}/>'
        bodies += f'<body pos="{link * (i > 0)} 0 0">{joint}'
        bodies += f'<inertial pos="{middle} 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>'
    bodies += f'<site name="tip" pos="{link} 0 0"/>' + "</body>" * COUNT
    option = f'<option timestep="{step}" integrator="{integrator}" gravity="0 0 0"/>'
    return f"<mujoco>{option}<worldbody>{bodies}</worldbody></mujoco>"


def ring(text, lagged=False):
    """(time, deflection) after the release of a static tip force. `lagged`: springs from angles of the last step."""
    model = mujoco.MjModel.from_xml_string(text)
    data, each = mujoco.MjData(model), round(PERIOD / model.opt.timestep)
    mujoco.mj_forward(model, data)
    stiffness = model.jnt_stiffness.reshape(model.nv, -1)[:, 0].copy()
    data.qpos[:] = FORCE * (LENGTH - data.xanchor[:, 0]) / stiffness
    before = data.qpos.copy()
    if lagged:
        model.jnt_stiffness[:] = 0.0
    rows = []
    for k in range(ROWS):
        mujoco.mj_forward(model, data)
        rows.append((k * PERIOD, data.site("tip").xpos[2]))
        for _ in range(each):
            if lagged:
                data.qfrc_applied[:], before = -stiffness * before, data.qpos.copy()
            mujoco.mj_step(model, data)
    return rows


def recorded(sheet, *options):
    """Table and header of the recording script of a sheet."""
    out = HERE / "run.csv"
    with TemporaryDirectory() as folder:
        write(sheet, Path(folder), "mujoco")
        subprocess.run([sys.executable, "mujoco_record.py", "--out", out, *options], cwd=folder, check=True)
    header, table = out.read_text().partition("\n")[0], np.loadtxt(out, delimiter=",", skiprows=1)
    out.unlink()
    return table, header


RINGS = {
    "ring-down": (cantilever(2.5e-5), False),
    "first-link-fixed": (cantilever(2.5e-5, first_fixed=True), False),
    "point-masses": (cantilever(2.5e-5, points=True), False),
    "implicit-euler": (cantilever(2.5e-4, "discrete"), False),
    "lagged-springs": (cantilever(1e-5), True),
}
RUNS = {
    "creeping-block": ("ramp-stick",),
    "pyramidal-cone": ("ramp-slip",),
    "damped-sag": ("damped-sag", "--springdamper"),
    "swinging-chain": ("swinging-chain",),
}


def main():
    tables = {name: (ring(*each), "time,deflection") for name, each in RINGS.items()}
    tables |= {name: recorded(*each) for name, each in RUNS.items()}
    for name, (table, header) in tables.items():
        path = HERE / "records" / f"{name}.csv"
        np.savetxt(path, table, delimiter=",", fmt="%.7g", header=header, comments="")


if __name__ == "__main__":
    main()
