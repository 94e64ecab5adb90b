"""Enumerating all grasps of four or more elements on one main truss of the exact search (compiled).

Elements are chosen depth first, in the order of their prices.  Which kinds they are is left open: a
location has the price of its cheaper kind, and what the chosen ones pull is listed for every share
of the kinds among them.  After each choice the locations that are too close are struck off, and
cliques of what is left bound the elements to come.  The last two are looked up as a pair.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from grasp_xl.compiled import inner
from grasp_xl.search.exact_bound import (
    shortest_truss,
)
from grasp_xl.search.exact_leaf import keep, stands_apart
from grasp_xl.search.exact_model import Locations
from grasp_xl.search.exact_pairs import (
    GRID,
    PAIRS,
    Listed,
    Pairs,
    make_pairs,
    pull_of,
    tabulate_pairs,
)
from grasp_xl.search.exact_prices import (
    Room,
    Truss,
    Weights,
    branch,
    cheapest,
    fit_together,
    is_barred,
    joins_clique,
    no_truss,
    price,
    truss_of,
)
from grasp_xl.space import FloatArray, IntArray

ENDS = 2
"""Elements that the main truss's ends give."""

MANY_MIN, MANY_MAX = 4, 14
"""Elements of a grasp that this search is for; the shares of the kinds double with each."""

TRY = 20_000
TRY_LISTED = 256
"""Work that the first try at one main truss may take, and the locations that it looks at; every
later try may take twice as much."""


class Chosen(NamedTuple):
    """What is known at each depth, a row a depth.

    position ``(n,)`` entry chosen; left ``(n, m)`` ranks of the locations left, left_size ``(n,)``;
    least ``(n, n)`` bound of the price of each element to come; price, fixed ``(n,)`` value so far
    with prices, and without the moment.  Of each share of the kinds among the elements chosen so
    far: pull ``(n, s, 3)`` (mm), magnets ``(n, s)``, kinds ``(n, s)`` a bit for each element, and
    shares ``(n,)`` how many.
    """

    position: IntArray
    left: IntArray
    left_size: IntArray
    least: FloatArray
    price: FloatArray
    fixed: FloatArray
    pull: FloatArray
    magnets: IntArray
    kinds: IntArray
    shares: IntArray


class ManyRoom(NamedTuple):
    """Arrays that one worker needs; halt ``(1,)`` is set from outside where it shall stop."""

    listed: Listed
    pairs: Pairs
    chosen: Chosen
    halt: IntArray


def make_many_room(locations: int, elements: int, halt: IntArray, pairs: int = PAIRS) -> ManyRoom:
    """Make the arrays for so many locations, elements of a grasp, and pairs in the grids."""
    depths = elements + 1
    shares = 1 << max(0, min(elements, MANY_MAX) - 2)
    return ManyRoom(
        Listed(
            np.empty(locations),
            np.empty(locations),
            np.empty(locations, dtype=np.int64),
            np.zeros(1, dtype=np.int64),
        ),
        make_pairs(pairs),
        Chosen(
            np.empty(depths, dtype=np.int64),
            np.empty((depths, locations), dtype=np.int64),
            np.empty(depths, dtype=np.int64),
            np.empty((depths, depths)),
            np.empty(depths),
            np.empty(depths),
            np.empty((depths, shares, 3)),
            np.empty((depths, shares), dtype=np.int64),
            np.empty((depths, shares), dtype=np.int64),
            np.empty(depths, dtype=np.int64),
        ),
        halt,
    )


# --- what is left at each depth ---


@inner
def list_locations(
    loc: Locations,
    w: Weights,
    t: Truss,
    cell: int,
    u: FloatArray,
    below: float,
    most: int,
    stack: IntArray,
    out: Listed,
) -> bool:
    """List the locations of a cell with prices below a limit, rising; False if not all of them.

    Only the ``most`` cheapest ones are listed.
    """
    n = 0
    complete = True
    stack[0] = cell
    size = 1
    while size > 0:
        size -= 1
        box = stack[size]
        value = price(loc, w, t, box, u)[0]
        if value >= below or is_barred(loc, t, box):
            continue
        if loc.child[box, 0] >= 0:
            stack[size], stack[size + 1] = loc.child[box, 1], loc.child[box, 0]
            size += 2
            continue
        if n == most:
            complete = False
            n -= 1
        slot = n
        while slot > 0 and out.price[slot - 1] > value:
            out.price[slot], out.fixed[slot] = out.price[slot - 1], out.fixed[slot - 1]
            out.place[slot] = out.place[slot - 1]
            slot -= 1
        out.price[slot] = value
        out.fixed[slot] = loc.least_deviation[box] * w.deviation + branch(loc, t, box) * w.structure
        out.place[slot] = loc.run[box, 0]
        n += 1
        if n == most and not complete:
            below = out.price[n - 1]
    out.size[0] = n
    return complete


