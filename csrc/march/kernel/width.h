/* The kernels of a march for the width RD_WIDTH: included by one source file per width. */

#include "base/fast.h"
#include "march/kernel/kernel.h"

#include <math.h>

#define NAME_(verb, w) verb##_##w
#define NAME(verb, w) NAME_(verb, w)

enum { W = RD_WIDTH, WW = W * W };
#define UNROLL RD_UNROLL(16)

/* y = M x and y = M^T x */
static inline void times(const double *restrict M, const double *restrict x, double *restrict y)
{
    UNROLL for (int i = 0; i < W; i++) {
        double sum = M[i * W] * x[0];
        UNROLL for (int j = 1; j < W; j++)
            sum += M[i * W + j] * x[j];
        y[i] = sum;
    }
}

static inline void times_transposed(const double *restrict M, const double *restrict x,
                                    double *restrict y)
{
    UNROLL for (int i = 0; i < W; i++) {
        double sum = M[i] * x[0];
        UNROLL for (int j = 1; j < W; j++)
            sum += M[j * W + i] * x[j];
        y[i] = sum;
    }
}

static inline double form(const double *M, const double *x)
{
    double y[W], sum = 0;
    times(M, x, y);
    UNROLL for (int i = 0; i < W; i++)
        sum += x[i] * y[i];
    return sum;
}

/* C = A B and C = A B^T */
static void multiply(const double *A, const double *B, double *C)
{
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            double sum = 0;
            UNROLL for (int k = 0; k < W; k++)
                sum += A[i * W + k] * B[k * W + j];
            C[i * W + j] = sum;
        }
}

static void multiply_transposed(const double *A, const double *B, double *C)
{
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < W; j++) {
            double sum = 0;
            UNROLL for (int k = 0; k < W; k++)
                sum += A[i * W + k] * B[j * W + k];
            C[i * W + j] = sum;
        }
}

static void symmetrise(double *M)
{
    UNROLL for (int i = 0; i < W; i++)
        UNROLL for (int j = 0; j < i; j++) {
            const double mean = (M[i * W + j] + M[j * W + i]) / 2;
            M[i * W + j] = mean;
            M[j * W + i] = mean;
        }
}

/* X = M^-1 with exchange of rows, M destroyed; its determinant */
static double invert(double *M, double *X)
{
    double det = 1;
    UNROLL for (int i = 0; i < WW; i++)
        X[i] = i % (W + 1) == 0;
    UNROLL for (int k = 0; k < W; k++) {
        int p = k;
        UNROLL for (int i = k + 1; i < W; i++)
            p = fabs(M[i * W + k]) > fabs(M[p * W + k]) ? i : p;
        UNROLL for (int j = 0; j < W && p != k; j++) {
            const double m = M[k * W + j], x = X[k * W + j];
            M[k * W + j] = M[p * W + j];
            M[p * W + j] = m;
            X[k * W + j] = X[p * W + j];
            X[p * W + j] = x;
        }
        const double pivot = M[k * W + k];
        det *= p == k ? pivot : -pivot;
        UNROLL for (int j = 0; j < W; j++) {
            M[k * W + j] /= pivot;
            X[k * W + j] /= pivot;
        }
        UNROLL for (int i = 0; i < W; i++) {
            const double factor = M[i * W + k];
            UNROLL for (int j = 0; j < W && i != k; j++) {
                M[i * W + j] -= factor * M[k * W + j];
                X[i * W + j] -= factor * X[k * W + j];
            }
        }
    }
    return det;
}

/* Z -= Z_i Z_i^T/Z_ii and with it E -= E_i Z_i^T/Z_ii, E W += E_i E_i^T/Z_ii, E_i being E e_i */
static void hold(int i, double *E, double *EW, double *Z)
{
    double e[W], z[W];
    const double most = Z[i * W + i];
    if (most == 0) /* held already, as by the end on the left */
        return;
    UNROLL for (int j = 0; j < W; j++) {
        e[j] = E[j * W + i];
        z[j] = Z[j * W + i];
    }
    UNROLL for (int a = 0; a < W; a++)
        UNROLL for (int b = 0; b < W; b++) {
            E[a * W + b] -= e[a] * (z[b] / most);
            EW[a * W + b] += e[a] * e[b] / most;
            Z[a * W + b] = a == i || b == i ? 0 : Z[a * W + b] - z[a] * z[b] / most;
        }
}

