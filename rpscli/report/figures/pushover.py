"""Static characteristics: restoring force of the storey, capacity curves of the whole structure."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.pushover import PushoverResult
from rpscli.errors import UsageError
from rpscli.report.figures import style

DISPLACEMENT = "cap beam displacement $u_b$ [m]"


def storey_curve_figure(result: PushoverResult, title: str) -> bytes:
    """Force and lift of the cap beam against its displacement, to the critical rotation."""
    panels = [partial(draw_one, result=result) for draw_one in (draw_force, draw_lift)]
    words = title, "storey of the bearings alone"
    return style.stacked(panels, words, 4.8, 5.8, ratios=[2.6, 1.0])


def draw_force(axes: style.Axes, result: PushoverResult) -> None:
    """Force against displacement, rolling and rocking, and back where the way back is another."""
    curve, beta = result.curve, result.structure.bearing.beta
    factor, prefix = style.engineering(float(np.max(curve.force)))
    u, F, back = curve.displacement, factor * curve.force, factor * curve.unloading_force
    returns = bool(np.any(back != F))
    if returns:
        axes.axhline(0.0, color=style.GREY, lw=0.6)
    if F[0] > 0.0:
        axes.plot([0.0, 0.0], [0.0, F[0]], color=style.BLACK, lw=2.0, label="full contact")
    for inside, colour, name in _phases(result):
        axes.plot(u[inside], F[inside], color=colour, lw=2.0, label=name)
        if returns:
            axes.plot(u[inside], back[inside], color=colour, lw=1.5, ls="--")
    if returns:
        axes.plot([], [], color=style.GREY, lw=1.5, ls="--", label="on the way back")
    rises = F[1] > F[0] > 0.15 * F.max()  # and there is room below
    # Above the name of beta, if that stands to the left of its point.
    higher = 18.0 if returns else 6.0
    if F[0] > 0.0:
        _mark(axes, 0.0, F[0], "uplift", (8.0, -4.0 if rises else higher))
    if 0.0 < beta < result.critical_rotation:
        at = int(np.searchsorted(curve.rotation, beta))
        side = (-7.0 if F[at + 1] > F[at] else 7.0, 6.0)
        _mark(axes, u[at], F[at], f"$\\beta$ = {beta:.3f} rad", side)
    critical = f"$\\theta_{{cr}}$ = {result.critical_rotation:.3f} rad"
    _mark(axes, u[-1], F[-1], critical, (-44.0, 3.0))
    low = min(0.0, back.min()) if returns or result.structure.bed else 0.0
    axes.set(xlim=(-0.02 * u[-1], 1.04 * u[-1]), ylim=(1.1 * low, 1.18 * F.max()))
    axes.set(xlabel=DISPLACEMENT, ylabel=f"force at the cap beam [{prefix}N]")
    if result.structure.uplift_force > 0.0:
        of_uplift = style.over(factor * result.structure.uplift_force)
        ratio = axes.secondary_yaxis("right", functions=of_uplift)
        ratio.set_ylabel("$F/(W \\tan\\alpha)$ [-]")
    style.legend_above(axes)


def draw_lift(axes: style.Axes, result: PushoverResult) -> None:
    """Lift against displacement."""
    u, lift = result.curve.displacement, 1e3 * result.curve.lift
    for inside, colour, _ in _phases(result):
        axes.plot(u[inside], lift[inside], color=colour, lw=2.0)
    axes.set(ylim=(0.0, None), ylabel="lift [mm]", xlabel=DISPLACEMENT)


def _phases(result: PushoverResult) -> Iterator[tuple[NDArray[np.bool_], str, str]]:
    """Points of the curve in each phase that there is, its colour and its name."""
    rotation, beta = result.curve.rotation, result.structure.bearing.beta
    phases = (rotation <= beta, style.BLUE, "rolling"), (rotation >= beta, style.RED, "rocking")
    yield from (phase for phase in phases if np.count_nonzero(phase[0]) > 1)


def _mark(axes: style.Axes, x: float, y: float, text: str, offset: style.At) -> None:
    """A point with its name, offset [pt] to the side on which no curve runs."""
    axes.plot(x, y, "o", color=style.BLACK, ms=5.0, zorder=5, clip_on=False)
    style.note(axes, text, (x, y), offset)


LOOKS = ((style.SKY, "-"), (style.RED, "-"), (style.BLACK, "-"), (style.PINK, ":"))


def capacity_figure(result: PushoverResult, title: str) -> bytes:
    """Sum of floor forces against roof displacement, whole and close to the uplift."""

    def draw(figure: style.Figure) -> None:
        lifts = np.array([curve.roof_displacement_at_uplift for curve in result.capacity])
        never = bool(np.isnan(lifts).all())
        ending = "a mechanism" if never else "the critical rotation"
        style.heading(figure, title, f"floor forces pushed to {ending}")
        if never:
            whole = figure.subplots()
            draw_capacity(whole, result)
            style.legend_below(figure, [whole])
            return
        whole, close = figure.subplots(1, 2, sharey=True, width_ratios=[1.6, 1.0])
        for axes in (whole, close):
            draw_capacity(axes, result)
        uplift = float(np.nanmax(lifts))
        close.set_xlim(0.0, 3.0 * uplift or 0.1 * whole.get_xlim()[1])
        close.locator_params(axis="x", nbins=3 if style.narrow() else 5)
        close.set(ylabel="", title="near uplift" if uplift else "where rolling begins")
        style.legend_below(figure, [close])

    return style.picture(draw, 3.6)


def draw_capacity(axes: style.Axes, result: PushoverResult) -> None:
    """Sum of floor forces against roof displacement by pattern, and where it uplifts."""
    if not result.capacity:
        raise UsageError("a structure without storeys has no capacity curve; draw `storey_curve`")
    factor, prefix = style.engineering(max(c.sum_of_floor_forces.max() for c in result.capacity))
    for k, curve in enumerate(result.capacity):
        colour, line = LOOKS[k % len(LOOKS)]  # curves may coincide: the first is the widest
        axes.plot(
            curve.roof_displacement, factor * curve.sum_of_floor_forces,
            color=colour, ls=line, lw=3.6 / (k + 1), label=curve.pattern.replace("_", " "),
        )  # fmt: skip
        axes.plot(
            curve.roof_displacement_at_uplift, factor * result.uplift_force, "o",
            color=colour, ms=4.5, clip_on=False,
        )  # fmt: skip
        for force in sorted(curve.yielding.values())[:1]:
            at = int(np.argmax(curve.sum_of_floor_forces >= force))
            roof = curve.roof_displacement[at]
            axes.plot(roof, factor * force, "D", color=colour, ms=4.5, clip_on=False)
    if any(curve.roof_displacement_at_uplift >= 0.0 for curve in result.capacity):
        begins = "uplift" if result.uplift_force else "rolling begins"
        axes.plot([], [], "o", color=style.GREY, ms=4.5, label=begins)
    if any(curve.yielding for curve in result.capacity):
        axes.plot([], [], "D", color=style.GREY, ms=4.5, label="first storey yields")
    lowest = min(0.0, *(factor * np.min(c.sum_of_floor_forces) for c in result.capacity))
    axes.set(xlim=(0.0, None), ylim=(lowest, None), xlabel="roof displacement [m]")
    axes.set_ylabel(f"sum of floor forces [{prefix}N]")
