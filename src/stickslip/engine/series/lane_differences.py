"""The functions of `engine.series.differences` for lanes, lane by lane."""

from __future__ import annotations

from stickslip.engine.codegen.simd import lane_by_lane
from stickslip.engine.series import differences

exp_difference = lane_by_lane(differences.exp_difference)
log_difference = lane_by_lane(differences.log_difference)
tanh_difference = lane_by_lane(differences.tanh_difference)
power_difference = lane_by_lane(differences.power_difference)
arcsinh_difference = lane_by_lane(differences.arcsinh_difference)
exp_value = lane_by_lane(differences.exp_value)
power_value = lane_by_lane(differences.power_value)
