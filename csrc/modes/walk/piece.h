/* Pieces of a uniform run: triples joined by doubling, at several lambda side by side.

   X = (G1^-1 + V)^-1, V = Q2 + N the joint's stiffness, F = I + D:
       D = D2 + D1 + D2 D1 - F2 X V F1
       G = G2 + F2 X F2^T
       Q = Q1 + F1^T (V - V X V) F1
   With G1 = L L^T the joint is C = I + L^T V L: its negative pivots are what the joint adds to the
   count, and a piece is joined only while they are all above PIVOT_LIMIT, well below its first
   resonance as a cantilever; so no piece has eigenvalues of its own below lambda. */
#ifndef RD_PIECE_H
#define RD_PIECE_H

#include "base/complex_step.h"
#include "base/real_lanes.h"
#include "modes/walk/foot.h"
#include "modes/walk/plain.h"
#include "modes/walk/walk.h"
#include "modes/walk/width.h"
#include "span/slice.h"

#include <math.h>

#define PIVOT_LIMIT 0.4

enum { LEVELS = 64 };

struct piece {
    lanes D[W][W], G[W][W], Q[W][W];
};

RD_INLINE double largest(lanes x)
{
    double most = 0;
    for (int k = 0; k < RD_LANES; k++)
        most = fmax(most, fabs(x[k]));
    return most;
}

/* a plain span's piece and, where change is not NULL, its d/dlambda */
RD_INLINE void plain_load(const struct rate_matrix *rate, lanes length, struct piece *piece,
                          struct piece *change)
{
    struct plain_piece plain;
    plain_piece_of(rate, length, &plain);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            piece->D[i][j] = plain.D[i][j].re;
            piece->G[i][j] = plain.G[i][j].re;
            piece->Q[i][j] = plain.Q[i][j].re;
            if (change) {
                change->D[i][j] = plain.D[i][j].im / RD_COMPLEX_STEP;
                change->G[i][j] = plain.G[i][j].im / RD_COMPLEX_STEP;
                change->Q[i][j] = plain.Q[i][j].im / RD_COMPLEX_STEP;
            }
        }
}

/* a continuous element's 2^-halvings part and, where change is not NULL, its d/dlambda */
RD_INLINE void slice_load(const struct rd_walk *walk, const struct rd_leg *leg, int halvings,
                          lanes lambda, struct piece *piece, struct piece *change)
{
    const struct rd_chain *chain = walk->chain;
    const size_t e = (size_t)leg->element;
    const cv inertia = c_make(-lambda, l_fill(change ? -RD_COMPLEX_STEP : 0));
    struct rate_matrix rate;
    const double part = ldexp(1, -halvings);
    rd_rate_fill(chain, e, c_real(1), c_real(1), inertia, c_zero(), &rate);
    cv D[W][W], G[W][W], Q[W][W];
    const int terms = rd_span_terms(part * rd_walk_radians(walk, leg, largest(lambda)));
    if (W > 2 && !change) {
        r_slice_fill(&rate, part * chain->length[e], terms, piece->D, piece->G, piece->Q);
        return;
    }
    slice_fill(&rate, part * chain->length[e], terms, D, G, Q);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            piece->D[i][j] = D[i][j].re;
            piece->G[i][j] = G[i][j].re;
            piece->Q[i][j] = Q[i][j].re;
            if (change) {
                change->D[i][j] = D[i][j].im / RD_COMPLEX_STEP;
                change->G[i][j] = G[i][j].im / RD_COMPLEX_STEP;
                change->Q[i][j] = Q[i][j].im / RD_COMPLEX_STEP;
            }
        }
}

/* the element itself */
RD_INLINE void piece_load(const struct rd_walk *walk, int32_t element, struct piece *piece)
{
    const double *triple = walk->triple + (size_t)element * 4 * W * W;
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            piece->D[i][j] = l_fill(triple[i * W + j]);
            piece->G[i][j] = l_fill(triple[W * W + i * W + j]);
            piece->Q[i][j] = l_fill(triple[2 * W * W + i * W + j]);
        }
}

/* N = stiffness - lambda mass of a node term, what is regular of the structures that it carries, and
   what the element before left to the node */
RD_INLINE void term_load(const struct rd_walk *walk, int32_t term, int32_t before, lanes lambda,
                         lanes N[W][W])
{
    const double *stiffness = rd_walk_springs(walk, term);
    const double *mass = rd_walk_mass(walk, term);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            N[i][j] = stiffness[i * W + j] - lambda * mass[i * W + j];
    foot_rest(walk->chain, term, lambda, N, NULL);
    if (before < 0 || !walk->strut[before])
        return;
    const double *P = walk->triple + ((size_t)before * 4 + 3) * W * W;
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            N[i][j] += P[i * W + j];
}

RD_INLINE lanes root(lanes x)
{
    for (int i = 0; i < RD_LANES; i++)
        x[i] = sqrt(x[i]);
    return x;
}