/* E, E W, H and J of a node and U of the next */
static enum rd_status map_node(const double *joint, const uint8_t *held, double *U, double *map,
                               bool *turned)
{
    const double *A = joint + RD_JOINT_A * WW, *B = joint + RD_JOINT_B * WW;
    const double *T = joint + RD_JOINT_W * WW;
    double *E = map + RD_MAP_E * WW, *EW = map + RD_MAP_EW * WW, *J = map + RD_MAP_J * WW;
    double M[WW], Z[WW];
    UNROLL for (int i = 0; i < WW; i++)
        map[RD_MAP_U * WW + i] = U[i];
    multiply(T, U, M);
    UNROLL for (int i = 0; i < W; i++)
        M[i * (W + 1)] += 1;
    const double det = invert(M, E);
    if (det == 0 || !isfinite(det))
        return RD_SINGULAR;
    *turned |= det < 0;
    multiply(E, T, EW);
    multiply(U, E, Z);
    symmetrise(EW);
    symmetrise(Z);
    UNROLL for (int i = 0; i < W; i++)
        if (held[i])
            hold(i, E, EW, Z);
    multiply_transposed(B, E, map + RD_MAP_H * WW);
    multiply(B, Z, J);
    multiply_transposed(J, B, U);
    UNROLL for (int i = 0; i < WW; i++)
        U[i] += A[i];
    symmetrise(U);
    return RD_OK;
}

/* negative eigenvalues of a symmetric matrix, by its largest pivots on the diagonal */
static int negative(const double *S)
{
    double M[WW];
    int left[W], count = 0;
    for (int i = 0; i < WW; i++)
        M[i] = S[i];
    for (int i = 0; i < W; i++)
        left[i] = i;
    for (int n = W; n > 0; n--) {
        int p = 0;
        for (int i = 1; i < n; i++)
            p = fabs(M[left[i] * (W + 1)]) > fabs(M[left[p] * (W + 1)]) ? i : p;
        const int k = left[p];
        const double pivot = M[k * (W + 1)];
        left[p] = left[n - 1];
        count += pivot < 0;
        for (int i = 0; i < n - 1 && pivot != 0; i++)
            for (int j = 0; j < n - 1; j++)
                M[left[i] * W + left[j]] -= M[left[i] * W + k] * M[k * W + left[j]] / pivot;
    }
    return count;
}

/* Negative eigenvalues of the stage's matrix. The left part up to a node, ended by a unit
   stiffness, has U at the node, and Z = U E with the node and what ends it now: neg(Z) - neg(U)
   more of them; of a next node that a string turns there is one before all others. */
static long growing(const struct rd_march *march)
{
    const struct rd_chain *chain = march->chain;
    long count = 0;
    for (size_t k = 0; k < chain->stretches; k++) {
        const bool turned = rd_joint_number(march, k)[RD_JOINT_TURNED] != 0;
        const uint8_t *held = chain->held + chain->term[k] * W;
        const size_t from = (size_t)chain->first[k], nodes = rd_stretch_nodes(chain, k);
        for (size_t i = from; i < from + nodes; i++) {
            const double *map = march->map + i * RD_MAP_BLOCKS * WW;
            double Z[WW];
            multiply(map + RD_MAP_U * WW, map + RD_MAP_E * WW, Z);
            symmetrise(Z);
            UNROLL for (int j = 0; j < WW; j++)
                Z[j] = held[j / W] || held[j % W] ? 0 : Z[j];
            count += negative(Z) - negative(map + RD_MAP_U * WW) + turned;
        }
    }
    return count;
}

