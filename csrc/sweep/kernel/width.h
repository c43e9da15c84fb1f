/* The sweep's kernel for the width RD_WIDTH: included by one source file per width.
   Everything is scaled: u = z u^, f = f^/z. Symmetric matrices are packed by rows. */

#include "sweep/kernel/kernel.h"

#include <math.h>

#pragma GCC diagnostic ignored "-Wpsabi"

#define NAME_(verb, w) verb##_##w
#define NAME(verb, w) NAME_(verb, w)
#define K_(verb) NAME(verb, RD_WIDTH)

enum { K_(W) = RD_WIDTH, K_(SYM) = RD_WIDTH * (RD_WIDTH + 1) / 2, K_(FULL) = RD_WIDTH * RD_WIDTH };
#define W K_(W)
#define SYM K_(SYM)
#define FULL K_(FULL)
#if RD_WIDTH < 4 && RD_FAST
#define UNROLL RD_UNROLL(4)
#else
#define UNROLL RD_UNROLL(1)
#endif
#define KEEP RD_UNROLL(1)

/* place of (i, j) in a packed symmetric matrix */
RD_INLINE int K_(at)(int i, int j)
{
    return i <= j ? i * W - i * (i - 1) / 2 + j - i : j * W - j * (j - 1) / 2 + i - j;
}
#define at K_(at)

#define RD_REAL 1
#include "sweep/kernel/number.h"

#include "sweep/kernel/small_matrix.h"

#include "sweep/kernel/join.h"

#undef RD_REAL
#define RD_REAL 0
#include "sweep/kernel/number.h"

#include "sweep/kernel/small_matrix.h"

#include "sweep/kernel/join.h"

#include "sweep/kernel/element.h"

#include "sweep/kernel/step.h"

#include "sweep/kernel/slice.h"

#include "sweep/kernel/node.h"

#include "sweep/kernel/walk.h"

#include "sweep/kernel/meet.h"

#if RD_WIDTH == 2 || RD_WIDTH == 3
#include "sweep/kernel/plane.h"

#undef RD_REAL
#define RD_REAL 1
#include "sweep/kernel/number.h"

#include "sweep/kernel/plane.h"
#endif

const struct sweep_kernel K_(rd_sweep_kernel) = {
    .make_element = K_(make_element),
    .make_rate = K_(make_rate),
    .make_slice = K_(make_slice),
    .make_span = K_(make_span),
    .make_whole = K_(make_whole),
    .make_coefficients = K_(make_coefficients),
    .make_single = K_(make_single),
#if RD_WIDTH > 2
    .make_coupled = K_(make_coupled),
    .twice = K_(twice),
#endif
#if RD_WIDTH == 2 || RD_WIDTH == 3
    .flatten = {K_(flatten), NAME(real_flatten, RD_WIDTH)},
    .scatter = {K_(unflatten), NAME(real_unflatten, RD_WIDTH)},
    .walk_plain = {K_(walk_plain), NAME(real_walk_plain, RD_WIDTH)},
#endif
#if RD_WIDTH == 2
    .walk_node = K_(walk_node),
    .walk_triples = K_(walk_triples),
    .make_compound = K_(make_compound),
    .walk_compound = K_(walk_compound),
#endif
    .join = {K_(join), NAME(real_join, RD_WIDTH)},
    .walk = K_(walk),
    .walk_pieces = K_(walk_pieces),
    .absorb = K_(absorb),
    .open = K_(open_all),
    .listen = K_(listen),
    .meet = K_(meet),
};
