/* Spans divided into elements: which are alike, and where stretches and nodes come to lie. */
#include "chain/division.h"
#include "check.h"

enum { SPANS = 5, STRETCHES = 9, NODES = 13 };

/* room for the spans of a test */
struct room {
    struct rd_span_key key[SPANS];
    size_t group[SPANS], head[SPANS];
    double total[SPANS], number[SPANS], length[SPANS];
    int32_t which[SPANS], term[SPANS];
    int64_t span[SPANS], within[SPANS];
};

static struct rd_division division_in(struct room *room)
{
    return (struct rd_division){
        .key = room->key,
        .group = room->group,
        .total = room->total,
        .number = room->number,
        .head = room->head,
        .which = room->which,
        .span = room->span,
        .length = room->length,
        .term = room->term,
        .within = room->within,
    };
}

static const int64_t ELEMENTS[SPANS] = {3, 1, 4, 2, 2}, ROPE[SPANS] = {0, 0, 0, 1, 0};

static void test_elements_are_one_but_for_rounding_and_rope(void)
{
    /* elements of 0.5, but for rounding, and one of 0.25 */
    const double station[] = {0.0, 1.5, 1.75, 3.75 + 8 * EPS, 4.75, 5.75};
    const struct rd_spans spans = {SPANS, station, ELEMENTS, ROPE};
    struct room room;
    struct rd_division division = division_in(&room);
    rd_division_tell(&spans, 16 * EPS, &division);
    CHECK_INT(division.distinct, 3);
    const int which[] = {0, 1, 0, 2, 0}, span[] = {0, 1, 3};
    for (size_t s = 0; s < SPANS; s++)
        CHECK_INT(division.which[s], which[s]);
    for (size_t e = 0; e < 3; e++)
        CHECK_INT(division.span[e], span[e]);
    CHECK_EXACT(division.length[1], 0.25);
    CHECK_REL(division.length[0], 0.5, 4 * EPS, "the mean of all that are as long");
    CHECK_EXACT(division.length[2], division.length[0]);
    /* nodes stand inside all spans but the second */
    CHECK_INT(division.inside, 2);
    CHECK_INT(division.within[0], 0);
    CHECK_INT(division.within[1], 2);
    rd_division_tell(&spans, 0.0, &division);
    CHECK_INT(division.distinct, 4);
}

static void test_stretches_are_stations_and_what_lies_between(void)
{
    const double station[] = {0.0, 1.5, 1.75, 3.75, 4.75, 5.75};
    const struct rd_spans spans = {SPANS, station, ELEMENTS, ROPE};
    struct room room;
    struct rd_division division = division_in(&room);
    rd_division_tell(&spans, 16 * EPS, &division);
    CHECK_INT(rd_division_stretches(&spans), STRETCHES + 1);
    CHECK_INT(rd_division_elements(&spans), NODES - 1);
    int32_t first[STRETCHES + 1], element[STRETCHES], term[STRETCHES + 1];
    double x[NODES];
    rd_division_lay(&spans, &division, first, element, term, x);
    const int begin[] = {0, 1, 3, 4, 5, 8, 9, 10, 11, 12};
    const int of[] = {0, 0, 1, 0, 0, 2, 2, 0, 0};
    const int at[] = {0, 6, 1, 2, 6, 3, 7, 4, 6, 5}; /* stations, then 6 and 7 inside spans */
    for (size_t k = 0; k <= STRETCHES; k++) {
        CHECK_INT(first[k], begin[k]);
        CHECK_INT(term[k], at[k]);
        if (k < STRETCHES)
            CHECK_INT(element[k], of[k]);
    }
    const double place[] = {0.0,  0.5,  1.0,  1.5,  1.75, 2.25, 2.75,
                            3.25, 3.75, 4.25, 4.75, 5.25, 5.75};
    for (size_t n = 0; n < NODES; n++)
        CHECK_EXACT(x[n], place[n]);
}

int main(void)
{
    test_elements_are_one_but_for_rounding_and_rope();
    test_stretches_are_stations_and_what_lies_between();
    return check_report("division");
}
