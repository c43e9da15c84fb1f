/* Eight threads sweep one chain and get the same bits. */
#include "check.h"
#include "line.h"

#include <pthread.h>
#include <string.h>

struct job {
    const struct line *line;
    enum rd_status status;
    double complex value[LINE_POINTS];
    double error[LINE_POINTS];
};

static void *work(void *given)
{
    struct job *job = given;
    double omega[LINE_POINTS];
    for (size_t i = 0; i < LINE_POINTS; i++)
        omega[i] = 3.0 * (double)(i + 1);
    job->status = line_frf(job->line, 100, 50, omega, LINE_POINTS, job->value, job->error);
    return NULL;
}

int main(void)
{
    enum { THREADS = 8 };
    static struct line line;
    static struct job job[THREADS];
    pthread_t thread[THREADS];
    line_make(&line, RD_TENSED, 2, 200, 300.0, 2.0, 1.0, 1);
    line.term_of[60] = FIRST;
    line_find(&line);
    for (int i = 0; i < THREADS; i++) {
        job[i].line = &line;
        pthread_create(thread + i, NULL, work, job + i);
    }
    for (int i = 0; i < THREADS; i++)
        pthread_join(thread[i], NULL);
    for (int i = 0; i < THREADS; i++) {
        CHECK_INT(job[i].status, RD_OK);
        CHECK(memcmp(job[i].value, job[0].value, sizeof job[0].value) == 0);
    }
    return check_report("threads");
}
