"""Work-precision benchmarks: run time over error of every method that answers the same question."""

from verify.bench.work_precision import Method, Question, Row, measure, result, time_at

__all__ = ["Method", "Question", "Row", "measure", "result", "time_at"]
