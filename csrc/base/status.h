/* What a core function answers; it never prints, exits or keeps state. */
#ifndef RD_STATUS_H
#define RD_STATUS_H

enum rd_status {
    RD_OK = 0,
    RD_NO_MEMORY,             /* the workspace handed in is too small */
    RD_NOT_POSITIVE_DEFINITE, /* a section or a flexibility that would create energy */
    RD_INDEFINITE_ELEMENT,    /* rounding leaves nothing positive of an element's flexibility */
    RD_CRITICAL_ELEMENT,      /* tension is the critical load of one element: no triple exists */
    RD_SINGULAR,              /* a factorisation met an exact zero */
    RD_UNSTABLE_MASSLESS,     /* stiffness is not positive on coordinates without mass */
    RD_NO_CONVERGENCE,        /* an eigensolver gave up */
    RD_CLUSTER,               /* more modes lie closer together than are told apart */
    RD_SHORT_WAVES,           /* a span has more pieces shorter than its waves than are walked */
    RD_OVERFLOW,              /* numbers are not finite */
    RD_INTERRUPTED,           /* the caller asked to stop */
};

#endif
