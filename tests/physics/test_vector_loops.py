"""Which loops over lanes are vector instructions: all but those that look at a lane alone."""

import re
from collections import Counter

import llvmlite.binding as llvm
import pytest
from paper_structures import needs_compiled_kernels

from rpscli.compiler.objects import optimised
from rpscli.physics.follow import follow
from rpscli.physics.kernels import kinds_of_arguments, program_text
from rpscli.physics.state import LANES

LANE_BY_LANE = {
    "act_branched_at_stage": 1,
    "advance": 1,
    "begin_work": 1,
    "call_in": 1,
    "check_all_steps": 1,
    "check_steps": 1,
    "empty": 1,
    "free_lane": 1,
    "free_storeys": 1,
    "look_after_all": 1,
    "next_intervals": 1,
    "observe": 1,
    "observe_devices": 2,
    "observe_tilt": 1,
    "stand": 1,
}
"""Loops of which a lane rarely has something to do, by their functions."""


def loops_over_lanes(text):
    """Names of all loops over lanes of a program: function and line."""
    tests = re.findall(rf"icmp slt i64 %(\w+)\.(\d+)\.loop\.\d+\.i, {LANES}\n", text)
    return {f"{function}:{line}" for function, line in tests}


def left_as_they_were(text):
    """Names of the loops that LLVM kept and did not make vector instructions of."""
    module = str(optimised(text))
    nodes = dict(re.findall(r"^!(\d+) = (?:distinct )?!\{(.*)\}$", module, re.MULTILINE))
    left = set()
    for content in nodes.values():
        said = [nodes.get(number, "") for number in re.findall(r"!(\d+)", content)]
        names = [each[2:-1] for each in said if re.fullmatch(r'!"\w+:\d+"', each)]
        if names and not any("isvectorized" in each for each in said):
            left.add(names[0])
    return left


@needs_compiled_kernels
@pytest.mark.parametrize("ways", [1, 2])
def test_loops_over_lanes_become_vector_instructions(ways):
    text = program_text(follow, kinds_of_arguments(ways, LANES))
    loops = loops_over_lanes(text)
    assert len(loops) > 35
    scalar = Counter(name.split(":")[0] for name in loops & left_as_they_were(text))
    if llvm.llvm_version_info < (22,):
        scalar.pop("check_all_steps", None)  # LLVM 20 leaves it for two directions
    assert all(scalar[name] <= LANE_BY_LANE.get(name, 0) for name in scalar), scalar
