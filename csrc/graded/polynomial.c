/* Polynomials through Chebyshev's nodes of the first kind. */
#include "graded/polynomial.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

void rd_nodes(int n, double *node)
{
    for (int j = 0; j < n; j++)
        node[j] = cos((2 * j + 1) * PI / (2 * n));
}

void rd_nodes_weigh(int n, const double *node, double x, double *weight)
{
    double sum = 0;
    for (int j = 0; j < n; j++) {
        const double apart = x - node[j];
        if (apart == 0) {
            for (int k = 0; k < n; k++)
                weight[k] = k == j;
            return;
        }
        const double size = sqrt(1 - node[j] * node[j]);
        sum += weight[j] = (j % 2 ? -size : size) / apart;
    }
    for (int j = 0; j < n; j++)
        weight[j] /= sum;
}