@inner
def narrow(loc: Locations, w: Weights, t: Truss, depth: int, room: ManyRoom) -> None:
    """List for this depth what is left behind the element that was chosen last."""
    c, place = room.chosen, room.listed.place
    last = depth - 1
    entry = c.position[last]
    n = 0
    for e in range(entry + 1, c.left_size[last]):
        rank = c.left[last, e]
        if fit_together(loc, w, t, place[rank], place[c.left[last, entry]]):
            c.left[depth, n] = rank
            n += 1
    c.left_size[depth] = n


@inner
def clique_prices(
    loc: Locations, w: Weights, depth: int, wanted: int, room: Room, many: ManyRoom
) -> float:
    """Return a bound on the prices of so many elements of what is left; writes each one's [5]."""
    c = many.chosen
    taken, total = 0, 0.0
    for e in range(c.left_size[depth]):
        rank = c.left[depth, e]
        if not joins_clique(loc, w, many.listed.place[rank], taken, room):
            c.least[depth, taken] = many.listed.price[rank]
            total += many.listed.price[rank]
            taken += 1
            if taken == wanted:
                return total
    return np.inf


@inner
def two_least(depth: int, room: ManyRoom) -> float:
    """Return the sum of the two least prices without the moment of what is left."""
    c = room.chosen
    first = second = np.inf
    for e in range(c.left_size[depth]):
        fixed = room.listed.fixed[c.left[depth, e]]
        second = min(second, max(first, fixed))
        first = min(first, fixed)
    total: float = first + second
    return total


@inner
def share_kinds(loc: Locations, w: Weights, place: int, depth: int, c: Chosen) -> None:
    """List every share of the kinds among the elements before this depth, the last at ``place``."""
    last = depth - 1
    n = 0
    for e in range(c.shares[last]):
        for kind in range(2):
            magnets = c.magnets[last, e] + kind
            if loc.footprint[place, kind] < 0 or magnets > w.magnets or depth - magnets > w.cups:
                continue
            pull = pull_of(w, kind)
            for axis in range(3):
                c.pull[depth, n, axis] = c.pull[last, e, axis] + pull * loc.xyz[place, axis]
            c.magnets[depth, n] = magnets
            c.kinds[depth, n] = c.kinds[last, e] | kind << last
            n += 1
    c.shares[depth] = n


# --- the last two elements ---


@inner
def look_up_pairs(
    loc: Locations,
    w: Weights,
    t: Truss,
    found: FloatArray,
    genes: IntArray,
    room: Room,
    many: ManyRoom,
) -> int:
    """Try the pairs of the grids that may go with the chosen elements; return how many."""
    n = w.cups + w.magnets
    c, frame = many.chosen, many.pairs.frame
    worst = len(found) - 1
    fixed = c.fixed[n - 2]
    spare = found[worst] - fixed - two_least(n - 2, many)
    if spare <= 0.0:
        return 0
    radius = spare / w.moment if w.moment > 0.0 else np.inf
    wide, high = radius * frame[2] + 1e-6, radius * frame[3] + 1e-6
    rank = c.left[n - 3, c.position[n - 3]] if n - 2 > ENDS else -1
    tried = 0
    for s in range(c.shares[n - 2]):
        magnets = w.magnets - c.magnets[n - 2, s]
        x = (-c.pull[n - 2, s, 0] - frame[0]) * frame[2]
        y = (-c.pull[n - 2, s, 1] - frame[1]) * frame[3]
        if magnets > 2 or x + wide < 0.0 or x - wide > GRID or y + high < 0.0 or y - high > GRID:
            continue
        left = int(min(max(x - wide, 0.0), GRID - 1.0))
        right = int(min(max(x + wide, 0.0), GRID - 1.0))
        bottom = int(min(max(y - high, 0.0), GRID - 1.0))
        top = int(min(max(y + high, 0.0), GRID - 1.0))
        for j in range(bottom, top + 1):
            row = (magnets * GRID + j) * GRID
            first, behind = many.pairs.start[row + left], many.pairs.start[row + right + 1]
            tried += behind - first
            for e in range(first, behind):
                value = fixed + many.pairs.fixed[e] + w.moment * pulled(many, n - 2, s, e)
                if value < found[worst] and many.pairs.member[e, 0] > rank:
                    try_pair(loc, w, t, s, many.pairs.member[e], found, genes, room, many)
    return tried


