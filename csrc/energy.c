/* Strain and kinetic energy of shapes, by what stores it. */
#include "energy.h"

#include "element.h"
#include "triple.h"

#include <string.h>

enum { W = RD_WIDTH_MAX, N = 2 * RD_WIDTH_MAX };

/* size of an imaginary step: its square is nothing beside 1, so derivatives are exact */
static const double STEP = 0x1p-100;

/* An element ready for its energies. */
struct store {
    struct rd_element element;
    double K[N * N];                              /* assembled, sections and tension */
    double jump[W * N];                           /* of its hinge */
    double _Complex F[W * W], G[W * W], Q[W * W]; /* at T (1 + i STEP) */
};

static enum rd_status prepare(const struct rd_chain *chain, size_t stretch, struct store *store)
{
    double string[N * N];
    store->element = rd_chain_span(chain, stretch);
    const size_t n = 2 * chain->width;
    enum rd_status status = rd_element_stiffness(&store->element, store->K, string);
    for (size_t i = 0; i < n * n; i++)
        store->K[i] += string[i];
    if (status == RD_OK)
        status = rd_element_jump(&store->element, store->jump);
    if (status != RD_OK)
        return status;
    return rd_triple(&store->element, 1, CMPLX(1, STEP), store->F, store->G, store->Q);
}

/* f_b, the force on the right end, of the nodes' motion u (2, width) */
static void end_force(const struct store *store, const double *u, double *force)
{
    const size_t w = store->element.width;
    for (size_t i = 0; i < w; i++) {
        force[i] = 0;
        for (size_t j = 0; j < 2 * w; j++)
            force[i] += store->K[(w + i) * 2 * w + j] * u[j];
    }
}

/* The mixed form P = f^T F u_a + (f^T G f - u_a^T Q u_a)/2 has u_b = dP/df, f_a = dP/du_a and is
   f u_b less the energy, so that twice the energy of the tension is -2 T dP/dT and twice the whole
   f^T G f + u_a^T Q u_a. */
static void weigh(const struct store *store, const double *u, const double *f, double *whole,
                  double *tension)
{
    const size_t w = store->element.width;
    double _Complex cross = 0, stored = 0, released = 0;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++) {
            cross += f[i] * store->F[i * w + j] * u[j];
            stored += f[i] * store->G[i * w + j] * f[j];
            released += u[i] * store->Q[i * w + j] * u[j];
        }
    *whole = creal(stored) + creal(released);
    *tension = -cimag(2 * cross + stored - released) / STEP;
}

/* beta_b - beta_a without the difference of two large numbers */
static double bent(const struct store *store, const double *u, const double *f)
{
    const size_t w = store->element.width;
    const size_t beta = w - 1;
    double sum = (creal(store->F[beta * w + beta]) - 1) * u[beta];
    for (size_t j = 0; j < w; j++)
        sum += creal(store->G[beta * w + j]) * f[j];
    return sum;
}

/* Torque t and axial force a are constant along the element; of the bending moment m the integral
   follows from the rotation between the ends: beta_b - beta_a = S_bb int m + l (S_tb t + S_ab a). */
static void add_element(const struct store *store, const double *u, const double *force,
                        double *strain)
{
    const struct rd_element *element = &store->element;
    const size_t w = element->width;
    const double l = element->length;
    const double *S = element->flexibility;
    const double Sbb = S[RD_BENDING * RD_CHANNELS + RD_BENDING];
    const double Stb = S[RD_TORSION * RD_CHANNELS + RD_BENDING];
    const double Sab = S[RD_AXIAL * RD_CHANNELS + RD_BENDING];
    double f[W] = {0}, whole, tension;
    for (size_t i = 0; i < w; i++)
        f[element->coordinate[i]] = force[i];
    weigh(store, u, force, &whole, &tension);
    const double a = f[RD_X];
    const double t = f[RD_ALPHA];
    const double stretch = S[RD_AXIAL * RD_CHANNELS + RD_AXIAL] * l * a * a;
    const double twist = S[RD_TORSION * RD_CHANNELS + RD_TORSION] * l * t * t;
    double lay = 2 * S[RD_AXIAL * RD_CHANNELS + RD_TORSION] * l * a * t;
    if (Stb != 0 || Sab != 0) {
        const double moment = (bent(store, u, force) - l * (Stb * t + Sab * a)) / Sbb;
        lay += 2 * (Stb * t + Sab * a) * moment;
    }
    strain[RD_STRAIN_TENSION] += tension;
    strain[RD_STRAIN_STRETCH] += stretch;
    strain[RD_STRAIN_TWIST] += twist;
    strain[RD_STRAIN_LAY] += lay;
    if (element->coordinate[w - 1] == RD_BETA)
        strain[RD_STRAIN_BENDING] += whole - tension - stretch - twist - lay;
}

