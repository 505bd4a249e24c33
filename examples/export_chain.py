"""
A chain for another engine, its modes for ParaView
==================================================

A multibody program needs lengths, masses, inertias and joint springs of the links. They are written as JSON, and a
substitute for the program reads them: its frequencies have to agree with those of the model. The shapes go to a vtu
file.
"""

import json
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import meshio
import numpy as np
from scipy.linalg import eigh

from verify import Beam, SegmentModel
from verify.engines.writers import write

beam = Beam(length=0.31, width=0.025, thickness=0.003, youngs_modulus=205e9, density=7850, supports=("clamped", "free"))
n, folder = 24, Path(tempfile.mkdtemp())
model = SegmentModel(beam, n)
modes = model.modes(5)

# %%
# Gregory's weights at the wall make the first three joints stiffer or softer than EI/l. Other suffixes are other
# engines: .xml is MuJoCo.
write(model.rigid_chain(), folder / "chain.json")

# %%
# The other program: angles of the links as unknowns, joints between neighbours.
read = json.loads((folder / "chain.json").read_text())
springs = [joint["hinges"][0]["stiffness"] for joint in read["joints"][:-1]]
lengths, masses, spins = np.array([(one["length"], one["mass"], one["inertia"][1]) for one in read["links"]]).T
lever = (np.tril(np.ones((n, n)), -1) + 0.5 * np.eye(n)) * lengths
turn = np.eye(n) - np.eye(n, k=-1)
stiffness = turn.T @ np.diag(springs) @ turn
inertia = lever.T @ np.diag(masses) @ lever + np.diag(spins)
frequencies = np.sqrt(eigh(stiffness, inertia, eigvals_only=True)[:5]) / (2 * np.pi)
difference = float(abs(frequencies / modes.frequencies_hz - 1.0).max())

# %%
# Modes as vectors at the joints: Warp By Vector in ParaView. meshio reads the file again.
x = modes.nodes
points, shapes = np.stack([x, 0 * x, 0 * x], axis=1), modes.deflection(x)
data = {f"mode_{i + 1}": np.stack([0 * x, shape, 0 * x], axis=1) for i, shape in enumerate(shapes)}
meshio.write(folder / "modes.vtu", meshio.Mesh(points, [("line", np.stack([range(n), range(1, n + 1)], axis=1))], data))
fig, ax = plt.subplots(layout="constrained")
for name, values in meshio.read(folder / "modes.vtu").point_data.items():
    ax.plot(x, values[:, 1], ".-", label=name)
ax.set(xlabel="x, m", ylabel="mass-normalised deflection, 1/sqrt(kg)")
ax.legend()
plt.show()

print(f"largest difference of the frequencies: {difference:.1e}")
