/* A march laid out in the caller's memory: factors that stay and arrays that a stage fills. */
#include "march/plan.h"

#include "march/form/joint.h"
#include "march/form/scale.h"

#include <math.h>
#include <string.h>

const struct rd_march_kernel *rd_march_kernel_of(const struct rd_march *march)
{
    static const struct rd_march_kernel *const kernels[] = {&rd_march_kernel_1, &rd_march_kernel_2,
                                                            &rd_march_kernel_3, &rd_march_kernel_4};
    return kernels[march->chain->width - 1];
}

static double *take(struct rd_workspace *workspace, size_t rows, size_t columns)
{
    return rd_take(workspace, rows, columns * sizeof(double));
}

static struct rd_scaled take_scaled(const struct rd_chain *chain, struct rd_workspace *workspace)
{
    return (struct rd_scaled){
        .u = take(workspace, chain->nodes, chain->width),
        .v = take(workspace, chain->nodes, chain->width),
        .f = take(workspace, chain->nodes, chain->width),
        .y = take(workspace, chain->attached, 1),
        .w = take(workspace, chain->attached, 1),
    };
}

static enum rd_status find_carriers(struct rd_march *march)
{
    const struct rd_chain *chain = march->chain;
    for (size_t k = 0; k < chain->attached; k++) {
        march->carrier[k] = -1;
        if (chain->attached_kind[k] != RD_RESONATOR)
            return RD_SPREAD_INERTIA;
        for (size_t s = 0; s < chain->stretches; s++)
            if (chain->term[s] == chain->attached_term[k])
                march->carrier[k] = chain->first[s];
    }
    return RD_OK;
}

enum rd_status rd_march_prepare(const struct rd_chain *chain, const struct rd_beside *beside,
                                const struct rd_laws *laws, struct rd_march *march,
                                struct rd_workspace *workspace)
{
    const size_t n = chain->nodes, w = chain->width, m = laws->ports.count;
    *march = (struct rd_march){
        .chain = chain,
        .beside = beside,
        .laws = laws,
        .iz = rd_coordinate_find(w, chain->coordinate, RD_Z),
    };
    march->number = rd_take(workspace, 1, sizeof *march->number);
    march->joint = take(workspace, chain->stretches, rd_joint_size(march));
    march->map = take(workspace, n, RD_MAP_BLOCKS * w * w);
    march->carrier = rd_take(workspace, chain->attached, sizeof *march->carrier);
    struct rd_scaled *const motions[] = {&march->start, &march->first, &march->later,
                                         &march->second, &march->correction};
    for (size_t i = 0; i < sizeof motions / sizeof *motions; i++)
        *motions[i] = take_scaled(chain, workspace);
    double **const nodal[] = {&march->load,  &march->p, &march->kick,
                              &march->shift, &march->c, &march->s};
    for (size_t i = 0; i < sizeof nodal / sizeof *nodal; i++)
        *nodal[i] = take(workspace, n, w);
    march->column = take(workspace, m, 2 * n * w);
    march->compliance = take(workspace, m, m);
    march->alone = take(workspace, m, 1);
    march->force = take(workspace, m, 1);
    march->law_work = take(workspace, m, m + 4);
    return rd_workspace_fits(workspace) ? find_carriers(march) : RD_NO_MEMORY;
}

double rd_march_read(const struct rd_march *march, const struct rd_ports *ports, size_t k,
                     const double *u)
{
    const size_t w = march->chain->width;
    const double *row = ports->row + k * 2 * w, *at = u + (size_t)ports->node[k] * w;
    double sum = 0;
    for (size_t i = 0; i < 2 * w; i++)
        sum += row[i] * (at[i] * march->number->z[i % w]);
    return sum;
}

void rd_march_push(const struct rd_march *march, const struct rd_ports *ports, size_t k,
                   double force, double *load)
{
    const size_t w = march->chain->width;
    const double *row = ports->row + k * 2 * w;
    double *at = load + (size_t)ports->node[k] * w;
    for (size_t i = 0; i < 2 * w; i++)
        at[i] += row[i] * force * march->number->z[i % w];
}

/* motion of the chain under a unit force of each law, and what that moves at each */
static void fill_columns(struct rd_march *march)
{
    const size_t n = march->chain->nodes * march->chain->width, m = march->laws->ports.count;
    const struct rd_march_kernel *kernel = rd_march_kernel_of(march);
    for (size_t k = 0; k < m; k++) {
        double *u = march->column + k * 2 * n;
        memset(march->p, 0, n * sizeof *march->p);
        rd_march_push(march, &march->laws->ports, k, 1, march->p);
        kernel->solve(march, march->p, false, u, u + n);
        for (size_t j = 0; j < m; j++)
            march->compliance[j * m + k] = rd_march_read(march, &march->laws->ports, j, u);
    }
    for (size_t k = 0; k < m; k++)
        for (size_t j = 0; j < k; j++) {
            const double mean = (march->compliance[j * m + k] + march->compliance[k * m + j]) / 2;
            march->compliance[j * m + k] = march->compliance[k * m + j] = mean;
        }
}

enum rd_status rd_march_tighten(struct rd_march *march, double extra)
{
    enum rd_status status = RD_OK;
    march->number->extra = extra;
    for (size_t k = 0; status == RD_OK && k < march->chain->stretches; k++)
        status = rd_joint_tighten(march, k);
    if (status == RD_OK)
        status = rd_march_kernel_of(march)->factor(march);
    if (status == RD_OK)
        fill_columns(march);
    else
        march->number->extra = NAN; /* no tension has these factors */
    return status;
}

enum rd_status rd_march_factor(struct rd_march *march, double theta, double extra)
{
    *march->number = (struct rd_march_numbers){.theta = theta, .base = extra, .slope = -1};
    memset(march->load, 0, march->chain->nodes * march->chain->width * sizeof *march->load);
    rd_march_scale(march, march->number->z);
    for (size_t k = 0; k < march->chain->stretches; k++) {
        const enum rd_status status = rd_joint_fill(march, k);
        if (status != RD_OK)
            return status;
    }
    return rd_march_tighten(march, extra);
}

void rd_march_load(struct rd_march *march, const struct rd_motion *motion)
{
    const struct rd_chain *chain = march->chain;
    const size_t w = chain->width, n = chain->nodes * w;
    const double *z = march->number->z, theta = march->number->theta;
    for (size_t i = 0; i < n; i++) {
        march->start.u[i] = motion->u[i] / z[i % w];
        march->start.v[i] = motion->v[i] / z[i % w] * theta;
    }
    for (size_t i = 0; i < n - w; i++)
        march->start.f[i] = motion->f[i] * z[i % w];
    for (size_t k = 0; k < chain->attached; k++) {
        march->start.y[k] = motion->y[k];
        march->start.w[k] = motion->w[k] * theta;
    }
}

void rd_march_unload(const struct rd_march *march, const struct rd_motion *motion)
{
    const struct rd_chain *chain = march->chain;
    const size_t w = chain->width, n = chain->nodes * w;
    const double *z = march->number->z, theta = march->number->theta;
    for (size_t i = 0; i < n; i++) {
        motion->u[i] = march->start.u[i] * z[i % w];
        motion->v[i] = march->start.v[i] * z[i % w] / theta;
    }
    for (size_t i = 0; i < n - w; i++)
        motion->f[i] = march->start.f[i] / z[i % w];
    for (size_t k = 0; k < chain->attached; k++) {
        motion->y[k] = march->start.y[k];
        motion->w[k] = march->start.w[k] / theta;
    }
}
