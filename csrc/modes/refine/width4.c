/* Inverse iteration for chains of width 4. */
#define RD_WAVE_WIDTH 4
#include "modes/refine/width.h"
