"""Parts of `verify.analytic_modes`: layout, characteristic equation, multiple shooting, closed forms, error laws."""
