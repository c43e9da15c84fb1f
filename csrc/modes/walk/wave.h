/* The left part of a chain in scattering form, at several real lambda side by side.

   u = U s, f = -i Y s with Y = I - U, U = R (R + i I)^-1 where u = R f, coordinates scaled.
   Both U and Y are carried, so that each is accurate where it is small.

   The count: let A be the stiffness of the part, stiffness i at its right coordinates. The angle
   Psi = sum of arg of the pivots of A, each in [0, pi], in any order, is continuous in all data;
   without the i it is pi times the number of negative eigenvalues. Each rank-one change turns Psi
   by less than pi, so the product e = exp(-i Psi) with its number of turns is all of it. */
#ifndef RD_WAVE_H
#define RD_WAVE_H

#include "base/real_lanes.h"
#include "modes/walk/width.h"

#include <stddef.h>

/* of a stretch: less is left to the transfer */
#define DECAYED 0.25

struct wave {
    cv U[W][W], Y[W][W];
    cv e;
    lanes turns; /* full turns in the angle of e */
};

/* e *= p, which turns by less than pi: to the left where left */
RD_INLINE void turn(struct wave *wave, cv p, lane_mask left)
{
    const cv e = c_mul(wave->e, p);
    const lane_mask up = wave->e.im >= 0;
    const lane_mask now = e.im >= 0;
    wave->turns += l_select(left & up & ~now, l_fill(1), l_fill(0));
    wave->turns -= l_select(~left & ~up & now, l_fill(1), l_fill(0));
    wave->e = e;
}

/* Keeps U + Y = I, from the smaller of both, and the size of e, of which only the angle counts: each
   step rounds U and Y on its own, and a pair that has drifted apart describes no chain. */
RD_INLINE void normalise(struct wave *wave)
{
    for (int i = 0; i < W; i++) {
        cv *U = &wave->U[i][i], *Y = &wave->Y[i][i];
        const lane_mask soft = c_size(*U) > c_size(*Y);
        U->re = l_select(soft, 1 - Y->re, U->re);
        U->im = l_select(soft, -Y->im, U->im);
        Y->re = l_select(soft, Y->re, 1 - U->re);
        Y->im = l_select(soft, Y->im, -U->im);
        for (int j = 0; j < i; j++) {
            wave->U[i][j] = c_scale(c_sub(wave->U[i][j], wave->Y[i][j]), 0.5);
            wave->U[j][i] = wave->U[i][j];
            wave->Y[i][j] = wave->Y[j][i] = c_neg(wave->U[i][j]);
        }
    }
    const lanes size = l_abs(wave->e.re) + l_abs(wave->e.im);
    wave->e = c_scale_lanes(wave->e, 1 / size);
}

/* U -= x y y^T, Y += x y y^T */
RD_INLINE void change(struct wave *wave, cv x, const cv *y)
{
    for (int i = 0; i < W; i++) {
        const cv xy = c_mul(x, y[i]);
        for (int j = 0; j <= i; j++) {
            const cv d = c_mul(xy, y[j]);
            wave->U[i][j] = wave->U[j][i] = c_sub(wave->U[i][j], d);
            wave->Y[i][j] = wave->Y[j][i] = c_add(wave->Y[i][j], d);
        }
    }
}

/* y = M v; v^T M v */
RD_INLINE cv along(const cv M[W][W], const lanes *v, cv *y)
{
    cv sum = c_make(l_fill(0), l_fill(0));
    for (int i = 0; i < W; i++) {
        y[i] = c_make(l_fill(0), l_fill(0));
        for (int j = 0; j < W; j++)
            y[i] = c_add(y[i], c_scale_lanes(M[i][j], v[j]));
        sum = c_add(sum, c_scale_lanes(y[i], v[i]));
    }
    return sum;
}

/* 1/d, also where |d|^2 would overflow or vanish */
RD_INLINE cv invert_any(cv d)
{
    const lanes size = 1 / c_size(d);
    return c_scale_lanes(c_invert(c_scale_lanes(d, size)), size);
}

