/* Triples of pieces of a block: the right width. */
#include "graded/family.h"

#include <assert.h>

#pragma GCC diagnostic ignored "-Wpsabi"

#define RD_FAMILY_WIDTH(w)                                                                         \
    void rd_family_fill_##w(const struct rd_field *, const struct rd_block *, struct rd_family *); \
    void rd_family_piece_##w(const struct rd_family *, size_t, cv *);                              \
    void rd_family_join_##w(const cv *, cv *);
RD_FAMILY_WIDTH(1)
RD_FAMILY_WIDTH(2)

void rd_family_fill(const struct rd_field *field, const struct rd_block *block,
                    struct rd_family *family)
{
    assert(field->width >= 1 && field->width <= RD_GRADED_WIDTH);
    family->block = block;
    family->width = field->width;
    if (field->width == 1)
        rd_family_fill_1(field, block, family);
    else
        rd_family_fill_2(field, block, family);
}

void rd_family_whole(const struct rd_field *field, size_t blocks, const struct rd_block *block,
                     cv *triple)
{
    struct rd_family family;
    cv next[RD_GRADED_TRIPLE];
    for (size_t k = 0; k < blocks; k++) {
        rd_family_fill(field, block + k, &family);
        for (size_t i = 0; i < block[k].pieces; i++) {
            rd_family_piece(&family, i, k + i == 0 ? triple : next);
            if (k + i > 0)
                rd_family_join(field->width, next, triple);
        }
    }
}

void rd_family_piece(const struct rd_family *family, size_t i, cv *triple)
{
    if (family->width == 1)
        rd_family_piece_1(family, i, triple);
    else
        rd_family_piece_2(family, i, triple);
}

void rd_family_join(size_t width, const cv *next, cv *triple)
{
    if (width == 1)
        rd_family_join_1(next, triple);
    else
        rd_family_join_2(next, triple);
}