static enum rd_status factor(struct rd_march *march)
{
    const struct rd_chain *chain = march->chain;
    bool turned = false;
    double U[WW] = {0};
    UNROLL for (int i = 0; i < W; i++)
        U[i * (W + 1)] = !chain->held[chain->term[0] * W + i];
    for (size_t k = 0; k < chain->stretches; k++) {
        const double *joint = rd_joint_of(march, k);
        const uint8_t *held = chain->held + chain->term[k] * W;
        const size_t from = (size_t)chain->first[k], nodes = rd_stretch_nodes(chain, k);
        turned |= rd_joint_number(march, k)[RD_JOINT_TURNED] != 0;
        for (size_t i = from; i < from + nodes; i++) {
            double *map = march->map + i * RD_MAP_BLOCKS * WW;
            const enum rd_status status = map_node(joint, held, U, map, &turned);
            if (status != RD_OK)
                return status;
        }
    }
    return turned && growing(march) != 0 ? RD_FAST_GROWTH : RD_OK;
}

/* p = load + M v/theta - K u - what the elements and strings put on the nodes, at star */
static void rest(struct rd_march *march)
{
    const struct rd_chain *chain = march->chain;
    const int iz = (int)(march->iz % W);
    double before[W] = {0}, pulled = 0;
    for (size_t k = 0; k < chain->stretches; k++) {
        const double *joint = rd_joint_of(march, k), *number = rd_joint_number(march, k);
        const double tension = number[RD_JOINT_STRING] + march->number->extra;
        const double string = number[RD_JOINT_REACH] * tension;
        const size_t from = (size_t)chain->first[k], nodes = rd_stretch_nodes(chain, k);
        for (size_t n = from; n < from + nodes; n++) {
            const double *u = march->star.u + n * W, *f = march->star.f + n * W;
            const double *load = march->load + n * W;
            double *p = march->p + n * W, inert[W], lost[W], carried[W];
            times(joint + RD_JOINT_MASS * WW, march->star.v + n * W, inert);
            times(joint + RD_JOINT_REST * WW, u, lost);
            if (n + 1 == chain->nodes) {
                UNROLL for (int i = 0; i < W; i++)
                    p[i] = load[i] + inert[i] - lost[i] - before[i];
                p[iz] -= pulled;
                return;
            }
            times_transposed(joint + RD_JOINT_D * WW, f, carried);
            const double pull = string * (u[W + iz] - u[iz]);
            UNROLL for (int i = 0; i < W; i++) {
                p[i] = load[i] + inert[i] - lost[i] + ((f[i] - before[i]) + carried[i]);
                before[i] = f[i];
            }
            p[iz] += pull - pulled;
            pulled = pull;
        }
    }
}

static void forward(struct rd_march *march, const double *p, bool moved)
{
    const size_t nodes = march->chain->nodes;
    double c[W] = {0};
    for (size_t n = 0; n < nodes; n++) {
        const double *map = march->map + n * RD_MAP_BLOCKS * WW;
        double *x = march->s + n * W, *kept = march->c + n * W;
        double own[W], back[W], on[W], pushed[W];
        UNROLL for (int i = 0; moved && i < W; i++)
            c[i] += (march->kick + n * W)[i];
        UNROLL for (int i = 0; i < W; i++)
            kept[i] = c[i];
        times(map + RD_MAP_E * WW, p + n * W, own);
        times(map + RD_MAP_EW * WW, c, back);
        times(map + RD_MAP_H * WW, c, on);
        times(map + RD_MAP_J * WW, p + n * W, pushed);
        UNROLL for (int i = 0; i < W; i++) {
            x[i] = own[i] - back[i];
            c[i] = on[i] + pushed[i];
        }
    }
}

/* u (nodes, width) and the change of the carried forces f under the loads p, held coordinates at
   their shifts where they are moved */
