/* A chain made ready: its arrays, its ports, and what happens when memory is short. */
#include "assembled/system.h"

#include "chains.h"
#include "check.h"

#include <string.h>

static const struct recipe recipe = {
    .kind = RD_RIGID,
    .elements = 5,
    .coordinates = "zab",
    .length = 0.16875,
    .tension = 300,
    .section = {0, 0.1485, 54.626, 0, 0.3},
    .inertia = {0, 0.02, 2.4e-8, 7.8e-5},
    .left = "zb",
    .right = "z",
};

static enum rd_status prepare(const struct rope *rope, size_t bytes, struct rd_system *system,
                              struct rd_workspace *workspace)
{
    *workspace = exact_workspace(bytes);
    return rd_system_prepare(&rope->chain, system, workspace);
}

static size_t measure(const struct rope *rope)
{
    struct rd_system system;
    struct rd_workspace workspace = {0};
    CHECK_INT(rd_system_prepare(&rope->chain, &system, &workspace), RD_NO_MEMORY);
    CHECK_INT(system.free, rope->chain.nodes * rope->chain.width);
    CHECK(workspace.used > 0);
    return workspace.used;
}

static void prepared_system_knows_what_is_free(void)
{
    struct rope rope = rope_make(&recipe);
    struct rd_system system;
    struct rd_workspace workspace;
    CHECK_INT(prepare(&rope, measure(&rope), &system, &workspace), RD_OK);
    CHECK_INT(workspace.used, workspace.size);
    CHECK_INT(system.free, 15);
    CHECK_INT(system.reach, 5);
    CHECK_INT(system.assembly.nodes, 6);
    CHECK_INT(system.assembly.width, 3);
    CHECK_INT(system.number[0], -1);
    CHECK_INT(system.number[1], 0);
    for (size_t i = 0; i < system.free; i++)
        CHECK(system.scale[i] > 0 && isfinite(system.scale[i]));
    free(workspace.base);
    rope_free(&rope);
}

/* every size that is too small: refused, and nothing is written outside the block */
static void short_memory_is_refused_at_every_size(void)
{
    struct rope rope = rope_make(&recipe);
    const size_t needed = measure(&rope);
    for (size_t bytes = 0; bytes < needed; bytes += bytes + 8 < needed ? 8 : 1) {
        struct rd_system system;
        struct rd_workspace workspace;
        CHECK_INT(prepare(&rope, bytes, &system, &workspace), RD_NO_MEMORY);
        CHECK_INT(workspace.used, needed);
        free(workspace.base);
    }
    rope_free(&rope);
}

static void section_that_creates_energy_is_refused(void)
{
    struct rope rope = rope_make(&recipe);
    struct rd_system system;
    struct rd_workspace workspace;
    rope.flexibility[8] = -1;
    CHECK_INT(prepare(&rope, measure(&rope), &system, &workspace), RD_NOT_POSITIVE_DEFINITE);
    free(workspace.base);
    rope_free(&rope);
}

/* a port at every node pair with arbitrary rows */
enum { PORTS = 5, ROWS = PORTS * 2 * 3 };

static struct rd_ports every_port(double *row, int32_t *node)
{
    for (int32_t p = 0; p < PORTS; p++)
        node[p] = p;
    for (int k = 0; k < ROWS; k++)
        row[k] = check_random();
    return (struct rd_ports){.count = PORTS, .node = node, .row = row};
}

/* read(u) = load . u: what a port watches is what it pushes */
static void reading_is_the_transpose_of_loading(size_t stride)
{
    struct rope rope = rope_make(&recipe);
    struct rd_system system;
    struct rd_workspace workspace;
    double row[ROWS];
    int32_t node[PORTS];
    const struct rd_ports ports = every_port(row, node);
    CHECK_INT(prepare(&rope, measure(&rope), &system, &workspace), RD_OK);
    double *u = zeros(system.free * stride), *load = zeros(system.free * stride);
    for (size_t p = 0; p < PORTS; p++) {
        double product = 0;
        for (size_t i = 0; i < system.free * stride; i++) {
            u[i] = check_random();
            load[i] = (double)NAN; /* what was there is overwritten */
        }
        rd_port_load(&system, &ports, p, stride, load);
        for (size_t i = 0; i < system.free; i++) {
            product += load[stride * i] * u[stride * i];
            for (size_t k = 1; k < stride; k++)
                CHECK_EXACT(load[stride * i + k], 0);
        }
        CHECK_EXACT(rd_port_read(&system, &ports, p, stride, u), product);
    }
    free(u);
    free(load);
    free(workspace.base);
    rope_free(&rope);
}

/* row (1, 0, 0 | 0, 0, 0) watches z of its left node, unscaled; held coordinates neither push nor
   move */
static void port_of_one_coordinate_is_that_coordinate(void)
{
    struct rope rope = rope_make(&recipe);
    struct rd_system system;
    struct rd_workspace workspace;
    static const int32_t node[] = {0, 2};
    static const double row[] = {1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    const struct rd_ports ports = {2, node, row, NULL};
    CHECK_INT(prepare(&rope, measure(&rope), &system, &workspace), RD_OK);
    double *u = zeros(system.free), *load = zeros(system.free);
    for (size_t i = 0; i < system.free; i++)
        u[i] = 1 / system.scale[i];
    rd_port_load(&system, &ports, 0, 1, load);
    for (size_t i = 0; i < system.free; i++)
        CHECK_EXACT(load[i], 0);
    CHECK_EXACT(rd_port_read(&system, &ports, 0, 1, u), 0);
    rd_port_load(&system, &ports, 1, 1, load);
    const size_t z = (size_t)system.number[6];
    for (size_t i = 0; i < system.free; i++)
        CHECK_EXACT(load[i], i == z ? system.scale[z] : 0);
    CHECK_REL(rd_port_read(&system, &ports, 1, 1, u), 1, 2 * EPS, "1/scale times scale");
    free(u);
    free(load);
    free(workspace.base);
    rope_free(&rope);
}

int main(void)
{
    prepared_system_knows_what_is_free();
    short_memory_is_refused_at_every_size();
    section_that_creates_energy_is_refused();
    reading_is_the_transpose_of_loading(1);
    reading_is_the_transpose_of_loading(2);
    port_of_one_coordinate_is_that_coordinate();
    return check_report("test_system");
}
