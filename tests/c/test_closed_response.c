/* Responses of one span in closed form: textbook values, reciprocity, and what is not certain. */
#include "base/complex.h"
#include "closed/response.h"

#include <string.h>

#include "check.h"

static const double PI = 3.14159265358979323846;

enum { LINES = 11 };

struct asked {
    double factor[5][2 * LINES];
    double omega[LINES];
};

/* elastic, with a loss factor and drag */
static struct asked lines_up_to(double highest, double loss)
{
    struct asked asked;
    for (size_t i = 0; i < LINES; i++) {
        const double omega = asked.omega[i] = highest * (double)(i + 1) / LINES;
        const double part[5][2] = {
            {1, loss}, {1, loss}, {1, loss}, {-omega * omega, 0}, {0, omega}};
        for (size_t k = 0; k < 5; k++)
            memcpy(asked.factor[k] + 2 * i, part[k], sizeof part[k]);
    }
    return asked;
}

struct found {
    double value[2 * LINES], error[LINES];
    uint8_t certain[LINES];
};

static struct found solve(const double *number, const struct asked *asked, double drag, double x0,
                          double x1)
{
    struct found found;
    memset(&found, 0, sizeof found); /* padding is compared too */
    const struct rd_closed_lines lines = {LINES, asked->factor[0], drag, 1, 1, &x0, &x1};
    const struct rd_closed_response to = {found.value, found.error, found.certain};
    rd_bent_response(number, 0, 1, &lines, &to);
    return found;
}

static double complex value_of(const struct found *found, size_t i)
{
    return found->value[2 * i] + I * found->value[2 * i + 1];
}

/* u = sum of 2 sin(n pi x0) sin(n pi x1)/(mu L (omega_n^2 - omega^2 + i ...)), of a pinned span; what
   is left out after 20000 modes is below 1e-13 of it */
static void a_pinned_span_answers_as_the_sum_of_its_modes(void)
{
    const double L = 2, mu = 3, T = 50, B = 5, loss = 0.02, drag = 0.4, x0 = 0.7, x1 = 1.6;
    const double number[] = {L, mu, T, B, INFINITY, 0, INFINITY, 0};
    const struct asked asked = lines_up_to(60, loss);
    const struct found found = solve(number, &asked, drag, x0, x1);
    for (size_t i = 0; i < LINES; i++) {
        const double omega = asked.omega[i];
        double complex sum = 0;
        for (int n = 20000; n > 0; n--) {
            const double k = n * PI / L;
            const double complex stiff = (T * k * k + B * k * k * k * k) * (1 + I * loss);
            sum += sin(k * x0) * sin(k * x1) / (stiff - mu * omega * omega + I * omega * drag);
        }
        sum *= 2 / L;
        CHECK(found.certain[i]);
        CHECK(cabs(value_of(&found, i) - sum) <= (found.error[i] + 1e-13) * cabs(sum));
        CHECK(found.error[i] < 1e-11);
    }
}

static void force_and_motion_change_places(void)
{
    const double number[] = {1.3, 0.2, -20, 11, 40, -3, 900, INFINITY};
    const struct asked asked = lines_up_to(2e4, 0.01);
    const struct found there = solve(number, &asked, 0.1, 0.2, 0.9);
    const struct found back = solve(number, &asked, 0.1, 0.9, 0.2);
    CHECK(memcmp(&there, &back, sizeof there) == 0);
}

static void what_has_no_sure_answer_is_not_certain(void)
{
    const double slow[] = {1, 1, 0, 1, INFINITY, 0, INFINITY, 0};
    const struct asked asked = lines_up_to(0.003, 0);
    const struct found found = solve(slow, &asked, 0, 0.3, 0.4);
    const struct asked usual = lines_up_to(50, 0);
    const struct found beside = solve(slow, &usual, 0, 0.3, 1.4);
    const double nothing[] = {-1, 1, 0, 1, INFINITY, 0, INFINITY, 0};
    const struct found none = solve(nothing, &usual, 0, 0.3, 0.4);
    for (size_t i = 0; i < LINES; i++)
        CHECK(!found.certain[i] && !beside.certain[i] && !none.certain[i]);
}

int main(void)
{
    a_pinned_span_answers_as_the_sum_of_its_modes();
    force_and_motion_change_places();
    what_has_no_sure_answer_is_not_certain();
    return check_report("test_closed_response");
}