static void solve(struct rd_march *march, const double *p, bool moved, double *u, double *f)
{
    const struct rd_chain *chain = march->chain;
    const int iz = (int)(march->iz % W);
    double right[W] = {0};
    forward(march, p, moved);
    for (size_t k = chain->stretches; k-- > 0;) {
        const double *number = rd_joint_number(march, k);
        const double string = number[RD_JOINT_STIFF], share = 1 / (1 + number[RD_JOINT_RATE]);
        const uint8_t *held = chain->held + chain->term[k] * W;
        const size_t from = (size_t)chain->first[k];
        for (size_t n = from + rd_stretch_nodes(chain, k); n-- > from;) {
            const double *map = march->map + n * RD_MAP_BLOCKS * WW;
            const double *c = march->c + n * W, *rest_of = march->s + n * W;
            double *x = u + n * W, *pull = f + n * W, s[W];
            times_transposed(map + RD_MAP_H * WW, right, s);
            UNROLL for (int i = 0; i < W; i++)
                s[i] += rest_of[i];
            times(map + RD_MAP_U * WW, s, x);
            UNROLL for (int i = 0; i < W; i++)
                x[i] = held[i] ? 0 : x[i] + c[i];
            UNROLL for (int i = 0; moved && i < W; i++)
            {
                x[i] += (march->shift + n * W)[i];
                s[i] += (march->shift + n * W)[i];
            }
            if (n + 1 < chain->nodes) {
                UNROLL for (int i = 0; i < W; i++)
                    pull[i] = right[i] - x[W + i];
                pull[iz] -= string * (x[W + iz] - x[iz]);
                UNROLL for (int i = 0; i < W; i++)
                    pull[i] *= share;
            }
            UNROLL for (int i = 0; i < W; i++)
                right[i] = s[i];
        }
    }
}

/* What lean leaves of a stage: p of each node's equilibrium, t = F u_a + G f - u_b of each
   element's compatibility, as loads and kick of a further solve. With t' = t + k t_z e_z beside a
   string k: p -= B^T t' - k t_z e_z on the left, c += t - A t' on the right. */
static void residual(struct rd_march *march)
{
    const struct rd_chain *chain = march->chain;
    const int iz = (int)(march->iz % W);
    const double damped = 1 + march->beside->spring_rate / march->number->theta;
    double before[W] = {0}, pulled = 0, kick[W] = {0};
    for (size_t k = 0; k < chain->stretches; k++) {
        const double *joint = rd_joint_of(march, k), *number = rd_joint_number(march, k);
        const double *A = joint + RD_JOINT_A * WW, *B = joint + RD_JOINT_B * WW;
        const double tension = number[RD_JOINT_STRING] + march->number->extra;
        const double string = number[RD_JOINT_REACH] * tension, stiff = number[RD_JOINT_STIFF];
        const double r = 1 + number[RD_JOINT_RATE];
        const uint8_t *held = chain->held + chain->term[k] * W;
        const size_t from = (size_t)chain->first[k], nodes = rd_stretch_nodes(chain, k);
        for (size_t n = from; n < from + nodes; n++) {
            const double *u = march->star.u + n * W, *f = march->star.f + n * W;
            const double *d = march->lean.u + n * W, *g = march->lean.f + n * W;
            const double *v = march->star.v + n * W, *load = march->load + n * W;
            double *p = march->p + n * W, *c = march->kick + n * W;
            double faster[W], sprung[W], inert[W], drag[W], spring[W];
            UNROLL for (int i = 0; i < W; i++) {
                c[i] = kick[i];
                faster[i] = d[i] - v[i];
                sprung[i] = u[i] + damped * d[i];
            }
            times(joint + RD_JOINT_MASS * WW, faster, inert);
            times(joint + RD_JOINT_DRAG * WW, d, drag);
            times(joint + RD_JOINT_SPRING * WW, sprung, spring);
            UNROLL for (int i = 0; i < W; i++)
                p[i] = held[i] ? 0 : load[i] - inert[i] - drag[i] - spring[i];
            if (n + 1 == chain->nodes) {
                UNROLL for (int i = 0; i < W; i++)
                    p[i] -= held[i] ? 0 : before[i] + (i == iz ? pulled : 0);
                return;
            }
            double force[W], carried[W], bent[W], lost[W], t[W], turned[W], soft[W];
            UNROLL for (int i = 0; i < W; i++) {
                force[i] = f[i] + r * g[i];
                bent[i] = u[i] + r * d[i];
            }
            times_transposed(joint + RD_JOINT_D * WW, force, carried);
            times(joint + RD_JOINT_Q * WW, bent, lost);
            times(joint + RD_JOINT_D * WW, d, turned);
            times(joint + RD_JOINT_G * WW, g, soft);
            const double pull =
                string * (u[W + iz] - u[iz]) + stiff * (d[W + iz] - d[iz]);
            UNROLL for (int i = 0; i < W; i++) {
                p[i] += held[i] ? 0
                                : (force[i] - before[i]) + carried[i] - lost[i] +
                                      (i == iz ? pull - pulled : 0);
                before[i] = force[i];
                t[i] = number[RD_JOINT_OPEN] != 0 ? 0 : turned[i] + soft[i] - (d[W + i] - d[i]);
            }
            pulled = pull;
            const double beside = stiff * t[iz];
            UNROLL for (int i = 0; i < W; i++)
                kick[i] = t[i];
            t[iz] += beside;
            times_transposed(B, t, turned);
            times(A, t, soft);
            UNROLL for (int i = 0; i < W; i++) {
                kick[i] -= soft[i];
                p[i] -= held[i] ? 0 : turned[i] - (i == iz ? beside : 0);
            }
        }
    }
}

