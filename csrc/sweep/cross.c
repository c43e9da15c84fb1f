/* Across the chain: runs by pieces, the rest element by element. */
#include "sweep/cross.h"
#include "graded/family.h"
#include "span/span.h"
#include "sweep/plan.h"

#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wpsabi"

/* fewer elements are crossed by real minors one by one in the time that it takes to join them */
enum { JOINED_LEAST = 16 };

/* at a free end nothing is behind the walk: U = I */
void rd_sweep_begin(struct sweep *s)
{
    const size_t w = s->chain->width;
    for (size_t i = 0, p = 0; i < w; i++)
        for (size_t j = i; j < w; j++, p++)
            s->state.U[p] = c_real(i == j ? 1.0 : 0.0);
    memset(s->state.A, 0, sizeof s->state.A);
    memset(s->rows, 0, 2 * s->carried * w * sizeof *s->rows);
    s->state.stretch = 0;
    s->state.absorbed = 0;
    s->state.flat = 0;
    s->state.rows = 0;
    s->state.E = s->state.E_all = s->rows;
}

/* the term of a node, near to which the walk stands */
static size_t term_at(struct sweep *s, size_t node)
{
    s->state.stretch = rd_stretch_of(s->chain, node, s->state.stretch);
    return (size_t)s->chain->term[s->state.stretch];
}

/* minors say what is behind the walk: while no row is carried */
static void flatten(struct sweep *s)
{
    if (!s->state.flat)
        s->kernel->flatten[s->undamped](&s->block, &s->state);
    s->state.flat = 1;
}

/* U says it again */
static void scatter(struct sweep *s)
{
    if (s->state.flat)
        s->kernel->scatter[s->undamped](&s->block, &s->state);
    s->state.flat = 0;
}

void rd_sweep_absorb(struct sweep *s, int way, size_t node)
{
    scatter(s);
    if (!s->state.absorbed)
        s->kernel->absorb(&s->walk[way], term_at(s, node), &s->state);
}

/* a node term that half a turn about z changes makes the pieces differ with the direction */
static int turns(const struct sweep *s, int32_t term)
{
    const size_t w = s->chain->width, at = (size_t)term * w * w;
    int any = 0;
    if (term == RD_NO_TERM)
        return 0;
    for (size_t i = 0; i < w; i++)
        for (size_t j = 0; j < w; j++)
            if (s->way[1].sign[i] * s->way[1].sign[j] < 0.0)
                any |= s->chain->mass[at + i * w + j] != 0.0 ||
                       s->chain->stiffness[at + i * w + j] != 0.0 ||
                       (s->chain->damping && s->chain->damping[at + i * w + j] != 0.0);
    return any;
}

/* pieces of 1, 2, 4, .. first pieces of a run, joined by doubling; those that it is crossed by are
   the largest and the binary digits of the rest */
static void make_table(struct sweep *s, const struct rd_run *run, int way,
                       const struct sweep_pieces *pieces)
{
    const size_t levels = pieces->level + 1, rest = pieces->count & (((size_t)1 << levels) - 1);
    struct sweep_table *table = &s->tabled;
    way = turns(s, run->term) ? way : 0;
    if (table->levels == levels && table->element == run->element && table->term == run->term &&
        table->way == way && table->rest == rest && table->flat == s->state.flat)
        return;
    s->whole.count = s->coupled.count = 0;
    cv *one = s->triple, *two = s->triple + s->coefs;
    const size_t e = (size_t)run->element;
    if (s->chain->inertia)
        s->kernel->make_slice(s->chain, &s->block, e, pieces->halvings,
                              rd_span_terms(pieces->radians), one);
    else
        s->kernel->make_element(s->chain, &s->block, e, one);
    for (size_t k = 0; k < levels; k++) {
        if (k + 1 == levels || rest >> k & 1) {
            cv *kept = s->table + k * s->coefs;
            if (s->state.flat)
                memcpy(kept, one, s->coefs * sizeof *one);
            else
                s->kernel->make_coefficients(one, kept);
        }
        if (k + 1 < levels)
            s->kernel->join[s->undamped](s->chain, &s->way[way], run->term, one, one, two);
        cv *swap = one;
        one = two;
        two = swap;
    }
    *table = (struct sweep_table){levels, rest, run->element, run->term, way, s->state.flat};
}

