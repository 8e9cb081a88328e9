"""Histories of many in states: of those that stand, of those that
move, of those that wait.

Who stands takes the exact step (`standing`), who moves that of Runge and Kutta (`step`);
each state takes its own for all its lanes. A history that is to take other steps than
before changes its state at an uplift or a re-contact, or waits until there is a lane
free: no bit of it knows its company. There are always more places than histories, so that
none waits for another one that waits.
"""

from __future__ import annotations

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.lane import lanes_of
from rpscli.physics.state import NO_HISTORY, Record

MOVING, STANDING, WAITING = range(3)
"""Numbers of the states; of those of histories that wait it is the first."""

CHEAPER = 3
"""A step of lanes that stand takes a third of the time of one of lanes that move."""


@inlined
def standing_is_next(moving: Record, standing: Record) -> bool:
    """Which state takes a step: one whose lanes are full, the one
    for which more are there.
    """
    lanes = lanes_of(moving)
    if moving.present >= lanes and standing.present >= lanes:
        return standing.present >= moving.present  # type: ignore[no-any-return]
    if moving.present >= lanes or standing.present >= lanes:
        return standing.present >= lanes  # type: ignore[no-any-return]
    return CHEAPER * standing.present >= moving.present  # type: ignore[no-any-return]


@inlined
def is_called(s: Record) -> bool:
    """True if a state has room for a history that waits for it."""
    return (s.active < lanes_of(s)) & (s.active < s.present)  # type: ignore[no-any-return]


@compiled
def free_lane(s: Record) -> int:
    """A lane without a history, or -1."""
    for l in range(lanes_of(s) if s.active < lanes_of(s) else 0):
        if s.history[l] == NO_HISTORY:
            return l
    return -1


@compiled
def waiting_place(state: Record) -> int:
    """A free place among those that wait: its state times lanes, and the lane; or -1."""
    lanes = lanes_of(state[WAITING])
    for k in range(WAITING, state.shape[0]):
        l = free_lane(state[k])
        if l >= 0:
            return k * lanes + l
    return -1


@compiled
def leave(state: Record, k: int, place: int) -> None:
    """Copy a history of state k from its place to the other state, or
    to where it waits for it.
    """
    other = state[STANDING if k == MOVING else MOVING]
    lanes = lanes_of(state[k])
    state[k].present -= 1
    other.present += 1
    to = other
    lane = free_lane(other)
    if lane < 0:
        free = waiting_place(state)
        to = state[free // lanes]
        lane = free % lanes
    copy_lane(to, lane, state[place // lanes], place % lanes)
    to.active += 1


@compiled
def copy_lane(to: Record, k: int, of: Record, l: int) -> None:
    """Copy all that a lane knows between two steps; stages are scratch."""
    for i in range(of.words.shape[0]):
        to.words[i, k] = of.words[i, l]
    for i in range(of.device_words.shape[0] if of.equipped > 0 else 0):
        to.device_words[i, k] = of.device_words[i, l]
    for i in range(of.mode_words.shape[0]):
        for r in range(of.axes * of.n):
            to.mode_words[i, r, k] = of.mode_words[i, r, l]
    for i in range(of.storey_words.shape[0] if of.yielding > 0 else 0):
        for r in range(of.axes * of.n):
            to.storey_words[i, r, k] = of.storey_words[i, r, l]
    for i in range(of.largest.shape[0]):
        for storey in range(of.n):
            to.largest[i, k, storey] = of.largest[i, l, storey]
            to.last[i, k, storey] = of.last[i, l, storey]
    to.factors_h[k] = -1.0
