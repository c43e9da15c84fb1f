/* Triples of six coordinates. */
#define WIDE 6
#include "space/triple.h"