static double quadratic(size_t n, const double *A, const double *u)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            sum += u[i] * A[i * n + j] * u[j];
    return sum;
}

/* moves u (2, width) from the left node to the left end of the element, across the hinge, and
   returns twice the energy of its spring */
static double open_hinge(const struct store *store, double *u)
{
    const size_t w = store->element.width;
    double jump[W], energy = 0;
    for (size_t i = 0; i < w; i++) {
        jump[i] = 0;
        for (size_t j = 0; j < 2 * w; j++)
            jump[i] += store->jump[i * 2 * w + j] * u[j];
    }
    for (size_t i = 0; i < w; i++) {
        u[i] += jump[i];
        if (store->element.hinge[i] > 0)
            energy += jump[i] * (jump[i] / store->element.hinge[i]);
    }
    return energy;
}

/* adds the energies of the elements of a stretch */
static void add_stretch(const struct rd_chain *chain, size_t k, const struct store *store,
                        const double *shape, double *strain)
{
    const size_t w = chain->width;
    for (size_t i = (size_t)chain->first[k]; i < (size_t)chain->first[k + 1]; i++) {
        double u[2 * W], f[W];
        memcpy(u, shape + i * w, 2 * w * sizeof *u);
        end_force(store, u, f);
        if (store->element.hinge)
            strain[RD_STRAIN_SPRING] += open_hinge(store, u);
        add_element(store, u, f, strain);
    }
}

/* sum of what the nodes' own matrices, one for each term, give */
static double at_nodes(const struct rd_chain *chain, const double *matrix, const double *shape)
{
    const size_t w = chain->width;
    double sum = 0;
    for (size_t i = 0; i < chain->nodes; i++)
        sum += quadratic(w, matrix + (size_t)chain->term_of[i] * w * w, shape + i * w);
    return sum;
}

double rd_energy_springs(const struct rd_chain *chain, const double *shape)
{
    return at_nodes(chain, chain->stiffness, shape);
}

double rd_energy_dashpots(const struct rd_chain *chain, const double *shape)
{
    return chain->damping ? at_nodes(chain, chain->damping, shape) : 0;
}

enum rd_status rd_energy_strain(const struct rd_chain *chain, const double *shape, double *strain)
{
    struct store store;
    memset(strain, 0, RD_STRAINS * sizeof *strain);
    for (size_t k = 0; k + 1 < chain->stretches; k++) {
        const enum rd_status status = prepare(chain, k, &store);
        if (status != RD_OK)
            return status;
        add_stretch(chain, k, &store, shape, strain);
    }
    strain[RD_STRAIN_SPRING] += rd_energy_springs(chain, shape);
    return RD_OK;
}

void rd_energy_kinetic(const struct rd_chain *chain, const double *shape, double *kinetic)
{
    const size_t w = chain->width;
    memset(kinetic, 0, w * sizeof *kinetic);
    for (size_t i = 0; i < chain->nodes; i++) {
        const double *M = chain->mass + (size_t)chain->term_of[i] * w * w;
        const double *u = shape + i * w;
        for (size_t a = 0; a < w; a++)
            for (size_t b = 0; b < w; b++)
                kinetic[a < b ? a : b] += u[a] * M[a * w + b] * u[b];
    }
}
