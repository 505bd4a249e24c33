"""Cases for any engine: a sheet of what to build, the table of numbers that its run gives, a verdict on the table.

A sheet is data (`data/NAME/sheet.toml`), free of rights; `read` takes its figures from a record, `judge` compares them.
"""
