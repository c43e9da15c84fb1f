/* Families of beams. */
#define RD_GRADED 2
#include "graded/width.h"
