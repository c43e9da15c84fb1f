/* The response of a tensed span that bends, by the waves that its ends send back.

   B w'''' - T w'' - m w = 0, m = mu omega^2 - i c omega, B and T complex, has the waves e^{-iKx} and
   e^{-Ax} over the length 1, with A^2 - K^2 = p = T L^2/B and A^2 K^2 = m L^4/B. At an end on springs
   sigma = s1/s2, kappa = k1/k2, of exponent e in the direction away from it,

       s1 w = s2 (p w' - w'''):  s1 - s2 e A^2 (e = -+ iK),  s1 + s2 e K^2 (e = -+ A)
       k1 w' = k2 w'':           k1 e - k2 e^2

   for what leaves it (e = -iK, -A) and arrives (iK, A), so that R = -M_out^-1 M_in. With
   P(x) = diag(e^{-iKx}, e^{-Ax}), a unit force at x0 sends out s = (-i/K, -1/A) L^3/2B(A^2 + K^2) to
   both sides, and at x1 >= x0

       R1 = P(x0) R_L P(x0),  R2 = P(1 - x0) R_R P(1 - x0)
       w = 1^T [P(x1 - x0) + P(1 - x1) R_R P(1 - x0)] (1 - R1 R2)^-1 (1 + R1) s */
#include "closed/response.h"

#include "closed/lane_trig.h"

static const double ROUNDING = 0x1p-52;

/* a larger error is none to answer with */
static const double CERTAIN = 1e-9;

struct two {
    cv of[2];
};

struct four {
    cv of[2][2];
};

struct waves {
    cv K, A, K2, A2;
    cv source; /* L^3/2B(A^2 + K^2) */
    cv spring; /* what springs are multiplied with, in parts of B */
    lane_mask certain;
};

struct end {
    struct four R;
    lanes size, noise; /* sums of |R| and of what rounding does to it, in eps */
};

/* an end's springs as double numbers (s1 : s2), (k1 : k2) */
struct springs {
    double s1, s2, k1, k2;
};

RD_INLINE cv c_load(const double *row, const size_t *line)
{
    cv z;
    for (int i = 0; i < RD_LANES; i++) {
        z.re[i] = row[2 * line[i]];
        z.im[i] = row[2 * line[i] + 1];
    }
    return z;
}

/* e^-z for Re z >= 0 */
RD_INLINE cv c_decay(cv z)
{
    lanes size = l_fill(1);
    if (some(z.re != 0.0))
        l_expm1_of_minus(z.re, &size);
    if (!some(z.im != 0.0))
        return (cv){size, l_fill(0)};
    const struct l_circle at = l_circle_of(z.im);
    return (cv){size * at.cos, -(size * at.sin)};
}

RD_INLINE struct two two_mul(struct two a, struct two b)
{
    return (struct two){{c_mul(a.of[0], b.of[0]), c_mul(a.of[1], b.of[1])}};
}

RD_INLINE lanes two_size(struct two a)
{
    return c_size(a.of[0]) + c_size(a.of[1]);
}

RD_INLINE struct two four_times(const struct four *m, struct two a)
{
    struct two b;
    for (int i = 0; i < 2; i++)
        b.of[i] = c_add(c_mul(m->of[i][0], a.of[0]), c_mul(m->of[i][1], a.of[1]));
    return b;
}

RD_INLINE lanes four_size(const struct four *m)
{
    return c_size(m->of[0][0]) + c_size(m->of[0][1]) + c_size(m->of[1][0]) + c_size(m->of[1][1]);
}

/* P R P */
RD_INLINE struct four between(struct two p, const struct four *R)
{
    struct four m;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            m.of[i][j] = c_mul(c_mul(p.of[i], R->of[i][j]), p.of[j]);
    return m;
}

RD_INLINE struct two travelled(const struct waves *w, double x)
{
    const struct two p = {
        {c_decay(c_scale(c_times_i(w->K), x)), c_decay(c_scale(w->A, x))},
    };
    return p;
}

RD_INLINE struct waves waves_of(const double *number, const struct rd_closed_lines *lines,
                                const size_t *line)
{
    const double L = number[RD_BENT_LENGTH], L2 = L * L;
    const double *factor = lines->factor;
    const size_t row = 2 * lines->lines;
    const cv section = c_load(factor, line), tension = c_load(factor + row, line);
    const cv spring = c_load(factor + 2 * row, line), inertia = c_load(factor + 3 * row, line);
    const cv dashpot = c_load(factor + 4 * row, line);
    const cv soft = c_inverse(c_scale(section, number[RD_BENT_STIFFNESS]));
    const cv moved =
        c_add(c_scale(inertia, number[RD_BENT_INERTIA]), c_scale(dashpot, lines->drag));
    const cv load = c_scale(c_mul(moved, soft), -L2 * L2);
    const cv half = c_scale(c_mul(tension, soft), 0.5 * number[RD_BENT_TENSION] * L2);
    /* A^2 and -K^2 are half +- root: the larger one, and the other from their product */
    const cv root = c_root(c_add(c_mul(half, half), load));
    const lane_mask tensed = half.re * root.re + half.im * root.im >= 0.0;
    const cv sum = {root.re + l_select(tensed, half.re, -half.re),
                    root.im + l_select(tensed, half.im, -half.im)};
    const cv other = c_mul(load, c_inverse(sum));
    struct waves w;
    w.A2 = (cv){l_select(tensed, sum.re, other.re), l_select(tensed, sum.im, other.im)};
    w.K2 = (cv){l_select(tensed, other.re, sum.re), l_select(tensed, other.im, sum.im)};
    w.K = c_root(w.K2);
    w.A = c_root(w.A2);
    w.source = c_scale(c_mul(soft, c_inverse(c_scale(root, 4))), L * L2);
    w.spring = c_mul(spring, c_inverse(section));
    w.certain = (w.K.re >= 0.0625) & (w.A.re >= 0.0625) & (w.K.im <= 0.0) & (w.K.im > -64.0);
    return w;
}

