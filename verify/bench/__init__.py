"""Work-precision benchmarks: run time over error of all methods for a quantity of interest."""
