/* Triples of uniform pieces and their joints for numbers of one type, NUM: included by one source file
   each. times(a, b) is their product, size(a) how large a number is. */
#include "space/space.h"

#include <math.h>
#include <string.h>

enum {
    TERMS = 24
}; /* of the series of a piece of up to half a radian, for all digits of all entries */

struct triple {
    NUM D[RD_SIX][RD_SIX], G[RD_SIX][RD_SIX], Q[RD_SIX][RD_SIX]; /* D = F - I */
};

struct rates {
    NUM phi[RD_SIX][RD_SIX], soft[RD_SIX][RD_SIX], load[RD_SIX][RD_SIX];
};

static void multiply(const NUM A[RD_SIX][RD_SIX], const NUM B[RD_SIX][RD_SIX],
                     NUM C[RD_SIX][RD_SIX])
{
    for (int i = 0; i < RD_SIX; i++) {
        NUM row[RD_SIX] = {0};
        for (int k = 0; k < RD_SIX; k++)
            for (int j = 0; j < RD_SIX; j++)
                row[j] += times(A[i][k], B[k][j]);
        memcpy(C[i], row, sizeof row);
    }
}

static void transpose(const NUM A[RD_SIX][RD_SIX], NUM B[RD_SIX][RD_SIX])
{
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++)
            B[i][j] = A[j][i];
}

/* C = A + B, symmetric but for rounding */
static void add_symmetric(const NUM A[RD_SIX][RD_SIX], const NUM B[RD_SIX][RD_SIX],
                          NUM C[RD_SIX][RD_SIX])
{
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j <= i; j++)
            C[i][j] = C[j][i] = A[i][j] + (B[i][j] + B[j][i]) / 2;
}

/* X (n columns, `wide` apart) <- A^-1 X by Gauss and Jordan with exchanges, A destroyed; the largest entry
   of A^-1 is at most that of X where X begins with the unit matrix */
static void divide(NUM A[RD_SIX][RD_SIX], int n, int wide, NUM *X)
{
    for (int k = 0; k < RD_SIX; k++) {
        int best = k;
        for (int i = k + 1; i < RD_SIX; i++)
            best = size(A[i][k]) > size(A[best][k]) ? i : best;
        for (int j = 0; j < RD_SIX; j++) {
            const NUM a = A[k][j];
            A[k][j] = A[best][j];
            A[best][j] = a;
        }
        for (int j = 0; j < n; j++) {
            const NUM x = X[k * wide + j];
            X[k * wide + j] = X[best * wide + j];
            X[best * wide + j] = x;
        }
        const NUM inverse = over(A[k][k]);
        for (int j = 0; j < RD_SIX; j++)
            A[k][j] = times(A[k][j], inverse);
        for (int j = 0; j < n; j++)
            X[k * wide + j] = times(X[k * wide + j], inverse);
        for (int i = 0; i < RD_SIX; i++) {
            const NUM a = A[i][k];
            if (i == k || a == 0)
                continue;
            for (int j = k; j < RD_SIX; j++)
                A[i][j] -= times(a, A[k][j]);
            for (int j = 0; j < n; j++)
                X[i * wide + j] -= times(a, X[k * wide + j]);
        }
    }
}

/* sum of A_ij x_j, rows and columns exchanged where flipped */
static void add_product(const NUM A[RD_SIX][RD_SIX], int flipped, double h, const NUM *x, NUM *y)
{
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++) {
            const NUM a = flipped ? A[j][i] : A[i][j];
            if (a != 0)
                y[i] += h * times(a, x[j]);
        }
}

/* column c of exp(l E) - I, u over f */
static void column(const struct rates *E, double l, int c, NUM *sum)
{
    NUM term[2 * RD_SIX] = {0};
    memset(sum, 0, 2 * RD_SIX * sizeof *sum);
    term[c] = 1;
    for (int m = 1; m <= TERMS; m++) {
        NUM next[2 * RD_SIX] = {0};
        const double h = l / m;
        add_product(E->phi, 0, h, term, next);
        add_product(E->soft, 0, h, term + RD_SIX, next);
        add_product(E->load, 0, h, term, next + RD_SIX);
        add_product(E->phi, 1, -h, term + RD_SIX, next + RD_SIX);
        for (int i = 0; i < 2 * RD_SIX; i++)
            sum[i] += next[i];
        memcpy(term, next, sizeof next);
    }
}

