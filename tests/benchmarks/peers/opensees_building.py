"""The linear building on a fixed base by OpenSeesPy: what it can do of the problem.

Same floors, Rayleigh damping and record; Newmark's constant average acceleration, a step a sample.
"""

from __future__ import annotations

import numpy as np

from benchmarks.peers.rocking import Floats, Rocking


class OpenSeesBuilding:
    """A shear building of one degree of freedom a floor."""

    def __init__(self, podium: Rocking) -> None:
        self.podium = podium

    def base_shear(self, record: Floats, dt: float, *, look: bool) -> float:
        """Run the record; the largest elastic base shear at samples if looked at, else 0."""
        import openseespy.opensees as ops

        n = len(self.podium.masses)
        ops.wipe()
        ops.model("basic", "-ndm", 1, "-ndf", 1)
        ops.node(0, 0.0)
        ops.fix(0, 1)
        for i in range(1, n + 1):
            ops.node(i, 0.0, "-mass", float(self.podium.masses[i - 1]))
            ops.uniaxialMaterial("Elastic", i, float(self.podium.stiffnesses[i - 1]))
            ops.element("zeroLength", i, i - 1, i, "-mat", i, "-dir", 1, "-doRayleigh", 1)
        ops.rayleigh(self.podium.a0, self.podium.a1, 0.0, 0.0)
        ops.timeSeries("Path", 1, "-dt", dt, "-values", *record.tolist())
        ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
        ops.constraints("Plain")
        ops.numberer("Plain")
        ops.system("ProfileSPD")
        ops.algorithm("Linear", "-factorOnce")
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
        steps, largest = len(record) - 1, 0.0
        if not look:
            if ops.analyze(steps, dt) != 0:
                raise RuntimeError("OpenSees did not finish")
            return 0.0
        for _ in range(steps):
            ops.analyze(1, dt)
            largest = max(largest, abs(ops.nodeDisp(1, 1)))
        return float(np.multiply(largest, self.podium.stiffnesses[0]))
