"""The compiled part of the exact search: the bound of a node, and the search of a single pair.

A *node* fixes the counts, and says in which two boxes of locations the ends of the main truss
stand.  A *location* is a place with the footprint of each kind that it has.  A lower bound takes
four facts together: the other elements stand within reach of both boxes; their distance to the
truss is at least that to the strip between the boxes; the moment is a norm, so at least its part
along any direction u; and a multiplier lam prices the kind of each element.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from grasp_xl.compiled import allocation_free, compiled
from grasp_xl.kernels import RecordArray
from grasp_xl.rules import SLACK
from grasp_xl.space import FloatArray, IntArray

Weights = Any
"""A row of ``WEIGHTS``."""

ASCENT_STEPS = 12
PAIR_STEPS = 60
"""Steps of the multipliers at a node."""

PAIR_BUDGET = 100_000
"""Steps of the search of a single pair; one that needs more comes back with four times as many."""

MAX_CLIQUE = 48
"""Members of a clique that are kept; a larger one would bound no better."""

CUPS, MAGNETS = 0, 1
"""The two kinds, by their number; the names are the thesis's."""


class Locations(NamedTuple):
    """All places, in the order of a kd-tree, so that a box is a run of them.

    xyz ``(n, 3)`` seen from the part's centroid (mm), z = 0 with the plan arm; deviation ``(n,)``;
    footprint ``(n, 2)`` 0-based footprint of each kind, -1 for none; box ``(m, 4)`` xmin, ymin,
    xmax, ymax of each tree node; run ``(m, 2)`` its first and behind its last location; child
    ``(m, 2)`` tree nodes, -1 at a single location.
    """

    xyz: FloatArray
    deviation: FloatArray
    footprint: IntArray
    box: FloatArray
    run: IntArray
    child: IntArray


WEIGHTS = np.dtype(
    [
        ("cups", "i8"),
        ("magnets", "i8"),
        ("base", "f8"),
        ("moment", "f8"),
        ("deviation", "f8"),
        ("structure", "f8"),
        ("cup_pull", "f8"),
        ("magnet_pull", "f8"),
        ("ratio", "f8"),
        ("clearance", "f8"),
        ("arm_cap", "f8"),
        ("deviation_cap", "f8"),
        ("structure_cap", "f8"),
    ]
)
"""The value to minimise, for fixed counts, as weights of its terms.

base is the cost term; moment, deviation and structure weigh a millimetre (of the centre of force,
of one element's deviation, of truss); pull is force over total force of one element; ratio is R of
eq. 7; clearance in mm; caps are limits of the moment arm, the summed deviation and the structure
(mm), infinite where goals need not be met.
"""

NODE = np.dtype(
    [
        ("bound", "f8"),
        ("counts", "i8"),
        ("a", "i8"),
        ("b", "i8"),
        ("ux", "f8"),
        ("uy", "f8"),
        ("uz", "f8"),
        ("lam", "f8"),
        ("budget", "i8"),
    ]
)
"""An open node: its bound, row of its weights, tree nodes of its boxes, multipliers, and how many
steps the search of a single pair may take."""


class Scratch(NamedTuple):
    """Room that one worker needs: candidates' places, weights and prices, and a heap."""

    place: IntArray
    weight: FloatArray
    price: FloatArray
    order: IntArray


@allocation_free
def box_distances(box: FloatArray, x: float, y: float) -> tuple[float, float]:
    """Return the least and the largest distance from a point to a box."""
    dx = max(0.0, max(box[0] - x, x - box[2]))
    dy = max(0.0, max(box[1] - y, y - box[3]))
    fx = max(abs(x - box[0]), abs(x - box[2]))
    fy = max(abs(y - box[1]), abs(y - box[3]))
    return np.sqrt(dx * dx + dy * dy), np.sqrt(fx * fx + fy * fy)


@allocation_free
def pair_distances(a: FloatArray, b: FloatArray) -> tuple[float, float]:
    """Return the least and the largest distance between points of two boxes."""
    dx = max(0.0, max(a[0] - b[2], b[0] - a[2]))
    dy = max(0.0, max(a[1] - b[3], b[1] - a[3]))
    fx = max(abs(a[2] - b[0]), abs(b[2] - a[0]))
    fy = max(abs(a[3] - b[1]), abs(b[3] - a[1]))
    return np.sqrt(dx * dx + dy * dy), np.sqrt(fx * fx + fy * fy)