/* springs in parts of B/L and B/L^3, projective */
static struct springs springs_of(const double *number, int side)
{
    const double L = number[RD_BENT_LENGTH], per = L / number[RD_BENT_STIFFNESS];
    const double kappa = number[side ? RD_BENT_BETA1 : RD_BENT_BETA0] * per;
    const double sigma = number[side ? RD_BENT_Z1 : RD_BENT_Z0] * L * L * per;
    const int stiff_k = fabs(kappa) > 1, stiff_s = fabs(sigma) > 1;
    return (struct springs){
        .s1 = stiff_s ? copysign(1, sigma) : sigma,
        .s2 = stiff_s ? 1 / fabs(sigma) : 1,
        .k1 = stiff_k ? copysign(1, kappa) : kappa,
        .k2 = stiff_k ? 1 / fabs(kappa) : 1,
    };
}

RD_INLINE struct end end_of(const struct springs *on, const struct waves *w)
{
    const cv s1 = c_scale(w->spring, on->s1), k1 = c_scale(w->spring, on->k1);
    const cv across[2] = {c_times_i(c_scale(c_mul(w->K, w->A2), on->s2)),
                          c_neg(c_scale(c_mul(w->A, w->K2), on->s2))};
    const cv turned[2] = {c_neg(c_times_i(c_mul(k1, w->K))), c_neg(c_mul(k1, w->A))};
    const cv bent[2] = {c_scale(w->K2, on->k2), c_neg(c_scale(w->A2, on->k2))};
    cv out[2][2], in[2][2];
    lanes t[2], r[2];
    for (int j = 0; j < 2; j++) {
        out[0][j] = c_add(s1, across[j]);
        in[0][j] = c_sub(s1, across[j]);
        out[1][j] = c_add(bent[j], turned[j]);
        in[1][j] = c_sub(bent[j], turned[j]);
        t[j] = c_size(s1) + c_size(across[j]);
        r[j] = c_size(bent[j]) + c_size(turned[j]);
    }
    const cv det = c_sub(c_mul(out[0][0], out[1][1]), c_mul(out[0][1], out[1][0]));
    const cv per = c_neg(c_inverse(det));
    struct end end;
    for (int j = 0; j < 2; j++) {
        const cv top = c_sub(c_mul(out[1][1], in[0][j]), c_mul(out[0][1], in[1][j]));
        const cv low = c_sub(c_mul(out[0][0], in[1][j]), c_mul(out[1][0], in[0][j]));
        end.R.of[0][j] = c_mul(top, per);
        end.R.of[1][j] = c_mul(low, per);
    }
    /* each product within 2 eps of its size */
    const lanes both = t[0] * r[1] + t[1] * r[0], all = (t[0] + t[1]) * (r[0] + r[1]);
    end.size = four_size(&end.R);
    end.noise = 2.0 * (2.0 * all + end.size * both) * c_size(per);
    return end;
}

