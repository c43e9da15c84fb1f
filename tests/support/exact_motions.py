"""The space of motions that one side of a rope admits, in many digits."""

from mpmath import mpf


class Motions:
    """Columns (u, f) that span the motions admitted by what has been passed so far.

    u is the motion of a section and f the force of the rope on its right on the rope on its left.
    There are as many columns as coordinates. Every step is linear in their exterior product, whose
    size `volume` is kept apart while the columns are made independent again and again: the product
    is an entire function of omega^2.

    Parameters
    ----------
    units : sequence
        Of u and then of f: what is large.
    """

    def __init__(self, units):
        self.units, w = units, len(units) // 2
        self.width, self.volume = w, mpf(1)
        # before the first node: any motion, no force
        self.rows = [[mpf(i == j) for j in range(w)] for i in range(2 * w)]
        self.watched = {}

    def watch(self, name, row):
        """Remember row number `row` of the motions here."""
        self.watched[name] = list(self.rows[row])

    def cross(self, transition):
        """Carry the motions along a piece whose end is `transition` (2w, 2w) times its start."""
        columns = list(zip(*self.rows))
        self.rows = [[_dot(row, column) for column in columns] for row in transition]
        self._make_independent()

    def add(self, row, factor, source):
        """Add a multiple of one row to another: a spring, a mass, an elastic hinge."""
        self.rows[row] = [a + factor * b for a, b in zip(self.rows[row], self.rows[source])]

    def replace(self, row, free):
        """Ask for zero in a row, and let another row be anything: a support, a free hinge."""
        k = max(range(self.width), key=lambda j: abs(self.rows[row][j]))
        self._eliminate(row, k)
        self.volume *= self.rows[row][k]
        for some in self._all():
            some[k] = mpf(0)
        self.rows[free][k] = mpf(1)

    def _make_independent(self):
        """Reduce columns to units in their largest rows; the one column of a string too."""
        columns, rows = list(range(self.width)), list(range(2 * self.width))
        while columns:
            i, k = max(
                ((i, k) for i in rows for k in columns),
                key=lambda at: abs(self.rows[at[0]][at[1]]) / self.units[at[0]],
            )
            pivot = self.rows[i][k]
            self.volume *= pivot
            for row in self._all():
                row[k] /= pivot
            self._eliminate(i, k)
            columns.remove(k)
            rows.remove(i)

    def _eliminate(self, i, k):
        """Clear row i of all columns but k by subtracting multiples of column k."""
        pivot = self.rows[i][k]
        share = {j: x / pivot for j, x in enumerate(self.rows[i]) if j != k and x != 0}
        for row in self._all():
            for j, x in share.items():
                row[j] -= x * row[k]

    def _all(self):
        yield from self.rows
        yield from self.watched.values()


def _dot(a, b):
    return sum((x * y for x, y in zip(a, b)), mpf(0))
