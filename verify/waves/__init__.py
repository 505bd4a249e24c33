"""Behind `verify.travelling_wave`: two waves in a window, unit responses superposed, drives, impedance matching."""