/* across the node ahead, whose term may differ from the run's */
static void cross_node(struct sweep *s, int way, size_t node)
{
    const size_t term = term_at(s, node);
    const int apart = s->trait[term] & (way ? RD_COUPLED : RD_COUPLED | RD_HINGED);
    if (s->state.flat && !apart) {
        if (!s->state.absorbed)
            s->kernel->walk_node(&s->walk[way], term, &s->state);
    } else {
        const int flat = s->state.flat;
        rd_sweep_absorb(s, way, node);
        if (!way && (s->trait[term] & RD_HINGED))
            s->kernel->open(&s->walk[way], term, &s->state);
        if (flat)
            flatten(s);
    }
    s->state.absorbed = 0;
}

/* count equal pieces of the table, with the run's term between them */
static void walk_pieces(struct sweep *s, int way, const cv *piece, int32_t term, size_t count)
{
    if (s->state.flat)
        s->kernel->walk_triples(&s->walk[way], piece, term, count, &s->state);
    else
        s->kernel->walk_pieces(&s->walk[way], piece, term, count, &s->state);
}

static void first_piece(struct sweep *s, int way, const cv *piece, size_t node)
{
    cross_node(s, way, node);
    walk_pieces(s, way, piece, RD_NO_TERM, 1);
}

/* binary digits of a number */
static size_t levels_of(size_t count)
{
    size_t levels = 0;
    while (count >> levels > 0)
        levels++;
    return levels;
}

static void cross_each(struct sweep *s, int way, size_t node, size_t count)
{
    if (count == 0)
        return;
    s->state.stretch = rd_stretch_of(s->chain, node, s->state.stretch);
    if (s->planar && s->state.rows == 0) {
        flatten(s);
        s->kernel->walk_plain[s->undamped](&s->walk[way], node, count, &s->state);
    } else {
        scatter(s);
        s->kernel->walk(&s->walk[way], node, count, &s->state);
    }
    s->state.absorbed = 0;
    s->steps += (double)count;
}

/* a hinge on the right of a node that the walk comes to from there */
static void open_behind(struct sweep *s, int way, size_t node)
{
    const size_t end = term_at(s, node);
    if (way && (s->trait[end] & RD_HINGED)) {
        scatter(s);
        s->kernel->open(&s->walk[way], end, &s->state);
    }
}

/* whether real minors can go across joined pieces and whole spans: nothing is damped and no row
   carried, of z with beta alone */
static int goes_flat(const struct sweep *s)
{
    return s->planar && s->undamped && s->state.rows == 0 && s->kernel->walk_triples != NULL &&
           s->block.bends;
}

/* The same as cross_plain by real minors. */
static void cross_compound(struct sweep *s, int32_t element, int way, size_t node, size_t count)
{
    struct sweep_compound *own = &s->compound;
    if (own->element != element || own->count != count) {
        const double length = (double)count * s->chain->length[element];
        s->kernel->make_compound(s->chain, &s->block, (size_t)element, length, &own->of);
        own->element = element;
        own->count = count;
    }
    flatten(s);
    cross_node(s, way, node);
    s->kernel->walk_compound(&own->of, &s->state);
    open_behind(s, way, way ? node - count : node + count);
    s->steps += (1.0 + own->of.radians) * (1.0 + own->of.radians);
    s->radians = l_most(own->of.radians, s->radians);
}

/* Across count elements of a plain span, at once: rounding of its phase is that of so many steps. */
static void cross_plain(struct sweep *s, int32_t element, int way, size_t node, size_t count)
{
    struct sweep_whole *whole = &s->whole;
    if (goes_flat(s) && s->waves) {
        cross_compound(s, element, way, node, count);
        return;
    }
    scatter(s);
    if (whole->element != element || whole->count != count) {
        const double length = (double)count * s->chain->length[element];
        s->kernel->make_whole(s->chain, &s->block, (size_t)element, length, s->table,
                              &whole->radians);
        whole->element = element;
        whole->count = count;
        s->tabled.levels = s->coupled.count = 0;
    }
    first_piece(s, way, s->table, node);
    open_behind(s, way, way ? node - count : node + count);
    s->steps += (1.0 + whole->radians) * (1.0 + whole->radians);
    s->radians = l_most(whole->radians, s->radians);
}

