/* Inverse iteration for chains of width 3. */
#define RD_WAVE_WIDTH 3
#include "modes/refine/width.h"
