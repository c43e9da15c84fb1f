/* Parts of pieces of six coordinates, at several eigenvalues. */
#define WIDE 6
#include "space/family.h"
