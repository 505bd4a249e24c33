"""Work-precision benchmarks: run time over error of all methods for a quantity of interest."""

from verify.bench.work_precision import Method, Question, Row, measure, result, time_at

__all__ = ["Method", "Question", "Row", "measure", "result", "time_at"]