/* twice the kinetic and the strain energy at the start of a step */
static void energy(const struct rd_march *march, double *sum)
{
    const struct rd_chain *chain = march->chain;
    const int iz = (int)(march->iz % W);
    double kinetic = 0, strain = 0;
    for (size_t k = 0; k < chain->stretches; k++) {
        const double *joint = rd_joint_of(march, k), *number = rd_joint_number(march, k);
        const double tension = number[RD_JOINT_STRING] + march->number->base;
        const double string = number[RD_JOINT_REACH] * tension;
        const size_t from = (size_t)chain->first[k], nodes = rd_stretch_nodes(chain, k);
        for (size_t n = from; n < from + nodes; n++) {
            const double *u = march->start.u + n * W;
            kinetic += form(joint + RD_JOINT_MASS * WW, march->start.v + n * W);
            strain += form(joint + RD_JOINT_SPRING * WW, u);
            if (n + 1 == chain->nodes)
                break;
            const double open = u[W + iz] - u[iz];
            strain += form(joint + RD_JOINT_G * WW, march->start.f + n * W) +
                      form(joint + RD_JOINT_Q * WW, u) + string * open * open;
        }
    }
    sum[RD_KINETIC] = kinetic;
    sum[RD_STRAIN] = strain;
}

/* theta times the power that the chain's dampers take at the stage, in lean */
static double dissipate(const struct rd_march *march)
{
    const struct rd_chain *chain = march->chain;
    const int iz = (int)(march->iz % W);
    const double sprung = march->beside->spring_rate / march->number->theta;
    double sum = 0;
    for (size_t k = 0; k < chain->stretches; k++) {
        const double *joint = rd_joint_of(march, k), *number = rd_joint_number(march, k);
        const double string = number[RD_JOINT_REACH] * number[RD_JOINT_DAMPED];
        const double rate = number[RD_JOINT_RATE];
        const size_t from = (size_t)chain->first[k], nodes = rd_stretch_nodes(chain, k);
        for (size_t n = from; n < from + nodes; n++) {
            const double *u = march->lean.u + n * W;
            sum += form(joint + RD_JOINT_DRAG * WW, u);
            if (sprung != 0)
                sum += sprung * form(joint + RD_JOINT_SPRING * WW, u);
            if (n + 1 == chain->nodes)
                break;
            const double open = u[W + iz] - u[iz];
            sum += string * open * open;
            if (rate != 0)
                sum += rate * (form(joint + RD_JOINT_G * WW, march->lean.f + n * W) +
                               form(joint + RD_JOINT_Q * WW, u));
        }
    }
    return sum;
}

const struct rd_march_kernel NAME(rd_march_kernel, RD_WIDTH) = {
    .factor = factor,
    .rest = rest,
    .solve = solve,
    .residual = residual,
    .energy = energy,
    .dissipate = dissipate,
};