@inner
def pulled(room: ManyRoom, depth: int, share: int, pair: int) -> float:
    """Return the arm of the chosen elements with a pair (mm)."""
    x = room.chosen.pull[depth, share, 0] + room.pairs.pull[pair, 0]
    y = room.chosen.pull[depth, share, 1] + room.pairs.pull[pair, 1]
    z = room.chosen.pull[depth, share, 2] + room.pairs.pull[pair, 2]
    return float(np.sqrt(x * x + y * y + z * z))


@inner
def try_pair(
    loc: Locations,
    w: Weights,
    t: Truss,
    share: int,
    member: IntArray,
    found: FloatArray,
    genes: IntArray,
    room: Room,
    many: ManyRoom,
) -> None:
    """Keep the chosen elements with a pair, if all stand apart and it is among the best."""
    n = w.cups + w.magnets
    p, q = many.listed.place[member[0]], many.listed.place[member[1]]
    if not stands_apart(loc, w, t, p, n - 2, room) or not stands_apart(loc, w, t, q, n - 2, room):
        return
    for i in range(n - 2):
        room.chosen_kind[i] = many.chosen.kinds[n - 2, share] >> i & 1
    room.chosen[n - 2], room.chosen[n - 1] = p, q
    room.chosen_kind[n - 2], room.chosen_kind[n - 1] = member[2] >> 1, member[2] & 1
    keep(loc, w, n, found, genes, room)


@inner
def try_all_pairs(
    loc: Locations,
    w: Weights,
    t: Truss,
    found: FloatArray,
    genes: IntArray,
    room: Room,
    many: ManyRoom,
) -> int:
    """Try all pairs of what is left, where the grids cannot hold them; return how many."""
    n = w.cups + w.magnets
    c, listed = many.chosen, many.listed
    worst = len(found) - 1
    tried = 0
    for e in range(c.left_size[n - 2]):
        for f in range(e + 1, c.left_size[n - 2]):
            p, q = c.left[n - 2, e], c.left[n - 2, f]
            tried += 1
            if c.price[n - 2] + listed.price[p] + listed.price[q] >= found[worst]:
                break
            fixed = c.fixed[n - 2] + listed.fixed[p] + listed.fixed[q]
            if fixed < found[worst] and fit_together(loc, w, t, listed.place[p], listed.place[q]):
                tried += 4 * c.shares[n - 2]
                try_all_kinds(loc, w, t, p, q, fixed, found, genes, room, many)
    return tried


@inner
def try_all_kinds(
    loc: Locations,
    w: Weights,
    t: Truss,
    p: int,
    q: int,
    fixed: float,
    found: FloatArray,
    genes: IntArray,
    room: Room,
    many: ManyRoom,
) -> None:
    """Try a pair with every share of the kinds; the first row of the grids serves as its own."""
    n = w.cups + w.magnets
    c, pull, member = many.chosen, many.pairs.pull, many.pairs.member[0]
    a, b = many.listed.place[p], many.listed.place[q]
    for code in range(4):
        kind_a, kind_b = code >> 1, code & 1
        if loc.footprint[a, kind_a] < 0 or loc.footprint[b, kind_b] < 0:
            continue
        for axis in range(3):
            pull[0, axis] = pull_of(w, kind_a) * loc.xyz[a, axis]
            pull[0, axis] += pull_of(w, kind_b) * loc.xyz[b, axis]
        member[0], member[1], member[2] = p, q, code
        for s in range(c.shares[n - 2]):
            if c.magnets[n - 2, s] + kind_a + kind_b != w.magnets:
                continue
            if fixed + w.moment * pulled(many, n - 2, s, 0) < found[len(found) - 1]:
                try_pair(loc, w, t, s, member, found, genes, room, many)


# --- the search ---


@inner
def choose_ends(
    loc: Locations, w: Weights, t: Truss, boxes: IntArray, u: FloatArray, room: Room, many: ManyRoom
) -> None:
    """Choose the ends of the main truss."""
    c = many.chosen
    fixed = w.base + w.ratio * shortest_truss(loc, w, t) * w.structure
    total = fixed + u[3] * w.magnets
    c.pull[0, 0, 0] = c.pull[0, 0, 1] = c.pull[0, 0, 2] = 0.0
    c.magnets[0, 0] = c.kinds[0, 0] = 0
    c.shares[0] = 1
    for i in range(ENDS):
        place = loc.run[boxes[i], 0]
        room.chosen[i] = place
        fixed += loc.deviation[place] * w.deviation
        total += price(loc, w, no_truss(), boxes[i], u)[0]
        share_kinds(loc, w, place, i + 1, c)
    c.price[ENDS], c.fixed[ENDS] = total, fixed


