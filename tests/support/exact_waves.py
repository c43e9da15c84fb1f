"""Natural frequencies of uniform chains and beams from their waves, in mpmath.

Eigenvalues omega^2 [rad^2/s^2] at the present mpmath precision; numbers of a rope are taken as
exact.
"""

import itertools

import mpmath
from mpmath import mpf


def pinned_tensed_chain(rope, tension, n, k):
    """Return eigenvalue k = 1 .. n - 1 of the pinned chain of n tensed elements.

    Its flexibility is the static beam's at the nodes, so that waves add up as 1/lambda: with
    theta = k pi/n, t = a sqrt(T/B) it is the sum over all m of mu/(B q^4 + T q^2) at
    q = (theta + 2 pi m)/a,

        mu a^2/T [1/(4 s^2) - sinh t/(2 t (cosh t - cos theta))],  s = sin(theta/2),
        mu a^4/B (3 - 2 s^2)/(48 s^4)  for T = 0.
    """
    mu, B, T = (mpf(x) for x in (rope.linear_density, rope.bending_stiffness, tension))
    a = mpf(rope.length) / n
    theta = k * mpmath.pi / n
    versed = mpmath.sin(theta / 2) ** 2
    if T == 0:
        return 48 * versed**2 * B / ((3 - 2 * versed) * mu * a**4)
    t = a * mpmath.sqrt(T / B)
    # cosh t - cos theta = 2 sinh^2(t/2) + 2 s^2
    curved = mpmath.sinh(t) / (4 * t * (mpmath.sinh(t / 2) ** 2 + versed))
    return T / (mu * a**2) / mpmath.re(1 / (4 * versed) - curved)


class RigidChain:
    """The uniform chain of rigid elements between equal ends, as a sum of its own waves.

    Nodes at x = -n/2 .. n/2, waves w = cos or sin(phi x), c = cos(phi), in the units of
    ../shared/reference/rigid_chain_exact.json: lambda = omega^2 m a^3/B, tau = T a^2/B,
    kappa = J/(m a^2). c obeys (2 (12 + tau)(1 - c) - lambda)(8 + 4 c - kappa lambda) =
    144 (1 - c^2); the two waves of one symmetry meet the ends where a 2 x 2 determinant is zero.

    Parameters
    ----------
    chain : Chain
        Of (z, beta), uniform: its compiled numbers are taken as exact.
    ends : {"clamped", "free"}
    """

    def __init__(self, chain, ends):
        self.n = chain.nodes - 1
        a, T = mpf(float(chain.length[0])), mpf(float(chain.tension[0]))
        B = 1 / mpf(float(chain.flexibility[0][2][2]))
        m, J = (2 * mpf(float(chain.mass[0][i][i])) for i in range(2))
        self.unit = B / (m * a**3)
        self.tau, self.kappa = T * a**2 / B, J / (m * a**2)
        self.meet = {"clamped": self._clamped, "free": self._free}[ends]

    def crossings(self, eigenvalues):
        """Return how many of the two determinants change their sign between each and the next."""
        signs = [
            [mpmath.sign(self.determinant(value, odd)) for odd in (False, True)]
            for value in eigenvalues
        ]
        return [sum(a != b for a, b in zip(*pair)) for pair in itertools.pairwise(signs)]

    def determinant(self, eigenvalue, odd):
        """Return the real determinant of the symmetric or antisymmetric waves at the end."""
        lam = mpf(eigenvalue) / self.unit
        roots = self._cosines(lam)
        (a, b), (c, d) = (self._column(lam, c, odd) for c in roots)
        # equal roots make equal columns; a wave of rotations alone makes a column of zeros
        alone = mpf(1) if odd else 12 - self.kappa * lam
        alone *= 4 - self.kappa * lam if odd == self.n % 2 else 1
        return mpmath.re((a * d - b * c) / (roots[0] - roots[1])) / alone

    def _cosines(self, lam):
        p, q = 2 * (12 + self.tau), 8 - self.kappa * lam
        square, middle, free = 144 - 4 * p, 4 * (p - lam) - p * q, (p - lam) * q - 144
        root = mpmath.sqrt(mpmath.mpc(middle**2 - 4 * square * free))
        return (-middle + root) / (2 * square), (-middle - root) / (2 * square)

    def _column(self, lam, c, odd):
        """Meet the end with one wave, divided by what makes it a polynomial in c."""
        phi = mpmath.acos(c)
        end = phi * self.n / 2
        w, turn = mpmath.cos(end), -mpmath.sin(phi) * mpmath.sin(end)
        common = mpmath.cos(phi / 2) if self.n % 2 else mpf(1)
        if odd:
            w, turn = mpmath.sin(end), mpmath.sin(phi) * mpmath.cos(end)
            common = mpmath.sin(phi / 2) if self.n % 2 else mpmath.sin(phi)
        return self.meet(8 + 4 * c - self.kappa * lam, c, w / common, turn / common)

    @staticmethod
    def _clamped(p, c, w, turn):
        """z = p w and beta a = 12 turn are zero."""
        return p * w, 12 * turn

    def _free(self, p, c, w, turn):
        """Force and moment of the element that is not there are zero.

        (12 + tau)(z_1 - z_-1)/2 = 6 beta_0 + 3 (beta_1 + beta_-1), and
        3 (z_1 - 2 z_0 + z_-1) = beta_1 - beta_-1 beside the end, beta in units of 1/a.
        """
        return turn * ((12 + self.tau) * p - 72 * (1 + c)), w * (c - 1) * (6 * p - 24 * (1 + c))


