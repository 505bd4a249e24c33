"""Parts of `verify.travelling_wave`: waves in a window, superposed unit responses, drives, impedance matching."""