/* A spring q at coordinate j: p = 1 + i q U_jj, x = i q/p, y = U e_j. Re U >= 0. */
RD_INLINE void add_spring(struct wave *wave, int j, lanes q)
{
    cv y[W];
    for (int i = 0; i < W; i++)
        y[i] = wave->U[i][j];
    const lanes im = q * not_negative(y[j].re);
    const cv p = c_make(1 - q * y[j].im, im);
    const cv inverse = c_invert(p);
    turn(wave, p, q >= 0);
    change(wave, c_turn(inverse, q), y);
    /* the column itself without cancellation: U e_j/p */
    for (int i = 0; i < W; i++)
        wave->U[i][j] = wave->U[j][i] = c_mul(y[i], inverse);
}

/* A spring q on u_j + u_k */
RD_INLINE void add_pair(struct wave *wave, int j, int k, lanes q)
{
    cv y[W];
    for (int i = 0; i < W; i++)
        y[i] = c_add(wave->U[i][j], wave->U[i][k]);
    const cv v = c_add(y[j], y[k]);
    const cv p = c_make(1 - q * v.im, q * not_negative(v.re));
    turn(wave, p, q >= 0);
    change(wave, c_turn(c_invert(p), q), y);
}

/* A structure -(w/e) v v^T (chain/attached.h), a spring q = -w/e on v^T u: p = (e - i w v^T U v)/e
   and x = -i w/(e - i w v^T U v), which holds v^T u where e = 0. `own` is the only coordinate of v,
   or -1: its column is U e_own/p without cancellation. */
RD_INLINE void add_pole(struct wave *wave, const lanes *v, int own, lanes w, lanes e)
{
    cv y[W], column[W];
    const cv h = along(wave->U, v, y);
    for (int i = 0; i < W; i++)
        column[i] = own < 0 ? y[i] : wave->U[i][own];
    const cv d = c_make(e + w * h.im, -w * not_negative(h.re));
    const lanes size = 1 / c_size(d), up = l_select(e > 0.0, size, -size);
    turn(wave, c_scale_lanes(d, up), w * up <= 0.0);
    const cv inverse = invert_any(d);
    change(wave, c_turn(inverse, -w), y);
    for (int i = 0; own >= 0 && i < W; i++)
        wave->U[i][own] = wave->U[own][i] = c_mul(column[i], c_scale_lanes(inverse, e));
}

/* Coordinate j held from here on: the spring q -> infinity, p = i U_jj */
RD_INLINE void hold(struct wave *wave, int j)
{
    cv y[W];
    for (int i = 0; i < W; i++)
        y[i] = wave->U[i][j];
    const cv p = c_make(-y[j].im, not_negative(y[j].re));
    turn(wave, p, p.im >= 0);
    change(wave, c_invert(y[j]), y);
    for (int i = 0; i < W; i++) {
        wave->U[i][j] = wave->U[j][i] = c_make(l_fill(0), l_fill(0));
        wave->Y[i][j] = wave->Y[j][i] = c_make(l_fill(i == j), l_fill(0));
    }
}

/* A compliance g v v^T in series: p = 1 - i g v^T Y v, y = Y v, U -= x y y^T with x = i g/p;
   Re Y >= 0. */
RD_INLINE void add_compliance(struct wave *wave, const lanes *v, lanes g)
{
    cv y[W];
    const cv s = along(wave->Y, v, y);
    const cv p = c_make(1 + g * s.im, -g * not_negative(s.re));
    turn(wave, p, g < 0);
    change(wave, c_turn(c_invert(p), g), y);
}

/* X (W, W) <- X Z^-1 in place, Z destroyed, by Gauss-Jordan on the columns; returns det Z. */
RD_INLINE cv divide(cv X[W][W], cv Z[W][W])
{
    cv det = c_make(l_fill(1), l_fill(0));
    for (int k = 0; k < W; k++) {
        const cv inverse = c_invert(Z[k][k]);
        det = c_mul(det, Z[k][k]);
        for (int i = 0; i < W; i++)
            X[i][k] = c_mul(X[i][k], inverse);
        for (int i = 0; i < W; i++)
            if (i != k)
                Z[i][k] = c_mul(Z[i][k], inverse);
        for (int j = 0; j < W; j++) {
            if (j == k)
                continue;
            const cv z = Z[k][j];
            for (int i = 0; i < W; i++) {
                X[i][j] = c_sub(X[i][j], c_mul(X[i][k], z));
                if (i != k)
                    Z[i][j] = c_sub(Z[i][j], c_mul(Z[i][k], z));
            }
        }
    }
    return det;
}

