"""A slider that may leave the beam: feet on springs or hard landings, and the figures of the motor that it makes.

Takes a beam under forces and a slider with `contact`; gives its run and figures of it. Knows nothing of scenes.

A run, in the order of its modules: `run` (asked), `combine` (refused or not), `feet` and `resting` (arrays, put down),
`coupling` and `plan` (laid out), `carry` and `stepping` (stepped, or `on_chain`), `outcome` and `result` (told).

Compiled: `records` names what the loops see, `kernels` is the step of feet on springs (`surface_kernels` what a point
stands on, `feet_kernels` across, `rub_kernels` along, `beam_kernels` a beam that feels it), `hop_kernels` a hard point,
`logging_kernels` what is kept, `warm` the calls. Of many runs: `case`, `repeated`, `figures`, `shooting`, `on_wave`.
"""
