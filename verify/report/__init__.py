"""The HTML report: one self-contained file that needs no network."""

from verify.report.html import write_report

__all__ = ["write_report"]