/* R <- F R F^T, F = I + D: P = F^T F - I, Z = I + P U, X = U Z^-1,
       U' - U = -X P U + D X + X D^T + D X D^T = -(Y' - Y), and the angle turns by arg det Z:
   signs of eigenvalues of R stay, so each turns by less than pi/2, two together by less than pi */
RD_INLINE void transfer(struct wave *wave, const lanes D[W][W])
{
    lanes P[W][W];
    cv PU[W][W], X[W][W], Z[W][W], DX[W][W];
    for (int i = 0; i < W; i++)
        for (int j = 0; j <= i; j++) {
            lanes sum = D[i][j] + D[j][i];
            for (int k = 0; k < W; k++)
                sum += D[k][i] * D[k][j];
            P[i][j] = P[j][i] = sum;
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            PU[i][j] = c_make(l_fill(0), l_fill(0));
            for (int k = 0; k < W; k++)
                PU[i][j] = c_add(PU[i][j], c_scale_lanes(wave->U[k][j], P[i][k]));
            Z[i][j] = PU[i][j];
            X[i][j] = wave->U[i][j];
        }
    for (int i = 0; i < W; i++)
        Z[i][i].re += 1;
    const cv det = divide(X, Z);
    turn(wave, det, det.im >= 0);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            DX[i][j] = c_make(l_fill(0), l_fill(0));
            for (int k = 0; k < W; k++)
                DX[i][j] = c_add(DX[i][j], c_scale_lanes(X[k][j], D[i][k]));
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j <= i; j++) {
            cv d = c_add(DX[i][j], DX[j][i]);
            for (int k = 0; k < W; k++) {
                d = c_add(d, c_scale_lanes(DX[i][k], D[j][k]));
                d = c_sub(d, c_mul(X[i][k], PU[k][j]));
            }
            wave->U[i][j] = wave->U[j][i] = c_add(wave->U[i][j], d);
            wave->Y[i][j] = wave->Y[j][i] = c_sub(wave->Y[i][j], d);
        }
}

/* F = diag(1 .. 1 + d .. 1): p = 1 + (c^2 - 1) U_jj, c = 1 + d; U_jj <- c^2 U_jj/p,
   U_ij <- c U_ij/p, the others U_ik - (c^2 - 1) U_ij U_jk/p; written as changes */
RD_INLINE void stretch(struct wave *wave, int j, lanes d)
{
    cv y[W], U[W][W];
    const lanes s = d * (2 + d);
    for (int i = 0; i < W; i++)
        y[i] = wave->U[i][j];
    const cv p = c_make(1 + s * y[j].re, s * y[j].im);
    const cv inverse = c_invert(p);
    turn(wave, p, p.im >= 0);
    for (int i = 0; i < W; i++)
        for (int k = 0; k <= i; k++) {
            U[i][k] = c_scale_lanes(c_mul(c_mul(y[i], y[k]), inverse), -s);
            const int other = i == j ? k : i;
            if (i == j && k == j)
                U[i][k] = c_scale_lanes(c_mul(c_mul(y[j], wave->Y[j][j]), inverse), s);
            else if (i == j || k == j)
                U[i][k] = c_mul(c_mul(y[other], inverse), c_make(d - s * y[j].re, -s * y[j].im));
        }
    for (int i = 0; i < W; i++)
        for (int k = 0; k <= i; k++) {
            wave->U[i][k] = wave->U[k][i] = c_add(wave->U[i][k], U[i][k]);
            wave->Y[i][k] = wave->Y[k][i] = c_sub(wave->Y[i][k], U[i][k]);
        }
}

