"""
Order of convergence on a stepped cantilever
============================================

With a step in section a chain converges with order 2 instead of 4, and with the joint as printed in the paper (Eq. (1),
two indices exchanged) with order 1. Hermite elements have a node at the step and remain of order 4.
"""

import matplotlib.pyplot as plt
import numpy as np

from verify import Beam, ExactModel, HermiteModel, Section, SegmentModel

# %%
# Steel, then titanium of half the thickness: both I and the modulus change at 180 mm.
beam = Beam(
    length=0.3, width=0.02, thickness=0.004, youngs_modulus=206e9, density=7850.0, supports=("clamped", "free"),
    section=[Section(length=0.18), Section(length=0.12, thickness=0.002, youngs_modulus=114e9, density=4430.0)],
)  # fmt: skip
mode, counts = 2, np.array([20, 40, 80, 160])
exact = ExactModel(beam).modes(mode).frequencies_hz[-1]
models = {
    "joints in series": lambda n: SegmentModel(beam, n),
    "joints as printed": lambda n: SegmentModel(beam, n, joints="printed"),
    "Hermite elements": lambda n: HermiteModel(beam, n),
}

# %%
# The observed order from size to size; it is meaningful only where two successive orders agree.
fig, ax = plt.subplots(layout="constrained")
orders = {}
for name, build in models.items():
    errors = np.array([abs(build(int(n)).modes(mode).frequencies_hz[-1] / exact - 1.0) for n in counts])
    orders[name] = -np.diff(np.log(errors)) / np.diff(np.log(counts))
    ax.loglog(counts, 100.0 * errors, "o-", label=f"{name}: {', '.join(f'{p:.2f}' for p in orders[name])}")
ax.set_xticks(counts, [str(n) for n in counts])
ax.minorticks_off()
ax.set(xlabel="number of parts", ylabel=f"|frequency error| of mode {mode}, %")
ax.legend(title="observed orders")
plt.show()

order = float(orders["joints in series"][-1])
print(f"order with joints in series: {order:.3f}")