@allocation_free
def usable(loc: Locations, w: Weights, place: int, kind: int) -> bool:
    """Tell whether an element of a kind may stand at a location."""
    count = w.magnets if kind else w.cups
    return count > 0 and loc.footprint[place, kind] >= 0


@allocation_free
def gather(loc: Locations, w: Weights, a: int, b: int, reach: float, scratch: Scratch) -> int:
    """Write the candidates for the other elements, and their separable weights; return how many.

    Dropped are those closer than the clearance to all of a box, or out of reach of one.
    """
    box_a, box_b = loc.box[a], loc.box[b]
    ax, ay = (box_a[0] + box_a[2]) / 2, (box_a[1] + box_a[3]) / 2
    bx, by = (box_b[0] + box_b[2]) / 2, (box_b[1] + box_b[3]) / 2
    length = np.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
    nx, ny = (0.0, 0.0) if length == 0.0 else ((ay - by) / length, (bx - ax) / length)
    half_a = (abs(nx) * (box_a[2] - box_a[0]) + abs(ny) * (box_a[3] - box_a[1])) / 2
    half_b = (abs(nx) * (box_b[2] - box_b[0]) + abs(ny) * (box_b[3] - box_b[1])) / 2
    half = max(half_a, half_b)
    single_a = loc.run[a, 0] if loc.child[a, 0] < 0 else -1
    single_b = loc.run[b, 0] if loc.child[b, 0] < 0 else -1
    least = w.clearance * (1 - SLACK)
    n = 0
    for k in range(len(loc.xyz)):
        x, y = loc.xyz[k, 0], loc.xyz[k, 1]
        near_a, far_a = box_distances(box_a, x, y)
        if near_a > reach or far_a < least:
            continue
        near_b, far_b = box_distances(box_b, x, y)
        if near_b > reach or far_b < least or k in (single_a, single_b):
            continue
        if not (usable(loc, w, k, CUPS) or usable(loc, w, k, MAGNETS)):
            continue
        branch = max(0.0, abs(nx * (x - ax) + ny * (y - ay)) - half)
        scratch.place[n] = k
        scratch.weight[n] = branch * w.structure + loc.deviation[k] * w.deviation
        n += 1
    return n


@allocation_free
def priced(loc: Locations, w: Weights, place: int, u: FloatArray, lam: float) -> tuple[float, int]:
    """Return the least price of an element at a location, and its kind."""
    along = w.moment * (
        u[0] * loc.xyz[place, 0] + u[1] * loc.xyz[place, 1] + u[2] * loc.xyz[place, 2]
    )
    best, kind = np.inf, CUPS
    if usable(loc, w, place, CUPS):
        best = w.cup_pull * along
    if usable(loc, w, place, MAGNETS) and w.magnet_pull * along - lam < best:
        best, kind = w.magnet_pull * along - lam, MAGNETS
    return best, kind


@allocation_free
def cheapest_end(
    loc: Locations, w: Weights, box: int, u: FloatArray, lam: float
) -> tuple[float, int]:
    """Return the least price of a truss end in a box, and the location."""
    best, at = np.inf, -1
    for k in range(loc.run[box, 0], loc.run[box, 1]):
        price = priced(loc, w, k, u, lam)[0] + loc.deviation[k] * w.deviation
        if price < best:
            best, at = price, k
    return best, at


@compiled
def balance(loc: Locations, w: Weights, picks: IntArray, n: int, u: FloatArray) -> float:
    """Return the multiplier at which the picks have the right number of magnets."""
    differences = np.empty(n)
    for i in range(n):
        place = picks[i]
        if not usable(loc, w, place, MAGNETS):
            differences[i] = np.inf
        elif not usable(loc, w, place, CUPS):
            differences[i] = -np.inf
        else:
            along = u[0] * loc.xyz[place, 0] + u[1] * loc.xyz[place, 1] + u[2] * loc.xyz[place, 2]
            differences[i] = (w.magnet_pull - w.cup_pull) * w.moment * along
    differences.sort()
    magnets = w.magnets
    low = differences[magnets - 1] if magnets > 0 else -np.inf
    high = differences[magnets] if magnets < n else np.inf
    if np.isfinite(low) and np.isfinite(high):
        return (low + high) / 2
    if np.isfinite(low):
        return low
    return high if np.isfinite(high) else 0.0


