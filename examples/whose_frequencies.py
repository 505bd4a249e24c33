"""
Identify a discretisation from its frequencies
===============================================

Eight natural frequencies of a steel cantilever come from another program. Their errors against the exact beam identify
its discretisation: wall rule and number of parts. ``verify compare`` does this with some forty
candidates and tests for wrong units, a missing mode and a compliant clamp.
"""

import matplotlib.pyplot as plt
import numpy as np

from verify import Beam, ExactModel, HermiteModel, SegmentModel

beam = Beam(length=0.3, width=0.025, thickness=0.003, youngs_modulus=206e9, density=7850, supports=("clamped", "free"))
listed = np.array([27.570, 172.561, 482.627, 944.652, 1559.74, 2327.21, 3246.43, 4316.71])  # Hz

# %%
# Candidates over their size: three rules for the joint at the wall, and consistent elements.
counts = range(10, 61)
candidates = {
    "segments, 2EI/l at the wall": lambda n: SegmentModel(beam, n, wall="half"),
    "segments, Gregory's weights": lambda n: SegmentModel(beam, n),
    "segments, half a link welded": lambda n: SegmentModel(beam, n, wall="welded"),
    "Hermite elements": lambda n: HermiteModel(beam, n),
}
rms = {}
for name, build in candidates.items():
    ratios = [build(n).modes(len(listed)).frequencies_hz / listed for n in counts]
    rms[name] = [float(np.sqrt(np.mean(np.log(ratio) ** 2))) for ratio in ratios]
best = min(rms, key=lambda name: min(rms[name]))
count = counts[int(np.argmin(rms[best]))]

# %%
# One candidate agrees at one size, by three orders of magnitude better than all others.
fig, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
left.plot(np.arange(1, 9), 100.0 * (listed / ExactModel(beam).modes(8).frequencies_hz - 1.0), "o-")
left.set(xlabel="mode", ylabel="error of the list, %")
for name, values in rms.items():
    right.semilogy(counts, values, label=name)
right.set(xlabel="number of parts", ylabel="rms difference of log frequencies", title=f"{best}, N = {count}")
right.legend(fontsize="small")
plt.show()

print(f"{best}, N = {count}, rms {min(rms[best]):.1e}")
