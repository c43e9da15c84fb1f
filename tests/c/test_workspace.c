/* The workspace: what it hands out, and what it refuses. */
#include "base/workspace.h"

#include "chains.h"
#include "check.h"

#include <stdint.h>
#include <string.h>

static void measuring_hands_out_nothing_and_counts(void)
{
    struct rd_workspace workspace = {0};
    CHECK(rd_take(&workspace, 3, sizeof(double)) == NULL);
    CHECK_INT(workspace.used, 32);
    CHECK(rd_take(&workspace, 1, 1) == NULL);
    CHECK_INT(workspace.used, 48);
    CHECK(rd_take(&workspace, 0, sizeof(double)) == NULL);
    CHECK_INT(workspace.used, 48);
    CHECK(!rd_workspace_fits(&workspace));
}

static void pieces_follow_each_other_aligned(void)
{
    static const size_t count[] = {1, 3, 16, 5, 2};
    struct rd_workspace workspace = exact_workspace(16 + 16 + 16 + 16 + 16);
    for (size_t k = 0; k < 5; k++) {
        char *piece = rd_take(&workspace, count[k], 1);
        CHECK(piece == workspace.base + 16 * k);
        CHECK_INT((uintptr_t)piece % 16, 0);
        memset(piece, 1, count[k]);
    }
    CHECK(rd_workspace_fits(&workspace));
    CHECK_INT(workspace.used, workspace.size);
    free(workspace.base);
}

static void measured_size_is_what_is_needed(void)
{
    static const size_t count[] = {7, 0, 1, 12};
    struct rd_workspace measure = {0};
    for (size_t k = 0; k < 4; k++)
        rd_take(&measure, count[k], sizeof(double));
    for (size_t short_of = 0; short_of < 2; short_of++) {
        struct rd_workspace workspace = exact_workspace(measure.used - short_of);
        for (size_t k = 0; k < 4; k++) {
            double *piece = rd_take(&workspace, count[k], sizeof(double));
            CHECK((piece == NULL) == (k == 3 && short_of > 0));
            if (piece != NULL)
                memset(piece, 0, count[k] * sizeof *piece);
        }
        CHECK_INT(rd_workspace_fits(&workspace), short_of == 0);
        free(workspace.base);
    }
}

/* once a piece did not fit, nothing does, however small */
static void full_workspace_stays_full(void)
{
    struct rd_workspace workspace = exact_workspace(32);
    CHECK(rd_take(&workspace, 3, 16) == NULL);
    CHECK(rd_take(&workspace, 1, 1) == NULL);
    CHECK(!rd_workspace_fits(&workspace));
    free(workspace.base);
}

static void more_than_can_be_addressed_is_refused(void)
{
    static const size_t request[][2] = {
        {SIZE_MAX, 2}, {SIZE_MAX / 8 + 1, 8}, {SIZE_MAX, SIZE_MAX}, {2, SIZE_MAX},
        {SIZE_MAX, 1}, {1, SIZE_MAX - 8},     {SIZE_MAX / 2, 3},    {(size_t)1 << 60, 64},
    };
    for (size_t k = 0; k < sizeof request / sizeof *request; k++) {
        struct rd_workspace workspace = exact_workspace(64);
        CHECK(rd_take(&workspace, request[k][0], request[k][1]) == NULL);
        CHECK(workspace.used == SIZE_MAX);
        CHECK(rd_take(&workspace, 1, 1) == NULL);
        CHECK(rd_take(&workspace, 0, 1) == NULL);
        CHECK(workspace.used == SIZE_MAX);
        CHECK(!rd_workspace_fits(&workspace));
        free(workspace.base);
    }
}

/* the sum of pieces overflows although each of them does not */
static void sum_of_pieces_does_not_wrap(void)
{
    struct rd_workspace workspace = {0};
    for (int k = 0; k < 5; k++)
        CHECK(rd_take(&workspace, SIZE_MAX / 4, 1) == NULL);
    CHECK(workspace.used == SIZE_MAX);
    workspace = (struct rd_workspace){.used = SIZE_MAX - 15};
    CHECK(rd_take(&workspace, 1, 8) == NULL);
    CHECK(workspace.used == SIZE_MAX);
}

int main(void)
{
    measuring_hands_out_nothing_and_counts();
    pieces_follow_each_other_aligned();
    measured_size_is_what_is_needed();
    full_workspace_stays_full();
    more_than_can_be_addressed_is_refused();
    sum_of_pieces_does_not_wrap();
    return check_report("test_workspace");
}
