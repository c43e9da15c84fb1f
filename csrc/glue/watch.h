/* A thread that works without the GIL and looks for Ctrl-C now and then. */
#ifndef PY_WATCH_H
#define PY_WATCH_H

#include "glue/glue.h"

#include "base/stop.h"

struct py_watch {
    PyThreadState *thread;
    double looked; /* [s] */
    bool stopped;
};

/* Releases the GIL; what the core asks from then on. */
struct rd_stop py_watch_begin(struct py_watch *watch);

/* Takes it again: 0, or -1 and the exception that Python had a reason to stop with. */
int py_watch_end(struct py_watch *watch);

#endif
