/* Counts of three coordinates. */
#define WIDE 3
#include "space/count.h"