@compiled
def relaxed(
    loc: Locations,
    w: Weights,
    a: int,
    b: int,
    n: int,
    u: FloatArray,
    lam: float,
    scratch: Scratch,
    picks: IntArray,
    offset: FloatArray,
) -> float:
    """Return the relaxed value at given multipliers, without the truss; its picks and offset too.

    ``picks`` get the cheapest candidates and the two ends, ``offset`` their centre of force.
    """
    others = len(picks) - 2
    prices = np.full(others + 1, np.inf)
    for i in range(n):
        price = scratch.weight[i] + priced(loc, w, scratch.place[i], u, lam)[0]
        scratch.price[i] = price
        slot = others
        while slot > 0 and prices[slot - 1] > price:
            prices[slot] = prices[slot - 1]
            if slot < others:
                picks[slot] = picks[slot - 1]
            slot -= 1
        if slot < others:
            prices[slot] = price
            picks[slot] = scratch.place[i]
    price_a, end_a = cheapest_end(loc, w, a, u, lam)
    price_b, end_b = cheapest_end(loc, w, b, u, lam)
    picks[others], picks[others + 1] = end_a, end_b
    total = price_a + price_b + lam * w.magnets
    for slot in range(others):
        total += prices[slot]
    offset[:] = 0.0
    if total < np.inf:
        for place in picks:
            pull = w.magnet_pull if priced(loc, w, place, u, lam)[1] else w.cup_pull
            for axis in range(3):
                offset[axis] += pull * loc.xyz[place, axis]
    return total


@compiled
def ascend(
    loc: Locations,
    w: Weights,
    a: int,
    b: int,
    n: int,
    truss: float,
    upper: float,
    u: FloatArray,
    lam: float,
    steps: int,
    scratch: Scratch,
) -> tuple[float, float]:
    """Improve the multipliers by projected Polyak steps; return the best bound and its lam.

    ``u`` is changed to the best direction found.
    """
    picks = np.zeros(w.cups + w.magnets, dtype=np.int64)
    offset = np.zeros(3)
    here, best_u = u.copy(), u.copy()
    best, best_lam = -np.inf, lam
    for _ in range(steps):
        value = truss + relaxed(loc, w, a, b, n, here, lam, scratch, picks, offset)
        if value > best:
            best, best_lam = value, lam
            best_u[:] = here
        if best >= upper or value == np.inf:
            break
        squared = (offset * offset).sum() * w.moment
        if squared > 0.0:
            target = upper if upper < np.inf else value + np.sqrt(squared * w.moment)
            here += offset * ((target - value) / squared)
            norm = np.sqrt((here * here).sum())
            if norm > 1.0:
                here /= norm
        lam = balance(loc, w, picks, len(picks), here)
    u[:] = best_u
    return best, best_lam


@allocation_free
def sift_down(order: IntArray, price: FloatArray, root: int, size: int) -> None:
    """Restore the heap below ``root``."""
    while True:
        child = 2 * root + 1
        if child >= size:
            return
        if child + 1 < size and price[order[child + 1]] < price[order[child]]:
            child += 1
        if price[order[root]] <= price[order[child]]:
            return
        order[root], order[child] = order[child], order[root]
        root = child


