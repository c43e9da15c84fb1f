/* A tiny checker: a failed check prints where, what and both values; main returns check_report. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* rounding of one operation on doubles, 2^-52; tolerances are multiples of it */
static const double EPS = 0x1p-52;

struct check_site {
    const char *file;
    int line;
    const char *text; /* the expression */
};

enum { CHECK_SHOWN = 20 }; /* failures printed one by one */

/* how many checks ran and how many failed in this program */
static size_t check_count, check_failures;

/* counts one check; true where a failure is to be shown */
static inline bool check_fails(struct check_site site, bool holds)
{
    check_count++;
    if (holds || ++check_failures > CHECK_SHOWN)
        return false;
    printf("%s:%d: %s", site.file, site.line, site.text);
    return true;
}

static inline void check_true(struct check_site site, bool holds)
{
    if (check_fails(site, holds))
        printf(" does not hold\n");
}

static inline void check_int(struct check_site site, long long value, long long expected)
{
    if (check_fails(site, value == expected))
        printf(" is %lld, expected %lld\n", value, expected);
}

static inline void check_exact(struct check_site site, double value, double expected)
{
    if (check_fails(site, value == expected))
        printf(" is %.17g, expected exactly %.17g\n", value, expected);
}

/* NaN fails */
static inline void check_near(struct check_site site, double value, double expected,
                              double tolerance, const char *reason)
{
    if (check_fails(site, fabs(value - expected) <= tolerance))
        printf(" is %.17g, expected %.17g: off by %.3g, allowed %.3g (%s)\n", value, expected,
               fabs(value - expected), tolerance, reason);
}

static inline void check_rel(struct check_site site, double value, double expected,
                             double tolerance, const char *reason)
{
    check_near(site, value, expected, tolerance * fabs(expected), reason);
}

#define CHECK_SITE(text) ((struct check_site){__FILE__, __LINE__, text})

#define CHECK(condition) check_true(CHECK_SITE(#condition), condition)

#define CHECK_INT(value, expected)                                                                 \
    check_int(CHECK_SITE(#value), (long long)(value), (long long)(expected))

#define CHECK_EXACT(value, expected) check_exact(CHECK_SITE(#value), value, expected)

/* |value - expected| <= tolerance |expected|; the reason says where the tolerance comes from */
#define CHECK_REL(value, expected, tolerance, reason)                                              \
    check_rel(CHECK_SITE(#value), value, expected, tolerance, reason)

/* |value - expected| <= tolerance */
#define CHECK_ABS(value, expected, tolerance, reason)                                              \
    check_near(CHECK_SITE(#value), value, expected, tolerance, reason)

/* ends main: one line for the program; 1 where a check failed or none ran */
static inline int check_report(const char *program)
{
    if (check_failures > CHECK_SHOWN)
        printf("... and %zu more\n", check_failures - CHECK_SHOWN);
    printf("%-16s %7zu checks, %zu failed\n", program, check_count, check_failures);
    return check_failures > 0 || check_count == 0;
}

/* a number in -1 ... 1, the same sequence in every run (Knuth's MMIX generator) */
static inline double check_random(void)
{
    static unsigned long long state = 2015;
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(state >> 11) * 0x1p-52 - 1;
}

/* what a test asks to stop with: says yes from one question on, and for ever after */
static inline bool says_yes(void *context)
{
    int *left = context;
    *left -= *left > 0;
    return *left == 0;
}

#endif