/* 1, 2, 4, .. elements of a run of spans of three coordinates and more */
static void make_coupled(struct sweep *s, const struct rd_run *run, size_t count)
{
    const size_t e = (size_t)run->element;
    const struct sweep_pieces all =
        rd_sweep_pieces(s->chain, run, count, rd_sweep_waves(s->chain, run, s->extent));
    /* terms for the shortest waves: more than a lane needs change none of its bits */
    const struct sweep_waves shortest = rd_sweep_waves(s->chain, run, &s->most);
    const int level = (int)all.level, joins = level < all.halvings ? level : all.halvings;
    const struct sweep_cut cut = {
        .joins = joins,
        .doublings = all.halvings - joins,
        .terms = rd_span_terms(ldexp(s->chain->length[e] * shortest.all, -all.halvings)),
    };
    s->kernel->make_coupled(s->chain, &s->block, e, &cut, s->table, &s->coupled.steps);
    for (size_t k = 1; k < levels_of(count); k++)
        s->kernel->twice(s->chain, s->way, RD_NO_TERM, s->table + (k - 1) * s->coefs,
                         s->table + k * s->coefs);
    s->coupled.element = run->element;
    s->coupled.count = count;
    s->whole.count = s->tabled.levels = 0;
}

/* Across count elements of such a run by the binary digits of count, the largest first. */
static void cross_coupled(struct sweep *s, const struct rd_run *run, int way, size_t node,
                          size_t count)
{
    scatter(s);
    if (s->coupled.element != run->element || s->coupled.count != count)
        make_coupled(s, run, count);
    cross_node(s, way, node);
    for (size_t k = levels_of(count); k-- > 0;)
        if (count >> k & 1)
            walk_pieces(s, way, s->table + k * s->coefs, RD_NO_TERM, 1);
    open_behind(s, way, way ? node - count : node + count);
    s->steps += s->coupled.steps * ((double)count * (double)count);
}

static const double *first_value(const struct rd_between *between, size_t e, int way)
{
    return between->values + 2 * between->nodes * between->first[2 * e + (size_t)way];
}

static void lines_fill(const struct sweep *s, size_t e, struct rd_between_lines *lines)
{
    rd_between_weigh(s->between, s->index, lines->weight);
    for (size_t i = 0; i < s->chain->width; i++)
        lines->z[i] = s->block.z[i];
    lines->load = rd_between_load(s->chain, e, s->block.inertia, s->block.dashpot);
}

/* Across an element whose tension grows, by the pieces of its blocks, which are others the other way. */
static void cross_graded(struct sweep *s, size_t e, int way, size_t node)
{
    struct rd_block block[RD_BLOCKS_MOST];
    struct rd_family family;
    struct rate_matrix rate;
    const struct rd_field field = {
        .width = s->chain->width,
        .rate = &rate,
        .tension = s->chain->tension[e],
        .pull = s->block.pull,
    };
    const struct rd_between *between = s->between;
    const struct rd_sizes sizes = between ? between->most : rd_sweep_sizes(s->extent);
    const size_t blocks = rd_blocks_of(s->chain, e, &sizes, way, block);
    const double *at = between ? first_value(between, e, way) : NULL;
    struct rd_between_lines lines;
    if (between)
        lines_fill(s, e, &lines);
    scatter(s);
    s->kernel->make_rate(s->chain, &s->block, e, &rate);
    s->tabled.levels = s->whole.count = s->coupled.count = 0;
    for (size_t k = 0; k < blocks; k++) {
        if (between)
            at = rd_between_family(between, &lines, at, field.width, block + k, &family);
        else
            rd_family_fill(&field, block + k, &family);
        for (size_t i = 0; i < block[k].pieces; i++) {
            rd_family_piece(&family, i, s->triple);
            s->kernel->make_coefficients(s->triple, s->table);
            if (k + i == 0)
                first_piece(s, way, s->table, node);
            else
                walk_pieces(s, way, s->table, RD_NO_TERM, 1);
        }
        s->steps += (double)block[k].pieces * (double)block[k].pieces;
    }
    open_behind(s, way, way ? node - 1 : node + 1);
}

