"""
Volts, not newtons: the wave of a beam on two stacks
====================================================

A stack of piezoelectric layers on a fixed base is much stiffer than the beam. Its voltage imposes a displacement, and
the wave of two voltages is not that of two forces with the same phases: it may run the other way.
"""

import matplotlib.pyplot as plt
import numpy as np

from verify import Beam, ExactModel, Mounted, PointForce, Stack, on_beam, travelling_wave

# %%
# The paper's beam at 4276 Hz with two forces, or two stacks of 20 layers of PZT-4, at 11.6 mm from its ends.
beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
stack = Stack(layers=20, layer_thickness=0.5e-3, area=25e-6)
model, hertz, window = ExactModel(beam), 4276.0, (0.125, 0.375)


def forced(phase):
    """Wave of two forces of 1 N."""
    second = PointForce(position=0.4884, phase_deg=phase)
    return travelling_wave.measure(model.harmonic([PointForce(position=0.0116), second], hertz), window)


def driven(phase):
    """Wave of two voltages of 1 V."""
    first = Mounted(actuator=stack, position=0.0116, voltage=1.0)
    second = Mounted(actuator=stack, position=0.4884, voltage=np.exp(1j * np.deg2rad(phase)))
    return travelling_wave.measure(on_beam(model, [first, second], hertz).field, window)


# %%
# The reflection, negative where the stronger wave runs towards -x: at 90 degrees forces and voltages differ in sign.
phases = np.arange(5.0, 180.0, 5.0)
fig, ax = plt.subplots(layout="constrained")
for name, wave in (("forces", forced), ("voltages of stacks", driven)):
    waves = [wave(phase).waves for phase in phases]
    ax.plot(phases, [one.direction * one.reflection for one in waves], ".", label=name)
ax.set(xlabel="phase of the second actuator, degrees", ylabel="reflection, with the sign of the stronger wave")
ax.legend()
plt.show()

ratio = driven(90.0).standing_wave_ratio
print(f"standing-wave ratio at 90 degrees: {forced(90.0).standing_wave_ratio:.4f} forces, {ratio:.4f} voltages")
