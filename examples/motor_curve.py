"""
Force over speed of a motor
===========================

A clasp of two feet is pressed on the upper and the lower face of the beam of the scene ``preloaded-motor``. Its mean
friction force is computed at prescribed speeds, as on a test bench. The result is the force-speed curve of the motor.
"""

import matplotlib.pyplot as plt
import numpy as np

from verify import Excitation, PrescribedSlider, load_scene, simulate

scene = load_scene("preloaded-motor")
frequency, slider = scene.drive.frequency_hz, scene.slider
excitation = Excitation(scene.forces, frequency)

# %%
# From standstill to the crest speed, 2.83 cm/s against the wave. Each run continues the one before: 32 periods
# settle, the next 32 are averaged.
speeds = np.linspace(0.0, -0.0283, 17)
forces, run = [], "steady"
for speed in speeds:
    held = PrescribedSlider(slider, speed, fixed_position=True)
    for _ in range(2):
        run = simulate(scene.beam, excitation, 32 / frequency, model="analytic", slider=held, start=run)
    forces.append(run.mean_friction)
forces = np.array(forces)

# %%
# At standstill all points slip in one direction: the stall force is mu N. Power is largest at three quarters of the
# crest speed; at the no-load speed the points near the crests drive as much as their neighbours brake.
no_load = float(np.interp(0.0, forces, speeds))
fig, ax = plt.subplots(layout="constrained")
ax.plot(100 * speeds, 1e3 * forces, "o-", label="force")
ax.axhline(-1e3 * slider.mu * slider.preload, color="grey", linestyle="--", label="mu N")
ax.set(xlabel="speed, cm/s", ylabel="mean force on the slider, mN", title=f"no load: {100 * no_load:.2f} cm/s")
power = ax.twinx()
power.plot(100 * speeds, 1e3 * forces * speeds, "s-", color="tab:orange", label="power")
power.set_ylabel("power, mW")
fig.legend(loc="outside lower center", ncols=3)
plt.show()

print(f"stall force {1e3 * forces[0]:+.2f} mN, no-load speed {100 * no_load:+.3f} cm/s")