/* Across count elements of a run: the largest pieces first, then the binary digits of the rest. */
static void cross_run(struct sweep *s, const struct rd_run *run, int way, size_t node, size_t count)
{
    if (rd_span_is_plain(s->chain, (size_t)run->element)) {
        cross_plain(s, run->element, way, node, count);
        return;
    }
    if (rd_is_graded(s->chain, (size_t)run->element)) {
        cross_graded(s, (size_t)run->element, way, node);
        return;
    }
    if (s->chain->inertia && s->kernel->make_coupled) {
        cross_coupled(s, run, way, node, count);
        return;
    }
    if (!s->chain->inertia && count < JOINED_LEAST && goes_flat(s)) {
        cross_each(s, way, node, count);
        return;
    }
    struct sweep_pieces all =
        rd_sweep_pieces(s->chain, run, count, rd_sweep_waves(s->chain, run, s->extent));
    if (s->chain->inertia) {
        /* terms for the shortest waves: more than a lane needs change none of its bits */
        const struct sweep_waves shortest = rd_sweep_waves(s->chain, run, &s->most);
        all.radians = ldexp(s->chain->length[run->element] * shortest.all, -all.halvings);
    }
    if (all.level == 0 && !s->chain->inertia) {
        cross_each(s, way, node, count);
        return;
    }
    if (goes_flat(s) && (run->term < 0 || !(s->trait[run->term] & RD_COUPLED)))
        flatten(s);
    else
        scatter(s);
    make_table(s, run, way, &all);
    int begun = 0;
    for (size_t left = all.count, top = all.level; left > 0; top--) {
        size_t pieces = left >> top;
        left -= pieces << top;
        s->steps += (double)pieces * (double)pieces;
        if (pieces == 0)
            continue;
        const cv *piece = s->table + top * s->coefs;
        if (!begun) {
            first_piece(s, way, piece, node);
            begun = 1;
            pieces--;
        }
        walk_pieces(s, way, piece, run->term, pieces);
    }
    open_behind(s, way, way ? node - count : node + count);
}

/* A heavy node lies between two stretches: rows lose most digits there. */
static void accompany(struct sweep *s)
{
    const size_t w = s->chain->width;
    for (size_t r = 0; r < s->state.rows; r += 2)
        sweep_accompany(s->state.E + r * w, (int)w, s->state.E + (r + 1) * w);
}

/* from node a to a later node b, runs by pieces and the rest element by element; r is the first
   run that ends behind a */
void rd_sweep_forward(struct sweep *s, size_t a, size_t b, size_t *r)
{
    while (a < b) {
        while (*r < s->runs.count && s->runs.run[*r].last <= a)
            ++*r;
        const struct rd_run *run = *r < s->runs.count ? s->runs.run + *r : NULL;
        const size_t until = !run || run->first > b ? b : run->first;
        if (a < until) {
            cross_each(s, 0, a, until - a);
            a = until;
        } else {
            const size_t end = run->last < b ? run->last : b;
            if (end - a >= s->runs.least)
                cross_run(s, run, 0, a, end - a);
            else
                cross_each(s, 0, a, end - a);
            a = end;
        }
        accompany(s);
    }
    scatter(s);
}

/* the same from b back to an earlier node a; *r - 1 is the last run that begins before b */
void rd_sweep_backward(struct sweep *s, size_t b, size_t a, size_t *r)
{
    while (a < b) {
        while (*r > 0 && s->runs.run[*r - 1].first >= b)
            --*r;
        const struct rd_run *run = *r > 0 ? s->runs.run + *r - 1 : NULL;
        const size_t until = !run || run->last < a ? a : run->last;
        if (until < b) {
            cross_each(s, 1, b, b - until);
            b = until;
        } else {
            const size_t end = run->first > a ? run->first : a;
            if (b - end >= s->runs.least)
                cross_run(s, run, 1, b, b - end);
            else
                cross_each(s, 1, b, b - end);
            b = end;
        }
        accompany(s);
    }
    scatter(s);
}
