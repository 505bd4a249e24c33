"""
The paper's figures: beam, wave and slider
==========================================

The travelling-wave motor of Collard, Vloebergh, Fisette and others: 500 x 20 x 1 mm of aluminium, two actuators 11.6
mm from the ends, 4276 Hz, modelled by 49 rigid segments. Pinned ends and material are inferred.
"""

import matplotlib.pyplot as plt
import numpy as np

from verify import Beam, ExactModel, Excitation, HermiteModel, PointForce, SegmentModel, Slider, simulate

beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
forces = [PointForce(position=0.0116), PointForce(position=0.4884, phase_deg=90.0)]
exact = ExactModel(beam)
models = {"49 segments": SegmentModel(beam, 49), "49 Hermite elements": HermiteModel(beam, 49)}

# %%
# The drive frequency is next to mode 22, which is 0.43 % too low with 49 segments.
reference = exact.modes(30).frequencies_hz
errors = {name: model.modes(30).frequencies_hz / reference - 1.0 for name, model in models.items()}
error_22 = errors["49 segments"][21]

# %%
# The slider of Figures 3 and 4 under a step load of 30 N: it follows the surface and moves to the left, against the
# wave. The paper states neither force nor start nor kinematics; the speed depends on all three.
strong = [PointForce(position=f.position, amplitude=30.0, phase_deg=f.phase_deg) for f in forces]
slider = Slider(mass=1.0193679918450561e-3, mu=0.2, kinematics="following", normal="massless", coupling="one-way")
motion = simulate(beam, Excitation(strong, 4276.0), 1e-3, count=49, slider=slider)

# %%
# A frequency error of 0.4 % detunes the wave: the ripple of its envelope is due to reflection.
fig, axes = plt.subplots(2, 2, figsize=(9, 6), layout="constrained")
for name, values in errors.items():
    axes[0, 0].plot(np.arange(1, 31), 100.0 * values, ".-", label=name)
x = np.linspace(0.0, beam.length, 1001)
for name, model in {"exact beam": exact, "49 segments": models["49 segments"]}.items():
    axes[0, 1].plot(1e3 * x, 1e6 * abs(model.harmonic(forces, 4276.0).deflection(x)), label=name)
axes[1, 0].plot(1e3 * motion.times, 1e6 * motion.travelled, label=f"mean speed {100 * motion.mean_speed:.2f} cm/s")
axes[1, 1].plot(1e3 * motion.times, 1e3 * motion.friction)
axes[0, 0].set(xlabel="mode", ylabel="frequency error, %")
axes[0, 1].set(xlabel="x, mm", ylabel="amplitude at 1 N, µm")
axes[1, 0].set(xlabel="time, ms", ylabel="displacement, µm")
axes[1, 1].set(xlabel="time, ms", ylabel="friction on the slider, mN")
for ax in axes.flat[:3]:
    ax.legend()
plt.show()

print(f"mode 22 by 49 segments: {100 * error_22:+.3f} %")
