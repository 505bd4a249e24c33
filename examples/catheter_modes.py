"""
A catheter in space, its links and its modes
============================================

A curve with its bending and torsional stiffness, mass and section becomes a chain of rigid pieces for MuJoCo, Exudyn or
Gazebo. Joints lie on the curve and turn about the axes of the section there. All modes have bending and twist.
"""

import tempfile
from importlib.util import find_spec
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from scipy.linalg import eigh

from verify.engines.curved import curved_chain
from verify.engines.rod import read_rod

# %%
# 75 mm straight, then 200 degrees of an arc that rises out of its plane; softer towards the tip.
s = np.linspace(0.0, 1.0, 31)
turn = np.radians(200.0) * np.clip((s - 0.5) / 0.5, 0.0, 1.0)
steps = np.diff(s, prepend=0.0)[:, None] * np.stack([np.cos(turn), np.sin(turn), 0.3 * s], axis=1)
rows = np.column_stack([0.15 * np.cumsum(steps, axis=0), 1.1e-4 * (1.0 - 0.6 * s), 0.9e-4 * (1.0 - 0.3 * s)])
path = Path(tempfile.mkdtemp()) / "catheter.csv"
np.savetxt(path, rows, delimiter=",", header="x,y,z,EI,GJ", comments="")
rod = read_rod(path, ["rho_A=4e-3", "rho_Ip=2e-9"])

# %%
# Errors against the estimate from finer links.
counts = np.array([15, 60])
chains = [curved_chain(rod, np.linspace(0.0, rod.s[-1], n + 1)) for n in counts]
exact = chains[-1].exact_hz(n_modes=3)
errors = np.array([chain.frequencies_hz(n_modes=3) / exact - 1.0 for chain in chains])
error = float(abs(errors[0]).max())

# %%
# Shapes: every hinge turns all places beyond it about its axis.
chain = chains[0]
mass, stiffness = chain.matrices()
shapes = eigh(stiffness, mass, subset_by_index=[0, 2])[1]
axes = chain.axes_at
directions = {"bending": -axes[:, :, 1], "width": axes[:, :, 2], "torsion": axes[:, :, 0]}
fig = plt.figure(layout="constrained")
ax = fig.add_subplot(projection="3d")
ax.plot(*chain.places.T * 1e3, "k.-", label="at rest")
curves = [chain.places]
for mode, shape in enumerate(shapes.T):
    moved = np.zeros_like(chain.places)
    for (name, j, _), angle in zip(chain.unknowns("coupled"), shape, strict=True):
        about = directions[name.partition("_")[2]][j]
        moved[j:] += angle * np.cross(about, chain.places[j:] - chain.places[j])
    curves.append(chain.places + 0.03 * moved / np.linalg.norm(moved, axis=1).max())
    ax.plot(*curves[-1].T * 1e3, label=f"mode {mode + 1}: {exact[mode]:.2f} Hz, {100.0 * errors[0, mode]:+.4f} %")
ax.set(xlabel="x, mm", ylabel="y, mm", zlabel="z, mm", title=f"{chain.count} rigid pieces")
ax.set_box_aspect(np.ptp(chain.places, axis=0) + 0.03)
ax.legend()
plt.show()

# %%
# With PyVista the same as tubes, in a picture next to the table.
if find_spec("pyvista"):
    import pyvista

    plotter = pyvista.Plotter(off_screen=True)
    for curve, colour in zip(curves, ("black", "tab:blue", "tab:orange", "tab:green"), strict=True):
        plotter.add_mesh(pyvista.Spline(curve, 400).tube(radius=7e-4), color=colour)
    plotter.screenshot(path.with_suffix(".png"))

print(f"largest error of {chain.count} pieces: {error:.1e}")
