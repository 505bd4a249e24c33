"""Sliders that may leave the beam: feet on springs or hard impacts, and the characteristics of a motor.

`run` (arguments), `combine` (refusals), `setup` (stages, coupling, step), `feet` (arrays, rest), `stepping` (loop) or
`on_chain`, `outcome` and `result`. `steady_state`, `curves`, `periodic_orbit`, `travelling_wave` consist of many runs.

Compiled: `records` (array columns), `kernels` (a step of feet on springs), `feet_kernels` (surface and motion across),
`friction_kernels` (one-way), `beam_kernels` (two-way), `impact_kernels` (a hard point).
"""
