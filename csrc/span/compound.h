/* What a whole plain span that bends does to the minors of the plane behind a walk where nothing is
   damped (sweep/kernel/plane.h), in real numbers.

   In units of the rate matrix (span/rate_matrix.h) with S = S', r = Phi_z,beta the minors
   (d, a, b, c, e) = (FM, zM, -zF, F beta, z beta) of two solutions go along the span by

       d' = q_z a + q_beta c,  a' = 2 r b + q_beta e,  b' = r c,  c' = q_z e + S d,  e' = S a.

   With the wavenumbers and C, s, c, g of span/halves.h at its end, E = k^2 + a^2, K = k^2 a^2,
   theta = a^2 - k^2 and (r^2 S d, a, r b, r^2 c, e/S) for the minors the solution is the matrix

       | dd  da      db  ae  de   |   ad = (s c - C g)/E              dd = (a^4 + k^4) C c + 2 K + K theta s g
       | ad  Cc    2 bc  sg  ae   |   bc = (a^2 C g + k^2 s c)/E      bd = theta (C c - 1) + 2 K s g
       | bd  -K ad   bb  bc  db/2 |   ae = (a^4 C g - k^4 s c)/E      bb = 4 K C c - 2 K theta s g + theta^2
       | bc  -K sg -2 K ad Cc da  |   da = -K (k^2 C g + a^2 s c)/E   db/2 = K (theta (C c - 1) - (a^4 + k^4) s g)
       | ed  bc    2 bd  ad  dd   |   ed = theta s g - 2 (C c - 1)
                                      de = -2 K^2 (C c - 1) - K theta (a^4 + K + k^4) s g

   the right column over E^2. All is times e^{-a l}, which a common factor of minors may be: whatever
   decays along the span is lost beside what grows, and nothing has a pole. */
#ifndef RD_COMPOUND_H
#define RD_COMPOUND_H

#include "span/plain_triple.h"

/* what a span is known by: theta and K [1/m^2, 1/m^4], S' > 0 and r */
struct bent_numbers {
    lanes theta, K, soft, lever, length;
};

struct bent_compound {
    lanes dd, db, de, da, ad, ae, bb, bc, bd, ed, Cc, sg, K;
    lanes units[4], back[4]; /* of d, b, c and e, and what undoes them */
    lanes radians;           /* of its waves */
    lane_mask brief;         /* where the triple of its series stands for it */
    int some_brief;
    lanes triple[10]; /* D, G, Q by rows */
};

/* k^2 and a^2, the smaller one from their product K >= 0 */
RD_INLINE void real_wavenumbers(lanes theta, lanes K, lanes *k2, lanes *a2)
{
    const lanes half = 0.5 * theta, R = l_root(half * half + K);
    const lane_mask tensed = half >= 0.0;
    const lanes large = R + l_abs(half), small = K / large;
    *k2 = l_select(tensed, small, large);
    *a2 = l_select(tensed, large, small);
}

RD_INLINE void compound_brief(const struct bent_numbers *of, struct bent_compound *x)
{
    const lanes r = of->lever, none = {0};
    const cv load[2] = {{-of->K / (of->soft * r * r), none}, {of->theta / of->soft, none}};
    struct bent_triple t;
    bent_triple_brief((cv){of->soft, none}, load, r, of->length, &t);
    for (int i = 0; i < 4; i++)
        x->triple[i] = t.D[i].re;
    for (int i = 0; i < 3; i++) {
        x->triple[4 + i] = t.G[i].re;
        x->triple[7 + i] = t.Q[i].re;
    }
}

/* K >= 0 */
RD_INLINE void bent_compound_fill(const struct bent_numbers *of, struct bent_compound *x)
{
    const lanes theta = of->theta, K = of->K, soft = of->soft, r = of->lever, length = of->length;
    lanes k2, a2, e;
    real_wavenumbers(theta, K, &k2, &a2);
    const lanes E = k2 + a2, per = 1.0 / E, k = l_root(k2), alpha = l_root(a2);
    x->radians = k * length;
    x->brief = ~(E * (length * length) > (double)BENT_BRIEF);
    const struct l_circle u = l_circle_of(x->radians);
    const lanes m = l_expm1_of_minus(alpha * length, &e);
    /* all but C and s are times e^{-a l}, which `e` is */
    const lanes C = u.cos, s = l_select(k > 0.0, u.sin / k, length);
    const lanes c = 0.5 * (1.0 + e * e);
    const lanes g = l_select(alpha > 0.0, -0.5 * (m * (m + 2.0)) / alpha, length);
    const lanes Cc = C * c, sg = s * g, Cg = C * g, sc = s * c, away = Cc - e;
    const lanes both = a2 * a2 + k2 * k2, square = per * per;
    x->K = K;
    x->Cc = Cc;
    x->sg = sg;
    x->ad = (sc - Cg) * per;
    x->bc = (a2 * Cg + k2 * sc) * per;
    x->ae = (a2 * a2 * Cg - k2 * k2 * sc) * per;
    x->da = -K * (k2 * Cg + a2 * sc) * per;
    x->dd = (both * Cc + K * (2.0 * e + theta * sg)) * square;
    x->bd = (theta * away + 2.0 * K * sg) * square;
    x->bb = (K * (4.0 * Cc - 2.0 * theta * sg) + theta * theta * e) * square;
    x->db = 2.0 * K * (theta * away - both * sg) * square;
    x->ed = (theta * sg - 2.0 * away) * square;
    x->de = -K * (2.0 * K * away + theta * (both + K) * sg) * square;
    const lanes hard = 1.0 / soft, units[4] = {r * r * soft, r, r * r, hard};
    const lanes low = 1.0 / r, back[4] = {low * low * hard, low, low * low, soft};
    for (int i = 0; i < 4; i++) {
        x->units[i] = units[i];
        x->back[i] = back[i];
    }
    x->some_brief = some(x->brief);
    if (x->some_brief) {
        compound_brief(of, x);
        x->radians = l_select(x->brief, l_fill(BENT_BRIEF), x->radians);
    }
}

/* p: d, a, b, c, e */
RD_INLINE void bent_compound_apply(const struct bent_compound *x, lanes *p)
{
    const lanes d = p[0] * x->units[0], a = p[1], b = p[2] * x->units[1];
    const lanes c = p[3] * x->units[2], e = p[4] * x->units[3];
    const lanes half = 0.5 * x->db, b2 = b + b;
    p[0] = x->back[0] * (x->dd * d + x->da * a + x->db * b + x->ae * c + x->de * e);
    p[1] = x->ad * d + x->Cc * a + x->bc * b2 + x->sg * c + x->ae * e;
    p[2] = x->back[1] * (x->bd * d - x->K * x->ad * a + x->bb * b + x->bc * c + half * e);
    p[3] = x->back[2] * (x->bc * d - x->K * (x->sg * a + x->ad * b2) + x->Cc * c + x->da * e);
    p[4] = x->back[3] * (x->ed * d + x->bc * a + x->bd * b2 + x->ad * c + x->dd * e);
}

#endif
