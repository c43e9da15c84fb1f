/* Triples of three coordinates. */
#define WIDE 3
#include "space/triple.h"
