/* How a continuous span is divided: its wavenumber, its halvings and the terms of its series. */
#include "span/span.h"

#include "check.h"

static const int32_t names[] = {RD_X, RD_Z, RD_ALPHA, RD_BETA};

static const double PI = 3.14159265358979323846;

/* one coordinate of a rod or a string: k = sqrt(load/stiffness) */
static void span_of_one_coordinate_has_its_closed_wavenumber(void)
{
    const double flexibility[9] = {[0] = 1 / 4.0, [4] = 1 / 25.0};
    struct rd_span span = {.width = 1, .flexibility = flexibility, .section = 1, .tension = 16};
    static const double stiffness[] = {4, 16, 25};
    for (int i = 0; i < 3; i++) {
        span.coordinate = names + i;
        span.load[0] = 400;
        CHECK_REL(rd_span_wavenumber(&span), sqrt(400 / stiffness[i]), 4 * EPS,
                  "a division, a product and a root");
        span.load[0] = 0;
        CHECK_EXACT(rd_span_wavenumber(&span), 0);
    }
}

/* z'''' = 2 h z'' + load S z: exp(a x) with a^2 = h + sqrt(h^2 + load S), h = T S/2; the propagating
   wave is never shorter, k^2 = a^2 - 2 h */
static void tensed_beam_has_its_evanescent_wavenumber(void)
{
    static const double tension[] = {0, 3, 700, 1e9};
    const double S = 0.02, flexibility[9] = {[8] = S};
    for (int i = 0; i < 4; i++) {
        const struct rd_span span = {.width = 2,
                                     .coordinate = (const int32_t[]){RD_Z, RD_BETA},
                                     .flexibility = flexibility,
                                     .section = 1,
                                     .tension = tension[i],
                                     .load = {5e4, 0}};
        const double a = rd_span_wavenumber(&span), a2 = a * a;
        CHECK_REL(a2 * a2, tension[i] * S * a2 + 5e4 * S, 16 * EPS, "a few roundings, squared");
    }
}

/* an inertia of rotation makes waves no longer, and a section that is softer neither */
static void wavenumber_grows_with_all_that_shortens_waves(void)
{
    const double flexibility[9] = {[4] = 6, [8] = 0.02};
    struct rd_span span = {.width = 3,
                           .coordinate = names + 1,
                           .flexibility = flexibility,
                           .section = 1,
                           .tension = 300,
                           .load = {5e4, 40, 7}};
    double before = rd_span_wavenumber(&span);
    for (int i = 0; i < 5; i++) {
        if (i < 3)
            span.load[i] *= 2;
        else if (i == 3)
            span.tension *= 2;
        else
            span.section /= 2;
        CHECK(rd_span_wavenumber(&span) > before);
        before = rd_span_wavenumber(&span);
    }
}

/* twice what it is alone */
static void coupled_channels_are_allowed_twice_the_wavenumber_squared(void)
{
    double flexibility[9] = {[4] = 6, [8] = 0.02};
    const struct rd_span span = {.width = 3,
                                 .coordinate = names + 1,
                                 .flexibility = flexibility,
                                 .section = 1,
                                 .tension = 300,
                                 .load = {5e4, 40, 7}};
    const double alone = rd_span_wavenumber(&span);
    static const int coupling[] = {1, 2, 5};
    for (int k = 0; k < 3; k++) {
        flexibility[coupling[k]] = 1e-9;
        CHECK_REL(rd_span_wavenumber(&span), sqrt(2) * alone, 4 * EPS, "two roots");
        flexibility[coupling[k]] = 0;
    }
}

/* 2^-n of the radians is at most 1, and n is the least; whatever there is to halve */
static void spans_are_halved_until_a_piece_has_one_radian(void)
{
    for (int k = -40; k < 59; k++)
        for (int side = 0; side < 3; side++) {
            const double radians = ldexp(side == 0 ? 1 : side == 1 ? 1 + EPS : PI, k);
            const int n = rd_span_halvings(radians, 1);
            CHECK(ldexp(radians, -n) <= 1);
            CHECK(n == 0 || ldexp(radians, -n) >= 0.5);
        }
    CHECK_INT(rd_span_halvings(0, 1), 0);
    CHECK_INT(rd_span_halvings(NAN, 1), 0);
    CHECK_INT(rd_span_halvings(1, 1), 0);
}

/* their number fits into an index, and their length into a double */
static void halvings_end_where_pieces_could_not_be_counted(void)
{
    CHECK_INT(rd_span_halvings(1e300, 1), RD_HALVINGS_MOST);
    CHECK_INT(rd_span_halvings(INFINITY, 1), RD_HALVINGS_MOST);
    static const size_t count[] = {3, 1 << 20, SIZE_MAX / 2, SIZE_MAX};
    for (int i = 0; i < 4; i++) {
        const int n = rd_span_halvings(INFINITY, count[i]);
        CHECK(count[i] << n >> n == count[i]);
        CHECK(n == RD_HALVINGS_MOST || count[i] << (n + 1) >> (n + 1) != count[i]);
    }
}

/* What is left out of exp(x) after n terms is x^(n+1)/(n+1)! and less than twice that for x <= 1; the
   first entries begin with the power 3, x^3/3!, so that EPS of these is what it must be below. */
static void series_is_summed_to_all_digits_of_its_least_entry(void)
{
    for (int k = 0; k <= 20; k++) {
        const double x = k == 0 ? 1 : pow(2, -2 * k);
        const int n = rd_span_terms(x);
        double rest = 2;
        for (int i = 1; i <= n + 1; i++)
            rest *= x / i;
        CHECK(n <= RD_SLICE_TERMS);
        CHECK(rest <= EPS / 8 * x * x * x / 6);
    }
    CHECK(rd_span_terms(0) >= 3);
    CHECK_INT(rd_span_terms(INFINITY), RD_SLICE_TERMS);
    CHECK(rd_span_terms(NAN) <= RD_SLICE_TERMS);
}

int main(void)
{
    span_of_one_coordinate_has_its_closed_wavenumber();
    tensed_beam_has_its_evanescent_wavenumber();
    wavenumber_grows_with_all_that_shortens_waves();
    coupled_channels_are_allowed_twice_the_wavenumber_squared();
    spans_are_halved_until_a_piece_has_one_radian();
    halvings_end_where_pieces_could_not_be_counted();
    series_is_summed_to_all_digits_of_its_least_entry();
    return check_report("test_span");
}
