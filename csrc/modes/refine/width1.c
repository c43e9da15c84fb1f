/* Inverse iteration for chains of width 1. */
#define RD_WAVE_WIDTH 1
#include "modes/refine/width.h"
