"""Charts of a motor."""

from typing import TYPE_CHECKING

from verify.studies.chart import Chart

if TYPE_CHECKING:
    from verify.studies.motor_figures import MotorFound


def motor_charts(found: "MotorFound") -> tuple[Chart, ...]:
    return ()