/* F^T = E22^-1, G = E12 E22^-1 and Q = E22^-1 E21 of exp(l E) = [[E11, E12], [E21, E22]] */
static void first(const struct rates *E, double l, struct triple *t)
{
    enum { ALL = 3 * RD_SIX };
    NUM A[RD_SIX][RD_SIX], X[RD_SIX][ALL], sum[2 * RD_SIX];
    NUM soft[RD_SIX][RD_SIX], inverse[RD_SIX][RD_SIX], zero[RD_SIX][RD_SIX] = {{0}};
    for (int c = 0; c < RD_SIX; c++) {
        column(E, l, c, sum);
        for (int i = 0; i < RD_SIX; i++)
            X[i][RD_SIX + c] = sum[RD_SIX + i];
        column(E, l, RD_SIX + c, sum);
        for (int i = 0; i < RD_SIX; i++) {
            soft[i][c] = sum[i];
            A[i][c] = sum[RD_SIX + i] + (i == c);
            X[i][c] = sum[RD_SIX + i];
            X[i][2 * RD_SIX + c] = i == c;
        }
    }
    divide(A, ALL, ALL, &X[0][0]);
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++) {
            t->D[j][i] = -X[i][j];
            t->Q[i][j] = X[i][RD_SIX + j];
            inverse[i][j] = X[i][2 * RD_SIX + j];
        }
    multiply(soft, inverse, t->G);
    add_symmetric(zero, t->G, t->G);
    add_symmetric(zero, t->Q, t->Q);
}

/* A <- A + A D */
static void carry(NUM A[RD_SIX][RD_SIX], const NUM D[RD_SIX][RD_SIX])
{
    NUM AD[RD_SIX][RD_SIX];
    multiply(A, D, AD);
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++)
            A[i][j] += AD[i][j];
}

/* C = A + (I + D)^T B (I + D) */
static void add_congruent(const NUM A[RD_SIX][RD_SIX], const NUM B[RD_SIX][RD_SIX],
                          const NUM D[RD_SIX][RD_SIX], NUM C[RD_SIX][RD_SIX])
{
    NUM BF[RD_SIX][RD_SIX], Dt[RD_SIX][RD_SIX], DtBF[RD_SIX][RD_SIX];
    memcpy(BF, B, sizeof BF);
    carry(BF, D);
    transpose(D, Dt);
    multiply(Dt, BF, DtBF);
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++)
            BF[i][j] += DtBF[i][j];
    add_symmetric(A, BF, C);
}

/* Two pieces, a node's stiffness N (or NULL) between them, V = Q2 + N, X = (I + G1 V)^-1 G1:

       D = D1 + D2 + D2 D1 - F2 X V F1,  G = G2 + F2 X F2^T,  Q = Q1 + F1^T (V - V X V) F1

   Returns the largest entry of (I + G1 V)^-1. */
static double join(const struct triple *one, const struct triple *two, const NUM *N,
                   struct triple *joined)
{
    enum { ALL = 2 * RD_SIX };
    NUM V[RD_SIX][RD_SIX], A[RD_SIX][RD_SIX], X[RD_SIX][RD_SIX], both[RD_SIX][ALL];
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++)
            V[i][j] = two->Q[i][j] + (N ? N[i * RD_SIX + j] : 0);
    multiply(one->G, V, A);
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++) {
            A[i][j] += i == j;
            both[i][j] = i == j;
            both[i][RD_SIX + j] = one->G[i][j];
        }
    divide(A, ALL, ALL, &both[0][0]);
    double largest = 0;
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++) {
            largest = fmax(largest, size(both[i][j]));
            X[i][j] = (both[i][RD_SIX + j] + both[j][RD_SIX + i]) / 2;
        }
    NUM XV[RD_SIX][RD_SIX], S[RD_SIX][RD_SIX], Dt[RD_SIX][RD_SIX], T[RD_SIX][RD_SIX];
    struct triple found;
    multiply(X, V, XV);
    multiply(V, XV, S);
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++)
            S[i][j] = V[i][j] - S[i][j];
    carry(XV, one->D);
    multiply(two->D, XV, T);
    multiply(two->D, one->D, found.D);
    for (int i = 0; i < RD_SIX; i++)
        for (int j = 0; j < RD_SIX; j++)
            found.D[i][j] += one->D[i][j] + two->D[i][j] - XV[i][j] - T[i][j];
    transpose(two->D, Dt);
    add_congruent(two->G, X, Dt, found.G);
    add_congruent(one->Q, S, one->D, found.Q);
    *joined = found;
    return largest;
}
