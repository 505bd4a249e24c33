"""
Choose the number of segments or elements
=========================================

How many parts are required for an error of mode 22 of the paper's beam below 1 %? The first size below the limit is not
sufficient: the error has to be below it for all larger sizes. ``verify choose paper --mode 22 --error 1%`` prints the
same numbers, with solve times.
"""

import matplotlib.pyplot as plt

from verify import Beam, ExactModel, HermiteModel, SegmentModel

beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
mode, limit = 22, 0.01
exact = ExactModel(beam).modes(mode).frequencies_hz[-1]

# %%
# Segments lie below the exact frequency and elements above it, both with order 4.
counts = range(mode + 1, 121)
errors = {
    "segments": [SegmentModel(beam, n).modes(mode).frequencies_hz[-1] / exact - 1.0 for n in counts],
    "Hermite elements": [HermiteModel(beam, n).modes(mode).frequencies_hz[-1] / exact - 1.0 for n in counts],
}
sufficient = {}
for name, values in errors.items():
    beyond = [n for n, error in zip(counts, values, strict=True) if abs(error) > limit]
    sufficient[name] = max(beyond, default=mode) + 1

# %%
# At order 4 a quarter of the error requires 41 % more parts.
fig, ax = plt.subplots(layout="constrained")
for name, values in errors.items():
    (line,) = ax.loglog(counts, [100.0 * abs(error) for error in values], label=f"{name}: {sufficient[name]}")
    ax.axvline(sufficient[name], color=line.get_color(), linestyle=":")
ax.axhline(100.0 * limit, color="grey", linestyle="--")
ax.set(xlabel="number of parts", ylabel=f"|frequency error| of mode {mode}, %")
ax.set_xticks(ticks := [25, 35, 42, 60, 80, 120], map(str, ticks))
ax.minorticks_off()
ax.legend(title="parts for 1 %")
plt.show()

print(f"segments for 1 % at mode {mode}: {sufficient['segments']}")