def pinned_rigid_chain(chain, number):
    """Return the lowest eigenvalues of the uniform pinned chain of rigid elements, both branches.

    k = 1 .. n - 1 half waves, c = cos(k pi/n), solve the quadratic equation of `RigidChain`;
    rotations alone have kappa lambda = 12 (k = 0) and 4 (k = n).
    """
    waves = RigidChain(chain, "clamped")
    kappa, stiff = waves.kappa, 2 * (12 + waves.tau)
    values = [mpf(12) / kappa, mpf(4) / kappa]
    for k in {*range(1, min(waves.n, number + 1)), *range(max(1, waves.n - number), waves.n)}:
        versed = 2 * mpmath.sin(k * mpmath.pi / (2 * waves.n)) ** 2
        p, q = stiff * versed, (12 - 4 * versed) / kappa
        product = p * q - 144 * versed * (2 - versed) / kappa
        half = (p + q) / 2
        large = half + mpmath.sqrt(half**2 - product)
        values += [product / large, large]
    return [value * waves.unit for value in sorted(values)[:number]]


def beam_determinant(scene, eigenvalue):
    """Return what is zero at the eigenvalues of a continuous tensed beam.

    Between stations z is a sum of cos k s, sin k s, exp(-a s), exp(-a (length - s)) with
    B q^4 + T q^2 = mu lambda for q = k and q = i a; the conditions at the stations are the rows.

    Parameters
    ----------
    scene : Scene
        Bending and tension, no rotary inertia; ends "clamped", "pinned" or "free"; point masses
        anywhere, supports of z inside.
    eigenvalue : mpf
        [rad^2/s^2], positive.
    """
    mu, B, T = (
        mpf(x) for x in (scene.rope.linear_density, scene.rope.bending_stiffness, scene.tension)
    )
    h = T / (2 * B)
    root = mpmath.sqrt(h**2 + mu * eigenvalue / B)
    k, a = mpmath.sqrt(root - h), mpmath.sqrt(root + h)
    length = mpf(scene.rope.length)
    inner = {mpf(p.x) for p in scene.parts if 0 < p.x < scene.rope.length}
    stations = [mpf(0), *sorted(inner), length]
    size = 4 * (len(stations) - 1)
    rows = []

    def row(*terms):
        """Add the row of factor * derivative at the left (0) or right (1) end of a span."""
        rows.append([mpf(0)] * size)
        for span, side, derivative, factor in terms:
            span_length = stations[span + 1] - stations[span]
            for j, value in enumerate(_waves(k, a, span_length, side, derivative)):
                rows[-1][4 * span + j] += factor * value

    def force(span, side, sign=1):
        """T z' - B z''', on what is left of the section."""
        return (span, side, 1, sign * T), (span, side, 3, -sign * B)

    def mass(x):
        return sum(
            mpf(p.mass) for p in scene.parts if hasattr(p, "mass") and abs(mpf(p.x) - x) == 0
        )

    last = len(stations) - 2
    for end, span, side, x in ((scene.ends[0], 0, 0, mpf(0)), (scene.ends[1], last, 1, length)):
        row((span, side, 1, 1) if end == "clamped" else (span, side, 2, B))
        if end == "free":
            # m z" = +- force
            row(*force(span, side, 1 - 2 * side), (span, side, 0, eigenvalue * mass(x)))
        else:
            row((span, side, 0, 1))
    for span, x in enumerate(stations[1:-1]):
        held = any(not hasattr(p, "mass") and mpf(p.x) == x for p in scene.parts)
        row((span, 1, 1, 1), (span + 1, 0, 1, -1))
        row((span, 1, 2, 1), (span + 1, 0, 2, -1))
        if held:
            row((span, 1, 0, 1))
            row((span + 1, 0, 0, 1))
        else:
            row((span, 1, 0, 1), (span + 1, 0, 0, -1))
            row(*force(span + 1, 0), *force(span, 1, -1), (span, 1, 0, eigenvalue * mass(x)))
    return mpmath.det(mpmath.matrix(rows))


def _waves(k, a, length, side, derivative):
    """Derivative of the four waves of a span at its left (0) or right (1) end."""
    s = side * length
    turned = derivative * mpmath.pi / 2
    return (
        k**derivative * mpmath.cos(k * s + turned),
        k**derivative * mpmath.sin(k * s + turned),
        (-a) ** derivative * mpmath.exp(-a * s),
        a**derivative * mpmath.exp(-a * (length - s)),
    )


def beam_eigenvalue(scene, near):
    """Return the eigenvalue of the continuous beam next to a good one, by the secant method."""
    near = mpf(float(near))
    value = mpmath.findroot(
        lambda x: beam_determinant(scene, x), (near, near * (1 + mpf(10) ** -8)), tol=1e-60
    )
    if abs(value / near - 1) > 1e-4:
        raise ValueError(f"the eigenvalue next to {near} is at {value}")
    return value
