/* Strain and kinetic energy of shapes, by what stores it. */
#include "energy.h"

#include "element.h"

#include <string.h>

enum { W = RD_WIDTH_MAX };

/* End force of the untensed element, spread over the four coordinates. */
static void end_force(const struct rd_element *element, const double *compliance,
                      const double *transfer, const double *u, double *force)
{
    const size_t w = element->width;
    double slip[W];
    for (size_t i = 0; i < w; i++) {
        slip[i] = u[w + i];
        for (size_t j = 0; j < w; j++)
            slip[i] -= transfer[i * w + j] * u[j];
    }
    memset(force, 0, W * sizeof *force);
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++)
            force[element->coordinate[i]] += compliance[i * w + j] * slip[j];
}

/* integrals over the element of products of torque t = M_alpha, moment m(s) = s F_z + M_beta and
   axial force a = F_x, each weighed with its entry of S */
static void add_elastic(const struct rd_element *element, const double *force, double *strain)
{
    const double l = element->length;
    const double *S = element->flexibility;
    const double a = force[RD_X];
    const double t = force[RD_ALPHA];
    const double mean = l * (l / 2 * force[RD_Z] + force[RD_BETA]);
    const double spread = l * l * l / 12 * force[RD_Z] * force[RD_Z];
    strain[RD_STRAIN_STRETCH] += S[RD_AXIAL * 3 + RD_AXIAL] * l * a * a;
    strain[RD_STRAIN_TWIST] += S[RD_TORSION * 3 + RD_TORSION] * l * t * t;
    strain[RD_STRAIN_BENDING] += S[RD_BENDING * 3 + RD_BENDING] * (mean * mean / l + spread);
    strain[RD_STRAIN_LAY] +=
        2 * (S[RD_AXIAL * 3 + RD_TORSION] * l * a * t + S[RD_AXIAL * 3 + RD_BENDING] * a * mean +
             S[RD_TORSION * 3 + RD_BENDING] * t * mean);
}

/* T/l (z_b - z_a)^2 */
static void add_tension(const struct rd_element *element, const double *u, double *strain)
{
    for (size_t i = 0; i < element->width; i++)
        if (element->coordinate[i] == RD_Z) {
            const double rise = u[element->width + i] - u[i];
            strain[RD_STRAIN_TENSION] += element->tension / element->length * rise * rise;
        }
}

static double quadratic(size_t n, const double *A, const double *u)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            sum += u[i] * A[i * n + j] * u[j];
    return sum;
}

enum rd_status rd_energy_strain(const struct rd_chain *chain, const double *shape, double *strain)
{
    const size_t w = chain->width;
    double transfer[W * W], compliance[W * W];
    struct rd_element element = {0};
    int32_t last = -1;
    memset(strain, 0, RD_STRAINS * sizeof *strain);
    for (size_t i = 0; i + 1 < chain->nodes; i++) {
        if (chain->element_of[i] != last) {
            last = chain->element_of[i];
            element = rd_chain_element(chain, (size_t)last);
            if (!rd_element_grip(&element, transfer, compliance))
                return RD_NOT_POSITIVE_DEFINITE;
        }
        double force[W];
        end_force(&element, compliance, transfer, shape + i * w, force);
        add_elastic(&element, force, strain);
        add_tension(&element, shape + i * w, strain);
    }
    for (size_t i = 0; i < chain->nodes; i++) {
        const double *N = chain->stiffness + (size_t)chain->term_of[i] * w * w;
        strain[RD_STRAIN_SPRING] += quadratic(w, N, shape + i * w);
    }
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
                kinetic[a] += u[a] * M[a * w + b] * u[b];
    }
}
