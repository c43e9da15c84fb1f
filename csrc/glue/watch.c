/* A thread that works without the GIL and looks for Ctrl-C now and then. */
#include "glue/glue.h"

#include <math.h>
#include <time.h>

static const double PATIENCE = 0.05; /* [s] */

static double now(void)
{
    struct timespec time;
    timespec_get(&time, TIME_UTC);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static bool asked_to_stop(void *context)
{
    struct py_watch *watch = context;
    const double time = now();
    if (watch->stopped || fabs(time - watch->looked) < PATIENCE)
        return watch->stopped;
    watch->looked = time;
    PyEval_RestoreThread(watch->thread);
    watch->stopped = PyErr_CheckSignals() < 0;
    watch->thread = PyEval_SaveThread();
    return watch->stopped;
}

struct rd_stop py_watch_begin(struct py_watch *watch)
{
    *watch = (struct py_watch){.looked = now(), .thread = PyEval_SaveThread()};
    return (struct rd_stop){asked_to_stop, watch};
}

int py_watch_end(struct py_watch *watch)
{
    PyEval_RestoreThread(watch->thread);
    return watch->stopped ? -1 : 0;
}
