/* Resonators at the nodes of a march. */
#include "march/form/resonator.h"

/* A mass m on a spring k and a dashpot c to its foot q = row u, all at the stage with
   kappa = k + c/theta, m' = m/theta^2 + alpha m/theta and rho = m/theta^2 w - k (y - q):

       (m' + kappa) dy - kappa dq = rho
       force on the foot -kappa (dq - dy) - k (q - y)
                       = -kappa m'/(m' + kappa) dq + kappa/(m' + kappa) rho + k (y - q) */
struct rd_resonator rd_resonator_of(const struct rd_march *march, size_t k)
{
    const struct rd_chain *chain = march->chain;
    const double *value = chain->attached_value + k * RD_ATTACHED_VALUES;
    const double theta = march->number->theta;
    struct rd_resonator one = {
        .m = value[0] / theta / theta,
        .k = value[1],
        .c = value[3] / theta,
        .drag = march->beside->mass_rate * value[0] / theta,
    };
    for (size_t i = 0; i < chain->width; i++)
        one.row[i] = chain->attached_row[k * 2 * chain->width + i] * march->number->z[i];
    return one;
}

double rd_resonator_foot(const struct rd_march *march, const struct rd_resonator *one, size_t k,
                         const double *u)
{
    double sum = 0;
    for (size_t i = 0; i < march->chain->width; i++)
        sum += one->row[i] * u[(size_t)march->carrier[k] * march->chain->width + i];
    return sum;
}

void rd_resonator_add(const struct rd_march *march, size_t k, double *N)
{
    const size_t w = march->chain->width;
    const struct rd_resonator one = rd_resonator_of(march, k);
    const double kappa = one.k + one.c, m = one.m + one.drag, joined = m * (kappa / (m + kappa));
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++)
            N[i * w + j] += joined * (one.row[i] * one.row[j]);
}

/* rho */
static double own_rest(const struct rd_march *march, const struct rd_resonator *one, size_t k)
{
    const double longer = march->star.y[k] - rd_resonator_foot(march, one, k, march->star.u);
    return one->m * march->star.w[k] - one->k * longer;
}

void rd_resonator_load(struct rd_march *march, size_t k)
{
    const size_t w = march->chain->width;
    const struct rd_resonator one = rd_resonator_of(march, k);
    const double kappa = one.k + one.c;
    const double longer = march->star.y[k] - rd_resonator_foot(march, &one, k, march->star.u);
    const double force =
        kappa / (one.m + one.drag + kappa) * own_rest(march, &one, k) + one.k * longer;
    for (size_t i = 0; i < w; i++)
        march->p[(size_t)march->carrier[k] * w + i] += force * one.row[i];
}

void rd_resonator_follow(struct rd_march *march, size_t k)
{
    const struct rd_resonator one = rd_resonator_of(march, k);
    const double kappa = one.k + one.c, foot = rd_resonator_foot(march, &one, k, march->lean.u);
    march->lean.y[k] = (own_rest(march, &one, k) + kappa * foot) / (one.m + one.drag + kappa);
}

/* k (y - q) + (k + c/theta) (dy - dq) */
double rd_resonator_force(const struct rd_march *march, const struct rd_resonator *one, size_t k)
{
    const double longer = march->star.y[k] - rd_resonator_foot(march, one, k, march->star.u);
    const double more = march->lean.y[k] - rd_resonator_foot(march, one, k, march->lean.u);
    return one->k * longer + (one->k + one->c) * more;
}

void rd_resonator_pull(struct rd_march *march, size_t k)
{
    const size_t w = march->chain->width;
    const struct rd_resonator one = rd_resonator_of(march, k);
    const double force = rd_resonator_force(march, &one, k);
    for (size_t i = 0; i < w; i++)
        march->p[(size_t)march->carrier[k] * w + i] += force * one.row[i];
}
