"""
Wave map and best drive
=======================

Two actuators generate a travelling wave at suitable pairs of frequency and phase. The map shows the reflection, the
amplitude of the weaker wave over that of the stronger: 0 is a travelling wave, 1 a standing one. All phases follow from
two unit fields by superposition.
"""

import matplotlib.pyplot as plt
import numpy as np

from verify import Beam, ExactModel, PointForce, travelling_wave

beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
left, right = PointForce(position=0.0116), PointForce(position=0.4884)
model, window = ExactModel(beam), travelling_wave.middle_half(beam)

# %%
# Forward and backward wave of each actuator alone, then every phase of the right one.
frequencies, phases = np.linspace(4150.0, 4350.0, 41), np.linspace(-180.0, 180.0, 121)
lead = np.exp(1j * np.deg2rad(phases))
reflection = []
for frequency in frequencies:
    one, other = (
        travelling_wave.two_waves(model.harmonic([force], frequency), window, model.wavenumber(frequency))
        for force in (left, right)
    )
    forward, backward = abs(one.forward + lead * other.forward), abs(one.backward + lead * other.backward)
    reflection.append(np.minimum(forward, backward) / np.maximum(forward, backward))

# %%
# The best phase of equal forces at the paper's 4276 Hz is -kL (modulo 360 degrees), wherever the forces are.
case = travelling_wave.DrivenCase(model=model, forces=(left, right), frequency_hz=4276.0)
best = travelling_wave.best_drive(case)
fig, ax = plt.subplots(layout="constrained")
mesh = ax.pcolormesh(frequencies, phases, np.array(reflection).T, vmin=0.0, vmax=1.0, cmap="viridis_r", rasterized=True)
fig.colorbar(mesh, label="reflection")
ax.plot(4276.0, best.phase_deg, "o", color="white", markeredgecolor="black", label=f"best: {best.phase_deg:.2f}°")
ax.plot(4276.0, 90.0, "+", color="red", markersize=10, label="the paper's drive")
ax.set(xlabel="frequency, Hz", ylabel="lead of the right actuator, degrees")
ax.legend(loc="lower left")
plt.show()

print(f"best phase at 4276 Hz: {best.phase_deg:.3f} degrees")
