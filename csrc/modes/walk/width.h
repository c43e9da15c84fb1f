/* The width RD_WAVE_WIDTH that a file is compiled for; included before all else. */
#ifndef RD_WALK_WIDTH_H
#define RD_WALK_WIDTH_H

#include "base/fast.h"

#if RD_FAST && RD_WAVE_WIDTH < 3
#pragma GCC optimize("O3") /* two thirds of the time of -O2 */
#endif

#define W RD_WAVE_WIDTH
#define WIDTH_(name, w) rd_##name##_##w
#define WIDTH_OF(name, w) WIDTH_(name, w)
#define WIDTH(name) WIDTH_OF(name, RD_WAVE_WIDTH)

#endif