/* whether I + D turns four eigenvalues by less than pi together: 4 (2 atan c - pi/2) < pi while its
   singular values c are above 0.42 and below 2.4 */
RD_INLINE _Bool is_gentle(const lanes D[W][W])
{
    lanes square = l_fill(0);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            square += D[i][j] * D[i][j];
    return every(square < 0.33);
}

/* F = (I 0; C/A I) (A 0; 0 I) (I 0; 0 E - C/A B) (I A\B; 0 I) with A of the coordinates that do not
   bend, one or two of them: each factor turns by less than pi, a shear two eigenvalues up and two
   down */
RD_INLINE void transfer_by_blocks(struct wave *wave, const lanes D[W][W], const _Bool *bends)
{
    lanes inverse[W][W], left[W][W], own[W][W], rest[W][W], right[W][W];
    int first = 0, last = W - 1;
    while (first < W - 1 && bends[first])
        first++;
    while (last > first && bends[last])
        last--;
    const lanes a = 1 + D[first][first], d = 1 + D[last][last];
    const lanes b = first == last ? l_fill(0) : D[first][last];
    const lanes c = first == last ? l_fill(0) : D[last][first];
    const lanes det = first == last ? a : a * d - b * c;
    const lane_mask apart = det > 1e-3;
    const lanes over = 1 / det;
    inverse[first][last] = -b * over;
    inverse[last][first] = -c * over;
    inverse[first][first] = first == last ? over : d * over;
    inverse[last][last] = first == last ? over : a * over;
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            left[i][j] = right[i][j] = l_fill(0);
            own[i][j] = bends[i] || bends[j] ? l_fill(0) : D[i][j];
            rest[i][j] = bends[i] && bends[j] ? D[i][j] : l_fill(0);
            for (int k = first; k <= last; k += last > first ? last - first : 1) {
                left[i][j] += bends[i] && !bends[j] ? D[i][k] * inverse[k][j] : l_fill(0);
                right[i][j] += !bends[i] && bends[j] ? inverse[i][k] * D[k][j] : l_fill(0);
            }
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            for (int k = 0; k < W && bends[i] && bends[j]; k++)
                rest[i][j] -= left[i][k] * (bends[k] ? l_fill(0) : D[k][j]);
    /* far beyond all eigenvalues A may be singular: F as it is */
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            right[i][j] = l_select(apart, right[i][j], l_fill(0));
            own[i][j] = l_select(apart, own[i][j], l_fill(0));
            rest[i][j] = l_select(apart, rest[i][j], D[i][j]);
            left[i][j] = l_select(apart, left[i][j], l_fill(0));
        }
    transfer(wave, right);
    transfer(wave, own);
    transfer(wave, rest);
    transfer(wave, left);
}

/* F in factors that turn by less than pi, for more than two coordinates: their own stretches first,
   but for what decays within the piece */
RD_INLINE void transfer_in_parts(struct wave *wave, const lanes D[W][W], const _Bool *bends)
{
    lanes rest[W][W];
    for (int j = 0; j < W; j++) {
        const lanes c = l_select(1 + D[j][j] > DECAYED, 1 + D[j][j], l_fill(DECAYED));
        stretch(wave, j, c - 1);
        for (int i = 0; i < W; i++)
            rest[i][j] = i == j ? (1 + D[j][j] - c) / c : D[i][j] / c;
    }
    if (is_gentle(rest))
        transfer(wave, rest);
    else
        transfer_by_blocks(wave, rest, bends);
}

/* Removes the i of coordinate j: p = Y_jj, Re Y >= 0, Y <- its Schur complement */
RD_INLINE void release(struct wave *wave, int j)
{
    cv p = wave->Y[j][j];
    p.re = not_negative(p.re);
    turn(wave, p, p.im >= 0);
    const cv inverse = c_invert(wave->Y[j][j]);
    for (int i = j + 1; i < W; i++)
        for (int k = j + 1; k < W; k++)
            wave->Y[i][k] =
                c_sub(wave->Y[i][k], c_mul(c_mul(wave->Y[i][j], wave->Y[j][k]), inverse));
}

#endif
