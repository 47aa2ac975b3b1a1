"""RRT-Connect (Kuffner and LaValle, 2000): two trees of configurations, one from the start and one from the goals, grow
towards random configurations and towards each other. Configurations are tuples of numbers."""

import math


class Tree:
    def __init__(self, roots):
        self.nodes, self.parents = list(roots), [None] * len(roots)

    def grow(self, towards, advance):
        """Goes from the nearest node as far as `advance` lets it. Returns the new node's number, or None."""
        nearest = min(range(len(self.nodes)), key=lambda i: math.dist(self.nodes[i], towards))
        end = advance(self.nodes[nearest], towards)
        if end == self.nodes[nearest]:
            return None
        self.nodes.append(end)
        self.parents.append(nearest)
        return len(self.nodes) - 1

    def way_to_root(self, node):
        while node is not None:
            yield self.nodes[node]
            node = self.parents[node]


def connect(start, goals, advance, sample, most):
    """A list of configurations from the start to one of the goals, or None if `most` samples do not suffice.
    `advance(a, b)`: the last configuration that is free on the straight line from a to b; `sample()`: a random one."""
    from_start, from_goals = Tree([start]), Tree(goals)
    this, other = from_start, from_goals
    for _ in range(most):
        reached = this.grow(sample(), advance)
        if reached is not None:
            met = other.grow(this.nodes[reached], advance)
            if met is not None and other.nodes[met] == this.nodes[reached]:
                here, there = (reached, met) if this is from_start else (met, reached)
                return list(from_start.way_to_root(here))[::-1] + list(from_goals.way_to_root(there))[1:]
        this, other = other, this
    return None


def shortened(path, advance, random, attempts):
    """The path without detours that straight lines can replace. `random`: a random.Random."""
    path = list(path)
    for _ in range(attempts):
        first, last = sorted(random.sample(range(len(path)), 2))
        if last - first > 1 and advance(path[first], path[last]) == path[last]:
            del path[first + 1:last]
    return path
