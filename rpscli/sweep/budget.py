"""What moves the results of one history: inputs changed one at a time, and what comes of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.result_quantities import LIMITED, NEEDS, ResultQuantity
from rpscli.case.case import Case
from rpscli.case.conditions import LIMITS, Condition, case_conditions, with_friction
from rpscli.errors import UsageError
from rpscli.sweep.statistics.fractiles import HIGH, LOW, Share, fractiles, share_of
from rpscli.sweep.statistics.summary import Records
from rpscli.sweep.statistics.verdicts import exceeds, worse
from rpscli.sweep.table import Array

FACTOR = 2.0
"""By which a result changes its order of magnitude."""
SHARES = (LOW, 0.5, HIGH)
RECORDS = "records"
"""The cause of all rows that are other records."""


class Row(NamedTuple):
    """One change, by options of `rps timehistory`: its results [SI], or why there are none."""

    cause: str
    change: str
    options: str
    outcome: str
    values: dict[str, float]
    record: str
    refused: str


class Effect(NamedTuple):
    """Of one limit or result on all rows: values, infinitely bad where it overturned, NaN if none.

    `spread` are the fractiles `SHARES` over the records, `beyond` the share beyond the limit.
    """

    name: str
    quantity: ResultQuantity | None
    limit: Condition | None
    values: Array
    exceeded: NDArray[np.bool_]
    spread: list[float]
    beyond: Share

    @property
    def turned(self) -> NDArray[np.bool_]:
        """(rows,) with the other verdict than the first."""
        return np.asarray(self.exceeded != self.exceeded[0])

    @property
    def moved(self) -> NDArray[np.bool_]:
        """(rows,) away from the first by `FACTOR`, or with the other sign."""
        own, size = self.values[0], np.abs(self.values)
        far = np.maximum(size, abs(own)) >= FACTOR * np.minimum(size, abs(own))
        other_sign = np.sign(self.values) * np.sign(own) < 0.0
        return np.asarray((self.values != own) & ~np.isnan(size) & (far | other_sign))


def effects(rows: Sequence[Row], case: Case) -> Iterator[Effect]:
    """On all limits, else on the main demands; of rows with results, the first as the case is."""
    limits = with_friction(case_conditions(case.limits, overturning=True), case.structure)
    judged: dict[str, Condition | None] = {each.name: each for each in limits}
    values = [row.values for row in rows]
    table = Records.of([r.outcome for r in rows], values, [r.record for r in rows])
    others = np.nonzero([row.cause == RECORDS for row in rows])[0]
    main = [q.name for q in LIMITED if q.demand and not np.isnan(values[0][q.name])]
    for name, limit in (judged or dict.fromkeys(main)).items():
        quantity, bad = LIMITS.get(name), worse(table, name)
        if quantity:
            bad[np.isnan(table.columns[name]) & ~table.overturned] = np.nan
            if limit and np.isnan(bad[0]):
                needs = NEEDS.get(quantity.needs, "what the case has not")
                raise UsageError(f"{limit.source}: {name} needs {needs}")
        sign = -1.0 if quantity and quantity.from_below else 1.0
        known, bound = ~np.isnan(bad), limit.limit if limit else np.inf
        beyond = exceeds(table, name, bound) & known & (limit is not None)
        spread = (sign * fractiles(bad[others], SHARES)).tolist()
        share = share_of(table, others, beyond[others])
        yield Effect(name, quantity, limit, sign * bad, beyond, spread, share)
