/* Counts of six coordinates. */
#define WIDE 6
#include "space/count.h"