@compiled
def far_apart_bound(loc: Locations, w: Weights, n: int, others: int, scratch: Scratch) -> float:
    """Return a bound on the other elements' prices that respects clearance, or kinds.

    In the order of their prices candidates join the first clique whose members are all closer than
    the clearance; a grasp has at most one element in each.  And it has no more elements at places
    for one kind only than that kind's count.  The larger of the two sums is a bound.
    """
    order, price = scratch.order, scratch.price
    for i in range(n):
        order[i] = i
    for root in range(n // 2 - 1, -1, -1):
        sift_down(order, price, root, n)
    members = np.empty((others, MAX_CLIQUE), dtype=np.int64)
    sizes = np.zeros(others, dtype=np.int64)
    cliques = taken = 0
    clique_sum = kind_sum = 0.0
    room = np.array([w.cups, w.magnets])
    squared = (w.clearance * (1 - SLACK)) ** 2
    size = n
    while size > 0 and (cliques < others or taken < others):
        top = order[0]
        place = scratch.place[top]
        size -= 1
        order[0] = order[size]
        sift_down(order, price, 0, size)
        if taken < others:
            both = usable(loc, w, place, CUPS) and usable(loc, w, place, MAGNETS)
            only = CUPS if usable(loc, w, place, CUPS) else MAGNETS
            if both or room[only] > 0:
                room[only] -= 0 if both else 1
                kind_sum += price[top]
                taken += 1
        if cliques == others:
            continue
        joined = False
        for c in range(cliques):
            if joined or sizes[c] == MAX_CLIQUE:
                continue
            joined = True
            for m in range(sizes[c]):
                q = members[c, m]
                dx = loc.xyz[place, 0] - loc.xyz[q, 0]
                dy = loc.xyz[place, 1] - loc.xyz[q, 1]
                if dx * dx + dy * dy >= squared:
                    joined = False
                    break
            if joined:
                members[c, sizes[c]] = place
                sizes[c] += 1
        if not joined:
            members[cliques, 0] = place
            sizes[cliques] = 1
            cliques += 1
            clique_sum += price[top]
    if cliques < others or taken < others:
        return np.inf
    return max(clique_sum, kind_sum)


@allocation_free
def span(pull: float, box: FloatArray, axis: int) -> tuple[float, float]:
    """Return the middle and half the width of a box's share in the centre of force."""
    return pull * (box[axis] + box[axis + 2]) / 2, pull * (box[axis + 2] - box[axis]) / 2


@allocation_free
def pull_of(w: Weights, kind: int) -> float:
    """Return force over total force of one element."""
    return w.magnet_pull if kind else w.cup_pull


@compiled
def few_bound(
    loc: Locations, w: Weights, a: int, b: int, n: int, truss: float, scratch: Scratch
) -> float:
    """Return a bound for grasps of two or three elements, without any relaxation of the third.

    For each candidate and each share of kinds: the centre of force stays in a box around it.
    """
    box_a, box_b = loc.box[a], loc.box[b]
    least_a, least_b = np.inf, np.inf
    low, high = np.inf, -np.inf
    for end in range(2):
        first, last = loc.run[a if end == 0 else b]
        for k in range(first, last):
            low, high = min(low, loc.xyz[k, 2]), max(high, loc.xyz[k, 2])
            if end == 0:
                least_a = min(least_a, loc.deviation[k])
            else:
                least_b = min(least_b, loc.deviation[k])
    fixed = truss + (least_a + least_b) * w.deviation
    best = np.inf
    others = w.cups + w.magnets - 2
    for kind_a in range(2):
        for kind_b in range(2):
            third = w.magnets - kind_a - kind_b
            if not 0 <= third <= others:
                continue
            pull_a, pull_b = pull_of(w, kind_a), pull_of(w, kind_b)
            ax, hx = span(pull_a, box_a, 0)
            bx, gx = span(pull_b, box_b, 0)
            ay, hy = span(pull_a, box_a, 1)
            by, gy = span(pull_b, box_b, 1)
            x, y, dx, dy = ax + bx, ay + by, hx + gx, hy + gy
            z_low, z_high = (pull_a + pull_b) * low, (pull_a + pull_b) * high
            if others == 0:
                arm = box_arm(x, y, dx, dy, z_low, z_high)
                best = min(best, fixed + w.moment * arm)
                continue
            pull = pull_of(w, third)
            for i in range(n):
                place = scratch.place[i]
                if not usable(loc, w, place, third):
                    continue
                shift = pull * loc.xyz[place, 2]
                arm = box_arm(
                    x + pull * loc.xyz[place, 0],
                    y + pull * loc.xyz[place, 1],
                    dx,
                    dy,
                    z_low + shift,
                    z_high + shift,
                )
                best = min(best, fixed + scratch.weight[i] + w.moment * arm)
    return best


@allocation_free
def box_arm(x: float, y: float, dx: float, dy: float, z_low: float, z_high: float) -> float:
    """Return the distance from the centroid to a box about (x, y), from z_low to z_high."""
    px, py = max(0.0, abs(x) - dx), max(0.0, abs(y) - dy)
    pz = max(0.0, z_low, -z_high)
    return np.sqrt(px * px + py * py + pz * pz)


@compiled
def node_bound(
    loc: Locations,
    w: Weights,
    a: int,
    b: int,
    upper: float,
    u: FloatArray,
    lam: float,
    scratch: Scratch,
) -> tuple[float, float]:
    """Return a lower bound of every grasp of a node, and the multiplier lam; changes ``u``."""
    near, far = pair_distances(loc.box[a], loc.box[b])
    if far < w.clearance * (1 - SLACK):
        return np.inf, lam
    shortest = w.ratio * max(near, w.clearance * (1 - SLACK))
    if shortest > w.structure_cap:
        return np.inf, lam
    others = w.cups + w.magnets - 2
    n = gather(loc, w, a, b, far * (1 + 2 * SLACK), scratch) if others else 0
    if n < others:
        return np.inf, lam
    truss = w.base + shortest * w.structure
    if others <= 1:
        return few_bound(loc, w, a, b, n, truss, scratch), lam
    bound, lam = ascend(loc, w, a, b, n, truss, upper, u, lam, ASCENT_STEPS, scratch)
    if bound >= upper:
        return bound, lam
    for i in range(n):
        scratch.price[i] = scratch.weight[i] + priced(loc, w, scratch.place[i], u, lam)[0]
    ends = cheapest_end(loc, w, a, u, lam)[0] + cheapest_end(loc, w, b, u, lam)[0]
    spread = far_apart_bound(loc, w, n, others, scratch)
    return max(bound, truss + ends + lam * w.magnets + spread), lam


@allocation_free
def true_moment(loc: Locations, w: Weights, chosen: IntArray, magnets: int) -> tuple[float, bool]:
    """Return the moment arm (mm) of chosen locations, bit i of ``magnets`` set for a magnet.

    The second value says whether the kinds fit the counts and the locations.
    """
    x = y = z = 0.0
    left = w.magnets
    for i in range(len(chosen)):
        kind = (magnets >> i) & 1
        left -= kind
        if not usable(loc, w, chosen[i], kind):
            return np.inf, False
        pull = w.magnet_pull if kind else w.cup_pull
        x += pull * loc.xyz[chosen[i], 0]
        y += pull * loc.xyz[chosen[i], 1]
        z += pull * loc.xyz[chosen[i], 2]
    return np.sqrt(x * x + y * y + z * z), left == 0


@allocation_free
def settle_kinds(
    loc: Locations,
    w: Weights,
    chosen: IntArray,
    separable: float,
    found: FloatArray,
    genes: IntArray,
) -> None:
    """Try every assignment of kinds to chosen locations, and keep the best grasps.

    ``found (k,)`` are the values of the best so far, rising, and ``genes (k, n, 2)`` their
    locations and kinds.
    """
    worst = len(found) - 1
    for magnets in range(1 << len(chosen)):
        arm, fits = true_moment(loc, w, chosen, magnets)
        if not fits or arm > w.arm_cap * (1 + SLACK):
            continue
        value = separable + w.moment * arm
        if value >= found[worst]:
            continue
        slot = worst
        while slot > 0 and found[slot - 1] > value:
            found[slot] = found[slot - 1]
            for i in range(len(chosen)):
                genes[slot, i, 0] = genes[slot - 1, i, 0]
                genes[slot, i, 1] = genes[slot - 1, i, 1]
            slot -= 1
        found[slot] = value
        for i in range(len(chosen)):
            genes[slot, i, 0] = chosen[i]
            genes[slot, i, 1] = (magnets >> i) & 1


@compiled
def search_pair(
    loc: Locations,
    w: Weights,
    a: int,
    b: int,
    u: FloatArray,
    lam: float,
    found: FloatArray,
    genes: IntArray,
    budget: int,
    scratch: Scratch,
) -> bool:
    """Search all grasps whose main truss joins two locations; tell whether it was finished.

    Depth first over the candidates in the order of their prices; what is left is at least the sum
    of the next prices, so the first one that is too dear ends its level.
    """
    i, j = loc.run[a, 0], loc.run[b, 0]
    dx, dy = loc.xyz[j, 0] - loc.xyz[i, 0], loc.xyz[j, 1] - loc.xyz[i, 1]
    length = np.sqrt(dx * dx + dy * dy)
    others = w.cups + w.magnets - 2
    worst = len(found) - 1
    n = gather(loc, w, a, b, length * (1 + 2 * SLACK), scratch) if others else 0
    truss = w.base + w.ratio * length * w.structure
    u = u.copy()
    if others > 1:
        bound, lam = ascend(loc, w, a, b, n, truss, found[worst], u, lam, PAIR_STEPS, scratch)
    else:
        bound = few_bound(loc, w, a, b, n, truss, scratch)
    if bound >= found[worst]:
        return True
    ends = cheapest_end(loc, w, a, u, lam)[0] + cheapest_end(loc, w, b, u, lam)[0]
    constant = truss + ends + lam * w.magnets
    fixed = truss + (loc.deviation[i] + loc.deviation[j]) * w.deviation
    prices = np.empty(n)
    for k in range(n):
        prices[k] = scratch.weight[k] + priced(loc, w, scratch.place[k], u, lam)[0]
    order = np.argsort(prices)
    sums = np.zeros(n + 1)
    for k in range(n):
        sums[k + 1] = sums[k] + prices[order[k]]
    chosen = np.empty(others + 2, dtype=np.int64)
    chosen[0], chosen[1] = i, j
    position = np.full(others + 1, -1)
    price_so_far = np.zeros(others + 1)
    weight_so_far = np.zeros(others + 1)
    least = (w.clearance * (1 - SLACK)) ** 2
    most = (length * (1 + 2 * SLACK)) ** 2
    if others == 0:
        if keeps_caps(loc, w, chosen, length):
            settle_kinds(loc, w, chosen, fixed, found, genes)
        return True
    depth = 0
    position[0] = -1
    while depth >= 0:
        position[depth] += 1
        k = position[depth]
        left = others - depth
        if k + left > n or (
            constant + price_so_far[depth] + sums[k + left] - sums[k] >= found[worst]
        ):
            depth -= 1
            continue
        budget -= 1
        if budget < 0:
            return False
        candidate = order[k]
        place = scratch.place[candidate]
        apart = True
        for m in range(2, depth + 2):
            ex = loc.xyz[place, 0] - loc.xyz[chosen[m], 0]
            ey = loc.xyz[place, 1] - loc.xyz[chosen[m], 1]
            squared = ex * ex + ey * ey
            if squared < least or squared > most:
                apart = False
                break
        if not apart:
            continue
        chosen[depth + 2] = place
        price_so_far[depth + 1] = price_so_far[depth] + prices[candidate]
        weight_so_far[depth + 1] = weight_so_far[depth] + scratch.weight[candidate]
        if depth + 1 == others:
            if keeps_caps(loc, w, chosen, length):
                settle_kinds(loc, w, chosen, fixed + weight_so_far[depth + 1], found, genes)
            continue
        depth += 1
        position[depth] = k
    return True


@allocation_free
def keeps_caps(loc: Locations, w: Weights, chosen: IntArray, length: float) -> bool:
    """Tell whether chosen locations keep the limits of deviation and structure."""
    if w.deviation_cap == np.inf and w.structure_cap == np.inf:
        return True
    i, j = chosen[0], chosen[1]
    dx, dy = loc.xyz[j, 0] - loc.xyz[i, 0], loc.xyz[j, 1] - loc.xyz[i, 1]
    deviation = 0.0
    doubled_areas = 0.0
    for place in chosen:
        deviation += loc.deviation[place]
        ex, ey = loc.xyz[place, 0] - loc.xyz[i, 0], loc.xyz[place, 1] - loc.xyz[i, 1]
        doubled_areas += abs(dx * ey - dy * ex)
    structure = w.ratio * length + doubled_areas / length
    return deviation <= w.deviation_cap * (1 + SLACK) and structure <= w.structure_cap * (1 + SLACK)


@compiled
def split(loc: Locations, a: int, b: int) -> IntArray:
    """Return the pairs of boxes that a pair splits into, ``(n, 2)``: the wider box in halves."""
    if a == b:
        low, high = loc.child[a]
        return np.array([[low, low], [low, high], [high, high]])
    wide = np.empty(2)
    for side, box in enumerate((a, b)):
        corners = loc.box[box]
        wide[side] = max(corners[2] - corners[0], corners[3] - corners[1])
        if loc.child[box, 0] < 0:
            wide[side] = -1.0
    if wide[0] >= wide[1]:
        return np.array([[loc.child[a, 0], b], [loc.child[a, 1], b]])
    return np.array([[a, loc.child[b, 0]], [a, loc.child[b, 1]]])


@compiled
def expand(
    loc: Locations,
    weights: RecordArray,
    nodes: RecordArray,
    upper: float,
    slack: float,
    children: RecordArray,
    found: FloatArray,
    genes: IntArray,
    scratch: Scratch,
) -> None:
    """Split nodes and bound their children, or search their single pairs.

    Parameters
    ----------
    loc, weights : Locations, RecordArray
    nodes : RecordArray
        ``(m,)`` of ``NODE``.
    upper, slack : float
        Grasps at ``upper`` or above are of no use; nodes within ``slack`` of it are pruned.
    children : RecordArray
        ``(m, 3)`` of ``NODE``; unused ones get an infinite bound.
    found : FloatArray
        ``(m, k)`` values of grasps found, rising; ``upper`` where there is none.
    genes : IntArray
        ``(m, k, n, 2)`` their locations and kinds.
    scratch : Scratch
    """
    u = np.zeros(3)
    for i in range(len(nodes)):
        node = nodes[i]
        w = weights[node.counts]
        for number in range(3):
            children[i, number].bound = np.inf
        found[i] = upper
        u[0], u[1], u[2] = node.ux, node.uy, node.uz
        if loc.child[node.a, 0] < 0 and loc.child[node.b, 0] < 0:
            if node.a != node.b and not search_pair(
                loc, w, node.a, node.b, u, node.lam, found[i], genes[i], node.budget, scratch
            ):
                children[i, 0] = node
                children[i, 0].budget = 4 * node.budget
            continue
        pairs = split(loc, node.a, node.b)
        for number in range(len(pairs)):
            u[0], u[1], u[2] = node.ux, node.uy, node.uz
            a, b = pairs[number, 0], pairs[number, 1]
            bound, lam = node_bound(loc, w, a, b, upper - slack, u, node.lam, scratch)
            if bound < upper - slack:
                child = children[i, number]
                child.bound = max(bound, node.bound)
                child.counts, child.a, child.b = node.counts, a, b
                child.ux, child.uy, child.uz = u[0], u[1], u[2]
                child.lam, child.budget = lam, PAIR_BUDGET


@compiled
def grow_tree(xy: FloatArray) -> tuple[IntArray, FloatArray, IntArray, IntArray]:
    """Build a kd-tree down to single points; return point order, boxes, runs and children."""
    n = len(xy)
    order = np.arange(n)
    box, run = np.empty((2 * n, 4)), np.empty((2 * n, 2), dtype=np.int64)
    child = np.full((2 * n, 2), -1)
    run[0] = 0, n
    nodes, done = 1, 0
    while done < nodes:
        first, last = run[done]
        points = xy[order[first:last]]
        box[done] = points[:, 0].min(), points[:, 1].min(), points[:, 0].max(), points[:, 1].max()
        if last - first > 1:
            wide = box[done, 2] - box[done, 0] >= box[done, 3] - box[done, 1]
            by = np.argsort(points[:, 0 if wide else 1], kind="mergesort")
            order[first:last] = order[first:last][by]
            middle = (first + last) // 2
            for side in range(2):
                child[done, side] = nodes
                run[nodes] = (first, middle) if side == 0 else (middle, last)
                nodes += 1
        done += 1
    return order, box[:nodes], run[:nodes], child[:nodes]
