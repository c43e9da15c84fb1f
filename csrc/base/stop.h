/* What long work asks now and then: whether to go on no longer. */
#ifndef RD_STOP_H
#define RD_STOP_H

#include <stdbool.h>
#include <stddef.h>

/* once `asked` has answered true it does so for ever */
struct rd_stop {
    bool (*asked)(void *context); /* NULL: never */
    void *context;
};

static inline bool rd_stop_is_asked(const struct rd_stop *stop)
{
    return stop->asked != NULL && stop->asked(stop->context);
}

#endif