/* A = L L^T; returns the lanes where every pivot exceeds limit */
RD_INLINE lane_mask cholesky(const lanes A[W][W], double limit, lanes L[W][W])
{
    lane_mask above = l_fill(0) == 0;
    for (int j = 0; j < W; j++)
        for (int i = j; i < W; i++) {
            lanes sum = A[i][j];
            for (int k = 0; k < j; k++)
                sum -= L[i][k] * L[j][k];
            if (i == j)
                above &= (lane_mask)(sum > limit);
            L[i][j] = i == j ? root(sum) : sum / L[j][j];
            L[j][i] = i == j ? L[i][i] : l_fill(0);
        }
    return above;
}

/* X = (G^-1 + V)^-1 = (L K^-T)(L K^-T)^T, I + L^T V L = K K^T; lanes where the joint is safe */
RD_INLINE lane_mask joint_invert(const lanes G[W][W], const lanes V[W][W], lanes X[W][W])
{
    lanes L[W][W], VL[W][W], C[W][W], K[W][W], H[W][W];
    lane_mask safe = cholesky(G, 0, L);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            VL[i][j] = l_fill(0);
            for (int k = j; k < W; k++)
                VL[i][j] += V[i][k] * L[k][j];
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j <= i; j++) {
            C[i][j] = l_fill(i == j);
            for (int k = i; k < W; k++)
                C[i][j] += L[k][i] * VL[k][j];
        }
    safe &= cholesky(C, PIVOT_LIMIT, K);
    /* K H^T = L^T */
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            lanes sum = L[i][j];
            for (int k = 0; k < j; k++)
                sum -= H[i][k] * K[j][k];
            H[i][j] = sum / K[j][j];
        }
    for (int i = 0; i < W; i++)
        for (int j = 0; j <= i; j++) {
            X[i][j] = l_fill(0);
            for (int k = 0; k < W; k++)
                X[i][j] += H[i][k] * H[j][k];
            X[j][i] = X[i][j];
        }
    return safe;
}

RD_INLINE void multiply(const lanes A[W][W], const lanes B[W][W], lanes C[W][W])
{
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            C[i][j] = A[i][0] * B[0][j];
            for (int k = 1; k < W; k++)
                C[i][j] += A[i][k] * B[k][j];
        }
}

RD_INLINE void transpose(const lanes A[W][W], lanes B[W][W])
{
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            B[i][j] = A[j][i];
}

/* C = A + F^T B F, symmetric, F = I + D */
RD_INLINE void add_congruent(const lanes A[W][W], const lanes B[W][W], const lanes D[W][W],
                             lanes C[W][W])
{
    lanes BF[W][W];
    multiply(B, D, BF);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            BF[i][j] += B[i][j];
    for (int i = 0; i < W; i++)
        for (int j = 0; j <= i; j++) {
            lanes sum = BF[i][j];
            for (int k = 0; k < W; k++)
                sum += D[k][i] * BF[k][j];
            C[i][j] = A[i][j] + sum;
            C[j][i] = C[i][j];
        }
}

/* The middle of two equal pieces: stiffness V = Q + N, receptance X, XV and V - V X V */
struct middle {
    lanes V[W][W], X[W][W], XV[W][W], S[W][W];
};

RD_INLINE lane_mask middle_fill(const struct piece *piece, const lanes N[W][W],
                                struct middle *middle)
{
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            middle->V[i][j] = piece->Q[i][j] + N[i][j];
    const lane_mask safe = joint_invert(piece->G, middle->V, middle->X);
    multiply(middle->X, middle->V, middle->XV);
    for (int i = 0; i < W; i++)
        for (int j = 0; j <= i; j++) {
            lanes sum = middle->V[i][j];
            for (int k = 0; k < W; k++)
                sum -= middle->V[i][k] * middle->XV[k][j];
            middle->S[i][j] = middle->S[j][i] = sum;
        }
    return safe;
}

/* A + A D */
RD_INLINE void carry(const lanes A[W][W], const lanes D[W][W], lanes AF[W][W])
{
    multiply(A, D, AF);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            AF[i][j] += A[i][j];
}

/* two equal pieces with the node term N between them; lanes where the joint is safe */
RD_INLINE lane_mask piece_double(const struct piece *half, const lanes N[W][W], struct piece *whole)
{
    struct middle middle;
    lanes Dt[W][W], XVF[W][W], DXVF[W][W], DD[W][W];
    const lane_mask safe = middle_fill(half, N, &middle);
    transpose(half->D, Dt);
    carry(middle.XV, half->D, XVF);
    multiply(half->D, XVF, DXVF);
    multiply(half->D, half->D, DD);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            whole->D[i][j] = 2 * half->D[i][j] + DD[i][j] - XVF[i][j] - DXVF[i][j];
    add_congruent(half->G, middle.X, Dt, whole->G);
    add_congruent(half->Q, middle.S, half->D, whole->Q);
    return safe;
}

