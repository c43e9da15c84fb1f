/* How the form of two motions changes where a node between continuous elements moves. */
#include "energy/place.h"

#pragma GCC diagnostic ignored "-Wpsabi"

enum { N = 2 * RD_WIDTH_MAX };

/* x a + y b */
static cv mixed(double x, cv a, double y, cv b)
{
    return c_add(c_scale(a, x), c_scale(b, y));
}

/* x left + y right, (x + y) times the lever, which all have */
static void combine(const struct rate_matrix *left, const struct rate_matrix *right, size_t w,
                    double x, double y, struct rate_matrix *both)
{
    *both = (struct rate_matrix){
        .z = left->z,
        .lever = left->lever * x + right->lever * y,
        .sag = mixed(x, left->sag, y, right->sag),
        .hangs = left->hangs,
    };
    for (size_t i = 0; i < w; i++) {
        both->q[i] = mixed(x, left->q[i], y, right->q[i]);
        for (size_t j = 0; j < w; j++) {
            both->S[i][j] = mixed(x, left->S[i][j], y, right->S[i][j]);
            both->elastic[i][j] = left->elastic[i][j] || right->elastic[i][j];
        }
    }
}

/* the size of what a difference of two numbers is rounded to, 0 where they are the same */
static cv rounded(cv of, cv difference)
{
    const lanes none = {0};
    return (cv){l_select(c_size(difference) > none, c_size(of), none), none};
}

static void round_to(const struct rate_matrix *mean, size_t w, struct rate_matrix *difference)
{
    difference->sag = rounded(mean->sag, difference->sag);
    for (size_t i = 0; i < w; i++) {
        difference->q[i] = rounded(mean->q[i], difference->q[i]);
        for (size_t j = 0; j < w; j++)
            difference->S[i][j] = rounded(mean->S[i][j], difference->S[i][j]);
    }
}

static void sizes(const cv *y, size_t n, lanes *size)
{
    for (size_t i = 0; i < n; i++)
        size[i] = c_size(y[i]);
}

/* of a product that is rounded as both its factors are */
static lanes product(const struct rate_matrix *rate, size_t w, const cv *a, const lanes *of_a,
                     const cv *b, const lanes *of_b)
{
    lanes size_a[N], size_b[N];
    sizes(a, 2 * w, size_a);
    sizes(b, 2 * w, size_b);
    return rd_rate_size(rate, w, size_a, of_b) + rd_rate_size(rate, w, of_a, size_b);
}

struct rd_place rd_place_between(const struct rate_matrix *left, const struct rate_matrix *right,
                                 size_t w, const struct rd_kink *a, const struct rd_kink *b)
{
    struct rate_matrix mean, change;
    struct rd_place place;
    combine(left, right, w, 0.5, 0.5, &mean);
    combine(left, right, w, -1, 1, &change);
    place.slope = c_add(rd_rate_form(&change, w, a->mean, b->mean),
                        c_scale(rd_rate_form(&change, w, a->jump, b->jump), 0.25));
    place.slope = c_add(place.slope, rd_rate_form(&mean, w, a->mean, b->jump));
    place.slope = c_add(place.slope, rd_rate_form(&mean, w, a->jump, b->mean));
    place.size = product(&mean, w, a->mean, a->of_mean, b->jump, b->of_jump) +
                 product(&mean, w, a->jump, a->of_jump, b->mean, b->of_mean) +
                 product(&change, w, a->mean, a->of_mean, b->mean, b->of_mean) +
                 product(&change, w, a->jump, a->of_jump, b->jump, b->of_jump);
    round_to(&mean, w, &change);
    lanes size_a[N], size_b[N];
    sizes(a->mean, 2 * w, size_a);
    sizes(b->mean, 2 * w, size_b);
    place.size += rd_rate_size(&change, w, size_a, size_b);
    return place;
}

lanes rd_place_size(const struct rate_matrix *left, size_t w, const struct rd_kink *a,
                    const struct rd_kink *b)
{
    return product(left, w, a->mean, a->of_mean, b->mean, b->of_mean);
}
