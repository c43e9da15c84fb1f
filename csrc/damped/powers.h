/* Numbers from the sums of their powers. */
#ifndef RD_POWERS_H
#define RD_POWERS_H

#include "base/complex.h"
#include "base/status.h"

#include <stddef.h>

enum { RD_POWERS_MOST = 64 };

/* root (count) from moment (count), sums of powers 1 .. count, of RD_POWERS_MOST at most; by Newton's
   identities. RD_NO_CONVERGENCE */
enum rd_status rd_powers_invert(size_t count, const double _Complex *moment, double _Complex *root);

#endif
