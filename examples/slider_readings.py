"""
One slider, three models
========================

The speed of a slider depends on its model. Tangential: the friction law alone moves it. Following: it is constrained to
the surface, whose slope acts on it. On feet: it may lift off, and touches the crests. All three are on the same steady
wave.
"""

import matplotlib.pyplot as plt
from msgspec.structs import replace

from verify import Beam, Contact, Excitation, Foot, Keep, PointForce, Slider, simulate

beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
forces = [
    PointForce(position=0.0116, amplitude=9.0),
    PointForce(position=0.4884, amplitude=9.0, phase_deg=86.86),
]
frequency, periods = 4276.0, 200
excitation, keep = Excitation(forces, frequency), Keep(samples=periods + 1)

# %%
# The same mass and friction coefficient. The wave travels to the right; the material at its crests moves to the left.
point = Slider(mass=0.01, mu=0.2, law="coulomb", normal="massless", coupling="one-way", gravity=0.0, preload=0.2)
clasp = Slider(
    mass=0.01, mu=0.2, law="coulomb", coupling="one-way", gravity=0.0, preload=0.2,
    contact=Contact(stiffness=6.3e4, damping=0.1),
    foot=(Foot(length=0.0465, points=15), Foot(length=0.0465, points=15, face="lower")),
)  # fmt: skip
readings = {"tangential": point, "following": replace(point, kinematics="following"), "feet": clasp}

# %%
# Displacement over 200 periods. Only the feet approach the crest speed: a point in permanent contact moves back in the
# troughs almost as far as forward at the crests.
fig, ax = plt.subplots(layout="constrained")
speeds = {}
for name, slider in readings.items():
    motion = simulate(beam, excitation, periods / frequency, model="analytic", slider=slider, start="steady", keep=keep)
    late = len(motion.times) // 2
    speeds[name] = (motion.travelled[-1] - motion.travelled[late]) / (motion.times[-1] - motion.times[late])
    ax.plot(1e3 * motion.times, 1e3 * motion.travelled, label=f"{name}: {100 * speeds[name]:+.3g} cm/s at the end")
ax.set(xlabel="time, ms", ylabel="displacement, mm")
ax.legend()
plt.show()

speed = float(speeds["feet"])
print(f"slider on feet: {100 * speed:+.3f} cm/s")
