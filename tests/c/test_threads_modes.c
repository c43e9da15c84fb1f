/* Eight threads look for the modes of one chain and get the same bits. */
#include "check.h"
#include "modes/certify/certify.h"
#include "walked.h"

#include <pthread.h>
#include <string.h>

enum { THREADS = 8, MODES = 6 };

/* the modes of one walk, which all threads read */
struct search {
    const struct rd_walk *walk;
    enum rd_status status;
    double lambda[MODES], error[MODES], certified[MODES], bracket[4 * MODES];
};

static void *certify(void *given)
{
    struct search *search = given;
    struct rd_workspace workspace = {0};
    struct rd_refine refine;
    size_t steps, pieces;
    struct rd_certified modes = {
        .wanted = MODES,
        .upper = INFINITY,
        .lambda = search->lambda,
        .error = search->error,
        .certified = search->certified,
        .bracket = search->bracket,
    };
    rd_certify_size(search->walk, 100, &steps, &pieces);
    rd_refine_take(search->walk, steps, pieces, 1, &workspace, &refine);
    workspace = exact_workspace(workspace.used);
    rd_refine_take(search->walk, steps, pieces, 1, &workspace, &refine);
    search->status = rd_certify(&refine, &modes);
    free(workspace.base);
    return NULL;
}

static void modes_of_one_walk_are_the_same(void)
{
    static const struct recipe recipe = {
        .kind = RD_TENSED,
        .elements = 200,
        .coordinates = "zb",
        .length = 0.005,
        .tension = 300,
        .section = {.bending = 2},
        .inertia = {[RD_Z] = 0.005, [RD_BETA] = 1e-9},
        .left = "zb",
        .right = "z",
    };
    static struct search search[THREADS];
    pthread_t thread[THREADS];
    struct rope rope = rope_make(&recipe);
    rope_gather(&rope);
    struct walked walked = walked_make(&rope.chain);
    for (int i = 0; i < THREADS; i++) {
        search[i].walk = &walked.walk;
        pthread_create(thread + i, NULL, certify, search + i);
    }
    for (int i = 0; i < THREADS; i++)
        pthread_join(thread[i], NULL);
    for (int i = 0; i < THREADS; i++) {
        CHECK_INT(search[i].status, RD_OK);
        CHECK(memcmp(search[i].lambda, search[0].lambda, sizeof search[0].lambda) == 0);
        CHECK(memcmp(search[i].bracket, search[0].bracket, sizeof search[0].bracket) == 0);
    }
    walked_free(&walked);
    rope_free(&rope);
}

int main(void)
{
    modes_of_one_walk_are_the_same();
    return check_report("threads_modes");
}