/* w at x1 per unit force at x0 <= x1, and its relative error */
RD_INLINE cv response_at(const struct waves *w, const struct end *ends, double x0, double x1,
                         lanes *error)
{
    const struct two p0 = travelled(w, x0), p1 = travelled(w, x1 - x0);
    const struct two p2 = travelled(w, 1 - x1), p12 = two_mul(p1, p2);
    const struct four R1 = between(p0, &ends[0].R), R2 = between(p12, &ends[1].R);
    const struct two s = {{c_mul(c_neg(c_times_i(c_inverse(w->K))), w->source),
                           c_mul(c_neg(c_inverse(w->A)), w->source)}};
    struct two sent = four_times(&R1, s);
    for (int i = 0; i < 2; i++)
        sent.of[i] = c_add(s.of[i], sent.of[i]);
    struct four N;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            const cv back = c_add(c_mul(R1.of[i][0], R2.of[0][j]), c_mul(R1.of[i][1], R2.of[1][j]));
            N.of[i][j] = c_sub(c_real(i == j), back);
        }
    const cv det = c_sub(c_mul(N.of[0][0], N.of[1][1]), c_mul(N.of[0][1], N.of[1][0]));
    const cv per = c_inverse(det);
    const struct four turned = {{{N.of[1][1], c_neg(N.of[0][1])}, {c_neg(N.of[1][0]), N.of[0][0]}}};
    struct two a = four_times(&turned, sent);
    for (int i = 0; i < 2; i++)
        a.of[i] = c_mul(a.of[i], per);
    const struct two back = four_times(&ends[1].R, two_mul(p12, a));
    const cv u = c_add(c_add(c_mul(p1.of[0], a.of[0]), c_mul(p1.of[1], a.of[1])),
                       c_add(c_mul(p2.of[0], back.of[0]), c_mul(p2.of[1], back.of[1])));

    /* what rounding does, in eps and to first order: the way of the waves, ends, and each sum */
    const lanes way = 2.0 + c_size(w->K), out = two_size(s), gone = two_size(a);
    const lanes one = four_size(&R1), other = four_size(&R2), inverse = four_size(&turned);
    const lanes noise0 = ends[0].noise + way * one, noise1 = ends[1].noise + way * other;
    const lanes of_N = noise0 * other + one * noise1 + 1.0 + one * other;
    const lanes of_sent = noise0 * out + way * (1.0 + one) * out;
    const lanes size = c_size(per);
    const lanes of_a = inverse * size * (of_N * gone + of_sent) + inverse * inverse * size * gone;
    const lanes heard = two_size(p1) + (1.0 + ends[1].size) * two_size(p2) * two_size(p12);
    const lanes of_u = heard * of_a + (way * heard + ends[1].noise * two_size(p2)) * gone;
    *error = ROUNDING * of_u / c_size(u);
    return u;
}

RD_INLINE void keep(const struct rd_closed_lines *lines, const struct rd_closed_response *to,
                    const size_t *line, size_t used, size_t pair, cv u, lanes error)
{
    const size_t at = pair * lines->lines;
    for (size_t i = 0; i < used; i++) {
        to->value[2 * (at + line[i])] = u.re[i];
        to->value[2 * (at + line[i]) + 1] = u.im[i];
        to->error[at + line[i]] = error[i];
    }
}

/* a few lines of a row */
RD_INLINE void lines_of(const double *number, const struct springs *on, size_t row, size_t start,
                        const struct rd_closed_lines *lines, const struct rd_closed_response *to)
{
    const size_t left = lines->lines - start, used = left < RD_LANES ? left : RD_LANES;
    size_t line[RD_LANES];
    for (size_t i = 0; i < RD_LANES; i++)
        line[i] = start + (i < used ? i : used - 1);
    const struct waves w = waves_of(number, lines, line);
    const struct end ends[2] = {end_of(on, &w), end_of(on + 1, &w)};
    const double L = number[RD_BENT_LENGTH];
    lane_mask certain = w.certain;
    for (size_t d = 0; d < lines->drives; d++)
        for (size_t r = 0; r < lines->responses; r++) {
            const double x = lines->drive[d] / L, y = lines->response[r] / L;
            lanes error;
            const cv u =
                x < y ? response_at(&w, ends, x, y, &error) : response_at(&w, ends, y, x, &error);
            certain &= error < CERTAIN;
            keep(lines, to, line, used, (row * lines->drives + d) * lines->responses + r, u, error);
        }
    for (size_t i = 0; i < used; i++)
        to->certain[row * lines->lines + line[i]] = certain[i] != 0;
}

static int is_inside(const double *number, const struct rd_closed_lines *lines)
{
    const double L = number[RD_BENT_LENGTH];
    int inside = L > 0 && number[RD_BENT_INERTIA] > 0 && number[RD_BENT_STIFFNESS] > 0;
    for (size_t d = 0; d < lines->drives; d++)
        inside &= lines->drive[d] >= 0 && lines->drive[d] <= L;
    for (size_t r = 0; r < lines->responses; r++)
        inside &= lines->response[r] >= 0 && lines->response[r] <= L;
    return inside;
}

RD_CLONES static void bent_response(const double *number, size_t first, size_t last,
                                    const struct rd_closed_lines *lines,
                                    const struct rd_closed_response *to)
{
    for (size_t row = first; row < last; row++) {
        const double *own = number + row * RD_BENT_NUMBERS;
        const int inside = is_inside(own, lines);
        const struct springs on[2] = {springs_of(own, 0), springs_of(own, 1)};
        for (size_t start = 0; start < lines->lines; start += RD_LANES) {
            if (inside)
                lines_of(own, on, row, start, lines, to);
            else
                for (size_t i = start; i < lines->lines && i < start + RD_LANES; i++)
                    to->certain[row * lines->lines + i] = 0;
        }
    }
}

/* copies are chosen behind this: a copied function would be seen outside the library */
void rd_bent_response(const double *number, size_t first, size_t last,
                      const struct rd_closed_lines *lines,
                      const struct rd_closed_response *response)
{
    bent_response(number, first, last, lines, response);
}
