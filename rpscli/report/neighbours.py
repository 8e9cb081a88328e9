"""Histories beside one in words: other motion, another impact law, shorter steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from rpscli.analyses.neighbours import NEAR, OTHER_LOSS, Neighbour
from rpscli.analyses.result_quantities import EVERY
from rpscli.analyses.results import TimeHistoryResult
from rpscli.report.table import shown
from rpscli.sweep.statistics.summary import step_changes


def neighbours_texts(
    result: TimeHistoryResult, found: Sequence[Neighbour]
) -> Iterator[str]:
    """That this is one history, and how much it moves with its
    motion and the impact law.
    """
    found = [each for each in found if each.step == 1.0]
    motions = [each for each in found if each.factor != 1.0]
    if motions:
        near = [each for each in motions if each.factor in NEAR]
        turned = [each for each in found if each.turned]
        beside = f"; turned by 1 deg {_reached(turned)}" if turned else ""
        yield (
            f"one history: with 1 % less or more motion {_reached(near)}; with up to 3 %"
            f" {_reached(motions)}{beside}{_chaotic(result)}: judge by several records"
        )
    elif result.twist is not None:
        yield "one history: motions beside it are not followed where the slab turns"
    elif result.outcome != "failed":
        yield (
            f"one history: its {result.history['steps']} steps are too many to look at"
            " motions 1 % weaker and stronger; judge by several records"
        )
    for other in (each for each in found if each.factor == 1.0 and not each.turned):
        instead = (
            f"{shown(other.restitution)} instead of {shown(result.structure.restitution)}"
        )
        yield (
            f"one impact law: with podium.impact.loss {OTHER_LOSS:g} (e = {instead})"
            f" {_reached([other])}"
        )


def _chaotic(result: TimeHistoryResult) -> str:
    """Why neighbours part; empty of ends that roll without impacts."""
    if result.structure.bearing.is_spherical:
        return ""
    passes = result.both_components and not result.structure.passes_smoothly
    return f". Motions with {'passes' if passes else 'impacts'} are chaotic"


def _reached(found: Sequence[Neighbour]) -> str:
    """Rotations and base shears of those that stood, and how many did not."""
    stood = [
        each for each in found if not each.outcome.startswith(("overturned", "failed"))
    ]
    texts = []
    if stood:
        shears = [1e-3 * each.max_base_shear for each in stood]
        texts = [f"{_range([each.rotation_ratio for each in stood])} theta_cr"]
        texts += [f"base shear {_range(shears)} kN"] * any(shears)
    for kind, word in (("overturned", "overturns"), ("failed", "fails")):
        if count := sum(each.outcome.startswith(kind) for each in found):
            texts.append(f"it {word}" + f" in {count} of {len(found)}" * (len(found) > 1))
    return " and ".join(texts)


def _range(values: Sequence[float]) -> str:
    return " to ".join(dict.fromkeys((shown(min(values)), shown(max(values)))))


def step_text(
    result: TimeHistoryResult, finer: Neighbour | None, limits: Mapping[str, float]
) -> str:
    """Results that steps of half the length change, of the main ones and of those that
    have a limit; empty if none does.
    """
    if finer is None:
        return ""
    if finer.outcome != result.outcome:
        ways = f"{result.outcome} or {finer.outcome}".replace("_", " ")
        return f"steps: with {finer.change} the outcome is another: {ways}; {JUDGE}"
    after = {**finer.demands, "max_base_shear": finer.max_base_shear}
    before = {name: getattr(result, name) for name in after}
    changes = step_changes(before, after, limits)
    if not changes:
        return ""
    told = ", ".join(
        f"{EVERY[name].label} by {part:.2g} of it" for name, part in changes.items()
    )
    return f"steps: {finer.change} change {told}; {JUDGE}"


JUDGE = (
    "there a change smaller than the error of a step decides: judge by several records,"
    " or raise analysis.accuracy"
)