@inner
def list_all(
    loc: Locations,
    w: Weights,
    t: Truss,
    boxes: IntArray,
    u: FloatArray,
    upper: float,
    most: int,
    room: Room,
    many: ManyRoom,
) -> tuple[bool, bool]:
    """Choose the ends, and list what may stand beside them and its pairs.

    Returns whether all is listed (no more than ``most``), and whether the grids hold all pairs.
    """
    n = w.cups + w.magnets
    c, listed = many.chosen, many.listed
    choose_ends(loc, w, t, boxes, u, room, many)
    c.left_size[ENDS] = 0
    spare = upper - c.price[ENDS] - cheapest(loc, w, t, boxes[ENDS], ENDS, n, u, room)
    if not spare > 0.0:  # nor where it is not a number
        return True, True
    below = spare + price(loc, w, t, room.pick[n - 1], u)[0]
    complete = list_locations(loc, w, t, boxes[ENDS], u, below, most, room.tag, listed)
    for rank in range(listed.size[0]):
        c.left[ENDS, rank] = rank
    c.left_size[ENDS] = listed.size[0]
    below += price(loc, w, t, room.pick[n - 2], u)[0]
    return complete, tabulate_pairs(loc, w, t, listed, below, many.pairs)


@inner
def enter(
    loc: Locations,
    w: Weights,
    t: Truss,
    depth: int,
    tabulated: bool,
    found: FloatArray,
    genes: IntArray,
    room: Room,
    many: ManyRoom,
) -> int:
    """Begin with what is left at a depth; where only a pair is wanted, try all; return the work."""
    n = w.cups + w.magnets
    c = many.chosen
    work = c.left_size[depth] // 8
    c.position[depth] = c.left_size[depth]  # nothing to choose
    total = c.price[depth] + clique_prices(loc, w, depth, n - depth, room, many)
    if total >= found[len(found) - 1]:
        return work
    if depth > ENDS:
        share_kinds(loc, w, room.chosen[depth - 1], depth, c)
    if depth < n - 2:
        c.position[depth] = -1
    elif tabulated:
        work += look_up_pairs(loc, w, t, found, genes, room, many) // 16
    else:
        work += try_all_pairs(loc, w, t, found, genes, room, many) // 16
    return work


@inner
def choose_next(w: Weights, depth: int, upper: float, room: Room, many: ManyRoom) -> bool:
    """Choose the next entry of what is left at a depth; False if there is none of use."""
    c, listed = many.chosen, many.listed
    wanted = w.cups + w.magnets - depth
    c.position[depth] += 1
    if c.position[depth] + wanted > c.left_size[depth]:
        return False
    rank = c.left[depth, c.position[depth]]
    total = c.price[depth] + listed.price[rank]
    for i in range(1, wanted):
        total += max(listed.price[rank], c.least[depth, i])
    if total >= upper:
        return False
    room.chosen[depth] = listed.place[rank]
    c.price[depth + 1] = c.price[depth] + listed.price[rank]
    c.fixed[depth + 1] = c.fixed[depth] + listed.fixed[rank]
    return True


@inner
def enumerate_many(
    loc: Locations,
    w: Weights,
    boxes: IntArray,
    u: FloatArray,
    tries: int,
    found: FloatArray,
    genes: IntArray,
    room: Room,
    many: ManyRoom,
) -> bool:
    """Look at all grasps on one main truss that may enter ``found``; False if that takes too long.

    Parameters
    ----------
    loc, w : Locations, Weights
    boxes : IntArray
        ``(n,)``; the first two are single locations, all others the same cell.
    u : FloatArray
        ``(4,)`` multipliers.
    tries : int
        How often this node was looked at before; each look may take twice as long.
    found, genes : FloatArray, IntArray
        ``(k,)`` values of the best grasps so far, rising, and ``(k, n, 2)`` their locations and
        kinds.
    room, many : Room, ManyRoom
    """
    worst = len(found) - 1
    t = truss_of(loc, w, boxes)
    most = TRY_LISTED << tries
    complete, tabulated = list_all(loc, w, t, boxes, u, found[worst], most, room, many)
    budget = TRY << tries
    depth = ENDS
    enters = True
    while depth >= ENDS:
        if enters:
            budget -= enter(loc, w, t, depth, tabulated, found, genes, room, many)
        enters = choose_next(w, depth, found[worst], room, many)
        if not enters:
            depth -= 1
            continue
        budget -= 1
        if budget < 0 or many.halt[0]:
            return False
        depth += 1
        narrow(loc, w, t, depth, many)
    return complete