/* level[0] of a leg, one of its 2^halvings parts of an element, and its d/dlambda */
RD_INLINE void first_piece(const struct rd_walk *walk, const struct rd_leg *leg, int halvings,
                           lanes lambda, struct piece *level, struct piece *change)
{
    if (leg_is_continuous(walk, leg)) {
        slice_load(walk, leg, halvings, lambda, level, change);
        return;
    }
    piece_load(walk, leg->element, level);
    if (change)
        *change = (struct piece){0};
}

/* level[k] of 2^k first pieces of an element's 2^-halvings part; returns the last k with
   2^k <= count 2^halvings and every joint safe */
RD_INLINE int pieces_fill(const struct rd_walk *walk, const struct rd_leg *leg, int halvings,
                          lanes lambda, struct piece *level)
{
    lanes N[W][W];
    int top = 0;
    first_piece(walk, leg, halvings, lambda, level, NULL);
    if (walk->strut[leg->element])
        return 0;
    for (int i = 0; i < W; i++)
        if (rd_walk_held(walk, leg->term)[i])
            return 0;
    term_load(walk, leg->term, leg->element, lambda, N);
    while (top + 1 < LEVELS && ((leg->count << halvings) >> (top + 1)) > 0 &&
           every(piece_double(level + top, N, level + top + 1)))
        top++;
    return top;
}

/* whether a leg of so many first pieces, 2^top of them joined, is more than is walked; a lumped one
   is not, which has no pieces but its elements */
RD_INLINE _Bool is_endless(const struct rd_walk *walk, const struct rd_leg *leg, int halvings,
                           int top)
{
    return leg_is_continuous(walk, leg) && (leg->count << halvings) >> top > RD_PIECES_MOST;
}

/* halvings of the elements of a leg */
RD_INLINE int leg_halvings(const struct rd_walk *walk, const struct rd_leg *leg, lanes lambda)
{
    return rd_span_halvings(rd_walk_radians(walk, leg, largest(lambda)), leg->count);
}

/* d/dlambda of a doubled piece, dN = -mass, M = I - X V, F' = dD:
       dX = M dG1 M^T - X dV X,  dS = M^T dV M - S dG1 S
       dD = dF2 M F1 + F2 M dF1 - F2 (dX V + X dV) F1
       dG = dG2 + F2 dX F2^T + dF2 X F2^T + F2 X dF2^T,  dQ likewise with S, F1 */
RD_INLINE void add_congruent_change(const lanes A[W][W], const lanes B[W][W], const lanes dB[W][W],
                                    const lanes D[W][W], const lanes dD[W][W], lanes C[W][W])
{
    lanes BdD[W][W], FtBdD[W][W], Dt[W][W];
    add_congruent(A, dB, D, C);
    multiply(B, dD, BdD);
    transpose(D, Dt);
    multiply(Dt, BdD, FtBdD);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            FtBdD[i][j] += BdD[i][j];
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            C[i][j] += FtBdD[i][j] + FtBdD[j][i];
}

RD_INLINE void congruent(const lanes A[W][W], const lanes B[W][W], lanes C[W][W])
{
    lanes AB[W][W], At[W][W];
    multiply(B, A, AB);
    transpose(A, At);
    multiply(At, AB, C);
}

RD_INLINE void piece_double_change(const struct piece *half, const struct piece *change,
                                   const lanes N[W][W], const lanes dN[W][W], struct piece *whole)
{
    struct middle middle;
    lanes M[W][W], Mt[W][W], dV[W][W], dX[W][W], dS[W][W], A[W][W], B[W][W], Dt[W][W], dDt[W][W];
    middle_fill(half, N, &middle);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++) {
            M[i][j] = l_fill(i == j) - middle.XV[i][j];
            dV[i][j] = change->Q[i][j] + dN[i][j];
        }
    transpose(M, Mt);
    congruent(Mt, change->G, A);
    congruent(middle.X, dV, B);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            dX[i][j] = A[i][j] - B[i][j];
    congruent(M, dV, A);
    congruent(middle.S, change->G, B);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            dS[i][j] = A[i][j] - B[i][j];

    /* H = dX V + X dV; dD = dF2 M F1 + F2 (M dF1 - H F1) */
    lanes H[W][W], MF[W][W], MdF[W][W], HF[W][W], FH[W][W], dFMF[W][W];
    multiply(dX, middle.V, A);
    multiply(middle.X, dV, B);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            H[i][j] = A[i][j] + B[i][j];
    carry(M, half->D, MF);
    multiply(M, change->D, MdF);
    carry(H, half->D, HF);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            MdF[i][j] -= HF[i][j];
    multiply(half->D, MdF, FH);
    multiply(change->D, MF, dFMF);
    for (int i = 0; i < W; i++)
        for (int j = 0; j < W; j++)
            whole->D[i][j] = MdF[i][j] + FH[i][j] + dFMF[i][j];
    transpose(half->D, Dt);
    transpose(change->D, dDt);
    add_congruent_change(change->G, middle.X, dX, Dt, dDt, whole->G);
    add_congruent_change(change->Q, middle.S, dS, half->D, change->D, whole->Q);
}

#endif
