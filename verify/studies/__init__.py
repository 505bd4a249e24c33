"""Studies: what a scene computes beside its gates. One study is one file; each returns a `Result`."""
